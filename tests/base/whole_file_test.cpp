#include "base/files/whole_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "tests/support/errors.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temporary_folder.h"

namespace emscape {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class WholeFile : public ::testing::Test {
 protected:
  static std::string errorOf(const std::function<void()>& body) {
    return test::errorOf(body, ErrorCode::other);
  }
  static std::string textOf(const fs::path& path) {
    const auto bytes = readWhole(path);
    return {bytes.begin(), bytes.end()};
  }
  long filesInFolder() const {
    return std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator());
  }

  test::TemporaryFolder folder_;
};

TEST_F(WholeFile, AppearsWithItsText) {
  writeWhole(folder_ / "a", [](std::ostream& stream) { stream << "one"; });
  EXPECT_EQ(textOf(folder_ / "a"), "one");
  writeWhole(folder_ / "a", [](std::ostream& stream) { stream << "two"; });
  EXPECT_EQ(textOf(folder_ / "a"), "two");
  EXPECT_EQ(filesInFolder(), 1);
}

TEST_F(WholeFile, ATargetIsRefusedBeforeItIsWritten) {
  requireFileTarget(folder_ / "a");
  EXPECT_EQ(errorOf([&] { requireFileTarget(folder_ / "none/a"); }),
            (folder_ / "none/a") + ": cannot write: the folder " + (folder_ / "none") + " does not exist");
  EXPECT_EQ(errorOf([&] { requireFileTarget(folder_.path()); }),
            folder_.path().string() + ": cannot write: a folder of that name exists");
  EXPECT_EQ(filesInFolder(), 0);
}

TEST_F(WholeFile, KeepsTheOldFileWhenTheWriterThrows) {
  writeWhole(folder_ / "a", [](std::ostream& stream) { stream << "one"; });
  EXPECT_THROW(writeWhole(folder_ / "a",
                          [](std::ostream& stream) {
                            stream << "half";
                            throw std::runtime_error("stop");
                          }),
               std::runtime_error);
  EXPECT_EQ(textOf(folder_ / "a"), "one");
  EXPECT_EQ(filesInFolder(), 1);
}

TEST_F(WholeFile, FilesThatBelongTogetherAppearTogetherOrNotAtAll) {
  const auto good = [](std::ostream& stream) { stream << "good"; };
  const auto bad = [](std::ostream& stream) { stream.setstate(std::ios::badbit); };
  EXPECT_THROW(writeWhole({{folder_ / "a", good}, {folder_ / "b", bad}}), Error);
  EXPECT_EQ(filesInFolder(), 0);
  writeWhole({{folder_ / "a", good}, {folder_ / "b", good}});
  EXPECT_EQ(filesInFolder(), 2);
}

TEST_F(WholeFile, NamesAMissingFolder) {
  EXPECT_THAT(
      errorOf([&] { writeWhole(folder_ / "none/a", [](std::ostream&) {}); }),
      HasSubstr(folder_ / "none/a" + ": cannot write: the folder " + folder_ / "none" + " does not exist"));
}

TEST_F(WholeFile, RefusesFoldersAndDevices) {
  EXPECT_THAT(errorOf([&] { writeWhole(folder_.path(), [](std::ostream&) {}); }),
              HasSubstr("a folder of that name exists"));
  EXPECT_THAT(errorOf([] { writeWhole("/dev/full", [](std::ostream&) {}); }),
              HasSubstr("not a regular file"));
}

TEST_F(WholeFile, NamesAMissingPermission) {
  fs::permissions(folder_.path(), fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                                      fs::perms::others_exec);
  const uid_t user = geteuid();
  constexpr uid_t kNobody = 65534;  // root may write everywhere
  ASSERT_EQ(seteuid(user == 0 ? kNobody : user), 0);
  const std::string error = errorOf([&] { writeWhole(folder_ / "a", [](std::ostream&) {}); });
  ASSERT_EQ(seteuid(user), 0);
  EXPECT_THAT(error, HasSubstr("Permission denied"));
  fs::permissions(folder_.path(), fs::perms::owner_all);
}

