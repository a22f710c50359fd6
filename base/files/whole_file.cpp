#include "base/files/whole_file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

#include "emscape/base/error.h"

namespace emscape {
namespace fs = std::filesystem;
namespace {

constexpr char kMarker[] = ".part-";

/// Endings of files that SQLite and GDAL make beside a temporary.
constexpr std::string_view kEndings[] = {"-journal", "-wal", "-shm", ".aux.xml"};

constexpr std::size_t longestEnding() {
  std::size_t longest = 0;
  for (const std::string_view ending : kEndings) longest = std::max(longest, ending.size());
  return longest;
}

std::string causeOf(int error_number) {
  return error_number == 0 ? "the system gives no cause" : std::generic_category().message(error_number);
}

[[noreturn]] void failWriting(const fs::path& path, const std::string& cause) {
  throw Error(ErrorCode::other, {path.string()}, "cannot write: " + cause);
}

/// Opens, fsyncs and closes a file or a folder; a rename is on the disk only after fsync of its folder.
/// @return errno, 0 if all went well
int syncToDisk(const fs::path& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) return errno;
  int cause = ::fsync(descriptor) == 0 ? 0 : errno;
  if (::close(descriptor) != 0 && cause == 0) cause = errno;
  return cause;
}

fs::path folderOf(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

std::uint32_t crc32Of(const std::string& text) {
  return static_cast<std::uint32_t>(::crc32_z(0, reinterpret_cast<const Bytef*>(text.data()), text.size()));
}

std::string hexText(std::uint32_t number) {
  char digits[9];
  std::snprintf(digits, sizeof digits, "%08x", number);
  return digits;
}

/// The names of a file's temporaries up to the process: NAME.part-. So that they fit into a folder, the end
/// of a long name is replaced by its checksum.
std::string stemOfTemporaries(const fs::path& path) {
  constexpr std::size_t kMaxName = 255;
  constexpr std::size_t kMaxWriter = 9 + 1 + 8;  // process, machine
  constexpr std::size_t kMaxStem = kMaxName - (sizeof kMarker - 1) - kMaxWriter - longestEnding();
  std::string name = path.filename().string();
  if (name.size() > kMaxStem) {
    const std::string checksum = '~' + hexText(crc32Of(name));
    std::size_t kept = kMaxStem - checksum.size();
    const auto isInsideCharacter = [&] { return (static_cast<unsigned char>(name[kept]) & 0xC0U) == 0x80; };
    while (kept > 0 && isInsideCharacter()) --kept;  // UTF-8
    name.replace(kept, std::string::npos, checksum);
  }
  return name + kMarker;
}

struct Writer {
  long process = 0;     ///< 0: the name is not one of a temporary
  std::string machine;  ///< machineName(); empty: not known
};

/// The process that wrote a temporary, or a file beside it.
Writer writerOf(const fs::path& path) {
  std::string name = path.filename().string();
  for (const std::string_view ending : kEndings) {
    if (name.size() > ending.size() &&
        name.compare(name.size() - ending.size(), ending.size(), ending) == 0) {
      name.resize(name.size() - ending.size());
      break;
    }
  }
  const std::size_t marker = name.rfind(kMarker);
  if (marker == std::string::npos || marker == 0) return {};
  const std::string text = name.substr(marker + std::strlen(kMarker));
  const std::size_t dash = text.find('-');
  const std::string process = text.substr(0, dash);
  const std::string machine = dash == std::string::npos ? "" : text.substr(dash + 1);
  const auto is = [](const std::string& word, int (*test)(int)) {
    return std::all_of(word.begin(), word.end(),
                       [&](unsigned char character) { return test(character) != 0; });
  };
  const bool is_process = !process.empty() && process.size() < 10 && is(process, std::isdigit);
  const bool is_machine =
      dash == std::string::npos || (machine.size() == machineName().size() && is(machine, std::isxdigit));
  return is_process && is_machine ? Writer{std::stol(process), machine} : Writer{};
}

/// True if a process is a zombie: ended, not yet waited for. False if the system does not report it.
bool isZombie(long process) {
  std::ifstream stream("/proc/" + std::to_string(process) + "/stat");
  std::string text;
  std::getline(stream, text);
  const std::size_t name_end = text.rfind(") ");  // "PID (NAME) STATE ..."
  return name_end != std::string::npos && text.compare(name_end + 2, 1, "Z") == 0;
}

/// True if a file is a temporary whose writer no longer runs. Writers on other machines that share the folder
/// are unknown.
bool isStale(const fs::path& path) {
  const Writer writer = writerOf(path);
  if (writer.process == 0 || (!writer.machine.empty() && writer.machine != machineName())) return false;
  return !isRunning(writer.process);
}

/// An open file, closed at the end of its scope.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags)
      : path_(path), number_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {
    if (number_ < 0) failWriting(path_, causeOf(errno));
  }
  ~Descriptor() { ::close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  void sync() const {
    if (::fsync(number_) != 0) failWriting(path_, causeOf(errno));
  }

 private:
  const fs::path path_;
  const int number_;
};

/// A file under its temporary name; removed unless kept.
class Temporary {
 public:
  explicit Temporary(const OutputFile& file) : path_(temporaryFor(file.path)) {
    requireFileTarget(file.path);
    std::ofstream stream;
    try {
      errno = 0;
      stream.open(path_, std::ios::binary | std::ios::trunc);  // may lack memory after the file was created
      if (!stream) failWriting(file.path, causeOf(errno));
      stream.exceptions(std::ios::badbit | std::ios::failbit);
      errno = 0;
      file.write(stream);
      stream.close();
    } catch (const std::ios_base::failure&) {
      const int cause = errno;
      remove();
      failWriting(file.path, causeOf(cause));
    } catch (...) {
      remove();
      throw;
    }
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() { remove(); }

  const fs::path& path() const { return path_; }

 private:
  void remove() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }

  fs::path path_;
};

/// @tparam Bytes  a container of bytes that can be resized
template <class Bytes>
Bytes readAll(const fs::path& path, std::uintmax_t max_bytes) {
  const auto fail = [&](const std::string& cause) {
    throw Error(ErrorCode::bad_input, {path.string()}, cause);
  };
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) fail("there is no such file");
  if (fs::is_directory(status)) fail("cannot read: it is a folder");
  if (!fs::is_regular_file(status)) fail("cannot read: it is not a regular file");
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail("cannot read: " + causeOf(errno));
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) fail("cannot read: " + error.message());
  if (size > max_bytes) {
    fail("is " + std::to_string(size) + " bytes large, more than the allowed " + std::to_string(max_bytes));
  }
  Bytes bytes;
  bytes.resize(static_cast<std::size_t>(size));
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size) fail("cannot read: it ended early");
  return bytes;
}

}  // namespace

