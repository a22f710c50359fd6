/// Points of the ellipsoid at many places close to each other.
#pragma once

#include <cmath>

#include "base/fast_geodesy.h"
#include "base/near_angle.h"
#include "emscape/base/units.h"
#include "emscape/base/vec.h"

namespace emscape {

/// toEcef() at height 0, without its calls of sine and cosine. Results do not depend on the places that were
/// asked before.
/// @accuracy 1e-8 m
class NearEcef {
 public:
  /// @param latitude_deg  -90..90, longitude_deg any
  Vec3d at(double latitude_deg, double longitude_deg) {
    const SineCosine latitude = latitude_.at(degToRad(latitude_deg));
    const SineCosine longitude = longitude_.at(degToRad(longitude_deg));
    const double prime_m =
        kWgs84SemiMajor_m / std::sqrt(1 - kWgs84EccentricitySquared * latitude.sine * latitude.sine);
    const double axial_m = prime_m * latitude.cosine;
    return {axial_m * longitude.cosine, axial_m * longitude.sine,
            (1 - kWgs84EccentricitySquared) * prime_m * latitude.sine};
  }

 private:
  NearAngle latitude_, longitude_;
};

}  // namespace emscape
