#include "emfield/cpu/clutter_rows.h"

#include <algorithm>

#include "base/math/simd.h"

namespace emscape::emfield {
namespace {

using scenario::PatternKind;

/// The looks at the voxels of a row, for all steps and trips.
EMSCAPE_SIMD_CLONES void findSurfaceLooks(const RadarPass& pass, const Row& row, SurfaceLook* looks,
                                          float* ranges_m) {
  const RadarLook look = pass.task.look;
  const ClutterMapView map = pass.clutter_map;
  const EmitterBeam beam = pass.beam;
#pragma omp simd
  for (int i = 0; i < row.count; ++i) {
    const AimedVoxel aimed = aimedVoxel(look, beam, row.column + i, row.t_m);
    looks[i] = surfaceLook(map, beam, aimed.aim);
    ranges_m[i] = aimed.range_m;
  }
}

template <PatternKind kind>
__attribute__((always_inline)) inline void addStep(const RadarPass& pass, const SurfaceLook* looks,
                                                   const float* ranges_m, int count, int trip, int step,
                                                   float* jamming) {
  const HeardRanges heard = pass.task.heard;
  const ClutterTask task = pass.task.clutter;
  const ClutterMapView map = pass.clutter_map;
  const EmitterBeam beam = pass.beam;
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    jamming[i] += heard.powerOf(ranges_m[i]) *
                  surfaceOfStep<kind>(task, map, map.trips, beam, looks[i], ranges_m[i], trip, step);
  }
}

template <PatternKind kind>
EMSCAPE_SIMD_CLONES void addSurfaceOfKind(const RadarPass& pass, const SurfaceLook* looks,
                                          const float* ranges_m, int count, float* jamming) {
  for (int trip = 0; trip < pass.clutter_map.trips.count; ++trip) {
    for (int step = 0; step < pass.clutter_map.steps.touched(); ++step)
      addStep<kind>(pass, looks, ranges_m, count, trip, step, jamming);
  }
}

void addSurface(const RadarPass& pass, const Row& row, float* jamming) {
  constexpr int kTogether = 64;  // voxels
  SurfaceLook looks[kTogether];
  float ranges_m[kTogether];
  for (int begin = 0; begin < row.count; begin += kTogether) {
    const int count = std::min(kTogether, row.count - begin);
    findSurfaceLooks(pass, {row.column + static_cast<std::size_t>(begin), count, row.t_m}, looks, ranges_m);
    onPattern(pass.beam.pattern,
              [&](auto kind) { addSurfaceOfKind<kind>(pass, looks, ranges_m, count, jamming + begin); });
  }
}

EMSCAPE_SIMD_CLONES void addRain(const RadarPass& pass, const Row& row, float* jamming) {
  const ClutterTask task = pass.task.clutter;
  const RadarLook look = pass.task.look;
  const HeardRanges heard = pass.task.heard;
  const EmitterBeam beam = pass.beam;
#pragma omp simd
  for (int i = 0; i < row.count; ++i) {
    const AimedVoxel aimed = aimedVoxel(look, beam, row.column + i, row.t_m);
    jamming[i] += heard.powerOf(aimed.range_m) * rainToNoise(task, beam, aimed.aim, aimed.range_m);
  }
}

}  // namespace

void addClutter(const RadarPass& pass, const Row& row, float* jamming) {
  if (pass.task.clutter.surface > 0) addSurface(pass, row, jamming);
  if (pass.task.clutter.rain > 0) addRain(pass, row, jamming);
}

}  // namespace emscape::emfield
