/// Messages of several lines in places of one. Internal to the module.
#pragma once

#include <string>

namespace emscape::playback {

inline std::string firstLine(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

}  // namespace emscape::playback
