/// Stage 2 of the models with an excess loss: fills the voxels of columns. The other stages do not depend on
/// the model.
#pragma once

#include <cmath>
#include <cstdint>

#include "emfield/columns/column_part.h"
#include "emfield/columns/excess_code.h"
#include "emfield/columns/foot_inverse.h"
#include "emfield/columns/grid_columns.h"
#include "emfield/columns/station.h"
#include "emfield/columns/two_rays.h"
#include "emfield/excess/emitter_excess.h"
#include "emfield/ground/ground_posts.h"
#include "emfield/ground/terrain_bounds.h"
#include "emscape/base/host_device.h"

namespace emscape::emfield {

using propagation::AirLoss;
using propagation::ExcessColumn;

/// The columns of a grid, as plain data.
struct ExcessGrid {
  ColumnsView columns;
  std::size_t column_count = 0;
  const float* t_m = nullptr;
  int layers = 0;
  bool tilted = false;        ///< columns are not vertical
  bool every_height = false;  ///< see ExcessColumn
  /// Ground below each column; null: read at the end of each profile (tilted columns), or none.
  const float* ground_msl_m = nullptr;
  /// Paths from the station to each column, if known and the columns are not tilted; null: they are computed.
  const FastInverse* paths = nullptr;
  /// Lowest layer of each column that counts; null: all do.
  const std::uint16_t* first_valid_k = nullptr;
  /// Number of segments of a tilted column, each above one point of the ground; 1 for vertical columns.
  int segments = 1;
  Dims dims;        ///< of the grid
  ColumnPart part;  ///< columns that are filled; on a GPU by `diffraction` and `horizon`, without `known`

  EMSCAPE_HD int firstLayer(int segment) const {
    return static_cast<int>(static_cast<long long>(layers) * segment / segments);
  }
  /// The first layer of a column that counts.
  EMSCAPE_HD int firstValid(std::size_t column) const {
    if (first_valid_k == nullptr) return 0;
    return first_valid_k[column] < layers ? first_valid_k[column] : layers;
  }
  /// True if no layer of a column counts, for a reason other than missing terrain, which is reported. For a
  /// tilted column terrain may be missing anywhere.
  EMSCAPE_HD bool isLeftOut(std::size_t column) const {
    return !tilted && first_valid_k != nullptr && first_valid_k[column] >= layers && !isWithoutGround(column);
  }
  /// True if terrain is missing below a column that is not tilted: every path to it is unknown to the models
  /// that need terrain.
  EMSCAPE_HD bool isWithoutGround(std::size_t column) const {
    return ground_msl_m != nullptr && ground_msl_m[column] != ground_msl_m[column];
  }
  /// Distance and azimuth from a station to the point below the middle of a segment.
  EMSCAPE_HD FastInverse coordinatesOf(const Station& station, std::size_t column, int segment) const {
    if (paths != nullptr) return paths[column];
    const auto first_m = static_cast<double>(t_m[firstLayer(segment)]);
    const auto last_m = static_cast<double>(t_m[firstLayer(segment + 1) - 1]);
    return footInverse(station, columns[column], (first_m + last_m) / 2);
  }
};

/// The columns of a grid, in host memory.
/// @param terrain  null: none
ExcessGrid excessGrid(const GridColumns& columns, const scenario::Terrain* terrain);

/// Heights (m above mean sea level) of a column's points at some t. By vector instructions.
void heightsMslCpu(const GridColumn& column, const float* t_m, int count, float* height_msl_m);

/// The losses of the air on a path and of the clutter at its ends, which are added to a model's excess.
struct PathEnds {
  const AirLoss& air;
  const propagation::TerminalClutter& terminal;
  propagation::AirColumn above;
  float range_m, ground_msl_m;  ///< of the far end

  EMSCAPE_HD PathEnds(const AirLoss& of_air, const propagation::TerminalClutter& of_ends, float at_m,
                      float ground_m)
      : air(of_air), terminal(of_ends), above(of_air, at_m), range_m(at_m), ground_msl_m(ground_m) {}

  EMSCAPE_HD bool areFree() const { return air.isClear() && !terminal.isSet(); }
  EMSCAPE_HD float withTerminalDb(float excess_db, float height_msl_m) const {
    return terminal.isSet() ? terminal.withLossDb(excess_db, range_m, height_msl_m - ground_msl_m)
                            : excess_db;
  }
  EMSCAPE_HD float added(float excess_db, float height_msl_m) const {
    const float with_db = withTerminalDb(excess_db, height_msl_m);
    return air.isClear() ? with_db : with_db + above.lossDb(height_msl_m);
  }
};
/// Adds the atmospheric attenuation at these heights. By vector instructions.
void addAirCpu(const AirLoss& air, float range_m, const GridColumn& column, const float* t_m, int count,
               float* excess_db);

/// One emitter. A model is a plain struct: see excess_model.h.
template <class Model>
struct ExcessTask {
  Model model;
  AirLoss air;
  Station station;
  ExcessGrid grid;
  GroundPosts ground;  ///< for models that need terrain
  propagation::TerminalClutter terminal = {};

  /// Posts of the longest profile.
  int posts() const { return maxPosts(station, ground, propagation::ReadsCrossings<Model>::value); }

