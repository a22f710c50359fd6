/// The rows of links and detections, time after time.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emfield/radar/detection.h"
#include "emscape/emfield/link.h"
#include "emscape/emfield/path_budget.h"
#include "emscape/scenario/snapshot.h"

namespace emscape::emfield {

/// One receiver and all emitters in its band. One thread at a time may use an object.
class ReceiverListener {
 public:
  ReceiverListener(const scenario::Scenario& scenario, int receiver, const LinkOptions& options);

  /// Adds a row to every link.
  void add(const scenario::Snapshot& snapshot, const scenario::Terrain* terrain);

  std::vector<Link> links;  ///< of the selected emitters in the band, on other platforms
  std::vector<std::string> warnings;

 private:
  /// An emitter's wave at the receiver.
  struct Wave {
    bool is_needed = false;  ///< selected, or in the band of a link
    propagation::PropagationModel model{};
    std::optional<PathBudget> budget;  ///< of the last time with a path
    bool is_present = false;           ///< radiates, with a path
    double range_m = 0;
    double pattern_db = 0;  ///< of the receiver's antenna towards the wave
  };

  void receive(int emitter, const scenario::Snapshot& snapshot, const scenario::Terrain* terrain);
  /// Power (W) of a wave in the band when the receiver is tuned to a frequency.
  double power_w(const scenario::Scenario& scenario, int emitter, double tuned_hz) const;

  int receiver_;
  std::vector<Wave> waves_;  ///< one per emitter
};

/// One radar and one target. One thread at a time may use an object.
class TargetWatcher {
 public:
  TargetWatcher(const scenario::Scenario& scenario, int radar, int target, const LinkOptions& options);

  /// Adds a row.
  void add(const scenario::Snapshot& snapshot, const scenario::Terrain* terrain);

  Detection detection;
  std::vector<std::string> warnings;

 private:
  /// Looks at the target between the first time and another, the first look at the first time.
  long long looksUntil(double time_s) const;

  std::shared_ptr<scenario::Scenario> own_;  ///< with the target's cross section and its fluctuation
  propagation::PropagationModel model_;
  std::optional<double> period_s_;               ///< between looks; none: every row is a look
  double missed_ = 1;                            ///< prod(1 - Pd)
  std::shared_ptr<const DetectionCurve> curve_;  ///< held, so that all rows share it
};

}  // namespace emscape::emfield
