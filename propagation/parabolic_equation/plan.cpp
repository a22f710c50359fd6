#include "propagation/parabolic_equation/plan.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "emscape/base/error.h"
#include "emscape/base/work.h"
#include "propagation/parabolic_equation/air/path_air.h"
#include "propagation/parabolic_equation/direct_ray.h"
#include "propagation/parabolic_equation/march/march_lanes.h"
#include "propagation/parabolic_equation/march/march_start.h"
#include "propagation/parabolic_equation/others.h"

namespace emscape::propagation {
namespace {

constexpr double kAngle_rad = 3 * kPi / 180, kSmallestAngle_rad = kPi / 180;
constexpr int kPlainIntervals = 4096, kTerrainIntervals = 2048;  // limit the domain's height
constexpr int kDearIntervals = 8192;                             // limit for a larger angle
constexpr int kSlopeIntervals = 4096;                            // limit for an angle that holds slopes
/// Over terrain: min fraction of the largest angle that is kept in order to halve the height steps.
constexpr double kWorthwhileAngle = 0.75;
/// Up to the first number of azimuths, which a GPU marches concurrently (three on each of its 132
/// multiprocessors), they are one position apart, else two.
constexpr int kFewAzimuths = 396, kMaxAzimuths = 1584;
constexpr double kFinestStep_m = 50;  // for positions that are closer
constexpr int kMaxHeights = 1024, kMaxRanges = 2000;
constexpr double kUsablePart = 0.8;  // fraction of the height below the absorber
/// Positions in a narrower sector have as many height steps as a single path, if the ground's slopes need
/// them.
constexpr double kNarrowSector_rad = 0.2 * kPi / 180;

void requireWithinLimit(const ModelLimit& limit, double value_si) {
  if (!limit.holds(value_si)) throw Error(ErrorCode::bad_input, outsideMessage(limit, value_si));
}

/// Height (m) covered by a number of height steps at an angle; see automaticGrid().
double affordable_m(const EmitterInputs& emitter, double angle_rad, int intervals) {
  const double step_m = kPeEvenBand * wavelength_m(emitter.frequency_hz) / (2 * std::sin(angle_rad));
  return intervals * step_m * kPeUsable * (1 - kPeAbsorberPart);
}

/// Largest angle up to `angle_rad` at which a number of height steps covers a height.
double affordableAngle_rad(const EmitterInputs& emitter, double angle_rad, double height_m, int intervals) {
  const double part = affordable_m(emitter, angle_rad, intervals) / height_m;
  return part >= 1 ? angle_rad : std::asin(std::sin(angle_rad) * part);
}

/// Largest angle (rad) for which the band holds the slopes, and the equation applies behind the ridges.
double groundAngle_rad(const DomainNeeds& needs) {
  constexpr double kFresnel_rad = 0.5 * kPi / 180;  // about bandEdgeWidth_rad() at the ridges
  const double sine = std::sin(needs.slope_rad) * kPeEvenBand / kPeMaxSlopePart;
  const double for_slopes_rad = std::asin(std::min(sine, 1.0));
  const double for_ridges_rad =
      needs.ridge_rad > 0 ? (needs.ridge_rad + kFresnel_rad) / (1 - double(kPeBlendPart)) : 0;
  const double whole_deg = std::ceil(radToDeg(std::max(for_slopes_rad, for_ridges_rad)));
  return std::min(degToRad(whole_deg), kPeAngle.max * kPeAngle.si_per_unit);
}

double planAngle_rad(const EmitterInputs& emitter, const DomainNeeds& needs, double height_m,
                     std::string& why) {
  const double given_deg = emitter.settings.parabolic_equation.max_angle_deg;
  why = "given";
  if (given_deg > 0) return degToRad(given_deg);
  why = "for two rays between antennas near the ground";
  double angle_rad = affordableAngle_rad(emitter, kAngle_rad, height_m, kDearIntervals);
  if (angle_rad < kAngle_rad) {
    angle_rad = std::max(angle_rad, kSmallestAngle_rad);
    angle_rad = affordableAngle_rad(emitter, angle_rad, height_m, kPeMaxIntervals);
    why = fmt::format("what the height steps afford up to {:.4g} m above the lowest ground", height_m);
  }
  const double wanted_rad = groundAngle_rad(needs);
  if (wanted_rad <= angle_rad) return angle_rad;
  const int intervals = needs.is_single || needs.is_narrow ? kPeMaxIntervals : kSlopeIntervals;
  const double affordable_rad = affordableAngle_rad(emitter, wanted_rad, height_m, intervals) * (1 - 1e-9);
  const std::string ground = fmt::format("slopes of {:.3g} degrees and ridges seen at {:.3g}",
                                         radToDeg(needs.slope_rad), radToDeg(needs.ridge_rad));
  why = affordable_rad > angle_rad && affordable_rad >= wanted_rad * (1 - 1e-6)
            ? "for " + ground
            : fmt::format("what {} height steps afford; {} need {:.3g}", intervals, ground,
                          radToDeg(wanted_rad));
  return std::max(angle_rad, affordable_rad);
}

/// Time (s) on one core per azimuth, step and height, rounded up (docs/parabolic-equation.md, Speed).
double secondsPerPoint(bool has_terrain) {
  return has_terrain ? 20e-9 : 14e-9;
}

/// Description of an elevation cut within the equation's angles.
std::string sourceText(const ElevationPattern& pattern, double max_angle_rad) {
  if (!pattern) return "the antenna's elevation cut, which is isotropic";
  const DirectRayPattern cut = directRayPattern(pattern, max_angle_rad);
  const float* const largest = std::max_element(cut.db, cut.db + DirectRayPattern::kEntries);
  return fmt::format("the antenna's elevation cut: at most {:.1f} dB, at {:.2f} degrees; {:.1f} dB at 0",
                     *largest, radToDeg(cut.angle_rad(int(largest - cut.db))), cut.pattern_db(0));
}

bool areSameAir(const std::vector<RefractivityAlongPath>& air) {
  return std::all_of(air.begin(), air.end(), [&](const auto& other) { return other == air.front(); });
}

/// @return why so many
std::string planAzimuths(const PathInputs& inputs, const RadialInputs& radials, PePlan& plan) {
  const double given = inputs.emitter.settings.parabolic_equation.azimuths;
  const double voxel_rad = std::max(radials.spacing_m, plan.grid.range_step_m) / radials.farthest_m;
  const double one_apart = std::ceil(radials.azimuth_span_rad / voxel_rad);
  const double two_apart = std::ceil(radials.azimuth_span_rad / (2 * voxel_rad));
  const double automatic =
      std::clamp(std::max(std::min(one_apart, double(kFewAzimuths)), two_apart), 8.0, double(kMaxAzimuths));
  std::string why = fmt::format("{} at the far end, at most {} around",
                                one_apart <= kFewAzimuths  ? "one voxel apart"
                                : two_apart > kFewAzimuths ? "two voxels apart"
                                                           : "at most two voxels apart",
                                kMaxAzimuths);
  plan.is_around = radials.isAround();
  plan.azimuths = int(given > 0 ? given : automatic);
  if (given > 0) why = "given";
  plan.first_azimuth_rad = radials.first_azimuth_rad;
  const int gaps = plan.is_around ? plan.azimuths : std::max(plan.azimuths - 1, 1);
  plan.azimuth_step_rad = radials.azimuth_span_rad / gaps;
  return why;
}

/// @param why  planAzimuths()
void planAir(const PathInputs& inputs, const RadialInputs& radials, std::string why, PePlan& plan) {
  for (int i = 0; i < plan.azimuths; ++i) {
    std::vector<RefractivityAlongPath> members =
        pathAirs(inputs.emitter.atmosphere, inputs.site, plan.azimuth_rad(i));
    plan.air.resize(members.size());
    for (std::size_t m = 0; m < members.size(); ++m) plan.air[m].push_back(std::move(members[m]));
  }
  if (std::all_of(plan.air.begin(), plan.air.end(), areSameAir)) {
    for (std::vector<RefractivityAlongPath>& member : plan.air) member.resize(1);
    if (!radials.has_terrain) {
      plan.azimuths = 1;
      plan.is_around = true;
      why = "smooth ground and the same air in all directions";
    }
  }
  plan.choices.push_back({"azimuths", fmt::format("{}: {}", plan.azimuths, why)});
}

void planCells(const RadialInputs& radials, PeCells kept, PePlan& plan) {
  RadialCells& cells = plan.cells;
  cells.above_ground = radials.above_ground;
  cells.are_points = kept == PeCells::point;
  const double spacing_m = std::max(radials.spacing_m, radials.farthest_m / kMaxRanges);
  const double steps = std::round(spacing_m / plan.grid.range_step_m);
  cells.overlap = steps >= 2 && !cells.are_points;
  cells.range_step_m = plan.grid.range_step_m * std::max(1.0, std::floor(steps / 2));
  cells.ranges = int(std::ceil(radials.farthest_m / cells.range_step_m)) + 1;
  // Below this height rays pass the lowest ground below the absorber, too.
  const double top_m = kUsablePart * plan.grid.usableTop_m();
  plan.top_msl_m = radials.lowest_ground_msl_m + top_m;
  double highest_m = std::min(radials.highest_m, plan.top_msl_m), last_m = plan.top_msl_m;
  if (radials.above_ground) {
    const bool are_extended = radials.highest_m + radials.highest_ground_msl_m > plan.top_msl_m;
    highest_m = are_extended ? top_m : radials.highest_m;  // rays cross the top above any ground
    last_m = top_m;
  }
  const double bottom_m = std::min(radials.lowest_m, last_m - radials.height_step_m);
  const double least_m = (highest_m - bottom_m) / (kMaxHeights - 2);
  const bool are_between = !radials.above_ground && !radials.are_level;
  cells.height_step_m = std::max(radials.height_step_m / (are_between ? 5 : 1), least_m);
  cells.mean_height_m = std::max(radials.height_step_m, least_m);
  cells.bottom_msl_m = bottom_m - cells.height_step_m / 2;
  cells.heights = int(std::ceil((highest_m - bottom_m) / cells.height_step_m)) + 2;
  plan.choices.push_back(
      {"cells",
       fmt::format(
           "{:.4g} m in range, {:.4g} m in height, above {}: the voxels' spacing; {} x {}, {:.4g} m and "
           "{:.4g} m apart",
           cells.meanRange_m(), cells.meanHeight_m(), cells.above_ground ? "the ground" : "mean sea level",
           cells.ranges, cells.heights, cells.range_step_m, cells.height_step_m)});
}

/// Number of cells of each azimuth up to the farthest position that is interpolated from it.
void planRanges(const RadialInputs& radials, PePlan& plan) {
  const std::vector<float>& arcs_m = radials.farthest_of_arcs_m;
  if (arcs_m.empty() || plan.azimuths == 1) return;
  plan.ranges.assign(std::size_t(plan.azimuths), 1);
  const double arc_rad = 2 * kPi / double(arcs_m.size());
  for (std::size_t i = 0; i < arcs_m.size(); ++i) {
    if (!(arcs_m[i] > 0)) continue;
    const int needed = std::min(plan.cells.ranges, int(double(arcs_m[i]) / plan.cells.range_step_m) + 2);
    for (const double end_rad : {double(i) * arc_rad, double(i + 1) * arc_rad}) {
      const double from_first = std::fmod(end_rad - plan.first_azimuth_rad + 4 * kPi, 2 * kPi);
      const int before = int(from_first / plan.azimuth_step_rad);
      for (const int near : {before, before + 1}) {
        int& ranges = plan.ranges[std::size_t(plan.is_around ? near % plan.azimuths
                                                             : std::min(near, plan.azimuths - 1))];
        ranges = std::max(ranges, needed);
      }
    }
  }
}

RefractivityAlongPath firstAir(const PathInputs& inputs, const RadialInputs& radials) {
  return highestDuct(pathAirs(inputs.emitter.atmosphere, inputs.site, radials.first_azimuth_rad));
}

/// The ground along some of the azimuths.
void addGroundNeeds(const PathInputs& inputs, const RadialInputs& radials, double curvature_per_m,
                    DomainNeeds& needs) {
  constexpr int kAzimuths = 32;
  const double held_part = needs.is_narrow ? 1 : 0.98;  // of the steps
  if (!radials.has_terrain) return;
  const double step_m = std::max(inputs.post_spacing_m, kFinestStep_m);
  const int count = int(radials.farthest_m / step_m) + 1;
  std::vector<float> ground_msl_m(static_cast<std::size_t>(count));
  GroundNeeds ground;
  for (int i = 0; i < kAzimuths; ++i) {
    checkpoint();
    const double part = radials.isAround() ? double(i) / kAzimuths : (i + 0.5) / kAzimuths;
    radials.ground(radials.first_azimuth_rad + part * radials.azimuth_span_rad, step_m * (count - 1), step_m,
                   count, ground_msl_m.data());
    ground.add(ground_msl_m.data(), count, step_m, inputs.site.height_msl_m, curvature_per_m);
  }
  needs.slope_rad = ground.slope_rad(held_part);
  needs.ridge_rad = ground.ridge_rad;
}

}  // namespace

void GroundNeeds::add(const float* ground_msl_m, int count, double step_m, double eye_msl_m,
                      double curvature_per_m) {
  for (int i = 1; i < count; ++i) {
    if (std::isnan(ground_msl_m[i])) break;
    const double range_m = i * step_m, height_msl_m = double(ground_msl_m[i]);
    const double rise_m = height_msl_m - double(ground_msl_m[i - 1]);
    slopes_rad.push_back(static_cast<float>(std::atan(std::fabs(rise_m) / step_m)));
    if (range_m < double(PeSight::kNearGround_m)) continue;
    ridge_rad = std::max(ridge_rad, (height_msl_m - eye_msl_m) / range_m - curvature_per_m * range_m / 2);
  }
}

double GroundNeeds::slope_rad(double fraction) {
  if (slopes_rad.empty()) return 0;
  const auto at = slopes_rad.begin() + std::ptrdiff_t(fraction * double(slopes_rad.size() - 1));
  std::nth_element(slopes_rad.begin(), at, slopes_rad.end());
  return std::min(double(*at), kPeSlope.max* kPeSlope.si_per_unit);
}

double trappingTop_m(const RefractivityAlongPath& air) {
  double top_m = 0;
  const std::vector<RefractivityLevel> levels = air.at(0).levels;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    if (levels[i].m_units < levels[i - 1].m_units) top_m = levels[i].height_msl_m;
  }
  return top_m;
}