  /// Builds the ExcessColumn of a segment of a column.
  /// @param read  see readProfile()
  template <class Reader>
  EMSCAPE_HD ExcessColumn readSegment(std::size_t c, int segment, const ExcessScratch& scratch,
                                      const Reader& read) const {
    ExcessColumn part;
    const int first = grid.firstLayer(segment);
    const FastInverse point = grid.coordinatesOf(station, c, segment);
    part.position = c;
    part.range_m = point.distance_m;
    part.azimuth_rad = std::atan2(point.sin_azimuth, point.cos_azimuth);
    part.height_msl_m = scratch.height_msl_m + first;
    part.count = grid.firstLayer(segment + 1) - first;
    part.every_height = grid.every_height;
    if constexpr (Model::kNeedsTerrain) {
      part.ground_msl_m =
          grid.ground_msl_m != nullptr ? grid.ground_msl_m[c] : groundAt(station, ground, point);
      part.profile = readProfile(station, ground, point, part.ground_msl_m, scratch, read);
    }
    const GridColumn column = grid.columns[c];
    float* const height_msl_m = scratch.height_msl_m + first;
#ifdef __CUDA_ARCH__
    for (int k = 0; k < part.count; ++k) {
      height_msl_m[k] = static_cast<float>(heightMsl_m(column, static_cast<double>(grid.t_m[first + k])));
    }
#else
    heightsMslCpu(column, grid.t_m + first, part.count, height_msl_m);
#endif
    if (propagation::OnEffectiveEarth<Model>::value && station.refraction.exponential) {
      for (int k = 0; k < part.count; ++k) {
        height_msl_m[k] = modelHeight_m(part.range_m, height_msl_m[k]);
      }
    }
    return part;
  }

  /// Height of a voxel, as input of the model.
  EMSCAPE_HD float modelHeight_m(double range_m, float height_msl_m) const {
    if constexpr (propagation::OnEffectiveEarth<Model>::value) {
      if (station.refraction.exponential) {
        return static_cast<float>(station.refraction.effectiveHeight_m(static_cast<double>(height_msl_m),
                                                                       station.height_msl_m, range_m));
      }
    }
    return height_msl_m;
  }

  /// Adds the other losses (PathEnds) at some heights of a segment.
  EMSCAPE_HD void addEnds(std::size_t c, int segment, const ExcessColumn& part, int begin, int end,
                          float* excess_db) const {
    float ground_msl_m = part.ground_msl_m;
    if (!Model::kNeedsTerrain && terminal.isSet()) {
      ground_msl_m = grid.ground_msl_m != nullptr
                         ? grid.ground_msl_m[c]
                         : groundAt(station, ground, grid.coordinatesOf(station, c, segment));
    }
    const PathEnds ends(air, terminal, static_cast<float>(part.range_m), ground_msl_m);
    if (ends.areFree()) return;
    const float* const t_m = grid.t_m + grid.firstLayer(segment);
    const auto heightOf = [&](int k) {
      return static_cast<float>(heightMsl_m(grid.columns[c], static_cast<double>(t_m[k])));
    };
#ifdef __CUDA_ARCH__
    for (int k = begin; k < end; ++k) excess_db[k] = ends.added(excess_db[k], heightOf(k));
#else
    for (int k = begin; terminal.isSet() && k < end; ++k)
      excess_db[k] = ends.withTerminalDb(excess_db[k], heightOf(k));
    if (!air.isClear())
      addAirCpu(air, ends.range_m, grid.columns[c], t_m + begin, end - begin, excess_db + begin);
#endif
  }

  /// Fills scratch.excess_db with the excess of a column's voxels, lowest first.
  /// @param reflected   dense order; receives the column's reflected rays if the model has any
  /// @param mechanisms  dense order; receives its mechanisms if the model has several; null: not needed
  /// @return warning bits of the model
  template <class Reader>
  EMSCAPE_HD unsigned fillColumn(std::size_t c, const ExcessScratch& scratch, const Reader& read,
                                 ReflectedRayCode* reflected, std::uint8_t* mechanisms) const {
    unsigned warnings = 0;
    for (int segment = 0; segment < grid.segments; ++segment) {
      const ExcessColumn part = readSegment(c, segment, scratch, read);
      const int first = grid.firstLayer(segment);
      float* const excess_db = scratch.excess_db + first;
      if constexpr (propagation::Reflects<Model>::value) {
        for (int k = 0; k < part.count; ++k) {
          // Lobes are narrow, so each voxel of a tilted column has its own range.
          const double range_m =
              grid.tilted
                  ? footInverse(station, grid.columns[c], static_cast<double>(grid.t_m[first + k])).distance_m
                  : part.range_m;
          reflected[static_cast<std::size_t>(first + k) * grid.column_count + c] =
              reflectedRayCode(model.reflectedRay(range_m, part.height_msl_m[k], excess_db[k]));
        }
      } else if constexpr (propagation::HasMechanisms<Model>::value) {
        std::uint8_t* const lowest =
            mechanisms == nullptr ? nullptr
                                  : mechanisms + static_cast<std::size_t>(first) * grid.column_count + c;
        warnings |= model(part, scratch, excess_db, {lowest, grid.column_count});
      } else {
        warnings |= model(part, scratch, excess_db);
      }
      addEnds(c, segment, part, 0, part.count, excess_db);
    }
    return warnings;
  }
};

/// Arrays of the results: dense order, the columns of a layer one after another.
struct ExcessOutput {
  ExcessStore excess;
  ReflectedRayCode* reflected = nullptr;  ///< of models with a reflected ray
  std::uint8_t* mechanisms = nullptr;     ///< of models with several; null: not needed
  float* shadow_edge_m = nullptr;         ///< set to NaN where terrain is missing: the column is unknown

  EMSCAPE_HD void markUnknown(std::size_t column) const { shadow_edge_m[column] = NAN; }
};

/// Runs a task on the CPU.
/// @param bounds  of the terrain, for surfaces; null: none
/// @return the models' warnings on all columns
unsigned fillExcessCpu(const EmitterExcess& excess, const Station& station, const ExcessGrid& grid,
                       const GroundPosts& ground, const TerrainBounds* bounds, const ExcessOutput& out);

}  // namespace emscape::emfield
