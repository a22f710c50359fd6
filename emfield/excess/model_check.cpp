#include "emfield/excess/model_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "emfield/clutter/clutter_reach.h"
#include "emfield/excess/clutter_text.h"
#include "emfield/excess/elevation_cut.h"
#include "emfield/excess/emitter_excess.h"
#include "emscape/base/error.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "emscape/emfield/solver/steep_ground.h"
#include "propagation/clear_air/climate.h"
#include "propagation/diffraction/diffraction.h"
#include "propagation/itm/itm.h"
#include "propagation/p528/p528.h"
#include "propagation/parabolic_equation/air/path_air.h"
#include "propagation/parabolic_equation/model.h"
#include "propagation/path_column.h"
#include "propagation/registry/model_info.h"
#include "propagation/two_ray/two_ray.h"
#include "scenario/scan/swept_antenna.h"

namespace emscape::emfield {
namespace {

using propagation::InputOrigin;
using propagation::ModelInfo;
using scenario::Emitter;
using scenario::Scenario;

std::string inModel(const Emitter& emitter, const std::string& model, const std::string& message) {
  return fmt::format("emitter '{}': '{}': {}", emitter.name, model, message);
}

/// Whether a radar has clutter of land and none of the sea.
bool hasLandOnly(const Emitter& emitter) {
  return emitter.clutter && emitter.clutter->land_gamma_db && !emitter.clutter->sea_state;
}

const SourceLocation& locationOf(InputOrigin origin, const Scenario& scenario, const Emitter& emitter) {
  switch (origin) {
    case InputOrigin::frequency:
      return emitter.frequency_location;
    case InputOrigin::ground:
      return scenario.ground.location;
    case InputOrigin::settings:
      return emitter.propagation.location;
  }
  return emitter.location;
}

/// Whether a model has fields beyond the horizon without troposcatter.
bool lacksScatter(propagation::PropagationModel model) {
  return model == propagation::PropagationModel::diffraction ||
         model == propagation::PropagationModel::two_ray;
}

/// An emitter at the highest place of its platform.
Station highestStation(const Scenario& scenario, const Emitter& emitter, const scenario::Terrain* terrain) {
  const auto heightOf_m = [&](const scenario::TrackPoint& point) {
    const scenario::SitePosition& site = point.position;
    if (!site.height_agl_m) return site.height_msl_m ? *site.height_msl_m : *site.height_ellipsoid_m;
    const float ground_m =
        terrain != nullptr ? terrain->heightMsl_m(site.latitude_deg, site.longitude_deg) : 0;
    return *site.height_agl_m + (std::isnan(ground_m) ? 0 : static_cast<double>(ground_m));
  };
  const std::vector<scenario::TrackPoint>& track =
      scenario.platforms[static_cast<std::size_t>(emitter.platform)].track;
  const auto highest = std::max_element(track.begin(), track.end(), [&](const auto& a, const auto& b) {
    return heightOf_m(a) < heightOf_m(b);
  });
  const double height_m = heightOf_m(*highest);
  return makeStation({highest->position.latitude_deg, highest->position.longitude_deg, height_m}, height_m,
                     scenario.atmosphere);
}

/// A warning if the table of an interval's pattern is coarse for the beam; see scenario/scan/swept_antenna.h.
std::vector<std::string> coarseIntervals(const Scenario& scenario, const Emitter& emitter) {
  using scenario::IntervalKind;
  using scenario::ScanKind;
  constexpr double kWorthSaying_db = 0.1;
  const scenario::IntervalSpec& interval = scenario.output.interval;
  const ScanKind scan = emitter.scan.kind;
  const bool has_table = interval.kind == IntervalKind::max_hold || interval.kind == IntervalKind::mean;
  const bool is_grid = scan == ScanKind::sector || scan == ScanKind::raster || scan == ScanKind::dwell_list;
  if (!has_table || !is_grid) return {};
  Emitter always_active = emitter;
  always_active.active_s.clear();
  const double low_db = scenario::lowOnAxis_db(
      *emitter.antenna,
      scenario::sweepOf(always_active, 0,
                        scenario::intervalDuration_s(interval, emitter.scan, scenario.clock)));
  if (low_db < kWorthSaying_db) return {};
  return {fmt::format(
      "emitter '{}': the beam is {:g} degrees wide, and its scan has too many directions for a table of an "
      "interval's pattern that is fine around all of them: values of the interval on its axis are up to "
      "{:.1f} "
      "dB low; a shorter interval has fewer directions",
      emitter.name, std::min(emitter.antenna->beamwidth_az_deg, emitter.antenna->beamwidth_el_deg), low_db)};
}

}  // namespace

std::vector<std::string> checkModel(const Scenario& scenario, const Emitter& emitter) {
  const ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
  checkElevationCut(scenario, emitter);
  std::vector<std::string> warnings = coarseIntervals(scenario, emitter);
  for (std::string& warning : clutterWarnings(scenario, emitter)) warnings.push_back(std::move(warning));
  for (std::string& warning : tiltWarnings(scenario, emitter)) warnings.push_back(std::move(warning));
  for (const propagation::InputFault& fault : model.check(emitterInputs(scenario, emitter))) {
    const std::string message = inModel(emitter, model.name, fault.message);
    if (fault.is_refused) {
      throw Error(ErrorCode::bad_input, locationOf(fault.origin, scenario, emitter), message);
    }
    warnings.push_back(message);
  }
  return warnings;
}

std::vector<std::string> checkModels(const Scenario& scenario) {
  std::vector<std::string> warnings;
  for (const Emitter& emitter : scenario.emitters) {
    const std::vector<std::string> of_emitter = checkModel(scenario, emitter);
    warnings.insert(warnings.end(), of_emitter.begin(), of_emitter.end());
  }
  return warnings;
}

std::vector<std::string> pathWarnings(const Emitter& emitter, const propagation::PathInputs& inputs,
                                      unsigned warnings) {
  const ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
  std::vector<std::string> messages = model.warningMessages(warnings);
  for (std::string& warning : model.pathWarnings(inputs)) messages.push_back(std::move(warning));
  for (std::string& message : messages) message = inModel(emitter, model.name, message);
  return messages;
}

std::vector<std::string> steepGroundWarnings(const SteepGrounds& grounds) {
  const std::vector<SteepGrounds::value_type> emitters(grounds.begin(), grounds.end());
  std::vector<std::string> texts(emitters.size());
  parallelFor(static_cast<int>(emitters.size()), 1, [&](int begin, int end) {
    for (int e = begin; e < end; ++e)
      texts[static_cast<std::size_t>(e)] =
          propagation::steepGroundWarning(emitters[static_cast<std::size_t>(e)].second);
  });
  std::vector<std::string> warnings;
  for (std::size_t e = 0; e < emitters.size(); ++e) {
    if (!texts[e].empty()) warnings.push_back(steepGroundText(emitters[e].first, texts[e]));
  }
  return warnings;
}

std::string steepGroundText(const std::string& emitter, const std::string& text) {
  return fmt::format("emitter '{}': 'parabolic_equation': {}", emitter, text);
}

void keepSteepest(SteepGrounds& kept, const std::string& emitter, const propagation::SteepGround& march) {
  std::vector<propagation::SteepGround>& of_emitter = kept[emitter];
  if (of_emitter.empty() || march.lostPart() > of_emitter.front().lostPart()) of_emitter = {march};
}

void keepSteepest(SteepGrounds& kept, const SteepGrounds& more) {
  for (const auto& [emitter, marches] : more) {
    for (const propagation::SteepGround& march : marches) keepSteepest(kept, emitter, march);
  }
}

std::optional<double> lowestHeight_m(propagation::PropagationModel model) {
  using propagation::PropagationModel;
  switch (model) {
    case PropagationModel::diffraction:
      return propagation::kDiffractionAboveGround.min;
    case PropagationModel::itm:
      return propagation::kItmHeight.min;
    case PropagationModel::p1812:
    case PropagationModel::p452:
      return propagation::kClearAirHeight.min;
    case PropagationModel::two_ray:
      return propagation::kTwoRayHeight.min;
    case PropagationModel::p528:
      return propagation::kP528Height.min;
    default:
      return std::nullopt;
  }
}

std::vector<std::string> lowEndWarnings(const Emitter& emitter, double emitter_agl_m, double point_agl_m) {
  constexpr double kRounding_m = 1e-3;
  const std::optional<double> lowest_m = lowestHeight_m(emitter.propagation.model);
  std::vector<std::string> warnings;
  const auto check = [&](const char* end, double height_agl_m) {
    // What is below a model's surface is warned of as such.
    if (!lowest_m || height_agl_m < 0 || !(height_agl_m < *lowest_m - kRounding_m)) return;
    warnings.push_back(fmt::format(
        "emitter '{}': {} is {:.2g} m above the ground; '{}' takes it as {:g} m high, and its loss is too "
        "low, "
        "by up to 20 lg of the ratio of the heights where waves graze the ground",
        emitter.name, end, height_agl_m, toString(emitter.propagation.model), *lowest_m));
  };
  check("its antenna", emitter_agl_m);
  check("the point", point_agl_m);
  return warnings;
}

std::vector<std::string> smoothSurfaceWarnings(const Scenario& scenario, const Emitter& emitter,
                                               const scenario::Terrain& terrain) {
  constexpr double kClearly_m = 20;
  const ModelInfo& model = propagation::modelInfo(emitter.propagation.model);
  if (!model.on_smooth_surface || scenario.ground.surface_msl_m) return {};
  const scenario::SitePosition& site =
      scenario.platforms[static_cast<std::size_t>(emitter.platform)].track.front().position;
  const double surface_m = terrain.heightMsl_m(site.latitude_deg, site.longitude_deg),
               lowest_m = terrain.lowest_m();
  if (!(surface_m - lowest_m > kClearly_m)) return {};
  return {fmt::format(
      "emitter '{0}': the smooth surface of '{1}' is the ground below the emitter, {2:.0f} m above mean sea "
      "level; the lowest ground is at {3:.0f} m: points below the surface, as of a sea below a hill, have no "
      "field of their own; 'ground: {{surface_msl_m: {3:.0f}}}' sets the surface",
      emitter.name, model.name, surface_m, lowest_m)};
}

std::vector<std::string> scatterWarnings(const Emitter& emitter, const propagation::PathInputs& inputs,
                                         const propagation::ExcessColumn& column, double end_msl_m,
                                         double loss_db) {
  if (!lacksScatter(emitter.propagation.model)) return {};
  const double scatter_db = propagation::troposcatterDb(inputs, column, end_msl_m);
  if (!(loss_db > scatter_db)) return {};
  return {inModel(
      emitter, toString(emitter.propagation.model),
      fmt::format(
          "the loss over free space to a point {:.0f} km away and {:.0f} m above mean sea level is "
          "{:.0f} dB; by troposcatter, which the model lacks, it would be {:.0f} dB (P.1812-8 eq. 44): "
          "beyond the horizon the field is too weak; itm, p1812, p452, p528 and parabolic_equation "
          "have it",
          column.range_m / 1000, end_msl_m, loss_db, scatter_db))};
}

std::vector<std::string> farthestScatterWarnings(const Scenario& scenario, const Emitter& emitter,
                                                 const scenario::Terrain* terrain,
                                                 const GridColumns& columns) {
  constexpr int kPosts = 64;
  if (!lacksScatter(emitter.propagation.model)) return {};
  const Station station = highestStation(scenario, emitter, terrain);
  // Elsewhere on its track the emitter may have no ground below it, on which a smooth surface stands.
  if (terrain != nullptr && propagation::modelInfo(emitter.propagation.model).on_smooth_surface &&
      !scenario.ground.surface_msl_m &&
      std::isnan(terrain->heightMsl_m(station.latitude_deg, station.longitude_deg)))
    return {};
  const propagation::PathInputs inputs =
      pathInputs(scenario, emitter, {}, station, terrain, pathExtent(station, columns));
  const double farthest_m = inputs.extent.farthest_m,
               end_msl_m = std::max(inputs.extent.lowest_msl_m, inputs.surface_msl_m + 1);
  std::vector<double> ranges_m(kPosts + 1);
  for (int i = 0; i <= kPosts; ++i) ranges_m[static_cast<std::size_t>(i)] = farthest_m * i / kPosts;
  const std::vector<float> smooth_msl_m(ranges_m.size(), static_cast<float>(inputs.surface_msl_m));
  propagation::PathColumn path({ranges_m.data(), smooth_msl_m.data(), kPosts + 1}, farthest_m, end_msl_m);
  const double loss_db = propagation::modelInfo(emitter.propagation.model).explain(inputs, path).loss_db;
  return scatterWarnings(emitter, inputs, path.column(), end_msl_m, loss_db);
}

static bool hasSurfaceClutter(const Emitter& radar) {
  return radar.clutter && radar.clutter->hasSurface();
}

std::vector<std::string> ductedClutterWarnings(const Scenario& scenario, const Emitter& radar,
                                               const Station& station) {
  using propagation::PropagationModel;
  constexpr double kMedian_percent = 50;
  if (!hasSurfaceClutter(radar)) return {};
  const propagation::ModelSettings& settings = radar.propagation;
  const PropagationModel model = settings.model;
  const bool is_p1812 = model == PropagationModel::p1812;
  const double time_percent = is_p1812                          ? settings.p1812.time_percent
                              : model == PropagationModel::p452 ? settings.p452.time_percent
                                                                : kMedian_percent;
  const bool has_ducts = model == PropagationModel::parabolic_equation &&
                         propagation::pathAir(scenario.atmosphere, station, 0).traps();
  if (!has_ducts && !(time_percent < kMedian_percent)) return {};
  return {inModel(
      radar, toString(model),
      fmt::format(
          "{}, which carry the echo of a target but not that of the surface: the clutter of land and sea is "
          "that of standard air, and ends at its horizon; beyond, detection is too good",
          has_ducts ? "the air has ducts"
                    : fmt::format("losses of {:g} % of the time are those of ducts", time_percent)))};
}

std::vector<std::string> ductedClutterWarnings(const Scenario& scenario, const Emitter& radar,
                                               const scenario::Terrain* terrain) {
  if (!hasSurfaceClutter(radar)) return {};
  return ductedClutterWarnings(scenario, radar, highestStation(scenario, radar, terrain));
}

std::vector<std::string> laterTripWarnings(const Scenario& scenario, const Emitter& radar,
                                           const Station& station) {
  constexpr double kWorthSaying = 1.05;
  if (!hasSurfaceClutter(radar) || !radar.waveform) return {};
  const double horizon_m =
      std::sqrt(2 * station.effective_earth_radius_m * std::max(station.height_msl_m, 0.0));
  const double repeat_m = radar.waveform->unambiguousRange_m();
  const double from_m = std::max(clutterReach_m(scenario.region, station), repeat_m);
  if (!(horizon_m > kWorthSaying * from_m)) return {};
  return {fmt::format(
      "emitter '{}': surfaces between {:.0f} km and its horizon at {:.0f} km are beyond the region and echo "
      "in the time of later pulses (unambiguous range {:.0f} km): that clutter is left out; a larger region "
      "includes it",
      radar.name, from_m / 1000, horizon_m / 1000, repeat_m / 1000)};
}

std::vector<std::string> laterTripWarnings(const Scenario& scenario, const Emitter& radar,
                                           const scenario::Terrain* terrain) {
  if (!hasSurfaceClutter(radar) || !radar.waveform) return {};
  return laterTripWarnings(scenario, radar, highestStation(scenario, radar, terrain));
}

double partAtSeaLevel(const std::vector<float>& heights_m) {
  constexpr float kSame_m = 0.5f;  // the sea is at or below it: some files have its bottom
  std::size_t count = 0, known = 0;
  for (const float height_m : heights_m) {
    known += std::isnan(height_m) ? 0 : 1;
    count += height_m <= kSame_m ? 1 : 0;
  }
  return known == 0 ? 0 : static_cast<double>(count) / static_cast<double>(known);
}

double partAtSeaLevel(const Scenario& scenario, const scenario::Terrain& terrain) {
  if (std::none_of(scenario.emitters.begin(), scenario.emitters.end(), hasLandOnly)) return 0;
  constexpr int kSide = 64;
  constexpr double kDegree_m = 111.2e3;
  const scenario::Region& region = scenario.region;
  const double north_deg = region.size_m.y / kDegree_m;
  const double east_deg = north_deg * region.size_m.x / region.size_m.y /
                          std::max(0.01, std::cos(degToRad(region.origin.latitude_deg)));
  std::vector<float> heights_m;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      heights_m.push_back(static_cast<float>(
          terrain.heightMsl_m(region.origin.latitude_deg + north_deg * ((j + 0.5) / kSide - 0.5),
                              region.origin.longitude_deg + east_deg * ((i + 0.5) / kSide - 0.5))));
    }
  }
  return partAtSeaLevel(heights_m);
}

