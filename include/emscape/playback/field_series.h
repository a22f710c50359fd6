/// A scenario's field over a list of times.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emscape/base/progress.h"
#include "emscape/emfield/field_solver.h"
#include "emscape/playback/inputs.h"
#include "emscape/scenario/snapshot.h"
#include "emscape/volume/value_range.h"
#include "emscape/volume/volume.h"

namespace emscape::playback {

using volume::ValueRange;

/// Each volume's own range.
std::vector<ValueRange> rangesOf(const std::vector<volume::Volume>& volumes);
/// Sets info().range_* of each volume; to its floor where the range is empty. @param ranges  one per volume
void setRanges(std::vector<volume::Volume>& volumes, const std::vector<ValueRange>& ranges);
/// Every so many-th step of a series is searched for the range of its colours: at most 24 of them.
int rangeSearchStride(int steps);

/// One thread uses it.
class FieldSeries {
 public:
  /// @param times_s  ascending
  /// @param stop     ends the work between two steps; may be null, else outlives this
  /// @throws Error (bad_input, device)
  FieldSeries(LoadedScenario input, std::vector<double> times_s, const emfield::FieldOptions& options,
              const StopFlag* stop = nullptr);

  int count() const { return static_cast<int>(times_s_.size()); }
  double time_s(int step) const { return times_s_[static_cast<std::size_t>(step)]; }
  const std::vector<double>& times_s() const { return times_s_; }
  const std::vector<emfield::Channel>& channels() const {
    return reference_ ? difference_channels_ : solver_.channels();
  }
  const LoadedScenario& input() const { return input_; }
  /// May be null.
  const StopFlag* stopFlag() const { return stop_; }
  const emfield::FieldOptions& options() const { return options_; }
  scenario::Snapshot snapshot(int step) const;

  /// Another scenario from now on: what an edit left as it was is not computed again. Faults that show only
  /// in computing are told by the next compute().
  /// @param times_s  ascending
  void setScenario(LoadedScenario input, std::vector<double> times_s);

  /// Volumes are from now on the differences (volume::difference()) to those of a reference at the same
  /// times, and channels have the names of differences. Not to be followed by setScenario().
  /// @param name  of the reference, for legends
  /// @throws Error (bad_input) for another grid, other channels and indices, (device)
  void compareWith(const LoadedScenario& reference, const std::string& name);
  /// Null without one.
  const LoadedScenario* reference() const { return reference_ ? &reference_->input() : nullptr; }

  /// Computes the first step, so that what it lacks is told now. @throws Error, Stopped
  void rehearse();

  /// Computes every `stride`-th step to learn the range of each channel over them; not with a reference.
  /// @param progress  may be empty
  /// @throws Error, Stopped
  std::vector<ValueRange> findRanges(int stride, const ProgressSink& progress);

  /// The channels' volumes at a step, or their differences; info().range_* are each volume's own. The step
  /// that was computed last is not computed again. @throws Error, Stopped
  std::vector<volume::Volume> compute(int step);

  /// Whether the volumes that compute() gave last differ from those that it gave before.
  bool changed() const { return changed_; }
  /// Updates of the solver so far.
  long long updates() const { return updates_; }
  /// Those of the solver so far.
  std::vector<std::string> warnings() const;

 private:
  void update(int step);

  LoadedScenario input_;
  std::vector<double> times_s_;
  emfield::FieldOptions options_;
  const StopFlag* stop_;
  emfield::FieldSolver solver_;
  std::unique_ptr<FieldSeries> reference_;
  std::string reference_name_;
  std::vector<emfield::Channel> difference_channels_;
  int updated_step_ = -1;
  bool changed_since_given_ = false;  // by an update since the last compute()
  bool changed_ = true;
  long long updates_ = 0;
};

}  // namespace emscape::playback
