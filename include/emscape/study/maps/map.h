/// A map: values of the pixels of a grid, and their description.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "emscape/study/maps/map_grid.h"
#include "emscape/study/maps/products.h"

namespace emscape::study {

enum class MapKind {
  level,        ///< value with a unit: dB, m, s
  difference,   ///< difference of two levels; the sign has a meaning
  probability,  ///< 0..1
  fraction,     ///< 0..1
  count,        ///< 0, 1, 2 ...
  classes,      ///< 0, 1 ... with a label each; 0: nothing to show
  category      ///< index of a label; -1: none
};
/// Kinds whose values are whole numbers that are not interpolated.
constexpr bool isWhole(MapKind kind) {
  return kind == MapKind::classes || kind == MapKind::count || kind == MapKind::category;
}

/// Kinds whose values are 0..1.
constexpr bool isFraction(MapKind kind) {
  return kind == MapKind::probability || kind == MapKind::fraction;
}

/// What a pixel's value says.
enum class PixelAnswer : std::uint8_t {
  exact,    ///< the value
  bound,    ///< the value, of the emitters with a known path and the known times; the others may add to it
  unknown,  ///< no value: elevation data are missing there, or on paths that decide
  none      ///< no value: left out, below the ground, at most the floor, or at no height or time
};

struct Map {
  std::string name;  ///< of the product, for file names: "covered"; letters, digits, '_'
  MapKind kind = MapKind::level;
  std::string title;                ///< of its legend, in words: "minimum height above ground"
  std::string unit;                 ///< "": none
  std::string subject;              ///< "detection probability": the description without its height
  std::string description;          ///< "detection probability at 150 m above ground"
  std::optional<MapHeight> height;  ///< none: for all heights
  std::optional<double> time_s;     ///< since the scenario's epoch; none: over all times
  std::vector<std::string> labels;  ///< of classes and categories: names of 0, 1 ...
  std::vector<int> colors;  ///< of classes: indices of render::categoryColor(); empty: the class itself
  std::vector<std::uint32_t> label_colors = {};  ///< of categories, 0xAABBGGRR, in place of `colors`
  std::optional<double> floor;                   ///< of levels: pixels at most this have no value
  std::string note;                              ///< of the legend: "no echo: 100"
  /// Of decibels about 0, which have the colours of a volume's: 1: values above 0 are of interest; -1: below.
  int ratio_side = 0;
  int area_class = -1;        ///< the class whose area is reported; -1: none
  std::vector<float> values;  ///< pixels in the grid's order; NaN: no value
  /// One per pixel; empty: those with a value are exact, why others have none is not known.
  std::vector<PixelAnswer> answers;
  /// Of the pixels without a value whose answer is known: no height reaches the threshold. None: all pixels
  /// with a known answer have a value.
  std::optional<double> unreached_area_m2;
};

/// Name of a map's files, layers and variables: "covered_agl150m_t80s".
std::string fileNameOf(const Map& map);

/// Text of a figure in reports, with the digits that maps justify: km2 to 0.001, percent and dB to 0.01, m to
/// 0.1, without a unit (probabilities, fractions) to 0.0001, others to 4 digits. "none" for NaN and
/// infinities.
std::string figureText(double value, const std::string& unit);

/// Statistics of a map.
struct MapSummary {
  double min = 0, max = 0;       ///< of the values; NaN if there are none
  double known_area_m2 = 0;      ///< of the pixels with a known answer, on the ellipsoid
  double unknown_area_m2 = 0;    ///< of the pixels with an unknown answer
  double class_area_m2 = 0;      ///< of the pixels in Map::area_class, or that a height reaches
  long long largest_pixel = -1;  ///< with the largest value; -1: there is none
  /// Of categories and classes: of the pixels of each of Map::labels; else empty.
  std::vector<double> label_areas_m2;
};
MapSummary summaryOf(const MapGrid& grid, const Map& map);

}  // namespace emscape::study
