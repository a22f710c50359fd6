/// Atomic file writes: a file appears under its name only when it is complete. Reading of whole files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace emscape {

/// One file to write: `write` fills the stream, which throws on every failure, seeks, and is binary.
struct OutputFile {
  std::filesystem::path path;
  std::function<void(std::ostream&)> write;
};

/// Writes files that belong together: each under a temporary name in the same folder, flushed to the disk.
/// When all are complete they are renamed, in the order given. Files of the same name are replaced. On any
/// failure no final name is written and the temporaries are removed; only a killed process leaves one, which
/// isTemporary() recognises.
/// @throws Error (other) that names the path and the cause: missing folder, no permission, no space;
/// exceptions that
///         `write` throws for reasons of its own pass through
void writeWhole(const std::vector<OutputFile>& files);
void writeWhole(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// Eight hexadecimal digits that identify a machine among those that may share a folder: from the host's name
/// and the namespace of process numbers.
const std::string& machineName();
/// True if a process of this machine runs.
bool isRunning(long process);

/// Refuses a file that cannot be written because of its folder or of what has its name, before work begins.
/// @throws Error (other) that names the path and the cause: missing folder, a folder or device of that name
void requireFileTarget(const std::filesystem::path& path);

/// The temporary name of a file, for programs that write it themselves:
/// NAME.part-PID-MACHINE; the end of a long NAME is replaced by a checksum, so that the name fits into 255
/// bytes, and so do those of isTemporary() beside it.
std::filesystem::path temporaryFor(const std::filesystem::path& path);

/// Flushes a complete temporary to the disk and renames it to its final name.
/// @throws Error (other); the temporary is then removed
void publish(const std::filesystem::path& temporary, const std::filesystem::path& path);

/// True for names that temporaryFor() gives, and for files that SQLite and GDAL make beside a temporary:
/// -journal, -wal, -shm, .aux.xml.
bool isTemporary(const std::filesystem::path& path);

/// Removes a temporary and the files beside it, as far as they exist.
void removeTemporary(const std::filesystem::path& temporary);

/// Removes the temporaries in a folder that belong to ended processes of this machine.
/// @return their number; 0 if the folder does not exist
int removeStaleTemporaries(const std::filesystem::path& folder);

/// Removes the temporaries of one file that belong to ended processes.
void removeStaleTemporariesOf(const std::filesystem::path& path);

/// Bytes that overwrite as many bytes of a file.
struct FilePatch {
  std::uint64_t offset = 0;
  std::string bytes;
};

/// Overwrites parts of a file in place; they are on the disk at return. Not atomic: after a crash of the
/// machine some of the patches may be unwritten.
/// @throws Error (other)
void patchFile(const std::filesystem::path& path, const std::vector<FilePatch>& patches);

/// Appends bytes to a file, which is created if it does not exist; they are on the disk at return.
/// @throws Error (other); some of the bytes may then be in the file
void appendToFile(const std::filesystem::path& path, const std::string& bytes);

/// Size and checksum of a file's content.
struct FileDigest {
  std::uint64_t bytes = 0;
  std::uint32_t crc32 = 0;

  bool operator==(const FileDigest& other) const { return bytes == other.bytes && crc32 == other.crc32; }
  bool operator!=(const FileDigest& other) const { return !(*this == other); }
};
/// @throws Error (bad_input) that names the path and the cause
FileDigest digestOf(const std::filesystem::path& path);

/// The exclusive right to write a folder's files, held until destruction by one process at a time; the kernel
/// takes it back from a process that dies.
class FolderLock {
 public:
  /// Creates FOLDER/NAME, which names the holder of the lock and is removed with it.
  /// @throws Error (other) that names the process that holds it, or the cause of another failure
  FolderLock(const std::filesystem::path& folder, const std::string& name);
  /// The same, but null if another process holds the lock.
  static std::unique_ptr<FolderLock> tryLock(const std::filesystem::path& folder, const std::string& name);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  explicit FolderLock(std::filesystem::path file) : file_(std::move(file)) {}
  /// @return false if another process holds the lock, named in `holder`
  bool lock(std::string& holder);

  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// All bytes of a regular file.
/// @throws Error (bad_input) that names the path and the cause: no such file, not a regular file, no
/// permission, more than max_bytes
std::vector<std::uint8_t> readWhole(const std::filesystem::path& path,
                                    std::uintmax_t max_bytes = UINTMAX_MAX);
/// The same bytes as a string. The encoding is not checked.
std::string readWholeText(const std::filesystem::path& path, std::uintmax_t max_bytes = UINTMAX_MAX);

}  // namespace emscape
