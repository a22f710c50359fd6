/// Stage 3: power density of each emitter at each voxel, and its reduction into the channels.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "emfield/columns/column_geometry.h"
#include "emscape/base/host_device.h"
#include "emscape/base/vec.h"
#include "emscape/scenario/antenna/antenna.h"
#include "scenario/antenna/pattern.h"

namespace emscape::emfield {

/// One emitter at one instant, as plain data.
struct EmitterBeam {
  ColumnGeometryView geometry;
  scenario::PatternView pattern;
  /// Unit vectors of the antenna's frame in the emitter's east-north-up axes.
  Vec3f forward, right, up;
  float steer_u = 0, steer_v = 0;
  /// Peak EIRP minus losses, over 4 pi (W); divided by the squared distance, the power density on boresight.
  float eirp_over_4pi_w = 0;
};

/// Lower limit (m) of the distance, so that the field is finite at the emitter.
constexpr float kMinDistance_m = 1;

/// A voxel relative to an emitter.
struct VoxelRay {
  Vec3f direction;  ///< of the refracted ray's start, in the antenna's frame (forward, right, up); not a unit
                    ///< vector
  float length2_m2;     ///< the direction's length squared
  float isotropic_wm2;  ///< power density with the boresight gain in every direction; 0 in shadow and if
                        ///< unknown
};

/// Start of the direct refracted ray, east-north-up at the emitter; not a unit vector.
/// @param t_m  z of the voxel in the grid's frame
EMSCAPE_HD inline Vec3f directRay(const ColumnGeometryView& g, std::size_t column, float t_m) {
  const float east = g.base_east_m[column] + t_m * g.axis_east[column];
  const float north = g.base_north_m[column] + t_m * g.axis_north[column];
  const float up = g.base_up_m[column] + t_m * g.axis_up[column] + g.lift_m[column];
  return {east, north, up};
}

/// A direction of the emitter's east-north-up axes in the antenna's frame.
EMSCAPE_HD inline Vec3f inAntennaFrame(const EmitterBeam& emitter, const Vec3f& direction) {
  return {dot(direction, emitter.forward), dot(direction, emitter.right), dot(direction, emitter.up)};
}

/// @param t_m  z of the voxel in the grid's frame
EMSCAPE_HD inline VoxelRay voxelRay(const EmitterBeam& emitter, std::size_t column, float t_m) {
  const ColumnGeometryView& g = emitter.geometry;
  const Vec3f ray = directRay(g, column, t_m);

  const float along_m = t_m - g.nearest_t_m[column];
  const float distance2 = g.offset2_m2[column] + along_m * along_m;
  constexpr float kMin2 = kMinDistance_m * kMinDistance_m;
  const float lit_w = t_m >= g.shadow_edge_m[column] ? emitter.eirp_over_4pi_w : 0.0f;
  return {inAntennaFrame(emitter, ray), dot(ray, ray), lit_w / (distance2 > kMin2 ? distance2 : kMin2)};
}

/// Direction of a voxel's reflected ray in the antenna's frame, a unit vector.
EMSCAPE_HD inline Vec3f reflectedDirection(const EmitterBeam& emitter, const ReflectedRay& reflected,
                                           std::size_t column, float t_m) {
  const Vec3f direct = directRay(emitter.geometry, column, t_m);
  return inAntennaFrame(emitter, reflectedDirection(direct, reflected.depression_sine));
}

/// Power density (W/m2) of one emitter at the voxel at z = t_m of a column, without the excess loss of its
/// path (ColumnGeometryView::excess, if there is one); 0 in shadow and where the path is
/// unknown. Within the near field (< 2 D^2 / lambda) it is the extrapolated far field.
/// @accuracy within 1e-4 dB of double precision on axis and for smooth patterns, to 500 km
template <scenario::PatternKind kind>
EMSCAPE_HD inline float powerDensity_wm2(const EmitterBeam& emitter, std::size_t column, float t_m) {
  const VoxelRay ray = voxelRay(emitter, column, t_m);
  Vec3f direction = ray.direction;
  if constexpr (kind == scenario::PatternKind::phased_array) {
    direction = direction * (1 / std::sqrt(ray.length2_m2 + 1e-12f));
  }
  const float amplitude =
      scenario::amplitudeOf<kind>(emitter.pattern, direction, emitter.steer_u, emitter.steer_v);
  return ray.isotropic_wm2 * amplitude * amplitude;
}

/// The same for the sum of the direct and the reflected ray.
template <scenario::PatternKind kind>
EMSCAPE_HD inline float powerDensity_wm2(const EmitterBeam& emitter, const ReflectedRayCode& code,
                                         std::size_t column, float t_m) {
  const VoxelRay ray = voxelRay(emitter, column, t_m);
  const ReflectedRay reflected = reflectedRay(code);
  const auto amplitude = [&](const Vec3f& direction) {
    return scenario::amplitudeOf<kind, true>(emitter.pattern, direction, emitter.steer_u, emitter.steer_v);
  };
  const float direct = amplitude(ray.direction * (1 / std::sqrt(ray.length2_m2 + 1e-12f)));
  return ray.isotropic_wm2 *
         powerOfBothRays(reflected, direct, amplitude(reflectedDirection(emitter, reflected, column, t_m)));
}

/// True if an emitter's power density depends on the pattern along the reflected ray; for isotropic antennas
/// the excess includes the ray.
EMSCAPE_HD inline bool weighsReflectedRays(const EmitterBeam& emitter) {
  return emitter.geometry.reflected != nullptr && emitter.pattern.kind != scenario::PatternKind::isotropic;
}

/// The power density of the direct ray to a voxel outside the pattern's lobe.
/// @param depth  below 0 outside the lobe (scenario::depthInLobe)
EMSCAPE_HD inline float sideLobePowerDensity_wm2(const EmitterBeam& emitter, std::size_t column, float t_m,
                                                 float& depth) {
  const VoxelRay ray = voxelRay(emitter, column, t_m);
  depth = scenario::depthInLobe(emitter.pattern, ray.direction);
  return ray.isotropic_wm2 * emitter.pattern.side_lobe_amplitude * emitter.pattern.side_lobe_amplitude;
}

/// Reduction of the emitters' power densities S to a channel's accumulator.
enum class Reduction {
  sum,                 ///< sum of weight * S
  maximum,             ///< largest weight * S
  count,               ///< number of emitters with S > weight
  dominant,            ///< weight of the emitter with the largest S, -1 if all are 0
  dominant_mechanism,  ///< the same; for emitters with mechanisms per voxel, that of the voxel
  signal,  ///< sum of weight * S of the emitters with weight >= 0; second: of -weight * S of the others
};

/// True for reductions with a second accumulator.
EMSCAPE_HD constexpr bool hasSecond(Reduction reduction) {
  return reduction == Reduction::dominant || reduction == Reduction::dominant_mechanism ||
         reduction == Reduction::signal;
}

/// Value of an accumulator before the first emitter.
EMSCAPE_HD constexpr float initialValue(Reduction reduction) {
  return reduction == Reduction::dominant || reduction == Reduction::dominant_mechanism ? -1.0f : 0.0f;
}

/// A channel's accumulator, dense order. `second` holds the largest S so far for Reduction::dominant and
/// dominant_mechanism, the signal for Reduction::signal, else null.
struct Accumulator {
  float* value = nullptr;
  float* second = nullptr;
};
struct ConstAccumulator {
  const float* value = nullptr;
  const float* second = nullptr;
};

/// Adds one emitter's power density to a voxel of a channel without a second accumulator.
/// @param weight  see Reduction
EMSCAPE_HD inline void reduce(Reduction reduction, float weight, float power_density_wm2, float& value) {
  if (reduction == Reduction::sum) {
    value += weight * power_density_wm2;
  } else if (reduction == Reduction::maximum) {
    value = weight * power_density_wm2 > value ? weight * power_density_wm2 : value;
  } else {
    value += power_density_wm2 > weight ? 1.0f : 0.0f;
  }
}

/// The same with a second accumulator.
EMSCAPE_HD inline void reduce(Reduction reduction, float weight, float power_density_wm2, float& value,
                              float& second) {
  if (reduction != Reduction::signal) {
    value = power_density_wm2 > second ? weight : value;
    second = power_density_wm2 > second ? power_density_wm2 : second;
  } else if (weight < 0) {
    second -= weight * power_density_wm2;
  } else {
    value += weight * power_density_wm2;
  }
}

/// An emitter's weight in Reduction::dominant_mechanism.
/// @param weight  of the emitter
EMSCAPE_HD inline float mechanismWeight(const ColumnGeometryView& geometry, float weight, std::size_t voxel) {
  return geometry.mechanisms != nullptr ? static_cast<float>(geometry.mechanisms[voxel]) : weight;
}

/// An emitter's contribution to one channel.
struct ChannelWeight {
  int channel = 0;  ///< index into CombineTask::accumulators
  float weight = 1;
};

struct CombineEmitter {
  EmitterBeam beam;
  int emitter_index = 0;
  std::vector<ChannelWeight> shares;
  /// Power density (W/m2) at every voxel, dense order, including the excess loss; written by the pass, or
  /// read instead of computed. Null: neither.
  float* power_wm2 = nullptr;
  bool power_is_known = false;
};

/// One pass over the grid.
struct CombineTask {
  Dims dims;
  const float* t_m = nullptr;        ///< z of each layer
  const int* first_row_k = nullptr;  ///< for each y the lowest layer with a voxel above ground; null: 0
  std::vector<CombineEmitter> emitters;
  std::vector<Reduction> reductions;      ///< one per channel
  std::vector<Accumulator> accumulators;  ///< one per channel; value null: not part of this pass
  std::vector<ConstAccumulator> initial;  ///< initial value of each accumulator; value null: none
  bool keep = false;                      ///< true: continue with the values in the accumulators
};

/// True if a pass adds an emitter to any of its accumulators. Echoes of radars are added by other passes.
inline bool isIncluded(const CombineTask& task, const CombineEmitter& emitter) {
  for (const ChannelWeight& share : emitter.shares) {
    if (task.accumulators[static_cast<std::size_t>(share.channel)].value != nullptr) return true;
  }
  return false;
}

/// Runs a pass on the CPU, rows of x in SIMD. Voxels below first_row_k are not changed.
void combineCpu(const CombineTask& task);

}  // namespace emscape::emfield
