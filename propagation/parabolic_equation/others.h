/// Models used outside the parabolic equation's limits: close to the antenna and at large angles diffraction
/// over terrain or two rays over a smooth earth, far beyond the horizon troposcatter; and the choice between
/// them.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "propagation/diffraction/excess.h"
#include "propagation/mechanism.h"
#include "propagation/p1812/p1812.h"
#include "propagation/parabolic_equation/direct_ray.h"
#include "propagation/parabolic_equation/sight.h"
#include "propagation/two_ray/excess.h"

namespace emscape::propagation {

/// Fraction (0..1) of the angle's and the range's limits over which two models are blended, in dB.
constexpr float kPeBlendPart = 0.2f;

/// Angle (rad) inside the edge of the band up to which the edge diffracts the field at a range, as a knife
/// edge does up to the Fresnel parameter 1.
template <class Real>
EMSCAPE_HD Real bandEdgeWidth_rad(Real half_wavelength_m, Real range_m) {
  return std::sqrt(half_wavelength_m / range_m);
}

/// Loss over free space at one position, and its contributions.
struct PeLoss {
  float equation_db = 0;         ///< of the parabolic equation, no larger than the floor's
  float equation_part = 1;       ///< its weight in dB: 1 within its limits, 0 outside
  float other_db = 0;            ///< of the other model
  float scatter_db = HUGE_VALF;  ///< by troposcatter; infinite within line of sight
  bool is_extended = false;      ///< from the top of the equation's domain along the ray
  bool is_floor = false;         ///< the equation's field is no larger than its floor

  /// Without troposcatter.
  EMSCAPE_HD float withoutScatter_db() const {
    return equation_part >= 1   ? equation_db
           : equation_part <= 0 ? other_db
                                : other_db + equation_part * (equation_db - other_db);
  }
  EMSCAPE_HD float loss_db() const {
    const float without_db = withoutScatter_db();
    if (!(scatter_db < HUGE_VALF)) return without_db;
    return -10 * std::log10(std::pow(10.0f, -without_db / 10) + std::pow(10.0f, -scatter_db / 10));
  }
  /// Mechanism of the larger contribution to the field, or to the blend in dB.
  EMSCAPE_HD Mechanism mechanism(bool over_terrain) const {
    if (scatter_db < withoutScatter_db()) return Mechanism::troposcatter;
    if (equation_part < 0.5f) return over_terrain ? Mechanism::diffraction : Mechanism::two_ray;
    if (is_floor) return Mechanism::floor;
    return is_extended ? Mechanism::extended_optics : Mechanism::parabolic_equation;
  }
};

/// Plain data, for one emitter. Heights are above mean sea level unless named otherwise.
struct PeOthers {
  float tx_msl_m = 0, tx_agl_m = 0;
  float curvature_per_m = 0;  ///< of rays over the flattened earth, upwards: 10^-6 dM/dz
  float max_angle_rad = 0, min_range_m = 0;
  float half_wavelength_m = 0;
  float largest_db = 80;  ///< of the equation
  DirectRayPattern direct_ray;
  bool over_terrain = false;
  DiffractionExcess diffraction;  ///< over terrain
  TwoRayExcess two_ray;           ///< over the smooth earth, at mean sea level
  /// Size of the cells over which the equation's field and the two rays are averaged; 0: points.
  float cell_range_m = 0, cell_height_m = 0;
  float march_step_m = 0;  ///< between heights that are so far apart, the equation's power is taken as linear
  P1812Model<float> scatter;  ///< input of p1812TroposcatterDb()

  /// Angle (rad) above the horizontal at which the ray to a height leaves the antenna.
  EMSCAPE_HD float launchAngle(float range_m, float height_msl_m) const {
    return (height_msl_m - tx_msl_m) / range_m - curvature_per_m * range_m / 2;
  }

