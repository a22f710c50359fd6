#include "render/cast/compositing.h"

#include <fmt/format.h>

#include "emscape/base/error.h"
#include "emscape/render/scene/render_settings.h"

namespace emscape::render {
namespace {}  // namespace

void SettingLimits::require(double value) const {
  if (value >= min && value <= max) return;
  throw Error(ErrorCode::bad_input, fmt::format("{} {}: expected a number {}..{}", name, value, min, max));
}

CompositingMode parseCompositingMode(const std::string& name) {
  return parseName<CompositingMode>("mode", name);
}

}  // namespace emscape::render
