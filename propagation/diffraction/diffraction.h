/// Model `diffraction`: loss over terrain and the earth's bulge, ITU-R P.526-15 section 4.5 ("delta-
/// Bullington"), also used by P.1812 and P.452. edges.h has the options single edge and Deygout.
///
/// Bullington replaces the terrain by one knife edge at the intersection of the steepest rays from the two
/// antennas. Over a smooth earth its loss is too small; the smooth-earth correction is added:
///   L = L_bulla + max(L_dsph - L_bulls, 0)
/// with L_bulls Bullington's loss and L_dsph the spherical earth's, both for a smooth earth, with antenna
/// heights above it equal to those above the terrain's trend. The loss is continuous in range, height and
/// frequency.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "emscape/base/units.h"
#include "propagation/diffraction/knife_edge.h"
#include "propagation/diffraction/spherical_earth.h"
#include "propagation/limits.h"
#include "propagation/terrain_profile.h"

namespace emscape::propagation {

constexpr ModelLimit kDiffractionFrequency{
    "frequency", "MHz", 1e6, 20, 50000, Beyond::warned, "below, the ground wave is missing"};
constexpr ModelLimit kDiffractionHeight{
    "height above mean sea level",
    "km",
    1000,
    -1,
    10,
    Beyond::warned,
    "rays are assumed straight over an earth of k times its radius; higher up they are not"};
constexpr ModelLimit kDiffractionDistance{"distance",
                                          "km",
                                          1000,
                                          0.1,
                                          1000,
                                          Beyond::warned,
                                          "far beyond the horizon scattering in the troposphere is stronger"};
constexpr ModelLimit kDiffractionAboveGround{
    "antenna height above ground",
    "m",
    1,
    1,
    100000,
    Beyond::clamped,
    "as in P.1812: the loss of a smooth earth has no bound at the ground itself"};
constexpr const ModelLimit* kDiffractionLimits[] = {&kDiffractionFrequency, &kDiffractionHeight,
                                                    &kDiffractionAboveGround, &kDiffractionDistance};

/// Parameters of a path's loss besides terrain and antennas.
struct DiffractionParameters {
  double frequency_hz = 0;
  double effective_earth_radius_m = 0;
  LinearPolarization polarization = LinearPolarization::horizontal;
  double sea_fraction = 0;     ///< of the path, 0..1
  bool sea_by_height = false;  ///< true: the fraction is that of the profile at or below mean sea level
  GroundConstants land = kDiffractionLand;
  GroundConstants sea = kDiffractionSea;
};

/// The model at one frequency, as plain data.
template <class Real>
struct DiffractionModel {
  SphericalEarth<Real> earth;
  Real half_curvature;  ///< 1 / (2 a): the earth's bulge is this times d1 d2
  bool sea_by_height;   ///< see DiffractionParameters

  /// Height of an antenna, at least kDiffractionAboveGround above its ground.
  static EMSCAPE_HD Real raised_m(Real antenna_m, Real ground_m) {
    const Real lowest = ground_m + Real(kDiffractionAboveGround.min);
    return antenna_m > lowest ? antenna_m : lowest;
  }

