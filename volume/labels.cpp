#include "volume/labels.h"

#include <sstream>

namespace emscape::volume {

std::vector<std::string> labelsOf(const VolumeInfo& info) {
  std::vector<std::string> labels;
  const auto found = info.extra.find(kLabelsKey);
  if (found == info.extra.end()) return labels;
  std::istringstream lines(found->second);
  for (std::string line; std::getline(lines, line);) labels.push_back(line);
  return labels;
}

}  // namespace emscape::volume
