/// Volumes at a list of times: a scenario's field.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/progress.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/playback/frames/inputs.h"
#include "emscape/scenario/model/snapshot.h"
#include "emscape/volume/value_range.h"
#include "emscape/volume/volume.h"

namespace emscape::playback {

/// Volumes of one or several quantities at a list of times: computed, or from files.
class VolumeSeries {
 public:
  virtual ~VolumeSeries() = default;
  /// Number of steps, at least 1.
  virtual int count() const = 0;
  /// Time of a step, ascending.
  virtual double time_s(int step) const = 0;
  /// The volumes of a step; info() has their own range and the time of the step. @throws Error, Stopped
  virtual std::vector<volume::Volume> compute(int step) = 0;
  /// True if there are volumes between the steps, too: at any time between the first and the last.
  virtual bool isContinuous() const { return false; }
  /// The volumes at a time; if the series is not continuous, those of the nearest step. @throws as compute()
  virtual std::vector<volume::Volume> computeAt(double time_s) { return compute(nearestIndex(time_s)); }
  /// The models' warnings on the steps so far.
  virtual std::vector<std::string> warnings() const = 0;

  /// The step with the nearest time; of two equally near, the earlier. @param time_s any, beyond the ends too
  int nearestIndex(double time_s) const;
};

using volume::ValueRange;

class DifferenceSeries;

/// The range of each volume.
std::vector<ValueRange> rangesOf(const std::vector<volume::Volume>& volumes);

/// Computes the field of a scenario at a list of times. For one thread.
class FieldSeries : public VolumeSeries {
 public:
  /// @param times_s  ascending
  /// @param stop     ends the work between two steps; may be null, else outlives this
  /// @throws Error (bad_input, device)
  FieldSeries(LoadedScenario input, std::vector<double> times_s, const emfield::FieldOptions& options,
              const StopFlag* stop = nullptr);
  ~FieldSeries() override;

  int count() const override { return static_cast<int>(times_s_.size()); }
  double time_s(int step) const override { return times_s_[static_cast<std::size_t>(step)]; }
  const std::vector<double>& times_s() const { return times_s_; }
  const std::vector<emfield::Channel>& channels() const {
    return difference_ ? difference_channels_ : solver_.channels();
  }
  const LoadedScenario& input() const { return input_; }
  /// May be null.
  const StopFlag* stopFlag() const { return stop_; }
  const emfield::FieldOptions& options() const { return options_; }
  scenario::Snapshot snapshotAt(double time_s) const;

  /// Changes the scenario: results that an edit does not invalidate are kept. Faults that only the
  /// computation detects are thrown by the next compute().
  /// @param times_s  ascending
  void setScenario(LoadedScenario input, std::vector<double> times_s);

  /// Computes other quantities from now on; channels() has them after the next compute(). The same faults are
  /// thrown here. Must not be called after compareWith().
  /// @throws Error (bad_input); nothing is changed then
  void setQuantities(const std::vector<std::string>& quantities);

  /// From now on compute() gives differences (volume::difference()) to the volumes of a reference at the same
  /// times. setScenario() must not be called after it.
  /// @param name  of the reference, for legends
  /// @throws Error (bad_input) if the grids or channels differ, or for indices; (device)
  void compareWith(const LoadedScenario& reference, const std::string& name);
  /// Null without a reference.
  const LoadedScenario* reference() const { return reference_ ? &*reference_ : nullptr; }

  /// Computes the first step, so that its errors are thrown here. @throws Error, Stopped
  void rehearse();

  /// FieldSolver::setTimeGoal() of the next computed fields; the reference has all columns.
  void setTimeGoal(double goal_ms);
  /// FieldSolver::columnStep() of the last field.
  int columnStep() const { return solver_.columnStep(); }

  /// The channels' volumes at a step, or their differences. The last computed step is not recomputed.
  std::vector<volume::Volume> compute(int step) override { return computeAt(time_s(step)); }
  bool isContinuous() const override { return true; }
  std::vector<volume::Volume> computeAt(double time_s) override;

  /// False if the last volumes of compute() are those of the call before; true for differences.
  bool changed() const { return changed_; }
  std::vector<std::string> warnings() const override;

 private:
  void update(double time_s);

  LoadedScenario input_;
  std::vector<double> times_s_;
  emfield::FieldOptions options_;
  const StopFlag* stop_;
  emfield::FieldSolver solver_;
  std::optional<LoadedScenario> reference_;
  std::unique_ptr<DifferenceSeries> difference_;
  std::vector<emfield::Channel> difference_channels_;
  std::optional<double> updated_s_;  // time of the solver's field
  double goal_ms_ = 0;
  bool changed_since_given_ = false;  // by an update since the last compute()
  bool changed_ = true;
};

}  // namespace emscape::playback