const std::string& machineName() {
  static const std::string kName = [] {
    char host[256] = "";
    ::gethostname(host, sizeof host - 1);
    std::error_code ignored;
    return hexText(crc32Of(host + ('|' + fs::read_symlink("/proc/self/ns/pid", ignored).string())));
  }();
  return kName;
}

bool isRunning(long process) {
  return !(::kill(static_cast<pid_t>(process), 0) != 0 && errno == ESRCH) && !isZombie(process);
}

fs::path temporaryFor(const fs::path& path) {
  return path.parent_path() / (stemOfTemporaries(path) + std::to_string(::getpid()) + '-' + machineName());
}

// Renaming to a folder fails late, and renaming to a device would replace it.
void requireFileTarget(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_directory(folderOf(path), ignored)) {
    failWriting(path, "the folder " + folderOf(path).string() + " does not exist");
  }
  const fs::file_status status = fs::status(path, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    failWriting(path, fs::is_directory(status) ? "a folder of that name exists" : "it is not a regular file");
  }
}

bool isTemporary(const fs::path& path) {
  return writerOf(path).process != 0;
}

void publish(const fs::path& temporary, const fs::path& path) {
  int cause = syncToDisk(temporary, O_RDONLY);
  if (cause == 0 && ::rename(temporary.c_str(), path.c_str()) != 0) cause = errno;
  if (cause != 0) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    failWriting(path, causeOf(cause));
  }
  // Some file systems cannot sync a folder; the file under its name is complete anyway.
  syncToDisk(folderOf(path), O_RDONLY | O_DIRECTORY);
}

void writeWhole(const std::vector<OutputFile>& files) {
  std::vector<std::unique_ptr<Temporary>> temporaries;
  for (const OutputFile& file : files) temporaries.push_back(std::make_unique<Temporary>(file));
  for (std::size_t i = 0; i < files.size(); ++i) publish(temporaries[i]->path(), files[i].path);
}

