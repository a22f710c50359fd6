/// The maps of a scenario's products at the heights of one reference.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/fast_geodesy.h"
#include "emscape/study/coverage.h"
#include "emscape/volume/dense_volume.h"
#include "study/time_figures.h"

namespace emscape::study {

/// True for products of what each emitter does by itself.
bool isPerEmitter(Product product);
/// True for products of what jamming changes.
bool isOfJamming(Product product);

/// A map without values.
/// @param height  none: for all heights
CoverageMap emptyMap(const scenario::Scenario& scenario, const CoverageRequest& request, Product product,
                     const std::optional<MapHeight>& height);
/// Sets the values of a map, NaN where there is none, and its areas.
void setValues(CoverageMap& map, const MapGrid& grid, std::vector<float> values);

/// The maps of one reference of height. The field is kept from scenario to scenario.
class SurfaceMaps {
 public:
  /// @param grid, request  must outlive the maps
  SurfaceMaps(const MapGrid& grid, const CoverageRequest& request, emfield::HeightReference reference,
              const emfield::FieldOptions& options);

  /// Begins with a number of scenarios.
  void begin(std::size_t scenarios);
  /// The maps of a scenario, by its index, at the next time.
  void addTime(std::size_t index, const std::shared_ptr<const scenario::Scenario>& scenario,
               const scenario::TerrainPtr& terrain, double time_s, const MapSink& take);
  /// The maps of a scenario over all times.
  void finish(std::size_t index, const MapSink& take);
  /// Of a scenario, after its last time.
  const std::vector<std::string>& warnings(std::size_t index) const { return states_[index].warnings; }

 private:
  /// A scenario between its times.
  struct State {
    std::shared_ptr<const scenario::Scenario> scenario;
    std::vector<TimeFigures> figures;  ///< one per height
    std::shared_ptr<const volume::DenseVolume> last;
    std::vector<std::string> warnings;
  };
  struct ValuesOfOne {
    int emitter;
    std::shared_ptr<const volume::DenseVolume> values;
    FastGeodesy geodesy;  ///< from its position
  };
  /// The quantity at a time.
  struct Values {
    std::shared_ptr<const volume::DenseVolume> all, unjammed;
    std::vector<ValuesOfOne> each;
  };

  bool isOverTime() const {
    return std::any_of(request_.products.begin(), request_.products.end(),
                       [](Product product) { return info(product).over_time; });
  }
  bool isCovered(float value) const { return static_cast<double>(value) >= request_.threshold; }

  float valueAt(const volume::DenseVolume& volume, std::size_t k, std::size_t p) const {
    const bool is_valid = volume.first_valid_k.empty() || k >= volume.first_valid_k[p];
    return is_valid ? volume.values[k * grid_.pixels() + p] : NAN;
  }

  float valueOf(Product product, const Values& values, std::size_t k, std::size_t p) const;
  float ofEmitters(Product product, const std::vector<ValuesOfOne>& each, std::size_t k, std::size_t p) const;

  const CoverageRequest& request_;
  const MapGrid& grid_;
  emfield::FieldOptions options_;
  std::vector<MapHeight> heights_;
  /// Its first channel is of all emitters, those after it of one each.
  std::optional<emfield::FieldSolver> solver_;
  std::vector<State> states_;  ///< one per scenario
};

}  // namespace emscape::study
