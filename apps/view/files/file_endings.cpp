#include "apps/view/files/file_endings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <vector>

#include "emscape/base/error.h"

namespace emscape::view {
namespace {

void requireEnding(const std::string& file, const std::vector<std::string>& endings) {
  if (file.empty()) return;
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (std::find(endings.begin(), endings.end(), ending) != endings.end()) return;
  throw Error(ErrorCode::usage, fmt::format("{}: must end in {}", file, fmt::join(endings, " or ")));
}

}  // namespace

void requirePictureEnding(const std::string& file) {
  requireEnding(file, {".png"});
}

void requireScenarioEnding(const std::string& file) {
  requireEnding(file, {".yaml", ".yml", ".json"});
}

void requireJsonEnding(const std::string& file) {
  requireEnding(file, {".json"});
}

}  // namespace emscape::view
