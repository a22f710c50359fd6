#include "base/files/whole_file.h"

#include <fmt/format.h>

#include <memory>

#include "base/files/unfinished_file.h"
#include "emscape/base/error.h"

namespace emscape {

void writeWhole(const std::vector<OutputFile>& files) {
  std::vector<std::unique_ptr<UnfinishedFile>> unfinished;
  for (const OutputFile& file : files) {
    unfinished.push_back(std::make_unique<UnfinishedFile>(file.path));
    unfinished.back()->write(file.write);
  }
  for (const auto& file : unfinished) file->publish();
}

void writeWhole(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write) {
  writeWhole({{path, write}});
}

void requireNew(const std::vector<std::filesystem::path>& files) {
  for (const std::filesystem::path& file : files) {
    std::error_code ignored;
    const auto type = std::filesystem::symlink_status(file, ignored).type();
    // Folders and devices are never replaced; UnfinishedFile names them.
    if (type == std::filesystem::file_type::regular || type == std::filesystem::file_type::symlink) {
      throw Error(ErrorCode::usage,
                  fmt::format("{} exists; --force replaces it, another --output keeps it", file.string()));
    }
  }
}

}  // namespace emscape
