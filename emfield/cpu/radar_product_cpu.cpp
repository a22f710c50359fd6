#include <algorithm>
#include <vector>

#include "base/simd.h"
#include "emfield/cpu/apply_excess.h"
#include "emfield/cpu/both_rays.h"
#include "emfield/cpu/clutter_rows.h"
#include "emfield/cpu/echo_rows.h"
#include "emfield/cpu/row.h"
#include "emfield/radar_product.h"
#include "emscape/base/parallel.h"

namespace emscape::emfield {
namespace {

using scenario::PatternKind;

template <PatternKind kind>
__attribute__((always_inline)) inline void fillRow(const RadarPass& pass, const Row& row, float* root,
                                                   float* jamming) {
  fillEchoes<kind>(pass, row, root);
  std::fill_n(jamming, row.count, 0.0f);
  for (int n = 0; n < pass.task.jammer_count; ++n) addJamming<kind>(pass, pass.task.jammers[n], row, jamming);
}

EMSCAPE_SIMD_CLONES void isotropicRow(const RadarPass& pass, const Row& row, float* root, float* jamming) {
  fillRow<PatternKind::isotropic>(pass, row, root, jamming);
}
EMSCAPE_SIMD_CLONES void gaussianRow(const RadarPass& pass, const Row& row, float* root, float* jamming) {
  fillRow<PatternKind::gaussian>(pass, row, root, jamming);
}
EMSCAPE_SIMD_CLONES void separableRow(const RadarPass& pass, const Row& row, float* root, float* jamming) {
  fillRow<PatternKind::separable>(pass, row, root, jamming);
}
EMSCAPE_SIMD_CLONES void phasedArrayRow(const RadarPass& pass, const Row& row, float* root, float* jamming) {
  fillRow<PatternKind::phased_array>(pass, row, root, jamming);
}
EMSCAPE_SIMD_CLONES void gridRow(const RadarPass& pass, const Row& row, float* root, float* jamming) {
  fillRow<PatternKind::grid>(pass, row, root, jamming);
}

void fillRow(const RadarPass& pass, const Row& row, float* root, float* jamming) {
  switch (pass.beam.pattern.kind) {
    case PatternKind::isotropic:
      return isotropicRow(pass, row, root, jamming);
    case PatternKind::gaussian:
      return gaussianRow(pass, row, root, jamming);
    case PatternKind::separable:
      return separableRow(pass, row, root, jamming);
    case PatternKind::phased_array:
      return phasedArrayRow(pass, row, root, jamming);
    case PatternKind::grid:
      return gridRow(pass, row, root, jamming);
  }
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
                                                      const float* root, const float* jamming,
                                                      const float* looks, float* accumulator) {
  const RadarTask task = pass_task;
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    accumulator[i] = withEcho<measure>(task, root[i], jamming[i], looks[i], accumulator[i]);
  }
}

EMSCAPE_SIMD_CLONES void accumulateRow(const RadarTask& task, int count, const float* root,
                                       const float* jamming, const float* looks, float* accumulator) {
  switch (task.measure) {
    case RadarMeasure::root_of_signal_to_noise:
      return accumulate<RadarMeasure::root_of_signal_to_noise>(task, count, root, jamming, looks,
                                                               accumulator);
    case RadarMeasure::signal_to_jamming:
      return accumulate<RadarMeasure::signal_to_jamming>(task, count, root, jamming, looks, accumulator);
    case RadarMeasure::detection:
      return accumulate<RadarMeasure::detection>(task, count, root, jamming, looks, accumulator);
    case RadarMeasure::detection_age:
      return accumulate<RadarMeasure::detection_age>(task, count, root, jamming, looks, accumulator);
    case RadarMeasure::root_of_signal_to_clutter_and_noise:
      return accumulate<RadarMeasure::root_of_signal_to_clutter_and_noise>(task, count, root, jamming, looks,
                                                                           accumulator);
  }
}

}  // namespace

void radarCpu(const RadarPass& pass) {
  const Dims& dims = pass.dims;
  parallelFor(dims.y, 1, [&](int begin, int end) {
    std::vector<float> root(dims.x), jamming(dims.x), looks(dims.x, 1.0f);
    for (int j = begin; j < end; ++j) {
      for (int k = pass.first_row_k == nullptr ? 0 : pass.first_row_k[j]; k < dims.z; ++k) {
        const std::size_t column = static_cast<std::size_t>(j) * dims.x;
        const std::size_t voxel = static_cast<std::size_t>(k) * dims.x * dims.y + column;
        const Row row{column, dims.x, pass.t_m[k]};
        if (pass.has_reflected_rays) {
          echoesOfBothRays(pass, voxel, row, root.data(), jamming.data());
        } else {
          fillRow(pass, row, root.data(), jamming.data());
        }
        if (!pass.task.clutter.isNone()) addClutter(pass, row, jamming.data());
        if (pass.task.measure == RadarMeasure::detection_age) {
          findAges(pass, row, looks.data());
        } else if (pass.task.is_cumulative) {
          countLooks(pass, row, looks.data());
        }
        applyExcess(pass.beam.geometry.excess, voxel, dims.x, root.data());
        accumulateRow(pass.task, dims.x, root.data(), jamming.data(), looks.data(), pass.accumulator + voxel);
      }
    }
  });
}

}  // namespace emscape::emfield
