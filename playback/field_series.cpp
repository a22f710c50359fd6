#include "apps/emscape/field_series.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "apps/emscape/interrupt.h"
#include "emscape/base/error.h"

namespace emscape::app {

void ValueRange::add(const ValueRange& other) {
  if (other.empty() || std::isnan(other.min) || std::isnan(other.max)) return;
  *this = empty() ? other : ValueRange{std::min(min, other.min), std::max(max, other.max)};
}

ValueRange parseRange(const std::string& text) {
  const std::size_t colon = text.find(':');
  ValueRange range;
  if (colon == std::string::npos || !CLI::detail::lexical_cast(text.substr(0, colon), range.min) ||
      !CLI::detail::lexical_cast(text.substr(colon + 1), range.max) || !std::isfinite(range.min) ||
      !std::isfinite(range.max) || range.min >= range.max) {
    throw Error(ErrorCode::usage, "--range '" + text + "' must be MIN:MAX, two numbers with MIN < MAX");
  }
  return range;
}

FieldSeries::FieldSeries(LoadedScenario input, std::vector<double> times_s,
                         const emfield::FieldOptions& options)
    : input_(std::move(input)),
      times_s_(std::move(times_s)),
      solver_(input_.scenario, input_.terrain, options) {}

scenario::Snapshot FieldSeries::snapshot(int step) const {
  return scenario::snapshotAt(input_.scenario, input_.terrain.get(), time_s(step));
}

scenario::Snapshot FieldSeries::update(int step) {
  stopIfInterrupted();
  scenario::Snapshot now = snapshot(step);
  changed_ = solver_.update(now).any;
  return now;
}

std::vector<volume::Volume> FieldSeries::latest() const {
  std::vector<volume::Volume> volumes;
  const auto take = [&volumes](const auto& latest) {
    for (const auto& volume : latest) volumes.emplace_back(volume, volume->info);
  };
  if (solver_.deviceVolumes().empty()) {
    take(solver_.volumes());
  } else {
    take(solver_.deviceVolumes());
  }
  return volumes;
}

std::vector<ValueRange> FieldSeries::findRanges(int stride, const std::function<void(int)>& done) {
  std::vector<ValueRange> ranges(channels().size());
  for (int step = 0; step < count(); step += stride) {
    update(step);
    const std::vector<volume::Volume> volumes = latest();
    for (std::size_t c = 0; c < ranges.size(); ++c) {
      const volume::VolumeInfo& info = volumes[c].info();
      ranges[c].add({info.range_min, info.range_max});
    }
    done(step + 1);
  }
  return ranges;
}

std::vector<volume::Volume> FieldSeries::compute(int step, const std::vector<ValueRange>& ranges) {
  const scenario::Snapshot now = update(step);
  std::vector<volume::Volume> volumes = latest();
  for (std::size_t c = 0; c < volumes.size(); ++c) {
    // The solver leaves a volume that did not change as it was, its time too.
    volume::VolumeInfo info = volumes[c].info();
    const ValueRange range = ranges[c].empty() ? ValueRange{info.floor, info.floor} : ranges[c];
    info.time_s = now.time_s;
    info.time_utc = now.time_utc;
    info.range_min = range.min;
    info.range_max = range.max;
    volumes[c].setInfo(std::move(info));
  }
  return volumes;
}

}  // namespace emscape::app
