/// The scenario at one instant: the input of emfield.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"

namespace emscape::scenario {

/// Position of a platform.
struct PlatformState {
  bool present = true;  ///< false: before or after its track; the position is that of the track's nearer end
  bool is_posed = false;  ///< at a stated pose, which holds as long as the snapshot is used, not on its track
  GeodeticPosition position;
  double height_msl_m = 0;
  Attitude attitude;
};

/// Orientation of a beam: unit vectors of the antenna's frame in the local east-north-up axes at the emitter.
struct BeamPose {
  Vec3d forward, right, up;
  double steer_u = 0;  ///< direction cosines (right, up) to which a phased array is steered
  double steer_v = 0;
};

struct EmitterState {
  /// Its platform is present, and it is active at the time or at some time of the output's interval that
  /// begins then.
  bool active = true;
  GeodeticPosition position;
  double height_msl_m = 0;
  BeamPose beam;
  /// The frame in which the beam can be turned to a target: the platform's axes, turned in azimuth to the
  /// centre of a sector or raster scan; for a steered array, its boresight.
  BeamPose mount;
};

struct ReceiverState {
  GeodeticPosition position;
  double height_msl_m = 0;
  BeamPose beam;
};

/// States are in the order of Scenario::platforms, Scenario::emitters and Scenario::placed_receivers.
struct Snapshot {
  double time_s = 0;
  std::string time_utc;
  std::shared_ptr<const Scenario> scenario;
  std::vector<PlatformState> platforms;
  std::vector<EmitterState> emitters;
  std::vector<ReceiverState> receivers;
};

/// Times in [begin, begin + duration) of a snapshot that begins then, at which an emitter is active and its
/// platform present, ascending, apart. A platform whose track reaches the end of the clock stays present
/// after it. Ends that differ from the interval's by rounding are the interval's.
std::vector<TimeInterval> activeTimes(const Snapshot& at, const Emitter& emitter, double duration_s);

/// A platform's axes (nose, right wing, up) in the local east-north-up axes.
BeamPose platformAxes(const Attitude& attitude);

/// A pose turned clockwise in azimuth about its own up axis, then upwards in elevation about its new right
/// axis.
BeamPose aimed(BeamPose pose, double azimuth_deg, double elevation_deg);

/// True if an emitter's beam is steered electronically: a phased array with dwells or a fixed scan.
bool isSteered(const Emitter& emitter);

/// The scenario at t_s seconds since its epoch. A pure, thread-safe function.
/// @param terrain  for heights above ground; may be null if no platform uses them
/// @throws Error (usage) as requireTime(); (bad_input) if a platform has a height above ground where terrain
/// is missing, or is below ground
Snapshot snapshotAt(const std::shared_ptr<const Scenario>& scenario, const Terrain* terrain, double t_s);

/// The same for paths and links, which have no interval: an emitter is active if it is active at t_s itself.
Snapshot instantAt(const std::shared_ptr<const Scenario>& scenario, const Terrain* terrain, double t_s);

}  // namespace emscape::scenario