  /// nu of an obstacle `above_m` above the line of sight, P.526-15 eq. (26) in metres.
  EMSCAPE_HD Real nuOf(Real above_m, Real d1_m, Real d2_m) const {
    return above_m * std::sqrt(2 * (d1_m + d2_m) / (earth.wavelength_m * d1_m * d2_m));
  }
};

template <class Real>
DiffractionModel<Real> diffractionModel(const DiffractionParameters& parameters) {
  DiffractionModel<Real> model;
  model.earth.earth_radius_m = Real(parameters.effective_earth_radius_m);
  model.earth.wavelength_m = Real(wavelength_m(parameters.frequency_hz));
  model.earth.sea_fraction = Real(parameters.sea_fraction);
  model.earth.land = firstTermGround<Real>(parameters.frequency_hz, parameters.land, parameters.polarization);
  model.earth.sea = firstTermGround<Real>(parameters.frequency_hz, parameters.sea, parameters.polarization);
  model.half_curvature = Real(0.5 / parameters.effective_earth_radius_m);
  model.sea_by_height = parameters.sea_by_height;
  return model;
}

/// Bullington's loss (dB) from the nu of its edge. @see P.526-15 eq. (56), (57)
template <class Real>
EMSCAPE_HD Real bullingtonLossDb(Real nu, Real distance_m) {
  const Real edge_db = knifeEdgeDb(nu);
  if (edge_db == 0) return 0;
  return edge_db + (1 - std::exp(-edge_db / 6)) * (10 + Real(2e-5) * distance_m);
}

/// nu of the edge at the intersection of the steepest rays. With slopes t and r of the rays relative to the
/// line of sight, the edge is at range d r / (t + r) and t times this range above the line: nu = sqrt(2 d t r
/// / lambda).
/// @param slope_to_rx  (h_rs - h_ts) / d
/// @param tx_slope     largest slope from the transmitter to an obstacle, >= slope_to_rx
/// @param rx_slope     the same from the receiver, >= -slope_to_rx
/// @see P.526-15 eq. (54), (55)
template <class Real>
EMSCAPE_HD Real bullingtonEdgeNu(const DiffractionModel<Real>& model, Real distance_m, Real slope_to_rx,
                                 Real tx_slope, Real rx_slope) {
  const Real product = (tx_slope - slope_to_rx) * (rx_slope + slope_to_rx);
  // Rounding may make the second factor negative where both are near 0.
  return std::sqrt(2 * distance_m / model.earth.wavelength_m * (product > 0 ? product : Real(0)));
}

/// Input of the smooth surface under a terrain profile.
template <class Real>
struct TerrainTrend {
  Real start_msl_m, end_msl_m;  ///< of the line fitted to the terrain, eq. (60), (61)
  Real highest_m;               ///< largest height of an obstacle over the line of sight; may be negative
  Real tx_angle, rx_angle;      ///< largest slopes of obstacles over the line of sight, from either end
  Real tx_ground_msl_m, rx_ground_msl_m;
};

/// That of a path without an obstacle above the line of sight, over heights that are relative to the first
/// post.
template <class Real>
EMSCAPE_HD TerrainTrend<Real> clearTrend(Real start_m, Real end_m, Real rx_ground_m) {
  return {start_m, end_m, -Real(HUGE_VAL), -Real(HUGE_VAL), -Real(HUGE_VAL), 0, rx_ground_m};
}

/// Heights of the antennas above the smooth surface (m).
template <class Real>
struct EffectiveHeights {
  Real tx_m, rx_m;
};

/// @see P.526-15 eq. (62) to (67); P.1812-6 eq. (84) to (90)
template <class Real>
EMSCAPE_HD EffectiveHeights<Real> effectiveHeights(const TerrainTrend<Real>& trend, Real tx_msl_m,
                                                   Real rx_msl_m) {
  Real start = trend.start_msl_m, end = trend.end_msl_m;
  if (trend.highest_m > 0) {
    const Real part = trend.tx_angle / (trend.tx_angle + trend.rx_angle);
    start -= trend.highest_m * part;
    end -= trend.highest_m * (1 - part);
  }
  start = start < trend.tx_ground_msl_m ? start : trend.tx_ground_msl_m;
  end = end < trend.rx_ground_msl_m ? end : trend.rx_ground_msl_m;
  return {tx_msl_m - start, rx_msl_m - end};
}

/// Length (m) of a path over sea: parts at or below mean sea level, with boundaries half way between posts.
/// @param count       posts, the last of which is below the receiver
/// @param rangeOf     range (m) of a post
/// @param heightOf    height (m above mean sea level) of a post
template <class RangeOf, class HeightOf>
EMSCAPE_HD double lengthOverSea_m(int count, RangeOf rangeOf, HeightOf heightOf) {
  double sea_m = 0, before_m = 0;
  bool before_is_sea = false;
  for (int i = 0; i < count; ++i) {
    const double here_m = double(rangeOf(i));
    const bool is_sea = double(heightOf(i)) <= 0;
    sea_m += (here_m - before_m) * ((is_sea ? 0.5 : 0.0) + (before_is_sea ? 0.5 : 0.0));
    before_m = here_m;
    before_is_sea = is_sea;
  }
  return sea_m;
}

/// Running sums of the line fitted to the terrain; in double precision.
struct TerrainSums {
  double v1 = 0, v2 = 0;