  /// Height (m) of the ray that leaves the antenna at an angle.
  EMSCAPE_HD float rayHeight_msl_m(float angle_rad, float range_m) const {
    return tx_msl_m + range_m * (angle_rad + curvature_per_m * range_m / 2);
  }

  /// The pass over the ground to a column.
  /// @param posts  memory for the ground's posts before the column
  EMSCAPE_HD PeSightWalk sightWalk(double range_m, const SightPosts& posts) const {
    return {tx_msl_m, curvature_per_m, scatter.clear_air.median.half_curvature, static_cast<float>(range_m),
            posts};
  }
  EMSCAPE_HD PeSight sightOf(const ExcessColumn& column, const SightPosts& posts) const {
    const TerrainProfile& profile = column.profile;
    PeSightWalk walk = sightWalk(column.range_m, posts);
    for (int i = 0; i + 1 < profile.count; ++i)
      walk.add({static_cast<float>(profile.range_m[i]), profile.height_msl_m[i]});
    return walk.sight(profile.count > 0 ? profile.height_msl_m[profile.count - 1] : 0);
  }

  /// Largest angle (rad) of the equation at a range: the edge of the band is at max_angle_rad. 0 at short
  /// ranges.
  EMSCAPE_HD float maxAngle(float range_m) const {
    const float angle_rad = max_angle_rad - bandEdgeWidth_rad(half_wavelength_m, range_m);
    return angle_rad > 0 ? angle_rad : 0;
  }

  /// Largest angle (rad) above the horizontal at which the field passes a ridge, seen from either end, at
  /// least 0; 0 over a smooth earth.
  EMSCAPE_HD float ridgeAngle(float range_m, const PeSight& sight, float height_msl_m) const {
    if (!over_terrain) return 0;
    float angle_rad = sight.horizon_rad;
    float before_rad = -HUGE_VALF;
    for (int n = sight.count - 1; n >= 0; --n) {
      const SightPost post = sight.posts.get(n);
      const float left_m = range_m - post.range_m;
      if (left_m < PeSight::kNearGround_m) continue;
      const float seen_rad = (post.ground_m - height_msl_m) / left_m - curvature_per_m * left_m / 2;
      if (seen_rad < before_rad) break;  // behind the horizon the angles fall
      before_rad = seen_rad;
      angle_rad = seen_rad > angle_rad ? seen_rad : angle_rad;
    }
    return angle_rad;
  }

  /// Weight of the equation.
  /// @param horizon_rad  ridgeAngle()
  EMSCAPE_HD float equationPart(float range_m, float height_msl_m, float ground_msl_m,
                                float horizon_rad) const {
    if (!(range_m > min_range_m)) return 0;
    const float above_m = height_msl_m > ground_msl_m ? height_msl_m - ground_msl_m : 0;
    const float direct = std::fabs(launchAngle(range_m, height_msl_m));
    const float reflected = (tx_agl_m + above_m) / range_m - curvature_per_m * range_m / 2;
    const float seen = direct > reflected ? direct : reflected;
    const float angle = seen > horizon_rad ? seen : horizon_rad;
    const float by_angle = (maxAngle(range_m) - angle) / (kPeBlendPart * max_angle_rad);
    const float by_range = (range_m / min_range_m - 1) / kPeBlendPart;
    const float part = by_angle < by_range ? by_angle : by_range;
    return part < 0 ? 0 : part > 1 ? 1 : part;
  }

  /// Sets the equation's loss relative to the direct ray to a position, at most that of its floor.
  EMSCAPE_HD void setEquation(float equation_db, float range_m, float height_msl_m, PeLoss& loss) const {
    loss.is_floor = equation_db > largest_db;
    loss.equation_db = loss.is_floor ? largest_db : equation_db;
    if (direct_ray.is_weighed)
      loss.equation_db += direct_ray.pattern_db(std::atan(launchAngle(range_m, height_msl_m)));
  }

