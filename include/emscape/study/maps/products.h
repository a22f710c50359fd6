/// The products of coverage and the heights of maps: names, units, text.
#pragma once

#include <string>
#include <vector>

#include "emscape/base/units.h"
#include "emscape/emfield/columns/surface.h"
#include "emscape/scenario/model/quantities.h"

namespace emscape::study {

struct MapHeight {
  emfield::HeightReference reference = emfield::HeightReference::ground;
  double metres = 0;
};
/// "150 m above ground", "3000 m above mean sea level", "500 ft above ground".
std::string describe(const MapHeight& height, Units units = Units::metric);
/// "agl150m", "msl3000m": for file names.
std::string nameOf(const MapHeight& height);

/// Parses "agl:30,150,300;msl:500:3000:500": lists and BEGIN:END:STEP.
/// @throws Error (usage) that names the part and what is allowed
std::vector<MapHeight> parseHeights(const std::string& text);

/// Content of a map. A position is covered if the quantity is at or above the threshold.
enum class Product {
  value,            ///< the quantity
  covered,          ///< 1 covered, 0 not
  margin,           ///< the quantity minus the threshold, for quantities in decibels
  count,            ///< number of emitters that cover the position on their own
  redundancy,       ///< number of those that may fail while one still covers it
  best,             ///< the emitter with the largest value, if it covers the position
  max_range,        ///< distance (m) along the ground of the farthest emitter that covers it on its own
  min_height,       ///< minimum height (m) above ground at which it is covered
  jam_loss,         ///< 1 if the position would be covered without jammers, but is not
  burn_through,     ///< 0 not covered even without jammers, 1 lost to jamming, 2 covered despite jamming
  cause,            ///< what decides that the position is not covered: emfield::PathCause
  first_detection,  ///< time (s) at which the position is first covered
  fraction,         ///< fraction of the times at which it is covered
  gaps,             ///< number of gaps in coverage
  longest_gap,      ///< longest time (s) without coverage
  mean_gap,         ///< mean duration (s) of the gaps
  revisit,          ///< mean time (s) between the beginnings of successive periods of coverage
  response,         ///< mean time (s) until it is covered, from a random moment
};

struct ProductInfo {
  Product product;
  const char* name;   ///< in options and file names
  const char* title;  ///< in words, for titles and legends; null: the quantity's
  const char* unit;   ///< null: the quantity's
  const char* description;
  bool over_time = false;    ///< one map for all times
  bool categorical = false;  ///< integers: counts and indices
  bool at_heights = true;    ///< a map for each height
  /// Names of the values 0, 1 ... of a product with classes.
  std::vector<const char*> classes = {};
  int area_class = -1;  ///< the class whose area is CoverageMap::class_area_m2
};
const std::vector<ProductInfo>& productTable();
const ProductInfo& info(Product product);
/// Name of a quantity in words: "detection probability", "SNR".
std::string titleOf(scenario::Quantity quantity);
/// Name of a product in words: "minimum height"; for Product::value that of the quantity.
std::string titleOf(Product product, scenario::Quantity quantity);
/// @throws Error (usage) that lists the allowed names
Product productNamed(const std::string& name);

}  // namespace emscape::study
