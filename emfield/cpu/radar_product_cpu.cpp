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
#include "emscape/base/work.h"

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

/// Adds a jammer to what a blanker has met.
void addBlanked(const Blanker& blanker, const JammerAtRadar& jammer, int count, const float* weights,
                BlankedSum* blanked) {
  for (int i = 0; i < count; ++i) blanker.add(jammer, weights[i], blanked[i]);
}

/// Adds what a blanker leaves of pulses without an echo in one state of the jamming.
/// @param part  of the time
EMSCAPE_SIMD_CLONES void addLeft(const Blanker& of_pass, int count, const JammingSum* states, float part,
                                 const float* clutter, OpenPulses* left) {
  const Blanker blanker = of_pass;
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const OpenPulses of_state = blanker.leftOf(states[i], clutter[i]);
    left[i].part += part * of_state.part;
    left[i].power += part * of_state.power;
  }
}

/// The same with an echo, of one state.
/// @param level    of the echo, over the mean
/// @param of_echo  weights of the echo
EMSCAPE_SIMD_CLONES void setLeft(const RadarTask& task, float level, int count, const JammingSum* states,
                                 const float* of_echo, const float* clutter, OpenPulses* left) {
  const Blanker blanker = task.blanker;
  const float echo_root = task.echo_root;
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const float root = echo_root * of_echo[i];
    const OpenPulses of_state = blanker.leftOf(states[i], clutter[i], level * root * root);
    left[i].part = of_state.part;
    left[i].power = of_state.power;
    left[i].square = of_state.square;
  }
}

/// Adds the probability of detection of one echo to the sums.
/// @param of_open  of Blanker::corrected()
EMSCAPE_SIMD_CLONES void addDetected(const RadarTask& task, int echo, int count, const float* of_echo,
                                     const OpenPulses* without, const OpenPulses* quiet,
                                     const OpenPulses* jammed, float* of_open, float* probabilities) {
  const Blanker blanker = task.blanker;
  const float echo_root = task.echo_root, level = blanker.echoes[echo], weight = blanker.weights[echo];
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const float root = echo_root * of_echo[i];
    const float threshold = Blanker::noiseOf(without[i]);
    const OpenPulses of_quiet{quiet[i].part, quiet[i].power, quiet[i].square};
    const OpenPulses of_jammed{jammed[i].part, jammed[i].power, jammed[i].square};
    probabilities[i] += weight * blanker.detected(of_quiet, of_jammed, threshold);
    of_open[i] += weight * blanker.unblanked(level * root * root / threshold);
  }
}

EMSCAPE_SIMD_CLONES void correct(const RadarTask& pass_task, int count, const float* of_echo,
                                 const OpenPulses* without, const float* clutter, const float* of_open,
                                 float* probabilities) {
  const RadarTask task = pass_task;
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const float root = task.echo_root * of_echo[i];
    const float threshold = Blanker::noiseOf(without[i]);
    probabilities[i] =
        Blanker::corrected(probabilities[i], of_open[i], task.curve(fastRatioToDb(root * root / threshold)),
                           task.curve(fastRatioToDb(root * root / (1 + clutter[i]))));
  }
}

/// Blanker::probability() of the voxels of a row.
class BlankedRow {
 public:
  explicit BlankedRow(int count)
      : sums(count), without_(count), quiet_(count), jammed_(count), of_open_(count), probabilities_(count) {}

  std::vector<BlankedSum> sums;

  /// @param of_echo  weights of the echo
  const float* probabilities(const RadarTask& task, const float* of_echo, const float* clutter) {
    const int count = static_cast<int>(sums.size()), states = sums.front().count;
    without_.assign(sums.size(), {});
    of_open_.assign(sums.size(), 0);
    probabilities_.assign(sums.size(), 0);
    states_.resize(states * sums.size());
    of_states_.resize(states_.size());
    const auto stateOf = [&](int n) { return states_.data() + n * sums.size(); };
    for (int n = 0; n < states; ++n) {
      for (int i = 0; i < count; ++i) stateOf(n)[i] = sums[i].states[n];
      addLeft(task.blanker, count, stateOf(n), sums.front().parts[n], clutter, without_.data());
    }
    for (int echo = 0; echo < task.blanker.echo_count; ++echo) {
      for (int n = 0; n < states; ++n) {
        setLeft(task, task.blanker.echoes[echo], count, stateOf(n), of_echo, clutter,
                of_states_.data() + n * sums.size());
      }
      splitByPower();
      addDetected(task, echo, count, of_echo, without_.data(), quiet_.data(), jammed_.data(), of_open_.data(),
                  probabilities_.data());
    }
    correct(task, count, of_echo, without_.data(), clutter, of_open_.data(), probabilities_.data());
    return probabilities_.data();
  }

