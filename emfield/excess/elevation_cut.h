/// The vertical cut through an antenna's beam, which some models use as source instead of an isotropic one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::emfield {

/// The same for all azimuths of an antenna that turns about the vertical.
struct ElevationCut {
  scenario::AntennaPtr antenna;
  Vec3d zenith;        ///< in the antenna's frame (forward, right, up)
  double steer_v = 0;  ///< as BeamPose

  /// Amplitude (relative voltage, with the field's sign) at an angle above the horizontal, in the vertical
  /// plane through the antenna's forward.
  double operator()(double elevation_rad) const;
};

/// The cut that an emitter's model uses; none if the source or the antenna is isotropic.
std::optional<ElevationCut> elevationCut(const scenario::Emitter& emitter, const scenario::BeamPose& beam);

/// @throws Error (bad_input) at the emitter's settings if its model uses a cut and the beam moves in
/// elevation, by its scan or towards the targets of radars
void checkElevationCut(const scenario::Scenario& scenario, const scenario::Emitter& emitter);

/// A warning if the parabolic equation marches the field of an isotropic source for a beam that points more
/// than half its width above or below the horizon by its scan: the rays it weighs alike are not.
std::vector<std::string> tiltWarnings(const scenario::Scenario& scenario, const scenario::Emitter& emitter);

}  // namespace emscape::emfield
