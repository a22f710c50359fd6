#include "base/files/unfinished_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ext/stdio_filebuf.h>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "base/large_array.h"
#include "emscape/base/error.h"

namespace emscape {
namespace fs = std::filesystem;
namespace {

constexpr char kPrefix[] = "emscape.part-";
constexpr std::size_t kRandomLetters = 12;
constexpr char kRecordName[] = "emscape.record";

/// Unpredictable: the name may be in a folder of several users.
std::string newFolderName() {
  std::random_device random;  // of the system
  std::uniform_int_distribution<int> letter('a', 'z');
  std::string name = kPrefix;
  for (std::size_t n = 0; n < kRandomLetters; ++n) name += static_cast<char>(letter(random));
  return name;
}

bool mayBeOwnFolder(const std::string& name) {
  return name.size() == sizeof kPrefix - 1 + kRandomLetters && name.rfind(kPrefix, 0) == 0;
}

/// The content of the record; it names its folder, so that a copy elsewhere proves nothing.
std::string recordOf(const std::string& folder_name) {
  return "unfinished file of emscape in " + folder_name + "\n";
}

Descriptor openInnerFolder(const Descriptor& folder, const std::string& name) {
  return Descriptor(::openat(folder.number(), name.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
}

/// Removes the files of an inner folder, the record last, then the folder.
/// @param record  closed before it is removed: NFS would keep an open file under another name
/// @return false if something is left
bool removeInnerFolder(const Descriptor& folder, const std::string& name, const Descriptor& inner,
                       Descriptor record) {
  const int copy = ::fcntl(inner.number(), F_DUPFD_CLOEXEC, 0);
  const std::unique_ptr<DIR, int (*)(DIR*)> listing(copy < 0 ? nullptr : ::fdopendir(copy), ::closedir);
  std::vector<std::string> files;
  while (const dirent* const entry = listing == nullptr ? nullptr : ::readdir(listing.get())) {
    if (entry->d_name != std::string(kRecordName)) files.emplace_back(entry->d_name);
  }
  for (const std::string& file : files) ::unlinkat(inner.number(), file.c_str(), 0);
  record.close();
  ::unlinkat(inner.number(), kRecordName, 0);
  return ::unlinkat(folder.number(), name.c_str(), AT_REMOVEDIR) == 0;
}

/// True if a record proves that a killed process of this program has left its folder.
bool provesAbandoned(const Descriptor& record, const std::string& folder_name) {
  const std::string expected = recordOf(folder_name);
  std::string text(expected.size() + 1, '\0');
  const ssize_t bytes = ::pread(record.number(), text.data(), text.size(), 0);
  if (bytes != static_cast<ssize_t>(expected.size())) return false;
  text.resize(expected.size());
  return text == expected && ::flock(record.number(), LOCK_EX | LOCK_NB) == 0;
}

/// Refuses a name to which nothing can be renamed: renaming to a folder fails late, and renaming to a device
/// would replace it. Renaming would also replace a file that the user has protected.
void requireFileTarget(const fs::path& file) {
  std::error_code ignored;
  const fs::file_status status = fs::status(file, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    failWriting(file, fs::is_directory(status) ? "a folder of that name exists" : "it is not a regular file");
  }
  if (fs::exists(status) && ::faccessat(AT_FDCWD, file.c_str(), W_OK, AT_EACCESS) != 0)
    failWriting(file, causeOf(errno));
}

}  // namespace

UnfinishedFile::UnfinishedFile(fs::path file, Replaces replaces)
    : file_(std::move(file)), replaces_(replaces), folder_(openFolderOf(file_)) {
  requireFileTarget(file_);
  if (replaces_ == Replaces::own) requireOwn(file_);
  try {
    makeOwnFolder();
  } catch (...) {
    removeOwnFolder();
    throw;
  }
  temporary_ = fs::absolute(file_).parent_path() / own_name_ / file_.filename();
}

UnfinishedFile::~UnfinishedFile() {
  removeOwnFolder();
}

void UnfinishedFile::makeOwnFolder() {
  int failed = 0;
  do {
    own_name_ = newFolderName();
    failed = ::mkdirat(folder_.number(), own_name_.c_str(), 0700);
  } while (failed != 0 && errno == EEXIST);
  if (failed == 0) own_folder_ = openInnerFolder(folder_, own_name_);
  if (!own_folder_.isOpen()) {
    const int cause = errno;
    if (failed == 0) ::unlinkat(folder_.number(), own_name_.c_str(), AT_REMOVEDIR);
    failWriting(file_, causeOf(cause));
  }
  record_ = Descriptor(
      ::openat(own_folder_.number(), kRecordName, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600));
  if (!record_.isOpen()) failWriting(file_, causeOf(errno));
  // Locked before it states anything. Where files cannot be locked it stays empty, which proves nothing.
  if (::flock(record_.number(), LOCK_EX | LOCK_NB) == 0) writeBytes(record_, recordOf(own_name_), file_);
}

void UnfinishedFile::removeOwnFolder() {
  if (!own_folder_.isOpen()) return;
  removeInnerFolder(folder_, own_name_, own_folder_, std::move(record_));
  own_folder_.close();
}

namespace {

/// Writes large blocks in parts, between which the work can be stopped.
class PartsBuffer : public __gnu_cxx::stdio_filebuf<char> {
 public:
  using stdio_filebuf::stdio_filebuf;

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    constexpr std::streamsize kAtOnce = ByteCheckpoints::kBytes / 8;
    std::streamsize done = 0;
    while (done < count) {
      const std::streamsize part = std::min(kAtOnce, count - done);
      const std::streamsize written = stdio_filebuf::xsputn(bytes + done, part);
      done += written;
      if (written != part) break;
      checkpoints_.add(static_cast<std::size_t>(written));
    }
    return done;
  }

  // A stream that does not know its position says so by -1 alone, which libraries write as a position into
  // the file.
  pos_type seekoff(off_type offset, std::ios::seekdir from, std::ios::openmode which) override {
    return known(stdio_filebuf::seekoff(offset, from, which));
  }
  pos_type seekpos(pos_type position, std::ios::openmode which) override {
    return known(stdio_filebuf::seekpos(position, which));
  }

 private:
  static pos_type known(pos_type position) {
    if (position == pos_type(off_type(-1)))
      throw std::ios_base::failure("a position in the file is not known");
    return position;
  }

  ByteCheckpoints checkpoints_;
};

}  // namespace

void UnfinishedFile::write(const std::function<void(std::ostream&)>& fill) {
  PartsBuffer buffer(createFile(own_folder_, file_, O_WRONLY).release(), std::ios::out | std::ios::binary);
  std::ostream stream(&buffer);
  try {
    stream.exceptions(std::ios::badbit | std::ios::failbit);
    errno = 0;
    fill(stream);
    if (buffer.close() == nullptr) stream.setstate(std::ios::badbit);
  } catch (const std::ios_base::failure&) {
    failWriting(file_, causeOf(errno));
  }
}

namespace {

/// True if a file was neither replaced nor written between two looks at its name.
bool isSame(const struct stat& a, const struct stat& b) {
  const auto areSame = [](const timespec& x, const timespec& y) {
    return x.tv_sec == y.tv_sec && x.tv_nsec == y.tv_nsec;
  };
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino && a.st_size == b.st_size &&
         areSame(a.st_mtim, b.st_mtim) && areSame(a.st_ctim, b.st_ctim);
}

}  // namespace

int UnfinishedFile::rename(const std::string& name, const std::string& target, Replaces replaces) {
  const Descriptor opened(
      ::openat(own_folder_.number(), name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (!opened.isOpen()) return errno;
  const auto statusOf = [&](struct stat& status) {
    return ::fstatat(folder_.number(), target.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0;
  };
  struct stat replaced {};
  const bool is_new = replaces == Replaces::own && !statusOf(replaced);
  // Before the record, which may replace that of the former file.
  if (replaces == Replaces::own && !is_new && !foreignText(file_.parent_path() / target).empty())
    return EEXIST;
  if (const int cause = recordOwn(file_.parent_path() / target, opened); cause != 0) return cause;
  struct stat former {};  // who may read a file does not change because it is written anew
  const bool has_former = statusOf(former) && S_ISREG(former.st_mode) && former.st_uid == ::geteuid();
  if (has_former && ::fchmod(opened.number(), former.st_mode & 0777) != 0) return errno;
  struct stat own {};
  if (::fsync(opened.number()) != 0 || ::fstat(opened.number(), &own) != 0) return errno;
  published_ = {own.st_dev, own.st_ino};
  const auto renamed = [&](unsigned flags) {
    return ::renameat2(own_folder_.number(), name.c_str(), folder_.number(), target.c_str(), flags) == 0;
  };
  // Reading and flushing a large file takes seconds.
  if (replaces == Replaces::own && !is_new && !(statusOf(former) && isSame(former, replaced))) return EEXIST;
  if (renamed(is_new || replaces == Replaces::nothing ? RENAME_NOREPLACE : 0)) return 0;
  if (errno != EINVAL && errno != ENOSYS) return errno;
  if (is_new) return renamed(0) ? 0 : errno;
  if (replaces != Replaces::nothing) return errno;
  // The file system knows no renaming without replacement; a link never replaces.
  return ::linkat(own_folder_.number(), name.c_str(), folder_.number(), target.c_str(), 0) == 0 ? 0 : errno;
}

std::string UnfinishedFile::keptText() {
  constexpr int kMost = 99;
  for (int n = 2; n <= kMost; ++n) {
    const std::string other = file_.stem().string() + '-' + std::to_string(n) + file_.extension().string();
    struct stat taken {};
    if (::fstatat(folder_.number(), other.c_str(), &taken, AT_SYMLINK_NOFOLLOW) == 0) continue;
    const int cause = rename(file_.filename(), other, Replaces::nothing);
    if (cause == 0) return "; the new one is kept as " + (file_.parent_path() / other).string();
    if (cause != EEXIST) break;
  }
  return "";
}

void UnfinishedFile::requireStillOwn(const fs::path& file) {
  const std::string foreign = foreignText(file);
  if (!foreign.empty()) throw Error(ErrorCode::usage, {file.string()}, "is " + foreign + keptText());
}

void UnfinishedFile::publish(const std::string& beside) {
  const std::string name = file_.filename();
  if (replaces_ == Replaces::own && !beside.empty()) requireStillOwn(file_);  // before the one beside it
  if (!beside.empty()) requireStillOwn(file_.string() + beside);
  if (!beside.empty()) {
    const int cause = rename(name + beside, name + beside, Replaces::any);
    if (cause == ENOENT) {
      ::unlinkat(folder_.number(), (name + beside).c_str(), 0);
    } else if (cause != 0) {
      failWriting(file_.string() + beside, causeOf(cause));
    }
  }
  int cause = rename(name, name, replaces_);
  if (cause == EEXIST && replaces_ == Replaces::own) {
    requireStillOwn(file_);
    cause = rename(name, name, replaces_);  // another process of this program has just written it
  }
  if (cause == EEXIST && replaces_ == Replaces::nothing) failExisting(file_);
  if (cause != 0) failWriting(file_, causeOf(cause));
  removeOwnFolder();
  // A rename is on the disk after this. Some file systems cannot sync a folder; the file is complete anyway.
  static_cast<void>(::fsync(folder_.number()) == 0);
}

void UnfinishedFile::withdraw() {
  const std::string name = file_.filename();
  struct stat now {};
  if (::fstatat(folder_.number(), name.c_str(), &now, AT_SYMLINK_NOFOLLOW) == 0 &&
      now.st_dev == published_.device && now.st_ino == published_.number)
    ::unlinkat(folder_.number(), name.c_str(), 0);
}

int removeAbandonedFiles(const fs::path& folder) {
  int removed = 0;
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
    const std::string name = entry.path().filename();
    if (!mayBeOwnFolder(name)) continue;
    const Descriptor outer(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    const Descriptor inner = openInnerFolder(outer, name);
    Descriptor record(::openat(inner.number(), kRecordName, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    if (provesAbandoned(record, name) && removeInnerFolder(outer, name, inner, std::move(record))) ++removed;
  }
  return removed;
}

}  // namespace emscape
