// Profiles of refractivity in CSV files.
#include "scenario/refractivity_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/errors.h"
#include "tests/support/temporary_folder.h"

namespace emscape::scenario {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

class RefractivityFiles : public testing::Test {
 protected:
  RefractivityFile read(const std::string& text) { return readRefractivity(folder_.write("air.csv", text)); }
  std::string errorOf(const std::string& text) {
    return test::errorOf([&] { read(text); }, ErrorCode::bad_input);
  }
  test::TemporaryFolder folder_;
};

TEST_F(RefractivityFiles, HoldOneProfileInMOrN) {
  const RefractivityFile in_m = read("height_msl_m,m_units\n0,330\n100,320\n");
  EXPECT_DOUBLE_EQ(in_m.air.at(5e4).at(50), 325);
  EXPECT_TRUE(in_m.air.traps());
  EXPECT_TRUE(in_m.warnings.empty());
  const RefractivityFile in_n = read("n_units,height_msl_m\n330,0\n290,1000\n");
  EXPECT_NEAR(in_n.air.at(0).at(1000), 290 + 1e6 / 6371, 1e-9);
  EXPECT_FALSE(in_n.air.traps());
}

TEST_F(RefractivityFiles, HoldProfilesByRange) {
  const RefractivityFile file =
      read("range_m,height_msl_m,m_units\n0,0,330\n0,10,320\n1000,0,330\n1000,30,320\n");
  EXPECT_DOUBLE_EQ(file.air.at(500).at(20), 320);  // the duct is 20 m high halfway
  EXPECT_FALSE(file.air.pointwise());
}

TEST_F(RefractivityFiles, WarnOfUnitsAndOfUnequalProfiles) {
  EXPECT_THAT(read("height_msl_m,m_units\n0,330\n2000,260\n").warnings,
              testing::ElementsAre(HasSubstr("look like N-units")));
  EXPECT_THAT(read("range_m,height_msl_m,m_units\n0,0,330\n0,10,331\n1000,0,330\n1000,30,320\n1000,60,325\n")
                  .warnings,
              testing::ElementsAre(HasSubstr("differ in their numbers of levels")));
}

TEST_F(RefractivityFiles, TellWhereTheyAreWrong) {
  EXPECT_THAT(errorOf(""), HasSubstr("air.csv:1:1: the file is empty"));
  EXPECT_THAT(errorOf("height_m,m_units\n"), HasSubstr("air.csv:1:1: unknown column 'height_m'"));
  EXPECT_THAT(errorOf("height_msl_m,height_msl_m\n"),
              HasSubstr("air.csv:1:14: second column 'height_msl_m'"));
  EXPECT_THAT(errorOf("height_msl_m,m_units,n_units\n"), HasSubstr("air.csv:1:1: the header has"));
  EXPECT_THAT(errorOf("height_msl_m,m_units\n"), HasSubstr("no levels; expected 2 .. 256"));
  EXPECT_THAT(errorOf("height_msl_m,m_units\n0,330\n"), HasSubstr("has 1 levels; expected 2 .. 256"));
  EXPECT_THAT(errorOf("height_msl_m,m_units\n0,330\n5\n"), HasSubstr("air.csv:3:1: 1 values"));
  EXPECT_THAT(errorOf("height_msl_m,m_units\n0,330\nnan,331\n"),
              HasSubstr("air.csv:3:1: height_msl_m is 'nan'"));
  EXPECT_THAT(errorOf("height_msl_m,m_units\n0,330\n0,331\n"),
              EndsWith("air.csv:3:1: height: 0 m is not above the level before, 0 m"));
  EXPECT_THAT(errorOf("height_msl_m,m_units\n0,330\n70000,331\n"),
              HasSubstr("not within 60000 m of sea level"));
  EXPECT_THAT(errorOf("height_msl_m,m_units\n0,-1\n"), HasSubstr("M: -1 is not in 0 .. 2500 M-units"));
  EXPECT_THAT(errorOf("height_msl_m,m_units\n0,330\n1,340\n"),
              HasSubstr("10 M-units per metre is not within +-5"));
  EXPECT_THAT(errorOf("height_msl_m,n_units\n0,501\n"), HasSubstr("n_units is 501; allowed are 0 to 500"));
  EXPECT_THAT(errorOf("range_m,height_msl_m,m_units\n9,0,330\n9,1,331\n5,0,330\n"),
              HasSubstr("air.csv:4:1: range_m is 5 behind 9; ranges ascend"));
  EXPECT_THAT(test::errorOf([] { readRefractivity("/none/air.csv"); }), HasSubstr("/none/air.csv"));
}

}  // namespace
}  // namespace emscape::scenario
