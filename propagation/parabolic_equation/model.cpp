#include "propagation/parabolic_equation/model.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "emscape/base/error.h"
#include "emscape/base/parallel.h"
#include "emscape/base/work.h"
#include "propagation/diffraction/model.h"
#include "propagation/parabolic_equation/air/ducts.h"
#include "propagation/parabolic_equation/air/path_air.h"
#include "propagation/parabolic_equation/air/refractivity_field.h"
#include "propagation/parabolic_equation/march/march_step.h"
#include "propagation/parabolic_equation/plan.h"
#include "propagation/two_ray/model.h"

namespace emscape::propagation {
namespace {

constexpr auto kPe = &ModelSettings::parabolic_equation;

/// @param median  of the same inputs
P1812Model<float> scatterModel(const PathInputs& inputs, const DiffractionModel<float>& median) {
  P1812Model<float> scatter;
  scatter.clear_air.frequency_ghz = static_cast<float>(inputs.emitter.frequency_hz / 1e9);
  scatter.clear_air.time_percent = 50;
  scatter.clear_air.median = median;
  scatter.sea_level_refractivity = static_cast<float>(inputs.emitter.atmosphere.sea_level_refractivity);
  return scatter;
}

PeOthers othersOf(const PathInputs& inputs, const RefractivityAlongPath& air, bool has_terrain,
                  double site_ground_msl_m, double max_angle_rad) {
  const ParabolicEquationSettings& settings = inputs.emitter.settings.parabolic_equation;
  PeOthers others;
  others.tx_msl_m = static_cast<float>(inputs.site.height_msl_m);
  others.tx_agl_m = static_cast<float>(inputs.site.height_msl_m - site_ground_msl_m);
  others.curvature_per_m = static_cast<float>(1e-6 * air.at(0).top_gradient_m);
  others.max_angle_rad = static_cast<float>(max_angle_rad);
  others.half_wavelength_m = static_cast<float>(wavelength_m(inputs.emitter.frequency_hz) / 2);
  others.direct_ray = directRayPattern(inputs.elevation_pattern, max_angle_rad);
  others.largest_db = static_cast<float>(-settings.floor_db);
  others.over_terrain = has_terrain;
  others.diffraction = diffractionExcess(inputs);
  PathInputs smooth = inputs;
  smooth.surface_msl_m = 0;
  smooth.emitter.settings.two_ray.roughness_model = settings.roughness;
  others.two_ray = twoRayExcess(smooth);
  others.scatter = scatterModel(inputs, others.diffraction.model);
  return others;
}

/// True if the air has an evaporation duct somewhere.
bool hasEvaporationDuct(const RefractivityAlongPath& air) {
  return std::any_of(air.profiles().begin(), air.profiles().end(), [](const RefractivityProfile& profile) {
    return evaporationDuctTop_msl_m(profile).has_value();
  });
}

/// Warnings about the air.
/// @param over_land      some of the ground is land
/// @param highest_msl_m  of antenna and field
unsigned airWarnings(const RefractivityAlongPath& air, bool over_land, double highest_msl_m) {
  unsigned warnings = over_land && hasEvaporationDuct(air) ? kPeDuctOverLand : 0u;
  if (air.pointwise()) warnings |= kPePointwiseAir;
  if (std::any_of(air.profiles().begin(), air.profiles().end(),
                  [&](const RefractivityProfile& profile) { return profile.known_to_m < highest_msl_m; }))
    warnings |= kPeProfileEnds;
  return warnings;
}

/// True if a surface without terrain is land.
bool isLand(const Ground& ground) {
  return ground.kind != GroundKind::sea && ground.kind != GroundKind::fresh_water;
}

/// Reads the ground along all azimuths. Beyond the first hole, and beyond an azimuth's end, it is level;
/// cells beyond a hole are unknown.
void readGround(const RadialInputs& radials, const PePlan& plan, FieldMarch& field) {
  if (!radials.has_terrain) return;
  AzimuthMarch& march = field.march;
  march.ground_steps = std::size_t(radials.farthest_m / plan.grid.range_step_m) + 2;
  march.ground_msl_m.resize(march.ground_steps * std::size_t(plan.azimuths));
  if (field.known_ranges.empty()) field.known_ranges.assign(std::size_t(plan.azimuths), plan.cells.ranges);
  const double step_m = plan.grid.range_step_m, length_m = step_m * double(march.ground_steps - 1);
  parallelFor(plan.azimuths, 8, [&](int begin, int end) {
    for (int a = begin; a < end; ++a) {
      float* const first = march.ground_msl_m.data() + std::size_t(a) * march.ground_steps;
      float* const last = first + march.ground_steps;
      const double end_m = march.rangesOfGroup(a) * plan.cells.range_step_m;
      const auto read = std::min(march.ground_steps, std::size_t(end_m / step_m) + 2);
      radials.ground(plan.azimuth_rad(a), length_m, step_m, int(read), first);
      std::fill(first + read, last, first[read - 1]);
      first[0] = static_cast<float>(radials.site_ground_msl_m);
      float* const hole = std::find_if(first, last, [](float height_m) { return std::isnan(height_m); });
      if (hole == last) continue;
      const double known_m = double(hole - first) * step_m;
      int& known = field.known_ranges[std::size_t(a)];
      known = std::min(known, int(known_m / plan.cells.range_step_m));
      std::fill(hole, last, hole[-1]);
    }
  });
}

/// The first range step whose ground the antenna sees above the equation's largest angle; `steps`: none.
int firstSteepStep(const PeOthers& others, double max_angle_rad, const float* ground_msl_m, int steps,
                   double step_m) {
  constexpr float kMargin = 1.05f;  // a column between two azimuths may see a little past both
  for (int i = 1; i < steps; ++i) {
    const auto range_m = static_cast<float>(i * step_m);
    if (range_m >= PeSight::kNearGround_m &&
        others.launchAngle(range_m, ground_msl_m[i]) >= kMargin * static_cast<float>(max_angle_rad))
      return i;
  }
  return steps;
}

/// Ends the marches beyond ground that the antenna sees above the equation's largest angle: the field passes
/// it at larger angles, for which other models are used (PeOthers::equationPart()).
void endBehindSteepGround(const PeOthers& others, const PePlan& plan, FieldMarch& field) {
  AzimuthMarch& march = field.march;
  const auto azimuths = std::size_t(plan.azimuths);
  std::vector<int> reached(azimuths, plan.cells.ranges);
  for (std::size_t a = 0; a < azimuths; ++a) {
    checkpoint();
    const double step_m = plan.grid.range_step_m;
    const int first =
        firstSteepStep(others, plan.max_angle_rad, march.ground_msl_m.data() + a * march.ground_steps,
                       int(march.ground_steps), step_m);
    if (first < int(march.ground_steps))
      reached[a] = int(double(static_cast<float>(first * step_m)) / plan.cells.range_step_m) + 2;
  }
  if (march.ranges.empty()) march.ranges.assign(azimuths, plan.cells.ranges);
  for (std::size_t a = 0; a < azimuths; ++a) {
    const std::size_t before = a > 0 ? a - 1 : plan.is_around ? azimuths - 1 : a;
    const std::size_t behind = a + 1 < azimuths ? a + 1 : plan.is_around ? 0 : a;
    march.ranges[a] = std::min(march.ranges[a], std::max({reached[before], reached[a], reached[behind]}));
    field.known_ranges[a] = std::min(field.known_ranges[a], march.ranges[a]);
  }
}

/// @param others  of the antenna
/// @param steps   of the ground, without the antenna's
SteepAzimuth steepAzimuth(const PeOthers& others, double max_angle_rad, const MarchGrid& grid,
                          double azimuth_rad, const float* ground_msl_m, int steps) {
  const int marched = firstSteepStep(others, max_angle_rad, ground_msl_m, steps, grid.range_step_m);
  const double part =
      staircasePart(ground_msl_m, marched, grid.range_step_m, grid.maxSine(), grid.slope_part);
  return {azimuth_rad, steps * grid.range_step_m, part * marched * grid.range_step_m,
          (steps - marched) * grid.range_step_m};
}

/// The inputs of SteepGround::with() for a field.
struct SteepMarches {
  PathInputs inputs;
  RadialInputs radials;
  DomainNeeds needs;
  PeOthers others;
  int members = 1;  ///< of the air's ensemble
  std::vector<double> azimuths_rad, lengths_m;