  /// Adds the interval that ends at post i >= 1 of the ground. Heights are relative to the first post.
  /// @see P.526-15 eq. (58), (59)
  EMSCAPE_HD void add(const TerrainProfile& profile, int i) {
    const float* const ground_msl_m = profile.ground_msl_m();
    const double base = ground_msl_m[0];
    add(profile.range_m[i - 1], ground_msl_m[i - 1] - base, profile.range_m[i], ground_msl_m[i] - base);
  }
  /// Adds an interval from one range and height (m) to the next.
  EMSCAPE_HD void add(double before, double h_before, double d, double h) {
    v1 += (d - before) * (h + h_before);
    v2 += (d - before) * (h * (2 * d + before) + h_before * (d + 2 * before));
  }
  /// Ends of the line over a path, eq. (60), (61).
  EMSCAPE_HD double start_m(double distance_m) const {
    return (2 * v1 * distance_m - v2) / (distance_m * distance_m);
  }
  EMSCAPE_HD double end_m(double distance_m) const {
    return (v2 - v1 * distance_m) / (distance_m * distance_m);
  }
};

/// Loss of a path and its parts.
template <class Real>
struct DeltaBullington {
  Real loss_db = 0;                    ///< L_d, eq. (68)
  Real terrain_db = 0;                 ///< L_bulla
  Real smooth_db = 0;                  ///< L_bulls; not computed and 0 where L_dsph is 0
  Real spherical_db = 0;               ///< L_dsph
  EffectiveHeights<Real> effective{};  ///< above the smooth surface

