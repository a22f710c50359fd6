/// Comparison of two scenarios, or of two folders of maps: what the second wins and loses, on maps, in
/// figures, and why.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "emscape/base/progress.h"
#include "emscape/emfield/field_solver.h"
#include "emscape/study/coverage.h"
#include "emscape/study/coverage_folder.h"
#include "emscape/study/map.h"

namespace emscape::study {

/// A scenario with its terrain (null: none).
struct ComparedScenario {
  std::shared_ptr<const scenario::Scenario> scenario;
  scenario::TerrainPtr terrain;
};

/// Figures of one product at a height and a time. Areas are of pixels that have a value in both scenarios.
struct ComparisonRow {
  Product product = Product::covered;
  std::optional<MapHeight> height;
  std::optional<double> time_s;
  std::string unit;
  double known_area_m2 = 0;
  bool is_area = false;  ///< the product marks an area (ProductInfo::area_class); else it is a level
  double area_a_m2 = 0, area_b_m2 = 0, gained_m2 = 0, lost_m2 = 0;  ///< of areas
  /// Of levels, B less A: mean by area, smallest and largest; NaN: no pixel has both values.
  double mean_difference = 0, min_difference = 0, max_difference = 0;
};

/// One end of an explanation: the path from the emitter that decides, in one of the scenarios.
struct ExplainedPath {
  std::string verdict;          ///< of PathBudget, or the reason why there is none
  std::optional<double> value;  ///< of the quantity for this emitter alone, if the budget has it
  std::optional<double> jammer_to_signal_db;  ///< of radars with jammers
};

/// Pixels that touch along their sides and changed alike.
struct ChangedArea {
  bool is_gained = false;  ///< B has it and A not; else the other way round
  Product product = Product::covered;
  MapHeight height;
  double time_s = 0;
  double area_m2 = 0;
  /// Its pixel nearest to its centre.
  double latitude_deg = 0, longitude_deg = 0, height_msl_m = 0;
  /// The emitter with the largest value there in the scenario that has the area; empty: none radiates.
  std::string emitter;
  ExplainedPath a, b;
};

struct Comparison {
  std::vector<ComparisonRow> rows;         ///< in the order of the maps
  std::vector<ChangedArea> changed_areas;  ///< the largest first, gained before lost
  bool has_paths = false;                  ///< the changed areas are explained by paths
  std::vector<std::string> warnings;
};

struct CompareRequest {
  CoverageRequest coverage;  ///< Product::best, an index, has no difference
  int areas = 3;             ///< of changed areas that are explained, for gained and lost each
};

/// @throws Error (usage, bad_input) as computeComparison() would, before it computes anything
void checkRequest(const CompareRequest& request, const scenario::Scenario& a, const scenario::Scenario& b);

/// Computes the same maps of two scenarios and their differences. Products that mark an area give a map of
/// classes (neither, gained, lost, kept), all others B less A. As computeCoverage() in all else.
/// @param take  the maps, PRODUCT_change and PRODUCT_difference
/// @throws Error (usage) for Product::best
Comparison computeComparison(const ComparedScenario& a, const ComparedScenario& b, const MapGrid& grid,
                             const CompareRequest& request, const emfield::FieldOptions& options,
                             const std::function<void(const Map&)>& take, const ProgressSink& progress = {});

/// The same of the maps that two folders hold, in the order of A's: nothing is computed again. The largest
/// areas are explained if both folders have their scenarios still.
/// @param grid    of both
/// @param chosen  maps of A and of B, of the same products, heights and times; none is Product::best
/// @throws Error (bad_input) for a GeoTIFF that is missing, or of other pixels or units than its pair
Comparison compareFolders(const CoverageFolder& a, const CoverageFolder& b,
                          const std::vector<std::pair<std::size_t, std::size_t>>& chosen, int areas,
                          const std::function<void(const Map&)>& take, const ProgressSink& progress = {});

/// Which maps of two folders are compared.
struct MapChoice {
  std::vector<Product> products;   ///< empty: all but Product::best
  std::vector<MapHeight> heights;  ///< empty: all
  std::vector<double> times_s;     ///< empty: all
};
/// Pairs of maps of two folders, in the order of A's.
/// @throws Error (bad_input) if the folders differ in pixels, quantity or threshold, or if one has a chosen
/// map that the other has not; (usage) for Product::best, and if there is no map of a chosen product or
/// height, or of any chosen time
std::vector<std::pair<std::size_t, std::size_t>> pairsOf(const CoverageFolder& a, const CoverageFolder& b,
                                                         const MapChoice& choice);

}  // namespace emscape::study
