/// Cached geometry of an emitter for the combine stage: per column of the grid, and per voxel for models with
/// an excess loss, until the emitter moves.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "emfield/columns/column_geometry.h"
#include "emfield/columns/column_part.h"
#include "emfield/geometry/clutter_map.h"
#include "emfield/ground/terrain_bounds.h"
#include "emscape/base/unset_vector.h"
#include "emscape/propagation/steep_ground.h"
#include "emscape/scenario/model/emitter.h"
#include "emscape/scenario/model/snapshot.h"
#include "emscape/scenario/terrain/terrain.h"

namespace emscape::emfield {

/// Parts of an emitter's geometry that the channels need.
struct GeometryNeeds {
  bool any = false;          ///< columns and excess, for power or echoes
  bool clutter_map = false;  ///< clutter of land and sea
  bool mechanisms = false;   ///< per voxel, of a model with several
};

/// Stages 1 and 2 of one emitter.
class EmitterGeometry {
 public:
  /// Times of the two stages (ms); the second without marches.
  struct Times {
    double columns_ms = 0, march_ms = 0, excess_ms = 0;
    double marched_heights = 0;
    double of_part_ms = 0;  ///< of excess_ms, the part that is proportional to the number of columns
  };

  /// @param emitter  of the scenario
  /// @param terrain  null: smooth earth
  /// @param bounds   of the terrain, for surfaces; null: none
  /// @param part     the columns to compute; the others are interpolated, or known from the call before,
  /// which
  ///                 had the same arguments and the step part.known. All where interpolates() is false
  void compute(const scenario::EmitterState& state, const scenario::Scenario& scenario,
               const scenario::Emitter& emitter, const GridColumns& columns, const scenario::Terrain* terrain,
               Times& times, const TerrainBounds* bounds = nullptr, const GeometryNeeds& needs = {},
               ColumnPart part = {});
  /// True if columns of an emitter can be interpolated: it has a loss or shadow, made column by column,
  /// without lobes.
  static bool interpolates(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                           const GridColumns& columns, const GeometryNeeds& needs);

  ColumnGeometryView view() const;
  /// Of a radar with surface clutter, if it was requested; else without cells.
  ClutterMapView clutterMap() const {
    return clutterMapView(clutter_grid_, clutter_.empty() ? nullptr : clutter_.data());
  }
  /// Columns whose path crosses missing terrain.
  long long unknownColumns() const { return unknown_columns_; }
  bool isUnknown(std::size_t column) const;
  /// Every step-th column in each direction is computed, and the others interpolated; 1: all are.
  int columnStep() const { return column_step_; }
  /// Warning bits of the model on the paths: see warningMessages().
  unsigned warnings() const { return warnings_; }
  /// EmitterExcess::steep.
  const std::shared_ptr<const propagation::SteepGround>& steep() const { return steep_; }

  static constexpr std::size_t kBytesPerColumn = 10 * sizeof(float);
  /// Bytes per voxel of an emitter: its excess, its reflected ray and its mechanism, if its model has them,
  /// and data that the model precomputes for a surface's points.
  /// @param on_surface  GridColumns::every_height
  static std::size_t bytesPerVoxel(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                                   bool on_surface = false, const GeometryNeeds& needs = {});
  /// Bytes per emitter for a grid with these numbers of columns and layers.
  static std::size_t bytesOf(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                             std::size_t columns, int layers, bool on_surface = false,
                             const GeometryNeeds& needs = {});
  std::size_t bytes() const {
    return (arrays_.size() + shadow_edge_m_.size() + excess_db_.size()) * sizeof(float) +
           excess_.size() * sizeof(ExcessCode) + reflected_.size() * sizeof(ReflectedRayCode) +
           mechanisms_.size() + clutter_.size() * sizeof(ClutterCell);
  }

 private:
  void mapClutter(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                  const Station& station, const propagation::PathExtent& extent,
                  const scenario::Terrain* terrain);
  /// @param paths  receives the paths to the columns if these are not tilted; null: not needed
  void locateColumns(const Station& station, const GridColumns& columns, FastInverse* paths);

  std::size_t column_count_ = 0;
  UnsetVector<float> arrays_;  ///< kColumnNumbers x column_count_
  std::vector<float> shadow_edge_m_;
  std::vector<ExcessCode> excess_;           ///< columns x layers, or empty
  UnsetVector<float> excess_db_;             ///< the same over a surface, instead of codes
  std::vector<ReflectedRayCode> reflected_;  ///< the same
  std::vector<std::uint8_t> mechanisms_;     ///< the same
  ClutterGrid clutter_grid_;
  std::vector<ClutterCell> clutter_;  ///< empty: no surface clutter
  long long unknown_columns_ = 0;
  unsigned warnings_ = 0;
  std::shared_ptr<const propagation::SteepGround> steep_;
  int column_step_ = 1;
};

}  // namespace emscape::emfield
