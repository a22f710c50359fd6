#include "propagation/p528/p528.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "propagation/p528/variability.h"

namespace emscape::propagation {
namespace {

constexpr double kEffectiveEarth_km = 9257;
constexpr double kSurfaceRefractivity = 341;
constexpr double kPermittivity = 15;
constexpr double kConductivity_s_m = 0.005;
/// Length of the shortest ray, the lower limit of free space.
constexpr double kNearest_km = 0.001;

double square(double x) {
  return x * x;
}

void require(const ModelLimit& limit, double value) {
  if (!limit.holds(value)) throw Error(ErrorCode::bad_input, "p528: " + outsideMessage(limit, value));
}

double freeSpace_db(double frequency_mhz, double length_km) {
  return 20 * std::log10(frequency_mhz) + 20 * std::log10(length_km) + 32.45;
}

/// Complex permittivity of the ground: epsilon_r - i X.
double reactance(double frequency_mhz) {
  return 18000 * kConductivity_s_m / frequency_mhz;
}

/// F(x): gain by height in the smooth-earth diffraction [10; Vogler 1964, ES-83-3 (72) to (75)].
double diffractionHeightGain_db(double x, double k) {
  const double log_x = std::log10(x);
  const double low_db = 40 * log_x - 117;
  const double high_db = 0.05751 * x - 10 * log_x;
  if (x > 2000) return high_db;
  if (x > 200) {
    const double weight = 0.0134 * x * std::exp(-0.005 * x);
    return weight * low_db + (1 - weight) * high_db;
  }
  const double log_k = std::log10(k);
  if (x < -450 / (log_k * log_k * log_k)) return 20 * log_k - 15 + 0.000025 * x * x / k;
  return std::max(low_db, -117.0);
}

/// Root of an increasing function of the grazing angle, 0..pi/2; the nearer end if it has none.
/// @accuracy 1e-15
/// @see Chandrupatla 1997, Advances in Engineering Software 28: inverse quadratic interpolation where that is
/// known to converge, else bisection
template <class Rising>
double grazingAngleWhere(Rising rising) {
  constexpr double kWithin_rad = 1e-15;
  struct Point {
    double angle_rad;
    double value;
  };
  const auto at = [&](double angle_rad) { return Point{angle_rad, rising(angle_rad)}; };
  Point a = at(kWithin_rad / 2), b = at(kPi / 2);
  if (a.value > 0) return a.angle_rad;
  if (!(b.value > 0)) return b.angle_rad;
  double part = 0.5;
  for (int i = 0; i < 100; ++i) {
    const Point next = at(a.angle_rad + part * (b.angle_rad - a.angle_rad));
    Point c = a;
    if ((next.value > 0) != (a.value > 0)) {
      c = b;
      b = a;
    }
    a = next;
    const Point& best = std::fabs(a.value) < std::fabs(b.value) ? a : b;
    const double least = kWithin_rad / std::fabs(b.angle_rad - a.angle_rad);
    if (best.value == 0 || least > 0.5) return best.angle_rad;
    const double xi = (a.angle_rad - b.angle_rad) / (c.angle_rad - b.angle_rad);
    const double phi = (a.value - b.value) / (c.value - b.value);
    part = 0.5;
    if (phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi) {
      part = a.value / (b.value - a.value) * c.value / (b.value - c.value) +
             (c.angle_rad - a.angle_rad) / (b.angle_rad - a.angle_rad) * a.value / (c.value - a.value) *
                 b.value / (c.value - b.value);
    }
    part = std::clamp(part, least, 1 - least);
  }
  return a.angle_rad;
}

}  // namespace

/// The direct ray and the one reflected by the ground, for a grazing angle [7].
struct P528Curve::TwoRays {
  double grazing_rad;
  double distance_km;          ///< along the ground
  double earth_radius_km;      ///< a_a: effective, for rays of this steepness
  double to_reflection_km[2];  ///< D: from each terminal, horizontally
  double direct_km;            ///< r_0
  double reflected_km;         ///< r_12
  double difference_km;        ///< of their lengths
  double elevation_rad;        ///< of the direct ray at the lower terminal
};

/// Scatter by the troposphere [11].
struct P528Curve::Scatter {
  double loss_db = 0;
  double crossing_height_km = 0;  ///< h_v: of the common volume of both horizon rays
  double angle_rad = 0;           ///< theta_s
};

/// [4]
P528Terminal p528Terminal(const P528Atmosphere& atmosphere, double height_m) {
  require(kP528Height, height_m);
  const double height_km = height_m / 1000;
  P528Terminal terminal;
  terminal.height_km = height_km;
  terminal.horizon_ray = atmosphere.trace(0, height_km, 0);
  terminal.horizon_km =
      kP528EarthRadius_km * (terminal.horizon_ray.upper_elevation_rad + terminal.horizon_ray.bending_rad);
  const double angle_rad = terminal.horizon_km / kEffectiveEarth_km;                             // (4-1)
  terminal.effective_height_km = kEffectiveEarth_km / std::cos(angle_rad) - kEffectiveEarth_km;  // (4-2)
  terminal.height_difference_km = height_km - terminal.effective_height_km;                      // (4-3)
  return terminal;
}

P528Curve::P528Curve(const std::shared_ptr<const P528Atmosphere>& atmosphere, double frequency_hz,
                     double first_height_m, double second_height_m, bool vertical_polarization)
    : P528Curve(atmosphere, frequency_hz, p528Terminal(*atmosphere, first_height_m),
                p528Terminal(*atmosphere, second_height_m), vertical_polarization) {}

P528Curve::P528Curve(std::shared_ptr<const P528Atmosphere> atmosphere, double frequency_hz,
                     const P528Terminal& first, const P528Terminal& second, bool vertical_polarization)
    : atmosphere_(std::move(atmosphere)),
      frequency_mhz_(frequency_hz / 1e6),
      wavelength_km_(0.2997925 / frequency_mhz_),
      vertical_(vertical_polarization),
      terminal_{first, second} {
  require(kP528Frequency, frequency_hz);
  if (second.height_km < first.height_km) std::swap(terminal_[0], terminal_[1]);
  horizon_km_ = terminal_[0].horizon_km + terminal_[1].horizon_km;  // (3-1)

  // the line through two diffraction losses behind the horizon (3-2) to (3-7)
  const double unit_km = std::cbrt(square(kEffectiveEarth_km) / frequency_mhz_);
  const double first_km = horizon_km_ + 0.5 * unit_km;
  const double second_km = horizon_km_ + 1.5 * unit_km;
  const double second_db = diffraction_db(second_km);
  diffraction_.slope_db_km = (second_db - diffraction_db(first_km)) / unit_km;
  diffraction_.at_zero_db = second_db - diffraction_.slope_db_km * second_km;
  horizon_loss_db_ = diffraction_.at(horizon_km_);

  setLobing();
  horizon_k_db_ = lineOfSight(horizon_km_ - 1, 50).k_db;
  setBeyondHorizon();
}

/// Over a smooth earth [10].
double P528Curve::diffraction_db(double distance_km) const {
  const double x = reactance(frequency_mhz_);
  const double cube_root_f = std::cbrt(frequency_mhz_);
  double k = 0.01778 / cube_root_f / std::pow(square(kPermittivity - 1) + x * x, 0.25);
  if (vertical_) k *= std::sqrt(square(kPermittivity) + x * x);
  const double scale = (1.607 - k) * cube_root_f;
  const double path_x = scale * distance_km;
  double loss_db = 0.05751 * path_x - 10 * std::log10(path_x) - 20;
  for (const P528Terminal& terminal : terminal_) {
    loss_db -= diffractionHeightGain_db(scale * terminal.horizon_km, k);
  }
  return loss_db;
}

P528Curve::TwoRays P528Curve::raysAt(double grazing_rad) const {
  TwoRays rays;
  rays.grazing_rad = grazing_rad;
  const double flattening = kP528EarthRadius_km / kEffectiveEarth_km - 1;                 // (7-1)
  rays.earth_radius_km = kP528EarthRadius_km / (1 + flattening * std::cos(grazing_rad));  // (7-2), (7-3)
  const double share =
      (rays.earth_radius_km - kP528EarthRadius_km) / (kEffectiveEarth_km - kP528EarthRadius_km);
  double radius_km[2];
  double angle_rad[2];
  double above_tangent_km[2];
  const bool steep = grazing_rad > 1.56;
  for (int end = 0; end < 2; ++end) {
    const double height_km = terminal_[end].height_km - share * terminal_[end].height_difference_km;  // (7-5)
    radius_km[end] = rays.earth_radius_km + height_km;
    angle_rad[end] =
        std::acos(rays.earth_radius_km * std::cos(grazing_rad) / radius_km[end]) - grazing_rad;      // (7-7)
    rays.to_reflection_km[end] = radius_km[end] * std::sin(angle_rad[end]);                          // (7-8)
    above_tangent_km[end] = steep ? height_km : rays.to_reflection_km[end] * std::tan(grazing_rad);  // (7-9)
  }
  const double across_km = rays.to_reflection_km[0] + rays.to_reflection_km[1];
  rays.distance_km = std::max(0.0, rays.earth_radius_km * (angle_rad[0] + angle_rad[1]));     // (7-11)
  const double slope_rad = std::atan2(above_tangent_km[1] - above_tangent_km[0], across_km);  // (7-12)
  rays.direct_km =
      std::max(std::fabs(radius_km[0] - radius_km[1]), across_km / std::cos(slope_rad));  // (7-13)
  // (7-14); for a vertical ray its quotient is 0 / 0
  rays.reflected_km = steep ? (above_tangent_km[0] + above_tangent_km[1]) / std::sin(grazing_rad)
                            : across_km / std::cos(grazing_rad);
  rays.difference_km =
      4 * above_tangent_km[0] * above_tangent_km[1] / (rays.direct_km + rays.reflected_km);  // (7-15)
  rays.elevation_rad = slope_rad - angle_rad[0];                                             // (7-16)
  return rays;
}

P528Curve::TwoRays P528Curve::raysAtDistance(double distance_km) const {
  return raysAt(grazingAngleWhere([&](double angle) { return distance_km - raysAt(angle).distance_km; }));
}

P528Curve::TwoRays P528Curve::raysAtDelay(double path_difference_km) const {
  return raysAt(
      grazingAngleWhere([&](double angle) { return raysAt(angle).difference_km - path_difference_km; }));
}

/// Field of the reflected ray relative to the direct one, without the phase of the path difference [8, 9].
Complex<double> P528Curve::reflectedField(const TwoRays& rays) const {
  const double sine = std::sin(rays.grazing_rad);
  const Complex<double> ground{kPermittivity, -reactance(frequency_mhz_)};
  const Complex<double> root = sqrt(ground - Complex<double>{square(std::cos(rays.grazing_rad)), 0});
  const Complex<double> incident = vertical_ ? ground * sine : Complex<double>{sine, 0};
  double divergence = 1;
  if (std::tan(rays.grazing_rad) < 0.1) {
    const double reduced =
        2 * rays.to_reflection_km[0] * rays.to_reflection_km[1] / std::cos(rays.grazing_rad) /
        (rays.to_reflection_km[0] + rays.to_reflection_km[1]) / rays.earth_radius_km;        // (8-4)
    divergence = 1 / std::sqrt(1 + reduced * (1 + sine * sine) / sine + reduced * reduced);  // (8-5)
  }
  const double lengths = std::min(rays.direct_km / rays.reflected_km, 1.0);  // (8-6)
  return (incident - root) / (incident + root) * (divergence * lengths);
}

/// Level (dB) of both rays relative to the direct one alone, at most 0 [8].
double P528Curve::twoRayGain_db(const TwoRays& rays) const {
  if (rays.grazing_rad > last_lobe_rad_) return 0;
  const double lag = 2 * kPi * rays.difference_km / wavelength_km_;
  const Complex<double> field =
      Complex<double>{1, 0} + reflectedField(rays) * Complex<double>{std::cos(lag), -std::sin(lag)};
  return 10 * std::log10(std::min(norm(field), 1.0));
}

/// Limits of the lobing region [6, 8].
void P528Curve::setLobing() {
  last_lobe_rad_ = raysAtDelay(wavelength_km_ / 2).grazing_rad;
  // the farthest distance at which two rays in phase opposition give the free-space level
  const double last_free_km = raysAtDelay(wavelength_km_ / 6).distance_km;
  const double no_diffraction_km = -diffraction_.at_zero_db / diffraction_.slope_db_km;  // (3-7)
  const double near_km = terminal_[0].horizon_km;
  if (near_km >= no_diffraction_km || no_diffraction_km >= horizon_km_) {
    lobing_end_km_ = near_km > last_free_km || last_free_km > horizon_km_ ? near_km : last_free_km;
  } else {
    lobing_end_km_ =
        no_diffraction_km < last_free_km && last_free_km < horizon_km_ ? last_free_km : no_diffraction_km;
  }
  lobing_end_gain_db_ = twoRayGain_db(raysAtDistance(lobing_end_km_));
}

/// [6, 13]
P528Curve::LineOfSight P528Curve::lineOfSight(double distance_km, double time_percent) const {
  const TwoRays rays = raysAtDistance(distance_km);
  double gain_db = 0;
  if (rays.distance_km > lobing_end_km_) {
    // (8-1)
    const double share = (rays.distance_km - lobing_end_km_) / (horizon_km_ - lobing_end_km_);
    gain_db = lobing_end_gain_db_ + share * (-horizon_loss_db_ - lobing_end_gain_db_);
  } else {
    gain_db = twoRayGain_db(rays);
  }

  const P528Ray ray = atmosphere_->trace(terminal_[0].height_km, terminal_[1].height_km, rays.elevation_rad);

  // (13-1)
  double angle_factor = 1;
  if (rays.elevation_rad >= 1) {
    angle_factor = 0;
  } else if (rays.elevation_rad > 0) {
    angle_factor = std::max(0.0, 0.5 - std::atan(20 * std::log10(32 * rays.elevation_rad)) / kPi);
  }
  const auto slowAt = [&](double percent) {
    return p528SlowVariability(horizon_km_, distance_km, frequency_mhz_, percent, angle_factor, gain_db);
  };
  const P528Slow median = slowAt(50);

  // the reflected ray's contribution to fading (13-2) to (13-4)
  double steadiness = 1;
  if (median.adjustment_db >= 9) {
    steadiness = 0.1;
  } else if (median.adjustment_db > 0) {
    steadiness = (1.1 + 0.9 * std::cos(median.adjustment_db / 9 * kPi)) / 2;
  }
  const double delay = rays.difference_km / wavelength_km_;
  double lobes = 1;
  if (delay <= 1.0 / 6) {
    lobes = 0.1;
  } else if (delay < 0.5) {
    lobes = (1.1 - 0.9 * std::cos(3 * kPi * (delay - 1.0 / 6))) / 2;
  }
  const double reflected = abs(reflectedField(rays)) * lobes * steadiness;

  // (13-5) to (13-9)
  const double turbulence_db =
      p528KOfLossAt99Percent_db(10 * std::log10(frequency_mhz_ * std::pow(ray.length_km, 3)) - 84.26);
  const double scattered = square(reflected) + square(0.01) + std::pow(10, turbulence_db / 10);

  LineOfSight result;
  result.k_db = std::max(kP528MinK_db, 10 * std::log10(scattered));
  result.loss.mode = P528Mode::line_of_sight;
  result.loss.absorption_db = ray.absorption_db;
  result.loss.free_space_db = freeSpace_db(frequency_mhz_, std::max(rays.direct_km, kNearest_km));
  result.loss.loss_db = result.loss.free_space_db + result.loss.absorption_db - gain_db -
                        p528Combined_db(median.gain_db, slowAt(time_percent).gain_db,
                                        p528Fading_db(result.k_db, time_percent), time_percent);
  return result;
}

/// [11]
P528Curve::Scatter P528Curve::scatterAt(double distance_km) const {
  Scatter scatter;
  const double half_km = (distance_km - horizon_km_) / 2;  // (11-2), (11-6)
  if (half_km <= 0) return scatter;

  // bending of the horizon rays on their way to the volume (11-7) to (11-19)
  const double curvature = 1 / kP528EarthRadius_km;
  const double gradient = curvature - 1 / kEffectiveEarth_km;
  const double scale_km = kSurfaceRefractivity * 1e-6 / gradient;
  const auto bentCurvature = [&](double height_km) {
    return curvature - gradient * std::exp(-std::min(35.0, height_km / scale_km));
  };
  const double at_ground = curvature - gradient;
  const double at_quarter = bentCurvature(square(half_km / 2) / (2 * kEffectiveEarth_km));
  const double at_half = bentCurvature(square(half_km) / (2 * kEffectiveEarth_km));
  const double middle_km = (7 * at_ground + 6 * at_quarter - at_half) * square(half_km) / 96;
  const double far_km = (at_ground + 2 * at_quarter) * square(half_km) / 6;
  const double at_middle = bentCurvature(middle_km);
  const double at_far = bentCurvature(far_km);
  scatter.crossing_height_km = (at_ground + 2 * at_middle) * square(half_km) / 6;
  scatter.angle_rad = (at_ground + 4 * at_middle + at_far) * half_km / 3;

  // scattering efficiency (11-20) to (11-23)
  const double n = kSurfaceRefractivity;
  const double h = scatter.crossing_height_km;
  const double e1 = 5.67e-6 * n * n - 0.00232 * n + 0.031;
  const double e2 = 0.0002 * n * n - 0.06 * n + 6.6;
  const double gamma = 0.1424 * (1 + e1 * std::exp(-std::min(35.0, std::pow(h / 4, 6))));
  const double efficiency_db =
      83.1 - e2 / (1 + 0.07716 * h * h) + 20 * std::log10(square(0.1424 / gamma) * std::exp(gamma * h));

  // scattering volume (11-24) to (11-38)
  const double wave_number = frequency_mhz_ / 0.0477;
  double to_volume_km[2];
  double rho[2];
  for (int end = 0; end < 2; ++end) {
    const double height_km = terminal_[end].effective_height_km;
    const double half_angle = terminal_[end].horizon_km / (2 * kEffectiveEarth_km);
    to_volume_km[end] =
        half_km + std::sqrt(square(height_km) + 4 * (kEffectiveEarth_km + height_km) * kEffectiveEarth_km *
                                                    square(std::sin(half_angle)));
    rho[end] = 2 * wave_number * scatter.angle_rad * height_km;
  }
  const double length_km = to_volume_km[0] + to_volume_km[1];
  const double s = (to_volume_km[0] - to_volume_km[1]) / length_km;
  const double eta = gamma * scatter.angle_rad * length_km / 2;
  const double x2[2] = {square(square(1 + s) * eta), square(square(1 - s) * eta)};
  const double rho2[2] = {square(rho[0]), square(rho[1])};
  const double q[2] = {x2[0] + rho2[0], x2[1] + rho2[1]};
  const double a = square(1 - s * s);
  const double b = 6 + 8 * s * s + 8 * (1 - s) * x2[0] * rho2[0] / square(q[0]) +
                   8 * (1 + s) * x2[1] * rho2[1] / square(q[1]) +
                   2 * (1 - s * s) * (1 + 2 * x2[0] / q[0]) * (1 + 2 * x2[1] / q[1]);
  const double root2 = std::sqrt(2.0);
  const double c = 12 * square(1 + root2 / rho[0]) * square(1 + root2 / rho[1]) * (rho[0] + rho[1]) /
                   (rho[0] + rho[1] + 2 * root2);
  const double volume_db =
      10 * std::log10((a * eta * eta + b * eta) * (q[0] / rho2[0]) * (q[1] / rho2[1]) + c);

  scatter.loss_db =
      efficiency_db + volume_db + 10 * std::log10(wave_number * std::pow(scatter.angle_rad, 3) / length_km);
  return scatter;
}

/// Distance at which scatter replaces diffraction: the first kilometre over which its loss grows more slowly
/// [3, step 6].
void P528Curve::setBeyondHorizon() {
  constexpr int kSearched_km = 100;
  constexpr double kMinLoss_db = 20;  // below, the scatter model does not hold
  beyond_ = diffraction_;
  lesser_counts_ = true;
  double before_db = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < kSearched_km; ++i) {
    scatter_from_km_ = horizon_km_ + 3 + i;
    const double before_km = scatter_from_km_ - 1;
    const double loss_db = scatterAt(scatter_from_km_).loss_db;
    if (loss_db < kMinLoss_db) continue;
    if (loss_db - before_db <= beyond_.slope_db_km) {  // not where before_db is NaN
      lesser_counts_ = before_db >= beyond_.at(before_km);
      if (!lesser_counts_) {
        // (3-12), (3-13): from the horizon to the scatter curve
        beyond_.slope_db_km = (before_db - horizon_loss_db_) / (before_km - horizon_km_);
        beyond_.at_zero_db = before_db - beyond_.slope_db_km * before_km;
      }
      return;
    }
    before_db = loss_db;
  }
  // only diffraction, unless scatter is less
}

