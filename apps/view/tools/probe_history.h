/// The value at a point over the steps of a series, computed in the background.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/worker.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/progress.h"
#include "emscape/playback/frames/inputs.h"

namespace emscape::view {

/// A point of a field.
struct HistoryQuestion {
  playback::LoadedScenario input;
  std::string channel;  ///< quantity, or channel such as "snr_db:search radar"
  double latitude_deg = 0, longitude_deg = 0, height_msl_m = 0;
  std::vector<double> times_s;  ///< ascending

  bool operator==(const HistoryQuestion& other) const;
};

/// Values by time; NaN where there is none, or none yet.
struct ValueHistory {
  std::vector<double> times_s;
  std::vector<float> values;
  std::size_t computed = 0;  ///< the first of them
  std::string unit;
  float floor = 0;    ///< values at or below it are no field
  std::string error;  ///< reason why there are no more values
};

/// Computes the field of the scenario at one point, step after step, by the solver of the volumes. A new
/// question ends the work for the one before. For use by one thread.
class ProbeHistory {
 public:
  /// @param wake  called on another thread when there are more values
  explicit ProbeHistory(std::function<void()> wake);
  ~ProbeHistory();
  ProbeHistory(const ProbeHistory&) = delete;
  ProbeHistory& operator=(const ProbeHistory&) = delete;

  /// Does nothing if this is the question already. At most 500 times are kept, at equal distances.
  void ask(HistoryQuestion question);
  /// Ends the work and drops the values.
  void clear();
  /// Takes new values. @return true if there are some
  bool update();
  const ValueHistory& values() const { return values_; }

 private:
  struct Work {
    StopFlag stop{false};
    std::mutex mutex;
    ValueHistory values;
  };
  static void compute(const HistoryQuestion& question, Work& work, const std::function<void()>& wake);

  const std::function<void()> wake_;
  HistoryQuestion question_;
  std::shared_ptr<Work> work_;
  ValueHistory values_;
  Worker worker_;
};

/// "t_s,QUANTITY_UNIT" and one line per computed time; without a field the value is empty.
std::string csvOf(const ValueHistory& history, const std::string& channel);

}  // namespace emscape::view
