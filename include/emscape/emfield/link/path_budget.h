/// The link budget of one path: from the transmitter's power to the power density at a point, term by term.
///
/// It explains missing coverage. The result equals the field's value at that point for this emitter; both use
/// the same functions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/emfield/link/path_profile.h"
#include "emscape/propagation/explanation.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::emfield {

/// A propagation model's excess loss on one path, and its parts.
struct PathExcess : propagation::Explanation {
  std::vector<std::string> warnings;
  double clutter_db = 0;  ///< part of the loss that trees and buildings cause, along the path and at its ends
  PathCover cover;        ///< that the model reads; without posts: nothing stands on the path
};

/// Uses the functions that compute the field's voxels, except for p528, which computes its curve instead of
/// reading the field's table.
/// @param emitter     with the model to use, at the beginning of the profile
/// @param beam        of the emitter
/// @param terrain     null: none
/// @throws Error (bad_input) if the model refuses an input
PathExcess pathExcess(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                      const scenario::BeamPose& beam, const PathProfile& profile,
                      const scenario::Terrain* terrain);

/// Geometry of the path.
struct PathGeometry {
  double slant_range_m = 0;
  double straight_elevation_rad = 0;  ///< of the straight line, at the emitter
  double launch_elevation_rad = 0;    ///< of the refracted ray's start
  double begin_ground_msl_m = 0, end_ground_msl_m = 0;
  double horizon_range_m =
      0;  ///< distance beyond which a smooth earth at mean sea level obstructs the line of sight
  double far_field_m = 0;  ///< 2 D^2 / lambda
};

/// Direction of a ray in the antenna's pattern.
struct RayPointing {
  double off_axis_rad = 0;  ///< between the ray's start and the beam's axis
  double azimuth_rad = 0;   ///< in the antenna's frame, clockwise from its boresight
  double elevation_rad = 0;
  double amplitude = 1;   ///< of the pattern, -1..1, with the sign of the field
  double pattern_db = 0;  ///< gain relative to the pattern's maximum, <= 0
};

/// The direct ray in the pattern, and the reflected ray for models that have one.
struct PathPointing : RayPointing {
  std::optional<RayPointing> reflected;
};

/// A jammer in a radar's band.
struct PathJammer {
  std::string name;
  double to_signal_db = 0;  ///< its mean power over that of the echo, with the beam on the target
  double blanked_part = 0;  ///< part (0..1) of its pulses that the radar's side-lobe blanker shuts out if it
                            ///< jams alone
  double probability_without = 0;  ///< of detection, if the others jam
};

/// What jamming does to a radar's detection.
struct PathJamming {
  std::vector<PathJammer> jammers;  ///< by their power at the radar, the largest first; empty: no jamming
  double unjammed_probability = 0;  ///< of detection

  /// Probabilities of detection against noise and jamming, in any range, without clutter and one of the
  /// losses of the path.
  struct WithoutClutterAnd {
    double nothing = 0, ground_cover = 0, terrain = 0, pointing = 0;
  };
  /// Of a target that is not detected (Pd < 0.5); else empty.
  std::optional<WithoutClutterAnd> without_clutter;
  double unjammed_in_any_range = 0;  ///< probability of detection without limits of range, too
  /// By how much the echo is too weak (dB) for detection (Pd 0.5) against noise and jamming, without clutter
  /// and in any range; empty if the target is detected, or not with an echo 200 dB stronger.
  std::optional<double> missing_db;
};

/// One line of the budget.
struct BudgetTerm {
  enum class Kind { part, sum };
  std::string key;    ///< stable, for programs
  std::string label;  ///< for people
  double value = 0;
  std::string unit;
  std::string note;  ///< origin of the value; may be empty
  Kind kind = Kind::part;
};

struct PathBudget {
  std::string emitter;
  double time_s = 0;
  bool active = true;
  double frequency_hz = 0;
  double k_factor = 0;
  PathProfile profile;
  PathGeometry geometry;
  PathPointing pointing;
  /// For the terms of detection of a radar whose beam follows the target (RadarLook::target, not a fixed
  /// scan): gain of that beam towards the end of the path, relative to its maximum (dB), <= 0.
  std::optional<double> look_pattern_db;
  bool has_fixed_beam = false;          ///< the radar's beam turns to no target: a fixed scan, of no array
  PathJamming jamming;                  ///< of the terms of detection
  std::string unheard;                  ///< why the radar detects nothing from this range; empty: it may
  double probability_in_any_range = 0;  ///< of detection, without the limit of `unheard`
  std::vector<PathObstacle> obstacles;
  propagation::PropagationModel model = propagation::PropagationModel::free_space;
  PathExcess excess;
  /// Power density at the path's end if the antenna had its maximum gain along every ray.
  double boresight_dbwm2 = 0;
  std::vector<BudgetTerm> terms;
  /// Without that of PathExcess::steep, which is for all paths of the emitter together
  /// (steepGroundWarnings()).
  std::vector<std::string> warnings;
  std::string verdict;  ///< one sentence

  /// Null if the budget has no such term.
  const BudgetTerm* find(const std::string& key) const;
};

/// The budget of a path. If the emitter is a radar, it includes the terms of detection of a target at the
/// path's end.
/// @param emitter  index into the snapshot
/// @param point    the far end of the path
/// @param terrain  null: a smooth earth at mean sea level
/// @throws Error (bad_input) as readPathProfile and pathExcess do
PathBudget pathBudget(const scenario::Snapshot& snapshot, int emitter, const PathEnd& point,
                      propagation::PropagationModel model, const scenario::Terrain* terrain);

/// The same without the terms of detection: for receivers.
/// @param earlier  null, or an earlier result for the same emitter, model and terrain: its profile and losses
/// are reused if neither end has moved since
PathBudget powerBudget(const scenario::Snapshot& snapshot, int emitter, const PathEnd& point,
                       propagation::PropagationModel model, const scenario::Terrain* terrain,
                       const PathBudget* earlier = nullptr);

}  // namespace emscape::emfield
