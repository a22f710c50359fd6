#include "emscape/study/maps/coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "emfield/excess/model_check.h"
#include "emscape/base/error.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/snapshot.h"
#include "scenario/scan/scan_sampling.h"
#include "study/maps/causes.h"
#include "study/maps/least_heights.h"
#include "study/maps/surface_maps.h"
#include "study/maps/warnings.h"

namespace emscape::study {
namespace {

using emfield::HeightReference;
using scenario::Quantity;

bool hasChannelPerEmitter(const scenario::Scenario& scenario, const std::string& quantity) {
  const std::vector<emfield::Channel> channels =
      emfield::channelsOf(scenario, {quantity}, scenario::CombineMode::per_emitter);
  return std::all_of(channels.begin(), channels.end(),
                     [](const emfield::Channel& channel) { return channel.emitters.size() == 1; });
}

/// The scenario with the output of a map. Radars look at the target at the map's time, also where the volumes
/// of the scenario show the directions that beams pass in an interval; a probability over an interval's looks
/// keeps it.
std::shared_ptr<const scenario::Scenario> atTargets(const scenario::Scenario& scenario, Quantity quantity) {
  auto at_targets = std::make_shared<scenario::Scenario>(scenario);
  at_targets->output.quantities = {scenario::info(quantity).name};
  at_targets->output.radar_look = scenario::RadarAim::target;
  const bool has_looks = at_targets->output.interval.kind == scenario::IntervalKind::cumulative;
  if (scenario::needsRadar(quantity) && !has_looks) at_targets->output.interval = {};
  if (at_targets->output.combine != scenario::CombineMode::max) {
    at_targets->output.combine = scenario::CombineMode::sum;
  }
  return at_targets;
}

/// Warnings for products over time if scanning beams pass between the times.
std::optional<std::string> scanWarning(const scenario::Scenario& at_targets,
                                       const std::vector<CoverageRequest>& requests) {
  const bool is_over_time =
      std::any_of(requests.begin(), requests.end(), [](const CoverageRequest& r) { return isOverTime(r); });
  const std::vector<double>& times_s = requests.front().times_s;
  if (!is_over_time || times_s.size() < 2) return std::nullopt;
  const double duration_s = times_s.back() - times_s.front();
  const scenario::Clock clock{"", duration_s, duration_s / static_cast<double>(times_s.size() - 1)};
  const std::optional<scenario::UnlitAzimuths> unlit = scenario::unlitAzimuths(at_targets, clock);
  if (!unlit) return std::nullopt;
  return unlit->warning;
}

/// Warning for products over time if emitters switch on and off between the times.
std::optional<std::string> activityWarning(const scenario::Scenario& at_targets,
                                           const std::vector<CoverageRequest>& requests) {
  const bool is_over_time =
      std::any_of(requests.begin(), requests.end(), [](const CoverageRequest& r) { return isOverTime(r); });
  if (!is_over_time || at_targets.output.interval.kind != scenario::IntervalKind::instant)
    return std::nullopt;
  std::string text = scenario::missedActivityText(at_targets, requests.front().times_s);
  if (text.empty()) return std::nullopt;
  return text;
}

/// Warning for a projection in which pixels have another size than on the ground: Mercator's far from the
/// equator, a zone of UTM far from its meridian.
std::optional<std::string> scaleWarning(const MapGrid& grid) {
  constexpr double kTolerated = 0.02;
  float least_m2 = INFINITY, largest_m2 = 0;
  for (std::size_t pixel = 0; pixel < grid.pixels(); ++pixel) {
    if (std::isnan(grid.positions[pixel].latitude_deg)) continue;
    least_m2 = std::min(least_m2, grid.areas_m2[pixel]);
    largest_m2 = std::max(largest_m2, grid.areas_m2[pixel]);
  }
  const auto least_m = std::sqrt(static_cast<double>(least_m2)),
             largest_m = std::sqrt(static_cast<double>(largest_m2));
  if (least_m > (1 - kTolerated) * grid.cell_m && largest_m < (1 + kTolerated) * grid.cell_m)
    return std::nullopt;
  return fmt::format(
      "pixels of {:g} m in {} are {:.4g} to {:.4g} m on the ground; with the crs utm or local they are "
      "nearly that size",
      grid.cell_m, grid.crs, least_m, largest_m);
}

/// Warnings for times at which no emitter of the quantity is active, whose maps are empty, and for those at
/// which a jammer is not.
std::vector<std::string> inactiveWarnings(const std::shared_ptr<const scenario::Scenario>& at_targets,
                                          const scenario::TerrainPtr& terrain, Quantity quantity,
                                          const std::vector<double>& times_s) {
  const bool of_radars = scenario::needsRadar(quantity);
  const std::vector<scenario::Emitter>& emitters = at_targets->emitters;
  std::vector<double> empty_s;
  std::vector<std::vector<double>> silent_s(emitters.size());
  for (const double time_s : times_s) {
    const scenario::Snapshot snapshot = scenario::snapshotAt(at_targets, terrain.get(), time_s);
    bool is_active = false;
    for (std::size_t e = 0; e < emitters.size(); ++e) {
      const bool counts = !of_radars || emitters[e].kind == scenario::EmitterKind::radar;
      is_active = is_active || (counts && snapshot.emitters[e].active);
      if (!snapshot.emitters[e].active) silent_s[e].push_back(time_s);
    }
    if (!is_active) empty_s.push_back(time_s);
  }
  std::vector<std::string> warnings;
  const auto warn = [&](const std::string& who, const std::vector<double>& at_s, const char* maps) {
    if (at_s.empty()) return;
    const std::string when = at_s.size() == 1 ? fmt::format("at t = {} s", at_s.front())
                                              : fmt::format("at {} of {} times, first at t = {} s",
                                                            at_s.size(), times_s.size(), at_s.front());
    warnings.push_back(fmt::format("{} active {} (active_s, blink, or outside its track): the maps of {} {}",
                                   who, when, at_s.size() == 1 ? "this time" : "these times", maps));
  };
  warn(fmt::format("no {} is", of_radars ? "radar" : "emitter"), empty_s, "are empty");
  for (std::size_t e = 0; e < emitters.size() && of_radars && scenario::needsJammer(quantity); ++e) {
    if (emitters[e].kind == scenario::EmitterKind::jammer && emitters[e].enabled)
      warn(fmt::format("jammer '{}' is not", emitters[e].name), silent_s[e], "have none of its jamming");
  }
  return warnings;
}

/// Warnings for the parts of a map beyond the ranges in which radars look.
std::vector<std::string> instrumentedRangeWarnings(
    const std::shared_ptr<const scenario::Scenario>& at_targets, const scenario::TerrainPtr& terrain,
    Quantity quantity, const MapGrid& grid, double time_s) {
  std::vector<std::string> warnings;
  if (!scenario::needsRadar(quantity)) return warnings;
  const scenario::Snapshot snapshot = scenario::snapshotAt(at_targets, terrain.get(), time_s);
  for (std::size_t e = 0; e < snapshot.emitters.size(); ++e) {
    const scenario::Emitter& radar = at_targets->emitters[e];
    const bool has_limit = snapshot.emitters[e].active && radar.kind == scenario::EmitterKind::radar &&
                           radar.waveform && radar.waveform->instrumented_range_m;
    if (!has_limit) continue;
    const double limit_m = *radar.waveform->instrumented_range_m;
    const bool ends_there = radar.waveform->limits_detection && quantity == Quantity::detection_probability;
    const Vec3d site_m = toEcef(snapshot.emitters[e].position);
    double all_m2 = 0, beyond_m2 = 0;
    for (std::size_t p = 0; p < grid.pixels(); ++p) {
      const auto [latitude_deg, longitude_deg] = grid.positions[p];
      if (std::isnan(latitude_deg)) continue;
      const auto area_m2 = static_cast<double>(grid.areas_m2[p]);
      all_m2 += area_m2;
      if (length(toEcef({latitude_deg, longitude_deg, 0}) - site_m) > limit_m) beyond_m2 += area_m2;
    }
    if (beyond_m2 == 0) continue;
    warnings.push_back(
        fmt::format("{:.1f} of {:.1f} km2 of the map are beyond the instrumented range of '{}', {:g} km: {}",
                    beyond_m2 / 1e6, all_m2 / 1e6, radar.name, limit_m / 1e3,
                    ends_there ? "it detects nothing there" : "its echoes are computed there nevertheless"));
  }
  return warnings;
}

/// Warning for heights that only make sense in kilometres.
std::optional<std::string> heightWarning(const std::vector<CoverageRequest>& requests) {
  constexpr double kLow_m = 1;
  for (const CoverageRequest& request : requests) {
    for (const MapHeight& height : request.heights) {
      if (height.metres > 0 && height.metres < kLow_m)
        return fmt::format("a map at {}: heights are in metres, not in kilometres", describe(height));
    }
  }
  return std::nullopt;
}

/// Warnings for maps below the lowest height of an emitter's model.
void addLowHeights(const scenario::Scenario& scenario, const std::vector<CoverageRequest>& requests,
                   std::vector<std::string>& warnings) {
  std::set<std::string> told;
  for (const CoverageRequest& request : requests) {
    for (const MapHeight& height : request.heights) {
      if (height.reference != emfield::HeightReference::ground) continue;
      for (const scenario::Emitter& emitter : scenario.emitters) {
        if (scenario::needsRadar(request.quantity) && emitter.kind != scenario::EmitterKind::radar) continue;
        const std::vector<std::string> low = emfield::lowEndWarnings(emitter, HUGE_VAL, height.metres);
        for (const std::string& warning : low)
          if (told.insert(warning).second) warnings.push_back(warning);
      }
    }
  }
}

/// A warning for maps that show the margin of burn-through as coverage.
std::optional<std::string> burnThroughWarning(const std::vector<CoverageRequest>& requests) {
  const bool has_margin = std::any_of(requests.begin(), requests.end(), [](const CoverageRequest& request) {
    return request.quantity == Quantity::burn_through_margin_db;
  });
  if (!has_margin) return std::nullopt;
  return "burn_through_margin_db compares the echo with jamming alone: noise, clutter and limits of range "
         "may "
         "prevent detection where it is positive; the product burn_through of detection_probability has them";
}

emfield::FieldOptions withoutQuantities(emfield::FieldOptions options) {
  options.quantities.clear();
  return options;
}

}  // namespace

std::optional<double> defaultThreshold(Quantity quantity) {
  switch (quantity) {
    case Quantity::detection_probability:
      return 0.5;
    case Quantity::burn_through_margin_db:
    case Quantity::intercept_margin_db:
      return 0.0;
    case Quantity::emitter_count:
    case Quantity::exposure_ratio:
      return 1.0;
    default:
      return std::nullopt;
  }
}

void requireThreshold(Quantity quantity, double threshold) {
  const char* const name = scenario::info(quantity).name;
  if (!std::isfinite(threshold))
    throw Error(ErrorCode::usage, fmt::format("threshold {} of {} must be a finite number", threshold, name));
  if (quantity == Quantity::detection_probability && !(threshold > 0 && threshold < 1))
    throw Error(ErrorCode::usage, fmt::format("threshold {} of {} must be between 0 and 1", threshold, name));
}

double thresholdOf(double threshold, Quantity quantity, const std::string& option) {
  const scenario::QuantityInfo& info = scenario::info(quantity);
  if (std::isnan(threshold)) {
    if (const std::optional<double> usual = defaultThreshold(quantity)) return *usual;
    const std::string unit = info.unit;
    throw Error(ErrorCode::usage, fmt::format("{}: quantity '{}' has no default threshold; give one{}",
                                              option, info.name, unit.empty() ? "" : " in " + unit));
  }
  requireThreshold(quantity, threshold);
  return threshold;
}

void checkRequest(const CoverageRequest& request, const scenario::Scenario& scenario) {
  const scenario::QuantityInfo& quantity = scenario::info(request.quantity);
  if (request.heights.empty()) throw Error(ErrorCode::usage, "a map needs a height");
  if (request.times_s.empty()) throw Error(ErrorCode::usage, "a map needs a time");
  for (std::size_t t = 0; t < request.times_s.size(); ++t) {
    const double time_s = request.times_s[t];
    if (!std::isfinite(time_s))
      throw Error(ErrorCode::usage, fmt::format("time {} s of a map is not a finite number", time_s));
    if (t > 0 && time_s <= request.times_s[t - 1])
      throw Error(ErrorCode::usage, fmt::format("times of maps must ascend; {} s follows {} s", time_s,
                                                request.times_s[t - 1]));
  }
  const bool in_decibels = std::string(quantity.unit).rfind("dB", 0) == 0;
  for (const Product product : request.products) {
    const auto refuse = [&](const std::string& why) {
      throw Error(ErrorCode::usage, fmt::format("product '{}' {}", info(product).name, why));
    };
    if (product == Product::margin && !in_decibels) {
      refuse(fmt::format("needs a quantity in decibels, not '{}'", quantity.name));
    }
    if (isOfJamming(product) && !scenario::needsJammer(request.quantity)) {
      refuse(fmt::format("needs a quantity that jamming affects, not '{}'", quantity.name));
    }
    if (product == Product::cause && !hasCauses(request.quantity)) {
      refuse(fmt::format("needs a quantity of the budget of a path, not '{}'", quantity.name));
    }
    if (product != Product::value && quantity.categorical) {
      refuse(fmt::format("needs a level; quantity '{}' is an index", quantity.name));
    }
    if (isPerEmitter(product) && !hasChannelPerEmitter(scenario, quantity.name)) {
      refuse(
          fmt::format("needs the value of each emitter; quantity '{}' has one value for all", quantity.name));
    }
    if (info(product).over_time && request.times_s.size() < 2) {
      refuse("is over time: give two times or more");
    }
  }
  const bool has_threshold = std::any_of(request.products.begin(), request.products.end(),
                                         [](Product product) { return product != Product::value; });
  if (has_threshold) requireThreshold(request.quantity, request.threshold);
}

struct CoverageSolver::Impl {
  /// The field of one reference of height, with the maps of each request.
  struct OfReference {
    SurfaceField field;
    std::vector<SurfaceMaps> maps;
  };

