#include "emscape/scenario/antenna/antenna.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/units.h"
#include "scenario/antenna/directivity.h"

namespace emscape::scenario {

double Antenna::amplitudeTowards(const Vec3d& direction, double steer_u, double steer_v) const {
  return std::abs(signedAmplitudeTowards(direction, steer_u, steer_v));
}

double Antenna::apertureDimension_m(double wavelength_m) const {
  const double narrower_deg = std::min(beamwidth_az_deg, beamwidth_el_deg);
  return narrower_deg < 180 ? aperture_factor * wavelength_m / degToRad(narrower_deg) : 0;
}

double Antenna::directivity_dbi() const {
  std::call_once(directivity_once_,
                 [this] { directivity_dbi_ = ratioToDb(4 * kPi / patternIntegral_sr(view())); });
  return directivity_dbi_;
}

}  // namespace emscape::scenario
