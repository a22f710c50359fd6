#include "emscape/study/coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/fast_geodesy.h"
#include "emscape/base/error.h"
#include "emscape/base/parallel.h"
#include "emscape/scenario/snapshot.h"
#include "emscape/volume/dense_volume.h"
#include "study/least_heights.h"
#include "study/time_figures.h"

namespace emscape::study {
namespace {

using emfield::FieldSolver;
using emfield::HeightReference;
using scenario::Quantity;

/// Products of what each emitter does by itself.
constexpr std::initializer_list<Product> kPerEmitter{Product::count, Product::redundancy, Product::best,
                                                     Product::max_range};
/// Products of what jamming changes.
constexpr std::initializer_list<Product> kOfJamming{Product::jam_loss, Product::burn_through};

bool isIn(const std::vector<Product>& products, std::initializer_list<Product> any) {
  return std::find_first_of(products.begin(), products.end(), any.begin(), any.end()) != products.end();
}

bool hasChannelPerEmitter(const scenario::Scenario& scenario, const std::string& quantity) {
  const std::vector<emfield::Channel> channels =
      emfield::channelsOf(scenario, {quantity}, scenario::CombineMode::per_emitter);
  return std::all_of(channels.begin(), channels.end(),
                     [](const emfield::Channel& channel) { return channel.emitters.size() == 1; });
}

/// @throws Error (usage)
void checkRequest(const scenario::Scenario& scenario, const CoverageRequest& request) {
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
    if (isIn({product}, kOfJamming) && !scenario::needsJammer(request.quantity)) {
      refuse(fmt::format("asks for a quantity that jamming changes; '{}' is none", quantity.name));
    }
    if (product != Product::value && quantity.categorical) {
      refuse(fmt::format("asks for a level; quantity '{}' is an index", quantity.name));
    }
    if (isIn({product}, kPerEmitter) && !hasChannelPerEmitter(scenario, quantity.name)) {
      refuse(fmt::format("asks what each emitter does by itself; quantity '{}' has one value for all",
                         quantity.name));
    }
    if (info(product).over_time && request.times_s.size() < 2) {
      refuse("is over time: give two times or more");
    }
  }
}

MapKind kindOf(const ProductInfo& product, Quantity quantity, const std::string& unit) {
  if (product.product == Product::best) return MapKind::category;
  if (!product.classes.empty()) return MapKind::classes;
  if (product.categorical) return MapKind::count;
  if (!unit.empty() || product.product == Product::gaps) return MapKind::level;
  const bool is_probability =
      product.product == Product::value && quantity == Quantity::detection_probability;
  return is_probability ? MapKind::probability : MapKind::part;
}

/// Colours of a product's classes: indices of render::categoryColor().
std::vector<int> classColors(Product product) {
  constexpr int kGreen = 2, kVermilion = 5;
  if (product == Product::covered) return {kGreen, kGreen};
  if (product == Product::jam_loss) return {kVermilion, kVermilion};
  if (product == Product::burn_through) return {kVermilion, kVermilion, kGreen};
  return {};
}

/// @param height  none: for all heights
CoverageMap emptyMap(const scenario::Scenario& scenario, const CoverageRequest& request, Product product,
                     const std::optional<MapHeight>& height) {
  const scenario::QuantityInfo& quantity = scenario::info(request.quantity);
  const ProductInfo& of_product = info(product);
  CoverageMap map;
  map.product = product;
  map.name = of_product.name;
  map.title = product == Product::value ? quantity.name : of_product.name;
  map.height = height;
  map.labels.assign(of_product.classes.begin(), of_product.classes.end());
  map.colors = classColors(product);
  map.area_class = of_product.area_class;
  map.unit = of_product.unit != nullptr ? of_product.unit : quantity.unit;
  map.kind = kindOf(of_product, request.quantity, map.unit);
  if (product == Product::best) {
    for (const scenario::Emitter& emitter : scenario.emitters) map.labels.push_back(emitter.name);
  }
  map.description = product == Product::value
                        ? quantity.name
                        : fmt::format("{} ({} >= {})", of_product.name, quantity.name, request.threshold);
  if (height) map.description += " at " + describe(*height);
  return map;
}

/// Sets the values of a map, and its areas.
template <class Value>
void fill(CoverageMap& map, const MapGrid& grid, const Value& valueAtPixel) {
  map.values.resize(grid.pixels());
  parallelFor(static_cast<int>(grid.pixels()), 1 << 14, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) map.values[p] = valueAtPixel(static_cast<std::size_t>(p));
  });
  const MapSummary summary = summaryOf(grid, map);
  map.known_area_m2 = summary.known_area_m2;
  map.class_area_m2 = summary.class_area_m2;
}

