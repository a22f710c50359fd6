/// Maps of coverage: a quantity on surfaces above ground or sea, and what follows from it over time.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/progress.h"
#include "emscape/emfield/field_solver.h"
#include "emscape/scenario/terrain.h"
#include "emscape/study/map_grid.h"

namespace emscape::study {

struct MapHeight {
  emfield::HeightReference reference = emfield::HeightReference::ground;
  double metres = 0;
};
/// "150 m above ground", "3000 m above mean sea level".
std::string describe(const MapHeight& height);
/// "agl150m", "msl3000m": for file names.
std::string nameOf(const MapHeight& height);

/// Parses "agl:30,150,300;msl:500:3000:500": lists and BEGIN:END:STEP.
/// @throws Error (usage) that names the part and what is allowed
std::vector<MapHeight> parseHeights(const std::string& text);

/// What a map shows. A place is covered where the quantity is at or above the threshold.
enum class Product {
  value,            ///< the quantity
  covered,          ///< 1 covered, 0 not
  margin,           ///< the quantity less the threshold, of quantities in decibels
  count,            ///< number of emitters that cover the place by themselves
  best,             ///< the emitter with the largest value, where it covers the place
  min_height,       ///< least height (m) above ground at which it is covered
  jam_loss,         ///< 1 where the place would be covered without jammers, but is not
  first_detection,  ///< time (s) at which the place is covered for the first time
  fraction,         ///< fraction of the times at which it is covered
  longest_gap,      ///< longest time (s) without coverage
  mean_gap,         ///< mean time (s) of the gaps
};

struct ProductInfo {
  Product product;
  const char* name;
  const char* unit;  ///< null: the quantity's
  const char* description;
  bool over_time = false;    ///< one map for all times
  bool categorical = false;  ///< integers: counts and indices
  bool at_heights = true;    ///< a map for each height
};
const std::vector<ProductInfo>& productTable();
const ProductInfo& info(Product product);
/// @throws Error (usage) that lists the allowed names
Product productNamed(const std::string& name);

struct CoverageRequest {
  std::vector<MapHeight> heights;
  std::vector<Product> products;
  scenario::Quantity quantity = scenario::Quantity::detection_probability;
  double threshold = 0.5;
  std::vector<double> times_s;  ///< rising
};

/// One map: a product at a height, at a time or over all.
struct CoverageMap {
  Product product = Product::value;
  std::optional<MapHeight> height;  ///< none: for all heights
  std::optional<double> time_s;     ///< none: over all times
  std::string unit;
  std::string description;     ///< "detection_probability at 150 m above ground"
  std::vector<float> values;   ///< pixels in the grid's order; NaN: left out, below ground or unknown
  double known_area_m2 = 0;    ///< of the pixels with a value
  double covered_area_m2 = 0;  ///< of product covered: where it is 1; of jam_loss: lost; else 0
};

/// The default threshold: 0.5 of a probability, 0 dB of a margin or ratio over a required level; none for
/// others.
std::optional<double> defaultThreshold(scenario::Quantity quantity);

/// Takes a finished map; called by the thread that computes.
using MapSink = std::function<void(CoverageMap)>;

/// Computes maps by the field's own functions at every pixel: a pixel's value is that of `emscape profile`
/// there. Looks are at the target (RadarLook::target): coverage does not depend on where a scan happens to
/// point. Maps come by time, height (those above ground first) and product; those over all times at last.
/// @param terrain  of the whole map and all platforms; null: a smooth earth
/// @param options  backend and memory; the rest is set here
/// @return warnings
/// @throws Error (bad_input, usage, device) as FieldSolver does, and for a product that the quantity or the
/// times do not have
std::vector<std::string> computeCoverage(const std::shared_ptr<const scenario::Scenario>& scenario,
                                         const scenario::TerrainPtr& terrain, const MapGrid& grid,
                                         const CoverageRequest& request, emfield::FieldOptions options,
                                         const MapSink& take, const ProgressSink& progress = {});

}  // namespace emscape::study
