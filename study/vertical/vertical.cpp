#include "emscape/study/vertical/vertical.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/large_array.h"
#include "emfield/columns/station.h"
#include "emfield/excess/clutter_text.h"
#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "emscape/base/work.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/snapshot.h"
#include "emscape/study/maps/area.h"
#include "emscape/study/maps/coverage.h"
#include "emscape/volume/dense_volume.h"
#include "propagation/registry/model_info.h"
#include "study/maps/contour_lines.h"

namespace emscape::study {
namespace {

using emfield::HeightReference;
using scenario::Quantity;

/// Log-odds of a probability, which are nearly linear where the probability has a step.
float logOdds(float probability) {
  const float p = std::clamp(probability, 1e-9f, 1 - 1e-7f);
  return std::isnan(probability) ? NAN : std::log(p / (1 - p));
}

void checkRange(double value, double lowest, double highest, const char* what) {
  if (value >= lowest && value <= highest) return;
  throw Error(ErrorCode::usage, fmt::format("{}: {} m; {} to {} m", what, value, lowest, highest));
}

/// @throws Error (usage)
void checkRequest(const scenario::Scenario& scenario, const VerticalRequest& request) {
  checkRange(request.range_m, VerticalRequest::kMinRange_m, VerticalRequest::kMaxRange_m, "range");
  const bool is_above_sea = request.axis == HeightReference::mean_sea_level && !request.smooth_earth;
  checkRange(request.max_height_m, is_above_sea ? -500 : 10, 1e5, "height");  // ground may be below sea level
  if (std::min(request.ranges, request.heights) < 2 || std::max(request.ranges, request.heights) > 10000) {
    throw Error(ErrorCode::usage,
                fmt::format("grid: {} x {}; 2 to 10000 points a side", request.ranges, request.heights));
  }
  const scenario::QuantityInfo& quantity = scenario::info(request.quantity);
  const scenario::Emitter& emitter = scenario.emitters[static_cast<std::size_t>(request.emitter)];
  if (request.azimuths_deg.empty()) throw Error(ErrorCode::usage, "a vertical diagram needs an azimuth");
  for (const double azimuth_deg : request.azimuths_deg) {
    if (!(azimuth_deg >= -360 && azimuth_deg <= 360)) {
      throw Error(ErrorCode::usage, fmt::format("azimuth: {} deg; -360 to 360 deg", azimuth_deg));
    }
  }
  if (scenario::needsRadar(request.quantity) && emitter.kind != scenario::EmitterKind::radar) {
    throw Error(ErrorCode::usage, fmt::format("quantity '{}' is one of radars; '{}' is a {}", quantity.name,
                                              emitter.name, toString(emitter.kind)));
  }
  if (request.smooth_earth && request.axis == HeightReference::ground) {
    throw Error(ErrorCode::usage, "a chart over a smooth earth has heights above mean sea level");
  }
}

std::vector<double> evenly(double begin, double end, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(begin + (end - begin) * i / (count - 1));
  return values;
}

/// The channel of one emitter by itself.
std::optional<std::size_t> channelOf(int emitter, const std::vector<emfield::Channel>& channels) {
  const auto found = std::find_if(channels.begin(), channels.end(), [&](const emfield::Channel& channel) {
    return channel.emitters == std::vector<int>{emitter};
  });
  if (found == channels.end()) return std::nullopt;
  return static_cast<std::size_t>(found - channels.begin());
}

/// @param scenario  with the request's output
/// @throws Error (usage)
void requireValueOfOneEmitter(const scenario::Scenario& scenario, const VerticalRequest& request) {
  const scenario::QuantityInfo& quantity = scenario::info(request.quantity);
  if (!quantity.categorical && channelOf(request.emitter, emfield::channelsOf(scenario, {}))) return;
  throw Error(ErrorCode::usage,
              fmt::format("quantity '{}' has no value of one emitter by itself", quantity.name));
}

/// Removes the emitters that do not affect the value of one emitter.
/// @return its new index
int keepOnly(scenario::Scenario& scenario, int emitter, bool with_jammers) {
  std::vector<scenario::Emitter> kept;
  int index = 0;
  for (std::size_t i = 0; i < scenario.emitters.size(); ++i) {
    const bool is_it = static_cast<int>(i) == emitter;
    const bool jams = scenario.emitters[i].kind == scenario::EmitterKind::jammer;
    if (is_it) index = static_cast<int>(kept.size());
    if (is_it || (jams && with_jammers)) kept.push_back(std::move(scenario.emitters[i]));
  }
  scenario.emitters = std::move(kept);
  scenario.output.wanted_emitter = scenario.output.wanted_emitter == emitter ? index : -1;
  return index;
}

/// The warnings of cuts that are computed one by one: those that differ only in their figures are told once.
class WarningsOfCuts {
 public:
  void add(double azimuth_deg, const std::vector<std::string>& warnings) {
    for (const std::string& text : warnings) {
      const auto known = std::find_if(told_.begin(), told_.end(), [&](const Told& told) {
        return withoutFigures(told.text) == withoutFigures(text);
      });
      if (known == told_.end()) {
        told_.push_back({text, azimuth_deg, {}});
      } else if (known->text != text) {
        known->others_deg.push_back(azimuth_deg);
      }
    }
  }

