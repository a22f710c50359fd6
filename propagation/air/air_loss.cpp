#include "propagation/air/air_loss.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <list>
#include <memory>
#include <mutex>

#include "base/math/simd.h"
#include "emscape/base/error.h"
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

/// Specific attenuation of the air (dB/m) over height: the standard atmosphere, its pressure and temperature
/// scaled to the scenario's values at sea level, with the scenario's vapour.
struct GasProfile {
  static constexpr float kStep_m = 50;
  static constexpr float kLowest_m = static_cast<float>(kGasesHeight.min * kGasesHeight.si_per_unit);

  std::vector<float> gamma;  ///< every kStep_m from kLowest_m up

  GasProfile(double frequency_hz, const AirState& at_sea_level, int count) {
    const AirState sea = standardAtmosphere(0);
    for (int i = 0; i < count; ++i) {
      AirState air =
          standardAtmosphere(static_cast<double>(kLowest_m + i * kStep_m), at_sea_level.vapour_g_m3);
      air.pressure_hpa *= at_sea_level.pressure_hpa / sea.pressure_hpa;
      air.temperature_k *= at_sea_level.temperature_k / sea.temperature_k;
      const double vapour_hpa = std::min(air.vapourPressure_hpa(), air.pressure_hpa);
      // The line-by-line sum is also used below 1 GHz, where the value of P.676 at 1 GHz would be too large.
      const double per_km = lineByLineGasAttenuation(frequency_hz, air.pressure_hpa - vapour_hpa,
                                                     air.temperature_k, air.vapour_g_m3)
                                .total_db_per_km();
      gamma.push_back(static_cast<float>(per_km / 1000));
    }
  }
};

/// The profile up to a height. The last profiles are kept, because moving emitters need theirs at each step.
std::shared_ptr<const GasProfile> gasProfile(double frequency_hz, const Atmosphere& atmosphere,
                                             double highest_msl_m) {
  struct Kept {
    std::array<double, 4> key;
    std::shared_ptr<const GasProfile> profile;
  };
  static std::mutex mutex;
  static std::list<Kept> kept;  // last used first
  constexpr std::size_t kMaxKept = 256;
  constexpr double kRounding_m = 2000;  // so that a profile is reused after small changes of height
  const double top_m = std::clamp(kRounding_m * std::ceil(highest_msl_m / kRounding_m), 0.0,
                                  kGasesHeight.max * kGasesHeight.si_per_unit);
  const auto count = static_cast<std::size_t>((top_m - static_cast<double>(GasProfile::kLowest_m)) /
                                              static_cast<double>(GasProfile::kStep_m)) +
                     2;
  const std::array<double, 4> key{frequency_hz, atmosphere.pressure_hpa, atmosphere.temperature_k,
                                  atmosphere.vapour_g_m3};
  const auto isEnough = [&](const Kept& one) { return one.key == key && one.profile->gamma.size() >= count; };
  {
    const std::lock_guard lock(mutex);
    const auto found = std::find_if(kept.begin(), kept.end(), isEnough);
    if (found != kept.end()) {
      kept.splice(kept.begin(), kept, found);
      return kept.front().profile;
    }
  }
  auto made = std::make_shared<const GasProfile>(
      frequency_hz, AirState{atmosphere.pressure_hpa, atmosphere.temperature_k, atmosphere.vapour_g_m3},
      static_cast<int>(count));
  const std::lock_guard lock(mutex);
  kept.push_front({key, made});
  if (kept.size() > kMaxKept) kept.pop_back();
  return made;
}

/// Means along rays that are straight over the effective earth, from a station to points at one range.
/// @param to_msl_m, means  `count` numbers each
EMSCAPE_SIMD_CLONES void meansAlong(const GasProfile& profile, float from_msl_m, const float* to_msl_m,
                                    int count, float sag_m, float* means) {
  // Gauss-Legendre: Abramowitz and Stegun, table 25.4, n = 16.
  constexpr float kNodes[] = {0.095012509837637f, 0.281603550779259f, 0.458016777657227f, 0.617876244402644f,
                              0.755404408355003f, 0.865631202387832f, 0.944575023073233f, 0.989400934991650f};
  constexpr float kWeights[] = {0.189450610455068f, 0.182603415044924f, 0.169156519395003f,
                                0.149595988816577f, 0.124628971255534f, 0.095158511682493f,
                                0.062253523938648f, 0.027152459411754f};
  const float* const gamma = profile.gamma.data();
  const float last = static_cast<float>(profile.gamma.size() - 1) - 0.001f;
  std::fill_n(means, count, 0.0f);
  for (int n = 0; n < 16; ++n) {
    const float t = 0.5f + (n < 8 ? -0.5f : 0.5f) * kNodes[n % 8], weight = kWeights[n % 8] / 2;
    const float begin_m = from_msl_m - t * (1 - t) * sag_m - GasProfile::kLowest_m;
    EMSCAPE_SIMD()
    for (int i = 0; i < count; ++i) {
      const float at = (begin_m + t * (to_msl_m[i] - from_msl_m)) * (1 / GasProfile::kStep_m);
      const float position = at < 0 ? 0.0f : at > last ? last : at;
      const int below = static_cast<int>(position);
      const float part = position - static_cast<float>(below);
      means[i] += weight * (gamma[below] + part * (gamma[below + 1] - gamma[below]));
    }
  }
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
    if (!std::isfinite(extent.lowest_msl_m) || !std::isfinite(extent.highest_msl_m)) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("gases: heights from {} m to {} m above mean sea level are not finite",
                              extent.lowest_msl_m, extent.highest_msl_m));
    }
    air.range_count = 49;
    air.height_count = 129;
    const double range_step_m = std::max(extent.farthest_m, 1.0) / (air.range_count - 1);
    const double height_step_m =
        std::max(extent.highest_msl_m - extent.lowest_msl_m, 1.0) / (air.height_count - 1);
    air.ranges_per_m = static_cast<float>(1 / range_step_m);
    air.lowest_msl_m = static_cast<float>(extent.lowest_msl_m);
    air.heights_per_m = static_cast<float>(1 / height_step_m);
    const auto profile =
        gasProfile(emitter.frequency_hz, atmosphere, std::max(extent.highest_msl_m, station_msl_m));
    std::vector<float> heights_msl_m;
    for (int h = 0; h < air.height_count; ++h) {
      heights_msl_m.push_back(static_cast<float>(extent.lowest_msl_m + h * height_step_m));
    }
    gases.resize(static_cast<std::size_t>(air.range_count) * air.height_count);
    for (int r = 0; r < air.range_count; ++r) {
      const double range_m = r * range_step_m;
      meansAlong(*profile, air.station_msl_m, heights_msl_m.data(), air.height_count,
                 static_cast<float>(range_m * range_m / (2 * earth_radius_m * atmosphere.k_factor)),
                 gases.data() + static_cast<std::size_t>(r) * air.height_count);
    }
    air.gases = gases.data();
  }
  return air;
}

}  // namespace emscape::propagation
