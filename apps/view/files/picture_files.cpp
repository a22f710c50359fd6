#include "apps/view/files/picture_files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace emscape::view {
namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

/// XDG_PICTURES_DIR of user-dirs.dirs, else ~/Pictures.
fs::path userPictures() {
  const std::string home = variable("HOME"), config = variable("XDG_CONFIG_HOME");
  std::ifstream lines(fs::path(config.empty() ? home + "/.config" : config) / "user-dirs.dirs");
  const std::string key = "XDG_PICTURES_DIR=\"", of_home = "$HOME";
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind(key, 0) != 0) continue;
    const std::string path = line.substr(key.size(), line.find('"', key.size()) - key.size());
    return path.rfind(of_home, 0) == 0 ? home + path.substr(of_home.size()) : path;
  }
  return home.empty() ? "" : home + "/Pictures";
}

bool takesFiles(const fs::path& folder) {
  std::error_code ignored;
  return !folder.empty() && fs::is_directory(folder, ignored) && access(folder.c_str(), W_OK) == 0;
}

fs::path pictureFolder(const std::string& input) {
  std::error_code ignored;
  for (const fs::path& folder : {userPictures(), fs::absolute(input, ignored).parent_path()}) {
    if (takesFiles(folder)) return folder;
  }
  return fs::current_path(ignored);
}

}  // namespace

std::string newPictureFile(const std::string& input, std::set<std::string>& given) {
  const fs::path folder = pictureFolder(input);
  for (int number = 1;; ++number) {
    const std::string file = (folder / fmt::format("emscape-{:04d}.png", number)).string();
    std::error_code ignored;
    if (!fs::exists(file, ignored) && given.insert(file).second) return file;
  }
}

}  // namespace emscape::view