RefractivityAlongPath highestDuct(const std::vector<RefractivityAlongPath>& airs) {
  return *std::max_element(airs.begin(), airs.end(),
                           [](const auto& a, const auto& b) { return trappingTop_m(a) < trappingTop_m(b); });
}

AutomaticGrid planGrid(const EmitterInputs& emitter, const RefractivityAlongPath& air,
                       const DomainNeeds& needs, double& max_angle_rad) {
  const ParabolicEquationSettings& settings = emitter.settings.parabolic_equation;
  requireWithinLimit(kPeFrequency, emitter.frequency_hz);
  std::string angle_why;
  double height_m = std::max(needs.required_m, 1.5 * trappingTop_m(air));
  if (needs.is_single) height_m = std::max(height_m, needs.wanted_m);
  if (settings.top_m > 0) height_m = needs.is_single ? std::max(settings.top_m, height_m) : settings.top_m;
  max_angle_rad = planAngle_rad(emitter, needs, height_m, angle_why);
  if (!needs.is_single && settings.top_m <= 0) {
    const bool is_steep = needs.is_narrow && max_angle_rad > kAngle_rad;  // slopes reflect to any height
    const int intervals = is_steep                   ? kPeMaxIntervals
                          : needs.post_spacing_m > 0 ? kTerrainIntervals
                                                     : kPlainIntervals;
    const double affordable = affordable_m(emitter, max_angle_rad, intervals) * (1 - 1e-9);
    height_m = std::max(height_m, std::min(needs.wanted_m, affordable));
  }
  if (height_m < needs.required_m) {
    throw Error(
        ErrorCode::bad_input,
        fmt::format("'top_m' is {:.4g} m; the antenna and the ground along the azimuths need at least "
                    "{:.4g} m above the lowest ground",
                    settings.top_m, needs.required_m));
  }
  MarchNeeds march;
  march.frequency_hz = emitter.frequency_hz;
  march.max_height_m = height_m;
  march.max_angle_rad = max_angle_rad;
  march.post_spacing_m = needs.post_spacing_m;
  march.traps = air.traps();
  if (trappingTop_m(air) > 0) march.trapping_top_m = trappingTop_m(air);
  AutomaticGrid found = automaticGrid(march);
  if (settings.max_angle_deg <= 0 && !needs.is_single && needs.post_spacing_m > 0) {
    const double fewer = found.grid.intervals / 2 / found.wanted_intervals;
    const double smaller_rad = std::asin(std::sin(max_angle_rad) * fewer) * (1 - 1e-9);
    if (fewer < 1 && smaller_rad >= std::max(kWorthwhileAngle * max_angle_rad, groundAngle_rad(needs))) {
      march.max_angle_rad = smaller_rad;
      AutomaticGrid cheaper = automaticGrid(march);
      if (cheaper.grid.intervals < found.grid.intervals) {
        found = std::move(cheaper);
        max_angle_rad = smaller_rad;
        angle_why = fmt::format("what {} height steps afford", found.grid.intervals);
      }
    }
  }
  // where most of the slopes fit, all of the band is used for them
  constexpr double kFittingPart = 0.55;
  const double slope_part = std::sin(needs.slope_rad) / found.grid.maxSine();
  if (needs.post_spacing_m > 0 && slope_part <= kFittingPart)
    found.grid.slope_part = std::clamp(slope_part * (1 + 1e-6), kPeSlopePart, kPeMaxSlopePart);
  found.choices.insert(
      found.choices.begin(),
      {"largest angle", fmt::format("{:.3g} degrees: {}", radToDeg(max_angle_rad), angle_why)});
  if (settings.range_step_m > 0) {
    const double largest_m = std::max(absorberStep_m(found.grid), found.grid.range_step_m);
    if (settings.range_step_m > largest_m) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("'range_step_m' is {:.4g} m; the absorber allows at most {:.4g} m",
                              settings.range_step_m, largest_m));
    }
    found.grid.range_step_m = settings.range_step_m;
    found.choices.back().text = fmt::format("{:.4g} m: given", settings.range_step_m);
  } else if (needs.spacing_m > 0) {
    double& step_m = found.grid.range_step_m;
    std::string& text = found.choices.back().text;
    const bool has_posts = needs.post_spacing_m > 0;
    const double positions_m = std::max(has_posts ? needs.spacing_m : needs.spacing_m / 2, kFinestStep_m);
    if (positions_m < step_m) {
      step_m = positions_m;
      text = fmt::format("{:.4g} m: {} the voxels' spacing, at least {:g} m", step_m,
                         has_posts ? "as" : "half of", kFinestStep_m);
    } else if (!has_posts) {
      text += fmt::format(" (at most {:.4g} m), a whole number in half of the voxels' spacing", step_m);
      step_m = positions_m / std::ceil(positions_m / step_m * (1 - 1e-12));
      text = fmt::format("{:.4g} m", step_m) + text.substr(text.find(':'));
    }
  }
  requireWithinLimit(kPeDistance, needs.farthest_m);
  requireWithinLimit(kPeSteps, std::ceil(needs.farthest_m / found.grid.range_step_m));
  return found;
}

