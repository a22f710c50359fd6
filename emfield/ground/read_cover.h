/// Clutter heights of the land cover on the CPU: tables of its classes, and heights of many posts at once.
#pragma once

#include <array>
#include <cstdint>

#include "emfield/ground/ground_posts.h"

namespace emscape::emfield {

/// Covers of classes (TerrainProfile::cover_m) by the cells' indices of classes. Immutable once made.
class ClassCovers {
 public:
  explicit ClassCovers(const scenario::LandCoverView& cover);

  /// Reads the covers of cells; -1: outside.
  void read(const std::uint8_t* cells, const int* cell, const float* ground_msl_m, int count,
            float* cover_m) const;
  bool isWater(std::uint8_t cell) const {
    return of_cell_[cell] == kLowWater || of_cell_[cell] == propagation::kSeaCover;
  }
  /// Clutter height: 0 on water and where no class is known.
  float raise_m(std::uint8_t cell) const { return of_cell_[cell] > 0 ? of_cell_[cell] : 0; }
  /// Largest of all classes.
  float highest_m() const;

 private:
  static constexpr float kLowWater = -2;  ///< sea where the ground is low

  std::array<float, 256> of_cell_{};
};

/// readCover() by vector instructions.
/// @param classes  of the ground's land cover
void readCoverCpu(const Station& station, const GroundPosts& ground, const FastInverse& path,
                  const ClassCovers& classes, const double* ranges_m, const float* ground_msl_m, int count,
                  float* cover_m);

}  // namespace emscape::emfield
