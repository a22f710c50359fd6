/// Occupancy: the fraction of an interval in which an emitter's power density is above a threshold (channel
/// occupancy of Report ITU-R SM.2256, 2.16, at each voxel).
///
/// The motion of the beam is represented by single positions; of the pattern only the angular distance from
/// the beam at which it reaches a level is used. Several emitters are assumed to be independent, which holds
/// for their turns in the long run: the fraction in which any of them is above is 1 - (1 - p1) (1 - p2) ...
#pragma once

#include <vector>

#include "emfield/columns/excess_code.h"
#include "emfield/columns/two_rays.h"
#include "emfield/combine/combine.h"
#include "emfield/radar/look.h"
#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"

namespace emscape::emfield {

/// Largest distance (rad of azimuth) from the beam's azimuth at which a pattern reaches each level, over all
/// elevations, as plain data.
struct PatternReach {
  static constexpr int kLevels = 161;
  static constexpr float kLevelsPerDb = 2;  ///< level n is n / 2 dB below the maximum
  float azimuth_rad[kLevels] = {};          ///< pi: the full circle

  /// @param level  power relative to the maximum, > 0
  EMSCAPE_HD float towards(float level) const {
    const float below = std::ceil(-kLevelsPerDb * fastRatioToDb(level));
    const int n = below > 0 ? (below < kLevels - 1 ? static_cast<int>(below) : kLevels - 1) : 0;
    return azimuth_rad[n];
  }
};

/// Positions of a beam at equal steps of azimuth about the up axis of a frame, at one elevation; or a single
/// position.
struct BeamArc {
  Aim aim;                            ///< of the first position
  float first_rad = 0, step_rad = 0;  ///< azimuths; at most a turn
  int begin = 0, count = 1;           ///< its positions in OccupancyPass::cos_azimuth
  int reach = -1;                     ///< index into OccupancyPass::reaches; -1: unknown
  float share = 0;                    ///< of one position in the interval
};

/// The positions of a beam in an interval.
struct BeamPositions {
  std::vector<BeamArc> arcs;
  std::vector<float> cos_azimuth, sin_azimuth;
  std::vector<PatternReach> reaches;
};

/// An emitter's contribution to a channel of occupancy.
struct OccupancyShare {
  int channel = 0;
  float threshold_wm2 = 0;
  float eirp_over_4pi_w = 0;  ///< while it is active: see EmitterBeam
  Vec3f forward, right, up;   ///< the frame of the positions in the emitter's east-north-up axes
  BeamPositions positions;
};

/// A pass of one emitter over the voxels of a channel, as plain data.
struct OccupancyPass {
  EmitterBeam beam;  ///< with the frame of the positions as its forward, right and up
  float threshold_wm2 = 0;
  const BeamArc* arcs = nullptr;
  int arc_count = 0;
  const float* cos_azimuth = nullptr;
  const float* sin_azimuth = nullptr;
  const PatternReach* reaches = nullptr;
  Dims dims;
  const float* t_m = nullptr;        ///< z of each layer
  const int* first_row_k = nullptr;  ///< for each y the lowest layer with a voxel above ground; null: 0
  float* accumulator = nullptr;      ///< dense order
};

/// @param beam  with views of its geometry and its own pattern
/// @param task  the pass over the other channels
inline OccupancyPass occupancyPass(const OccupancyShare& share, const EmitterBeam& beam,
                                   const CombineTask& task, float* accumulator) {
  OccupancyPass pass;
  pass.beam = beam;
  pass.beam.forward = share.forward;
  pass.beam.right = share.right;
  pass.beam.up = share.up;
  pass.beam.eirp_over_4pi_w = share.eirp_over_4pi_w;
  pass.threshold_wm2 = share.threshold_wm2;
  pass.arcs = share.positions.arcs.data();
  pass.arc_count = static_cast<int>(share.positions.arcs.size());
  pass.cos_azimuth = share.positions.cos_azimuth.data();
  pass.sin_azimuth = share.positions.sin_azimuth.data();
  pass.reaches = share.positions.reaches.data();
  pass.dims = task.dims;
  pass.t_m = task.t_m;
  pass.first_row_k = task.first_row_k;
  pass.accumulator = accumulator;
  return pass;
}

/// Positions of an arc that may illuminate the voxel; at most three runs.
struct PositionRuns {
  int begin[3] = {}, end[3] = {};
};

/// The positions of an arc within an azimuth (rad) of another.
EMSCAPE_HD inline PositionRuns positionsNear(const BeamArc& arc, float azimuth_rad, float reach_rad) {
  constexpr float kTurn_rad = 6.28318531f;
  PositionRuns runs;
  if (arc.count == 1 || !(2 * reach_rad < kTurn_rad - 2 * arc.step_rad)) {
    runs.end[0] = arc.count;
    return runs;
  }
  const float off_rad = azimuth_rad - arc.first_rad;
  const float from_first_rad = off_rad - kTurn_rad * std::floor(off_rad / kTurn_rad);
  for (int n = 0; n < 3; ++n) {
    const float middle_rad = from_first_rad + kTurn_rad * static_cast<float>(n - 1);
    const float begin = std::floor((middle_rad - reach_rad) / arc.step_rad);
    const float end = std::ceil((middle_rad + reach_rad) / arc.step_rad) + 1;
    const auto most = static_cast<float>(arc.count);
    runs.begin[n] = static_cast<int>(begin < 0 ? 0.0f : begin < most ? begin : most);
    runs.end[n] = static_cast<int>(end < 0 ? 0.0f : end < most ? end : most);
  }
  return runs;
}

/// Number of positions begin..end - 1 of an arc from which a voxel's direct ray is above a level.
/// @param direction  of the ray in the frame of the positions, a unit vector
template <scenario::PatternKind kind>
EMSCAPE_HD inline int countAbove(const OccupancyPass& pass, const BeamArc& arc, int begin, int end,
                                 const Vec3f& direction, float level) {
  const scenario::PatternView pattern = pass.beam.pattern;
  const float *const cos_azimuth = pass.cos_azimuth + arc.begin, *const sin_azimuth =
                                                                     pass.sin_azimuth + arc.begin;
  const Aim first = arc.aim;
  const Vec3f ray = direction;
  int above = 0;
  for (int n = begin; n < end; ++n) {
    Aim aim = first;
    aim.cos_azimuth = cos_azimuth[n];
    aim.sin_azimuth = sin_azimuth[n];
    const float amplitude = amplitudeTowards<kind>(pattern, aim, ray);
    above += amplitude * amplitude > level ? 1 : 0;
  }
  return above;
}

/// The same of the direct and the reflected ray.
/// @param below  direction of the reflected ray
template <scenario::PatternKind kind>
EMSCAPE_HD inline int countAbove(const OccupancyPass& pass, const BeamArc& arc, const Vec3f& direction,
                                 const ReflectedRay& reflected, const Vec3f& below, float level) {
  const scenario::PatternView pattern = pass.beam.pattern;
  const float *const cos_azimuth = pass.cos_azimuth + arc.begin, *const sin_azimuth =
                                                                     pass.sin_azimuth + arc.begin;
  const Aim first = arc.aim;
  const Vec3f ray = direction, ray_below = below;
  const ReflectedRay local = reflected;
  int above = 0;
  for (int n = 0; n < arc.count; ++n) {
    Aim aim = first;
    aim.cos_azimuth = cos_azimuth[n];
    aim.sin_azimuth = sin_azimuth[n];
    const float power = powerOfBothRays(local, amplitudeTowards<kind, true>(pattern, aim, ray),
                                        amplitudeTowards<kind, true>(pattern, aim, ray_below));
    above += power > level ? 1 : 0;
  }
  return above;
}

/// The fraction of the interval in which one emitter is above the threshold at a voxel.
template <scenario::PatternKind kind>
EMSCAPE_HD inline float occupancyAt(const OccupancyPass& pass, std::size_t voxel, std::size_t column,
                                    float t_m) {
  const VoxelRay ray = voxelRay(pass.beam, column, t_m);
  const ExcessView& excess = pass.beam.geometry.excess;
  const float power = ray.isotropic_wm2 * (excess.isEmpty() ? 1.0f : excess.factor(voxel));
  if (!(power > 0)) return 0;
  const float level = pass.threshold_wm2 / power;
  const Vec3f direction = ray.direction * (1 / std::sqrt(ray.length2_m2 + 1e-12f));
  float share = 0;
  if (weighsReflectedRays(pass.beam)) {
    const ReflectedRay reflected = reflectedRay(pass.beam.geometry.reflected[voxel]);
    const Vec3f below = reflectedDirection(pass.beam, reflected, column, t_m);
    for (int a = 0; a < pass.arc_count; ++a) {
      const BeamArc& arc = pass.arcs[a];
      share +=
          arc.share * static_cast<float>(countAbove<kind>(pass, arc, direction, reflected, below, level));
    }
    return share < 1 ? share : 1.0f;
  }
  if (level >= 1) return 0;
  const float floor = pass.beam.pattern.side_lobe_amplitude;
  const bool is_always = level < floor * floor;
  const float azimuth_rad = fastAtan2(direction.y, direction.x);
  for (int a = 0; a < pass.arc_count; ++a) {
    const BeamArc& arc = pass.arcs[a];
    int above = is_always ? arc.count : 0;
    if (!is_always) {
      const float reach_rad = arc.reach < 0 ? 4.0f : pass.reaches[arc.reach].towards(level);
      const PositionRuns runs = positionsNear(arc, azimuth_rad, reach_rad);
      for (int n = 0; n < 3; ++n)
        above += countAbove<kind>(pass, arc, runs.begin[n], runs.end[n], direction, level);
    }
    share += arc.share * static_cast<float>(above);
  }
  return share < 1 ? share : 1.0f;
}

/// Adds one emitter to the accumulated occupancy.
EMSCAPE_HD inline float withOccupancy(float share, float accumulated) {
  return accumulated + share * (1 - accumulated);
}

/// Runs a pass on the CPU. Voxels below first_row_k are not changed.
void occupancyCpu(const OccupancyPass& pass);

}  // namespace emscape::emfield