std::vector<PeSurface> planSurfaces(const EmitterInputs& emitter, const RefractivityAlongPath& air) {
  const RefractivityProfile profile = air.at(0);
  PeSurface surface;
  surface.ground = groundConstants(emitter.ground, emitter.frequency_hz);
  surface.roughness_m = emitter.ground.roughness_m;
  surface.roughness_model = emitter.settings.parabolic_equation.roughness;
  double deficit_m_units = 0;
  const double surface_m_units = profile.at(0);
  for (const RefractivityLevel& level : profile.levels)
    deficit_m_units = std::max(deficit_m_units, surface_m_units - level.m_units);
  if (deficit_m_units > 0) surface.grazing_rad = std::sqrt(2e-6 * deficit_m_units);
  std::vector<PeSurface> surfaces;
  if (emitter.polarization != Polarization::vertical) {
    surface.polarization = LinearPolarization::horizontal;
    surface.perfect = surface.roughness_m == 0;
    surfaces.push_back(surface);
  }
  if (emitter.polarization != Polarization::horizontal) {
    surface.polarization = LinearPolarization::vertical;
    surface.perfect = false;
    surfaces.push_back(surface);
  }
  return surfaces;
}

DomainNeeds domainNeeds(const PathInputs& inputs, const RadialInputs& radials) {
  constexpr double kClear = 1.1, kMargin_m = 30;  // between the antenna or a summit and the top of the cells
  const double source_msl_m = inputs.site.height_msl_m, lowest_m = radials.lowest_ground_msl_m;
  const double highest_m = std::max(radials.highest_ground_msl_m, source_msl_m);
  DomainNeeds needs;
  needs.required_m = kClear * (highest_m - lowest_m) + kMargin_m;
  needs.wanted_m = radials.highest_m + 2 * radials.height_step_m - lowest_m +
                   (radials.above_ground ? radials.highest_ground_msl_m : 0);
  needs.post_spacing_m = radials.has_terrain ? inputs.post_spacing_m : 0;
  needs.farthest_m = radials.farthest_m;
  needs.spacing_m = radials.spacing_m;
  // Positions of a map are points: close to the ground the field follows the terrain's posts, not the pixels.
  if (radials.above_ground && radials.has_terrain)
    needs.spacing_m = std::min(needs.spacing_m, 3 * inputs.post_spacing_m);
  needs.is_narrow = radials.azimuth_span_rad <= kNarrowSector_rad && radials.spacing_m > 0;
  addGroundNeeds(inputs, radials, 1e-6 * firstAir(inputs, radials).at(0).top_gradient_m, needs);
  return needs;
}

