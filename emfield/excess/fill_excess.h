/// Stage 2 of the models with an excess loss: fills the voxels of columns. Nothing else in the pipeline knows
/// which model ran.
#pragma once

#include <cmath>

#include "base/host_device.h"
#include "emfield/excess/excess_code.h"
#include "emfield/excess/excess_column.h"
#include "emfield/excess/excess_model.h"
#include "emfield/grid_columns.h"
#include "emfield/station.h"

namespace emscape::emfield {

/// The columns of a grid, as plain data.
struct ExcessGrid {
  const GridColumn* columns = nullptr;
  std::size_t column_count = 0;
  const float* t_m = nullptr;
  int layers = 0;
  /// Ground below each column; null: taken from the fan (columns that lean), or none.
  const float* ground_msl_m = nullptr;
  /// Leaning columns are cut into as many pieces, each over one point of the ground.
  int pieces = 1;

  EMSCAPE_HD int firstLayer(int piece) const {
    return static_cast<int>(static_cast<long long>(layers) * piece / pieces);
  }
  /// Where a piece stands as seen from a station.
  EMSCAPE_HD FanCoordinates placeOf(const Station& station, std::size_t column, int piece) const {
    const auto first_m = static_cast<double>(t_m[firstLayer(piece)]);
    const auto last_m = static_cast<double>(t_m[firstLayer(piece + 1) - 1]);
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

  /// Fills scratch.excess_db with the excess of a column's voxels, lowest first.
  /// @return false if the column lies beyond the fan's intervals; `remarks` gets bits of the model
  EMSCAPE_HD bool fillColumn(std::size_t c, const ExcessScratch& scratch, unsigned& remarks) const {
    const GridColumn& column = grid.columns[c];
    for (int k = 0; k < grid.layers; ++k) {
      scratch.height_msl_m[k] = static_cast<float>(heightMsl_m(column, static_cast<double>(grid.t_m[k])));
    }
    for (int piece = 0; piece < grid.pieces; ++piece) {
      const int first = grid.firstLayer(piece), end = grid.firstLayer(piece + 1);
      const FanCoordinates point = grid.placeOf(station, c, piece);
      ExcessColumn part;
      part.range_m = point.range_m;
      part.height_msl_m = scratch.height_msl_m + first;
      part.count = end - first;
      if constexpr (Model::kNeedsTerrain) {
        const double azimuth_index = fan.shape.azimuthIndex(point.azimuth_rad);
        if (!fan.holds(azimuth_index)) return false;
        part.ground_msl_m =
            grid.ground_msl_m != nullptr ? grid.ground_msl_m[c] : fan.heightAt(azimuth_index, point.range_m);
        part.profile = readProfile(fan, azimuth_index, point.range_m, part.ground_msl_m, scratch);
      }
      remarks |= model(part, scratch, scratch.excess_db + first);
      if (air.isClear()) continue;
      for (int k = first; k < end; ++k) {
        scratch.excess_db[k] += air.lossDb(static_cast<float>(point.range_m), scratch.height_msl_m[k]);
      }
    }
    return true;
  }
};

/// Where the results go: dense order, the columns of a layer one after another.
struct ExcessOutput {
  ExcessCode* codes = nullptr;
  float* shadow_edge_m = nullptr;  ///< set to NaN where terrain is missing: the column is unknown

  EMSCAPE_HD void markUnknown(std::size_t column) const { shadow_edge_m[column] = NAN; }
};

/// Runs a task on the CPU.
/// @return the models' remarks on all columns
unsigned fillExcessCpu(const EmitterExcess& excess, const Station& station, const ExcessGrid& grid,
                       const FanHeights& fan, const ExcessOutput& out);

}  // namespace emscape::emfield
