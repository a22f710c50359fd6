/// Stage 2 of the models with an excess loss: fills the voxels of columns. The other stages do not depend on
/// the model.
#pragma once

#include <cmath>

#include "emfield/emitter_excess.h"
#include "emfield/excess_code.h"
#include "emfield/fan_heights.h"
#include "emfield/grid_columns.h"
#include "emfield/station.h"
#include "emfield/two_rays.h"
#include "emscape/base/host_device.h"

namespace emscape::emfield {

using propagation::AirLoss;
using propagation::ExcessColumn;

/// The columns of a grid, as plain data.
struct ExcessGrid {
  const GridColumn* columns = nullptr;
  std::size_t column_count = 0;
  const float* t_m = nullptr;
  int layers = 0;
  /// Ground below each column; null: taken from the fan (tilted columns), or none.
  const float* ground_msl_m = nullptr;
  /// Number of segments of a tilted column, each above one point of the ground; 1 for vertical columns.
  int segments = 1;

  EMSCAPE_HD int firstLayer(int segment) const {
    return static_cast<int>(static_cast<long long>(layers) * segment / segments);
  }
  /// Azimuth and range of a segment from a station.
  EMSCAPE_HD FanCoordinates coordinatesOf(const Station& station, std::size_t column, int segment) const {
    const auto first_m = static_cast<double>(t_m[firstLayer(segment)]);
    const auto last_m = static_cast<double>(t_m[firstLayer(segment + 1) - 1]);
    return fanCoordinates(station, columns[column], (first_m + last_m) / 2);
  }
};

/// The columns of a grid, in host memory.
ExcessGrid excessGrid(const GridColumns& columns, const FanResolution& resolution);

/// One emitter over some intervals of its fan. A model is a plain struct: see excess_model.h.
template <class Model>
struct ExcessTask {
  Model model;
  AirLoss air;
  Station station;
  ExcessGrid grid;
  FanHeights fan;  ///< for models that need terrain

  /// Posts of the longest profile.
  int posts() const { return fan.shape.range_count + 1; }

  /// Builds the ExcessColumn of a segment of a column. @return false if the column is outside the fan's
  /// intervals
  EMSCAPE_HD bool readSegment(std::size_t c, int segment, const ExcessScratch& scratch,
                              ExcessColumn& part) const {
    const int first = grid.firstLayer(segment);
    const FanCoordinates point = grid.coordinatesOf(station, c, segment);
    part.range_m = point.range_m;
    part.height_msl_m = scratch.height_msl_m + first;
    part.count = grid.firstLayer(segment + 1) - first;
    if constexpr (Model::kNeedsTerrain) {
      const double azimuth_index = fan.shape.azimuthIndex(point.azimuth_rad);
      if (!fan.holds(azimuth_index)) return false;
      part.ground_msl_m =
          grid.ground_msl_m != nullptr ? grid.ground_msl_m[c] : fan.heightAt(azimuth_index, point.range_m);
      part.profile = readProfile(fan, azimuth_index, point.range_m, part.ground_msl_m, scratch);
    }
    for (int k = 0; k < part.count; ++k) {
      const auto t_m = static_cast<double>(grid.t_m[first + k]);
      scratch.height_msl_m[first + k] = static_cast<float>(heightMsl_m(grid.columns[c], t_m));
    }
    return true;
  }

  /// Adds the attenuation by the air at some heights of a segment.
  EMSCAPE_HD void addAir(const ExcessColumn& part, int begin, int end, float* excess_db) const {
    if (air.isClear()) return;
    for (int k = begin; k < end; ++k) {
      excess_db[k] += air.lossDb(static_cast<float>(part.range_m), part.height_msl_m[k]);
    }
  }

  /// Fills scratch.excess_db with the excess of a column's voxels, lowest first.
  /// @param reflected  dense order; receives the column's reflected rays if the model has any
  /// @return false if the column is outside the fan's intervals; `warnings` receives the bits of the model
  EMSCAPE_HD bool fillColumn(std::size_t c, const ExcessScratch& scratch, ReflectedRayCode* reflected,
                             unsigned& warnings) const {
    for (int segment = 0; segment < grid.segments; ++segment) {
      ExcessColumn part;
      if (!readSegment(c, segment, scratch, part)) return false;
      const int first = grid.firstLayer(segment);
      float* const excess_db = scratch.excess_db + first;
      if constexpr (propagation::Reflects<Model>::value) {
        for (int k = 0; k < part.count; ++k) {
          reflected[static_cast<std::size_t>(first + k) * grid.column_count + c] =
              reflectedRayCode(model.reflectedRay(part.range_m, part.height_msl_m[k], excess_db[k]));
        }
      } else {
        warnings |= model(part, scratch, excess_db);
      }
      addAir(part, 0, part.count, excess_db);
    }
    return true;
  }
};

/// Arrays of the results: dense order, the columns of a layer one after another.
struct ExcessOutput {
  ExcessCode* codes = nullptr;
  ReflectedRayCode* reflected = nullptr;  ///< of models with a reflected ray
  float* shadow_edge_m = nullptr;         ///< set to NaN where terrain is missing: the column is unknown

  EMSCAPE_HD void markUnknown(std::size_t column) const { shadow_edge_m[column] = NAN; }
};

/// Runs a task on the CPU.
/// @return the models' warnings on all columns
unsigned fillExcessCpu(const EmitterExcess& excess, const Station& station, const ExcessGrid& grid,
                       const FanHeights& fan, const ExcessOutput& out);

}  // namespace emscape::emfield
