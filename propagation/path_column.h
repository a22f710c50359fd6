/// One path as a column of one voxel, from which models explain the parts of its loss.
#pragma once

#include <vector>

#include "propagation/column.h"

namespace emscape::propagation {

/// Not copied: its column points into its memory.
class PathColumn {
 public:
  /// @param profile      from the emitter to below the path's end; must outlive this object
  /// @param azimuth_rad  of the path
  PathColumn(const TerrainProfile& profile, double range_m, double end_msl_m, double azimuth_rad = 0)
      : memory_(ExcessScratch::bytes(profile.count + 1, 1) / sizeof(double) + 1),
        scratch_(ExcessScratch::in(memory_.data(), profile.count + 1, 1)) {
    scratch_.height_msl_m[0] = static_cast<float>(end_msl_m);
    column_.range_m = range_m;
    column_.azimuth_rad = azimuth_rad;
    column_.ground_msl_m = profile.height_msl_m[profile.count - 1];
    column_.profile = profile;
    column_.height_msl_m = scratch_.height_msl_m;
    column_.count = 1;
  }
  PathColumn(const PathColumn&) = delete;
  PathColumn& operator=(const PathColumn&) = delete;

  /// Excess (dB) by a model's function for columns.
  template <class Model>
  double excess_db(const Model& model) {
    warnings_ |= model(column_, scratch_, scratch_.excess_db);
    return static_cast<double>(scratch_.excess_db[0]);
  }
  /// Adds warnings of a model that has no function for columns.
  void addWarnings(unsigned warnings) { warnings_ |= warnings; }
  const ExcessColumn& column() const { return column_; }
  /// Warnings of all models evaluated so far.
  unsigned warnings() const { return warnings_; }

 private:
  std::vector<double> memory_;
  ExcessScratch scratch_;
  ExcessColumn column_;
  unsigned warnings_ = 0;
};

}  // namespace emscape::propagation