  std::vector<SteepAzimuth> with(double max_angle_deg) const {
    PathInputs other = inputs;
    other.emitter.settings.parabolic_equation.max_angle_deg = max_angle_deg;
    std::vector<SteepAzimuth> found;
    try {
      const PePlan plan = planWithoutAir(other, radials, needs, members);
      const double step_m = plan.grid.range_step_m;
      for (std::size_t a = 0; a < azimuths_rad.size(); ++a) {
        const int steps = int(lengths_m[a] / step_m);
        std::vector<float> ground_msl_m(std::size_t(steps) + 1);
        radials.ground(azimuths_rad[a], radials.farthest_m, step_m, steps + 1, ground_msl_m.data());
        ground_msl_m[0] = static_cast<float>(radials.site_ground_msl_m);
        found.push_back(
            steepAzimuth(others, plan.max_angle_rad, plan.grid, azimuths_rad[a], ground_msl_m.data(), steps));
      }
    } catch (const Error& error) {
      if (error.code() != ErrorCode::bad_input) throw;
      found.clear();
    }
    return found;
  }
};

/// @param field  whose marches do not yet end behind steep ground
SteepGround steepGround(const PathInputs& inputs, const RadialInputs& radials, const DomainNeeds& needs,
                        const PeOthers& others, const PePlan& plan, const FieldMarch& field) {
  constexpr int kMaxAzimuths = 64;
  const AzimuthMarch& march = field.march;
  const auto tried = std::make_shared<SteepMarches>(
      SteepMarches{inputs, radials, needs, others, int(plan.air.size()), {}, {}});
  SteepGround steep;
  steep.max_angle_deg = radToDeg(plan.max_angle_rad);
  steep.is_automatic = inputs.emitter.settings.parabolic_equation.max_angle_deg <= 0;
  const int apart = (plan.azimuths + kMaxAzimuths - 1) / kMaxAzimuths;
  for (int a = 0; a < plan.azimuths; a += apart) {
    const double length_m = march.rangesOf(a) * plan.cells.range_step_m;
    const int steps = std::min(int(length_m / plan.grid.range_step_m), int(march.ground_steps) - 1);
    steep.azimuths.push_back(steepAzimuth(others, plan.max_angle_rad, plan.grid, plan.azimuth_rad(a),
                                          march.ground_msl_m.data() + std::size_t(a) * march.ground_steps,
                                          steps));
    tried->azimuths_rad.push_back(plan.azimuth_rad(a));
    tried->lengths_m.push_back(steep.azimuths.back().whole_m);
  }
  steep.with = [tried](double max_angle_deg) { return tried->with(max_angle_deg); };
  return steep;
}

/// Ground that is above mean sea level only where it is land by its cover.
void separateSea(std::vector<float>& ground_msl_m, const float* cover_m) {
  constexpr float kLowLand_m = 0.01f;
  for (std::size_t i = 0; i < ground_msl_m.size(); ++i) {
    float& height_m = ground_msl_m[i];
    if (cover_m[i] < 0) height_m = std::min(height_m, 0.0f);
    if (cover_m[i] >= 0) height_m = std::max(height_m, kLowLand_m);
  }
}

/// The air of each azimuth over its ground, or one for all.
std::vector<RefractivityAlongPath> airOverGround(const std::vector<RefractivityAlongPath>& air,
                                                 const RadialInputs& radials, const PePlan& plan,
                                                 const AzimuthMarch& march, const Ground& ground) {
  std::vector<RefractivityAlongPath> over_ground;
  if (march.ground_msl_m.empty()) {
    for (const RefractivityAlongPath& of_azimuth : air)
      over_ground.push_back(isLand(ground) ? withoutDuctOverLand(of_azimuth) : of_azimuth);
    return over_ground;
  }
  if (std::none_of(air.begin(), air.end(), hasEvaporationDuct)) return air;
  for (std::size_t a = 0; a < std::size_t(march.azimuths); ++a) {
    checkpoint();
    const float* const first = march.ground_msl_m.data() + a * march.ground_steps;
    std::vector<float> ground_msl_m(first, first + march.ground_steps);
    if (radials.cover) {
      std::vector<float> cover_m(ground_msl_m.size());
      const double step_m = march.grid.range_step_m;
      radials.cover(plan.azimuth_rad(int(a)), step_m * double(cover_m.size() - 1), step_m,
                    int(cover_m.size()), first, cover_m.data());
      separateSea(ground_msl_m, cover_m.data());
    }
    over_ground.push_back(withoutDuctOverLand(air[air.size() == 1 ? 0 : a], ground_msl_m.data(),
                                              ground_msl_m.size(), march.grid.range_step_m));
  }
  return over_ground;
}

/// Ground at even steps between the posts of a profile.
std::vector<float> evenGround(const TerrainProfile& profile, double step_m, int steps) {
  std::vector<float> ground_msl_m;
  int post = 0;
  for (int i = 0; i <= steps; ++i) {
    const double at_m = i * step_m;
    while (post + 2 < profile.count && profile.range_m[post + 1] < at_m) ++post;
    const int next = std::min(post + 1, profile.count - 1);
    const double length_m = profile.range_m[next] - profile.range_m[post];
    const double part = length_m > 0 ? std::clamp((at_m - profile.range_m[post]) / length_m, 0.0, 1.0) : 0;
    ground_msl_m.push_back(float(double(profile.height_msl_m[post]) +
                                 part * double(profile.height_msl_m[next] - profile.height_msl_m[post])));
  }
  return ground_msl_m;
}

/// The land cover of the posts next to even steps; empty: unknown.
std::vector<float> evenCover(const TerrainProfile& profile, double step_m, int steps) {
  std::vector<float> cover_m;
  if (profile.cover_m == nullptr) return cover_m;
  int post = 0;
  for (int i = 0; i <= steps; ++i) {
    while (post + 1 < profile.count && profile.range_m[post + 1] + profile.range_m[post] < 2 * i * step_m)
      ++post;
    cover_m.push_back(profile.cover_m[post]);
  }
  return cover_m;
}

/// The other model as a column model.
struct OtherColumn {
  const PeOthers& others;

