#include "apps/common/value_range.h"

#include <CLI/CLI.hpp>
#include <cmath>

#include "emscape/base/error.h"

namespace emscape::app {

playback::ValueRange parseRange(const std::string& text) {
  const std::size_t colon = text.find(':');
  playback::ValueRange range;
  if (colon == std::string::npos || !CLI::detail::lexical_cast(text.substr(0, colon), range.min) ||
      !CLI::detail::lexical_cast(text.substr(colon + 1), range.max) || !std::isfinite(range.min) ||
      !std::isfinite(range.max) || range.min >= range.max) {
    throw Error(ErrorCode::usage, "--range '" + text + "' must be MIN:MAX, two numbers with MIN < MAX");
  }
  return range;
}

}  // namespace emscape::app
