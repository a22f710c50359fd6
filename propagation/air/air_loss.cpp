#include "propagation/air/air_loss.h"

#include <algorithm>

#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "propagation/air/gases.h"
#include "propagation/air/rain.h"

namespace emscape::propagation {
namespace {

/// Tilt angle (rad) of a polarisation, as P.838 defines it.
double tilt_rad(Polarization polarization) {
  if (polarization == Polarization::horizontal) return 0;
  return polarization == Polarization::vertical ? kPi / 2 : kPi / 4;
}

/// Specific attenuation of the air (dB/m) at every height. The standard atmosphere, its pressure and
/// temperature scaled to the scenario's values at sea level, with the scenario's vapour.
class GasProfile {
 public:
  GasProfile(const Atmosphere& atmosphere, double frequency_hz, double highest_msl_m) {
    const AirState sea = standardAtmosphere(0);
    const double lowest_m = kGasesHeight.min * kGasesHeight.si_per_unit;
    const double top_m = std::min(std::max(highest_msl_m, 0.0), kGasesHeight.max * kGasesHeight.si_per_unit);
    const int count = static_cast<int>((top_m - lowest_m) / kStep_m) + 2;
    for (int i = 0; i < count; ++i) {
      const double height_m = lowest_m + i * kStep_m;
      AirState air = standardAtmosphere(height_m, atmosphere.vapour_g_m3);
      air.pressure_hpa *= atmosphere.pressure_hpa / sea.pressure_hpa;
      air.temperature_k *= atmosphere.temperature_k / sea.temperature_k;
      const double vapour_hpa = std::min(air.vapourPressure_hpa(), air.pressure_hpa);
      // The line-by-line sum also below 1 GHz, where the value of P.676 at 1 GHz would be too large.
      gamma_.push_back(lineByLineGasAttenuation(frequency_hz, air.pressure_hpa - vapour_hpa,
                                                air.temperature_k, air.vapour_g_m3)
                           .total_db_per_km() /
                       1000);
    }
  }

  double at(double height_msl_m) const {
    const double position =
        std::clamp(height_msl_m / kStep_m - kGasesHeight.min * kGasesHeight.si_per_unit / kStep_m, 0.0,
                   static_cast<double>(gamma_.size()) - 1.001);
    const auto below = static_cast<std::size_t>(position);
    return gamma_[below] + (position - static_cast<double>(below)) * (gamma_[below + 1] - gamma_[below]);
  }

 private:
  static constexpr double kStep_m = 50;
  std::vector<double> gamma_;
};

/// Mean along the ray, straight over the effective earth, by Simpson's rule.
double meanAlong(const GasProfile& profile, double from_msl_m, double to_msl_m, double range_m,
                 double effective_earth_radius_m) {
  constexpr int kIntervals = 64;
  const double sag_m = range_m * range_m / (2 * effective_earth_radius_m);
  double sum = 0;
  for (int i = 0; i <= kIntervals; ++i) {
    const double t = static_cast<double>(i) / kIntervals;
    const double height_m = from_msl_m + t * (to_msl_m - from_msl_m) - t * (1 - t) * sag_m;
    sum += (i == 0 || i == kIntervals ? 1 : i % 2 == 1 ? 4 : 2) * profile.at(height_m);
  }
  return sum / (3 * kIntervals);
}

}  // namespace

double rainHeight_m(double latitude_deg) {
  if (latitude_deg > 23) return 1000 * std::max(5 - 0.075 * (latitude_deg - 23), 0.0);
  if (latitude_deg >= -21) return 5000;
  return 1000 * std::max(5 + 0.1 * (latitude_deg + 21), 0.0);
}

AirLoss airLoss(const PathInputs& inputs, bool with_gases, std::vector<float>& gases) {
  const EmitterInputs& emitter = inputs.emitter;
  const Atmosphere& atmosphere = emitter.atmosphere;
  const PathExtent& extent = inputs.extent;
  const double station_msl_m = inputs.site.height_msl_m, earth_radius_m = inputs.site.earth_radius_m;
  AirLoss air;
  air.station_msl_m = static_cast<float>(station_msl_m);
  air.earth_radius_m = static_cast<float>(earth_radius_m);
  air.effective_earth_radius_m = static_cast<float>(earth_radius_m * atmosphere.k_factor);

  if (atmosphere.rain_mm_h > 0) {
    const auto rain = [&](double elevation_rad) {
      const double per_km =
          rainCoefficients(emitter.frequency_hz, elevation_rad, tilt_rad(emitter.polarization))
              .specificAttenuation_db_per_km(atmosphere.rain_mm_h);
      return static_cast<float>(per_km / 1000);
    };
    air.level_rain = rain(0);
    air.upright_rain = rain(kPi / 2);
    air.rain_top_msl_m =
        static_cast<float>(atmosphere.rain_height_m.value_or(rainHeight_m(inputs.site.latitude_deg)));
  }

  if (with_gases) {
    air.range_count = 49;
    air.height_count = 129;
    const double range_step_m = std::max(extent.farthest_m, 1.0) / (air.range_count - 1);
    const double height_step_m =
        std::max(extent.highest_msl_m - extent.lowest_msl_m, 1.0) / (air.height_count - 1);
    air.ranges_per_m = static_cast<float>(1 / range_step_m);
    air.lowest_msl_m = static_cast<float>(extent.lowest_msl_m);
    air.heights_per_m = static_cast<float>(1 / height_step_m);
    const GasProfile profile(atmosphere, emitter.frequency_hz, std::max(extent.highest_msl_m, station_msl_m));
    gases.resize(static_cast<std::size_t>(air.range_count) * air.height_count);
    parallelFor(air.range_count, 1, [&](int begin, int end) {
      for (int r = begin; r < end; ++r) {
        for (int h = 0; h < air.height_count; ++h) {
          gases[static_cast<std::size_t>(r) * air.height_count + h] =
              static_cast<float>(meanAlong(profile, station_msl_m, extent.lowest_msl_m + h * height_step_m,
                                           r * range_step_m, earth_radius_m * atmosphere.k_factor));
        }
      }
    });
    air.gases = gases.data();
  }
  return air;
}

}  // namespace emscape::propagation
