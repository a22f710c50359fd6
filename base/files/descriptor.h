/// Open files and folders. Files are created and opened for writing here alone: an output folder may come
/// from a stranger, or be writable by others, so that no link in it is followed.
#pragma once

#include <filesystem>
#include <string>

namespace emscape {

/// The system's description of errno; a sentence if it is 0.
std::string causeOf(int error_number);
/// @throws Error (other) "FILE: cannot write: CAUSE"
[[noreturn]] void failWriting(const std::filesystem::path& file, const std::string& cause);

/// @throws Error (usage) for an output that exists and is not to be replaced, with the option --force
[[noreturn]] void failExisting(const std::filesystem::path& file);

/// An open file or folder, closed at the end of its scope.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept;

  int number() const { return number_; }
  bool isOpen() const { return number_ >= 0; }
  void close();
  /// The number, which the caller closes.
  int release();

 private:
  int number_ = -1;
};

/// Opens the folder of a file. It may be a link, because the user has named it.
/// @throws Error (other) that names the file and the cause
Descriptor openFolderOf(const std::filesystem::path& file);

/// Creates a file in its open folder. Not open if the name exists, be it a link.
/// @param flags  of open(): O_RDWR, O_WRONLY, O_APPEND
/// @throws Error (other) that names the file and the cause
Descriptor createFile(const Descriptor& folder, const std::filesystem::path& file, int flags);

/// Opens an existing file in its open folder. Not open if there is none.
/// @param flags  as of createFile()
/// @throws Error (other) that names the file and the cause; a symbolic link, a file with a second name (hard
/// link) and all but regular files are refused
Descriptor openFile(const Descriptor& folder, const std::filesystem::path& file, int flags);

/// Opens a file, or creates it.
Descriptor openOrCreateFile(const std::filesystem::path& file, int flags);

/// Writes all bytes at the present position. @throws Error (other) that names the file and the cause
void writeBytes(const Descriptor& descriptor, const std::string& bytes, const std::filesystem::path& file);
/// Flushes to the disk. @throws Error (other) that names the file and the cause
void syncFile(const Descriptor& descriptor, const std::filesystem::path& file);

}  // namespace emscape
