/// Maps of coverage: a quantity on surfaces above ground or sea, and what follows from it over time.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/progress.h"
#include "emscape/emfield/field_solver.h"
#include "emscape/scenario/terrain.h"
#include "emscape/study/map.h"
#include "emscape/study/map_grid.h"
#include "emscape/study/products.h"

namespace emscape::study {

struct CoverageRequest {
  std::vector<MapHeight> heights;
  std::vector<Product> products;
  scenario::Quantity quantity = scenario::Quantity::detection_probability;
  double threshold = 0.5;
  std::vector<double> times_s;  ///< rising
};

/// A map of a product, at a height or for all, at a time or over all. Values are NaN in pixels that are left
/// out, below ground or unknown.
struct CoverageMap : Map {
  Product product = Product::value;
  double known_area_m2 = 0;  ///< of the pixels with a value
  double class_area_m2 = 0;  ///< of ProductInfo::area_class; 0 for products without one
};

/// The default threshold: 0.5 of a probability, 0 dB of a margin or ratio over a required level; none for
/// others.
std::optional<double> defaultThreshold(scenario::Quantity quantity);

/// Takes a finished map; called by the thread that computes.
using MapSink = std::function<void(CoverageMap)>;

/// The same for a map of one of several scenarios and requests, by their indices.
using ScenarioMapSink = std::function<void(std::size_t scenario, std::size_t request, CoverageMap)>;

/// Computes maps of one scenario after another on the same pixels and keeps the field between them: of a
/// scenario that differs from the one before, only what the difference invalidates is computed
/// (FieldSolver::update). The maps are those of computeCoverage(). One thread calls it.
class CoverageSolver {
 public:
  /// @param grid      must outlive the solver
  /// @param requests  one or more, of one quantity and the same times: they share its field
  /// @param options   backend, memory and move_tolerance_m; the rest is set here
  CoverageSolver(const MapGrid& grid, std::vector<CoverageRequest> requests,
                 const emfield::FieldOptions& options);
  ~CoverageSolver();

  /// Computes several scenarios together, all of them at the first time, then at the next: where platforms
  /// move, scenarios of the same tracks share the geometry of each time. Memory for products over time grows
  /// with their number.
  /// @param terrain  of the whole map and all platforms; null: a smooth earth. Another object than before is
  /// another terrain
  /// @return warnings of each scenario
  /// @throws Error (bad_input, usage, device) as FieldSolver does, and for a product that the quantity or the
  /// times do not have
  std::vector<std::vector<std::string>> compute(
      const std::vector<std::shared_ptr<const scenario::Scenario>>& scenarios,
      const scenario::TerrainPtr& terrain, const ScenarioMapSink& take, const ProgressSink& progress = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// @throws Error (usage) for a product that the scenario, the quantity or the times do not have
void checkRequest(const CoverageRequest& request, const scenario::Scenario& scenario);

/// Computes maps by the field's own functions at every pixel: a pixel's value is that of `emscape profile`
/// there. Looks are at the target (RadarLook::target): coverage does not depend on where a scan happens to
/// point. Maps come by time, height (those above ground first) and product; those over all times at last.
/// @param terrain  of the whole map and all platforms; null: a smooth earth
/// @param options  backend, memory and move_tolerance_m; the rest is set here
/// @return warnings
/// @throws Error (bad_input, usage, device) as FieldSolver does, and for a product that the quantity or the
/// times do not have
std::vector<std::string> computeCoverage(const std::shared_ptr<const scenario::Scenario>& scenario,
                                         const scenario::TerrainPtr& terrain, const MapGrid& grid,
                                         const CoverageRequest& request, const emfield::FieldOptions& options,
                                         const MapSink& take, const ProgressSink& progress = {});

}  // namespace emscape::study
