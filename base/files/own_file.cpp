#include "base/files/own_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cinttypes>
#include <cstdio>
#include <ctime>
#include <map>
#include <mutex>
#include <string_view>

#include "base/files/file_reading.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"

namespace emscape {
namespace fs = std::filesystem;

const char* const kForeignFile =
    "a file that emscape did not write, or has no record of having written (of an earlier version, copied, "
    "or changed since); move it away first, or give another output";

namespace {

constexpr char kAttribute[] = "user.emscape";
constexpr char kList[] = ".emscape-files";
constexpr std::uintmax_t kMaxListBytes = std::uintmax_t{64} << 20;  // a million lines

/// Descriptions of files that were read before. A file is read again if the system tells of a change, or if
/// it was changed so shortly before it was read that a later change may have the same time.
class KnownDescriptions {
 public:
  /// @return empty if the file is to be read
  std::string find(const struct stat& status) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = known_.find(stateOf(status));
    return found == known_.end() ? "" : found->second;
  }
  /// @param status  before the file was read at `read_at`
  void add(const struct stat& status, const timespec& read_at, const std::string& description) {
    constexpr time_t kTick_s = 3;  // of the coarsest file systems, and more
    if (std::max(status.st_ctim.tv_sec, status.st_mtim.tv_sec) > read_at.tv_sec - kTick_s) return;
    constexpr std::size_t kMost = 10000;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (known_.size() >= kMost) known_.clear();
    known_[stateOf(status)] = description;
  }

 private:
  /// Device, number, size, and times of the last changes of content and status.
  using State = std::array<std::int64_t, 7>;
  static State stateOf(const struct stat& status) {
    return {static_cast<std::int64_t>(status.st_dev),
            static_cast<std::int64_t>(status.st_ino),
            status.st_size,
            status.st_mtim.tv_sec,
            status.st_mtim.tv_nsec,
            status.st_ctim.tv_sec,
            status.st_ctim.tv_nsec};
  }

