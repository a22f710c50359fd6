#include "apps/view/files/examples.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace emscape::view {
namespace {

namespace fs = std::filesystem;

/// The folder of the scenarios; empty if it is not found.
fs::path scenarioFolder() {
  std::error_code failed;
  fs::path above = fs::read_symlink("/proc/self/exe", failed).parent_path();
  for (int level = 0; level < 5 && above.has_relative_path(); ++level, above = above.parent_path()) {
    for (const fs::path& folder : {above / "share/emscape/scenarios", above / "scenarios"}) {
      if (fs::exists(folder / "jacksboro.yaml", failed)) return folder;
    }
  }
  return {};
}

/// The first sentence of the comment at the beginning of a file, shortened to whole words.
std::string firstSentence(const fs::path& file) {
  constexpr std::size_t kMaxCharacters = 240;
  std::ifstream lines(file);
  std::string text;
  for (std::string line; std::getline(lines, line) && line.rfind("# ", 0) == 0;) {
    text += (text.empty() ? "" : " ") + line.substr(2);
  }
  text = text.substr(0, text.find(". "));
  if (text.size() <= kMaxCharacters) return text.substr(0, text.find_last_not_of('.') + 1);
  return text.substr(0, text.rfind(' ', kMaxCharacters)) + " …";
}

}  // namespace

std::vector<Example> findExamples() {
  std::vector<Example> examples;
  std::error_code failed;
  const fs::path folder = scenarioFolder();
  if (folder.empty()) return examples;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
    if (entry.path().extension() == ".yaml")
      examples.push_back({entry.path().string(), firstSentence(entry.path())});
  }
  const auto isFirst = [](const Example& a) { return fs::path(a.file).filename() == "jacksboro.yaml"; };
  std::sort(examples.begin(), examples.end(), [&](const Example& a, const Example& b) {
    return isFirst(a) != isFirst(b) ? isFirst(a) : a.file < b.file;
  });
  return examples;
}

}  // namespace emscape::view
