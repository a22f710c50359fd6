#include "emscape/study/coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/error.h"
#include "emscape/scenario/snapshot.h"
#include "study/least_heights.h"
#include "study/surface_maps.h"

namespace emscape::study {
namespace {

using emfield::FieldSolver;
using emfield::HeightReference;
using scenario::Quantity;

bool hasChannelPerEmitter(const scenario::Scenario& scenario, const std::string& quantity) {
  const std::vector<emfield::Channel> channels =
      emfield::channelsOf(scenario, {quantity}, scenario::CombineMode::per_emitter);
  return std::all_of(channels.begin(), channels.end(),
                     [](const emfield::Channel& channel) { return channel.emitters.size() == 1; });
}

/// The scenario with the output of a map.
std::shared_ptr<const scenario::Scenario> atTargets(const scenario::Scenario& scenario, Quantity quantity) {
  auto at_targets = std::make_shared<scenario::Scenario>(scenario);
  at_targets->output.quantities = {scenario::info(quantity).name};
  at_targets->output.radar_look = scenario::RadarLook::target;
  if (at_targets->output.combine != scenario::CombineMode::max) {
    at_targets->output.combine = scenario::CombineMode::sum;
  }
  return at_targets;
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
      return 1.0;
    default:
      return std::nullopt;
  }
}

void checkRequest(const CoverageRequest& request, const scenario::Scenario& scenario) {
  const scenario::QuantityInfo& quantity = scenario::info(request.quantity);
  if (request.heights.empty()) throw Error(ErrorCode::usage, "a map needs a height");
  if (request.times_s.empty()) throw Error(ErrorCode::usage, "a map needs a time");
  const bool in_decibels = std::string(quantity.unit).rfind("dB", 0) == 0;
  for (const Product product : request.products) {
    const auto refuse = [&](const std::string& why) {
      throw Error(ErrorCode::usage, fmt::format("product '{}' {}", info(product).name, why));
    };
    if (product == Product::margin && !in_decibels) {
      refuse(fmt::format("is a difference of decibels; quantity '{}' has none", quantity.name));
    }
    if (isOfJamming(product) && !scenario::needsJammer(request.quantity)) {
      refuse(fmt::format("asks for a quantity that jamming changes; '{}' is none", quantity.name));
    }
    if (product != Product::value && quantity.categorical) {
      refuse(fmt::format("asks for a level; quantity '{}' is an index", quantity.name));
    }
    if (isPerEmitter(product) && !hasChannelPerEmitter(scenario, quantity.name)) {
      refuse(fmt::format("asks what each emitter does by itself; quantity '{}' has one value for all",
                         quantity.name));
    }
    if (info(product).over_time && request.times_s.size() < 2) {
      refuse("is over time: give two times or more");
    }
  }
}

struct CoverageSolver::Impl {
  const MapGrid& grid;
  const CoverageRequest request;
  emfield::FieldOptions options;
  LeastHeights least_heights;
  std::vector<std::unique_ptr<SurfaceMaps>> maps;

  /// @param of_maps  without quantities
  Impl(const MapGrid& map_grid, const CoverageRequest& of_request, const emfield::FieldOptions& of_maps)
      : grid(map_grid),
        request(of_request),
        options(of_maps),
        least_heights(map_grid, of_request.threshold, of_maps) {}
};

CoverageSolver::CoverageSolver(const MapGrid& grid, const CoverageRequest& request,
                               const emfield::FieldOptions& options)
    : impl_(new Impl(grid, request, withoutQuantities(options))) {
  for (const HeightReference reference : {HeightReference::ground, HeightReference::mean_sea_level}) {
    const bool is_asked = std::any_of(request.heights.begin(), request.heights.end(),
                                      [&](const MapHeight& height) { return height.reference == reference; });
    if (is_asked) {
      impl_->maps.push_back(std::make_unique<SurfaceMaps>(grid, impl_->request, reference, impl_->options));
    }
  }
}

CoverageSolver::~CoverageSolver() = default;

std::vector<std::vector<std::string>> CoverageSolver::compute(
    const std::vector<std::shared_ptr<const scenario::Scenario>>& scenarios,
    const scenario::TerrainPtr& terrain, const ScenarioMapSink& take, const ProgressSink& progress) {
  const CoverageRequest& request = impl_->request;
  std::vector<std::shared_ptr<const scenario::Scenario>> at_targets;
  for (const auto& scenario : scenarios) {
    checkRequest(request, *scenario);
    at_targets.push_back(atTargets(*scenario, request.quantity));
  }
  const bool has_least =
      std::count(request.products.begin(), request.products.end(), Product::min_height) > 0;
  const double steps = static_cast<double>(request.times_s.size() * scenarios.size() *
                                           (impl_->maps.size() + (has_least ? 1 : 0)));
  double done = 0;
  for (const auto& of_reference : impl_->maps) of_reference->begin(scenarios.size());
  for (const double time_s : request.times_s) {
    for (std::size_t s = 0; s < scenarios.size(); ++s) {
      const MapSink take_map = [&](CoverageMap map) { take(s, std::move(map)); };
      for (const auto& of_reference : impl_->maps) {
        if (progress) progress("maps", done / steps);
        of_reference->addTime(s, at_targets[s], terrain, time_s, take_map);
        ++done;
      }
      if (!has_least) continue;
      if (progress) progress("maps", done / steps);
      const std::vector<float> heights_m = impl_->least_heights.compute(at_targets[s], terrain, time_s);
      CoverageMap map = emptyMap(*at_targets[s], request, Product::min_height, std::nullopt);
      map.time_s = time_s;
      setValues(map, impl_->grid, heights_m);
      take_map(std::move(map));
      ++done;
    }
  }
  std::vector<std::vector<std::string>> warnings(scenarios.size());
  for (std::size_t s = 0; s < scenarios.size(); ++s) {
    for (const auto& of_reference : impl_->maps) {
      of_reference->finish(s, [&](CoverageMap map) { take(s, std::move(map)); });
      for (const std::string& warning : of_reference->warnings(s)) {
        if (std::find(warnings[s].begin(), warnings[s].end(), warning) == warnings[s].end()) {
          warnings[s].push_back(warning);
        }
      }
    }
  }
  if (progress) progress("maps", 1);
  return warnings;
}

std::vector<std::string> computeCoverage(const std::shared_ptr<const scenario::Scenario>& scenario,
                                         const scenario::TerrainPtr& terrain, const MapGrid& grid,
                                         const CoverageRequest& request, const emfield::FieldOptions& options,
                                         const MapSink& take, const ProgressSink& progress) {
  CoverageSolver solver(grid, request, options);
  return solver
      .compute(
          {scenario}, terrain, [&](std::size_t, CoverageMap map) { take(std::move(map)); }, progress)
      .front();
}

}  // namespace emscape::study
