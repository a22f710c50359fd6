#include <algorithm>

#include "base/simd.h"
#include "emfield/cpu/both_rays.h"
#include "emfield/cpu/echo_rows.h"

namespace emscape::emfield {
namespace {

using scenario::PatternKind;

/// @param reflected  of the row's first voxel
template <PatternKind kind>
__attribute__((always_inline)) inline void fillEchoesOfBothRays(const RadarPass& pass,
                                                                const ReflectedRayCode* reflected,
                                                                const Row& row, float* root) {
  const RadarTask task = pass.task;
  const EmitterBeam beam = pass.beam;
#pragma omp simd
  for (int i = 0; i < row.count; ++i) {
    root[i] = echoToNoiseRoot<kind>(task, beam, reflected[i], row.column + i, row.t_m);
  }
}

template <PatternKind kind>
__attribute__((always_inline)) inline void addJammingOfBothRays(const RadarPass& pass,
                                                                const JammerAtRadar& jammer, const Row& row,
                                                                float* jamming) {
  const RadarTask task = pass.task;
  const EmitterBeam beam = pass.beam;
  const JammerAtRadar local = jammer;
#pragma omp simd
  for (int i = 0; i < row.count; ++i) {
    jamming[i] += jammingOfBothRaysToNoise<kind>(task, beam, local, row.column + i, row.t_m);
  }
}

/// @param reflected  of the row's first voxel; null: the radar's reflected rays are not weighed
template <PatternKind kind>
__attribute__((always_inline)) inline void fillRowOfBothRays(const RadarPass& pass,
                                                             const ReflectedRayCode* reflected,
                                                             const Row& row, float* root, float* jamming) {
  if (kind != PatternKind::isotropic && reflected != nullptr) {
    fillEchoesOfBothRays<kind>(pass, reflected, row, root);
  } else {
    fillEchoes<kind>(pass, row, root);
  }
  std::fill_n(jamming, row.count, 0.0f);
  for (int n = 0; n < pass.task.jammer_count; ++n) {
    const JammerAtRadar& jammer = pass.task.jammers[n];
    if (jammer.has_reflected_ray) {
      addJammingOfBothRays<kind>(pass, jammer, row, jamming);
    } else {
      addJamming<kind>(pass, jammer, row, jamming);
    }
  }
}

EMSCAPE_SIMD_CLONES void isotropicEchoes(const RadarPass& pass, const ReflectedRayCode* reflected,
                                         const Row& row, float* root, float* jamming) {
  fillRowOfBothRays<PatternKind::isotropic>(pass, reflected, row, root, jamming);
}
EMSCAPE_SIMD_CLONES void gaussianEchoes(const RadarPass& pass, const ReflectedRayCode* reflected,
                                        const Row& row, float* root, float* jamming) {
  fillRowOfBothRays<PatternKind::gaussian>(pass, reflected, row, root, jamming);
}
EMSCAPE_SIMD_CLONES void separableEchoes(const RadarPass& pass, const ReflectedRayCode* reflected,
                                         const Row& row, float* root, float* jamming) {
  fillRowOfBothRays<PatternKind::separable>(pass, reflected, row, root, jamming);
}
EMSCAPE_SIMD_CLONES void phasedArrayEchoes(const RadarPass& pass, const ReflectedRayCode* reflected,
                                           const Row& row, float* root, float* jamming) {
  fillRowOfBothRays<PatternKind::phased_array>(pass, reflected, row, root, jamming);
}
EMSCAPE_SIMD_CLONES void gridEchoes(const RadarPass& pass, const ReflectedRayCode* reflected, const Row& row,
                                    float* root, float* jamming) {
  fillRowOfBothRays<PatternKind::grid>(pass, reflected, row, root, jamming);
}

}  // namespace

void echoesOfBothRays(const RadarPass& pass, std::size_t voxel, const Row& row, float* root, float* jamming) {
  const ReflectedRayCode* const reflected =
      weighsReflectedRays(pass.beam) ? pass.beam.geometry.reflected + voxel : nullptr;
  switch (pass.beam.pattern.kind) {
    case PatternKind::isotropic:
      return isotropicEchoes(pass, reflected, row, root, jamming);
    case PatternKind::gaussian:
      return gaussianEchoes(pass, reflected, row, root, jamming);
    case PatternKind::separable:
      return separableEchoes(pass, reflected, row, root, jamming);
    case PatternKind::phased_array:
      return phasedArrayEchoes(pass, reflected, row, root, jamming);
    case PatternKind::grid:
      return gridEchoes(pass, reflected, row, root, jamming);
  }
}

}  // namespace emscape::emfield
