#include "study/maps/warnings.h"

#include <algorithm>
#include <regex>

namespace emscape::study {

std::string withoutCount(const std::string& warning) {
  static const std::regex kCount(R"( \(\d+ times\)$)");
  return std::regex_replace(warning, kCount, "");
}

void addOnce(std::vector<std::string>& all, const std::vector<std::string>& more) {
  for (const std::string& warning : more) {
    std::string text = withoutCount(warning);
    if (std::find(all.begin(), all.end(), text) == all.end()) all.push_back(std::move(text));
  }
}

}  // namespace emscape::study
