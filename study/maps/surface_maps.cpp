#include "study/maps/surface_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/large_array.h"
#include "base/text/quantity_text.h"
#include "emfield/channels/categories.h"
#include "emfield/channels/products.h"
#include "emscape/base/parallel.h"
#include "emscape/scenario/model/snapshot.h"
#include "emscape/volume/dense_volume.h"
#include "study/maps/causes.h"

namespace emscape::study {
namespace {

using emfield::HeightReference;
using scenario::Quantity;

MapKind kindOf(const ProductInfo& product, Quantity quantity, const std::string& unit) {
  const bool is_value = product.product == Product::value;
  if (product.product == Product::best) return MapKind::category;
  if (is_value && scenario::info(quantity).categorical) return MapKind::category;
  if (is_value && quantity == Quantity::emitter_count) return MapKind::count;
  if (!product.classes.empty()) return MapKind::classes;
  if (product.categorical) return MapKind::count;
  if (!unit.empty()) return MapKind::level;
  const bool is_probability = is_value && quantity == Quantity::detection_probability;
  return is_probability ? MapKind::probability : MapKind::fraction;
}

/// The value that a field holds where it has none; none: its smallest value is an answer.
std::optional<double> floorOf(const scenario::Scenario& scenario, Quantity quantity) {
  if (quantity == Quantity::detection_age_s) return -1;
  const bool in_decibels = std::string(scenario::info(quantity).unit).rfind("dB", 0) == 0;
  return in_decibels ? std::optional(scenario.output.floor) : std::nullopt;
}

/// Map::ratio_side of a quantity.
int ratioSideOf(Quantity quantity) {
  const char* const scale = emfield::scaleOf(quantity);
  if (scale == nullptr) return 0;
  return scale == std::string(volume::kRatioAboveScale)   ? 1
         : scale == std::string(volume::kRatioBelowScale) ? -1
                                                          : 0;
}

/// Colours of a product's classes: indices of render::categoryColor().
std::vector<int> classColors(Product product) {
  constexpr int kGreen = 2, kVermilion = 5;
  if (product == Product::covered) return {kGreen, kGreen};
  if (product == Product::jam_loss) return {kVermilion, kVermilion};
  if (product == Product::burn_through) return {kVermilion, kVermilion, kGreen};
  if (product == Product::cause) return {2, 7, 0, 5, 3, 4, 6, 1};
  return {};
}

/// A value for each pixel.
template <class Value>
std::vector<float> valuesOfPixels(const MapGrid& grid, const Value& valueAtPixel) {
  std::vector<float> values(grid.pixels());
  parallelFor(static_cast<int>(grid.pixels()), 1 << 14, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) values[p] = valueAtPixel(static_cast<std::size_t>(p));
  });
  return values;
}

/// True for products that the emitters with a known path do not decide although they reach the threshold.
bool needsAllEmitters(Product product) {
  return product == Product::best;
}

/// The answers of a product, and its values: NaN where there is none.
void setAnswers(CoverageMap& map, std::vector<PixelAnswer> answers, std::vector<float>& values) {
  for (std::size_t p = 0; p < values.size(); ++p) {
    const bool has_value = answers[p] == PixelAnswer::exact || answers[p] == PixelAnswer::bound;
    if (has_value && std::isnan(values[p])) answers[p] = PixelAnswer::none;
    if (!has_value) values[p] = NAN;
  }
  map.answers = std::move(answers);
}

template <class Test>
bool hasAny(const std::vector<Product>& products, const Test& test) {
  return std::any_of(products.begin(), products.end(), test);
}

}  // namespace

bool isPerEmitter(Product product) {
  return product == Product::count || product == Product::redundancy || product == Product::best ||
         product == Product::max_range;
}

bool isOfJamming(Product product) {
  return product == Product::jam_loss || product == Product::burn_through;
}

bool isOverTime(const CoverageRequest& request) {
  return std::any_of(request.products.begin(), request.products.end(),
                     [](Product product) { return info(product).over_time; });
}

