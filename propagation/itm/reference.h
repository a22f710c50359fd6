/// ITM: the reference attenuation, the median excess over free space [Hufford 1995, sec. 4].
///
/// Beyond the smooth-earth horizon it is a straight line in distance through the diffraction losses at two
/// distances far beyond it, or the line through two scatter losses where that is lower; before the horizon, a
/// curve through two-ray losses that meets the diffraction line at the horizon.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "emscape/base/units.h"
#include "propagation/complex.h"
#include "propagation/itm/path.h"

namespace emscape::propagation {

enum class ItmMode { none = 0, line_of_sight = 1, diffraction = 2, troposcatter = 3 };

template <class Real>
struct ItmReference {
  Real attenuation_db = 0;
  ItmMode mode = ItmMode::none;
};

namespace itm_detail {

template <class Real>
EMSCAPE_HD Real powerDb(Real ratio) {
  return 10 * std::log10(ratio);
}

/// Attenuation as a straight line in distance.
template <class Real>
struct LossLine {
  Real at_zero_db;
  Real slope_db_m;
  EMSCAPE_HD Real at(Real distance_m) const { return at_zero_db + slope_db_m * distance_m; }
};

/// Loss of a knife edge, from the square of the Fresnel parameter [Alg 4.21; TN101, I.1].
template <class Real>
EMSCAPE_HD Real knifeEdgeDb(Real parameter_squared) {
  if (parameter_squared < Real(5.76)) {
    return Real(6.02) + Real(9.11) * std::sqrt(parameter_squared) - Real(1.27) * parameter_squared;
  }
  return Real(12.953) + powerDb(parameter_squared);
}

/// F(x, K): gain by height over a smooth earth, in the three-radii method [Vogler 1964; TN101, 8.2].
/// @param x  normalised distance
/// @param k  ground parameter
template <class Real>
EMSCAPE_HD Real heightGainDb(Real x, Real k) {
  const Real log_x = std::log10(x);
  if (x < 200) {
    const Real w = -std::log(k);
    if (k < Real(1e-5) || x * w * w * w > 5495) return x > 1 ? 40 * log_x - 117 : Real(-117);
    return Real(2.5e-5) * x * x / k + 20 * std::log10(k) - 15;
  }
  const Real far_db = Real(0.05751) * x - 10 * log_x;
  if (x >= 2000) return far_db;
  const Real w = Real(0.0134) * x * std::exp(Real(-0.005) * x);
  return (1 - w) * far_db + w * (40 * log_x - 117);
}

/// Diffraction over the horizon as a weighted sum of two knife edges and a rounded earth [Alg 4.9-4.22]. The
/// terms that do not depend on the distance are computed once.
template <class Real>
class Diffraction {
 public:
  EMSCAPE_HD explicit Diffraction(const ItmPath<Real>& path) : path_(path) {
    horizon_m_ = path.horizonDistance_m();
    horizon_rad_ = path.beyondHorizon_rad(0);
    cube_root_f_ = std::cbrt(path.frequency_mhz);
    impedance_ = abs(path.ground_impedance);

    height_x_ = 0;
    height_gains_db_ = 0;
    for (const ItmTerminal<Real>& terminal : path.terminal) {
      const Real distance_m = terminal.horizon_distance_m;
      const Rounded rounded = roundedBy(distance_m * distance_m / (2 * terminal.effective_height_m));
      const Real x = rounded.x_per_m * distance_m;
      height_x_ += x;
      height_gains_db_ += heightGainDb(x, rounded.k);
    }

    const Real product_m2 = path.terminal[0].height_agl_m * path.terminal[1].height_agl_m;
    const Real effective_m2 = path.terminal[0].effective_height_m * path.terminal[1].effective_height_m;
    const Real deviation_m =
        itmTerrainDeviation_m(itmIrregularityWithin_m(path.smoothHorizonDistance_m(), path.irregularity_m));
    clutter_db_ =
        smaller(Real(15), 5 * std::log10(1 + Real(1e-5) * product_m2 * path.frequency_mhz * deviation_m));
    // 10 m2 more if the profile is known: low antennas are then not in clutter
    const Real known_m2 = product_m2 + (path.profile_is_known ? 10 : 0);
    height_ratio_ = std::sqrt(1 + (effective_m2 - product_m2) / known_m2);
  }

  EMSCAPE_HD Real lossDb(Real distance_m) const {
    const Real beyond_rad = horizon_rad_ + distance_m / path_.effective_earth_radius_m;  // [Alg 4.12]
    const Real irregularity_m = itmIrregularityWithin_m(distance_m, path_.irregularity_m);
    const Real reach = (horizon_rad_ * path_.effective_earth_radius_m + horizon_m_) / distance_m;
    const Real q = (height_ratio_ + reach) * smaller(irregularity_m * path_.waveNumber(), Real(6283.2));
    const Real weight = Real(25.1) / (Real(25.1) + std::sqrt(q));  // [ERL 79-ITS 67, 3.23]
    return weight * roundedEarthDb(distance_m, beyond_rad) +
           (1 - weight) * knifeEdgesDb(distance_m, beyond_rad) + clutter_db_;
  }

