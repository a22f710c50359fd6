/// Studies: variants of a scenario, and the measures of each variant. docs/what-if.md describes the file
/// format.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "emscape/scenario/model/scenario.h"
#include "emscape/study/maps/area.h"
#include "emscape/study/maps/coverage.h"
#include "emscape/study/maps/map_grid.h"
#include "study/sweep/definition/variants.h"

namespace emscape::study {

/// One number of a variant.
struct StudyMeasure {
  enum class Figure {
    km2,      ///< area in which the product has its area class
    percent,  ///< the same, as a percentage of the area with a value
    mean,     ///< of the product, weighted by area
    min,
    max
  };
  std::string name;
  Product product = Product::covered;
  MapHeight height;  ///< not for products for all heights
  scenario::Quantity quantity = scenario::Quantity::detection_probability;
  double threshold = 0.5;
  Figure figure = Figure::km2;
  std::string over;  ///< file of polygons; empty: the whole map
};
/// "km2", "percent", or the product's unit.
std::string unitOf(const StudyMeasure& measure);

/// Choice of sites from candidates, each of which is a variant.
struct SiteSearch {
  int choose = 1;
  std::size_t measure = 0;  ///< to maximise: index into StudySpec::measures
};

struct StudySpec {
  std::string name;
  std::string file;
  std::shared_ptr<const scenario::Scenario> base;  ///< the scenario that the variants edit
  std::vector<double> times_s;                     ///< ascending
  MapArea area;
  double cell_m = 0;
  std::string crs;
  std::vector<StudyMeasure> measures;
  VariantSet variants;
  std::optional<SiteSearch> sites;
  /// Files that determine the results, besides those of `base`: polygons and candidates with the files beside
  /// them that GDAL reads, such as a shapefile's .prj, and files that the variants' scenarios name. Missing
  /// are files of a setting that is valid only together with those of other factors.
  std::vector<std::string> files;
  /// Terrain files of `base` with their CRC-32, as they are when the study is read.
  std::vector<std::pair<std::string, std::uint32_t>> rasters;
  /// FNV-1a (64 bits, hex) of the study, the scenario with its edits, its files and those in `files`.
  std::string hash;
};

/// Reads a study and its scenario. File names in it are relative to its folder. Every value of a parameter is
/// checked separately in the scenario; of more than 200 values, only the first, the last and the extremes.
/// @param edits    of the scenario, before those of the variants
/// @param version  of the program, for the hash
/// @param tries_values  false: neither values nor that each is set once are checked; for processes that
/// compute parts of a study that was checked before
/// @throws Error (bad_input) that lists all faults with file, line and column
StudySpec loadStudy(const std::string& file, const std::vector<scenario::Edit>& edits,
                    const std::string& version, bool tries_values = true);

/// The pixels of a study's maps. @throws Error (bad_input) that names the study, as makeMapGrid()
MapGrid mapGridOf(const StudySpec& study);

}  // namespace emscape::study