CoverageMap emptyMap(const scenario::Scenario& scenario, const CoverageRequest& request, Product product,
                     const std::optional<MapHeight>& height) {
  const scenario::QuantityInfo& quantity = scenario::info(request.quantity);
  const ProductInfo& of_product = info(product);
  CoverageMap map;
  map.product = product;
  map.name = of_product.name;
  map.title = titleOf(product, request.quantity);
  map.height = height;
  map.labels.assign(of_product.classes.begin(), of_product.classes.end());
  map.colors = classColors(product);
  map.area_class = of_product.area_class;
  map.unit = of_product.unit != nullptr ? of_product.unit : quantity.unit;
  map.kind = kindOf(of_product, request.quantity, map.unit);
  if (map.kind == MapKind::category) {
    const Quantity named = product == Product::best ? Quantity::dominant_emitter : request.quantity;
    map.labels = emfield::categoryNames(scenario, named);
  }
  if (product == Product::value || product == Product::margin)
    map.floor = floorOf(scenario, request.quantity);
  if (product == Product::value) {
    map.note = emfield::legendNoteOf(request.quantity, scenario);
    map.ratio_side = ratioSideOf(request.quantity);
  }
  map.subject = product == Product::value ? map.title
                                          : fmt::format("{} ({} >= {})", map.title, titleOf(request.quantity),
                                                        quantityText(request.threshold, quantity.unit));
  map.description = map.subject + (height ? " at " + describe(*height) : "");
  return map;
}

std::vector<CoverageMap> outlinesOf(const CoverageRequest& request) {
  const std::vector<std::optional<MapHeight>> heights(request.heights.begin(), request.heights.end());
  const std::vector<std::optional<double>> times_s(request.times_s.begin(), request.times_s.end());
  std::vector<CoverageMap> outlines;
  for (const Product product : request.products) {
    const ProductInfo& of = info(product);
    for (const auto& height : of.at_heights ? heights : std::vector<std::optional<MapHeight>>(1)) {
      for (const auto& time_s : of.over_time ? std::vector<std::optional<double>>(1) : times_s) {
        CoverageMap& map = outlines.emplace_back();
        map.product = product;
        map.name = of.name;
        map.height = height;
        map.time_s = time_s;
      }
    }
  }
  return outlines;
}

void setValues(CoverageMap& map, const MapGrid& grid, std::vector<float> values) {
  map.values = std::move(values);
  const MapSummary summary = summaryOf(grid, map);
  map.known_area_m2 = summary.known_area_m2;
  map.class_area_m2 = summary.class_area_m2;
}

SurfaceField::SurfaceField(const MapGrid& grid, const std::vector<CoverageRequest>& requests,
                           HeightReference reference, const emfield::FieldOptions& options)
    : options_(options) {
  auto surface = std::make_shared<emfield::Surface>();
  surface->width = grid.width;
  surface->height = grid.height;
  copyInParts(grid.positions, surface->positions);
  surface->reference = reference;
  for (const CoverageRequest& request : requests) {
    for (const MapHeight& height : request.heights) {
      if (height.reference == reference) surface->heights_m.push_back(height.metres);
    }
    options_.also_per_emitter = options_.also_per_emitter || hasAny(request.products, isPerEmitter);
    options_.also_unjammed = options_.also_unjammed || hasAny(request.products, isOfJamming);
  }
  std::sort(surface->heights_m.begin(), surface->heights_m.end());
  surface->heights_m.erase(std::unique(surface->heights_m.begin(), surface->heights_m.end()),
                           surface->heights_m.end());
  options_.surface = surface;
  options_.allow_missing_terrain = true;  // masked, and reported as the maps' known area; see requireGround()
  options_.keep_partly_unknown = true;
}

std::size_t SurfaceField::layerOf(const MapHeight& height) const {
  const std::vector<double>& heights_m = options_.surface->heights_m;
  return static_cast<std::size_t>(std::lower_bound(heights_m.begin(), heights_m.end(), height.metres) -
                                  heights_m.begin());
}