 private:
  /// Terms of a radius in the three-radii method.
  struct Rounded {
    Real k;
    Real x_per_m;
  };
  EMSCAPE_HD Rounded roundedBy(Real radius_m) const {
    const Real c = std::cbrt(Real(4.0 / 3 * 6370e3) / radius_m);      // [Vogler 1964, 2]
    const Real k = Real(0.017778) * c / (cube_root_f_ * impedance_);  // [Vogler 1964, 6a]
    return {k, (Real(1.607) - k) * c * c * cube_root_f_ / 1000};      // [Vogler 1964, 2]
  }

  EMSCAPE_HD Real knifeEdgesDb(Real distance_m, Real beyond_rad) const {
    const Real between_m = distance_m - horizon_m_;
    const Real common = Real(1 / (4 * kPi)) * path_.waveNumber() * beyond_rad * beyond_rad * between_m;
    Real loss_db = 0;
    for (const ItmTerminal<Real>& terminal : path_.terminal) {
      const Real reach_m = terminal.horizon_distance_m;
      loss_db += knifeEdgeDb(common * reach_m / (between_m + reach_m));  // [TN101, I.7]
    }
    return loss_db;
  }

  EMSCAPE_HD Real roundedEarthDb(Real distance_m, Real beyond_rad) const {
    // the radius that bends the stretch between the horizons by the angle beyond them
    const Real between_m = distance_m - horizon_m_;
    const Real x = roundedBy(between_m / beyond_rad).x_per_m * between_m + height_x_;
    return Real(0.05751) * x - powerDb(x) - height_gains_db_ - 20;  // [Vogler 1964; TN101, 8.4]
  }

