/// Inputs of an excess-loss model for one column of the grid: the terrain profile up to the column and the
/// heights of its voxels.
#pragma once

#include <cstddef>

#include "emscape/base/host_device.h"
#include "propagation/terrain_profile.h"

namespace emscape::propagation {

/// A column, or the segment of a tilted one above one point of the ground.
struct ExcessColumn {
  double range_m = 0;      ///< along the ground from the emitter
  double azimuth_rad = 0;  ///< from the emitter, clockwise from north, -pi .. pi
  float ground_msl_m = 0;  ///< NaN over missing terrain
  TerrainProfile profile;  ///< from the emitter to below the column; no posts for models without terrain
  const float* height_msl_m = nullptr;  ///< of the voxels, ascending
  int count = 0;
  /// True: models evaluate every height. False: they may interpolate between some.
  bool every_height = false;
  std::size_t position = 0;  ///< index of the column in its grid

  /// The tolerance of an interpolation between heights; negative if every height is evaluated.
  EMSCAPE_HD float tolerance_db(float of_model_db) const { return every_height ? -1.0f : of_model_db; }
};

/// Warning bit that models return for missing terrain; their other bits are specific to the model.
constexpr unsigned kMissingTerrain = 1u << 31;

/// Some of a column's heights, for a model that fills them by bisection.
struct ColumnPart {
  int begin = 0, end = 0;      ///< heights begin..end - 1; begin is a multiple of kBisectionStep
  float* memory_db = nullptr;  ///< for one more height

  /// Number of heights of the bisection, including the first of the next part.
  EMSCAPE_HD int reach(int count) const { return (end < count ? end + 1 : count) - begin; }
};

/// Scratch memory for one column at a time, in one block; one per thread.
struct ExcessScratch {
  double* range_m = nullptr;
  float* ground_msl_m = nullptr;
  float* raised_msl_m = nullptr;       ///< ground_msl_m with clutter
  float* cover_m = nullptr;            ///< see TerrainProfile
  float* even_ground_msl_m = nullptr;  ///< for models that need even spacing; size: posts + 1
  float* height_msl_m = nullptr;
  float* excess_db = nullptr;
  float* other_db = nullptr;      ///< of a second model
  float* post_numbers = nullptr;  ///< kPostNumbers arrays of `posts` elements, for the model
  int posts = 0;

  static constexpr int kPostNumbers = 2;

  /// @param posts  of the longest profile
  static EMSCAPE_HD std::size_t bytes(int posts, int layers) {
    return std::size_t(posts) * (sizeof(double) + (4 + kPostNumbers) * sizeof(float)) +
           3 * sizeof(float) * std::size_t(layers) + sizeof(float) + sizeof(double);
  }
  /// @param memory  bytes(posts, layers), aligned for double
  static EMSCAPE_HD ExcessScratch in(void* memory, int posts, int layers) {
    ExcessScratch scratch;
    scratch.range_m = static_cast<double*>(memory);
    float* next = reinterpret_cast<float*>(scratch.range_m + posts);
    const auto take = [&next](int count) {
      float* const taken = next;
      next += count;
      return taken;
    };
    scratch.ground_msl_m = take(posts);
    scratch.raised_msl_m = take(posts);
    scratch.cover_m = take(posts);
    scratch.even_ground_msl_m = take(posts + 1);
    scratch.height_msl_m = take(layers);
    scratch.excess_db = take(layers);
    scratch.other_db = take(layers);
    scratch.posts = posts;
    scratch.post_numbers = take(kPostNumbers * posts);
    return scratch;
  }
};

}  // namespace emscape::propagation
