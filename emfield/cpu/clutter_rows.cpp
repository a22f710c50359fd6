#include "emfield/cpu/clutter_rows.h"

#include "base/math/simd.h"

namespace emscape::emfield {
namespace {

using scenario::PatternKind;

template <PatternKind kind>
__attribute__((always_inline)) inline void addTrip(const RadarPass& pass, const Row& row, int trip,
                                                   float* jamming) {
  const HeardRanges heard = pass.task.heard;
  const ClutterTask task = pass.task.clutter;
  const RadarLook look = pass.task.look;
  const ClutterMapView map = pass.clutter_map;
  const EmitterBeam beam = pass.beam;
#pragma omp simd
  for (int i = 0; i < row.count; ++i) {
    const AimedVoxel aimed = aimedVoxel(look, beam, row.column + i, row.t_m);
    jamming[i] += heard.powerOf(aimed.range_m) *
                  surfaceOfTrip<kind>(task, map, map.trips, beam, aimed.aim, aimed.range_m, trip);
  }
}

template <PatternKind kind>
EMSCAPE_SIMD_CLONES void addSurfaceOfKind(const RadarPass& pass, const Row& row, float* jamming) {
  for (int trip = 0; trip < pass.clutter_map.trips.count; ++trip) addTrip<kind>(pass, row, trip, jamming);
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
  if (pass.task.clutter.surface > 0)
    onPattern(pass.beam.pattern, [&](auto kind) { addSurfaceOfKind<kind>(pass, row, jamming); });
  if (pass.task.clutter.rain > 0) addRain(pass, row, jamming);
}

}  // namespace emscape::emfield
