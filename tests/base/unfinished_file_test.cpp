// What a killed process leaves of its unfinished files, and what only resembles it.
#include "base/files/unfinished_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/files/whole_file.h"
#include "emscape/base/error.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/unfinished_files.h"

namespace emscape {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

using test::leaveUnfinished;

TEST(UnfinishedFile, IsInAFolderOfItsOwnThatOtherUsersCannotEnter) {
  const test::TemporaryFolder folder;
  UnfinishedFile file(folder / "a.tif");
  const fs::path own = file.temporary().parent_path();
  EXPECT_EQ(file.temporary().filename(), "a.tif");
  EXPECT_TRUE(file.temporary().is_absolute());
  EXPECT_THAT(own.filename().string(), StartsWith("emscape.part-"));
  EXPECT_EQ(fs::status(own).permissions(), fs::perms::owner_all);
  EXPECT_NE(UnfinishedFile(folder / "a.tif").temporary(), file.temporary());
}

TEST(UnfinishedFile, IsPublishedWithTheFileBesideIt) {
  const test::TemporaryFolder folder;
  for (const bool has_labels : {true, false}) {
    UnfinishedFile file(folder / "a.tif");
    test::writeFile(file.temporary(), "raster");
    if (has_labels) test::writeFile(file.temporary().string() + ".aux.xml", "labels");
    file.publish(".aux.xml");
    if (has_labels) {
      EXPECT_THAT(folder.files(), ElementsAre("a.tif", "a.tif.aux.xml"));
    } else {
      EXPECT_THAT(folder.files(), ElementsAre("a.tif")) << "the labels of the earlier file";
    }
  }
}

TEST(UnfinishedFile, IsNotPublishedOverAFileOfTheUserBesideTheFormerOne) {
  const test::TemporaryFolder folder;
  for (const bool has_former : {false, true}) {
    for (const bool has_labels : {true, false}) {
      if (has_former) {
        UnfinishedFile former(folder / "a.tif");
        test::writeFile(former.temporary(), "former");
        former.publish(".aux.xml");
      }
      UnfinishedFile file(folder / "a.tif");
      test::writeFile(file.temporary(), "raster");
      if (has_labels) test::writeFile(file.temporary().string() + ".aux.xml", "labels");
      folder.write("a.tif.aux.xml", "statistics");
      EXPECT_THAT(test::errorOf([&] { file.publish(".aux.xml"); }, ErrorCode::usage),
                  testing::HasSubstr("a.tif.aux.xml: is a file that emscape did not write"));
      EXPECT_EQ(test::readFile(folder / "a.tif.aux.xml"), "statistics");
      EXPECT_EQ(fs::exists(folder / "a.tif"), has_former);
      fs::remove(folder / "a.tif.aux.xml");
    }
  }
}

// Libraries would write -1 into the file.
TEST(UnfinishedFile, ThatDoesNotKnowItsPositionFails) {
  const test::TemporaryFolder folder;
  int pipe[2];
  ASSERT_EQ(::pipe(pipe), 0);
  const auto write = [&] {
    UnfinishedFile file(folder / "a.vdb");
    file.write([&](std::ostream& out) {
      EXPECT_EQ((out << "values").tellp(), 6);
      for (const fs::directory_entry& entry : fs::directory_iterator("/proc/self/fd")) {
        std::error_code is_closed;
        if (fs::read_symlink(entry, is_closed) == file.temporary())
          ::dup2(pipe[1], std::stoi(entry.path().filename()));  // has no position
      }
      static_cast<void>(out.tellp());
    });
  };
  EXPECT_THAT(test::errorOf(write, ErrorCode::other), HasSubstr("a.vdb: cannot write: Illegal seek"));
  EXPECT_THAT(folder.files(), IsEmpty());
  ::close(pipe[0]);
  ::close(pipe[1]);
}

TEST(UnfinishedFile, LeavesNothingWhenDescriptorsRunOut) {
  const test::TemporaryFolder folder;
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &limit), 0);
  const int next = ::dup(0);  // the lowest free number
  ASSERT_GE(next, 0);
  ::close(next);
  for (int more = 0; more < 4; ++more) {
    const rlimit few{static_cast<rlim_t>(next + more), limit.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
    std::string error;
    try {
      const UnfinishedFile file(folder / "a.tif");
    } catch (const Error& failed) {
      error = failed.what();
    }
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &limit), 0);
    if (more < 3) {
      EXPECT_THAT(error, AllOf(HasSubstr("a.tif"), HasSubstr("Too many open files"))) << more;
    }
    EXPECT_THAT(folder.files(), IsEmpty()) << more;
  }
}

