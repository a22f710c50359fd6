/// Studies: many variants of a scenario, and what is measured of each. The file's format: docs/what-if.md.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emscape/scenario/scenario.h"
#include "emscape/study/area.h"
#include "emscape/study/coverage.h"
#include "emscape/study/variants.h"

namespace emscape::study {

/// One number of a variant.
struct StudyMeasure {
  enum class Figure {
    km2,      ///< area where the product has its area class
    percent,  ///< the same, of the area with a value
    mean,     ///< of the product, weighted by area
    min,
    max
  };
  std::string name;
  Product product = Product::covered;
  MapHeight height;  ///< not of products for all heights
  scenario::Quantity quantity = scenario::Quantity::detection_probability;
  double threshold = 0.5;
  Figure figure = Figure::km2;
  std::string over;  ///< file of polygons; empty: the whole map
};
/// "km2", "percent", or the product's unit.
std::string unitOf(const StudyMeasure& measure);

/// Sites to choose from the candidates, each a variant.
struct SiteSearch {
  int choose = 1;
  std::size_t measure = 0;  ///< to maximise: index into StudySpec::measures
};

struct StudySpec {
  std::string name;
  std::string file;
  std::shared_ptr<const scenario::Scenario> base;  ///< which the variants edit
  std::vector<double> times_s;                     ///< rising
  MapArea area;
  double cell_m = 0;
  std::string crs;
  std::vector<StudyMeasure> measures;
  VariantSet variants;
  std::optional<SiteSearch> sites;
  /// FNV-1a (64 bits, hex) of the study, the scenario with its edits and all files of both.
  std::string hash;
};

/// Reads a study and its scenario. Names of files in it are relative to its folder. Every value of a
/// parameter is tried in the scenario by itself; of more than 200 values, the first, the last and the
/// extremes.
/// @param edits    of the scenario, before those of the variants
/// @param version  of the program, for the hash
/// @param tries_values  false: values are not tried, in a process that computes parts of a study that another
/// has read before
/// @throws Error (bad_input) that lists all faults with file, line and column
StudySpec loadStudy(const std::string& file, const std::vector<scenario::Edit>& edits,
                    const std::string& version, bool tries_values = true);

}  // namespace emscape::study
