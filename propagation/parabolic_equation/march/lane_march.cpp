#include "propagation/parabolic_equation/march/lane_march.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/work.h"
#include "propagation/parabolic_equation/march/march_block_tables.h"

namespace emscape::propagation {
namespace {

StoredComplex stored(Complex<double> a) {
  return block_tables::stored(a);
}

LaneMarchTables tablesOf(const BlockInput& input, const MarchBlockTask& scalars, int intervals) {
  LaneMarchTables tables;
  MarchBlockTask& task = tables.task = scalars;
  task.segments = input.segments.data();
  task.levels = input.levels.data();
  task.first_segment = input.first_segment.data();
  const LaneTransform transform(intervals);
  for (const int n : transform.wavenumbers()) {
    const bool inside = n > 0 && n < intervals;
    const Complex<double> exponent = propagatorExponent(task, intervals, n);
    if (input.flat) {
      tables.propagator.push_back(inside ? stored(exponential(exponent) * (0.5 / intervals))
                                         : StoredComplex());
      continue;
    }
    const double s = double(task.sine_step) * n, cosine2 = 1 - s * s;
    FlatExponent flat;
    flat.turns = float(exponent.im / (2 * kPi));
    flat.magnitude = inside && cosine2 > 0 ? float(std::exp(exponent.re) * 0.5 / intervals) : 0.0F;
    flat.logarithm = cosine2 > 0 ? float(exponent.re) : 0.0F;
    flat.cosine = cosine2 > 0 ? float(std::sqrt(cosine2)) : 1.0F;
    tables.exponents.push_back(flat);
  }
  for (int j = 0; j < intervals; ++j) {
    if (input.flat && input.steady_air) {
      tables.half_screen.push_back(stored(exponential(screenExponent(task, j))));
    } else {
      const double exponent = absorberExponent(task, j);
      tables.absorbed.push_back(Complex<float>{float(std::exp(exponent)), float(exponent)});
    }
    if (task.mixed) {
      tables.surface.powers.push_back(stored(exponential(task.log_ratio * double(j))));
      tables.surface.weights.push_back(stored(surfaceWeight(task, intervals, j)));
    }
  }
  tables.surface.ratio = task.ratio;
  tables.surface.inverse_power = task.inverse_power;
  return tables;
}

}  // namespace

LaneMarchPlan laneMarchPlan(const AzimuthMarch& march) {
  LaneMarchPlan plan;
  plan.march = &march;
  plan.input = blockInput(march, kMaxLaneIntervals);
  for (std::size_t i = 0; i < plan.input.tasks.size(); ++i) {
    checkpoint();
    plan.tables.push_back(tablesOf(plan.input, plan.input.tasks[i], plan.input.intervals[i]));
  }
  return plan;
}

LaneMarch::LaneMarch(const LaneMarchPlan& plan, int first, int count)
    : plan_(plan), first_(first), count_(count), transform_(plan.input.intervals.front()) {
  int end_step = 0;
  for (int l = 0; l < kStepLanes; ++l) {
    states_[std::size_t(l)] = plan.input.states[std::size_t(first + std::min(l, count - 1))];
    end_step = std::max(end_step, states_[std::size_t(l)].end_step);
  }
  for (MarchState& state : states_) state.end_step = end_step;
  for (const StoredComplex& u : plan.input.start) {
    StepLanes& lanes = field_.emplace_back();
    std::fill(std::begin(lanes.re), std::end(lanes.re), u.re);
    std::fill(std::begin(lanes.im), std::end(lanes.im), u.im);
  }
  if (plan.tables.front().half_screen.empty()) half_screen_.resize(field_.size());
  power_.resize(field_.size() * kStepLanes);
  planGround();
}

void LaneMarch::planGround() {
  if (plan_.input.flat) return;
  MarchBlockTask here = task();
  here.ground_msl_m = plan_.march->ground_msl_m.data() + std::size_t(first_) * here.ground_steps;
  here.states = states_.data();
  planned_.resize(std::size_t(count_) * std::size_t(here.end_step));
  for (int l = 0; l < count_; ++l) {
    checkpoint();
    planSteps(here, intervals(), planned_.data(), l);
  }
}

const PlannedStep& LaneMarch::planned(int l) const {
  if (plan_.input.flat) return task().flat;
  return planned_[std::size_t(std::min(l, count_ - 1)) * std::size_t(task().end_step) + std::size_t(step_)];
}

/// Levels of the air at the middle of the step.
void LaneMarch::prepareAir() {
  const BlockInput& input = plan_.input;
  const double range_m = (step_ + 0.5) * task().range_step_m;
  for (int l = 0; l < (task().common_air ? 1 : kStepLanes); ++l) {
    const std::size_t of = task().common_air ? 0 : std::size_t(first_ + std::min(l, count_ - 1));
    const int first = input.first_segment[of], end = input.first_segment[of + 1];
    Air& air = air_[std::size_t(l)];
    if (end == first + 1 && !air.units.empty()) continue;
    int i = first;
    while (i + 1 < end && input.segments[std::size_t(i) + 1].begin_m <= range_m) ++i;
    const AirSegment& segment = input.segments[std::size_t(i)];
    const float part = float((range_m - segment.begin_m) * segment.per_m);
    const auto between = [part](float from, float to) { return from + part * (to - from); };
    air = {};
    for (int n = 0; n < segment.levels; ++n) {
      const AirLevel& level = input.levels[std::size_t(segment.first + n)];
      air.level_m.push_back(between(level.from_m, level.to_m));
      air.units.push_back(between(level.from_units, level.to_units));
    }
    for (std::size_t n = 0; n + 1 < air.units.size(); ++n) {
      air.gradient.push_back((air.units[n + 1] - air.units[n]) / (air.level_m[n + 1] - air.level_m[n]));
    }
    air.gradient.push_back(between(segment.top_from, segment.top_to));
  }
}

/// The field through half of the air's screen, after the breaks of slope.
void LaneMarch::screen() {
  prepareAir();
  LaneAir lanes;
  for (int l = 0; l < kStepLanes; ++l) {
    const Air& air = air_[task().common_air ? 0 : std::size_t(l)];
    const PlannedStep& step = planned(l);
    lanes.level_m[l] = air.level_m.data();
    lanes.units[l] = air.units.data();
    lanes.gradient[l] = air.gradient.data();
    lanes.levels[l] = int(air.units.size());
    lanes.middle_m[l] = step.middle_m;
    lanes.half_turns[l] = step.half_m * task().per_wavelength_m;
    lanes.stretch[l] = 2 * step.half_m * task().per_step_m - 1;
    lanes.turns[l] = step.turns;
    lanes.turns_rest[l] = step.turns_rest;
    const float ground_m = float(states_[std::size_t(l)].ground_m);
    std::size_t level = 0;
    while (level + 1 < air.units.size() && air.level_m[level + 1] <= ground_m) ++level;
    lanes.reference_units[l] = air.units[level] + air.gradient[level] * (ground_m - air.level_m[level]);
  }
  screenLanes(lanes, task().dz_m, task().wide, tables().absorbed.data(), intervals(), half_screen_.data(),
              field_.data());
}

void LaneMarch::advance() {
  const int n = intervals();
  const LaneMarchTables& of = tables();
  const bool steady = !of.half_screen.empty();
  const bool test = task().halve && step_ + 1 >= task().halve_from && (step_ + 1) % task().halve_pause == 0;
  if (steady) {
    multiplyLanes(field_.data(), of.half_screen.data(), n);
  } else {
    screen();
  }
  StepLanes wave;
  if (task().mixed) splitLanes(of.surface, field_.data(), n, wave);
  LaneTransform::Shares shares;
  if (plan_.input.flat) {
    transform_.step(field_.data(), of.propagator, test ? &shares : nullptr);
  } else {
    LaneTransform::Slopes slopes;
    for (int l = 0; l < kStepLanes; ++l) {
      const PlannedStep& step = planned(l);
      slopes.cube[l] = step.cube;
      slopes.square[l] = step.square;
      slopes.stretch[l] = 2 * step.half_m * task().per_step_m - 1;
    }
    transform_.step(field_.data(), of.exponents, slopes, task().sine_step, task().wavelengths,
                    test ? &shares : nullptr);
  }
  if (task().mixed) {
    for (int l = 0; l < kStepLanes; ++l) {
      const Complex<float> factor = planned(l).wave, before{wave.re[l], wave.im[l]}, after = before * factor;
      wave.re[l] = after.re;
      wave.im[l] = after.im;
    }
    joinLanes(of.surface, field_.data(), n, wave);
  }
  if (steady) {
    multiplyLanes(field_.data(), of.half_screen.data(), n);
  } else {
    multiplyLanes(field_.data(), half_screen_.data(), n);
  }
  for (int l = 0; l < kStepLanes; ++l) {
    MarchState& state = states_[std::size_t(l)];
    const PlannedStep& step = planned(l);
    state.ground_m = step.ground_m;
    state.sine = step.sine;
    if (step.shift != 0) shift(l, step.shift);
  }
  ++step_;
  has_power_ = false;
  if (!test) return;
  for (int l = 0; l < kStepLanes; ++l) {
    if (shares.upper[l] > 1e-6 * shares.all[l]) return;
  }
  halve();
}

/// Shifts the field by whole height steps: the ground rises (> 0) or falls.
void LaneMarch::shift(int l, int by) {
  const int n = intervals();
  for (int i = 0; i < n; ++i) {
    const int j = by > 0 ? i : n - 1 - i, from = j + by;
    const bool inside = from >= 0 && from < n && j > 0;
    field_[std::size_t(j)].re[l] = inside ? field_[std::size_t(from)].re[l] : 0.0F;
    field_[std::size_t(j)].im[l] = inside ? field_[std::size_t(from)].im[l] : 0.0F;
  }
}

void LaneMarch::halve() {
  const std::size_t n = std::size_t(intervals()) / 2;
  for (std::size_t j = 0; j < n; ++j) field_[j] = field_[2 * j];
  field_.resize(n);
  ++level_;
  transform_ = LaneTransform(int(n));
  for (MarchState& state : states_) {
    state.intervals = int(n);
    state.step = step_;
  }
  planGround();
}

double LaneMarch::meanSquaredFactor(int l, double z1_m, double z2_m) {
  const int n = intervals();
  if (!has_power_) {
    const MarchBlockTask& scalars = task();
    const std::vector<float>& ground_m = plan_.march->ground_msl_m;
    float rise[kStepLanes];
    for (int i = 0; i < kStepLanes; ++i) {
      const std::size_t azimuth = std::size_t(first_ + std::min(i, count_ - 1));
      const double source_m =
          scalars.source_agl_m + (ground_m.empty() ? 0 : double(ground_m[azimuth * scalars.ground_steps]));
      rise[i] = float((states_[std::size_t(i)].ground_m - source_m) / range_m());
    }
    powerLanes(field_.data(), n, float(scalars.wavelength_m * range_m()), rise,
               float(scalars.height_step_m / range_m()), scalars.wide, power_.data());
    has_power_ = true;
  }
  const float* const power = power_.data() + l;
  const auto at = [power](int j) { return double(power[std::size_t(j) * kStepLanes]); };
  const double per_step = 1 / task().height_step_m, z1 = z1_m * per_step, z2 = z2_m * per_step;
  // |u|^2 is taken as linear between the heights
  const int first = std::clamp(int(z1), 0, n - 2), last = std::clamp(int(std::ceil(z2)), first + 1, n - 1);
  double sum = 0, here = at(first);
  for (int j = first; j < last; ++j) {
    const double next = at(j + 1);
    const double a = std::max(z1 - j, 0.0), b = std::min(z2 - j, 1.0);
    sum += (b - a) * (here + (a + b) / 2 * (next - here));
    here = next;
  }
  return sum / (z2 - z1);
}

}  // namespace emscape::propagation
