#include "apps/emscape/file_names.h"

#include <fmt/core.h>

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

std::string numberedName(const std::string& name, int number) {
  return fmt::format("{}_{:04}", name, number);
}

}  // namespace emscape::app
