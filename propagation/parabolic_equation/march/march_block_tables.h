/// Tables and plans of a block's march in double, one entry or azimuth per call; see march_block.h.
#pragma once

#include "propagation/parabolic_equation/march/march_block.h"

namespace emscape::propagation {

/// Tables to be written; the same pointers as in MarchBlockTask.
struct BlockTables {
  StoredComplex *propagator = nullptr, *exponents = nullptr;
  StoredComplex *half_screen = nullptr, *whole_screen = nullptr, *half_in_runs = nullptr,
                *whole_in_runs = nullptr;
  StoredComplex* weights = nullptr;
  PlannedStep* planned = nullptr;
};

namespace block_tables {

EMSCAPE_HD inline StoredComplex stored(Complex<double> a) {
  return Complex<float>{float(a.re), float(a.im)};
}

/// M relative to that of the first level, at the first range.
EMSCAPE_HD inline double unitsAt(const MarchBlockTask& task, double height_m) {
  const AirSegment& segment = task.segments[0];
  const AirLevel* const levels = task.levels + segment.first;
  int i = 0;
  while (i + 1 < segment.levels && double(levels[i + 1].from_m) <= height_m) ++i;
  const double gradient = i + 1 < segment.levels
                              ? (double(levels[i + 1].from_units) - double(levels[i].from_units)) /
                                    (double(levels[i + 1].from_m) - double(levels[i].from_m))
                              : double(segment.top_from);
  return double(levels[i].from_units) + gradient * (height_m - double(levels[i].from_m));
}

}  // namespace block_tables

/// Logarithm of the propagator along level ground at the wavenumber n of N; its phase is reduced.
EMSCAPE_HD inline Complex<double> propagatorExponent(const MarchBlockTask& task, int intervals, int n) {
  const double q = kPi * n / (task.height_step_m * intervals);
  const double loss = task.absorber_m > 0
                          ? bandEdgeRate(double(n) / intervals, task.wavelength_m / (2 * task.height_step_m),
                                         task.range_step_m, task.ground_steps > 0)
                          : 0;
  const Complex<double> exponent =
      stepExponent(task.wide, 2 * kPi / task.wavelength_m, task.range_step_m, {q * q, 0});
  const double turns = exponent.im / (2 * kPi);
  return {exponent.re - loss * task.range_step_m, 2 * kPi * (turns - std::rint(turns))};
}

/// Logarithm of the magnitude of half a step's screen over flat ground.
EMSCAPE_HD inline double absorberExponent(const MarchBlockTask& task, int j) {
  const double above_m = j * task.height_step_m - task.usable_top_m;
  const double t = above_m > 0 ? above_m / task.absorber_m : 0;
  return -task.absorber_per_m * t * t * t * task.range_step_m / 2;
}

/// Logarithm of half a step's screen over flat ground under the first profile.
EMSCAPE_HD inline Complex<double> screenExponent(const MarchBlockTask& task, int j) {
  const double m =
      1e-6 * (block_tables::unitsAt(task, j * task.height_step_m) - block_tables::unitsAt(task, 0));
  return {absorberExponent(task, j),
          kPi / task.wavelength_m * task.range_step_m * (task.wide ? m : m + m * m / 2)};
}

/// Part of v[j] in the surface wave of the field that v[j] leaves: (r^j - r^(2N - j)) / (1 - r^2N).
EMSCAPE_HD inline Complex<double> surfaceWeight(const MarchBlockTask& task, int intervals, int j) {
  const auto power = [&](double exponent) { return exponential(task.log_ratio * exponent); };
  return (power(j) - power(2.0 * intervals - j)) / (Complex<double>{1, 0} - power(2.0 * intervals));
}

/// Entry i of the propagator (0 .. 16 kSpectral - 1), of the screens and of the weights (0 .. N - 1).
EMSCAPE_HD inline void fillTables(const MarchBlockTask& task, const BlockTables& tables, int intervals,
                                  int i) {
  const int N = intervals, lanes = N / 128, spectral = 9 * lanes, runs = 8 * lanes;
  if (i < 16 * spectral) {
    const int t = i % spectral, e = i / spectral;
    const int n = wavenumberOf(N, t / lanes, t % lanes, e);
    const Complex<double> exponent = propagatorExponent(task, N, n);
    const bool inside = n > 0 && n < N;
    if (tables.propagator != nullptr) {
      tables.propagator[i] =
          inside ? block_tables::stored(exponential(exponent) * (0.5 / N)) : StoredComplex();
    }
    if (tables.exponents != nullptr) {
      tables.exponents[i] = Complex<float>{float(exponent.im / (2 * kPi)),
                                           inside ? float(exponent.re / 0.69314718055994531) : -1000.0F};
    }
  }
  if (i >= N) return;
  if (tables.half_screen != nullptr) {
    const Complex<double> exponent = screenExponent(task, i);
    const StoredComplex half = block_tables::stored(exponential(exponent));
    const StoredComplex whole = block_tables::stored(exponential(exponent * 2.0));
    const int in_runs = i % 16 * runs + i / 16;
    tables.half_screen[i] = tables.half_in_runs[in_runs] = half;
    tables.whole_screen[i] = tables.whole_in_runs[in_runs] = whole;
    if (i == 0) tables.half_screen[N] = tables.whole_screen[N] = StoredComplex();
  }
  if (tables.weights != nullptr) tables.weights[i] = block_tables::stored(surfaceWeight(task, N, i));
}

/// Factor of the surface wave for a step along a slope: exp(i d (sqrt(k^2 + (ln r / (dz cos))^2) - k)).
EMSCAPE_HD inline StoredComplex surfaceWave(const MarchBlockTask& task, double cosine) {
  const double scale = 1 / (task.height_step_m * cosine);
  const Complex<double> decay = task.log_ratio * scale, squared = decay * decay;
  return block_tables::stored(exponential(stepExponent(
      task.wide, 2 * kPi / task.wavelength_m, task.range_step_m / cosine, {-squared.re, -squared.im})));
}

/// Plans all steps of an azimuth from its state on, if it has N intervals.
EMSCAPE_HD inline void planSteps(const MarchBlockTask& task, int intervals, PlannedStep* planned,
                                 int azimuth) {
  const MarchState& state = task.states[azimuth];
  if (state.intervals != intervals) return;
  const float* const ground_m = task.ground_msl_m + std::size_t(azimuth) * task.ground_steps;
  const double max_sine = task.wavelength_m / (2 * task.height_step_m);
  double here_m = state.ground_m, sine = state.sine;
  for (int s = state.step; s < state.end_step; ++s) {
    const std::size_t next = std::size_t(s) + 1;
    const double rise_m = double(ground_m[next < task.ground_steps ? next : task.ground_steps - 1]) - here_m;
    const GroundStep step = groundStep(rise_m, task.range_step_m, sine, s == 0, max_sine, task.slope_part);
    const double tangent = step.sine / step.cosine;
    PlannedStep plan;
    const double turns = task.height_step_m * step.turn / task.wavelength_m,
                 reduced = turns - std::rint(turns);
    plan.turns = float(std::rint(reduced * 4096) / 4096);
    plan.turns_rest = float(reduced - double(plan.turns));
    plan.middle_m = float(here_m + task.range_step_m / 2 * tangent);
    plan.half_m = float(task.range_step_m / 2 / step.cosine);
    const double square = 1 / (step.cosine * step.cosine);
    plan.square = float(tangent * tangent);
    plan.cube = float(square / step.cosine - 1);
    if (task.mixed) plan.wave = surfaceWave(task, step.cosine);
    plan.shift = int(std::lround(step.stair_m / task.height_step_m));
    here_m += task.range_step_m * tangent + plan.shift * task.height_step_m;
    plan.ground_m = here_m;
    plan.sine = sine = step.sine;
    planned[std::size_t(azimuth) * task.end_step + s] = plan;
  }
}

}  // namespace emscape::propagation
