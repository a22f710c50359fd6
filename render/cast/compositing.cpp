#include "render/cast/compositing.h"

#include <fmt/format.h>

#include "emscape/base/error.h"
#include "emscape/render/scene/render_settings.h"
#include "render/cast/names.h"

namespace emscape::render {
namespace {

constexpr Named<CompositingMode> kModes[] = {{CompositingMode::dvr, "dvr"},
                                             {CompositingMode::mida, "mida"},
                                             {CompositingMode::mip, "mip"},
                                             {CompositingMode::iso, "iso"}};

}  // namespace

const char* toString(CompositingMode mode) {
  return nameOf(kModes, mode);
}

void SettingLimits::require(double value) const {
  if (value >= min && value <= max) return;
  throw Error(ErrorCode::bad_input, fmt::format("{} {}: expected a number {}..{}", name, value, min, max));
}

CompositingMode parseCompositingMode(const std::string& name) {
  return parseName(kModes, "mode", name);
}

}  // namespace emscape::render
