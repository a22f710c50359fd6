#include "base/files/whole_file.h"

#include <memory>

#include "base/files/unfinished_file.h"

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

}  // namespace emscape
