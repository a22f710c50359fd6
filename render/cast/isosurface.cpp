#include "render/cast/isosurface.h"

#include <fmt/format.h>

#include <algorithm>

#include "emscape/base/error.h"
#include "emscape/render/transfer/transfer_function.h"
#include "emscape/volume/statistics.h"

namespace emscape::render {

std::string missingIsosurface(double value, const volume::DenseVolume& volume, const ColorRange& range) {
  const volume::VolumeInfo& info = volume.info;
  if (info.categorical) {
    throw Error(
        ErrorCode::bad_input,
        fmt::format("iso value {:g}: {} holds indices, which have no isosurface", value, info.quantity));
  }
  const volume::Statistics values = volume::statisticsOf(volume);
  const volume::ValueRange of_series = colorRangeOf(info, range);
  const float lowest = std::min(values.min, of_series.min);
  const float highest = std::max(values.max, of_series.max);
  if (value >= lowest && value <= highest) return "";
  return fmt::format("iso value {:g}{}{}: {} ranges from {:g} to {:g}", value, info.unit.empty() ? "" : " ",
                     info.unit, info.quantity, lowest, highest);
}

}  // namespace emscape::render
