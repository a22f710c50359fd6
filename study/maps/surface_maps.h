/// The maps of a scenario's products at the heights of one reference.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/geodesy/fast_geodesy.h"
#include "emscape/study/maps/coverage.h"
#include "emscape/volume/dense_volume.h"
#include "study/maps/time_figures.h"

namespace emscape::study {

/// True for products that depend on each emitter separately.
bool isPerEmitter(Product product);
/// True for products of the effect of jamming.
bool isOfJamming(Product product);

/// True if a product of the request covers all times.
bool isOverTime(const CoverageRequest& request);

/// A map without values.
/// @param height  none: for all heights
CoverageMap emptyMap(const scenario::Scenario& scenario, const CoverageRequest& request, Product product,
                     const std::optional<MapHeight>& height);
/// The maps that a request makes, with what their file names are made of: product, height and time.
std::vector<CoverageMap> outlinesOf(const CoverageRequest& request);
/// Sets the values of a map, NaN where there is none, and its areas.
void setValues(CoverageMap& map, const MapGrid& grid, std::vector<float> values);

/// A quantity on the surfaces of one reference of height at a time.
struct SurfaceValues {
  struct OfOne {
    int emitter;
    std::shared_ptr<const volume::DenseVolume> values;
    FastGeodesy geodesy;  ///< from its position
  };
  std::shared_ptr<const volume::DenseVolume> all;
  /// Pixels that are unknown to some emitters and have the value of the others: 1; empty: none.
  std::vector<std::uint8_t> partly_unknown;
  std::vector<float> ground_msl_m;                      ///< for heights above the sea; empty: none is known
  std::vector<OfOne> each;                              ///< if a product needs them
  std::shared_ptr<const volume::DenseVolume> unjammed;  ///< if a product needs it
  scenario::TerrainPtr terrain;
};

/// The field of one reference of height, which is kept between times and scenarios.
class SurfaceField {
 public:
  /// @param requests  of one quantity
  SurfaceField(const MapGrid& grid, const std::vector<CoverageRequest>& requests,
               emfield::HeightReference reference, const emfield::FieldOptions& options);

  /// False: no request has a height of the reference.
  bool hasHeights() const { return !options_.surface->heights_m.empty(); }
  /// Of a layer.
  double height_m(std::size_t k) const { return options_.surface->heights_m[k]; }
  /// Index of a height in the values' layers.
  std::size_t layerOf(const MapHeight& height) const;
  SurfaceValues at(const std::shared_ptr<const scenario::Scenario>& scenario,
                   const scenario::TerrainPtr& terrain, double time_s);
  /// Of the last time.
  /// @param steep  receives what is in place of the warnings of steep ground
  std::vector<std::string> warnings(emfield::SteepGrounds& steep) const { return solver_->warnings(&steep); }

 private:
  emfield::FieldOptions options_;
  /// Its channels: all emitters together; each alone, if a product needs it; all without jamming, if a
  /// product needs it.
  std::unique_ptr<emfield::FieldSolver> solver_;
};

/// The maps of a request at the heights of one reference.
class SurfaceMaps {
 public:
  /// @param grid, request  must outlive the maps
  SurfaceMaps(const MapGrid& grid, const CoverageRequest& request, emfield::HeightReference reference,
              const SurfaceField& field);

  /// Begins with a number of scenarios.
  void begin(std::size_t scenarios);
  /// Maps `cause` of a scenario at a time, which are computed path by path.
  std::size_t causeMaps() const;
  /// The maps of a scenario, by its index, at the next time.
  /// @param progress  gets the number of completed maps `cause`, 0..causeMaps()
  void addTime(std::size_t index, const std::shared_ptr<const scenario::Scenario>& scenario,
               const SurfaceValues& values, double time_s, const MapSink& take,
               const std::function<void(double)>& progress);
  /// The maps of a scenario over all times.
  void finish(std::size_t index, const MapSink& take);

 private:
  /// A height, and its index in the layers of values.
  struct Layer {
    MapHeight height;
    std::size_t k;
  };
  /// A scenario between its times.
  struct State {
    std::shared_ptr<const scenario::Scenario> scenario;
    std::vector<TimeFigures> figures;               ///< one per layer
    std::vector<std::vector<PixelAnswer>> answers;  ///< of the last time, one per layer
  };

  bool isCovered(float value) const { return static_cast<double>(value) >= request_.threshold; }

  float valueAt(const volume::DenseVolume& volume, std::size_t k, std::size_t p) const {
    const bool is_valid = volume.first_valid_k.empty() || k >= volume.first_valid_k[p];
    return is_valid ? volume.values[k * grid_.pixels() + p] : NAN;
  }

  /// What the value of all emitters says. That of some of them is an answer if it reaches the threshold.
  PixelAnswer answerAt(const SurfaceValues& values, const Layer& layer, std::size_t p) const;
  std::vector<float> valuesOf(Product product, const SurfaceValues& values, std::size_t k,
                              const std::vector<PixelAnswer>& answers, std::optional<float> floor) const;
  float ofEmitters(Product product, const std::vector<SurfaceValues::OfOne>& each, std::size_t k,
                   std::size_t p) const;

  const CoverageRequest& request_;
  const MapGrid& grid_;
  std::vector<Layer> layers_;
  std::vector<State> states_;  ///< one per scenario
};

}  // namespace emscape::study