TEST(UnfinishedFile, LeavesNothingUnlessPublished) {
  const test::TemporaryFolder folder;
  {
    UnfinishedFile file(folder / "a.gpkg");
    test::writeFile(file.temporary(), "half");
    test::writeFile(file.temporary().string() + "-journal", "of a library");
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(UnfinishedFile, OfAKilledProcessIsRemovedByTheNext) {
  const test::TemporaryFolder folder;
  leaveUnfinished(folder / "a.vdb");
  ASSERT_FALSE(fs::is_empty(folder.path()));
  const UnfinishedFile running(folder / "b.vdb");
  EXPECT_EQ(removeAbandonedFiles(folder.path()), 1);
  EXPECT_TRUE(fs::exists(running.temporary().parent_path())) << "its writer runs";
  EXPECT_EQ(removeAbandonedFiles(folder.path()), 0);
  EXPECT_EQ(removeAbandonedFiles(folder / "none"), 0);
}

TEST(UnfinishedFile, ThatCannotBeProvedToBeOneIsKept) {
  const test::TemporaryFolder folder;
  std::vector<std::string> files{"backup.tar.gz.part-07",
                                 "archive.zip.part-99999",
                                 "Holiday film.part-22222.aux.xml",
                                 "notes.part-31337-journal",
                                 "emscape.part-abcdefghijkl",
                                 "emscape.part-aaaaaaaaaaaa/thesis.tex",
                                 "emscape.part-bbbbbbbbbbbb/emscape.record"};
  for (const std::string& file : files) folder.write(file, "of the user");
  const fs::path empty = folder.path() / "emscape.part-cccccccccccc",
                 linked = folder.path() / "emscape.part-dddddddddddd";
  fs::create_directory(empty);
  // A copy of what a killed process has left, and a link to it.
  const test::TemporaryFolder other;
  leaveUnfinished(other / "a.vdb");
  const fs::path left = fs::directory_iterator(other.path())->path();
  fs::copy(left, folder.path() / "emscape.part-eeeeeeeeeeee", fs::copy_options::recursive);
  fs::create_directory_symlink(left, linked);
  const std::vector<std::string> before = folder.files();
  EXPECT_EQ(removeAbandonedFiles(folder.path()), 0);
  EXPECT_EQ(folder.files(), before);
  EXPECT_TRUE(fs::exists(empty));
  EXPECT_TRUE(fs::is_symlink(linked));
  EXPECT_EQ(removeAbandonedFiles(other.path()), 1);
}

TEST(UnfinishedFile, ReplacesALinkOfItsNameAndNotWhatItNames) {
  const test::TemporaryFolder folder;
  folder.write("victim", "precious");
  fs::create_symlink("victim", folder.path() / "a.png");
  const auto write = [](std::ostream& stream) { stream << "picture"; };
  EXPECT_THAT(test::errorOf([&] { writeWhole(folder / "a.png", write); }, ErrorCode::usage),
              HasSubstr("a.png: is a link"));
  EXPECT_TRUE(fs::is_symlink(folder.path() / "a.png"));
  writeWhole(folder / "a.png", write, Replaces::any);
  EXPECT_EQ(test::readFile(folder / "victim"), "precious");
  EXPECT_EQ(test::readFile(folder / "a.png"), "picture");
  EXPECT_FALSE(fs::is_symlink(folder.path() / "a.png"));
}

}  // namespace
}  // namespace emscape