SurfaceValues SurfaceField::at(const std::shared_ptr<const scenario::Scenario>& scenario,
                               const scenario::TerrainPtr& terrain, double time_s) {
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, terrain.get(), time_s);
  if (!solver_) solver_ = std::make_unique<emfield::FieldSolver>(scenario, terrain, options_);
  solver_->update(snapshot, terrain);
  const std::vector<volume::Volume>& volumes = solver_->volumes();
  SurfaceValues values;
  values.terrain = terrain;
  values.all = volumes.front().host();
  values.partly_unknown = solver_->partlyUnknown(0);
  if (options_.surface->reference == HeightReference::mean_sea_level)
    values.ground_msl_m = solver_->groundHeights_m();
  if (options_.also_unjammed) values.unjammed = volumes.back().host();
  const std::size_t end = volumes.size() - (options_.also_unjammed ? 1 : 0);
  for (std::size_t c = 1; c < end; ++c) {
    const int emitter = solver_->channels()[c].emitters.front();
    const GeodeticPosition& position = snapshot.emitters[emitter].position;
    values.each.push_back(
        {emitter, volumes[c].host(), fastGeodesy(position.latitude_deg, position.longitude_deg)});
  }
  return values;
}

SurfaceMaps::SurfaceMaps(const MapGrid& grid, const CoverageRequest& request, HeightReference reference,
                         const SurfaceField& field)
    : request_(request), grid_(grid) {
  for (const MapHeight& height : request.heights) {
    if (height.reference == reference) layers_.push_back({height, field.layerOf(height)});
  }
  const auto isLower = [](const Layer& a, const Layer& b) { return a.k < b.k; };
  const auto isSame = [](const Layer& a, const Layer& b) { return a.k == b.k; };
  std::sort(layers_.begin(), layers_.end(), isLower);
  layers_.erase(std::unique(layers_.begin(), layers_.end(), isSame), layers_.end());
}

void SurfaceMaps::begin(std::size_t scenarios) {
  states_.assign(scenarios, {});
  for (State& state : states_) {
    state.figures.assign(layers_.size(), {isOverTime(request_) ? grid_.pixels() : 0, request_.times_s});
  }
}

std::size_t SurfaceMaps::causeMaps() const {
  const std::vector<Product>& products = request_.products;
  return std::find(products.begin(), products.end(), Product::cause) == products.end() ? 0 : layers_.size();
}

void SurfaceMaps::addTime(std::size_t index, const std::shared_ptr<const scenario::Scenario>& scenario,
                          const SurfaceValues& values, double time_s, const MapSink& take,
                          const std::function<void(double)>& progress) {
  State& state = states_[index];
  double causes = 0;
  state.scenario = scenario;
  state.answers.resize(isOverTime(request_) ? layers_.size() : 0);
  for (std::size_t n = 0; n < layers_.size(); ++n) {
    const std::size_t k = layers_[n].k;
    std::vector<PixelAnswer> answers(grid_.pixels());
    parallelFor(static_cast<int>(grid_.pixels()), 1 << 14, [&](int begin, int end) {
      for (int p = begin; p < end; ++p)
        answers[p] = answerAt(values, layers_[n], static_cast<std::size_t>(p));
    });
    if (isOverTime(request_)) {
      state.figures[n].add(time_s, [&](std::size_t p) {
        return answers[p] == PixelAnswer::unknown      ? TimeFigures::Coverage::unknown
               : isCovered(valueAt(*values.all, k, p)) ? TimeFigures::Coverage::yes
                                                       : TimeFigures::Coverage::no;
      });
    }
    for (const Product product : request_.products) {
      if (info(product).over_time || !info(product).at_heights) continue;
      CoverageMap map = emptyMap(*scenario, request_, product, layers_[n].height);
      map.time_s = time_s;
      std::vector<PixelAnswer> of_product = answers;
      if (needsAllEmitters(product))
        std::replace(of_product.begin(), of_product.end(), PixelAnswer::bound, PixelAnswer::unknown);
      std::vector<float> shown =
          product == Product::cause
              ? causesOf(
                    grid_, request_, scenario, values.terrain.get(), layers_[n].height, time_s, of_product,
                    [&](std::size_t p) { return isCovered(valueAt(*values.all, k, p)); },
                    [&](double fraction) { progress(causes + fraction); })
              : valuesOf(product, values, k, of_product, map.floor);
      causes += product == Product::cause;
      setAnswers(map, std::move(of_product), shown);
      setValues(map, grid_, std::move(shown));
      take(std::move(map));
    }
    if (isOverTime(request_)) state.answers[n] = std::move(answers);
  }
}

