#include "base/files/folder.h"

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

void makeFolder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed == std::errc::not_a_directory || failed == std::errc::file_exists)
    throw Error(ErrorCode::usage, {folder.string()}, "is to be a folder, but it or a part of it is a file");
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