namespace {

/// Grid, surfaces and cells.
PePlan planDomain(const PathInputs& inputs, const RadialInputs& radials, const DomainNeeds& needs) {
  const double source_msl_m = inputs.site.height_msl_m;
  PePlan plan;
  const RefractivityAlongPath air = firstAir(inputs, radials);
  AutomaticGrid automatic = planGrid(inputs.emitter, air, needs, plan.max_angle_rad);
  plan.grid = automatic.grid;
  plan.choices = std::move(automatic.choices);
  plan.surfaces = planSurfaces(inputs.emitter, air);
  const PeSource source{source_msl_m - radials.site_ground_msl_m, inputs.elevation_pattern};
  for (const PeSurface& surface : plan.surfaces) checkSource(plan.grid, source, surface);
  if (inputs.emitter.settings.parabolic_equation.source == PeRadiator::pattern)
    plan.choices.push_back({"source", sourceText(inputs.elevation_pattern, plan.max_angle_rad)});
  planCells(radials, inputs.emitter.settings.parabolic_equation.cells, plan);
  return plan;
}

struct Cost {
  double points = 0;  ///< azimuths x steps x heights
  double cells = 0;   ///< that are kept
};

/// @param members  of the air's ensemble
/// @throws Error (bad_input) outside the limits
Cost affordableCost(const PePlan& plan, double members) {
  const double lanes = kStepLanes * std::ceil(double(plan.azimuths) / kStepLanes);
  const double marched = plan.ranges.empty() ? lanes * plan.cells.ranges
                                             : std::accumulate(plan.ranges.begin(), plan.ranges.end(), 0.0);
  const double points = members * double(plan.surfaces.size()) * marched *
                        std::ceil(plan.cells.range_step_m / plan.grid.range_step_m) * plan.grid.intervals;
  requireWithinLimit(kPeWork, points);
  const double cells = members * plan.azimuths * plan.cells.ranges * plan.cells.heights;
  requireWithinLimit(kPeCells, cells);
  return {points, cells};
}

RadialInputs spacedBy(const DomainNeeds& needs, RadialInputs radials) {
  radials.spacing_m = needs.spacing_m;
  return radials;
}

}  // namespace

