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

}  // namespace emscape::study
