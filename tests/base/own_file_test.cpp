// Files that this program wrote: told from those of the user, and from its own that the user changed.
#include "base/files/own_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/xattr.h>

#include <chrono>
#include <memory>
#include <thread>

#include "base/files/file_patch.h"
#include "base/files/unfinished_file.h"
#include "base/files/whole_file.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class OwnFile : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    writeWhole(folder_ / name, [&](std::ostream& stream) { stream << text; });
  }

  test::TemporaryFolder folder_;
};

TEST_F(OwnFile, IsOneThatWasWrittenAndNotChanged) {
  write("a", "one");
  EXPECT_TRUE(isOwn(folder_ / "a"));
  write("a", "two");
  EXPECT_TRUE(isOwn(folder_ / "a"));
  const fs::file_time_type time = fs::last_write_time(folder_ / "a");
  for (const char* const changed : {"two, and mine", "own"}) {
    test::writeFile(folder_ / "a", changed);
    fs::last_write_time(folder_ / "a", time);
    EXPECT_FALSE(isOwn(folder_ / "a"));
  }
  test::writeFile(folder_ / "a", "two");
  EXPECT_TRUE(isOwn(folder_ / "a"));
  patchFile(folder_ / "a", {{0, "T"}});
  EXPECT_TRUE(isOwn(folder_ / "a")) << "changed by this program";
  EXPECT_EQ(test::readFile(folder_ / "a"), "Two");
}

// The second time it is not read, unless it was changed.
TEST_F(OwnFile, SLOW_IsLookedAtAgainAfterAChangeThatKeepsSizeAndTime) {
  write("a", "one");
  const fs::file_time_type time = fs::last_write_time(folder_ / "a");
  std::this_thread::sleep_for(std::chrono::milliseconds(4100));
  for (int n = 0; n < 2; ++n) EXPECT_TRUE(isOwn(folder_ / "a"));
  test::writeFile(folder_ / "a", "own");
  fs::last_write_time(folder_ / "a", time);
  EXPECT_FALSE(isOwn(folder_ / "a"));
}

TEST_F(OwnFile, HasItsDigestInItsRecord) {
  write("a", "one");
  EXPECT_EQ(recordedDigestOf(folder_ / "a"), digestOf(folder_ / "a"));
  folder_.write("users", "mine");
  EXPECT_EQ(recordedDigestOf(folder_ / "users"), digestOf(folder_ / "users"));
}

TEST_F(OwnFile, IsNotOneOfTheUserNorALinkToAnOwn) {
  folder_.write("users", "mine");
  folder_.write("empty", "");
  write("a", "one");
  fs::create_symlink("a", folder_ / "link");
  fs::create_directory(folder_ / "folder");
  EXPECT_FALSE(isOwn(folder_ / "users"));
  EXPECT_TRUE(isOwn(folder_ / "empty"));
  EXPECT_FALSE(isOwn(folder_ / "link"));
  fs::create_symlink("nothing", folder_ / "dangling");
  for (const char* const link : {"link", "dangling"})
    EXPECT_THAT(test::errorOf([&] { write(link, "two"); }, ErrorCode::usage), HasSubstr("is a link"));
  EXPECT_FALSE(isOwn(folder_ / "folder"));
  EXPECT_NO_THROW(requireOwn(folder_ / "none"));
  EXPECT_THAT(
      test::errorOf([&] { write("users", "two"); }, ErrorCode::usage),
      HasSubstr(folder_ / "users" + ": is a file that emscape did not write, or has no record of having "
                                    "written (of an earlier version, copied, or changed since); move it "
                                    "away first, or give another output"));
  EXPECT_EQ(test::readFile(folder_ / "users"), "mine");
}

// The user may write a file of that name while the output is made, which may have taken hours.
TEST_F(OwnFile, IsKeptUnderAFreeNameIfItsNameWasTakenMeanwhile) {
  folder_.write("a-2.txt", "mine, too");
  const auto slow = [&](std::ostream& stream) {
    stream << "output";
    folder_.write("a.txt", "mine");
  };
  EXPECT_THAT(test::errorOf([&] { writeWhole(folder_ / "a.txt", slow); }, ErrorCode::usage),
              testing::AllOf(HasSubstr("/a.txt: is a file that emscape did not write"),
                             HasSubstr("; the new one is kept as " + (folder_ / "a-3.txt"))));
  EXPECT_EQ(test::readFile(folder_ / "a.txt"), "mine");
  EXPECT_EQ(test::readFile(folder_ / "a-2.txt"), "mine, too");
  EXPECT_EQ(test::readFile(folder_ / "a-3.txt"), "output");
  EXPECT_TRUE(isOwn(folder_ / "a-3.txt"));
  EXPECT_EQ(folder_.files().size(), 3u) << "nothing unfinished";
}

// QGIS changes the header of a GeoPackage that it only shows.
TEST_F(OwnFile, IsADatabaseOfWhichOnlyTheHeaderWasChanged) {
  const std::string begin("SQLite format 3\0", 16);
  write("a.gpkg", begin + std::string(84, '1') + "tables");
  test::writeFile(folder_ / "a.gpkg", begin + std::string(84, '2') + "tables");
  EXPECT_TRUE(isOwn(folder_ / "a.gpkg"));
  test::writeFile(folder_ / "a.gpkg", begin + std::string(84, '2') + "tables, and a layer");
  EXPECT_FALSE(isOwn(folder_ / "a.gpkg"));
}

