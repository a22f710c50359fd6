#include "base/files/descriptor.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "base/files/folder.h"
#include "emscape/base/error.h"

namespace emscape {
namespace fs = std::filesystem;

std::string causeOf(int error_number) {
  return error_number == 0 ? "the system gives no cause" : std::generic_category().message(error_number);
}

void failWriting(const fs::path& file, const std::string& cause) {
  throw Error(ErrorCode::other, {file.string()}, "cannot write: " + cause);
}

void failExisting(const fs::path& file) {
  throw Error(ErrorCode::usage, file.string() + " exists; --force replaces it, another name keeps it");
}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  close();
  number_ = other.release();
  return *this;
}

void Descriptor::close() {
  if (number_ >= 0) ::close(number_);
  number_ = -1;
}

int Descriptor::release() {
  return std::exchange(number_, -1);
}

Descriptor openFolderOf(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  // A folder may be writable without being readable.
  if (!opened.isOpen() && errno == EACCES) {
    opened = Descriptor(::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  }
  if (opened.isOpen()) return opened;
  if (errno == ENOTDIR)
    failWriting(file, fileInPath(folder).string() + " is a file, not a folder; give another output");
  failWriting(file, errno == ENOENT ? "the folder " + folder.string() + " does not exist" : causeOf(errno));
}

Descriptor createFile(const Descriptor& folder, const fs::path& file, int flags) {
  Descriptor created(::openat(folder.number(), file.filename().c_str(),
                              flags | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
  if (!created.isOpen() && errno != EEXIST) failWriting(file, causeOf(errno));
  return created;
}

Descriptor openFile(const Descriptor& folder, const fs::path& file, int flags) {
  // O_NONBLOCK: a pipe without a reader is refused instead of waited for.
  Descriptor opened(
      ::openat(folder.number(), file.filename().c_str(), flags | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (!opened.isOpen()) {
    if (errno == ENOENT) return opened;
    failWriting(file, errno == ELOOP ? "it is a symbolic link, which is not followed" : causeOf(errno));
  }
  struct stat status {};
  if (::fstat(opened.number(), &status) != 0) failWriting(file, causeOf(errno));
  if (!S_ISREG(status.st_mode)) failWriting(file, "it is not a regular file");
  if (status.st_nlink > 1)
    failWriting(file, "the file has a second name (hard link), which would change with it");
  return opened;
}

Descriptor openOrCreateFile(const fs::path& file, int flags) {
  const Descriptor folder = openFolderOf(file);
  for (;;) {  // other processes may create and remove the file meanwhile
    if (Descriptor created = createFile(folder, file, flags); created.isOpen()) return created;
    if (Descriptor opened = openFile(folder, file, flags); opened.isOpen()) return opened;
  }
}

void writeBytes(const Descriptor& descriptor, const std::string& bytes, const fs::path& file) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t written = ::write(descriptor.number(), bytes.data() + done, bytes.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) failWriting(file, causeOf(errno));
    done += static_cast<std::size_t>(written);
  }
}

void syncFile(const Descriptor& descriptor, const fs::path& file) {
  if (::fsync(descriptor.number()) != 0) failWriting(file, causeOf(errno));
}

}  // namespace emscape
