/// Model `itm`: Irregular Terrain Model (Longley-Rice), version 1.2.2; point-to-point and area mode.
///
/// Computes the basic transmission loss between two antennas near the ground that is not exceeded for
/// percentages of time, of locations and of situations. The loss is not continuous over distance: it may jump
/// where a horizon moves from one post of the profile to another. This is a property of the model.
///
/// @see Hufford, The ITS Irregular Terrain Model, version 1.2.2: the Algorithm (1995), cited as [Alg n.m];
///      NTIA Report 82-100 (1982); NBS Technical Note 101 (1967), cited as [TN101]; ESSA ERL 79-ITS 67 (1968)
#pragma once

#include <string>
#include <vector>

#include "emscape/base/host_device.h"
#include "emscape/base/units.h"
#include "emscape/propagation/settings.h"
#include "propagation/itm/path.h"
#include "propagation/itm/profile.h"
#include "propagation/itm/reference.h"
#include "propagation/itm/variability.h"
#include "propagation/limits.h"

namespace emscape::propagation {

// clang-format off
constexpr ModelLimit kItmFrequency{"frequency", "MHz", 1e6, 20, 20000, Beyond::refused, ""};
constexpr ModelLimit kItmProvenFrequency{"frequency", "MHz", 1e6, 40, 10000, Beyond::warned, "range of the data behind the model"};
constexpr ModelLimit kItmHeight{"antenna height above ground", "m", 1, 0.5, 3000, Beyond::refused, "paths and fields take a lower end as 0.5 m high, with a warning; above, diffraction"};
constexpr ModelLimit kItmProvenHeight{"antenna height above ground", "m", 1, 1, 1000, Beyond::warned, "range of the data behind the model"};
constexpr ModelLimit kItmDistance{"distance", "km", 1e3, 1, 2000, Beyond::warned, ""};
constexpr ModelLimit kItmProvenDistance{"distance", "km", 1e3, 0, 1000, Beyond::warned, "range of the data behind the model"};
constexpr ModelLimit kItmSeaLevelRefractivity{"refractivity at sea level", "N-units", 1, 250, 400, Beyond::refused, "N_0, not that at the surface"};
constexpr ModelLimit kItmSurfaceRefractivity{"refractivity at the surface", "N-units", 1, 150, 400, Beyond::refused, "N_s, computed from N_0 and the terrain"};
constexpr ModelLimit kItmProvenSurfaceRefractivity{"refractivity at the surface", "N-units", 1, 250, 400, Beyond::warned, ""};
constexpr ModelLimit kItmPermittivity{"relative permittivity of the ground", "", 1, 1, kNoLimit, Beyond::refused, ""};
constexpr ModelLimit kItmConductivity{"conductivity of the ground", "S/m", 1, 0, kNoLimit, Beyond::refused, "0 itself is refused"};
constexpr ModelLimit kItmPercentage{"percentage of time, locations, situations", "%", 1, 0, 100, Beyond::refused, "0 and 100 themselves are refused"};
constexpr ModelLimit kItmIrregularity{"terrain irregularity (area mode)", "m", 1, 0, kNoLimit, Beyond::refused, ""};
constexpr ModelLimit kItmEffectiveEarth{"effective earth radius", "km", 1e3, 4000, 13333.333, Beyond::refused, "computed from N_s"};
constexpr ModelLimit kItmHorizonAngle{"elevation of a horizon", "mrad", 1e-3, -200, 200, Beyond::warned, ""};
constexpr ModelLimit kItmHorizonDistance{"distance of a horizon against that over a smooth earth", "", 1, 0.1, 3, Beyond::warned, ""};
constexpr ModelLimit kItmDeviate{"standard normal deviate of a percentage", "", 1, -3.1, 3.1, Beyond::warned, "percentages of about 0.1 and 99.9"};
// clang-format on
constexpr const ModelLimit* kItmLimits[] = {&kItmFrequency,
                                            &kItmProvenFrequency,
                                            &kItmHeight,
                                            &kItmProvenHeight,
                                            &kItmDistance,
                                            &kItmProvenDistance,
                                            &kItmSeaLevelRefractivity,
                                            &kItmSurfaceRefractivity,
                                            &kItmProvenSurfaceRefractivity,
                                            &kItmPermittivity,
                                            &kItmConductivity,
                                            &kItmPercentage,
                                            &kItmIrregularity,
                                            &kItmEffectiveEarth,
                                            &kItmHorizonAngle,
                                            &kItmHorizonDistance,
                                            &kItmDeviate};

/// Numbers as in the NTIA's implementation; 1000 and above: no result.
enum class ItmStatus {
  done = 0,
  done_with_warnings = 1,
  transmitter_height = 1000,
  receiver_height = 1001,
  climate = 1002,
  time = 1003,
  location = 1004,
  situation = 1005,
  refractivity = 1008,
  frequency = 1009,
  permittivity = 1011,
  conductivity = 1012,
  ground_impedance = 1013,
  variability_mode = 1014,
  effective_earth = 1016,
  distance = 1017,
  irregularity = 1018,
  transmitter_siting = 1019,
  receiver_siting = 1020,
  surface_refractivity_too_small = 1021,
  surface_refractivity_too_large = 1022,
  profile = 2000,  ///< fewer than two intervals, or a height is missing; not in NTIA's implementation
};

/// Bits as in the NTIA's implementation.
enum ItmWarning : unsigned {
  kItmWarnTransmitterHeight = 0x0001,
  kItmWarnReceiverHeight = 0x0002,
  kItmWarnFrequency = 0x0004,
  kItmWarnDistanceOver1000km = 0x0008,
  kItmWarnDistanceOver2000km = 0x0010,
  kItmWarnDistanceUnderHeights = 0x0020,
  kItmWarnDistanceUnder1km = 0x0040,
  kItmWarnTransmitterHorizonAngle = 0x0080,
  kItmWarnReceiverHorizonAngle = 0x0100,
  kItmWarnTransmitterHorizonNear = 0x0200,
  kItmWarnReceiverHorizonNear = 0x0400,
  kItmWarnTransmitterHorizonFar = 0x0800,
  kItmWarnReceiverHorizonFar = 0x1000,
  kItmWarnExtremeVariability = 0x2000,
  kItmWarnSurfaceRefractivity = 0x4000,
};

/// The link without the terrain.
template <class Real>
struct ItmLink {
  Real height_agl_m[2] = {};  ///< transmitter, receiver
  Real frequency_hz = 0;
  bool vertical_polarization = true;
  Real relative_permittivity = 15;
  Real conductivity_s_m = Real(0.005);
  Real sea_level_refractivity =
      301;  ///< N_0 (N-units); determines the curvature of the rays, instead of a k factor
  ItmClimate climate = ItmClimate::continental_temperate;
  int variability_mode = 12;  ///< 0..3, 10..13, 20..23: see itmQuantileDb
};

/// The loss is not exceeded in `time` percent of the time, in `location` percent of the locations, in
/// `situation` percent of such links.
template <class Real>
struct ItmQuantiles {
  Real time_percent = 50;
  Real location_percent = 50;
  Real situation_percent = 50;
};

template <class Real>
struct ItmResult {
  ItmStatus status = ItmStatus::done;
  unsigned warnings = 0;  ///< ItmWarning bits
  Real loss_db = 0;       ///< basic transmission loss, free space included; NaN if refused
  Real free_space_db = 0;
  Real reference_db = 0;  ///< reference attenuation, above free space
  ItmMode mode = ItmMode::none;
  ItmPath<Real> path;  ///< intermediate results

