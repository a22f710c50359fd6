#include "render/cast/isosurface.h"

#include <fmt/format.h>

#include <algorithm>

#include "emscape/base/error.h"
#include "emscape/volume/statistics.h"

namespace emscape::render {

std::string missingIsosurface(double value, const volume::DenseVolume& volume) {
  const volume::VolumeInfo& info = volume.info;
  if (info.categorical) {
    throw Error(
        ErrorCode::bad_input,
        fmt::format("iso value {:g}: {} holds indices, which have no isosurface", value, info.quantity));
  }
  const volume::Statistics values = volume::statisticsOf(volume);
  const float lowest = std::min(values.min, info.range_min);
  const float highest = std::max(values.max, info.range_max);
  if (value >= lowest && value <= highest) return "";
  return fmt::format("iso value {:g}{}{}: {} ranges from {:g} to {:g}", value, info.unit.empty() ? "" : " ",
                     info.unit, info.quantity, lowest, highest);
}

void checkIsoValue(double value, const volume::DenseVolume& volume) {
  const std::string missing = missingIsosurface(value, volume);
  if (!missing.empty()) throw Error(ErrorCode::bad_input, missing);
}

}  // namespace emscape::render