  /// Range (m) at which the ray to a position above a given height, itself above the antenna, crosses it.
  EMSCAPE_HD float crossing_m(float range_m, float height_msl_m, float crossed_msl_m) const {
    const float rise_m = crossed_msl_m - tx_msl_m, angle = launchAngle(range_m, height_msl_m);
    const float under = angle * angle + 2 * curvature_per_m * rise_m;
    const float at_m = 2 * rise_m / (angle + std::sqrt(under > 0 ? under : 0));
    return at_m > 0 && at_m < range_m ? at_m : range_m;
  }

  /// Losses of the other model at all heights of a column; NaN beyond missing terrain.
  EMSCAPE_HD void fill(const ExcessColumn& column, const ExcessScratch& scratch, float* other_db) const {
    if (over_terrain) {
      diffraction(column, scratch, other_db);
      return;
    }
    for (int k = 0; k < column.count; ++k) other_db[k] = twoRays_db(column.range_m, column.height_msl_m[k]);
  }

  /// Adds troposcatter to a loss where it can be significant.
  EMSCAPE_HD void addScatter(float range_m, const PeSight& sight, float height_msl_m, PeLoss& loss) const {
    constexpr float kMatters_db = 30;  // troposcatter is weaker than that by 15 dB and more
    if (loss.withoutScatter_db() < kMatters_db) return;
    const float angle_rad = horizonAngle(range_m, sight, height_msl_m);
    if (!(angle_rad > 0)) return;
    const float free_space_db = 92.45f + 20 * std::log10(scatter.clear_air.frequency_ghz * range_m / 1000);
    const float scatter_db = p1812TroposcatterDb(scatter, range_m, 1000 * angle_rad) - free_space_db;
    loss.scatter_db = scatter_db > 0 ? scatter_db : 0;
  }

  /// Mean of the two rays over a cell, in which the difference of their paths is linear; taken as the
  /// equation's mean, so that there is no seam between them.
  EMSCAPE_HD float twoRays_db(double range_m, float height_msl_m) const {
    float excess_db = 0;
    const ReflectedRay ray = two_ray.reflectedRay(range_m, height_msl_m, excess_db);
    if (ray.weight < 1) return excess_db;
    const float phase_per_m =
        2 * float(kPi) * 2 * tx_agl_m / (float(two_ray.model.earth.wavelength_m) * float(range_m));
    const float of_lines = sinc(phase_per_m * march_step_m / 2);
    const float mean = of_lines * of_lines * sinc(phase_per_m * cell_height_m / 2) *
                       sinc(phase_per_m * height_msl_m / float(range_m) * cell_range_m / 2);
    const float power = 1 + ray.re * ray.re + ray.im * ray.im + 2 * ray.re * mean;
    constexpr float kLowest = 1e-6f;  // 60 dB, as two_ray
    return -10 * std::log10(power > kLowest ? power : kLowest);
  }

 private:
  static EMSCAPE_HD float sinc(float x) { return std::fabs(x) < 1e-3f ? 1 : std::sin(x) / x; }

  /// Angle (rad) between the horizon rays of both ends, 0 within line of sight.
  EMSCAPE_HD float horizonAngle(float range_m, const PeSight& sight, float height_msl_m) const {
    const float half_curvature = scatter.clear_air.median.half_curvature;
    const float to_rx = (height_msl_m - tx_msl_m) / range_m - half_curvature * range_m;
    if (!(sight.to_ground_rad > to_rx)) return 0;
    float of_rx = -HUGE_VALF;
    for (int n = sight.count - 1; n >= 0; --n) {
      const SightPost post = sight.posts.get(n);
      const float left_m = range_m - post.range_m;
      const float from_rx = (post.ground_m - height_msl_m) / left_m - half_curvature * left_m;
      if (from_rx < of_rx) break;  // behind the horizon the angles fall
      of_rx = from_rx;
    }
    return 2 * half_curvature * range_m + sight.to_ground_rad + of_rx;
  }
};

}  // namespace emscape::propagation
