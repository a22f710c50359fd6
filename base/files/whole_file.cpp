#include "base/files/whole_file.h"

#include <fmt/format.h>

#include <memory>

#include "base/files/unfinished_file.h"

namespace emscape {

void writeWhole(const std::vector<OutputFile>& files, Replaces replaces) {
  std::vector<std::unique_ptr<UnfinishedFile>> unfinished;
  for (const OutputFile& file : files) {
    unfinished.push_back(std::make_unique<UnfinishedFile>(file.path, replaces));
    unfinished.back()->write(file.write);
  }
  std::size_t published = 0;
  try {
    for (; published < unfinished.size(); ++published) unfinished[published]->publish();
  } catch (...) {
    while (replaces == Replaces::nothing && published-- > 0) unfinished[published]->withdraw();
    throw;
  }
}

void writeWhole(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write,
                Replaces replaces) {
  writeWhole({{path, write}}, replaces);
}

void requireNew(const std::vector<std::filesystem::path>& files) {
  for (const std::filesystem::path& file : files) {
    std::error_code ignored;
    const auto type = std::filesystem::symlink_status(file, ignored).type();
    // Folders and devices are never replaced; UnfinishedFile names them.
    if (type == std::filesystem::file_type::regular || type == std::filesystem::file_type::symlink) {
      failExisting(file);
    }
  }
}

}  // namespace emscape