  unsigned operator()(const ExcessColumn& column, const ExcessScratch& scratch, float* excess_db) const {
    others.fill(column, scratch, excess_db);
    return 0;
  }
};

/// A march along one path.
struct PathMarch {
  double factor_db = 0;
  std::string text;
};

/// Needs of the ground along a path, seen from both ends.
void addGroundNeeds(const PathInputs& inputs, const ExcessColumn& column, double curvature_per_m,
                    DomainNeeds& needs) {
  // closer than the march's, whose steps may lie otherwise
  const int steps = std::max(1, int(4 * column.range_m / std::max(inputs.post_spacing_m, 50.0)));
  const double step_m = column.range_m / steps;
  std::vector<float> ground_msl_m = evenGround(column.profile, step_m, steps);
  GroundNeeds ground;
  ground.add(ground_msl_m.data(), steps + 1, step_m, inputs.site.height_msl_m, curvature_per_m);
  std::reverse(ground_msl_m.begin(), ground_msl_m.end());
  ground.add(ground_msl_m.data(), steps + 1, step_m, double(column.height_msl_m[0]), curvature_per_m);
  needs.slope_rad = ground.slope_rad(1);
  needs.ridge_rad = ground.ridge_rad;
}

/// True if ground rises above the straight ray within two steps of an end.
bool hasNearObstacle(const TerrainProfile& profile, double begin_msl_m, double end_msl_m, double range_m,
                     double step_m) {
  for (int i = 1; i + 1 < profile.count; ++i) {
    const double at_m = double(profile.range_m[i]);
    if (std::min(at_m, range_m - at_m) > 2 * step_m || !(at_m > 0 && at_m < range_m)) continue;
    if (double(profile.height_msl_m[i]) > begin_msl_m + at_m / range_m * (end_msl_m - begin_msl_m))
      return true;
  }
  return false;
}

/// Range steps of equal length along a path.
int fitSteps(double range_m, MarchGrid& grid) {
  const int steps = int(std::ceil(range_m / grid.range_step_m - 1e-9));
  grid.range_step_m = range_m / steps;
  return steps;
}

/// The inputs of SteepGround::with() for a path.
struct SteepPath {
  EmitterInputs emitter;
  RefractivityAlongPath air;
  DomainNeeds needs;
  double range_m = 0, azimuth_rad = 0;
  std::vector<double> ranges_m;
  std::vector<float> heights_msl_m;