TEST_F(WholeFile, IsRemovedWhenTheDiskIsFull) {
  const test::FileSizeLimit limit(100000);
  for (const int bytes : {150000, 3000000}) {
    const std::string text(static_cast<std::size_t>(bytes), 'x');
    EXPECT_THAT(errorOf([&] { writeWhole(folder_ / "a", [&](std::ostream& stream) { stream << text; }); }),
                HasSubstr("a: cannot write: File too large"));
  }
  // Small writes fail when the buffer is flushed at the end.
  EXPECT_THROW(writeWhole(folder_ / "a",
                          [](std::ostream& stream) {
                            for (int i = 0; i < 100001; ++i) stream.put('x');
                          }),
               Error);
  EXPECT_EQ(filesInFolder(), 0);
}

TEST_F(WholeFile, TemporariesOfKilledRunsAreKnownAndRemoved) {
  const fs::path mine = temporaryFor(folder_ / "a.vdb");
  EXPECT_TRUE(isTemporary(mine));
  EXPECT_EQ(mine.filename().string().rfind("a.vdb.part-", 0), 0U);
  EXPECT_FALSE(isTemporary("a.vdb"));
  EXPECT_FALSE(isTemporary("a.part-"));
  EXPECT_FALSE(isTemporary("a.part-12b"));
  EXPECT_FALSE(isTemporary(".part-12"));
  EXPECT_TRUE(isTemporary("a.part-12"));
  EXPECT_FALSE(isTemporary("a.part-12-host"));
  for (const char* ending : {"-journal", "-wal", "-shm", ".aux.xml"}) {
    EXPECT_TRUE(isTemporary(mine.string() + ending)) << ending;
    EXPECT_TRUE(isTemporary(std::string("a.part-12") + ending)) << ending;
    EXPECT_FALSE(isTemporary(std::string("a.vdb") + ending)) << ending;
  }
  EXPECT_FALSE(isTemporary("a.part-12-note"));
  std::ofstream(mine) << "running";
  std::ofstream(folder_ / "a.vdb.part-999999999") << "killed";  // above the largest process number
  std::ofstream(folder_ / "a.vdb.part-999999999-journal") << "of GDAL";
  const fs::path elsewhere = folder_ / "a.vdb.part-999999999-00000000";
  ASSERT_NE(machineName(), "00000000");
  std::ofstream(elsewhere) << "of another machine, where it may run";
  EXPECT_EQ(removeStaleTemporaries(folder_.path()), 2);
  EXPECT_TRUE(fs::exists(mine));
  EXPECT_TRUE(fs::remove(elsewhere));
  publish(mine, folder_ / "a.vdb");
  EXPECT_EQ(textOf(folder_ / "a.vdb"), "running");
  EXPECT_EQ(filesInFolder(), 1);
  EXPECT_EQ(removeStaleTemporaries(folder_ / "none"), 0);
}

TEST_F(WholeFile, TheNameMayBeAsLongAsTheFileSystemAllows) {
  std::string name = "1";
  while (name.size() < 251) name += "\u00e9";
  const std::string one = folder_ / (name + "1.a"), two = folder_ / (name + "2.a");
  const auto write = [](std::ostream& stream) { stream << "text"; };
  writeWhole({{one, write}, {two, write}});
  EXPECT_EQ(textOf(one), "text");
  EXPECT_EQ(textOf(two), "text");
  EXPECT_EQ(filesInFolder(), 2);
  const fs::path temporary = temporaryFor(one);
  EXPECT_TRUE(isTemporary(temporary));
  EXPECT_LE(temporary.filename().string().size() + std::string(".aux.xml").size(), 255U);
  EXPECT_NE(temporary, temporaryFor(two));
  const std::string stem = temporary.string().substr(0, temporary.string().rfind('-'));
  const std::string killed = stem.substr(0, stem.rfind('-') + 1) + "999999999";
  std::ofstream(killed) << "killed";
  removeStaleTemporariesOf(two);
  EXPECT_TRUE(fs::exists(killed));
  removeStaleTemporariesOf(one);
  EXPECT_FALSE(fs::exists(killed));
}

