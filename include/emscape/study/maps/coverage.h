/// Maps of coverage: a quantity on surfaces above ground or sea, and products over time.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/progress.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/scenario/terrain/terrain.h"
#include "emscape/study/maps/map.h"
#include "emscape/study/maps/map_grid.h"
#include "emscape/study/maps/products.h"

namespace emscape::study {

struct CoverageRequest {
  std::vector<MapHeight> heights;
  std::vector<Product> products;
  scenario::Quantity quantity = scenario::Quantity::detection_probability;
  double threshold = 0.5;
  std::vector<double> times_s;  ///< ascending
};

/// A map of a product, at one height or for all, at one time or over all. Values are NaN in pixels that are
/// left out, below ground or unknown.
struct CoverageMap : Map {
  Product product = Product::value;
  double known_area_m2 = 0;  ///< of the pixels with a known answer
  double class_area_m2 = 0;  ///< as in MapSummary; 0 for products without areas
};

/// The default threshold: 0.5 for a probability, 0 dB for a margin or ratio over a required level; none for
/// other quantities.
std::optional<double> defaultThreshold(scenario::Quantity quantity);
/// @throws Error (usage) for a threshold that is not finite, or of a probability not between 0 and 1
void requireThreshold(scenario::Quantity quantity, double threshold);
/// The threshold, or the default of the quantity. @param threshold  NaN: none  @param option  its name
/// @throws Error (usage) that names the option if there is neither; as requireThreshold()
double thresholdOf(double threshold, scenario::Quantity quantity, const std::string& option);

/// Receives a finished map, on the thread that computes.
using MapSink = std::function<void(CoverageMap)>;

/// The same for maps of several scenarios and requests, with their indices.
using ScenarioMapSink = std::function<void(std::size_t scenario, std::size_t request, CoverageMap)>;

/// Computes maps of several scenarios on the same pixels and keeps the field between them: only what differs
/// from the previous scenario is recomputed (FieldSolver::update). The maps equal those of computeCoverage().
/// For one thread.
class CoverageSolver {
 public:
  /// @param grid      must outlive the solver
  /// @param requests  one or more, with the same quantity and times, so that they share the field
  /// @param options   backend, memory and move_tolerance_m; the rest is set here
  CoverageSolver(const MapGrid& grid, std::vector<CoverageRequest> requests,
                 const emfield::FieldOptions& options);
  ~CoverageSolver();

  /// Computes several scenarios together: all at the first time, then all at the next. Scenarios with the
  /// same tracks share the geometry of each time. Memory for products over time grows with the number of
  /// scenarios.
  /// @param terrain  of the whole map and all platforms; null: a smooth earth. A different object is treated
  /// as a different terrain
  /// @return the warnings of each scenario, each once, without counts
  /// @throws Error (bad_input, usage, device) as FieldSolver does, and for a product that the quantity or the
  /// times do not have
  std::vector<std::vector<std::string>> compute(
      const std::vector<std::shared_ptr<const scenario::Scenario>>& scenarios,
      const scenario::TerrainPtr& terrain, const ScenarioMapSink& take, const ProgressSink& progress = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// @throws Error (usage) for a product that the scenario, the quantity or the times do not have, a threshold
/// as requireThreshold(), and times that do not ascend
void checkRequest(const CoverageRequest& request, const scenario::Scenario& scenario);

/// Computes maps with the functions of the field: the value of a pixel equals that of `emscape profile`
/// there. Radars look at the target (RadarAim::target), so coverage does not depend on the current direction
/// of a scan. Maps are ordered by time, height (above ground first) and product; those over all times are the
/// last.
/// @param terrain  of the whole map and all platforms; null: a smooth earth
/// @param options  backend, memory and move_tolerance_m; the rest is set here
/// @return warnings, each once, without counts
/// @throws Error (bad_input, usage, device) as FieldSolver does, and for a product that the quantity or the
/// times do not have
std::vector<std::string> computeCoverage(const std::shared_ptr<const scenario::Scenario>& scenario,
                                         const scenario::TerrainPtr& terrain, const MapGrid& grid,
                                         const CoverageRequest& request, const emfield::FieldOptions& options,
                                         const MapSink& take, const ProgressSink& progress = {});

}  // namespace emscape::study
