#include "apps/view/files/recent_files.h"

#include <algorithm>
#include <sstream>
#include <system_error>

#include "base/files/file_reading.h"
#include "base/files/folder.h"
#include "base/files/whole_file.h"
#include "base/text/failure_text.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"
#include "playback/editing/autosave.h"

namespace emscape::view {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxBytes = 1 << 20;

}  // namespace

fs::path recentFilesFile() {
  return playback::stateFolder() / "recent";
}

std::vector<std::string> readRecentFiles() {
  std::vector<std::string> files;
  try {
    std::istringstream text(readWholeText(recentFilesFile(), kMaxBytes));
    for (std::string line; std::getline(text, line) && files.size() < kMaxRecentFiles;) {
      if (!line.empty()) files.push_back(line);
    }
  } catch (const Error&) {  // none yet
  }
  return files;
}

std::vector<std::string> addRecentFile(const std::string& input) {
  std::error_code failure;
  fs::path canonical = fs::absolute(input, failure);
  if (!failure) canonical = fs::weakly_canonical(canonical, failure);
  const std::string path = failure ? input : canonical.string();
  std::vector<std::string> files = readRecentFiles();
  files.erase(std::remove(files.begin(), files.end(), path), files.end());
  if (path.find('\n') == std::string::npos) files.insert(files.begin(), path);
  files.resize(std::min(files.size(), kMaxRecentFiles));
  try {
    makeFolder(recentFilesFile().parent_path());
    writeWhole(
        recentFilesFile(),
        [&files](std::ostream& out) {
          for (const std::string& file : files) out << file << '\n';
        },
        Replaces::any);
  } catch (const Error& error) {
    logWarning(failureText(error));
  }
  return files;
}

}  // namespace emscape::view