  std::vector<std::string> texts() const {
    std::vector<std::string> texts;
    for (const Told& told : told_) {
      texts.push_back(told.others_deg.empty()
                          ? told.text
                          : fmt::format("{} (azimuth {:g} degrees; likewise, with other figures, at {:g})",
                                        told.text, told.azimuth_deg, fmt::join(told.others_deg, ", ")));
    }
    return texts;
  }

 private:
  struct Told {
    std::string text;
    double azimuth_deg;
    std::vector<double> others_deg;
  };

  static std::string withoutFigures(std::string text) {
    text.erase(std::remove_if(text.begin(), text.end(),
                              [](char letter) { return (letter >= '0' && letter <= '9') || letter == '.'; }),
               text.end());
    return text;
  }

  std::vector<Told> told_;
};

/// The field of the request over a scenario, by cut.
struct Solved {
  std::vector<std::vector<float>> values, ground_msl_m;
  WarningsOfCuts warnings;
  emfield::SteepGrounds steep;
};

class Solver {
 public:
  /// @param emitter  index in the scenarios of solve()
  Solver(const VerticalRequest& request, int emitter, const VerticalDiagram& diagram,
         emfield::FieldOptions options)
      : request_(request), emitter_(emitter), diagram_(diagram), options_(std::move(options)) {
    options_.allow_missing_terrain = true;
    options_.quantities.clear();
  }

  /// A model that marches does so for each cut by itself: along the cut, not between azimuths beside it.
  Solved solve(const scenario::Snapshot& snapshot, const scenario::TerrainPtr& terrain) const {
    const scenario::Emitter& emitter = snapshot.scenario->emitters[static_cast<std::size_t>(emitter_)];
    const std::size_t cuts = request_.azimuths_deg.size();
    Solved solved;
    if (propagation::modelInfo(emitter.propagation.model).radial == nullptr) {
      solveCuts(0, cuts, snapshot, terrain, solved);
      return solved;
    }
    for (std::size_t cut = 0; cut < cuts; ++cut) {
      const auto done = static_cast<double>(cut), count = static_cast<double>(cuts);
      const WorkPart part("", done / count, (done + 1) / count);
      solveCuts(cut, cut + 1, snapshot, terrain, solved);
    }
    return solved;
  }

 private:
  std::shared_ptr<emfield::Surface> surfaceOf(std::size_t begin, std::size_t end) const {
    auto surface = std::make_shared<emfield::Surface>();
    surface->width = request_.ranges;
    surface->height = static_cast<int>(end - begin);
    surface->reference = request_.axis;
    surface->heights_m = diagram_.heights_m;
    for (std::size_t cut = begin; cut < end; ++cut) {
      for (const double range_m : diagram_.ranges_m) {
        const GeodeticPosition position = geodesicDirect(diagram_.latitude_deg, diagram_.longitude_deg,
                                                         degToRad(request_.azimuths_deg[cut]), range_m);
        surface->positions.push_back({position.latitude_deg, position.longitude_deg});
      }
    }
    return surface;
  }

