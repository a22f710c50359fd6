// Locks where the file system cannot lock files, as NFS without its daemon and some parallel ones.
#include "base/files/folder_lock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>

#include "tests/support/errors.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace {
/// What flock() of this program fails with; 0: it works.
std::atomic<int> flock_error{0};
}  // namespace

// Instead of the C library's, for all of the program.
extern "C" int flock(int descriptor, int operation) {
  if (flock_error != 0) {
    errno = flock_error;
    return -1;
  }
  return static_cast<int>(::syscall(SYS_flock, descriptor, operation));
}

namespace emscape {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class LockWithoutFlock : public testing::TestWithParam<int> {
 protected:
  LockWithoutFlock() { flock_error = GetParam(); }
  ~LockWithoutFlock() override { flock_error = 0; }

  const test::TemporaryFolder folder_;
};

TEST_P(LockWithoutFlock, IsHeldByTheProcessThatCreatesTheFile) {
  {
    const FolderLock first(folder_.path(), "a.lock");
    EXPECT_THAT(folder_.files(), ElementsAre("a.lock"));
    EXPECT_EQ(FolderLock::tryLock(folder_.path(), "a.lock"), nullptr);
    EXPECT_THAT(folder_.files(), ElementsAre("a.lock")) << "the refused one removes nothing";
    const std::string error = test::errorOf([&] { FolderLock(folder_.path(), "a.lock"); }, ErrorCode::other);
    EXPECT_THAT(error, AllOf(HasSubstr("process " + std::to_string(::getpid()) + " on "),
                             HasSubstr("if that process has ended, remove " + (folder_ / "a.lock"))));
  }
  EXPECT_THAT(folder_.files(), IsEmpty());
  EXPECT_NE(FolderLock::tryLock(folder_.path(), "a.lock"), nullptr);
}

TEST_P(LockWithoutFlock, LeavesAFileThatIsNoLock) {
  folder_.write("a.lock", "of the user");
  EXPECT_THAT(test::errorOf([&] { FolderLock(folder_.path(), "a.lock"); }, ErrorCode::other),
              HasSubstr("that is no lock of emscape"));
  EXPECT_EQ(test::readFile(folder_ / "a.lock"), "of the user");
}

TEST_P(LockWithoutFlock, NamesAnEmptyFileThatMayBeALock) {
  folder_.write("a.lock", "");
  EXPECT_THAT(test::errorOf([&] { FolderLock(folder_.path(), "a.lock"); }, ErrorCode::other),
              HasSubstr("if a killed process has left it, remove it"));
}

/// A lock that could not be written would block its folder once its process is killed.
TEST(FolderLock, IsNotHeldOnAFullDisk) {
  const test::TemporaryFolder folder;
  {
    const test::FileSizeLimit full(0);
    EXPECT_THAT(test::errorOf([&] { FolderLock(folder.path(), "a.lock"); }, ErrorCode::other),
                HasSubstr("a.lock: cannot write: "));
  }
  EXPECT_THAT(folder.files(), IsEmpty());
  EXPECT_NE(FolderLock::tryLock(folder.path(), "a.lock"), nullptr);
}

INSTANTIATE_TEST_SUITE_P(Causes, LockWithoutFlock, testing::Values(ENOLCK, ENOSYS, EOPNOTSUPP, EIO));

}  // namespace
}  // namespace emscape
