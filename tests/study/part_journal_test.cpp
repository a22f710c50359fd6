// Finished variants of a part that is not complete, and the claims of parts.
#include "study/sweep/part_journal.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <thread>

#include "study/sweep/part_claim.h"
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
  test::writeFile(file, whole);
  EXPECT_THAT(PartJournal(file, {2}, 3).unfinished(), ElementsAre(2)) << "of another part";
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

TEST(PartClaim, IsHeldByOneUntilItEnds) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "part.claim";
  EXPECT_FALSE(PartClaim::isHeld(file));
  auto claim = PartClaim::tryClaim(file);
  ASSERT_NE(claim, nullptr);
  EXPECT_TRUE(PartClaim::isHeld(file));
  EXPECT_THAT(test::readFile(file), HasSubstr("process " + std::to_string(getpid())));
  EXPECT_EQ(PartClaim::tryClaim(file), nullptr);
  claim.reset();
  EXPECT_TRUE(folder.files().empty());
  EXPECT_NE(PartClaim::tryClaim(file), nullptr);
}

TEST(PartClaim, OfAnEndedProcessIsTakenOver) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "part.claim";
  const pid_t process = fork();
  if (process == 0) {
    static_cast<void>(PartClaim::tryClaim(file).release());
    kill(getpid(), SIGKILL);
  }
  waitpid(process, nullptr, 0);
  EXPECT_THAT(test::readFile(file), HasSubstr("process " + std::to_string(process)));
  EXPECT_FALSE(PartClaim::isHeld(file));
  const auto claim = PartClaim::tryClaim(file);
  ASSERT_NE(claim, nullptr);
  EXPECT_EQ(folder.files(), std::vector<std::string>{"part.claim"});
}

TEST(PartClaim, OfAnotherMachineIsTakenOverWhenItWasNotTouchedForFiveMinutes) {
  const test::TemporaryFolder folder;
  const std::string file = folder.write("part.claim", "host other\nprocess 1\nmachine 00000000\nclaim 1\n");
  const auto touchedBefore_s = [&](double age_s) {
    timespec times[2] = {};
    clock_gettime(CLOCK_REALTIME, &times[0]);
    times[0].tv_sec -= static_cast<time_t>(age_s);
    times[1] = times[0];
    ASSERT_EQ(utimensat(AT_FDCWD, file.c_str(), times, 0), 0);
  };
  for (const double age_s : {0.0, 90.0, 0.9 * PartClaim::kAbandoned_s}) {
    touchedBefore_s(age_s);
    EXPECT_TRUE(PartClaim::isHeld(file)) << age_s;
    EXPECT_EQ(PartClaim::tryClaim(file), nullptr) << age_s;
  }
  touchedBefore_s(1.1 * PartClaim::kAbandoned_s);
  EXPECT_FALSE(PartClaim::isHeld(file));
  const auto claim = PartClaim::tryClaim(file);
  ASSERT_NE(claim, nullptr);
  // The other process returns and claims it again.
  test::writeFile(file, "host other\nprocess 1\nmachine 00000000\nclaim 1\n");
  EXPECT_EQ(folder.files(), std::vector<std::string>{"part.claim"});
}

TEST(PartClaim, OneOfManyThatTryAtOnceGetsIt) {
  const test::TemporaryFolder folder;
  for (int round = 0; round < 20; ++round) {
    const std::string file = folder / ("part" + std::to_string(round));
    std::vector<std::unique_ptr<PartClaim>> claims(8);
    std::vector<std::thread> threads;
    for (auto& claim : claims) threads.emplace_back([&] { claim = PartClaim::tryClaim(file); });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(std::count(claims.begin(), claims.end(), nullptr), 7);
  }
}

}  // namespace
}  // namespace emscape::study
