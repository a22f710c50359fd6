#include "emscape/playback/frames/field_series.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/error.h"
#include "emscape/playback/stop.h"
#include "emscape/scenario/model/quantities.h"
#include "playback/frames/difference_source.h"
#include "volume/difference.h"

namespace emscape::playback {

std::vector<ValueRange> rangesOf(const std::vector<volume::Volume>& volumes) {
  std::vector<ValueRange> ranges;
  for (const volume::Volume& volume : volumes) {
    ValueRange range;
    range.add({volume.info().range_min, volume.info().range_max});
    ranges.push_back(range);
  }
  return ranges;
}

void setRanges(std::vector<volume::Volume>& volumes, const std::vector<ValueRange>& ranges) {
  for (std::size_t c = 0; c < volumes.size(); ++c) {
    volume::VolumeInfo info = volumes[c].info();
    const ValueRange range = ranges[c].empty() ? ValueRange{info.floor, info.floor} : ranges[c];
    info.range_min = range.min;
    info.range_max = range.max;
    volumes[c].setInfo(std::move(info));
  }
}

int rangeSearchStride(int steps) {
  // Beams repeat their motion, so a part of the steps is sufficient for the range of colours.
  constexpr int kMaxSteps = 24;
  return (steps + kMaxSteps - 1) / kMaxSteps;
}

FieldSeries::FieldSeries(LoadedScenario input, std::vector<double> times_s,
                         const emfield::FieldOptions& options, const StopFlag* stop)
    : input_(std::move(input)),
      times_s_(std::move(times_s)),
      options_(options),
      stop_(stop),
      solver_(input_.scenario, input_.terrain, options) {}

scenario::Snapshot FieldSeries::snapshot(int step) const {
  return scenario::snapshotAt(input_.scenario, input_.terrain.get(), time_s(step));
}

void FieldSeries::setScenario(LoadedScenario input, std::vector<double> times_s) {
  input_ = std::move(input);
  times_s_ = std::move(times_s);
  updated_step_ = -1;
}

void FieldSeries::compareWith(const LoadedScenario& reference, const std::string& name) {
  emfield::FieldOptions options = options_;
  options.move_tolerance_m = 0;  // else a step would depend on the previous steps
  auto series = std::make_unique<FieldSeries>(reference, times_s_, options, stop_);
  const std::vector<emfield::Channel>& own = solver_.channels();
  const std::vector<emfield::Channel>& others = series->channels();
  const auto sameName = [](const emfield::Channel& a, const emfield::Channel& b) { return a.name == b.name; };
  if (!std::equal(own.begin(), own.end(), others.begin(), others.end(), sameName)) {
    throw Error(ErrorCode::bad_input, "the compared scenarios have other quantities or emitters in them");
  }
  std::vector<emfield::Channel> channels = own;
  for (emfield::Channel& channel : channels) {
    const scenario::QuantityInfo& quantity = scenario::info(channel.quantity);
    volume::requireDifference(channel.name, quantity.categorical);
    volume::VolumeInfo info;
    info.quantity = channel.name;
    info.unit = quantity.unit;
    channel.name = volume::differenceInfo(info).quantity;
  }
  reference_ = std::move(series);
  reference_name_ = name;
  difference_channels_ = std::move(channels);
}

void FieldSeries::rehearse() {
  update(0);
  if (reference_) reference_->rehearse();
}

std::vector<std::string> FieldSeries::warnings() const {
  std::vector<std::string> all = solver_.warnings();
  if (!reference_) return all;
  for (const std::string& warning : reference_->warnings()) all.push_back(reference_name_ + ": " + warning);
  return all;
}

void FieldSeries::update(int step) {
  throwIfStopped(stop_);
  if (step == updated_step_) return;
  updated_step_ = -1;
  if (solver_.update(snapshot(step), input_.terrain).any) changed_since_given_ = true;
  updated_step_ = step;
}

std::vector<ValueRange> FieldSeries::findRanges(int stride, const ProgressSink& progress) {
  std::vector<ValueRange> ranges(channels().size());
  for (int step = 0; step < count(); step += stride) {
    update(step);
    const std::vector<ValueRange> own = rangesOf(solver_.volumes());
    for (std::size_t c = 0; c < ranges.size(); ++c) ranges[c].add(own[c]);
    if (progress) progress("value range", static_cast<double>(step + 1) / count());
  }
  return ranges;
}

std::vector<volume::Volume> FieldSeries::compute(int step) {
  update(step);
  changed_ = std::exchange(changed_since_given_, false);
  const scenario::Snapshot now = snapshot(step);
  std::vector<volume::Volume> volumes = solver_.volumes();
  for (volume::Volume& volume : volumes) {
    // The solver does not change an unchanged volume, including its time.
    volume::VolumeInfo info = volume.info();
    info.time_s = now.time_s;
    info.time_utc = now.time_utc;
    volume.setInfo(std::move(info));
  }
  if (!reference_) return volumes;
  const std::vector<volume::Volume> others = reference_->compute(step);
  for (std::size_t c = 0; c < volumes.size(); ++c) {
    volumes[c] = differenceOf(volumes[c], others[c], reference_name_);
  }
  changed_ = changed_ || reference_->changed();
  return volumes;
}

}  // namespace emscape::playback
