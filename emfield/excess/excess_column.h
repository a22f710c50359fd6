/// What a model of excess loss is given of a column of the grid: the terrain up to it, and the heights of its
/// voxels.
#pragma once

#include <cstddef>

#include "emfield/models/diffraction.h"
#include "emfield/models/diffraction_sweep.h"
#include "emfield/terrain_fan.h"
#include "emscape/base/host_device.h"

namespace emscape::emfield {

/// A column, or the piece of a leaning one that stands over one point of the ground.
struct ExcessColumn {
  double range_m = 0;      ///< along the ground from the emitter
  float ground_msl_m = 0;  ///< NaN over missing terrain
  TerrainProfile profile;  ///< from the emitter to below the column; no posts for models without terrain
  const float* height_msl_m = nullptr;  ///< of the voxels, rising
  int count = 0;
};

/// What a model says of a column besides its losses: bits of its own, and this one, that terrain is missing.
constexpr unsigned kMissingTerrain = 1u << 31;

/// Some of a column's heights, for a model that fills them by bisection.
struct ColumnPart {
  int begin = 0, end = 0;      ///< heights begin..end - 1; begin is a multiple of kBisectionStep
  float* memory_db = nullptr;  ///< for a height more

  /// Heights of the bisection: up to the first of the next part, of which so many are in question.
  EMSCAPE_HD int reach(int count) const { return (end < count ? end + 1 : count) - begin; }
};

/// Memory for one column at a time, cut from one block: a thread has its own.
struct ExcessScratch {
  double* range_m = nullptr;
  float* ground_msl_m = nullptr;
  float* even_ground_msl_m = nullptr;  ///< for models that want even spacing; a post more
  float* height_msl_m = nullptr;
  float* excess_db = nullptr;
  float* other_db = nullptr;  ///< of a second model
  DiffractionScratch<float> diffraction;

  /// @param posts  of the longest profile
  static EMSCAPE_HD std::size_t bytes(int posts, int layers) {
    return std::size_t(posts) * (sizeof(double) + 7 * sizeof(float) + 2 * sizeof(int)) +
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
    scratch.even_ground_msl_m = take(posts + 1);
    scratch.height_msl_m = take(layers);
    scratch.excess_db = take(layers);
    scratch.other_db = take(layers);
    scratch.diffraction.inverse_range = take(posts);
    scratch.diffraction.lowered_m = take(posts);
    scratch.diffraction.slope = take(posts);
    scratch.diffraction.line_nu = take(posts);
    scratch.diffraction.line_fall = take(posts);
    scratch.diffraction.lowered_hull = reinterpret_cast<int*>(next);
    scratch.diffraction.plain_hull = scratch.diffraction.lowered_hull + posts;
    return scratch;
  }
};

/// Height at any range up to a fan's last, linear between its samples.
/// @param heightOf  height (m) of a sample
template <class HeightOf>
EMSCAPE_HD float heightBetween(const FanView& shape, double range_m, HeightOf heightOf) {
  const int before = shape.lastBefore(range_m);
  const int after = before + 1 < shape.range_count ? before + 1 : before;
  const float low = heightOf(before);
  if (after == before) return low;
  const double part = (range_m - shape.ranges_m[before]) / (shape.ranges_m[after] - shape.ranges_m[before]);
  return low + static_cast<float>(part) * (heightOf(after) - low);
}

/// Heights of some of a fan's intervals, as plain data.
struct FanHeights {
  FanView shape;
  const float* height_msl_m = nullptr;  ///< as TerrainFan::height_msl_m
  int first_interval = 0;
  int interval_count = 0;

  EMSCAPE_HD bool holds(double azimuth_index) const {
    return azimuth_index >= first_interval && azimuth_index < first_interval + interval_count;
  }
  /// Height at a sample's range, linear between the azimuths.
  EMSCAPE_HD float heightAt(double azimuth_index, int range) const {
    const int interval = static_cast<int>(azimuth_index);
    const float weight = static_cast<float>(azimuth_index - interval);
    const float* left =
        height_msl_m + static_cast<std::size_t>(interval - first_interval) * shape.range_count + range;
    const float right = left[shape.range_count];
    return *left + weight * (right - *left);
  }
  /// The same at any range up to the last.
  EMSCAPE_HD float heightAt(double azimuth_index, double range_m) const {
    return heightBetween(shape, range_m, [&](int range) { return heightAt(azimuth_index, range); });
  }
};

/// The profile to a point of the ground: the fan's samples nearer than it, linear between the azimuths, and
/// the point itself. So every column has a profile of its own, and there are no seams between azimuths.
EMSCAPE_HD inline TerrainProfile readProfile(const FanHeights& fan, double azimuth_index, double range_m,
                                             float ground_msl_m, const ExcessScratch& scratch) {
  const int before = fan.shape.lastBefore(range_m);
  const int interval = static_cast<int>(azimuth_index);
  const float weight = static_cast<float>(azimuth_index - interval);
  const float* left =
      fan.height_msl_m + static_cast<std::size_t>(interval - fan.first_interval) * fan.shape.range_count;
  const float* right = left + fan.shape.range_count;
  for (int i = 0; i <= before; ++i) {
    scratch.range_m[i] = fan.shape.ranges_m[i];
    scratch.ground_msl_m[i] = left[i] + weight * (right[i] - left[i]);
  }
  const bool beyond_first = range_m > fan.shape.ranges_m[0];
  const int last = beyond_first ? before + 1 : 0;
  if (beyond_first) {
    scratch.range_m[last] = range_m;
    scratch.ground_msl_m[last] = ground_msl_m;
  }
  return {scratch.range_m, scratch.ground_msl_m, last + 1};
}

}  // namespace emscape::emfield
