#include "base/files/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>
#include <utility>

#include "emscape/base/error.h"

namespace emscape {
namespace fs = std::filesystem;
namespace {

/// Begins the content of every lock.
const std::string kLockWords = "lock of emscape, ";
/// For a process that has created a lock to write it.
constexpr int kAttempts = 50;
constexpr std::chrono::milliseconds kBetweenAttempts{10};

/// The beginning of a lock's content.
std::string contentOf(const Descriptor& lock) {
  std::string text(kLockWords.size() + 300, '\0');
  const ssize_t bytes = ::pread(lock.number(), text.data(), text.size(), 0);
  text.resize(bytes > 0 ? static_cast<std::size_t>(bytes) : 0);
  return text;
}

bool isLock(const std::string& content) {
  return content.rfind(kLockWords, 0) == 0;
}

/// True if the open file is still the one of that name: its holder removes it.
bool isNamed(const Descriptor& open, const Descriptor& folder, const fs::path& file) {
  struct stat held {
  }, named{};
  return ::fstat(open.number(), &held) == 0 &&
         ::fstatat(folder.number(), file.filename().c_str(), &named, AT_SYMLINK_NOFOLLOW) == 0 &&
         held.st_ino == named.st_ino && held.st_dev == named.st_dev;
}

}  // namespace

FolderLock::FolderLock(fs::path file) : file_(std::move(file)), folder_(openFolderOf(file_)) {}

FolderLock::FolderLock(const fs::path& folder, const std::string& name) : FolderLock(folder / name) {
  std::string holder;
  if (!lock(holder)) {
    throw Error(ErrorCode::other, {folder.string()}, "another process writes this folder: " + holder);
  }
}

std::unique_ptr<FolderLock> FolderLock::tryLock(const fs::path& folder, const std::string& name) {
  std::unique_ptr<FolderLock> result(new FolderLock(folder / name));
  std::string holder;
  if (!result->lock(holder)) return nullptr;
  return result;
}

bool FolderLock::lock(std::string& holder) {
  for (int attempts_left = kAttempts; !descriptor_.isOpen();) {
    Descriptor found = createFile(folder_, file_, O_RDWR);
    const bool is_new = found.isOpen();
    if (!is_new) found = openFile(folder_, file_, O_RDWR);
    if (!found.isOpen()) continue;  // removed between the two calls
    const int cause = ::flock(found.number(), is_new ? LOCK_EX : LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
    const std::string content = contentOf(found);
    if (cause != 0 && cause != EWOULDBLOCK) {
      // Files cannot be locked on this file system: the process that has created the file holds the lock.
      if (!is_new && content.empty() && attempts_left-- > 0) {
        found.close();
        std::this_thread::sleep_for(kBetweenAttempts);
        continue;
      }
      if (!is_new && isLock(content)) {
        holder = content.substr(kLockWords.size()) + "; files cannot be locked here (" + causeOf(cause) +
                 "): if that process has ended, remove " + file_.string();
        return false;
      }
    } else if (cause != 0) {
      holder = isLock(content) ? content.substr(kLockWords.size()) : "not known which";
      return false;
    }
    if (!isNamed(found, folder_, file_)) continue;
    if (!is_new && content.empty() && attempts_left-- > 0) {
      found.close();  // the process that created it is about to lock it
      std::this_thread::sleep_for(kBetweenAttempts);
      continue;
    }
    // An empty file that could be locked is held by nobody: of a program that was killed before it wrote its
    // name, or of the user. It is used, and left empty.
    was_empty_ = !is_new && content.empty() && cause == 0;
    if (!is_new && !isLock(content) && !was_empty_) {
      failWriting(file_,
                  "a file of that name exists that is no lock of emscape; " +
                      std::string(content.empty() ? "it is empty: if a killed process has left it, remove it"
                                                  : "use another folder"));
    }
    descriptor_ = std::move(found);
  }
  char host[256] = "?";
  ::gethostname(host, sizeof host - 1);
  const std::string own = kLockWords + "process " + std::to_string(::getpid()) + " on " + host;
  // A lock without its words would be taken for a file of the user after this process is killed.
  try {
    if (::ftruncate(descriptor_.number(), 0) != 0) failWriting(file_, causeOf(errno));
    writeBytes(descriptor_, own, file_);
  } catch (const Error&) {
    remove();
    descriptor_.close();
    throw;
  }
  return true;
}

void FolderLock::remove() {
  if (was_empty_ && ::ftruncate(descriptor_.number(), 0) == 0) return;
  ::unlinkat(folder_.number(), file_.filename().c_str(), 0);
}

FolderLock::~FolderLock() {
  if (descriptor_.isOpen()) remove();
}

}  // namespace emscape
