/// A radar's contribution to a channel, from the state of its beam and the received jammers.
#pragma once

#include <optional>
#include <vector>

#include "emfield/combine/radar_product.h"
#include "emscape/base/vec.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::emfield {

/// The path of a jammer to a radar.
struct JammerPath {
  int jammer = 0;  ///< index of the emitter
  /// Unit vector from the radar along the start of the refracted ray to the jammer, east-north-up.
  Vec3d direction;
  /// At the radar, with the jammer's antenna gain, propagation model and losses; with `reflected` the gain is
  /// the larger one of the two rays.
  double power_density_wm2 = 0;

  /// The reflected ray of models that have one.
  struct Reflected {
    ReflectedRay ray;
    Vec3d direction;  ///< from the radar, as that of the direct ray
    /// Amplitudes of the jammer's pattern, with the field's sign.
    double direct_amplitude = 1, reflected_amplitude = 1;
  };
  std::optional<Reflected> reflected;
};

/// A radar's contribution to a channel at one instant.
/// @param task     that of the channel's plan
/// @param jammers  that count in the channel
RadarShare radarShare(const scenario::Scenario& scenario, int radar, const scenario::EmitterState& state,
                      const RadarTask& task, const std::vector<JammerPath>& jammers);

}  // namespace emscape::emfield