  std::mutex mutex_;
  std::map<State, std::string> known_;
};

/// "BYTES CRC32" of what is compared of a file, as it will be with the patches.
/// @return errno, 0 if all went well
int describe(const Descriptor& file, std::string& description, const std::vector<FilePatch>& patches = {}) {
  static KnownDescriptions known;
  struct stat status {};
  timespec now{};
  if (::fstat(file.number(), &status) != 0 || ::clock_gettime(CLOCK_REALTIME, &now) != 0) return errno;
  if (patches.empty()) description = known.find(status);
  if (!description.empty()) return 0;
  constexpr std::string_view kDatabase("SQLite format 3\0", 16);
  constexpr off_t kDatabaseHeader = 100;
  char begin[kDatabase.size()] = {};
  const ssize_t bytes = ::pread(file.number(), begin, sizeof begin, 0);
  if (bytes < 0) return errno;
  const bool is_database = std::string_view(begin, static_cast<std::size_t>(bytes)) == kDatabase;
  if (::lseek(file.number(), is_database ? kDatabaseHeader : 0, SEEK_SET) < 0) return errno;
  FileDigest digest;
  const int cause = addToDigest(file, digest, patches);
  description = fmt::format("{} {:08x}", digest.bytes, digest.crc32);
  if (cause == 0 && patches.empty()) known.add(status, now, description);
  return cause;
}

/// The description in the attribute; empty: none.
std::string attributeOf(const Descriptor& file) {
  std::string record(100, '\0');
  const ssize_t bytes = ::fgetxattr(file.number(), kAttribute, record.data(), record.size());
  record.resize(bytes > 0 ? static_cast<std::size_t>(bytes) : 0);
  return record;
}

/// A line of the list; empty for a name that cannot be in it.
std::string lineOf(const std::string& name, const std::string& description) {
  return name.find('\n') == std::string::npos ? description + ' ' + name + '\n' : std::string();
}

bool isListed(const fs::path& list, const std::string& line) {
  const Descriptor opened(::open(list.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (line.empty() || !opened.isOpen()) return false;
  // Another process may be changing it; until the file is closed.
  while (::flock(opened.number(), LOCK_SH) != 0 && errno == EINTR) {
  }
  const std::string lines = '\n' + readWholeText(list, kMaxListBytes);
  return lines.find('\n' + line) != std::string::npos;
}

/// The name in a line of the list, without its end.
std::string_view nameIn(std::string_view line) {
  const std::size_t name = line.find(' ', line.find(' ') + 1);
  return name == std::string_view::npos ? std::string_view() : line.substr(name + 1);
}

/// Puts a line in place of those of the same name.
/// @throws Error (other), as of a list of another user
void addToList(const fs::path& list, const std::string& line) {
  const Descriptor file = openOrCreateFile(list, O_RDWR);
  // Until the file is closed.
  while (::flock(file.number(), LOCK_EX) != 0 && errno == EINTR) {
  }
  const std::string former = readWholeText(list, kMaxListBytes);
  const std::string_view name = nameIn(std::string_view(line).substr(0, line.size() - 1));
  std::string lines;
  for (std::size_t begin = 0; begin < former.size();) {
    const std::size_t end = std::min(former.find('\n', begin), former.size());
    const std::string_view other(former.data() + begin, end - begin);
    // A killed process may have left a line without its end.
    if (nameIn(other) != name) (lines += other) += '\n';
    begin = end + 1;
  }
  lines += line;
  if (lines.size() > kMaxListBytes)
    failWriting(list, fmt::format("it has {} bytes, the limit is {}", former.size(), kMaxListBytes));
  const auto same = static_cast<std::size_t>(
      std::mismatch(former.begin(), former.end(), lines.begin(), lines.end()).first - former.begin());
  if (::lseek(file.number(), static_cast<off_t>(same), SEEK_SET) < 0) failWriting(list, causeOf(errno));
  writeBytes(file, lines.substr(same), list);
  if (::ftruncate(file.number(), static_cast<off_t>(lines.size())) != 0) failWriting(list, causeOf(errno));
}

/// True for a database with changes beside it: those of a program that has it open, or had when it died.
bool hasPendingChanges(const fs::path& database) {
  for (const char* const ending : {"-wal", "-journal"}) {
    std::error_code none;
    const std::uintmax_t bytes = fs::file_size(database.string() + ending, none);
    if (!none && bytes > 0) return true;
  }
  return false;
}

}  // namespace

int recordOwn(const fs::path& file, const Descriptor& opened, const std::vector<FilePatch>& patches) {
  std::string description;
  if (const int cause = describe(opened, description, patches); cause != 0) return cause;
  if (::fsetxattr(opened.number(), kAttribute, description.data(), description.size(), 0) == 0) return 0;
  const std::string cause = causeOf(errno), line = lineOf(file.filename(), description);
  ::fremovexattr(opened.number(), kAttribute);  // that of the former content
  std::string why_not_listed = "its name has a line end";
  try {
    if (!line.empty()) {
      addToList(file.parent_path() / kList, line);
      return 0;
    }
  } catch (const Error& error) {
    why_not_listed = error.what();
  }
  static std::atomic<bool> was_told{false};
  if (!was_told.exchange(true)) {
    logWarning(
        fmt::format("{} and others of its folder will count as files of yours, which are not replaced: their "
                    "attribute {} cannot be written ({}), and they cannot be listed ({})",
                    file.string(), kAttribute, cause, why_not_listed));
  }
  return 0;
}

FileDigest recordedDigestOf(const fs::path& file) {
  const Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  FileDigest digest;
  if (std::sscanf(attributeOf(opened).c_str(), "%" SCNu64 " %" SCNx32, &digest.bytes, &digest.crc32) == 2)
    return digest;
  return digestOf(file);
}

bool isOwn(const fs::path& file) {
  const Descriptor opened(::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  struct stat status {};
  if (!opened.isOpen() || ::fstat(opened.number(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
  if (status.st_size == 0) return true;
  if (hasPendingChanges(file)) return false;
  std::string description;
  if (describe(opened, description) != 0) return false;
  if (attributeOf(opened) == description) return true;
  try {
    return isListed(file.parent_path() / kList, lineOf(file.filename(), description));
  } catch (const Error&) {  // no list, or one of another user
  } catch (const fs::filesystem_error&) {
  }
  return false;
}

std::string foreignText(const fs::path& file) {
  std::error_code ignored;
  const fs::file_type type = fs::symlink_status(file, ignored).type();
  if (type == fs::file_type::symlink)
    return "a link, which is not followed; remove it, or give another output";
  return type == fs::file_type::regular && !isOwn(file) ? kForeignFile : "";
}

void requireOwn(const fs::path& file) {
  const std::string text = foreignText(file);
  if (!text.empty()) throw Error(ErrorCode::usage, {file.string()}, "is " + text);
}

}  // namespace emscape
