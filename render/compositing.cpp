#include "render/compositing.h"

#include "emscape/render/render_settings.h"
#include "render/names.h"

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

CompositingMode parseCompositingMode(const std::string& name) {
  return parseName(kModes, "mode", name);
}

}  // namespace emscape::render