std::vector<std::string> seaWarnings(const Scenario& scenario, const Emitter& emitter, double lowest_m,
                                     double at_sea_level) {
  constexpr double kNoise_m = -2;  // heights of a calm sea in elevation files are this close to 0
  constexpr double kWorthSaying = 0.01;
  std::vector<std::string> warnings;
  if (hasLandOnly(emitter) && at_sea_level > kWorthSaying) {
    warnings.push_back(fmt::format(
        "emitter '{}': its clutter takes all ground for land, also the {:.0f} % of it that are at "
        "or below mean sea level; where that is water, 'sea_state' of the clutter says so",
        emitter.name, 100 * at_sea_level));
  }
  if (!(lowest_m < kNoise_m)) return warnings;
  const auto warn = [&](const std::string& who, const std::string& remedy) {
    warnings.push_back(
        fmt::format("emitter '{}': ground lies down to {:.0f} m, and {} takes ground at or below mean sea "
                    "level for sea; where "
                    "it is land, {}",
                    emitter.name, lowest_m, who, remedy));
  };
  using propagation::ClearAirZone;
  using propagation::PropagationModel;
  const propagation::ModelSettings& settings = emitter.propagation;
  const PropagationModel model = emitter.propagation.model;
  if (model == PropagationModel::p1812 && settings.p1812.zone == ClearAirZone::by_height)
    warn("'p1812'", "'p1812: {zone: inland}' (or coastal_land) says so");
  if (model == PropagationModel::p452 && settings.p452.zone == ClearAirZone::by_height)
    warn("'p452'", "'p452: {zone: inland}' (or coastal_land) says so");
  if (model == PropagationModel::diffraction && scenario.ground.sea_by_height)
    warn("'diffraction'", "leave out 'ground: {sea_by_height: true}'");
  if (emitter.clutter && emitter.clutter->sea_state)
    warn("its clutter", "leave out 'sea_state' of the clutter");
  return warnings;
}

}  // namespace emscape::emfield