  const MapGrid& grid;
  const std::vector<CoverageRequest> requests;
  emfield::FieldOptions options;
  std::vector<OfReference> references;
  std::vector<std::size_t> with_least;  ///< requests with minimum heights
  std::optional<LeastHeights> least_heights;
  const std::optional<std::string> scale_warning;

  /// @param of_maps  without quantities
  /// @throws Error (usage) if no pixel has its centre in the area
  Impl(const MapGrid& map_grid, std::vector<CoverageRequest> of_maps_requests,
       const emfield::FieldOptions& of_maps)
      : grid(map_grid),
        requests(std::move(of_maps_requests)),
        options(of_maps),
        scale_warning(scaleWarning(map_grid)) {
    const auto isInside = [](const emfield::Surface::Position& centre) {
      return !std::isnan(centre.latitude_deg);
    };
    if (std::none_of(grid.positions.begin(), grid.positions.end(), isInside)) {
      throw Error(ErrorCode::usage,
                  fmt::format("no pixel of {} m has its centre in the area: a smaller cell or a larger area",
                              grid.cell_m));
    }
    for (const HeightReference reference : {HeightReference::ground, HeightReference::mean_sea_level}) {
      SurfaceField field(grid, requests, reference, options);
      if (!field.hasHeights()) continue;
      references.push_back({std::move(field), {}});
      OfReference& of_reference = references.back();
      for (const CoverageRequest& request : requests)
        of_reference.maps.emplace_back(grid, request, reference, of_reference.field);
    }
    std::vector<double> thresholds;
    for (std::size_t r = 0; r < requests.size(); ++r) {
      const std::vector<Product>& products = requests[r].products;
      if (std::count(products.begin(), products.end(), Product::min_height) == 0) continue;
      with_least.push_back(r);
      thresholds.push_back(requests[r].threshold);
    }
    if (!thresholds.empty()) least_heights.emplace(grid, std::move(thresholds), options);
  }
};

CoverageSolver::CoverageSolver(const MapGrid& grid, std::vector<CoverageRequest> requests,
                               const emfield::FieldOptions& options)
    : impl_(new Impl(grid, std::move(requests), withoutQuantities(options))) {}

CoverageSolver::~CoverageSolver() = default;

std::vector<std::vector<std::string>> CoverageSolver::compute(
    const std::vector<std::shared_ptr<const scenario::Scenario>>& scenarios,
    const scenario::TerrainPtr& terrain, const ScenarioMapSink& take, const ProgressSink& progress) {
  const std::vector<CoverageRequest>& requests = impl_->requests;
  const std::vector<double>& times_s = requests.front().times_s;
  std::vector<std::shared_ptr<const scenario::Scenario>> at_targets;
  for (const auto& scenario : scenarios) {
    for (const CoverageRequest& request : requests) checkRequest(request, *scenario);
    at_targets.push_back(atTargets(*scenario, requests.front().quantity));
  }
  const std::size_t fields = impl_->references.size() + (impl_->least_heights ? 1 : 0);
  std::size_t causes = 0;
  for (const Impl::OfReference& of : impl_->references) {
    for (const SurfaceMaps& maps : of.maps) causes += maps.causeMaps();
  }
  const auto steps = static_cast<double>(times_s.size() * scenarios.size() * (fields + causes));
  double done = 0;
  const auto tell = [&](double more) {
    if (progress) progress("maps", (done + more) / steps);
  };
  for (Impl::OfReference& of : impl_->references) {
    for (SurfaceMaps& maps : of.maps) maps.begin(scenarios.size());
  }
  std::vector<std::set<std::string>> of_fields(scenarios.size());  // warnings
  std::vector<emfield::SteepGrounds> steep(scenarios.size());
  for (const double time_s : times_s) {
    for (std::size_t s = 0; s < scenarios.size(); ++s) {
      const auto takeOf = [&](std::size_t r) {
        return [&take, s, r](CoverageMap map) { take(s, r, std::move(map)); };
      };
      for (Impl::OfReference& of : impl_->references) {
        tell(0);
        const SurfaceValues values = of.field.at(at_targets[s], terrain, time_s);
        ++done;
        emfield::SteepGrounds now;
        addOnce(of_fields[s], of.field.warnings(now));
        emfield::keepSteepest(steep[s], now);
        for (std::size_t r = 0; r < requests.size(); ++r) {
          of.maps[r].addTime(s, at_targets[s], values, time_s, takeOf(r), tell);
          done += static_cast<double>(of.maps[r].causeMaps());
        }
      }
      if (!impl_->least_heights) continue;
      tell(0);
      std::vector<std::vector<float>> least_m = impl_->least_heights->compute(at_targets[s], terrain, time_s);
      for (std::size_t n = 0; n < least_m.size(); ++n) {
        const std::size_t r = impl_->with_least[n];
        CoverageMap map = emptyMap(*at_targets[s], requests[r], Product::min_height, std::nullopt);
        map.time_s = time_s;
        double unreached_m2 = 0;
        for (std::size_t p = 0; p < least_m[n].size(); ++p) {
          map.answers.push_back(impl_->least_heights->answer(p, least_m[n][p]));
          const bool is_inside = !std::isnan(impl_->grid.positions[p].latitude_deg);
          if (is_inside && map.answers.back() == PixelAnswer::none)
            unreached_m2 += static_cast<double>(impl_->grid.areas_m2[p]);
        }
        map.unreached_area_m2 = unreached_m2;
        setValues(map, impl_->grid, std::move(least_m[n]));
        takeOf(r)(std::move(map));
      }
      ++done;
    }
  }
  std::vector<std::vector<std::string>> warnings(scenarios.size());
  for (std::size_t s = 0; s < scenarios.size(); ++s) {
    warnings[s] = warningsOf(*scenarios[s]);
    const std::string outside = scenario::outsideClockText(times_s, at_targets[s]->clock);
    if (!outside.empty()) warnings[s].push_back(outside);
    for (std::string& warning : inactiveWarnings(at_targets[s], terrain, requests.front().quantity, times_s))
      warnings[s].push_back(std::move(warning));
    for (const auto& warning :
         {scanWarning(*at_targets[s], requests), activityWarning(*at_targets[s], requests),
          impl_->scale_warning, heightWarning(requests), burnThroughWarning(requests)})
      if (warning) warnings[s].push_back(*warning);
    addLowHeights(*at_targets[s], requests, warnings[s]);
    for (std::string& warning : instrumentedRangeWarnings(at_targets[s], terrain, requests.front().quantity,
                                                          impl_->grid, times_s.front()))
      warnings[s].push_back(std::move(warning));
    for (Impl::OfReference& of : impl_->references) {
      for (std::size_t r = 0; r < requests.size(); ++r)
        of.maps[r].finish(s, [&](CoverageMap map) { take(s, r, std::move(map)); });
    }
    addOnce(of_fields[s], emfield::steepGroundWarnings(steep[s]));
    warnings[s].insert(warnings[s].end(), of_fields[s].begin(), of_fields[s].end());
  }
  if (progress) progress("maps", 1);
  return warnings;
}

std::vector<std::string> computeCoverage(const std::shared_ptr<const scenario::Scenario>& scenario,
                                         const scenario::TerrainPtr& terrain, const MapGrid& grid,
                                         const CoverageRequest& request, const emfield::FieldOptions& options,
                                         const MapSink& take, const ProgressSink& progress) {
  CoverageSolver solver(grid, {request}, options);
  return solver
      .compute(
          {scenario}, terrain, [&](std::size_t, std::size_t, CoverageMap map) { take(std::move(map)); },
          progress)
      .front();
}

}  // namespace emscape::study
