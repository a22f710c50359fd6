#include <algorithm>
#include <cmath>

#include "emscape/base/units.h"
#include "emscape/scenario/model/quantities.h"

namespace emscape::scenario {
namespace {

/// Levels of one group; f is the frequency in MHz.
struct Levels {
  double electric_v_m;     ///< 0.1 to 30 MHz: over f^0.7
  double magnetic_a_m;     ///< 0.1 to 30 MHz: over f
  double vhf_wm2;          ///< above 30 to 400 MHz
  double uhf_wm2_per_mhz;  ///< above 400 MHz to 2 GHz: times f
  double microwave_wm2;    ///< above 2 to 300 GHz
};
constexpr Levels kGeneralPublic{300, 2.2, 2, 1 / 200.0, 10};
constexpr Levels kOccupational{660, 4.9, 10, 1 / 40.0, 50};

}  // namespace

std::optional<double> referenceLevel_wm2(ExposureGroup group, double frequency_hz) {
  const Levels& levels = group == ExposureGroup::occupational ? kOccupational : kGeneralPublic;
  const double f_mhz = frequency_hz / 1e6;
  if (!(f_mhz >= 0.1 && f_mhz <= 300e3)) return {};
  if (f_mhz > 2000) return levels.microwave_wm2;
  if (f_mhz > 400) return levels.uhf_wm2_per_mhz * f_mhz;
  if (f_mhz > 30) return levels.vhf_wm2;
  const double electric_v_m = levels.electric_v_m / std::pow(f_mhz, 0.7);
  const double magnetic_a_m = levels.magnetic_a_m / f_mhz;
  return std::min(electric_v_m * electric_v_m / kFreeSpaceImpedance,
                  magnetic_a_m * magnetic_a_m * kFreeSpaceImpedance);
}

}  // namespace emscape::scenario