  /// Adds the correction for the smooth earth, from `effective`.
  /// @param nuOf  () -> nu of Bullington's edge over it
  template <class NuOf>
  EMSCAPE_HD void addEarth(const SphericalEarth<Real>& earth, Real distance_m, const NuOf& nuOf) {
    spherical_db = sphericalEarthLossDb(earth, distance_m, effective.tx_m, effective.rx_m);
    if (!(spherical_db > 0)) return;
    smooth_db = bullingtonLossDb(nuOf(), distance_m);
    const Real correction_db = spherical_db - smooth_db;
    loss_db += correction_db > 0 ? correction_db : Real(0);
  }
};

/// Bullington's nu over heights of obstacles: terrain, or a smooth earth if all are 0.
/// @param heightOf  height (m) of post i, 0 < i < count - 1
/// @return -infinity without a post between
/// @see P.526-15 eq. (50) to (55)
template <class Real, class HeightOf>
EMSCAPE_HD Real bullingtonNu(const DiffractionModel<Real>& model, const double* range_m, int count, Real tx_m,
                             Real rx_m, HeightOf heightOf) {
  const Real d = Real(range_m[count - 1]);
  const Real slope_to_rx = (rx_m - tx_m) / d;
  const Real infinity = Real(HUGE_VAL);
  Real tx_slope = -infinity, rx_slope = -infinity;
  for (int i = 1; i < count - 1; ++i) {
    const Real d1 = Real(range_m[i]), d2 = d - d1;
    const Real h = heightOf(i) + model.half_curvature * d1 * d2;
    const Real from_tx = (h - tx_m) / d1, from_rx = (h - rx_m) / d2;
    tx_slope = from_tx > tx_slope ? from_tx : tx_slope;
    rx_slope = from_rx > rx_slope ? from_rx : rx_slope;
  }
  if (tx_slope >= slope_to_rx) return bullingtonEdgeNu(model, d, slope_to_rx, tx_slope, rx_slope);
  Real nu = -infinity;
  for (int i = 1; i < count - 1; ++i) {
    const Real d1 = Real(range_m[i]), d2 = d - d1;
    const Real above = heightOf(i) + model.half_curvature * d1 * d2 - tx_m - slope_to_rx * d1;
    const Real here = model.nuOf(above, d1, d2);
    nu = here > nu ? here : nu;
  }
  return nu;
}

/// Loss of one path over a profile whose last post is below the receiver. Where the profile is raised by
/// clutter, the smooth surface is that of the bare ground, as in P.1812-8 (Attachment 1 to Annex 1) and
/// P.452-18 (Attachment 2 to Annex 1): otherwise trees over flat ground would raise the antennas above it.
/// @param tx_msl_m, rx_msl_m  of the antennas; see kDiffractionAboveGround
/// @return 0 with a single post; all NaN over missing terrain (NaN)
/// @accuracy float within 0.02 dB of double to 500 km, 20 MHz to 40 GHz
template <class Real>
EMSCAPE_HD DeltaBullington<Real> deltaBullington(const DiffractionModel<Real>& model,
                                                 const TerrainProfile& profile, Real tx_msl_m,
                                                 Real rx_msl_m) {
  DeltaBullington<Real> result;
  const int last = profile.count - 1;
  const double distance_m = profile.range_m[last];
  const Real d = Real(distance_m);
  const Real base = Real(profile.height_msl_m[0]);
  // Heights are relative to the first post, for precision in float.
  TerrainTrend<Real> trend = clearTrend(Real(0), Real(0), Real(profile.height_msl_m[last]) - base);
  const Real tx = model.raised_m(tx_msl_m - base, 0);
  const Real rx = model.raised_m(rx_msl_m - base, trend.rx_ground_msl_m);
  const auto heightOf = [&](int i) { return Real(profile.height_msl_m[i]) - base; };
  const float* const ground_msl_m = profile.ground_msl_m();

  if (last == 0) {  // from the antenna to itself
    result.loss_db = std::isnan(base) ? base : Real(0);
    return result;
  }

  TerrainSums sums;
  const Real slope = (rx - tx) / d;
  for (int i = 1; i <= last; ++i) {
    sums.add(profile, i);
    if (i == last) break;
    const Real d1 = Real(profile.range_m[i]), d2 = d - d1;
    const Real above = Real(ground_msl_m[i]) - base - tx - slope * d1;
    trend.highest_m = above > trend.highest_m ? above : trend.highest_m;
    trend.tx_angle = above / d1 > trend.tx_angle ? above / d1 : trend.tx_angle;
    trend.rx_angle = above / d2 > trend.rx_angle ? above / d2 : trend.rx_angle;
  }
  if (std::isnan(sums.v1)) {
    const Real nan = Real(NAN);
    return {nan, nan, nan, nan, {nan, nan}};
  }
  trend.start_msl_m = Real(sums.start_m(distance_m));
  trend.end_msl_m = Real(sums.end_m(distance_m));
  result.effective = effectiveHeights(trend, tx, rx);

  result.terrain_db =
      bullingtonLossDb(bullingtonNu(model, profile.range_m, profile.count, tx, rx, heightOf), d);
  SphericalEarth<Real> earth = model.earth;
  if (model.sea_by_height) {
    const double sea_m = lengthOverSea_m(
        profile.count, [&](int i) { return profile.range_m[i]; }, [&](int i) { return ground_msl_m[i]; });
    earth.sea_fraction = Real(sea_m / distance_m);
  }
  result.loss_db = result.terrain_db;
  result.addEarth(earth, d, [&] {
    return bullingtonNu(model, profile.range_m, profile.count, result.effective.tx_m, result.effective.rx_m,
                        [](int) { return Real(0); });
  });
  return result;
}

}  // namespace emscape::propagation
