#include "study/maps/warnings.h"

#include <algorithm>
#include <regex>

namespace emscape::study {

void addOnce(std::vector<std::string>& all, const std::vector<std::string>& more) {
  static const std::regex kCount(R"( \(\d+ times\)$)");
  for (const std::string& warning : more) {
    std::string text = std::regex_replace(warning, kCount, "");
    if (std::find(all.begin(), all.end(), text) == all.end()) all.push_back(std::move(text));
  }
}

}  // namespace emscape::study