/// The maps of one reference of height.
class SurfaceMaps {
 public:
  SurfaceMaps(const MapGrid& grid, const CoverageRequest& request, HeightReference reference,
              const emfield::FieldOptions& options)
      : request_(request), grid_(grid), options_(options) {
    auto surface = std::make_shared<emfield::Surface>();
    surface->width = grid.width;
    surface->height = grid.height;
    surface->places = grid.places;
    surface->reference = reference;
    for (const MapHeight& height : request.heights) {
      if (height.reference == reference) surface->heights_m.push_back(height.metres);
    }
    std::sort(surface->heights_m.begin(), surface->heights_m.end());
    surface->heights_m.erase(std::unique(surface->heights_m.begin(), surface->heights_m.end()),
                             surface->heights_m.end());
    for (const double metres : surface->heights_m) heights_.push_back({reference, metres});
    options_.surface = surface;
    options_.allow_missing_terrain = true;  // masked, and reported by the maps' known area
    options_.also_per_emitter = isIn(request.products, kPerEmitter);
  }

  /// Begins with a number of scenarios.
  void begin(std::size_t scenarios) {
    states_.assign(scenarios, {});
    for (State& state : states_) {
      state.figures.assign(heights_.size(), {isOverTime() ? grid_.pixels() : 0, request_.times_s});
    }
  }

