#include "base/files/whole_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

#include "base/files/appended_file.h"
#include "base/files/file_digest.h"
#include "base/files/file_patch.h"
#include "base/files/file_reading.h"
#include "base/files/folder.h"
#include "base/files/unfinished_file.h"
#include "base/large_array.h"
#include "tests/support/errors.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temporary_folder.h"

namespace emscape {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class WholeFile : public ::testing::Test {
 protected:
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

/// Large files are left once the work is stopped; the small records of what is finished are not.
TEST_F(WholeFile, OfManyBytesIsNeitherWrittenNorReadOnceTheWorkIsStopped) {
  const std::string large(3 * ByteCheckpoints::kBytes / 2, 'x');
  writeWhole(folder_ / "large", [&](std::ostream& stream) { stream << large; });
  StopFlag stopped{true};
  Work work(&stopped);
  const WorkScope scope(&work);
  EXPECT_THROW(writeWhole(folder_ / "block", [&](std::ostream& stream) { stream << large; }), Stopped);
  EXPECT_THROW(writeWhole(folder_ / "pieces",
                          [&](std::ostream& stream) {
                            for (std::size_t n = 0; n < large.size(); n += 1000)
                              stream.write(&large[n], 1000);
                          }),
               Stopped);
  EXPECT_EQ(filesInFolder(), 1);
  EXPECT_THROW(readWhole(folder_ / "large"), Stopped);
  EXPECT_THROW(digestOf(folder_ / "large"), Stopped);
  std::vector<int> memory;
  EXPECT_THROW(resizeInParts(memory, 10'000'000), Stopped);
  writeWhole(folder_ / "record", [](std::ostream& stream) { stream << "step 1"; });
  EXPECT_EQ(textOf(folder_ / "record"), "step 1");
  EXPECT_EQ(digestOf(folder_ / "record").bytes, 6U);
}

TEST_F(WholeFile, KeepsWhoMayReadTheFileThatItReplaces) {
  for (const auto mode : {fs::perms(0600), fs::perms(0640), fs::perms(0664)}) {
    writeWhole(folder_ / "a", [](std::ostream& stream) { stream << "one"; });
    fs::permissions(folder_ / "a", mode);
    writeWhole(folder_ / "a", [](std::ostream& stream) { stream << "two"; });
    EXPECT_EQ(textOf(folder_ / "a"), "two");
    EXPECT_EQ(fs::status(folder_ / "a").permissions(), mode);
    fs::remove(folder_ / "a");
  }
}

TEST_F(WholeFile, AWriteProtectedFileStays) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write every file";
  writeWhole(folder_ / "a", [](std::ostream& stream) { stream << "one"; });
  fs::permissions(folder_ / "a", fs::perms(0444));
  const std::string error = test::errorOf(
      [&] { writeWhole(folder_ / "a", [](std::ostream& stream) { stream << "two"; }); }, ErrorCode::other);
  EXPECT_THAT(error, testing::HasSubstr("a: cannot write: Permission denied"));
  EXPECT_EQ(textOf(folder_ / "a"), "one");
}

TEST_F(WholeFile, ATargetIsRefusedBeforeItIsWritten) {
  UnfinishedFile(folder_ / "a");
  EXPECT_EQ(test::errorOf([&] { UnfinishedFile(folder_ / "none/a"); }, ErrorCode::other),
            (folder_ / "none/a") + ": cannot write: the folder " + (folder_ / "none") + " does not exist");
  EXPECT_EQ(test::errorOf([&] { UnfinishedFile(folder_.path()); }, ErrorCode::other),
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

TEST_F(WholeFile, AFileThatAnotherProcessWritesMeanwhileStaysUnlessItIsToBeReplaced) {
  const auto good = [](std::ostream& stream) { stream << "good"; };
  const auto slow = [&](std::ostream& stream) {
    stream << "slow";
    writeWhole(folder_ / "b", [](std::ostream& other) { other << "other"; });
  };
  const std::string error = test::errorOf(
      [&] {
        writeWhole({{folder_ / "a", good}, {folder_ / "b", slow}}, Replaces::nothing);
      },
      ErrorCode::usage);
  EXPECT_THAT(error, HasSubstr(folder_ / "b" + " exists; --force replaces it"));
  EXPECT_EQ(textOf(folder_ / "b"), "other");
  EXPECT_EQ(filesInFolder(), 1) << "what belongs to it is taken back";
  writeWhole(folder_ / "b", slow);
  EXPECT_EQ(textOf(folder_ / "b"), "slow");
}

TEST_F(WholeFile, NamesAMissingFolder) {
  EXPECT_THAT(
      test::errorOf([&] { writeWhole(folder_ / "none/a", [](std::ostream&) {}); }, ErrorCode::other),
      HasSubstr(folder_ / "none/a" + ": cannot write: the folder " + folder_ / "none" + " does not exist"));
}

TEST_F(WholeFile, NamesAFileInPlaceOfAFolder) {
  const std::string file = folder_.write("file", "");
  for (const char* output : {"file/a", "file/none/a"}) {
    EXPECT_EQ(test::errorOf([&] { writeWhole(folder_ / output, [](std::ostream&) {}); }, ErrorCode::other),
              folder_ / output + ": cannot write: " + file + " is a file, not a folder; give another output");
    EXPECT_EQ(test::errorOf([&] { makeFolder(folder_ / output); }, ErrorCode::usage),
              folder_ / output + ": is to be a folder, but " + file + " is a file; give another output");
  }
  EXPECT_THAT(test::errorOf([&] { makeFolder(file); }, ErrorCode::usage), HasSubstr("but it is a file"));
}

TEST_F(WholeFile, RefusesFoldersAndDevices) {
  EXPECT_THAT(test::errorOf([&] { writeWhole(folder_.path(), [](std::ostream&) {}); }, ErrorCode::other),
              HasSubstr("a folder of that name exists"));
  EXPECT_THAT(test::errorOf([] { writeWhole("/dev/full", [](std::ostream&) {}); }, ErrorCode::other),
              HasSubstr("not a regular file"));
}

TEST_F(WholeFile, NamesAMissingPermission) {
  fs::permissions(folder_.path(), fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                                      fs::perms::others_exec);
  const uid_t user = geteuid();
  constexpr uid_t kNobody = 65534;  // root may write everywhere
  ASSERT_EQ(seteuid(user == 0 ? kNobody : user), 0);
  const std::string error =
      test::errorOf([&] { writeWhole(folder_ / "a", [](std::ostream&) {}); }, ErrorCode::other);
  ASSERT_EQ(seteuid(user), 0);
  EXPECT_THAT(error, HasSubstr("Permission denied"));
  fs::permissions(folder_.path(), fs::perms::owner_all);
}

TEST_F(WholeFile, IsRemovedWhenTheDiskIsFull) {
  const test::FileSizeLimit limit(100000);
  for (const int bytes : {150000, 3000000}) {
    const std::string text(static_cast<std::size_t>(bytes), 'x');
    EXPECT_THAT(
        test::errorOf([&] { writeWhole(folder_ / "a", [&](std::ostream& stream) { stream << text; }); },
                      ErrorCode::other),
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

TEST_F(WholeFile, TheNameMayBeAsLongAsTheFileSystemAllows) {
  std::string name = "1";
  while (name.size() < 251) name += "\u00e9";
  const std::string one = folder_ / (name + "1.a"), two = folder_ / (name + "2.a");
  const auto write = [](std::ostream& stream) { stream << "text"; };
  writeWhole({{one, write}, {two, write}});
  EXPECT_EQ(textOf(one), "text");
  EXPECT_EQ(textOf(two), "text");
  EXPECT_EQ(filesInFolder(), 2);
}

TEST_F(WholeFile, PatchesReplaceBytesWhereTheyLie) {
  writeWhole(folder_ / "a", [](std::ostream& stream) { stream << "0123456789"; });
  patchFile(folder_ / "a", {{2, "xy"}, {9, "z"}});
  EXPECT_EQ(textOf(folder_ / "a"), "01xy45678z");
  EXPECT_THAT(test::errorOf(
                  [&] {
                    patchFile(folder_ / "none", {{0, "x"}});
                  },
                  ErrorCode::other),
              HasSubstr("none: cannot write: No such file or directory"));
}

TEST_F(WholeFile, AppendingMakesTheFileAndAddsToIt) {
  AppendedFile(folder_ / "a").append("one\n");
  AppendedFile(folder_ / "a").append("two\n");
  EXPECT_EQ(textOf(folder_ / "a"), "one\ntwo\n");
  AppendedFile cut(folder_ / "a");
  cut.cut(4);
  cut.append("three\n");
  EXPECT_EQ(textOf(folder_ / "a"), "one\nthree\n");
  EXPECT_THAT(test::errorOf([&] { AppendedFile(folder_ / "none/a"); }, ErrorCode::other),
              HasSubstr("cannot write"));
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

TEST_F(WholeFile, APipeIsReadToItsEnd) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  ASSERT_EQ(write(ends[1], "script", 6), 6);
  close(ends[1]);
  EXPECT_EQ(readTextOrPipe("/dev/fd/" + std::to_string(ends[0])), "script");
  close(ends[0]);
  EXPECT_THAT(test::errorOf([&] { readTextOrPipe(folder_ / "none"); }, ErrorCode::bad_input),
              HasSubstr("none: there is no such file"));
}

}  // namespace
}  // namespace emscape
