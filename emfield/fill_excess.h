/// Stage 2 of the models with an excess loss: fills the voxels of columns. Nothing else in the pipeline knows
/// which model ran.
#pragma once

#include <cmath>

#include "emfield/emitter_excess.h"
#include "emfield/excess_code.h"
#include "emfield/fan_heights.h"
#include "emfield/grid_columns.h"
#include "emfield/station.h"
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

  /// Reads what a model is told of a piece of a column.
  /// @return false if the column lies beyond the fan's intervals
  EMSCAPE_HD bool readPiece(std::size_t c, int piece, const ExcessScratch& scratch,
                            ExcessColumn& part) const {
    const int first = grid.firstLayer(piece);
    const FanCoordinates point = grid.placeOf(station, c, piece);
    part.range_m = point.range_m;
    part.height_msl_m = scratch.height_msl_m + first;
    part.count = grid.firstLayer(piece + 1) - first;
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

  /// What air adds to some heights of a piece.
  EMSCAPE_HD void addAir(const ExcessColumn& part, int begin, int end, float* excess_db) const {
    if (air.isClear()) return;
    for (int k = begin; k < end; ++k) {
      excess_db[k] += air.lossDb(static_cast<float>(part.range_m), part.height_msl_m[k]);
    }
  }

  /// Fills scratch.excess_db with the excess of a column's voxels, lowest first.
  /// @return false if the column lies beyond the fan's intervals; `remarks` gets bits of the model
  EMSCAPE_HD bool fillColumn(std::size_t c, const ExcessScratch& scratch, unsigned& remarks) const {
    for (int piece = 0; piece < grid.pieces; ++piece) {
      ExcessColumn part;
      if (!readPiece(c, piece, scratch, part)) return false;
      float* const excess_db = scratch.excess_db + grid.firstLayer(piece);
      remarks |= model(part, scratch, excess_db);
      addAir(part, 0, part.count, excess_db);
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