  /// The maps of a scenario, by its index, at the next time.
  void addTime(std::size_t index, const std::shared_ptr<const scenario::Scenario>& scenario,
               const scenario::TerrainPtr& terrain, double time_s, const MapSink& take) {
    const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, terrain.get(), time_s);
    if (!solver_) solver_.emplace(scenario, terrain, options_);
    Values values;
    if (isIn(request_.products, kOfJamming)) {
      scenario::Snapshot quiet = snapshot;
      for (std::size_t e = 0; e < quiet.emitters.size(); ++e) {
        if (scenario->emitters[e].kind == scenario::EmitterKind::jammer) quiet.emitters[e].active = false;
      }
      solver_->update(quiet, terrain);
      values.unjammed = solver_->volumes().front().host();
    }
    solver_->update(snapshot, terrain);
    const std::vector<volume::Volume>& volumes = solver_->volumes();
    values.all = volumes.front().host();
    State& state = states_[index];
    state.scenario = scenario;
    state.last = isOverTime() ? values.all : nullptr;
    state.warnings = solver_->warnings();
    for (std::size_t c = 1; c < volumes.size(); ++c) {
      const int emitter = solver_->channels()[c].emitters.front();
      const GeodeticPosition& at = snapshot.emitters[emitter].position;
      values.each.push_back({emitter, volumes[c].host(), fastGeodesy(at.latitude_deg, at.longitude_deg)});
    }
    for (std::size_t k = 0; k < heights_.size(); ++k) {
      if (isOverTime()) {
        state.figures[k].add(time_s, [&](std::size_t p) { return isCovered(valueAt(*values.all, k, p)); });
      }
      for (const Product product : request_.products) {
        if (info(product).over_time || !info(product).at_heights) continue;
        CoverageMap map = emptyMap(*scenario, request_, product, heights_[k]);
        map.time_s = time_s;
        fill(map, grid_, [&](std::size_t p) { return valueOf(product, values, k, p); });
        take(std::move(map));
      }
    }
  }

  /// The maps of a scenario over all times.
  void finish(std::size_t index, const MapSink& take) {
    const State& state = states_[index];
    for (std::size_t k = 0; k < heights_.size(); ++k) {
      for (const Product product : request_.products) {
        if (!info(product).over_time) continue;
        CoverageMap map = emptyMap(*state.scenario, request_, product, heights_[k]);
        fill(map, grid_, [&](std::size_t p) {
          return std::isnan(valueAt(*state.last, k, p)) ? NAN : state.figures[k].figure(product, p);
        });
        take(std::move(map));
      }
    }
  }

  /// Of a scenario, after its last time.
  const std::vector<std::string>& warnings(std::size_t index) const { return states_[index].warnings; }

 private:
  /// A scenario between its times.
  struct State {
    std::shared_ptr<const scenario::Scenario> scenario;
    std::vector<TimeFigures> figures;  ///< one per height
    std::shared_ptr<const volume::DenseVolume> last;
    std::vector<std::string> warnings;
  };
  struct ValuesOfOne {
    int emitter;
    std::shared_ptr<const volume::DenseVolume> values;
    FastGeodesy geodesy;  ///< from its position
  };
  /// The quantity at a time.
  struct Values {
    std::shared_ptr<const volume::DenseVolume> all, unjammed;
    std::vector<ValuesOfOne> each;
  };

  bool isOverTime() const {
    return std::any_of(request_.products.begin(), request_.products.end(),
                       [](Product product) { return info(product).over_time; });
  }
  bool isCovered(float value) const { return static_cast<double>(value) >= request_.threshold; }

  float valueAt(const volume::DenseVolume& volume, std::size_t k, std::size_t p) const {
    const bool is_valid = volume.first_valid_k.empty() || k >= volume.first_valid_k[p];
    return is_valid ? volume.values[k * grid_.pixels() + p] : NAN;
  }

  float valueOf(Product product, const Values& values, std::size_t k, std::size_t p) const {
    const float value = valueAt(*values.all, k, p);
    if (std::isnan(value)) return value;
    switch (product) {
      case Product::covered:
        return isCovered(value) ? 1.0f : 0.0f;
      case Product::margin:
        return value - static_cast<float>(request_.threshold);
      case Product::jam_loss:
        return !isCovered(value) && isCovered(valueAt(*values.unjammed, k, p)) ? 1.0f : 0.0f;
      case Product::burn_through:
        return isCovered(value) ? 2.0f : isCovered(valueAt(*values.unjammed, k, p)) ? 1.0f : 0.0f;
      case Product::count:
      case Product::redundancy:
      case Product::best:
      case Product::max_range:
        return ofEmitters(product, values.each, k, p);
      default:
        return value;
    }
  }

  float ofEmitters(Product product, const std::vector<ValuesOfOne>& each, std::size_t k,
                   std::size_t p) const {
    int count = 0, best = -1;
    float largest = 0;
    double farthest_m = NAN;
    for (const ValuesOfOne& one : each) {
      const float value = valueAt(*one.values, k, p);
      if (!isCovered(value)) continue;
      if (count++ == 0 || value > largest) {
        best = one.emitter;
        largest = value;
      }
      if (product == Product::max_range) {
        const auto [latitude_deg, longitude_deg] = grid_.places[p];
        const double distance_m =
            fastInverse(one.geodesy, surfacePoint(latitude_deg, longitude_deg).ecef_m).distance_m;
        farthest_m = std::fmax(farthest_m, distance_m);
      }
    }
    switch (product) {
      case Product::count:
        return static_cast<float>(count);
      case Product::redundancy:
        return static_cast<float>(std::max(count - 1, 0));
      case Product::max_range:
        return static_cast<float>(farthest_m);
      default:
        return static_cast<float>(best);
    }
  }

  const CoverageRequest& request_;
  const MapGrid& grid_;
  emfield::FieldOptions options_;
  std::vector<MapHeight> heights_;
  std::optional<FieldSolver> solver_;  ///< its first channel is of all emitters, those after it of one each
  std::vector<State> states_;          ///< one per scenario
};

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

struct CoverageSolver::Impl {
  const MapGrid& grid;
  const CoverageRequest request;
  emfield::FieldOptions options;
  std::vector<std::unique_ptr<SurfaceMaps>> maps;
};

CoverageSolver::CoverageSolver(const MapGrid& grid, const CoverageRequest& request,
                               const emfield::FieldOptions& options)
    : impl_(new Impl{grid, request, options, {}}) {
  impl_->options.quantities.clear();
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
    checkRequest(*scenario, request);
    at_targets.push_back(atTargets(*scenario, request.quantity));
  }
  const bool has_least = isIn(request.products, {Product::min_height});
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
      const std::vector<float> heights_m =
          leastHeights(at_targets[s], terrain, impl_->grid, request.threshold, time_s, impl_->options);
      CoverageMap map = emptyMap(*at_targets[s], request, Product::min_height, std::nullopt);
      map.time_s = time_s;
      fill(map, impl_->grid, [&](std::size_t p) { return heights_m[p]; });
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