/// Fills the space for attributes of a file. @return false where there is no end of it
bool fillAttributes(const std::string& file) {
  int number = 0;
  for (std::size_t bytes = 2048; bytes > 0; bytes /= 2) {
    const std::string value(bytes, 'x');
    while (::setxattr(file.c_str(), fmt::format("user.fill{}", number).c_str(), value.data(), bytes, 0) ==
           0) {
      if (++number > 100) return false;
    }
  }
  return true;
}

TEST_F(OwnFile, IsNoDatabaseWithChangesBesideIt) {
  UnfinishedFile database(folder_ / "a.gpkg");
  test::writeFile(database.temporary(), "SQLite format 3");
  database.publish();
  const fs::path file = folder_ / "a.gpkg", changes = folder_ / "a.gpkg-wal";
  EXPECT_TRUE(isOwn(file));
  test::writeFile(changes, "");
  EXPECT_TRUE(isOwn(file));
  test::writeFile(changes, "a table");
  EXPECT_FALSE(isOwn(file));
}

TEST_F(OwnFile, IsListedInItsFolderIfItsAttributeCannotBeWritten) {
  const std::string file = folder_ / "a", list = folder_ / ".emscape-files";
  test::writeFile(list, "torn");
  for (const char* const text : {"one", "two"}) {
    folder_.write("a", text);
    if (!fillAttributes(file)) GTEST_SKIP() << "attributes have no end here";
    EXPECT_FALSE(isOwn(file));
    patchFile(file, {{1, "NE"}});
    EXPECT_TRUE(isOwn(file));
  }
  EXPECT_EQ(test::readFile(list), "torn\n3 c4f5ce0a a\n") << "one line";
  EXPECT_EQ(recordedDigestOf(file), digestOf(file)) << "not that of the former content";
  test::writeFile(list, "3 c4f5ce0a a\n12345678 11111111 a b\n9 22222222 a\n");
  patchFile(file, {{0, "T"}});
  EXPECT_TRUE(isOwn(file));
  EXPECT_EQ(test::readFile(list), "12345678 11111111 a b\n3 fcb888ea a\n") << "of a shorter text";
  patchFile(file, {{0, "t"}});
  fs::copy_file(file, folder_ / "b");
  EXPECT_FALSE(isOwn(folder_ / "b")) << "of another name";
  test::writeFile(file, "tWO");
  EXPECT_FALSE(isOwn(file));
}

TEST_F(OwnFile, IsReplacedByAnotherContentWhereThereAreNoAttributes) {
  const std::string place = folder_ / "mounted";
  fs::create_directory(place);
  if (::mount("none", place.c_str(), "ramfs", 0, nullptr) != 0) GTEST_SKIP() << "nothing may be mounted";
  const auto unmount = [](const std::string* mounted) { ::umount2(mounted->c_str(), MNT_DETACH); };
  const std::unique_ptr<const std::string, decltype(unmount)> mounted(&place, unmount);
  for (const std::string text : {"one", "two, longer", "three"}) {
    EXPECT_NO_THROW(write("mounted/a", text));
    EXPECT_EQ(test::readFile(place + "/a"), text);
    EXPECT_TRUE(isOwn(place + "/a"));
  }
  test::writeFile(place + "/a", "mine");
  EXPECT_THAT(test::errorOf([&] { write("mounted/a", "four"); }, ErrorCode::usage),
              HasSubstr("/a: is a file"));
  EXPECT_EQ(test::readFile(place + "/a"), "mine");
}

TEST_F(OwnFile, IsNotToldByAListThatIsALinkOrTooLarge) {
  const std::string file = folder_.write("a", "one"), list = folder_ / ".emscape-files";
  const std::string line = "3 7a6c86f1 a\n";
  test::writeFile(list, line);
  ASSERT_TRUE(isOwn(file));
  fs::rename(list, folder_ / "list");
  fs::create_symlink("list", list);
  EXPECT_FALSE(isOwn(file));
  fs::remove(list);
  fs::rename(folder_ / "list", list);
  fs::resize_file(list, std::uintmax_t{100} << 30);  // a hole
  EXPECT_FALSE(isOwn(file));
  fs::remove(list);
  fs::create_directory(list);
  EXPECT_FALSE(isOwn(file));
}

TEST_F(OwnFile, ThatCanNeitherHaveAnAttributeNorBeListedIsWarnedOfOnce) {
  std::vector<std::string> warnings;
  setLogSink([&](LogLevel, const std::string& text) { warnings.push_back(text); });
  fs::create_directory(folder_ / ".emscape-files");
  bool is_full = true;
  for (const char* const name : {"a", "b"}) {
    folder_.write(name, "one");
    is_full = is_full && fillAttributes(folder_ / name);
    patchFile(folder_ / name, {{0, "O"}});
  }
  setLogSink(nullptr);
  if (!is_full) GTEST_SKIP() << "attributes have no end here";
  EXPECT_THAT(warnings,
              testing::ElementsAre(HasSubstr("/a and others of its folder will count as files of yours")));
}

}  // namespace
}  // namespace emscape
