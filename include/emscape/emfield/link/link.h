/// Links over time: emitters received by receivers, and targets observed by radars.
///
/// A row equals the result of `pathBudget` for the same ends and time; both use the same functions.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/progress.h"
#include "emscape/propagation/settings.h"
#include "emscape/scenario/model/scenario.h"

namespace emscape::emfield {

struct LinkOptions {
  std::vector<double> times_s;  ///< since the epoch, ascending
  /// Indices into Scenario::emitters, placed_receivers and targets.
  std::vector<int> emitters, receivers, targets;
  /// Model for the selected emitters; none: their own models. Interfering emitters and jammers keep their
  /// own.
  std::optional<propagation::PropagationModel> model;
};

/// Conditions that a row of a link and one of a detection share.
struct PathRow {
  double time_s = 0;
  bool active = true;  ///< the emitter radiates; if not, powers are -infinity
  /// False: no path is computed, because an end is absent or vertically above the other.
  bool has_path = true;
  double range_m = 0;  ///< slant
  double power_density_dbwm2 = 0;
  double pattern_db = 0;    ///< emitter's antenna towards the other end, relative to its maximum
  double off_axis_rad = 0;  ///< of the ray from the axis of the emitter's beam
  bool is_blocked = false;  ///< ground, the earth's bulge, trees or buildings are above the ray
  std::string verdict;      ///< one sentence: that of the budget
  std::string path;         ///< the same without antenna and detection
};

/// An emitter at a receiver at one time.
struct LinkRow : PathRow {
  double received_power_dbm = 0;  ///< within the receiver's band, after its losses
  /// Sum of all other active emitters in the band, except those on the receiver's own platform.
  double interference_dbm = 0;
  double noise_dbm = 0;
  double sinr_db = 0;              ///< received power over noise and interference
  double jammer_to_signal_db = 0;  ///< jammers in the band over received power; -infinity without
  bool is_received = false;        ///< meets the receiver's thresholds
};

struct Link {
  int emitter = 0, receiver = 0;
  std::vector<LinkRow> rows;  ///< one per time

  std::optional<double> firstReceived_s() const;
  std::optional<double> lastReceived_s() const;
  /// Fraction (0..1) of the times at which the signal is received.
  double receivedShare() const;
};

/// A target observed by a radar at one time, with the radar's beam as close to the target as its scan
/// permits.
struct DetectionRow : PathRow {
  /// Of the radar's beam at its look at the target, relative to its maximum: far below 0 if the scan does not
  /// reach there.
  double look_pattern_db = 0;
  double rcs_m2 = 0;    ///< from the radar's aspect; NaN: an end is absent
  double snr_db = 0;    ///< one pulse
  double sclnr_db = 0;  ///< echo over clutter and noise after the radar's filter; snr_db without clutter
  std::optional<double>
      radial_speed_mps;  ///< of the target, positive away from the radar; only for radars with clutter
  double jammer_to_signal_db = 0;
  double detection_probability = 0;   ///< of one look
  int looks = 0;                      ///< since the row before
  double cumulative_probability = 0;  ///< 1 - prod(1 - Pd) over all looks so far
};

struct Detection {
  int radar = 0, target = 0;
  std::vector<DetectionRow> rows;  ///< one per time

  /// The first time at which one look detects with a probability of at least 1/2.
  std::optional<double> firstDetection_s() const;
};

struct LinkReport {
  std::vector<Link> links;            ///< by emitter, then receiver
  std::vector<Detection> detections;  ///< by radar, then target
  std::vector<std::string> warnings;  ///< each once
};

/// All pairs of the selected emitters and receivers, and of the selected radars and targets, except those on
/// one platform and emitters outside the receiver's band.
/// @param terrain   null: a smooth earth at mean sea level
/// @param progress  may be empty; called by the calling thread, at most a thousand times
/// @throws Error (bad_input) as snapshotAt and pathBudget do, with the pair and the time
LinkReport computeLinks(const std::shared_ptr<const scenario::Scenario>& scenario,
                        const scenario::Terrain* terrain, const LinkOptions& options,
                        const ProgressSink& progress = {});

}  // namespace emscape::emfield
