/// The products of coverage and the heights of maps: names, units, text.
#pragma once

#include <string>
#include <vector>

#include "emscape/emfield/surface.h"

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
  redundancy,       ///< number of those that may fail before none of them covers it
  best,             ///< the emitter with the largest value, where it covers the place
  max_range,        ///< distance (m) on the ground of the farthest emitter that covers it by itself
  min_height,       ///< least height (m) above ground at which it is covered
  jam_loss,         ///< 1 where the place would be covered without jammers, but is not
  burn_through,     ///< 0 not covered even without jammers, 1 lost to jamming, 2 covered in spite of it
  first_detection,  ///< time (s) at which the place is covered for the first time
  fraction,         ///< fraction of the times at which it is covered
  gaps,             ///< number of the gaps in coverage
  longest_gap,      ///< longest time (s) without coverage
  mean_gap,         ///< mean time (s) of the gaps
  revisit,          ///< mean time (s) from the beginning of a coverage to that of the next
  response,         ///< mean time (s) until it is covered, from a moment chosen at random
};

struct ProductInfo {
  Product product;
  const char* name;
  const char* unit;  ///< null: the quantity's
  const char* description;
  bool over_time = false;    ///< one map for all times
  bool categorical = false;  ///< integers: counts and indices
  bool at_heights = true;    ///< a map for each height
  /// Names of the values 0, 1 ... of a product that sorts places into classes.
  std::vector<const char*> classes = {};
  int area_class = -1;  ///< the class of which CoverageMap::class_area_m2 is the area
};
const std::vector<ProductInfo>& productTable();
const ProductInfo& info(Product product);
/// @throws Error (usage) that lists the allowed names
Product productNamed(const std::string& name);

}  // namespace emscape::study