void writeWhole(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  writeWhole({{path, write}});
}

void removeTemporary(const fs::path& temporary) {
  std::error_code ignored;
  fs::remove(temporary, ignored);
  for (const std::string_view ending : kEndings)
    fs::remove(temporary.string() + std::string(ending), ignored);
}

int removeStaleTemporaries(const fs::path& folder) {
  int removed = 0;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (isStale(entry.path()) && fs::remove(entry.path(), error)) ++removed;
  }
  return removed;
}

void removeStaleTemporariesOf(const fs::path& path) {
  std::error_code error;
  const std::string prefix = stemOfTemporaries(path);
  for (const fs::directory_entry& entry : fs::directory_iterator(folderOf(path), error)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(prefix, 0) == 0 && isStale(entry.path())) fs::remove(entry.path(), error);
  }
}

void patchFile(const fs::path& path, const std::vector<FilePatch>& patches) {
  Descriptor file(path, O_WRONLY);
  for (const FilePatch& patch : patches) {
    for (std::size_t done = 0; done < patch.bytes.size();) {
      const ssize_t written = ::pwrite(file.number(), patch.bytes.data() + done, patch.bytes.size() - done,
                                       static_cast<off_t>(patch.offset + done));
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) failWriting(path, causeOf(errno));
      done += static_cast<std::size_t>(written);
    }
  }
  file.sync();
}

void appendToFile(const fs::path& path, const std::string& bytes) {
  Descriptor file(path, O_WRONLY | O_CREAT | O_APPEND);
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t written = ::write(file.number(), bytes.data() + done, bytes.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) failWriting(path, causeOf(errno));
    done += static_cast<std::size_t>(written);
  }
  file.sync();
}

FileDigest digestOf(const fs::path& path) {
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error(ErrorCode::bad_input, {path.string()}, "cannot read: " + causeOf(errno));
  FileDigest digest;
  uLong crc = ::crc32(0, nullptr, 0);
  std::vector<char> block(1 << 20);
  while (stream) {
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    const auto bytes = static_cast<std::size_t>(stream.gcount());
    crc = ::crc32_z(crc, reinterpret_cast<const Bytef*>(block.data()), bytes);
    digest.bytes += bytes;
  }
  if (!stream.eof()) throw Error(ErrorCode::bad_input, {path.string()}, "cannot read: " + causeOf(errno));
  digest.crc32 = static_cast<std::uint32_t>(crc);
  return digest;
}

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
  for (;;) {
    const int descriptor = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0) failWriting(file_, causeOf(errno));
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
      const int cause = errno;
      char text[64] = {};
      const ssize_t bytes = ::pread(descriptor, text, sizeof text - 1, 0);
      ::close(descriptor);
      if (cause != EWOULDBLOCK) failWriting(file_, causeOf(cause));
      holder = bytes > 0 ? text : "not known which";
      return false;
    }
    // The previous holder may have removed the file between the two calls.
    struct stat held {
    }, named{};
    if (::fstat(descriptor, &held) == 0 && ::stat(file_.c_str(), &named) == 0 &&
        held.st_ino == named.st_ino && held.st_dev == named.st_dev) {
      descriptor_ = descriptor;
      break;
    }
    ::close(descriptor);
  }
  char host[256] = "?";
  ::gethostname(host, sizeof host - 1);
  const std::string own = "process " + std::to_string(::getpid()) + " on " + host;
  // Only a message depends on this text.
  if (::ftruncate(descriptor_, 0) == 0) {
    static_cast<void>(::pwrite(descriptor_, own.data(), own.size(), 0) == 0);
  }
  return true;
}

FolderLock::~FolderLock() {
  if (descriptor_ < 0) return;
  std::error_code ignored;
  fs::remove(file_, ignored);
  ::close(descriptor_);
}

std::vector<std::uint8_t> readWhole(const fs::path& path, std::uintmax_t max_bytes) {
  return readAll<std::vector<std::uint8_t>>(path, max_bytes);
}

std::string readWholeText(const fs::path& path, std::uintmax_t max_bytes) {
  return readAll<std::string>(path, max_bytes);
}

}  // namespace emscape