TEST_F(WholeFile, OnlyTheTemporariesOfAFileThatDeadProcessesLeftAreRemovedWithIt) {
  const fs::path mine = temporaryFor(folder_ / "film.mp4");
  std::ofstream(mine) << "running";
  std::ofstream(folder_ / "film.mp4.part-999999999") << "killed";
  std::ofstream(folder_ / "other.mp4.part-999999999") << "not asked for";
  std::ofstream(folder_ / "film.mp4.part-notes") << "of another program";
  removeStaleTemporariesOf(folder_ / "film.mp4");
  EXPECT_FALSE(fs::exists(folder_ / "film.mp4.part-999999999"));
  EXPECT_EQ(filesInFolder(), 3);
  EXPECT_NO_THROW(removeStaleTemporariesOf(folder_ / "none/film.mp4"));
}

TEST_F(WholeFile, TheTemporaryOfAProcessThatEndedButWasNotWaitedForIsStale) {
  const pid_t process = fork();
  if (process == 0) _exit(0);
  siginfo_t ended{};
  waitid(P_PID, static_cast<id_t>(process), &ended, WEXITED | WNOWAIT);
  std::ofstream(folder_ / ("a.vdb.part-" + std::to_string(process))) << "killed";
  EXPECT_EQ(removeStaleTemporaries(folder_.path()), 1);
  waitpid(process, nullptr, 0);
}

TEST_F(WholeFile, PatchesReplaceBytesWhereTheyLie) {
  writeWhole(folder_ / "a", [](std::ostream& stream) { stream << "0123456789"; });
  patchFile(folder_ / "a", {{2, "xy"}, {9, "z"}});
  EXPECT_EQ(textOf(folder_ / "a"), "01xy45678z");
  EXPECT_THAT(errorOf([&] {
                patchFile(folder_ / "none", {{0, "x"}});
              }),
              HasSubstr("none: cannot write: No such file or directory"));
}

TEST_F(WholeFile, AppendingMakesTheFileAndAddsToIt) {
  appendToFile(folder_ / "a", "one\n");
  appendToFile(folder_ / "a", "two\n");
  EXPECT_EQ(textOf(folder_ / "a"), "one\ntwo\n");
  EXPECT_THAT(errorOf([&] { appendToFile(folder_ / "none/a", "x"); }), HasSubstr("cannot write"));
}

TEST_F(WholeFile, DigestIsSizeAndCrc32OfContent) {
  writeWhole(folder_ / "a", [](std::ostream& stream) { stream << "123456789"; });
  const FileDigest digest = digestOf(folder_ / "a");
  EXPECT_EQ(digest.bytes, 9U);
  EXPECT_EQ(digest.crc32, 0xcbf43926U);  // the check value of the CRC-32 of ISO 3309
  writeWhole(folder_ / "large", [](std::ostream& stream) { stream << std::string(3'000'001, 'x'); });
  EXPECT_EQ(digestOf(folder_ / "large").bytes, 3'000'001U);
  EXPECT_NE(digestOf(folder_ / "large"), digest);
  writeWhole(folder_ / "empty", [](std::ostream&) {});
  EXPECT_EQ(digestOf(folder_ / "empty"), (FileDigest{0, 0}));
  EXPECT_THAT(test::errorOf([&] { digestOf(folder_ / "none"); }),
              HasSubstr("none: cannot read: No such file or directory"));
}

TEST_F(WholeFile, ReadErrorNamesTheCause) {
  EXPECT_THAT(test::errorOf([&] { readWhole(folder_ / "none"); }, ErrorCode::bad_input),
              HasSubstr("none: there is no such file"));
  EXPECT_THROW(readWhole(folder_.path()), Error);
}

}  // namespace
}  // namespace emscape
