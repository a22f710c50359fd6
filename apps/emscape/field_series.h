/// A scenario's field over a list of times.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/emscape/inputs.h"
#include "emscape/emfield/field_solver.h"
#include "emscape/scenario/snapshot.h"
#include "emscape/volume/value_range.h"
#include "emscape/volume/volume.h"

namespace emscape::app {

using volume::ValueRange;

/// Parses "MIN:MAX", MIN < MAX. @throws Error (usage)
ValueRange parseRange(const std::string& text);

class FieldSeries {
 public:
  FieldSeries(LoadedScenario input, std::vector<double> times_s, const emfield::FieldOptions& options);

  int count() const { return static_cast<int>(times_s_.size()); }
  double time_s(int step) const { return times_s_[static_cast<std::size_t>(step)]; }
  const std::vector<emfield::Channel>& channels() const { return solver_.channels(); }
  const LoadedScenario& input() const { return input_; }
  scenario::Snapshot snapshot(int step) const;

  /// Computes the first step: what that lacks is told now. @throws Error, Interrupted
  void rehearse() { update(0); }

  /// Computes steps to learn the range of each channel over them.
  /// @param stride  every so many steps; 1: the range of the whole series
  /// @param done    called after each step with the number of the next
  /// @throws Interrupted
  std::vector<ValueRange> findRanges(int stride, const std::function<void(int)>& done);

  /// The channels' volumes at a step; info.range_* as given, one range a channel.
  /// @throws Interrupted
  std::vector<volume::Volume> compute(int step, const std::vector<ValueRange>& ranges);

  /// Whether the last step that was computed differs from the one computed before it.
  bool changed() const { return changed_; }

  /// Those of the solver so far.
  std::vector<std::string> warnings() const { return solver_.warnings(); }

 private:
  scenario::Snapshot update(int step);

  LoadedScenario input_;
  std::vector<double> times_s_;
  emfield::FieldSolver solver_;
  bool changed_ = true;
};

}  // namespace emscape::app
