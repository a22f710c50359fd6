#include "emscape/playback/frames/field_series.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/error.h"
#include "emscape/base/work.h"
#include "emscape/scenario/model/quantities.h"
#include "playback/frames/difference_series.h"
#include "scenario/file/far_outside.h"
#include "volume/difference.h"

namespace emscape::playback {

int VolumeSeries::nearestIndex(double time_s) const {
  int first = 0, last = count() - 1;
  while (last - first > 1) {  // time_s(first) <= time_s < time_s(last), or time_s is beyond an end
    const int middle = first + (last - first) / 2;
    (this->time_s(middle) <= time_s ? first : last) = middle;
  }
  return std::abs(this->time_s(last) - time_s) < std::abs(this->time_s(first) - time_s) ? last : first;
}

std::vector<ValueRange> rangesOf(const std::vector<volume::Volume>& volumes) {
  std::vector<ValueRange> ranges;
  for (const volume::Volume& volume : volumes) {
    ValueRange range;
    range.add({volume.info().range_min, volume.info().range_max});
    ranges.push_back(range);
  }
  return ranges;
}

FieldSeries::FieldSeries(LoadedScenario input, std::vector<double> times_s,
                         const emfield::FieldOptions& options, const StopFlag* stop)
    : input_(std::move(input)),
      times_s_(std::move(times_s)),
      options_(options),
      stop_(stop),
      solver_(input_.scenario, input_.terrain, options) {}

FieldSeries::~FieldSeries() = default;

scenario::Snapshot FieldSeries::snapshotAt(double time_s) const {
  return scenario::snapshotAt(input_.scenario, input_.terrain.get(), time_s);
}

void FieldSeries::setScenario(LoadedScenario input, std::vector<double> times_s) {
  input_ = std::move(input);
  times_s_ = std::move(times_s);
  updated_s_.reset();
}

void FieldSeries::setQuantities(const std::vector<std::string>& quantities) {
  solver_.setQuantities(quantities, input_.scenario);
  options_.quantities = quantities;
  updated_s_.reset();
}

void FieldSeries::compareWith(const LoadedScenario& reference, const std::string& name) {
  emfield::FieldOptions options = options_;
  options.move_tolerance_m = 0;  // else a step would depend on the previous steps
  const auto series = std::make_shared<FieldSeries>(reference, times_s_, options, stop_);
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
  reference_ = reference;
  difference_ = std::make_unique<DifferenceSeries>([series] { return series; }, name, 0);
  difference_channels_ = std::move(channels);
}

void FieldSeries::setTimeGoal(double goal_ms) {
  goal_ms_ = goal_ms;
  solver_.setTimeGoal(goal_ms);
}

void FieldSeries::rehearse() {
  update(time_s(0));
  if (difference_) difference_->reference(time_s(0));
}

std::vector<std::string> FieldSeries::warnings() const {
  std::vector<std::string> all = difference_ ? difference_->warnings(solver_.warnings()) : solver_.warnings();
  const std::string outside = scenario::outsideClockText(times_s_, input_.scenario->clock);
  if (!outside.empty()) all.push_back(outside);
  const std::string heights =
      scenario::outsideHeightsText(snapshotAt(times_s_.front()), input_.terrain.get());
  if (!heights.empty()) all.push_back(heights);
  return all;
}

void FieldSeries::update(double time_s) {
  throwIfStopped(stop_);
  if (time_s == updated_s_ && (goal_ms_ > 0 || columnStep() == 1)) return;
  updated_s_.reset();
  Work stoppable(stop_);
  const WorkScope scope(currentWork() != nullptr ? currentWork() : &stoppable);
  if (solver_.update(snapshotAt(time_s), input_.terrain).any) changed_since_given_ = true;
  updated_s_ = time_s;
}

std::vector<volume::Volume> FieldSeries::computeAt(double time_s) {
  update(time_s);
  changed_ = std::exchange(changed_since_given_, false) || difference_;
  return difference_ ? difference_->of(solver_.volumes(), time_s) : solver_.volumes();
}

}  // namespace emscape::playback
