#include "base/files/file_patch.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "base/files/descriptor.h"

namespace emscape {

void patchFile(const std::filesystem::path& path, const std::vector<FilePatch>& patches) {
  const Descriptor file = openFile(openFolderOf(path), path, O_WRONLY);
  if (!file.isOpen()) failWriting(path, causeOf(ENOENT));
  for (const FilePatch& patch : patches) {
    if (::lseek(file.number(), static_cast<off_t>(patch.offset), SEEK_SET) < 0)
      failWriting(path, causeOf(errno));
    writeBytes(file, patch.bytes, path);
  }
  syncFile(file, path);
}

}  // namespace emscape
