/// What the combine stage keeps of an emitter's place: per column of the grid, and per voxel for models with
/// an excess loss, until the emitter moves.
#pragma once

#include <vector>

#include "emfield/column_geometry.h"
#include "emfield/terrain_fan.h"
#include "emscape/scenario/emitter.h"
#include "emscape/scenario/snapshot.h"

namespace emscape::emfield {

/// Stages 1 and 2 of one emitter.
class EmitterGeometry {
 public:
  /// Milliseconds that the two stages took.
  struct Times {
    double fan_ms = 0, plane_ms = 0;
  };

  /// @param emitter  of the scenario
  /// @param terrain  null: smooth earth
  void compute(const scenario::EmitterState& state, const scenario::Scenario& scenario,
               const scenario::Emitter& emitter, const GridColumns& columns, const scenario::Terrain* terrain,
               const FanResolution& resolution, Times& times);

  ColumnGeometryView view() const;
  /// Columns whose path crosses missing terrain.
  long long unknownColumns() const { return unknown_columns_; }
  bool isUnknown(std::size_t column) const;
  /// What the model remarks on the paths: see remarkMessages().
  unsigned remarks() const { return remarks_; }

  static constexpr std::size_t kBytesPerColumn = 10 * sizeof(float);
  /// Bytes that an emitter takes, of a grid with so many columns and layers.
  static std::size_t bytesOf(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                             std::size_t columns, int layers);
  std::size_t bytes() const {
    return (arrays_.size() + shadow_edge_m_.size()) * sizeof(float) + excess_.size() * sizeof(ExcessCode);
  }

 private:
  void locateColumns(const Station& station, const GridColumns& columns,
                     const std::vector<FanCoordinates>& coordinates);

  std::size_t column_count_ = 0;
  std::vector<float> arrays_;  ///< kColumnNumbers x column_count_
  std::vector<float> shadow_edge_m_;
  std::vector<ExcessCode> excess_;  ///< columns x layers, or empty
  long long unknown_columns_ = 0;
  unsigned remarks_ = 0;
};

}  // namespace emscape::emfield
