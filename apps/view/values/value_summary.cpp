#include "apps/view/values/value_summary.h"

#include <algorithm>

#include "base/thread_arena.h"

namespace emscape::view {

ValueSummary summaryOf(const playback::ShownField& field) {
  constexpr long long kMaxBins = 2048, kValuesPerBin = 200;
  ValueSummary summary;
  summary.field = field;
  const auto values = field.values();
  ThreadArena one_thread(1);  // the other threads cast rays
  one_thread.run([&] {
    const volume::VolumeInfo& info = field.info();
    const auto bins = static_cast<int>(std::clamp(values->grid.dims.count() / kValuesPerBin, 32LL, kMaxBins));
    if (info.range_min < info.range_max) {
      summary.histogram = volume::histogramOf(*values, bins, info.range_min, info.range_max);
    }
    summary.fitted = field.defaultColors();
  });
  return summary;
}

}  // namespace emscape::view
