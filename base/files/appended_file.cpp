#include "base/files/appended_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace emscape {

AppendedFile::AppendedFile(std::filesystem::path file)
    : file_(std::move(file)), descriptor_(openOrCreateFile(file_, O_WRONLY | O_APPEND)) {}

void AppendedFile::cut(std::uintmax_t bytes) {
  if (::ftruncate(descriptor_.number(), static_cast<off_t>(bytes)) != 0) failWriting(file_, causeOf(errno));
}

void AppendedFile::append(const std::string& bytes) {
  writeBytes(descriptor_, bytes, file_);
}

}  // namespace emscape
