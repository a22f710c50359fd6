#include "emfield/cpu/clutter_rows.h"

#include "base/math/simd.h"

namespace emscape::emfield {
namespace {

using scenario::PatternKind;

template <PatternKind kind>
__attribute__((always_inline)) inline void addOfKind(const RadarPass& pass, const Row& row, float* jamming) {
  const ClutterTask task = pass.task.clutter;
  const RadarLook look = pass.task.look;
  const ClutterMapView map = pass.clutter_map;
  const EmitterBeam beam = pass.beam;
#pragma omp simd
  for (int i = 0; i < row.count; ++i) {
    const AimedVoxel aimed = aimedVoxel(look, beam, row.column + i, row.t_m);
    jamming[i] += surfaceToNoise<kind>(task, map, beam, aimed.aim, aimed.range_m);
  }
}

EMSCAPE_SIMD_CLONES void addRain(const RadarPass& pass, const Row& row, float* jamming) {
  const ClutterTask task = pass.task.clutter;
  const RadarLook look = pass.task.look;
  const EmitterBeam beam = pass.beam;
#pragma omp simd
  for (int i = 0; i < row.count; ++i) {
    const AimedVoxel aimed = aimedVoxel(look, beam, row.column + i, row.t_m);
    jamming[i] += rainToNoise(task, beam, aimed.aim, aimed.range_m);
  }
}

EMSCAPE_SIMD_CLONES void addIsotropic(const RadarPass& pass, const Row& row, float* jamming) {
  addOfKind<PatternKind::isotropic>(pass, row, jamming);
}
EMSCAPE_SIMD_CLONES void addGaussian(const RadarPass& pass, const Row& row, float* jamming) {
  addOfKind<PatternKind::gaussian>(pass, row, jamming);
}
EMSCAPE_SIMD_CLONES void addSeparable(const RadarPass& pass, const Row& row, float* jamming) {
  addOfKind<PatternKind::separable>(pass, row, jamming);
}
EMSCAPE_SIMD_CLONES void addPhasedArray(const RadarPass& pass, const Row& row, float* jamming) {
  addOfKind<PatternKind::phased_array>(pass, row, jamming);
}
EMSCAPE_SIMD_CLONES void addGrid(const RadarPass& pass, const Row& row, float* jamming) {
  addOfKind<PatternKind::grid>(pass, row, jamming);
}

void addSurface(const RadarPass& pass, const Row& row, float* jamming) {
  switch (pass.beam.pattern.kind) {
    case PatternKind::isotropic:
      return addIsotropic(pass, row, jamming);
    case PatternKind::gaussian:
      return addGaussian(pass, row, jamming);
    case PatternKind::separable:
      return addSeparable(pass, row, jamming);
    case PatternKind::phased_array:
      return addPhasedArray(pass, row, jamming);
    case PatternKind::grid:
      return addGrid(pass, row, jamming);
  }
}

}  // namespace

void addClutter(const RadarPass& pass, const Row& row, float* jamming) {
  if (pass.task.clutter.surface > 0) addSurface(pass, row, jamming);
  if (pass.task.clutter.rain > 0) addRain(pass, row, jamming);
}

}  // namespace emscape::emfield
