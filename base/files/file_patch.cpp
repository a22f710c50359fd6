#include "base/files/file_patch.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "base/files/descriptor.h"
#include "base/files/own_file.h"

namespace emscape {

void patchFile(const std::filesystem::path& path, const std::vector<FilePatch>& patches) {
  const Descriptor file = openFile(openFolderOf(path), path, O_RDWR);
  if (!file.isOpen()) failWriting(path, causeOf(ENOENT));
  if (const int cause = recordOwn(path, file, patches); cause != 0) failWriting(path, causeOf(cause));
  for (const FilePatch& patch : patches) {
    if (::lseek(file.number(), static_cast<off_t>(patch.offset), SEEK_SET) < 0)
      failWriting(path, causeOf(errno));
    writeBytes(file, patch.bytes, path);
  }
  syncFile(file, path);
}

}  // namespace emscape