  EMSCAPE_HD bool refused() const { return static_cast<int>(status) >= 1000; }
};

template <class Real>
struct ItmArea {
  Real distance_m = 0;      ///< > 0
  Real irregularity_m = 0;  ///< Delta h; 90 for hills, 0 for the sea
  ItmSiting siting[2] = {};
};

namespace itm_detail {

/// Parameters that do not depend on the path.
template <class Real>
EMSCAPE_HD ItmStatus checkInput(const ItmLink<Real>& link, const ItmQuantiles<Real>& quantiles,
                                unsigned& warnings) {
  for (int end = 0; end < 2; ++end) {
    const Real height_m = link.height_agl_m[end];
    if (!holds<kItmHeight>(height_m)) {
      return end == 0 ? ItmStatus::transmitter_height : ItmStatus::receiver_height;
    }
    if (!holds<kItmProvenHeight>(height_m)) {
      warnings |= end == 0 ? kItmWarnTransmitterHeight : kItmWarnReceiverHeight;
    }
  }
  if (static_cast<int>(link.climate) < 1 || static_cast<int>(link.climate) > 7) return ItmStatus::climate;
  if (!holds<kItmSeaLevelRefractivity>(link.sea_level_refractivity)) return ItmStatus::refractivity;
  if (!holds<kItmFrequency>(link.frequency_hz)) return ItmStatus::frequency;
  if (!holds<kItmProvenFrequency>(link.frequency_hz)) warnings |= kItmWarnFrequency;
  if (!holds<kItmPermittivity>(link.relative_permittivity)) return ItmStatus::permittivity;
  if (!(link.conductivity_s_m > kItmConductivity.min)) return ItmStatus::conductivity;
  const int mode = link.variability_mode;
  if (mode < 0 || mode > 23 || mode % 10 > 3) return ItmStatus::variability_mode;
  const auto possible = [](Real percent) {
    return percent > kItmPercentage.min && percent < kItmPercentage.max;
  };
  if (!possible(quantiles.situation_percent)) return ItmStatus::situation;
  if (!possible(quantiles.time_percent)) return ItmStatus::time;
  if (!possible(quantiles.location_percent)) return ItmStatus::location;
  return ItmStatus::done;
}

/// Parameters of the path.
template <class Real>
EMSCAPE_HD ItmStatus checkPath(const ItmPath<Real>& path, unsigned& warnings) {
  for (int end = 0; end < 2; ++end) {
    const ItmTerminal<Real>& terminal = path.terminal[end];
    const Real smooth_m = path.smoothHorizonDistance_m(end);
    if (!holds<kItmHorizonAngle>(terminal.horizon_angle_rad)) {
      warnings |= end == 0 ? kItmWarnTransmitterHorizonAngle : kItmWarnReceiverHorizonAngle;
    }
    if (terminal.horizon_distance_m < Real(kItmHorizonDistance.min) * smooth_m) {
      warnings |= end == 0 ? kItmWarnTransmitterHorizonNear : kItmWarnReceiverHorizonNear;
    }
    if (terminal.horizon_distance_m > Real(kItmHorizonDistance.max) * smooth_m) {
      warnings |= end == 0 ? kItmWarnTransmitterHorizonFar : kItmWarnReceiverHorizonFar;
    }
  }
  const Real refractivity = path.surface_refractivity;
  if (!holds<kItmSurfaceRefractivity>(refractivity)) {
    return refractivity > kItmSurfaceRefractivity.max ? ItmStatus::surface_refractivity_too_large
                                                      : ItmStatus::surface_refractivity_too_small;
  }
  if (!holds<kItmProvenSurfaceRefractivity>(refractivity)) warnings |= kItmWarnSurfaceRefractivity;
  if (!holds<kItmEffectiveEarth>(path.effective_earth_radius_m)) return ItmStatus::effective_earth;
  if (path.ground_impedance.re <= std::fabs(path.ground_impedance.im)) return ItmStatus::ground_impedance;

  const Real difference_m =
      std::fabs(path.terminal[0].effective_height_m - path.terminal[1].effective_height_m);
  if (path.distance_m < difference_m / Real(0.2)) warnings |= kItmWarnDistanceUnderHeights;
  if (path.distance_m < kItmDistance.min * kItmDistance.si_per_unit) warnings |= kItmWarnDistanceUnder1km;
  if (!holds<kItmProvenDistance>(path.distance_m)) warnings |= kItmWarnDistanceOver1000km;
  if (path.distance_m > kItmDistance.max * kItmDistance.si_per_unit) warnings |= kItmWarnDistanceOver2000km;
  return ItmStatus::done;
}

template <class Real>
EMSCAPE_HD ItmResult<Real>& refuse(ItmResult<Real>& result, ItmStatus status) {
  result.status = status;
  result.loss_db = Real(NAN);
  return result;
}

/// Loss of a path whose terrain parameters are known.
template <class Real>
EMSCAPE_HD void finish(const ItmLink<Real>& link, const ItmQuantiles<Real>& quantiles,
                       ItmResult<Real>& result) {
  ItmPath<Real>& path = result.path;
  if (const ItmStatus status = checkPath(path, result.warnings); status != ItmStatus::done) {
    refuse(result, status);
    return;
  }
  const ItmReference<Real> reference = itmReference(path);
  result.reference_db = reference.attenuation_db;
  result.mode = reference.mode;
  result.free_space_db =
      Real(32.45) + 20 * std::log10(path.frequency_mhz) + 20 * std::log10(path.distance_m / 1000);
  ItmDeviates<Real> deviates{normalDeviate(quantiles.time_percent / 100),
                             normalDeviate(quantiles.location_percent / 100),
                             normalDeviate(quantiles.situation_percent / 100)};
  result.loss_db = result.free_space_db + itmQuantileDb(path, reference.attenuation_db, link.climate,
                                                        link.variability_mode, deviates);
  if (!holds<kItmDeviate>(deviates.time) || !holds<kItmDeviate>(deviates.location) ||
      !holds<kItmDeviate>(deviates.situation)) {
    result.warnings |= kItmWarnExtremeVariability;
  }
  if (result.warnings != 0) result.status = ItmStatus::done_with_warnings;
}

}  // namespace itm_detail

/// Loss over a terrain profile.
/// @param statistics  itm_detail::ProfileStatistics of the profile, or the like
/// @accuracy double: within 0.001 dB of the NTIA's implementation; float: within 0.01 dB of double
/// Safe to call from any thread; nothing is allocated.
template <class Real, class Height, class Statistics>
EMSCAPE_HD ItmResult<Real> itmPointToPoint(const ItmProfile<Height>& profile, const ItmLink<Real>& link,
                                           const ItmQuantiles<Real>& quantiles, Statistics& statistics) {
  using namespace itm_detail;
  ItmResult<Real> result;
  if (const ItmStatus status = checkInput(link, quantiles, result.warnings); status != ItmStatus::done) {
    return refuse(result, status);
  }
  if (!(profile.intervals >= 2 && profile.step_m > 0) || !statistics.hasEveryHeight()) {
    return refuse(result, ItmStatus::profile);
  }
  result.path = statistics.medium(link);
  for (int end = 0; end < 2; ++end) result.path.terminal[end].height_agl_m = link.height_agl_m[end];
  itmSetTerrain(result.path, profile, statistics);
  finish(link, quantiles, result);
  return result;
}
template <class Real, class Height>
EMSCAPE_HD ItmResult<Real> itmPointToPoint(const ItmProfile<Height>& profile, const ItmLink<Real>& link,
                                           const ItmQuantiles<Real>& quantiles) {
  itm_detail::ProfileStatistics<Real, Height> statistics{profile};
  return itmPointToPoint(profile, link, quantiles, statistics);
}

/// Loss over terrain that is described only by its irregularity.
template <class Real>
EMSCAPE_HD ItmResult<Real> itmAreaMode(const ItmArea<Real>& area, const ItmLink<Real>& link,
                                       const ItmQuantiles<Real>& quantiles) {
  using namespace itm_detail;
  ItmResult<Real> result;
  if (const ItmStatus status = checkInput(link, quantiles, result.warnings); status != ItmStatus::done) {
    return refuse(result, status);
  }
  if (!(area.distance_m > 0)) return refuse(result, ItmStatus::distance);
  if (!holds<kItmIrregularity>(area.irregularity_m)) return refuse(result, ItmStatus::irregularity);
  ItmPath<Real>& path = result.path;
  path.distance_m = area.distance_m;
  path.irregularity_m = area.irregularity_m;
  itmSetMedium(path, link.frequency_hz, link.vertical_polarization, link.relative_permittivity,
               link.conductivity_s_m, link.sea_level_refractivity, Real(0));
  for (int end = 0; end < 2; ++end) {
    ItmTerminal<Real>& terminal = path.terminal[end];
    const Real height_m = link.height_agl_m[end];
    terminal.height_agl_m = height_m;
    Real raised_m = 0;  // [Alg 3.2]
    switch (area.siting[end]) {
      case ItmSiting::random:
        break;
      case ItmSiting::careful:
        raised_m = 4;
        break;
      case ItmSiting::very_careful:
        raised_m = 9;
        break;
      default:
        return refuse(result, end == 0 ? ItmStatus::transmitter_siting : ItmStatus::receiver_siting);
    }
    if (raised_m > 0) {
      if (height_m < 5) raised_m *= std::sin(Real(kPi / 10) * height_m);
      const Real relative = 2 * height_m / larger(Real(1e-3), area.irregularity_m);
      raised_m = (1 + raised_m) * std::exp(-smaller(Real(20), relative));
    }
    terminal.effective_height_m = height_m + raised_m;
    itmEstimateHorizon(terminal, path.smoothHorizonDistance_m(end), area.irregularity_m);
  }
  finish(link, quantiles, result);
  return result;
}

/// Text of a status or a warning, with the limits: "frequency outside 20..20000 MHz: refused".
std::string itmMessage(ItmStatus status);
std::vector<std::string> itmMessages(unsigned warnings);

}  // namespace emscape::propagation
