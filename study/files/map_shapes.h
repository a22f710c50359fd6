/// Maps as lines and polygons.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/geodesy/gdal.h"
#include "emscape/render/transfer/transfer_function.h"
#include "emscape/study/maps/map.h"

namespace emscape::study {

/// The levels of a map's contours, ascending: 0.1, 0.5 and 0.9 of probabilities and fractions; multiples of
/// 10 of decibels; of other units, round steps of about a quarter of the range. None for whole numbers.
std::vector<double> levelsOf(const Map& map);

struct MapLine {
  double level = 0;
  gdal::Geometry geometry;  ///< line string
};

struct MapBand {
  double min = 0, max = 0;           ///< values; equal for whole numbers
  std::string label;                 ///< of a class or category
  std::optional<render::Rgb> color;  ///< by the map's legend; none: transparent
  gdal::Geometry geometry;           ///< multipolygon, valid
};

struct MapShapes {
  std::vector<MapLine> lines;
  std::vector<MapBand> bands;
};

/// Contours are interpolated linearly between the centres of pixels; probabilities by their log-odds (clamped
/// to 1e-6 .. 1 - 1e-6). Beside pixels without a value, and beside those with a probability of 0, where there
/// is no echo, bands have the outlines of the pixels. Bands between levels tile the pixels that have a value.
/// Whole numbers have no contours; their bands have the outlines of the pixels, one for each number except
/// the one for no value. Coordinates are those of the grid's projection.
/// @throws Error (other) naming the destination file
MapShapes shapesOf(const MapGrid& grid, const Map& map, const std::filesystem::path& file);

}  // namespace emscape::study