/// [3, steps 7 to 10]
P528Loss P528Curve::transhorizon(double distance_km, double time_percent) const {
  const double diffraction_db = beyond_.at(distance_km);
  const Scatter scatter = scatterAt(distance_km);
  P528Loss result;
  const bool scatters =
      distance_km >= scatter_from_km_ && (!lesser_counts_ || scatter.loss_db <= diffraction_db);
  result.mode = scatters ? P528Mode::troposcatter : P528Mode::diffraction;
  const double excess_db = scatters ? scatter.loss_db : diffraction_db;

  const auto slowAt = [&](double percent) {
    return p528SlowVariability(horizon_km_, distance_km, frequency_mhz_, percent, 1, -excess_db).gain_db;
  };
  // fading increases from that at the horizon to Rayleigh fading at 1.5 degrees
  constexpr double kRayleigh_db = 20;
  const double share = std::clamp(scatter.angle_rad / degToRad(1.5), 0.0, 1.0);
  const double k_db = horizon_k_db_ + share * (kRayleigh_db - horizon_k_db_);

  const P528Ray upper = atmosphere_->trace(0, scatter.crossing_height_km, 0);
  const P528Ray& first = terminal_[0].horizon_ray;
  const P528Ray& second = terminal_[1].horizon_ray;
  result.absorption_db = first.absorption_db + second.absorption_db + 2 * upper.absorption_db;  // (3-17)
  result.free_space_db = freeSpace_db(
      frequency_mhz_, first.length_km + second.length_km + 2 * upper.length_km);  // (3-18), (3-19)
  result.loss_db = result.free_space_db + result.absorption_db + excess_db -
                   p528Combined_db(slowAt(50), slowAt(time_percent), p528Fading_db(k_db, time_percent),
                                   time_percent);  // (3-20)
  return result;
}

P528Loss P528Curve::at(double distance_m, double time_percent) const {
  if (!(distance_m >= 0) || !kP528Percentage.holds(time_percent)) {
    P528Loss refused;
    refused.loss_db = std::numeric_limits<double>::quiet_NaN();
    return refused;
  }
  const double distance_km = distance_m / 1000;
  return horizon_km_ - distance_km > 0.001 ? lineOfSight(distance_km, time_percent).loss
                                           : transhorizon(distance_km, time_percent);
}

}  // namespace emscape::propagation