 private:
  void splitByPower() {
    const std::size_t count = sums.size();
    quiet_.assign(count, {});
    jammed_.assign(count, {});
    for (std::size_t i = 0; i < count; ++i) {
      Blanker::Powers powers;
      for (int n = 0; n < sums[i].count; ++n) powers.add(of_states_[n * count + i]);
      for (int n = 0; n < sums[i].count; ++n) {
        const OpenPulses& of_state = of_states_[n * count + i];
        OpenPulses& of = powers.isHigh(of_state) ? jammed_[i] : quiet_[i];
        of = of.plus(of_state, sums[i].parts[n]);
      }
    }
  }

  std::vector<JammingSum> states_;     ///< row after row
  std::vector<OpenPulses> of_states_;  ///< with an echo
  std::vector<OpenPulses> without_, quiet_, jammed_;
  std::vector<float> of_open_, probabilities_;
};

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
                                                      const float* looks, const float* probabilities,
                                                      float* accumulator) {
  const RadarTask task = pass_task;
  if constexpr (measure == RadarMeasure::detection || measure == RadarMeasure::detection_age) {
    if (probabilities != nullptr) {
#pragma omp simd
      for (int i = 0; i < count; ++i) {
        accumulator[i] =
            withDetection<measure>(task, weights[i] > 0, probabilities[i], looks[i], accumulator[i]);
      }
      return;
    }
  }
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    accumulator[i] =
        withEcho<measure>(task, task.echo_root * weights[i], jamming[i], looks[i], accumulator[i]);
  }
}

/// @param weights      of the echo
/// @param probabilities  of detection behind a blanker; null without one
EMSCAPE_SIMD_CLONES void accumulateRow(const RadarTask& task, int count, const float* weights,
                                       const float* jamming, const float* looks, const float* probabilities,
                                       float* accumulator) {
  switch (task.measure) {
    case RadarMeasure::root_of_signal_to_noise:
      return accumulate<RadarMeasure::root_of_signal_to_noise>(task, count, weights, jamming, looks,
                                                               probabilities, accumulator);
    case RadarMeasure::signal_to_jamming:
      return accumulate<RadarMeasure::signal_to_jamming>(task, count, weights, jamming, looks, probabilities,
                                                         accumulator);
    case RadarMeasure::detection:
      return accumulate<RadarMeasure::detection>(task, count, weights, jamming, looks, probabilities,
                                                 accumulator);
    case RadarMeasure::detection_age:
      return accumulate<RadarMeasure::detection_age>(task, count, weights, jamming, looks, probabilities,
                                                     accumulator);
    case RadarMeasure::root_of_signal_to_clutter_and_noise:
      return accumulate<RadarMeasure::root_of_signal_to_clutter_and_noise>(task, count, weights, jamming,
                                                                           looks, probabilities, accumulator);
  }
}

}  // namespace

void radarCpu(const RadarPass& pass, const LookWeights& weights) {
  if (pass.task.look_arc_count > 0) return radarOfArcsCpu(pass);
  const Dims& dims = pass.dims;
  parallelFor(dims.y, 1, [&](int begin, int end) {
    std::vector<float> buffer(dims.x), echo(dims.x), jamming(dims.x), looks(dims.x, 1.0f);
    const bool blanks = !pass.task.blanker.isNone();
    BlankedRow blanked(blanks ? dims.x : 0);
    for (int j = begin; j < end; ++j) {
      for (int k = pass.first_row_k == nullptr ? 0 : pass.first_row_k[j]; k < dims.z; ++k) {
        checkpoint();  // a row of a vertical section is the whole plane
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
        blanked.sums.assign(blanked.sums.size(), {});
        for (int n = 0; n < pass.task.jammer_count; ++n) {
          const JammerAtRadar& jammer = pass.task.jammers[n];
          const WeightArray kept = weights.jammers.empty() ? WeightArray{} : weights.jammers[n];
          const float* const of_jammer = weightsIn(kept, &jammer, buffer.data());
          if (!blanks) {
            addWeighted(jammer.boresight_to_noise, of_jammer, dims.x, jamming.data());
          } else {
            addBlanked(pass.task.blanker, jammer, dims.x, of_jammer, blanked.sums.data());
          }
        }
        if (!pass.task.clutter.isNone()) addClutter(pass, row, jamming.data());
        if (pass.task.measure == RadarMeasure::detection_age) {
          findAges(pass, row, looks.data());
        } else if (pass.task.is_cumulative) {
          countLooks(pass, row, looks.data());
        }
        const float* const probabilities =
            blanks ? blanked.probabilities(pass.task, of_echo, jamming.data()) : nullptr;
        accumulateRow(pass.task, dims.x, of_echo, jamming.data(), looks.data(), probabilities,
                      pass.accumulator + voxel);
      }
    }
  });
}

}  // namespace emscape::emfield