  /// Adds the fields of some cuts.
  void solveCuts(std::size_t begin_cut, std::size_t end_cut, const scenario::Snapshot& snapshot,
                 const scenario::TerrainPtr& terrain, Solved& solved) const {
    emfield::FieldOptions options = options_;
    options.surface = surfaceOf(begin_cut, end_cut);
    emfield::FieldSolver solver(snapshot.scenario, terrain, options);
    const std::size_t channel = *channelOf(emitter_, solver.channels());
    solver.update(snapshot);
    const auto volume = solver.volumes()[channel].host();
    solved.warnings.add(request_.azimuths_deg[begin_cut], solver.warnings(&solved.steep));
    const std::size_t ranges = static_cast<std::size_t>(request_.ranges);
    const std::size_t positions = ranges * (end_cut - begin_cut);
    for (std::size_t cut = 0; cut < end_cut - begin_cut; ++cut) {
      std::vector<float> values;
      for (std::size_t k = 0; k < options.surface->heights_m.size(); ++k) {
        checkpoint();
        for (std::size_t p = cut * ranges; p < (cut + 1) * ranges; ++p) {
          const bool is_valid = volume->first_valid_k.empty() || k >= volume->first_valid_k[p];
          values.push_back(is_valid ? volume->values[k * positions + p] : NAN);
        }
      }
      solved.values.push_back(std::move(values));
      const std::vector<float>& ground = solver.groundHeights_m();
      const auto begin = static_cast<std::ptrdiff_t>(cut * ranges);
      solved.ground_msl_m.emplace_back();
      if (!ground.empty()) {
        solved.ground_msl_m.back().assign(ground.begin() + begin,
                                          ground.begin() + begin + static_cast<std::ptrdiff_t>(ranges));
      }
    }
  }