  const ItmPath<Real>& path_;
  Real horizon_m_, horizon_rad_, cube_root_f_, impedance_;
  Real height_x_, height_gains_db_, clutter_db_, height_ratio_;
};

/// Two rays over rough ground, blended with the diffraction line with increasing roughness [Alg 4.46-4.50].
template <class Real>
EMSCAPE_HD Real lineOfSightDb(const ItmPath<Real>& path, Real distance_m, const LossLine<Real>& diffraction) {
  const Real wave_number = path.waveNumber();
  const Real height_m[2] = {path.terminal[0].effective_height_m, path.terminal[1].effective_height_m};
  const Real sum_m = height_m[0] + height_m[1];
  const Real sine = sum_m / std::sqrt(distance_m * distance_m + sum_m * sum_m);
  const Real deviation_m = itmTerrainDeviation_m(itmIrregularityWithin_m(distance_m, path.irregularity_m));

  const Complex<Real> grazing{sine, 0};
  Complex<Real> reflected = (grazing - path.ground_impedance) / (grazing + path.ground_impedance) *
                            std::exp(-smaller(Real(10), wave_number * deviation_m * sine));
  const Real strength = norm(reflected);
  if (strength < Real(0.25) || strength < sine) reflected = reflected * std::sqrt(sine / strength);

  constexpr Real kQuarter = Real(kPi / 2);
  Real phase = 2 * wave_number * height_m[0] * height_m[1] / distance_m;
  // no lobes: the phase difference only approaches half a turn
  if (phase > kQuarter) phase = Real(kPi) - kQuarter * kQuarter / phase;
  const Real two_ray_db = -powerDb(norm(Complex<Real>{std::cos(phase), -std::sin(phase)} + reflected));

  const Real weight =
      1 / (1 + path.frequency_mhz * path.irregularity_m / larger(Real(10e3), path.smoothHorizonDistance_m()));
  return weight * two_ray_db + (1 - weight) * diffraction.at(distance_m);
}

/// The curve through two-ray losses that meets the diffraction line at the smooth-earth horizon
/// [Alg 4.28-4.45].
template <class Real>
EMSCAPE_HD Real beforeHorizonDb(const ItmPath<Real>& path, const LossLine<Real>& diffraction) {
  const Real horizon_m = path.horizonDistance_m();
  const Real smooth_m = path.smoothHorizonDistance_m();
  const Real smooth_db = diffraction.at(smooth_m);
  // where the two rays' phases begin to differ [ERL 79-ITS 67, 3.16a]
  Real near_m = Real(0.04) * path.frequency_mhz * path.terminal[0].effective_height_m *
                path.terminal[1].effective_height_m;
  Real middle_m;
  if (diffraction.at_zero_db >= 0) {
    near_m = smaller(near_m, horizon_m / 2);
    middle_m = near_m + (horizon_m - near_m) / 4;
  } else {
    middle_m = larger(-diffraction.at_zero_db / diffraction.slope_db_m, horizon_m / 4);
  }
  const Real middle_db = lineOfSightDb(path, middle_m, diffraction);

  // loss = smooth_db + linear (d - smooth_m) + logarithmic ln(d / smooth_m)
  Real linear = 0;
  Real logarithmic = 0;
  bool through_both = false;
  if (near_m < middle_m) {
    const Real near_db = lineOfSightDb(path, near_m, diffraction);
    const Real span = std::log(smooth_m / near_m);
    logarithmic = larger(
        Real(0), ((smooth_m - near_m) * (middle_db - near_db) - (middle_m - near_m) * (smooth_db - near_db)) /
                     ((smooth_m - near_m) * std::log(middle_m / near_m) - (middle_m - near_m) * span));
    through_both = diffraction.at_zero_db > 0 || logarithmic > 0;
    if (through_both) {
      linear = (smooth_db - near_db - logarithmic * span) / (smooth_m - near_m);
      if (linear < 0) {
        linear = 0;
        logarithmic = larger(Real(0), smooth_db - near_db) / span;
        if (logarithmic == 0) linear = diffraction.slope_db_m;
      }
    }
  }
  if (!through_both) {
    linear = larger(Real(0), smooth_db - middle_db) / (smooth_m - middle_m);
    logarithmic = 0;
    if (linear == 0) linear = diffraction.slope_db_m;
  }
  return smooth_db + linear * (path.distance_m - smooth_m) +
         logarithmic * std::log(path.distance_m / smooth_m);
}

/// Frequency gain H_0 of one terminal at a whole number of the scatter efficiency eta, 1..5 [TN101, 9.5].
template <class Real>
EMSCAPE_HD Real frequencyGainAt(int eta, Real r) {
  constexpr Real kA[5] = {25, 80, 177, 395, 705};
  constexpr Real kB[5] = {24, 45, 68, 80, 105};
  const Real x = 1 / (r * r);
  return powerDb((kA[eta - 1] * x + kB[eta - 1]) * x + 1);
}

template <class Real>
EMSCAPE_HD Real frequencyGainDb(Real r, Real eta) {
  eta = smaller(larger(eta, Real(1)), Real(5));
  const int below = static_cast<int>(eta);
  const Real fraction = eta - below;
  const Real gain_db = frequencyGainAt(below, r);
  return fraction == 0 ? gain_db : (1 - fraction) * gain_db + fraction * frequencyGainAt(below + 1, r);
}

/// F(theta d): attenuation function of scatter [TN101, 9.1].
template <class Real>
EMSCAPE_HD Real scatterFunctionDb(Real distance_m) {
  const Real log_db = 10 * std::log10(distance_m);
  if (distance_m <= Real(10e3)) return Real(133.4) + Real(0.332e-3) * distance_m - log_db;
  if (distance_m <= Real(70e3)) return Real(104.6) + Real(0.212e-3) * distance_m - log_db / 4;
  return Real(71.8) + Real(0.157e-3) * distance_m + log_db / 2;
}

/// Forward scatter by the troposphere [Alg 4.60-4.67].
template <class Real>
class Troposcatter {
 public:
  EMSCAPE_HD explicit Troposcatter(const ItmPath<Real>& path) : path_(path) {}

  /// Call for the farther distance first: a gain above 15 dB is replaced by that of the previous call.
  /// @return a loss above 1000 dB where scatter is negligible
  EMSCAPE_HD Real lossDb(Real distance_m) {
    const Real angle_rad = path_.horizonAngle_rad() + distance_m / path_.effective_earth_radius_m;
    if (!(gain_db_ > 15)) {
      const Real r[2] = {2 * path_.waveNumber() * angle_rad * path_.terminal[0].effective_height_m,
                         2 * path_.waveNumber() * angle_rad * path_.terminal[1].effective_height_m};
      if (r[0] < Real(0.2) && r[1] < Real(0.2)) return 1001;
      const Real gain_db = gainDb(distance_m, angle_rad, r);
      if (!(gain_db > 15 && gain_db_ >= 0)) gain_db_ = gain_db;
    }
    const Real beyond_rad = path_.beyondHorizon_rad(distance_m);
    const Real square = beyond_rad * beyond_rad;
    return scatterFunctionDb(beyond_rad * distance_m) + powerDb(path_.frequency_mhz * square * square) -
           Real(0.1) * (path_.surface_refractivity - 301) * std::exp(-beyond_rad * distance_m / Real(40e3)) +
           gain_db_;
  }

