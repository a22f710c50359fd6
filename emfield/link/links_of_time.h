/// The rows of links and detections, time after time.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "emfield/radar/detection.h"
#include "emscape/emfield/link/link.h"
#include "emscape/emfield/link/path_budget.h"
#include "emscape/emfield/solver/steep_ground.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::emfield {

/// One receiver and all emitters in its band. One thread at a time may use an object.
class ReceiverListener {
 public:
  ReceiverListener(const scenario::Scenario& scenario, int receiver, const LinkOptions& options);

  /// Adds a row to every link.
  /// @param is_last  no other time follows: the budgets of the paths are released
  void add(const scenario::Snapshot& snapshot, const scenario::Terrain* terrain, bool is_last);

  std::vector<Link> links;  ///< of the selected emitters in the band, on other platforms
  std::vector<std::string> warnings;
  SteepGrounds steep;  ///< of each emitter the path that loses most

 private:
  /// An emitter's wave at the receiver.
  struct Wave {
    bool is_needed = false;  ///< selected, or in the band of a link
    propagation::PropagationModel model{};
    std::unique_ptr<PathBudget> budget;  ///< of the last time with a path; may be null
    bool is_present = false;             ///< radiates, with a path
    bool is_unknown = false;             ///< its path crosses missing terrain
    double power_density_wm2 = 0;        ///< if present
    double area_m2 = 0;                  ///< of the receiver for the wave, inBandArea_m2()
  };

  void receive(int emitter, const scenario::Snapshot& snapshot, const scenario::Terrain* terrain);
  /// Power (W) of each wave within the band when the receiver is tuned to a frequency; 0: not present.
  void findPowers(const scenario::Scenario& scenario, double tuned_hz, std::vector<double>& powers_w) const;

  int receiver_;
  std::vector<Wave> waves_;  ///< one per emitter
};

/// A copy of the scenario at one instant, into which the values of one target after another are put. One
/// thread at a time may use it.
struct TargetScene {
  std::shared_ptr<scenario::Scenario> scenario;
  scenario::Snapshot snapshot;  ///< of `scenario`
};

/// Scenes for watchers, as many as are used at a time. Thread-safe.
class TargetScenes {
 public:
  /// A scene at an instant; its emitters are those of the snapshot's scenario.
  std::unique_ptr<TargetScene> take(const scenario::Snapshot& snapshot);
  void giveBack(std::unique_ptr<TargetScene> scene);

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<TargetScene>> free_;
};

/// One radar and one target. One thread at a time may use an object.
class TargetWatcher {
 public:
  TargetWatcher(const scenario::Scenario& scenario, int radar, int target, const LinkOptions& options);

  /// Adds a row.
  void add(const scenario::Snapshot& snapshot, const scenario::Terrain* terrain, TargetScenes& scenes);

  Detection detection;
  std::vector<std::string> warnings;
  SteepGrounds steep;  ///< the path that loses most

 private:
  /// Looks at the target between the first time and another, the first look at the first time.
  long long looksUntil(double time_s) const;

  propagation::PropagationModel model_;
  std::optional<double> period_s_;               ///< between looks; none: every row is a look
  double missed_ = 1;                            ///< prod(1 - Pd)
  std::shared_ptr<const DetectionCurve> curve_;  ///< held, so that all rows share it
};

}  // namespace emscape::emfield
