// Finished variants of a part that is not complete.
#include "study/sweep/results/part_journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::study {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

VariantResult resultOf(std::size_t variant) {
  return {variant, {0.1 + static_cast<double>(variant), NAN, -1e-300}, {1, 0, 0, 1, 1, 0, 1, 0, 1}};
}

TEST(PartJournal, KeepsFinishedVariants) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "part.rows";
  {
    PartJournal journal(file, {5, 3, 8}, 3);
    EXPECT_THAT(journal.unfinished(), ElementsAre(5, 3, 8));
    journal.add(resultOf(5), {"first"}, "cpu");
    journal.add(resultOf(8), {"first", "second"}, "cpu");
  }
  PartJournal journal(file, {5, 3, 8}, 3);
  EXPECT_THAT(journal.unfinished(), ElementsAre(3));
  EXPECT_THAT(journal.warnings(), ElementsAre("first", "second"));
  journal.add(resultOf(3), {}, "gpu");
  EXPECT_THAT(journal.machines(), ElementsAre("cpu", "gpu"));
  const std::vector<VariantResult> results = journal.results();
  ASSERT_EQ(results.size(), 3u);
  for (const VariantResult& result : results) {
    const VariantResult expected = resultOf(result.variant);
    EXPECT_EQ(result.values[0], expected.values[0]);
    EXPECT_TRUE(std::isnan(result.values[1]));
    EXPECT_EQ(result.values[2], expected.values[2]);
    EXPECT_EQ(result.pixels, expected.pixels);
  }
  EXPECT_EQ(results[1].variant, 3u) << "in the order of the part";
}

TEST(PartJournal, TruncatedLineIsIgnored) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "part.rows";
  {
    PartJournal journal(file, {0, 1, 2}, 3);
    journal.add(resultOf(0), {}, "cpu");
    journal.add(resultOf(1), {}, "cpu");
  }
  const std::string whole = test::readFile(file);
  for (std::size_t bytes = 0; bytes <= whole.size(); ++bytes) {
    test::writeFile(file, whole.substr(0, bytes));
    std::size_t before = 0;
    {
      PartJournal journal(file, {0, 1, 2}, 3);
      before = journal.unfinished().size();
      EXPECT_GE(before, 1u);
      journal.add(resultOf(2), {}, "cpu");
    }
    EXPECT_EQ(PartJournal(file, {0, 1, 2}, 3).unfinished().size(), before - 1) << bytes << " bytes";
  }
  // What a disk without power leaves.
  for (const std::string& left :
       {std::string(9000, '\0'), whole.substr(0, 30) + std::string(100, '\0') + "]\n",
        '\n' + std::string(50, '\0')}) {
    test::writeFile(file, left);
    PartJournal(file, {0, 1, 2}, 3).add(resultOf(2), {}, "cpu");
    EXPECT_THAT(PartJournal(file, {0, 1, 2}, 3).unfinished(), ElementsAre(0, 1));
  }
  test::writeFile(file, whole);
  EXPECT_THAT(PartJournal(file, {2}, 3).unfinished(), ElementsAre(2)) << "of another part";
}

TEST(PartJournal, AChangedLineIsToldAndStays) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "part.rows";
  {
    PartJournal journal(file, {0, 1, 2}, 3);
    for (const std::size_t variant : {0u, 1u}) journal.add(resultOf(variant), {}, "cpu");
  }
  const std::string whole = test::readFile(file);
  const std::size_t second = whole.find("cpu", whole.find("cpu") + 1);
  for (const std::string& changed :
       {whole.substr(0, second) + "gpu" + whole.substr(second + 3),
        whole.substr(0, second - 1) + whole.substr(second), whole + "a note of mine\n"}) {
    test::writeFile(file, changed);
    EXPECT_THAT(test::errorOf(
                    [&] {
                      PartJournal(file, {0, 1, 2}, 3);
                    },
                    ErrorCode::bad_input),
                HasSubstr("was changed since it was written; put it back as it was, or remove the line"));
    EXPECT_EQ(test::readFile(file), changed);
  }
  test::writeFile(file, whole.substr(0, whole.find('\n', 1) + 1));
  EXPECT_THAT(PartJournal(file, {0, 1, 2}, 3).unfinished(), ElementsAre(1, 2)) << "without the line";
}

TEST(PartJournal, ProcessesMayAppendAtTheSameTime) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "part.rows";
  std::vector<std::size_t> variants(400);
  for (std::size_t v = 0; v < variants.size(); ++v) variants[v] = v;
  std::vector<std::thread> writers;
  for (std::size_t w = 0; w < 4; ++w) {
    writers.emplace_back([&, w] {
      PartJournal journal(file, variants, 3);
      for (std::size_t v = w; v < variants.size(); v += 4) journal.add(resultOf(v), {}, "cpu");
    });
  }
  for (std::thread& writer : writers) writer.join();
  EXPECT_TRUE(PartJournal(file, variants, 3).unfinished().empty());
}

TEST(PartJournal, NamesAFileThatCannotBeWritten) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(test::errorOf([&] { PartJournal(folder / "none/part.rows", {1}, 1); }),
              HasSubstr("none/part.rows"));
}

}  // namespace
}  // namespace emscape::study
