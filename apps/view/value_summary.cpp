#include "apps/view/value_summary.h"

#include <algorithm>

#include "base/thread_arena.h"

namespace emscape::view {

ValueSummary summaryOf(const volume::Volume& volume) {
  constexpr long long kMaxBins = 2048, kVoxelsPerBin = 200;
  ValueSummary summary;
  summary.volume = volume;
  const auto host = volume.host();
  ThreadArena one_thread(1);  // the other threads cast
  one_thread.run([&] {
    const volume::VolumeInfo& info = volume.info();
    const auto bins =
        static_cast<int>(std::clamp(volume.grid().dims.count() / kVoxelsPerBin, 32LL, kMaxBins));
    if (info.range_min < info.range_max) {
      summary.histogram = volume::histogramOf(*host, bins, info.range_min, info.range_max);
    }
    summary.fitted = render::defaultTransferFunction(*host);
  });
  return summary;
}

bool sameValues(const volume::Volume& a, const volume::Volume& b) {
  return !a.isEmpty() && !b.isEmpty() && a.dense() == b.dense() && a.device() == b.device();
}

}  // namespace emscape::view
