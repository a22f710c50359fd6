#include "base/files/folder.h"

#include <fmt/format.h>

#include <string>
#include <system_error>
#include <utility>

#include "emscape/base/error.h"

namespace emscape {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void failMaking(const fs::path& folder, const std::string& cause) {
  throw Error(ErrorCode::other, {folder.string()}, "cannot make the folder: " + cause);
}

}  // namespace

fs::path fileInPath(const fs::path& path) {
  fs::path part;
  for (const fs::path& name : path) {
    part /= name;
    std::error_code ignored;
    const fs::file_status status = fs::status(part, ignored);
    if (fs::exists(status) && !fs::is_directory(status)) return part;
  }
  return {};
}

void requireNoFileIn(const fs::path& folder) {
  const fs::path file = fileInPath(folder);
  if (file.empty()) return;
  throw Error(ErrorCode::usage, {folder.string()},
              fmt::format("is to be a folder, but {} is a file; give another output",
                          folder == file ? "it" : file.string()));
}

void makeFolder(const fs::path& folder) {
  requireNoFileIn(folder);
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) failMaking(folder, failed.message());
}

FolderForFiles::FolderForFiles(fs::path folder) : folder_(std::move(folder)), is_new_(!fs::exists(folder_)) {
  makeFolder(folder_);
}

FolderForFiles::~FolderForFiles() {
  std::error_code is_used;
  if (is_new_) fs::remove(folder_, is_used);
}

fs::path makeFolderIn(const fs::path& folder, const fs::path& inner) {
  makeFolder(folder);
  fs::path made = folder;
  for (const fs::path& component : inner) {
    made /= component;
    std::error_code failed;
    if (fs::is_symlink(made, failed)) failMaking(made, "it is a symbolic link, which is not followed");
    makeFolder(made);
  }
  return made;
}

}  // namespace emscape
