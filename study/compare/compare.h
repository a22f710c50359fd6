/// Comparison of two scenarios, or of two folders of maps: gained and lost areas as maps and figures, with
/// their causes.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "emscape/base/progress.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/study/maps/coverage.h"
#include "emscape/study/maps/map.h"
#include "study/report/coverage_folder.h"

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
  /// Of levels, B minus A: area-weighted mean, minimum and maximum; NaN: no pixel has both values.
  double mean_difference = 0, min_difference = 0, max_difference = 0;
};

/// One side of an explanation: the path from the deciding emitter, in one of the scenarios.
struct ExplainedPath {
  std::string verdict;          ///< of PathBudget, or the reason why there is none
  std::optional<double> value;  ///< of the quantity for this emitter alone, if the budget has it
  std::optional<double> jammer_to_signal_db;  ///< of radars with jammers
};

/// Adjacent pixels (along their sides) with the same change.
struct ChangedArea {
  bool is_gained = false;  ///< true: in B and not in A; false: in A and not in B
  Product product = Product::covered;
  MapHeight height;
  double time_s = 0;
  double area_m2 = 0;
  /// Its pixel nearest to its centre.
  double latitude_deg = 0, longitude_deg = 0, height_msl_m = 0;
  /// The emitter with the largest value there, in the scenario that has the area; empty if none radiates.
  std::string emitter;
  ExplainedPath a, b;
};

struct Comparison {
  std::vector<ComparisonRow> rows;         ///< in the order of the maps
  std::vector<ChangedArea> changed_areas;  ///< the largest first, gained before lost
  bool has_paths = false;                  ///< the changed areas are explained by paths
  std::vector<std::string> warnings;
};

/// Warnings of A and B: those of both once.
std::vector<std::string> warningsOfBoth(const std::vector<std::string>& of_a,
                                        const std::vector<std::string>& of_b);

struct CompareRequest {
  CoverageRequest coverage;  ///< Product::best, an index, has no difference
  int areas = 3;             ///< of changed areas that are explained, for gained and lost each
};

/// @throws Error (usage, bad_input) as computeComparison() would, before it computes anything
void checkRequest(const CompareRequest& request, const scenario::Scenario& a, const scenario::Scenario& b);

/// Name of the map of changes: PRODUCT_change for products that mark an area, else PRODUCT_difference.
std::string changeNameOf(Product product);

/// Computes the same maps of two scenarios and their differences. Products that mark an area give a map of
/// classes (neither, gained, lost, kept), all others the difference B - A. Otherwise as computeCoverage().
/// @param take receives the maps of changeNameOf()
/// @throws Error (usage) for Product::best
Comparison computeComparison(const ComparedScenario& a, const ComparedScenario& b, const MapGrid& grid,
                             const CompareRequest& request, const emfield::FieldOptions& options,
                             const std::function<void(const Map&)>& take, const ProgressSink& progress = {});

/// The same for the maps in two folders, in the order of A's; no field is computed. The largest areas are
/// explained if the scenarios of both folders still exist.
/// @param grid    of both
/// @param chosen  pairs of maps of A and B of the same products, heights and times; not Product::best
/// @throws Error (bad_input) for a GeoTIFF that is missing, or whose pixels or unit differ from the other one
Comparison compareFolders(const CoverageFolder& a, const CoverageFolder& b,
                          const std::vector<std::pair<std::size_t, std::size_t>>& chosen, int areas,
                          const std::function<void(const Map&)>& take, const ProgressSink& progress = {});

/// Selection of the maps of two folders that are compared.
struct MapChoice {
  std::vector<Product> products;   ///< empty: all except Product::best
  std::vector<MapHeight> heights;  ///< empty: all
  std::vector<double> times_s;     ///< empty: all
};
/// Pairs of maps of two folders, in the order of A's.
/// @throws Error (bad_input) if the folders differ in pixels, quantity or threshold, or if a chosen map
/// exists in only one of them; (usage) for Product::best, and if there is no map for a chosen product or
/// height, or for any chosen time
std::vector<std::pair<std::size_t, std::size_t>> pairsOf(const CoverageFolder& a, const CoverageFolder& b,
                                                         const MapChoice& choice);

}  // namespace emscape::study
