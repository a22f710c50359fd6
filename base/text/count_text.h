/// Numbers with their nouns.
#pragma once

#include <fmt/format.h>

#include <string>

namespace emscape {

/// "1 beam is", "2 beams are". @param many  the words for other numbers than one
template <class Count>
std::string countText(Count count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

}  // namespace emscape