  const VerticalRequest& request_;
  int emitter_;
  const VerticalDiagram& diagram_;
  emfield::FieldOptions options_;
};

std::vector<VerticalCut::Line> contoursOf(const std::vector<float>& values, const VerticalDiagram& diagram) {
  const VerticalRequest& request = diagram.request;
  std::vector<float> levels;
  copyInParts(values, levels);
  auto level = static_cast<float>(request.threshold), floor = static_cast<float>(diagram.floor);
  if (request.quantity == Quantity::detection_probability) {
    floor = logOdds(0) - 1;
    for (std::size_t n = 0; n < levels.size(); ++n) {
      if (n % static_cast<std::size_t>(request.ranges) == 0) checkpoint();
      levels[n] = values[n] == 0 ? floor : logOdds(values[n]);
    }
    level = logOdds(level);
  }
  const double range_step = diagram.ranges_m[1] - diagram.ranges_m[0];
  const double height_step = diagram.heights_m[1] - diagram.heights_m[0];
  std::vector<VerticalCut::Line> lines;
  for (const GridLine& of_grid : contourLines(levels, request.ranges, request.heights, level, floor)) {
    lines.emplace_back();
    for (const GridPoint& point : of_grid) {
      lines.back().push_back(
          {diagram.ranges_m[0] + point.x * range_step, diagram.heights_m[0] + point.y * height_step});
    }
  }
  return lines;
}

/// Removes the terrain: the smooth surface is moved to mean sea level, and all emitters with it.
/// @param station  the emitter below which the ground is the surface
/// @return the previous height (m) of the surface
double putOnSmoothEarth(scenario::Snapshot& snapshot, scenario::Scenario& scenario,
                        const scenario::EmitterState& station, const scenario::TerrainPtr& terrain) {
  double surface_msl_m = scenario.ground.surface_msl_m.value_or(0);
  if (!scenario.ground.surface_msl_m && terrain != nullptr) {
    surface_msl_m = static_cast<double>(
        terrain->heightMsl_m(station.position.latitude_deg, station.position.longitude_deg));
  }
  scenario.terrain.reset();
  scenario.ground.surface_msl_m.reset();
  for (scenario::EmitterState& state : snapshot.emitters) {
    state.height_msl_m -= surface_msl_m;
    state.position.height_ellipsoid_m -= surface_msl_m;
  }
  return surface_msl_m;
}

/// Height (m) of the lower edge above mean sea level: the lowest ground of all cuts, rounded down to 100 m.
double lowestGround_m(const VerticalRequest& request, const VerticalDiagram& diagram,
                      const scenario::Terrain* terrain) {
  if (terrain == nullptr) return 0;
  double lowest = INFINITY;
  for (const double azimuth_deg : request.azimuths_deg) {
    for (const double range_m : diagram.ranges_m) {
      const GeodeticPosition position =
          geodesicDirect(diagram.latitude_deg, diagram.longitude_deg, degToRad(azimuth_deg), range_m);
      const auto ground_m =
          static_cast<double>(terrain->heightMsl_m(position.latitude_deg, position.longitude_deg));
      if (ground_m < lowest) lowest = ground_m;
    }
  }
  return std::isfinite(lowest) ? 100 * std::floor(lowest / 100) : 0;
}

}  // namespace

double defaultRange_m(const scenario::Scenario& scenario, const VerticalRequest& request) {
  const scenario::Emitter& emitter = scenario.emitters[static_cast<std::size_t>(request.emitter)];
  if (emitter.waveform && emitter.waveform->instrumented_range_m)
    return *emitter.waveform->instrumented_range_m;
  constexpr int kSteps = 500;
  const auto [latitude_deg, longitude_deg] = [&] {
    const scenario::SitePosition site =
        scenario::pointAt(scenario.platforms[static_cast<std::size_t>(emitter.platform)], request.time_s)
            .position;
    return std::pair{site.latitude_deg, site.longitude_deg};
  }();
  const GeoFrame frame(scenario.region.origin);
  const Vec3d half = scenario.region.size_m * 0.5;
  double farthest_m = 0, range_m = 0;
  for (const double x : {-half.x, half.x}) {
    for (const double y : {-half.y, half.y}) {
      const GeodeticPosition corner = frame.toGeodetic({x, y, 0});
      farthest_m = std::max(
          farthest_m,
          geodesicInverse(latitude_deg, longitude_deg, corner.latitude_deg, corner.longitude_deg).distance_m);
    }
  }
  for (const double azimuth_deg : request.azimuths_deg) {
    for (int step = 1; step <= kSteps; ++step) {
      const double at_m = farthest_m * step / kSteps;
      const Vec3d local =
          frame.toLocal(geodesicDirect(latitude_deg, longitude_deg, degToRad(azimuth_deg), at_m));
      if (std::abs(local.x) > half.x || std::abs(local.y) > half.y) break;
      range_m = std::max(range_m, at_m);
    }
  }
  return std::max(range_m > 0 ? range_m : farthest_m, VerticalRequest::kMinRange_m);
}

VerticalRequest withDefaults(VerticalRequest request, const scenario::Scenario& scenario, bool has_quantity,
                             const std::string& option) {
  const bool is_radar =
      scenario.emitters[static_cast<std::size_t>(request.emitter)].kind == scenario::EmitterKind::radar;
  if (!has_quantity) {
    request.quantity =
        is_radar ? scenario::Quantity::detection_probability : scenario::Quantity::power_density_dbwm2;
  }
  request.threshold = thresholdOf(request.threshold, request.quantity, option);
  if (std::isnan(request.range_m)) request.range_m = defaultRange_m(scenario, request);
  const scenario::Region& region = scenario.region;
  const bool is_above_ground = request.axis == emfield::HeightReference::ground || request.smooth_earth;
  const double bottom_m = is_above_ground ? 0 : region.origin.height_msl_m;
  if (std::isnan(request.max_height_m)) {
    request.max_height_m = bottom_m + region.size_m.z;
    request.fits_height = true;
  }
  return request;
}

scenario::TerrainPtr loadVerticalTerrain(const scenario::Scenario& scenario, const VerticalRequest& request) {
  const scenario::Emitter& emitter = scenario.emitters[static_cast<std::size_t>(request.emitter)];
  const scenario::Platform& platform = scenario.platforms[static_cast<std::size_t>(emitter.platform)];
  const scenario::SitePosition site = scenario::pointAt(platform, request.time_s).position;
  return loadTerrain(scenario,
                     circularArea({site.latitude_deg, site.longitude_deg, 1.001 * request.range_m + 200}));
}

VerticalDiagram computeVertical(const std::shared_ptr<const scenario::Scenario>& scenario,
                                const scenario::TerrainPtr& terrain, const VerticalRequest& request,
                                emfield::FieldOptions options) {
  checkRequest(*scenario, request);
  auto own = std::make_shared<scenario::Scenario>(*scenario);
  own->output.quantities = {scenario::info(request.quantity).name};
  own->output.radar_look = scenario::RadarAim::target;
  own->output.combine = scenario::CombineMode::per_emitter;
  own->output.interval = {};
  requireValueOfOneEmitter(*own, request);
  const int index = keepOnly(*own, request.emitter, scenario::needsJammer(request.quantity));
  const auto e = static_cast<std::size_t>(index);
  scenario::Snapshot snapshot = scenario::instantAt(own, terrain.get(), request.time_s);
  const scenario::EmitterState& state = snapshot.emitters[e];
  const auto platform = static_cast<std::size_t>(own->emitters[e].platform);
  if (!snapshot.platforms[platform].present) {
    throw Error(ErrorCode::usage, scenario::absenceText(own->platforms[platform], request.time_s));
  }
  if (!state.active) {
    throw Error(ErrorCode::usage,
                fmt::format("'{}' is off at t = {:g} s", own->emitters[e].name, request.time_s));
  }
  const scenario::TerrainPtr below = request.smooth_earth ? nullptr : terrain;
  const double surface_msl_m = request.smooth_earth ? putOnSmoothEarth(snapshot, *own, state, terrain) : 0;

  VerticalDiagram diagram;
  diagram.request = request;
  diagram.scenario = own->name;
  diagram.title = titleOf(*scenario);
  diagram.emitter = own->emitters[e].name;
  diagram.model = toString(own->emitters[e].propagation.model);
  diagram.clutter = emfield::clutterText(*own, own->emitters[e]);
  diagram.unit = scenario::info(request.quantity).unit;
  diagram.latitude_deg = state.position.latitude_deg;
  diagram.longitude_deg = state.position.longitude_deg;
  diagram.station_msl_m = state.height_msl_m;
  diagram.floor = own->output.floor;
  diagram.surface_msl_m = surface_msl_m;
  diagram.station_agl_m = diagram.station_msl_m;
  if (below != nullptr) {
    diagram.station_agl_m -=
        static_cast<double>(below->heightMsl_m(diagram.latitude_deg, diagram.longitude_deg));
  }
  const emfield::Station station = emfield::makeStation(state.position, state.height_msl_m, own->atmosphere);
  diagram.effective_earth_radius_m = station.effective_earth_radius_m;
  diagram.k_factor = station.effective_earth_radius_m / station.earth_radius_m;
  diagram.ranges_m = evenly(request.range_m / request.ranges, request.range_m, request.ranges);
  const double lowest_m =
      request.axis == HeightReference::ground ? 0 : lowestGround_m(request, diagram, below.get());
  if (lowest_m + 10 > request.max_height_m) {
    throw Error(ErrorCode::usage,
                fmt::format("height: {} m; the lowest ground is at {} m", request.max_height_m, lowest_m));
  }
  diagram.heights_m = evenly(lowest_m, request.max_height_m, request.heights);

  const Solver solver(request, index, diagram, std::move(options));
  Solved solved = solver.solve(snapshot, below);
  diagram.warnings = warningsOf(*scenario);
  for (std::string& warning : solved.warnings.texts()) diagram.warnings.push_back(std::move(warning));
  for (std::string& warning : emfield::steepGroundWarnings(solved.steep))
    diagram.warnings.push_back(std::move(warning));
  if (const std::string outside = scenario::outsideClockText({request.time_s}, scenario->clock);
      !outside.empty())
    diagram.warnings.push_back(outside);
  for (std::size_t cut = 0; cut < request.azimuths_deg.size(); ++cut) {
    diagram.cuts.push_back({request.azimuths_deg[cut],
                            std::move(solved.values[cut]),
                            std::move(solved.ground_msl_m[cut]),
                            {},
                            {}});
    diagram.cuts.back().contours = contoursOf(diagram.cuts.back().values, diagram);
  }
  if (!request.smooth_earth) return diagram;

  auto free_space = std::make_shared<scenario::Scenario>(*own);
  free_space->emitters[e].propagation = {};
  free_space->emitters[e].propagation.model = propagation::PropagationModel::free_space;
  snapshot.scenario = free_space;
  const Solved without_earth = solver.solve(snapshot, nullptr);
  for (std::size_t cut = 0; cut < diagram.cuts.size(); ++cut) {
    diagram.cuts[cut].free_space = contoursOf(without_earth.values[cut], diagram);
  }
  return diagram;
}

}  // namespace emscape::study