void SurfaceMaps::finish(std::size_t index, const MapSink& take) {
  const State& state = states_[index];
  for (std::size_t n = 0; n < layers_.size(); ++n) {
    for (const Product product : request_.products) {
      if (!info(product).over_time) continue;
      CoverageMap map = emptyMap(*state.scenario, request_, product, layers_[n].height);
      const TimeFigures& figures = state.figures[n];
      std::vector<PixelAnswer> answers = state.answers[n];
      for (std::size_t p = 0; p < answers.size(); ++p)
        if (answers[p] != PixelAnswer::none) answers[p] = figures.answer(product, p);
      std::vector<float> values =
          valuesOfPixels(grid_, [&](std::size_t p) { return figures.figure(product, p); });
      setAnswers(map, std::move(answers), values);
      setValues(map, grid_, std::move(values));
      take(std::move(map));
    }
  }
}

PixelAnswer SurfaceMaps::answerAt(const SurfaceValues& values, const Layer& layer, std::size_t p) const {
  if (std::isnan(grid_.positions[p].latitude_deg)) return PixelAnswer::none;
  const float value = valueAt(*values.all, layer.k, p);
  if (std::isnan(value)) {
    constexpr double kSame_m = 0.01;
    const bool is_above_sea = layer.height.reference == HeightReference::mean_sea_level;
    const double ground_m = values.ground_msl_m.empty() ? 0 : static_cast<double>(values.ground_msl_m[p]);
    const bool is_below = is_above_sea && layer.height.metres < ground_m + kSame_m;
    return is_below ? PixelAnswer::none : PixelAnswer::unknown;
  }
  if (values.partly_unknown.empty() || values.partly_unknown[p] == 0) return PixelAnswer::exact;
  return isCovered(value) ? PixelAnswer::bound : PixelAnswer::unknown;
}

std::vector<float> SurfaceMaps::valuesOf(Product product, const SurfaceValues& values, std::size_t k,
                                         const std::vector<PixelAnswer>& answers,
                                         std::optional<float> floor) const {
  /// @param ofKnown(value, p)  of a pixel with a value
  const auto from = [&](const auto& ofKnown) {
    return valuesOfPixels(grid_, [&](std::size_t p) {
      const bool has_value = answers[p] == PixelAnswer::exact || answers[p] == PixelAnswer::bound;
      return has_value ? ofKnown(valueAt(*values.all, k, p), p) : NAN;
    });
  };
  const auto aboveFloor = [floor](float value) { return floor && !(value > *floor) ? NAN : value; };
  const auto isCoveredUnjammed = [&](std::size_t p) { return isCovered(valueAt(*values.unjammed, k, p)); };
  switch (product) {
    case Product::covered:
      return from([&](float value, std::size_t) { return isCovered(value) ? 1.0f : 0.0f; });
    case Product::margin:
      return from([&](float value, std::size_t) {
        return aboveFloor(value) - static_cast<float>(request_.threshold);
      });
    case Product::jam_loss:
      return from([&](float value, std::size_t p) {
        return !isCovered(value) && isCoveredUnjammed(p) ? 1.0f : 0.0f;
      });
    case Product::burn_through:
      return from([&](float value, std::size_t p) {
        return isCovered(value) ? 2.0f : isCoveredUnjammed(p) ? 1.0f : 0.0f;
      });
    case Product::count:
    case Product::redundancy:
    case Product::best:
    case Product::max_range:
      return from([&](float, std::size_t p) { return ofEmitters(product, values.each, k, p); });
    default:
      return from([&](float value, std::size_t) { return aboveFloor(value); });
  }
}

float SurfaceMaps::ofEmitters(Product product, const std::vector<SurfaceValues::OfOne>& each, std::size_t k,
                              std::size_t p) const {
  int count = 0, best = -1;
  float largest = 0;
  double farthest_m = NAN;
  for (const SurfaceValues::OfOne& one : each) {
    const float value = valueAt(*one.values, k, p);
    if (!isCovered(value)) continue;
    if (count++ == 0 || value > largest) {
      best = one.emitter;
      largest = value;
    }
    if (product == Product::max_range) {
      const auto [latitude_deg, longitude_deg] = grid_.positions[p];
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

}  // namespace emscape::study
