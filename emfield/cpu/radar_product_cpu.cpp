#include <algorithm>
#include <vector>

#include "base/math/simd.h"
#include "emfield/combine/radar_product.h"
#include "emfield/cpu/apply_excess.h"
#include "emfield/cpu/both_rays.h"
#include "emfield/cpu/clutter_rows.h"
#include "emfield/cpu/echo_rows.h"
#include "emfield/cpu/radar_of_arcs.h"
#include "emfield/cpu/row.h"
#include "emscape/base/parallel.h"

namespace emscape::emfield {
namespace {

using scenario::PatternKind;

template <PatternKind kind>
EMSCAPE_SIMD_CLONES void weightsOfKind(const RadarPass& pass, const JammerAtRadar* jammer, const Row& row,
                                       float* out) {
  fillWeights<kind>(pass, jammer, row, out);
}

/// @param jammer  of which the weights are; null: of the echo, with the excess
/// @param voxel   index of the row's first voxel
void weightsOf(const RadarPass& pass, const JammerAtRadar* jammer, std::size_t voxel, const Row& row,
               float* out) {
  if (pass.has_reflected_rays) {
    weightsOfBothRays(pass, jammer, voxel, row, out);
  } else {
    onPattern(pass.beam.pattern, [&](auto kind) { weightsOfKind<kind>(pass, jammer, row, out); });
  }
  if (jammer == nullptr) applyExcess(pass.beam.geometry.excess, voxel, row.count, out);
}

EMSCAPE_SIMD_CLONES void addWeighted(float factor, const float* weights, int count, float* sum) {
#pragma omp simd
  for (int i = 0; i < count; ++i) sum[i] += factor * weights[i];
}

/// Weights of echoes that arrive while the radar listens.
EMSCAPE_SIMD_CLONES void limitToHeard(const RadarPass& pass, const Row& row, const float* weights,
                                      float* out) {
  const HeardRanges heard = pass.task.heard;
  const EmitterBeam beam = pass.beam;
#pragma omp simd
  for (int i = 0; i < row.count; ++i)
    out[i] = weights[i] * heard.amplitudeOf(slantRange_m(beam.geometry, row.column + i, row.t_m));
}

EMSCAPE_SIMD_CLONES void countLooks(const RadarPass& pass, const Row& row, float* looks) {
  const RadarTask task = pass.task;
  const EmitterBeam beam = pass.beam;
#pragma omp simd
  for (int i = 0; i < row.count; ++i) looks[i] = looksAt(task, beam, row.column + i, row.t_m);
}

EMSCAPE_SIMD_CLONES void findAges(const RadarPass& pass, const Row& row, float* ages_s) {
  const RadarTask task = pass.task;
  const EmitterBeam beam = pass.beam;
#pragma omp simd
  for (int i = 0; i < row.count; ++i) ages_s[i] = ageAt(task, beam, row.column + i, row.t_m);
}

template <RadarMeasure measure>
__attribute__((always_inline)) inline void accumulate(const RadarTask& pass_task, int count,
                                                      const float* weights, const float* jamming,
                                                      const float* looks, float* accumulator) {
  const RadarTask task = pass_task;
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    accumulator[i] =
        withEcho<measure>(task, task.echo_root * weights[i], jamming[i], looks[i], accumulator[i]);
  }
}

/// @param weights  of the echo
EMSCAPE_SIMD_CLONES void accumulateRow(const RadarTask& task, int count, const float* weights,
                                       const float* jamming, const float* looks, float* accumulator) {
  switch (task.measure) {
    case RadarMeasure::root_of_signal_to_noise:
      return accumulate<RadarMeasure::root_of_signal_to_noise>(task, count, weights, jamming, looks,
                                                               accumulator);
    case RadarMeasure::signal_to_jamming:
      return accumulate<RadarMeasure::signal_to_jamming>(task, count, weights, jamming, looks, accumulator);
    case RadarMeasure::detection:
      return accumulate<RadarMeasure::detection>(task, count, weights, jamming, looks, accumulator);
    case RadarMeasure::detection_age:
      return accumulate<RadarMeasure::detection_age>(task, count, weights, jamming, looks, accumulator);
    case RadarMeasure::root_of_signal_to_clutter_and_noise:
      return accumulate<RadarMeasure::root_of_signal_to_clutter_and_noise>(task, count, weights, jamming,
                                                                           looks, accumulator);
  }
}

}  // namespace

void radarCpu(const RadarPass& pass, const LookWeights& weights) {
  if (pass.task.look_arc_count > 0) return radarOfArcsCpu(pass);
  const Dims& dims = pass.dims;
  parallelFor(dims.y, 1, [&](int begin, int end) {
    std::vector<float> buffer(dims.x), echo(dims.x), jamming(dims.x), looks(dims.x, 1.0f);
    for (int j = begin; j < end; ++j) {
      for (int k = pass.first_row_k == nullptr ? 0 : pass.first_row_k[j]; k < dims.z; ++k) {
        const std::size_t column = static_cast<std::size_t>(j) * dims.x;
        const std::size_t voxel = static_cast<std::size_t>(k) * dims.x * dims.y + column;
        const Row row{column, dims.x, pass.t_m[k]};
        const auto weightsIn = [&](const WeightArray& kept, const JammerAtRadar* jammer, float* own) {
          float* const out = kept.values != nullptr ? kept.values + voxel : own;
          if (!kept.is_known) weightsOf(pass, jammer, voxel, row, out);
          return static_cast<const float*>(out);
        };
        const float* of_echo = weightsIn(weights.echo, nullptr, echo.data());
        if (pass.task.heard.isLimited()) {
          limitToHeard(pass, row, of_echo, echo.data());
          of_echo = echo.data();
        }
        std::fill(jamming.begin(), jamming.end(), 0.0f);
        for (int n = 0; n < pass.task.jammer_count; ++n) {
          const JammerAtRadar& jammer = pass.task.jammers[n];
          const WeightArray kept = weights.jammers.empty() ? WeightArray{} : weights.jammers[n];
          addWeighted(jammer.boresight_to_noise, weightsIn(kept, &jammer, buffer.data()), dims.x,
                      jamming.data());
        }
        if (!pass.task.clutter.isNone()) addClutter(pass, row, jamming.data());
        if (pass.task.measure == RadarMeasure::detection_age) {
          findAges(pass, row, looks.data());
        } else if (pass.task.is_cumulative) {
          countLooks(pass, row, looks.data());
        }
        accumulateRow(pass.task, dims.x, of_echo, jamming.data(), looks.data(), pass.accumulator + voxel);
      }
    }
  });
}

}  // namespace emscape::emfield