PePlan planWithoutAir(const PathInputs& inputs, const RadialInputs& given, const DomainNeeds& needs,
                      int members) {
  const RadialInputs radials = spacedBy(needs, given);
  PePlan plan = planDomain(inputs, radials, needs);
  planAzimuths(inputs, radials, plan);
  planRanges(radials, plan);
  affordableCost(plan, members);
  return plan;
}

PePlan planMarch(const PathInputs& inputs, const RadialInputs& given, const DomainNeeds& needs) {
  const RadialInputs radials = spacedBy(needs, given);
  PePlan plan = planDomain(inputs, radials, needs);
  planAir(inputs, radials, planAzimuths(inputs, radials, plan), plan);
  planRanges(radials, plan);
  plan.min_range_m = std::max({2 * plan.grid.range_step_m, 20 * wavelength_m(inputs.emitter.frequency_hz),
                               2 * plan.cells.meanRange_m()});
  const double half_wavelength_m = wavelength_m(inputs.emitter.frequency_hz) / 2;
  const auto blurred_deg = [&](double range_m) {
    return radToDeg(bandEdgeWidth_rad(half_wavelength_m, range_m));
  };
  plan.choices.push_back(
      {"extent", fmt::format("from {:.4g} m, to {:.4g} m above mean sea level, up to the largest angle less "
                             "{:.2g} degrees at 1 km, "
                             "{:.2g} at 10 km (the band's edge diffracts): elsewhere other models apply",
                             plan.min_range_m, plan.top_msl_m, blurred_deg(1e3), blurred_deg(1e4))});
  const auto [points, cells] = affordableCost(plan, double(plan.air.size()));
  const double time_s = points * secondsPerPoint(radials.has_terrain);
  plan.choices.push_back(
      {"cost",
       fmt::format("{:.3g} million steps of a height, about {:.2g} s on one core{}; {:.0f} MiB of cells",
                   points / 1e6, time_s,
                   plan.grid.intervals > kMaxBlockIntervals
                       ? fmt::format(", which marches also beside a GPU: more than {} height steps",
                                     kMaxBlockIntervals)
                       : "",
                   cells * sizeof(float) / (1 << 20)),
       time_s});
  return plan;
}

}  // namespace emscape::propagation
