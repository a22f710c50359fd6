// Links in output folders: whatever this program locks, appends to or changes in place, it follows none.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "base/files/appended_file.h"
#include "base/files/file_patch.h"
#include "base/files/folder.h"
#include "base/files/folder_lock.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Each way to open a file under a fixed name for writing.
const std::vector<std::function<void(const fs::path&)>>& writers() {
  static const std::vector<std::function<void(const fs::path&)>> kWriters{
      [](const fs::path& file) { FolderLock(file.parent_path(), file.filename()); },
      [](const fs::path& file) { FolderLock::tryLock(file.parent_path(), file.filename()); },
      [](const fs::path& file) { AppendedFile(file).append("line\n"); },
      [](const fs::path& file) {
        patchFile(file, {{0, "XX"}});
      }};
  return kWriters;
}

TEST(OutputLinks, AreRefusedByName) {
  const test::TemporaryFolder folder;
  const fs::path victim = folder.write("victim", "precious");
  const auto refusalOf = [&](const std::string& name) {
    std::string common;
    for (const auto& write : writers()) {
      const std::string error = test::errorOf([&] { write(folder.path() / name); }, ErrorCode::other);
      EXPECT_TRUE(common.empty() || error == common) << error;
      common = error;
      EXPECT_EQ(test::readFile(victim), "precious");
    }
    return common;
  };
  fs::create_symlink("victim", folder.path() / "relative");
  EXPECT_EQ(refusalOf("relative"),
            folder / "relative" + ": cannot write: it is a symbolic link, which is not followed");
  fs::create_symlink(victim, folder.path() / "absolute");
  EXPECT_THAT(refusalOf("absolute"), HasSubstr("symbolic link"));
  fs::create_symlink("none", folder.path() / "dangling");
  EXPECT_THAT(refusalOf("dangling"), HasSubstr("symbolic link"));
  EXPECT_FALSE(fs::exists(folder.path() / "none"));
  fs::create_hard_link(victim, folder.path() / "hard");
  EXPECT_THAT(refusalOf("hard"), HasSubstr("hard link"));
}

TEST(OutputLinks, PipesAndFoldersAreRefused) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_directory(folder / "folder");
  for (const auto& write : writers()) {
    for (const std::string name : {"pipe", "folder"}) {
      EXPECT_THAT(test::errorOf([&] { write(folder.path() / name); }, ErrorCode::other),
                  AllOf(HasSubstr(folder / name), HasSubstr("cannot write")));
    }
  }
}

TEST(OutputLinks, InnerFoldersAreNotLinks) {
  const test::TemporaryFolder folder;
  fs::create_directories(folder / "elsewhere/b");
  fs::create_directories(folder / "out");
  fs::create_symlink("../elsewhere", folder / "out/a");
  for (const char* const inner : {"a", "a/b", "a/new"}) {
    EXPECT_EQ(test::errorOf([&] { makeFolderIn(folder / "out", inner); }, ErrorCode::other),
              folder / "out/a" + ": cannot make the folder: it is a symbolic link, which is not followed");
  }
  EXPECT_FALSE(fs::exists(folder / "elsewhere/new"));
  fs::create_symlink("out", folder / "named by the user");
  EXPECT_EQ(makeFolderIn(folder / "named by the user", "b/c"), folder / "named by the user/b/c");
  EXPECT_TRUE(fs::is_directory(folder / "out/b/c"));
}

TEST(FolderLock, IsHeldByOneAndRemovedWithIt) {
  const test::TemporaryFolder folder;
  {
    const FolderLock lock(folder.path(), "a.lock");
    EXPECT_EQ(FolderLock::tryLock(folder.path(), "a.lock"), nullptr);
    char host[256] = "";
    gethostname(host, sizeof host - 1);
    EXPECT_EQ(test::errorOf([&] { FolderLock(folder.path(), "a.lock"); }, ErrorCode::other),
              folder.path().string() + ": another process writes this folder: process " +
                  std::to_string(getpid()) + " on " + host);
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(FolderLock, OfAKilledProcessIsTakenOver) {
  const test::TemporaryFolder folder;
  const pid_t process = fork();
  if (process == 0) {
    const FolderLock lock(folder.path(), "a.lock");
    _exit(0);  // without destructors
  }
  waitpid(process, nullptr, 0);
  ASSERT_THAT(folder.files(), ElementsAre("a.lock"));
  { const FolderLock lock(folder.path(), "a.lock"); }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(FolderLock, AFileOfTheUserWithItsNameIsLeftAsItIs) {
  const test::TemporaryFolder folder;
  folder.write("a.lock", "of another program");
  EXPECT_EQ(test::errorOf([&] { FolderLock(folder.path(), "a.lock"); }, ErrorCode::other),
            folder / "a.lock" +
                ": cannot write: a file of that name exists that is no lock of emscape; use another folder");
  EXPECT_EQ(test::readFile(folder / "a.lock"), "of another program");
}

/// A process that was killed between creating and writing its lock has left it, or the user.
TEST(FolderLock, AnEmptyFileThatNobodyHoldsIsUsedAndStaysEmpty) {
  const test::TemporaryFolder folder;
  folder.write("a.lock", "");
  {
    const FolderLock lock(folder.path(), "a.lock");
    EXPECT_THAT(test::readFile(folder / "a.lock"), HasSubstr("lock of emscape, process "));
    EXPECT_EQ(FolderLock::tryLock(folder.path(), "a.lock"), nullptr);
  }
  EXPECT_EQ(test::readFile(folder / "a.lock"), "");
  const int holder = open((folder / "a.lock").c_str(), O_RDWR);
  flock(holder, LOCK_EX);  // as by flock(1)
  EXPECT_EQ(FolderLock::tryLock(folder.path(), "a.lock"), nullptr);
  close(holder);
}

TEST(FolderLock, OneOfManyProcessesGetsIt) {
  const test::TemporaryFolder folder;
  constexpr int kProcesses = 16;
  std::vector<pid_t> processes;
  for (int n = 0; n < kProcesses; ++n) {
    processes.push_back(fork());
    if (processes.back() != 0) continue;
    int held = 0;
    try {
      while (held < 20) {
        if (const auto lock = FolderLock::tryLock(folder.path(), "a.lock")) {
          const int number = open((folder / "held").c_str(), O_CREAT | O_EXCL | O_WRONLY, 0600);
          if (number < 0) _exit(1);  // another one holds it too
          close(number);
          unlink((folder / "held").c_str());
          ++held;
        }
      }
    } catch (const std::exception& error) {
      fprintf(stderr, "%s\n", error.what());
      _exit(2);
    }
    _exit(0);
  }
  for (const pid_t process : processes) {
    int status = 0;
    waitpid(process, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace emscape
