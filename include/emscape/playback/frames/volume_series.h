/// Volumes at a list of times.
#pragma once

#include <string>
#include <vector>

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

}  // namespace emscape::playback