 private:
  /// H_0 of both terminals [TN101, 9.3-9.5].
  EMSCAPE_HD Real gainDb(Real distance_m, Real angle_rad, const Real (&r)[2]) const {
    Real difference_m = path_.terminal[0].horizon_distance_m - path_.terminal[1].horizon_distance_m;
    Real height_ratio = path_.terminal[1].effective_height_m / path_.terminal[0].effective_height_m;
    if (difference_m < 0) {
      difference_m = -difference_m;
      height_ratio = 1 / height_ratio;
    }
    const Real symmetry = (distance_m - difference_m) / (distance_m + difference_m);
    const Real q = smaller(larger(Real(0.1), height_ratio / symmetry), Real(10));
    const Real s = larger(Real(0.1), symmetry);
    const Real crossing_m =
        (distance_m - difference_m) * (distance_m + difference_m) * angle_rad / 4 / distance_m;
    const Real refractivity = path_.surface_refractivity;
    const Real profile = (Real(5.67e-6) * refractivity - Real(2.32e-3)) * refractivity + Real(0.031);
    const Real cap = smaller(Real(1.7), crossing_m / 8000);
    const Real sixth = cap * cap * cap * cap * cap * cap;
    const Real eta = crossing_m / Real(1.7556e3) * (1 + profile * std::exp(-sixth));
    const Real eta_used = larger(eta, Real(1));

    const Real mean_db = (frequencyGainDb(r[0], eta_used) + frequencyGainDb(r[1], eta_used)) / 2;
    const Real correction_db = 6 * (Real(0.6) - std::log10(eta_used)) * std::log10(s) * std::log10(q);
    Real gain_db = larger(Real(0), mean_db + smaller(mean_db, correction_db));
    if (eta < 1) {
      constexpr Real kRoot2 = Real(1.41421356237309505);
      const Real product = (1 + kRoot2 / r[0]) * (1 + kRoot2 / r[1]);
      gain_db =
          eta * gain_db + (1 - eta) * powerDb(product * product * (r[0] + r[1]) / (r[0] + r[1] + 2 * kRoot2));
    }
    return gain_db;
  }

  const ItmPath<Real>& path_;
  Real gain_db_ = -1;
};

}  // namespace itm_detail

/// Reference attenuation (dB above free space, >= 0) and the mode of propagation [Alg 4.1].
template <class Real>
EMSCAPE_HD ItmReference<Real> itmReference(const ItmPath<Real>& path) {
  using namespace itm_detail;
  const Real horizon_m = path.horizonDistance_m();
  const Real smooth_m = path.smoothHorizonDistance_m();
  const Real radius_m = path.effective_earth_radius_m;
  const Real unit_m = std::cbrt(radius_m * (radius_m / path.frequency_mhz));

  // The diffraction line, through two points well behind the horizon [Alg 4.2-4.8].
  const Real first_m = larger(smooth_m, horizon_m + 5 * unit_m);
  const Real second_m = first_m + 10 * unit_m;
  const Diffraction<Real> diffraction(path);
  const Real first_db = diffraction.lossDb(first_m);
  const Real slope_db_m = (diffraction.lossDb(second_m) - first_db) / (10 * unit_m);
  const LossLine<Real> diffraction_line{first_db - slope_db_m * first_m, slope_db_m};

  if (path.distance_m < smooth_m) {
    return {larger(Real(0), beforeHorizonDb(path, diffraction_line)), ItmMode::line_of_sight};
  }

  // The scatter line, through two points farther out [Alg 4.57-4.59].
  constexpr Real kApart_m = Real(200e3);
  Troposcatter<Real> scatter(path);
  const Real far_db = scatter.lossDb(horizon_m + 2 * kApart_m);
  const Real near_db = scatter.lossDb(horizon_m + kApart_m);
  if (near_db < 1000) {
    const Real scatter_slope = (far_db - near_db) / kApart_m;
    const Real crossing_m = (near_db - diffraction_line.at_zero_db - scatter_slope * (horizon_m + kApart_m)) /
                            (slope_db_m - scatter_slope);
    const Real from_m =
        larger(larger(smooth_m, horizon_m + Real(1.088) * unit_m * std::log(path.frequency_mhz)), crossing_m);
    if (path.distance_m > from_m) {
      return {larger(Real(0), diffraction_line.at(from_m) + scatter_slope * (path.distance_m - from_m)),
              ItmMode::troposcatter};
    }
  } else if (path.distance_m > Real(10e6)) {
    return {larger(Real(0), diffraction_line.at(path.distance_m)), ItmMode::troposcatter};
  }
  return {larger(Real(0), diffraction_line.at(path.distance_m)), ItmMode::diffraction};
}

}  // namespace emscape::propagation
