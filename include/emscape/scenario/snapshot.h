/// The scenario at one instant: the input of emfield.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "emscape/scenario/scenario.h"

namespace emscape::scenario {

/// Position of a platform.
struct PlatformState {
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
  bool active = true;  ///< at the time, or at some time of the output's interval that begins there
  GeodeticPosition position;
  double height_msl_m = 0;
  BeamPose beam;
  /// The frame in which the beam can be turned onto a target: the platform's axes, turned to the centre of a
  /// sector or raster scan in azimuth; for a steered array, its boresight.
  BeamPose mount;
};

/// States are in the order of Scenario::platforms and Scenario::emitters.
struct Snapshot {
  double time_s = 0;
  std::string time_utc;
  std::shared_ptr<const Scenario> scenario;
  std::vector<PlatformState> platforms;
  std::vector<EmitterState> emitters;
};

/// A pose turned in azimuth about its own up, clockwise, then in elevation about its new right, upwards.
BeamPose aimed(BeamPose pose, double azimuth_deg, double elevation_deg);

/// True if an emitter's beam is steered electronically: a phased array with dwells or a fixed scan.
bool isSteered(const Emitter& emitter);

/// The scenario at t_s seconds since its epoch. Pure. Thread-safe.
/// @param terrain  for heights above ground; may be null if no platform uses them
/// @throws Error (bad_input) if a height above ground is asked for where the terrain is missing, or a
/// platform is below ground
Snapshot snapshotAt(const std::shared_ptr<const Scenario>& scenario, const Terrain* terrain, double t_s);

}  // namespace emscape::scenario
