// The frame of `emscape check`: tables of reference figures, and its report on a folder.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cctype>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "emfield/check/reference_check.h"
#include "emfield/check/reference_table.h"
#include "emscape/base/log.h"
#include "propagation/air/gases.h"
#include "propagation/air/rain.h"
#include "propagation/limits.h"
#include "propagation/p2108/p2108.h"
#include "propagation/registry/model_info.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/reference_data.h"
#include "tests/support/sanitizers.h"
#include "tests/support/temporary_folder.h"

namespace emscape::emfield {
namespace {

using namespace propagation;

namespace fs = std::filesystem;
using testing::EndsWith;
using testing::HasSubstr;

class CheckFolder : public testing::Test {
 protected:
  fs::path write(const std::string& name, const std::string& text) const { return root_.write(name, text); }

  const test::TemporaryFolder root_;
};

TEST_F(CheckFolder, ReadsATableByColumnNames) {
  const ReferenceTable table(write("t.csv", "a,b,c\r\n1,-2.5e-3,x y\r\n\r\n4,,z\r\n"), {"a", "c"});
  ASSERT_EQ(table.rows(), 2);
  EXPECT_EQ(table.integer(0, "a"), 1);
  EXPECT_EQ(table.number(0, "b"), -2.5e-3);
  EXPECT_EQ(table.text(0, "c"), "x y");
  EXPECT_FALSE(table.has(1, "b"));
  EXPECT_EQ(table.location(1).line, 4);
}

TEST_F(CheckFolder, TellsALastRowWithoutALineEnd) {
  std::string warnings;
  setLogSink([&](LogLevel, const std::string& text) { warnings += text; });
  ReferenceTable(write("whole.csv", "a,b\n1,2\n"), {"a"});
  EXPECT_EQ(warnings, "");
  ReferenceTable(write("cut.csv", "a,b\n1,2"), {"a"});
  setLogSink({});
  EXPECT_THAT(warnings, HasSubstr("cut.csv:2:1: a row has no end"));
}

TEST_F(CheckFolder, NamesFileAndLineOfAMalformedTable) {
  const auto message = [this](const std::string& text) {
    const fs::path file = write("t.csv", text);
    return test::errorOf(
        [&] {
          const ReferenceTable table(file, {"a", "b"});
          for (int i = 0; i < table.rows(); ++i) table.integer(i, "a");
        },
        ErrorCode::bad_input);
  };
  EXPECT_THAT(message(""), EndsWith("t.csv: no cases; expected column names and a row for each case"));
  EXPECT_THAT(message("a,b\n"), HasSubstr("t.csv: no cases"));
  EXPECT_THAT(message("a,c\n1,2\n"), EndsWith("t.csv:1: column 'b' is missing"));
  EXPECT_THAT(message("a,b\n1,2\n1\n"), EndsWith("t.csv:3: 1 cells where the first line names 2 columns"));
  EXPECT_THAT(message("a,b\n1,2\nx,2\n"), EndsWith("t.csv:3: a: 'x' is not a finite number"));
  EXPECT_THAT(message("a,b\n,2\n"), EndsWith("t.csv:2: a: '' is not a finite number"));
  EXPECT_THAT(message("a,b\nnan,2\n"), EndsWith("t.csv:2: a: 'nan' is not a finite number"));
  EXPECT_THAT(message("a,b\n1.5,2\n"), EndsWith("t.csv:2: a: '1.5' is not a whole number"));
  EXPECT_THAT(test::errorOf([this] { ReferenceTable(root_ / "none.csv", {}); }, ErrorCode::bad_input),
              HasSubstr("none.csv"));
}

TEST_F(CheckFolder, NamesFileAndLineOfAMalformedProfile) {
  const auto message = [this](const std::string& text) {
    const fs::path file = write("profiles.csv", text);
    return test::errorOf([&] { readReferenceProfiles(file); }, ErrorCode::bad_input);
  };
  EXPECT_THAT(
      message("1,90,5,6\n2,90,5,6\n"),
      EndsWith("profiles.csv:2: n_intervals is 2 but 2 heights follow; expected one more than intervals"));
  EXPECT_THAT(message("1,0,5,6\n"), EndsWith("profiles.csv:1: step_m: 0 is not above 0 m"));
  EXPECT_THAT(message("1,90,5,\n"), EndsWith("profiles.csv:1: h_1: '' is not a finite number"));
  EXPECT_THAT(message("1\n"), HasSubstr("profiles.csv:1: n_intervals is 1 but"));
  const auto profiles = readReferenceProfiles(write("profiles.csv", "1,90,5,6\n2,30,1,2,3\n"));
  ASSERT_EQ(profiles.size(), 2u);
  EXPECT_EQ(profiles[1].step_m, 30);
  EXPECT_THAT(profiles[1].heights_msl_m, testing::ElementsAre(1, 2, 3));
}

TEST_F(CheckFolder, ListsPresentAbsentAndUnknownDatasets) {
  write("geoid/check_points.csv", "");
  write("radar/mystery.csv", "");
  write("p9999/cases.csv", "");
  write("README.md", "");
  const ReferenceFolder found = findDatasets(root_.path());
  ASSERT_EQ(found.present.size(), 1u);
  EXPECT_EQ(found.present[0]->name, "geoid");
  EXPECT_EQ(found.absent.size(), referenceDatasets().size() - 1);
  EXPECT_THAT(found.unknown, testing::ElementsAre("p9999", "radar/mystery.csv"));
}

TEST_F(CheckFolder, TakesTheFolderOfOneDatasetOrOfAFamily) {
  write("geoid/check_points.csv", "");
  write("radar/clutter_worked_examples.csv", "");
  const ReferenceFolder geoid = findDatasets(root_ / "geoid"), radar = findDatasets(root_ / "radar");
  ASSERT_EQ(geoid.present.size(), 1u);
  EXPECT_EQ(geoid.present[0]->name, "geoid");
  EXPECT_THAT(geoid.unknown, testing::IsEmpty());
  ASSERT_EQ(radar.present.size(), 1u);
  EXPECT_EQ(radar.present[0]->name, "radar/clutter_worked_examples.csv");
}

TEST_F(CheckFolder, RefusesAFolderWithoutDatasets) {
  EXPECT_THAT(test::errorOf([this] { findDatasets(root_.path()); }, ErrorCode::bad_input),
              HasSubstr("has no known dataset"));
  EXPECT_THAT(test::errorOf([this] { findDatasets(root_ / "none"); }, ErrorCode::bad_input),
              EndsWith("none: no such folder"));
}

TEST(FigureCheck, KeepsTheLargestDifferenceAndItsLine) {
  FigureCheck figure{"loss_db", 0.1, "dB"};
  figure.compare(1, 1, 2);
  EXPECT_EQ(figure.worst_line, 0);
  figure.compare(1, 1.25, 3);
  figure.compare(1, 1.125, 4);
  EXPECT_EQ(figure.max_abs_error, 0.25);
  EXPECT_EQ(figure.worst_line, 3);
  EXPECT_FALSE(figure.pass());
}

TEST(FigureCheck, CountsNaNAsAMiss) {
  FigureCheck figure{"loss_db", 0.1, "dB"};
  figure.compare(std::nan(""), 1, 2);
  figure.compare(1, 1, 3);
  EXPECT_FALSE(figure.pass());
  EXPECT_EQ(figure.worst_line, 2);
}

TEST(FigureCheck, ComparesRelatively) {
  FigureCheck figure{"gamma", 0.01, "relative"};
  figure.compareRelative(202, 200, 2);
  EXPECT_NEAR(figure.max_abs_error, 0.01, 1e-15);
  figure.compareRelative(0, 0, 3);
  EXPECT_EQ(figure.worst_line, 2);
}

/// Every dataset with a model meets its tolerance.
class Reference : public testing::TestWithParam<int> {};

TEST_P(Reference, ResultsWithinTolerance) {
  const ReferenceDataset& dataset = referenceDatasets()[static_cast<std::size_t>(GetParam())];
  const auto path = test::referenceFile("reference/" + dataset.name);
  if (!path) GTEST_SKIP() << test::notInRepository("reference/" + dataset.name);
  const bool is_march = dataset.name.rfind("pe/", 0) == 0;
  if (emscape::test::kIsSanitized && is_march)
    GTEST_SKIP() << "the sanitizers take minutes for these marches";
  const DatasetCheck result = dataset.check(*path);
  EXPECT_GT(result.cases, 0);
  for (const FigureCheck& figure : result.figures) {
    EXPECT_LE(figure.max_abs_error, figure.tolerance) << figure.figure << ", line " << figure.worst_line;
  }
}

/// Indices of the datasets that a model implements.
std::vector<int> checkedDatasets() {
  std::vector<int> indices;
  for (std::size_t i = 0; i < referenceDatasets().size(); ++i) {
    if (referenceDatasets()[i].check != nullptr) indices.push_back(static_cast<int>(i));
  }
  return indices;
}

std::string datasetTestName(const testing::TestParamInfo<int>& info) {
  std::string name = referenceDatasets()[static_cast<std::size_t>(info.param)].name;
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  const bool is_slow = name == "pe_ntia_lfmf_10_30mhz_csv";  // 20 s
  return (is_slow ? "SLOW_" : "") + name;
}
INSTANTIATE_TEST_SUITE_P(Datasets, Reference, testing::ValuesIn(checkedDatasets()), datasetTestName);

constexpr ModelLimit kFrequency{"frequency", "MHz", 1e6, 20, 20000, Beyond::refused, "of the model's data"};

TEST(ModelLimits, IncludeMinAndMaxAndExcludeNaN) {
  EXPECT_TRUE(kFrequency.holds(20e6));
  EXPECT_TRUE(kFrequency.holds(20e9));
  EXPECT_FALSE(kFrequency.holds(19.999e6));
  EXPECT_FALSE(kFrequency.holds(20.001e9));
  EXPECT_FALSE(kFrequency.holds(std::nan("")));
}

TEST(ModelLimits, AppearInMessageAndTable) {
  EXPECT_EQ(outsideMessage(kFrequency, 15e6), "frequency 15 MHz is outside 20..20000 MHz: refused");
  const ModelLimit* const limits[] = {&kFrequency};
  EXPECT_THAT(limitsTable(limits),
              EndsWith("| frequency | MHz | 20 | 20000 | refused | of the model's data |\n"));
}

/// The tables of limits in docs/models.md are up to date.
TEST(ModelLimits, AppearInDocumentation) {
  const std::string text = test::readFile(test::sourceFile("docs/models.md"));
  for (const ModelInfo& model : models()) {
    if (model.limits.empty()) continue;
    EXPECT_THAT(text, HasSubstr(limitsTable(model.limits.data(), static_cast<int>(model.limits.size()))));
  }
  EXPECT_THAT(text, HasSubstr(limitsTable(kGasesLimits)));
  EXPECT_THAT(text, HasSubstr(limitsTable(kRainLimits)));
  EXPECT_THAT(text, HasSubstr(limitsTable(kP2108Limits)));
}

}  // namespace
}  // namespace emscape::emfield