  SteepAzimuth over(MarchGrid grid) const {
    const int steps = fitSteps(range_m, grid);
    const std::vector<float> ground_msl_m =
        evenGround({ranges_m.data(), heights_msl_m.data(), int(ranges_m.size())}, grid.range_step_m, steps);
    const double part =
        staircasePart(ground_msl_m.data(), steps, grid.range_step_m, grid.maxSine(), grid.slope_part);
    return {azimuth_rad, range_m, part * range_m, 0};
  }
  std::vector<SteepAzimuth> with(double max_angle_deg) const {
    EmitterInputs other = emitter;
    other.settings.parabolic_equation.max_angle_deg = max_angle_deg;
    try {
      double max_angle_rad = 0;
      return {over(planGrid(other, air, needs, max_angle_rad).grid)};
    } catch (const Error& error) {
      if (error.code() != ErrorCode::bad_input) throw;
      return {};
    }
  }
};

SteepGround steepGround(const PathInputs& inputs, const ExcessColumn& column,
                        const RefractivityAlongPath& air, const DomainNeeds& needs, const MarchGrid& grid,
                        double max_angle_rad) {
  const TerrainProfile& profile = column.profile;
  const auto path =
      std::make_shared<SteepPath>(SteepPath{inputs.emitter,
                                            air,
                                            needs,
                                            column.range_m,
                                            column.azimuth_rad,
                                            {profile.range_m, profile.range_m + profile.count},
                                            {profile.height_msl_m, profile.height_msl_m + profile.count}});
  return {radToDeg(max_angle_rad),
          inputs.emitter.settings.parabolic_equation.max_angle_deg <= 0,
          {path->over(grid)},
          [path](double max_angle_deg) { return path->with(max_angle_deg); }};
}

PathMarch marchPath(const PathInputs& inputs, const ExcessColumn& column, const RefractivityAlongPath& air,
                    MarchGrid grid, bool has_terrain) {
  const int steps = fitSteps(column.range_m, grid);
  const TerrainProfile& profile = column.profile;
  PathMarch found;
  double power = 0;
  const std::vector<PeSurface> surfaces = planSurfaces(inputs.emitter, air);
  int halvings = 0;
  for (const PeSurface& surface : surfaces) {
    RadialPath path;
    path.surface = surface;
    path.source = {inputs.site.height_msl_m - double(profile.height_msl_m[0]), inputs.elevation_pattern};
    path.air = isLand(inputs.emitter.ground) ? withoutDuctOverLand(air) : air;
    if (has_terrain) {
      std::vector<float> ground_msl_m = evenGround(profile, grid.range_step_m, steps);
      path.ground_msl_m.assign(ground_msl_m.begin(), ground_msl_m.end());
      const std::vector<float> cover_m = evenCover(profile, grid.range_step_m, steps);
      if (!cover_m.empty()) separateSea(ground_msl_m, cover_m.data());
      path.air = withoutDuctOverLand(air, ground_msl_m.data(), ground_msl_m.size(), grid.range_step_m);
    }
    RadialMarch<double, 1> march(grid, {std::move(path)});
    for (int i = 0; i < steps; ++i) {
      checkpoint();
      march.advance();
    }
    const double above_m = double(column.height_msl_m[0]) - march.ground_m(0);
    power += std::pow(10.0, march.factorDb(0, std::max(above_m, 0.0)) / 10) / double(surfaces.size());
    halvings = int(std::lround(std::log2(double(grid.intervals) / march.intervals())));
  }
  found.factor_db = 10 * std::log10(power);
  found.text = fmt::format("{} steps of {:.4g} m in range, {} heights of {:.3g} m", steps, grid.range_step_m,
                           grid.intervals, grid.heightStep_m());
  if (halvings > 0) found.text += fmt::format(", halved {} times", halvings);
  return found;
}

}  // namespace

std::vector<Setting> peSettings() {
  std::vector<Setting> settings;
  settings.push_back(automaticSetting<kPe, &ParabolicEquationSettings::max_angle_deg>(
      "max_angle_deg", "deg", kPeAngle.min, kPeAngle.max,
      "largest angle from the horizontal of the equation; above, two_ray or diffraction"));
  settings.push_back(automaticSetting<kPe, &ParabolicEquationSettings::top_m>(
      "top_m", "m", 10, 20000,
      "height above the ground up to which the equation is solved; above, along rays"));
  settings.push_back(automaticSetting<kPe, &ParabolicEquationSettings::range_step_m>(
      "range_step_m", "m", 1, 2000, "step of the march in range"));
  settings.push_back(automaticSetting<kPe, &ParabolicEquationSettings::azimuths>(
      "azimuths", "", 2, 7200, "directions that are marched; the field is interpolated between them"));
  settings.back().is_whole = true;
  settings.push_back(choiceSetting<kPe, &ParabolicEquationSettings::source>(
      "source",
      "what is marched: isotropic serves every beam; pattern, the antenna's elevation cut with its tilt, for "
      "narrow or tilted beams that stay in elevation"));
  settings.push_back(choiceSetting<kPe, &ParabolicEquationSettings::roughness>(
      "roughness", "reduction of the reflection by roughness"));
  settings.push_back(numberSetting<kPe, &ParabolicEquationSettings::floor_db>(
      "floor_db", "dB", -120, -20, "lowest field of the equation over that in free space"));
  settings.push_back(choiceSetting<kPe, &ParabolicEquationSettings::cells>(
      "cells", "mean power over a voxel's height and range, or the field at its middle"));
  return settings;
}

std::vector<std::string> peWarningMessages(unsigned warnings) {
  std::vector<std::string> messages;
  if (warnings & kPePointwiseAir) {
    messages.emplace_back(
        "profiles of the air with different numbers of levels are interpolated at each height: halfway "
        "between two ducts there are two faint ones");
  }
  if (warnings & kPeDuctOverLand) {
    messages.emplace_back(
        "the evaporation duct is left out over land (above mean sea level, or a 'ground' that is not water)");
  }
  if (warnings & kPeProfileEnds) {
    messages.emplace_back(
        "the profile of the air ends below the antenna or the top of the field: above it the air is "
        "standard");
  }
  if (warnings & kPeNearObstacle) {
    messages.emplace_back(
        "ground rises above the ray within two range steps of an end, where the march hardly resolves it: "
        "the "
        "loss may be wrong by 20 dB and more, and differ as much with the ends exchanged; compare with "
        "'diffraction'");
  }
  return messages;
}

InputFaults checkPe(const EmitterInputs& inputs) {
  InputFaults faults;
  checkInput(kPeFrequency, inputs.frequency_hz, InputOrigin::frequency, faults);
  if (faults.empty()) checkInput(kPeTriedFrequency, inputs.frequency_hz, InputOrigin::frequency, faults);
  checkInput(kPeRoughness, inputs.ground.roughness_m, InputOrigin::ground, faults);
  return faults;
}

std::vector<ModelChoice> peChoices(const PathInputs& inputs, const RadialInputs& radials) {
  return planMarch(inputs, radials, domainNeeds(inputs, radials)).choices;
}

PeField peField(const PathInputs& inputs, const RadialInputs& radials) {
  const DomainNeeds needs = domainNeeds(inputs, radials);
  const PePlan plan = planMarch(inputs, radials, needs);
  FieldMarch field;
  AzimuthMarch& march = field.march;
  march.grid = plan.grid;
  march.source = {inputs.site.height_msl_m - radials.site_ground_msl_m, inputs.elevation_pattern};
  march.cells = plan.cells;
  march.azimuths = plan.azimuths;
  march.ranges = field.known_ranges = plan.ranges;
  field.surfaces = plan.surfaces;
  if (inputs.emitter.atmosphere.refractivity)
    field.quantile = inputs.emitter.atmosphere.refractivity->quantile;
  readGround(radials, plan, field);
  for (const std::vector<RefractivityAlongPath>& member : plan.air)
    field.members.push_back(airOverGround(member, radials, plan, march, inputs.emitter.ground));

  const RadialCells& cells = plan.cells;
  PeExcess excess;
  excess.others = othersOf(inputs, plan.air.front().front(), radials.has_terrain, radials.site_ground_msl_m,
                           plan.max_angle_rad);
  std::optional<SteepGround> steep;
  if (radials.has_terrain) {
    steep = steepGround(inputs, radials, needs, excess.others, plan, field);
    endBehindSteepGround(excess.others, plan, field);
  }
  excess.others.min_range_m = static_cast<float>(plan.min_range_m);
  if (!cells.are_points) {
    excess.others.cell_range_m = static_cast<float>(cells.meanRange_m());
    excess.others.cell_height_m = static_cast<float>(cells.meanHeight_m());
    excess.others.march_step_m = static_cast<float>(plan.grid.top_m / plan.grid.intervals);
  }
  excess.azimuths = plan.azimuths;
  excess.ranges = cells.ranges;
  excess.heights = cells.heights;
  excess.is_around = plan.is_around;
  excess.above_ground = cells.above_ground;
  excess.first_azimuth_rad = plan.first_azimuth_rad;
  excess.azimuth_step_rad = plan.azimuth_step_rad;
  excess.first_range_m = static_cast<float>(
      cells.are_points ? cells.range_step_m
                       : cells.range_step_m + (plan.grid.range_step_m - cells.meanRange_m()) / 2);
  excess.range_step_m = static_cast<float>(cells.range_step_m);
  excess.bottom_m = static_cast<float>(cells.bottom_msl_m);
  excess.height_step_m = static_cast<float>(cells.height_step_m);
  excess.top_msl_m = static_cast<float>(plan.top_msl_m);
  const bool over_land = radials.has_terrain
                             ? std::any_of(march.ground_msl_m.begin(), march.ground_msl_m.end(),
                                           [](float ground_msl_m) { return ground_msl_m > 0; })
                             : isLand(inputs.emitter.ground);
  const double field_msl_m = radials.highest_m + (radials.above_ground ? radials.highest_ground_msl_m : 0);
  for (const RefractivityAlongPath& air : plan.air.front())
    excess.warnings |= airWarnings(air, over_land, std::max(field_msl_m, inputs.site.height_msl_m));
  return {excess, std::move(field), std::move(steep)};
}

double troposcatterDb(const PathInputs& inputs, const ExcessColumn& column, double end_msl_m) {
  PeOthers others;
  others.tx_msl_m = static_cast<float>(inputs.site.height_msl_m);
  others.scatter = scatterModel(inputs, diffractionExcess(inputs).model);
  const auto posts = static_cast<std::size_t>(column.profile.count);
  std::vector<float> ranges_m(posts), grounds_m(posts);
  PeLoss loss;
  loss.equation_db = HUGE_VALF;
  others.addScatter(static_cast<float>(column.range_m),
                    others.sightOf(column, {ranges_m.data(), grounds_m.data()}),
                    static_cast<float>(end_msl_m), loss);
  return static_cast<double>(loss.scatter_db);
}

Explanation explainPe(const PathInputs& inputs, PathColumn& path) {
  const ExcessColumn& column = path.column();
  const TerrainProfile& profile = column.profile;
  const float end_msl_m = column.height_msl_m[0];
  const std::vector<RefractivityAlongPath> airs =
      pathAirs(inputs.emitter.atmosphere, inputs.site, column.azimuth_rad);
  const RefractivityAlongPath air = highestDuct(airs);
  const auto [lowest, highest] =
      std::minmax_element(profile.height_msl_m, profile.height_msl_m + profile.count);
  const bool has_terrain = *lowest != 0 || *highest != 0;
  DomainNeeds needs;
  needs.required_m = 1.1 * (std::max(inputs.site.height_msl_m, double(*highest)) - double(*lowest)) + 30;
  needs.wanted_m = 1.1 * double(end_msl_m - *lowest) + 30;
  needs.post_spacing_m = has_terrain ? inputs.post_spacing_m : 0;
  needs.farthest_m = column.range_m;
  needs.is_single = true;
  if (has_terrain) addGroundNeeds(inputs, column, 1e-6 * air.at(0).top_gradient_m, needs);
  double max_angle_rad = 0;
  const AutomaticGrid automatic = planGrid(inputs.emitter, air, needs, max_angle_rad);

  PeOthers others = othersOf(inputs, air, has_terrain, double(profile.height_msl_m[0]), max_angle_rad);
  others.min_range_m = static_cast<float>(
      std::max(2 * automatic.grid.range_step_m, 20 * wavelength_m(inputs.emitter.frequency_hz)));
  const char* const other_name = has_terrain ? "diffraction" : "two_ray";
  PeLoss loss;
  const auto posts = static_cast<std::size_t>(profile.count);
  std::vector<float> ranges_m(posts), grounds_m(posts);
  const PeSight sight = others.sightOf(column, {ranges_m.data(), grounds_m.data()});
  const float ridge_rad = others.ridgeAngle(static_cast<float>(column.range_m), sight, end_msl_m);
  loss.equation_part = others.equationPart(static_cast<float>(column.range_m), end_msl_m,
                                           profile.height_msl_m[profile.count - 1], ridge_rad);
  if (loss.equation_part < 1) loss.other_db = static_cast<float>(path.excess_db(OtherColumn{others}));
  Explanation explanation;
  std::string march_text = "no march";
  if (loss.equation_part > 0) {
    std::vector<float> losses_db;
    for (const RefractivityAlongPath& member : airs) {
      const PathMarch march = marchPath(inputs, column, member, automatic.grid, has_terrain);
      losses_db.push_back(static_cast<float>(-march.factor_db));
      march_text = march.text;
    }
    if (has_terrain)
      explanation.steep = steepGround(inputs, column, air, needs, automatic.grid, max_angle_rad);
    if (has_terrain && hasNearObstacle(profile, inputs.site.height_msl_m, double(end_msl_m), column.range_m,
                                       automatic.grid.range_step_m))
      path.addWarnings(kPeNearObstacle);
    if (airs.size() > 1) march_text += fmt::format(", {} members of the air", airs.size());
    const auto& refractivity = inputs.emitter.atmosphere.refractivity;
    others.setEquation(ofMembers_db(losses_db, refractivity ? refractivity->quantile : std::nullopt),
                       static_cast<float>(column.range_m), end_msl_m, loss);
  }
  others.addScatter(static_cast<float>(column.range_m), sight, end_msl_m, loss);
  const bool over_land = has_terrain ? *highest > 0 : isLand(inputs.emitter.ground);
  path.addWarnings(airWarnings(air, over_land, std::max(double(end_msl_m), inputs.site.height_msl_m)));
  if (loss.equation_part > 0) {
    const bool is_floor = loss.mechanism(has_terrain) == Mechanism::floor;
    explanation.add(is_floor ? "floor" : "parabolic_equation",
                    is_floor ? "parabolic equation, at its floor (floor_db)" : "parabolic equation",
                    double(loss.equation_part * loss.equation_db));
  }
  if (loss.equation_part < 1)
    explanation.add(std::string("outside_equation_") + other_name,
                    fmt::format("{} outside the equation's limits", other_name),
                    double((1 - loss.equation_part) * loss.other_db));
  if (loss.scatter_db < HUGE_VALF)
    explanation.add("troposcatter", "troposcatter beside it",
                    double(loss.loss_db() - loss.withoutScatter_db()));
  const bool scatters = loss.mechanism(has_terrain) == Mechanism::troposcatter;
  explanation.why = fmt::format(
      "{} applies; launch angle {:.2f} of {:.3g} degrees, {}; maps and volumes have the mean over cells "
      "between "
      "marched azimuths instead",
      scatters                  ? "troposcatter"
      : loss.equation_part >= 1 ? "the parabolic equation"
      : loss.equation_part <= 0 ? other_name
                                : fmt::format("the parabolic equation by {:.0f} %, {} for the rest,",
                                              double(100 * loss.equation_part), other_name),
      radToDeg(
          double(std::max(ridge_rad, others.launchAngle(static_cast<float>(column.range_m), end_msl_m)))),
      radToDeg(double(others.maxAngle(static_cast<float>(column.range_m)))), march_text);
  return explanation;
}

}  // namespace emscape::propagation
