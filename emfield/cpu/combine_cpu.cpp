#include <algorithm>
#include <vector>

#include "base/math/simd.h"
#include "emfield/combine/combine.h"
#include "emfield/cpu/apply_excess.h"
#include "emfield/cpu/both_rays.h"
#include "emfield/cpu/row.h"
#include "emscape/base/parallel.h"
#include "emscape/base/work.h"

namespace emscape::emfield {
namespace {

using scenario::PatternKind;

template <PatternKind kind>
__attribute__((always_inline)) inline void fillPiece(const EmitterBeam& emitter, const Row& row, float* out) {
  const EmitterBeam local = emitter;
#pragma omp simd
  for (int i = 0; i < row.count; ++i) out[i] = powerDensity_wm2<kind>(local, row.column + i, row.t_m);
}

/// Number of voxels that are tested together for being outside the lobe, where the pattern need not be
/// evaluated. With a narrow beam most are.
constexpr int kPiece = 64;

/// Fills at most kPiece voxels as outside the main lobe. @return true if some may be inside
__attribute__((always_inline)) inline bool fillBesideLobe(const EmitterBeam& emitter, const Row& row,
                                                          float* out) {
  const EmitterBeam local = emitter;
  float depth[kPiece];
#pragma omp simd
  for (int i = 0; i < row.count; ++i) {
    out[i] = sideLobePowerDensity_wm2(local, row.column + i, row.t_m, depth[i]);
  }
  int inside = 0;
#pragma omp simd reduction(+ : inside)
  for (int i = 0; i < row.count; ++i) inside += depth[i] >= 0 ? 1 : 0;
  return inside > 0;
}

template <PatternKind kind>
__attribute__((always_inline)) inline void fillRow(const EmitterBeam& emitter, const Row& row, float* out) {
  if (kind == PatternKind::isotropic || emitter.pattern.lobe_tangent == 0)
    return fillPiece<kind>(emitter, row, out);
  for (int first = 0; first < row.count; first += kPiece) {
    const Row piece{row.column + first, std::min(kPiece, row.count - first), row.t_m};
    if (fillBesideLobe(emitter, piece, out + first)) fillPiece<kind>(emitter, piece, out + first);
  }
}

template <PatternKind kind>
EMSCAPE_SIMD_CLONES void rowOfKind(const EmitterBeam& emitter, const Row& row, float* out) {
  fillRow<kind>(emitter, row, out);
}

/// @param first  index of the row's first voxel
void powerDensityRow(const EmitterBeam& emitter, const Row& row, std::size_t first, float* out) {
  if (weighsReflectedRays(emitter)) return bothRaysRow(emitter, emitter.geometry.reflected + first, row, out);
  onPattern(emitter.pattern, [&](auto kind) { rowOfKind<kind>(emitter, row, out); });
}

EMSCAPE_SIMD_CLONES void reduceRow(Reduction reduction, float weight, const float* power_density_wm2,
                                   int count, float* value, float* second) {
  switch (reduction) {
    case Reduction::sum:
#pragma omp simd
      for (int i = 0; i < count; ++i) reduce(Reduction::sum, weight, power_density_wm2[i], value[i]);
      break;
    case Reduction::maximum:
#pragma omp simd
      for (int i = 0; i < count; ++i) reduce(Reduction::maximum, weight, power_density_wm2[i], value[i]);
      break;
    case Reduction::count:
#pragma omp simd
      for (int i = 0; i < count; ++i) reduce(Reduction::count, weight, power_density_wm2[i], value[i]);
      break;
    case Reduction::dominant:
#pragma omp simd
      for (int i = 0; i < count; ++i) {
        reduce(Reduction::dominant, weight, power_density_wm2[i], value[i], second[i]);
      }
      break;
    case Reduction::dominant_mechanism:  // mechanismRow()
      break;
    case Reduction::signal:
#pragma omp simd
      for (int i = 0; i < count; ++i)
        reduce(Reduction::signal, weight, power_density_wm2[i], value[i], second[i]);
      break;
  }
}

/// Reduction::dominant_mechanism.
EMSCAPE_SIMD_CLONES void mechanismRow(const ColumnGeometryView& geometry, std::size_t first, float weight,
                                      const float* power_density_wm2, int count, float* value,
                                      float* second) {
  const ColumnGeometryView local = geometry;
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    reduce(Reduction::dominant_mechanism, mechanismWeight(local, weight, first + i), power_density_wm2[i],
           value[i], second[i]);
  }
}

void startRow(const CombineTask& task, std::size_t channel, std::size_t first) {
  const Accumulator& out = task.accumulators[channel];
  const ConstAccumulator& from = task.initial[channel];
  const int count = task.dims.x;
  if (from.value != nullptr) {
    std::copy_n(from.value + first, count, out.value + first);
    if (out.second != nullptr) std::copy_n(from.second + first, count, out.second + first);
  } else {
    std::fill_n(out.value + first, count, initialValue(task.reductions[channel]));
    if (out.second != nullptr) std::fill_n(out.second + first, count, 0.0f);
  }
}

/// @param buffer  of one row, for emitters whose power density is not stored
/// @return the row's power density
const float* powerOf(const CombineEmitter& emitter, const Row& row, std::size_t first, float* buffer) {
  float* const power_wm2 = emitter.power_wm2 != nullptr ? emitter.power_wm2 + first : buffer;
  if (emitter.power_is_known) return power_wm2;
  powerDensityRow(emitter.beam, row, first, power_wm2);
  applyExcess(emitter.beam.geometry.excess, first, row.count, power_wm2);
  return power_wm2;
}

void combineRow(const CombineTask& task, int j, int k, float* buffer) {
  const int count = task.dims.x;
  const std::size_t first = (static_cast<std::size_t>(k) * task.dims.y + j) * count;
  const Row row{static_cast<std::size_t>(j) * count, count, task.t_m[k]};
  if (!task.keep) {
    for (std::size_t c = 0; c < task.accumulators.size(); ++c) {
      if (task.accumulators[c].value != nullptr) startRow(task, c, first);
    }
  }
  for (const CombineEmitter& emitter : task.emitters) {
    if (!isIncluded(task, emitter)) continue;
    const float* const power_wm2 = powerOf(emitter, row, first, buffer);
    for (const ChannelWeight& share : emitter.shares) {
      const Accumulator& out = task.accumulators[share.channel];
      if (out.value == nullptr) continue;
      const Reduction reduction = task.reductions[share.channel];
      float* const second = out.second == nullptr ? nullptr : out.second + first;
      if (reduction == Reduction::dominant_mechanism) {
        mechanismRow(emitter.beam.geometry, first, share.weight, power_wm2, count, out.value + first, second);
      } else {
        reduceRow(reduction, share.weight, power_wm2, count, out.value + first, second);
      }
    }
  }
}

}  // namespace

void combineCpu(const CombineTask& task) {
  parallelFor(task.dims.y, 1, [&](int begin, int end) {
    std::vector<float> buffer(task.dims.x);
    for (int j = begin; j < end; ++j) {
      for (int k = task.first_row_k == nullptr ? 0 : task.first_row_k[j]; k < task.dims.z; ++k) {
        checkpoint();
        combineRow(task, j, k, buffer.data());
      }
    }
  });
}

}  // namespace emscape::emfield
