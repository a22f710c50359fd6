#include "apps/emscape/file_names.h"

#include <algorithm>

namespace emscape::app {

std::string fileNameOf(const std::string& name) {
  const auto isForeign = [](char c) {
    return !((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
             c == '-');
  };
  std::string result = name;
  std::replace_if(result.begin(), result.end(), isForeign, '_');
  return result;
}

}  // namespace emscape::app
