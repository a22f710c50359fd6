#include "propagation/parabolic_equation/march/march_block_input.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "emscape/base/error.h"
#include "propagation/parabolic_equation/march/march_block_tables.h"
#include "propagation/parabolic_equation/march/march_start.h"

namespace emscape::propagation {
namespace {

/// Appends the levels between two profiles: level by level, or at the heights of both.
void addSegment(BlockInput& input, double begin_m, double length_m, const RefractivityProfile& from,
                const RefractivityProfile& to, double reference_units) {
  AirSegment segment;
  segment.begin_m = begin_m;
  segment.per_m = length_m > 0 ? 1 / length_m : 0;
  segment.first = int(input.levels.size());
  segment.top_from = float(from.top_gradient_m);
  segment.top_to = float(to.top_gradient_m);
  const auto add = [&](double from_m, double from_units, double to_m, double to_units) {
    input.levels.push_back(
        {float(from_m), float(from_units - reference_units), float(to_m), float(to_units - reference_units)});
  };
  if (from.levels.size() == to.levels.size()) {
    for (std::size_t l = 0; l < from.levels.size(); ++l) {
      add(from.levels[l].height_msl_m, from.levels[l].m_units, to.levels[l].height_msl_m,
          to.levels[l].m_units);
    }
  } else {
    std::set<double> heights_m;
    for (const RefractivityProfile* profile : {&from, &to}) {
      for (const RefractivityLevel& level : profile->levels) heights_m.insert(level.height_msl_m);
    }
    for (const double z : heights_m) add(z, from.at(z), z, to.at(z));
  }
  segment.levels = int(input.levels.size()) - segment.first;
  input.segments.push_back(segment);
}

void addAir(BlockInput& input, const RefractivityAlongPath& air) {
  const auto& profiles = air.profiles();
  const auto& ranges_m = air.ranges_m();
  const double reference_units = profiles.front().levels.front().m_units;
  input.first_segment.push_back(int(input.segments.size()));
  addSegment(input, -1e9, 0, profiles.front(), profiles.front(), reference_units);
  for (std::size_t i = 0; i + 1 < profiles.size(); ++i) {
    addSegment(input, ranges_m[i], ranges_m[i + 1] - ranges_m[i], profiles[i], profiles[i + 1],
               reference_units);
  }
  if (profiles.size() > 1)
    addSegment(input, ranges_m.back(), 0, profiles.back(), profiles.back(), reference_units);
}

/// Steps at the end of each range of cells, as marchCells() counts them.
std::vector<int> cellEnds(const AzimuthMarch& march) {
  std::vector<int> ends;
  const double step_m = march.grid.range_step_m;
  int steps = 0;
  for (int i = 0; i < march.cells.ranges; ++i) {
    const double last_m = (i + 1) * march.cells.range_step_m * (1 + 1e-12) - step_m;
    while (steps * step_m <= last_m) ++steps;
    ends.push_back(steps);
  }
  return ends;
}

MarchBlockTask taskOf(const AzimuthMarch& march, const BlockInput& input, int intervals, int end_step) {
  const MarchGrid& grid = march.grid;
  MarchBlockTask task;
  task.azimuths = march.azimuths;
  task.end_step = end_step;
  task.wide = grid.form == PeForm::wide;
  task.slope_part = grid.slope_part;
  task.range_step_m = grid.range_step_m;
  task.height_step_m = grid.top_m / intervals;
  task.wavelength_m = wavelength_m(grid.frequency_hz);
  task.usable_top_m = grid.usableTop_m();
  task.absorber_m = grid.absorber_m;
  task.absorber_per_m = grid.absorber_per_m;
  task.dz_m = float(task.height_step_m);
  task.usable_m = float(task.usable_top_m);
  task.per_absorber_m = grid.absorber_m > 0 ? float(1 / grid.absorber_m) : 0.0F;
  task.per_wavelength_m = float(1 / task.wavelength_m);
  task.absorber_log2_per_m = float(-grid.absorber_per_m / std::log(2.0));
  task.wavelengths = float(grid.range_step_m / task.wavelength_m);
  task.per_step_m = float(1 / grid.range_step_m);
  task.sine_step = float(task.wavelength_m / (2 * grid.top_m));
  task.source_agl_m = march.source.height_agl_m;
  task.ground_steps = march.ground_steps;
  task.flat.half_m = float(grid.range_step_m / 2);
  const double half_sine = task.wavelength_m / (4 * task.height_step_m);
  task.halve = grid.halving && intervals > kMinBlockIntervals && half_sine < 1;
  if (task.halve) {
    const double length_m = 1.5 * grid.top_m / std::tan(std::asin(half_sine));
    task.halve_from = int(std::ceil(length_m / grid.range_step_m));
    task.halve_pause = std::max(1, int(length_m / 8 / grid.range_step_m));
  }
  const std::complex<double> ratio = checkedRatio(grid, march.surface, task.height_step_m);
  task.mixed = !march.surface.perfect;
  if (task.mixed) {
    const std::complex<double> logarithm = std::log(ratio);
    const std::complex<double> inverse = (1.0 - ratio * ratio) / (1.0 - std::pow(ratio, 2.0 * intervals));
    task.log_ratio = {logarithm.real(), logarithm.imag()};
    task.ratio = {float(ratio.real()), float(ratio.imag())};
    task.inverse_power = {float(inverse.real()), float(inverse.imag())};
    task.flat.wave = surfaceWave(task, 1);
  }
  task.common_air = march.air.size() == 1;
  for (const AirSegment& segment : input.segments)
    task.max_levels = std::max(task.max_levels, segment.levels);
  task.cell_heights = march.cells.heights;
  task.cell_ranges = march.cells.ranges;
  task.cell_bottom_msl_m = march.cells.bottom_msl_m;
  task.cells_above_ground = march.cells.above_ground;
  task.cells_are_points = march.cells.are_points;
  task.cells_overlap = march.cells.overlap;
  task.cell_height_m = march.cells.height_step_m;
  task.cell_mean_height_m = march.cells.meanHeight_m();
  return task;
}

}  // namespace

BlockInput blockInput(const AzimuthMarch& march, int max_intervals, const std::vector<int>& columns_at) {
  const MarchGrid& grid = march.grid;
  checkMarch(march);
  checkSource(grid, march.source, march.surface);
  checkGround(grid, march.ground_msl_m.data(), march.ground_msl_m.size());
  if (grid.intervals < kMinBlockIntervals || grid.intervals > max_intervals) {
    throw Error(ErrorCode::bad_input, fmt::format("parabolic_equation: {} height steps; expected {} .. {}",
                                                  grid.intervals, kMinBlockIntervals, max_intervals));
  }
  BlockInput input;
  input.flat = march.ground_msl_m.empty();
  input.steady_air = march.air.size() == 1 && march.air.front().constant();
  input.kind = !march.surface.perfect           ? BlockKind::mixed
               : input.flat && input.steady_air ? BlockKind::tables
                                                : BlockKind::terrain;
  for (const RefractivityAlongPath& air : march.air) addAir(input, air);
  input.first_segment.push_back(int(input.segments.size()));
  input.cell_end = cellEnds(march);
  const int cells_end = input.cell_end.empty() ? 0 : input.cell_end.back();
  const int columns_end = columns_at.empty() ? 0 : columns_at.back();
  const int end_step = std::max(cells_end, columns_end);
  for (int n = grid.intervals; n >= kMinBlockIntervals; n /= 2) {
    input.intervals.push_back(n);
    input.tasks.push_back(taskOf(march, input, n, end_step));
    const MarchBlockTask& task = input.tasks.back();
    if (!task.halve || task.halve_from >= end_step) break;
  }
  for (const std::complex<double>& u :
       startField(grid, march.source, checkedRatio(grid, march.surface, grid.heightStep_m()))) {
    input.start.push_back(Complex<float>{float(u.real()), float(u.imag())});
  }
  input.states.resize(std::size_t(march.azimuths));
  for (std::size_t a = 0; a < input.states.size(); ++a) {
    const int ranges = march.rangesOf(int(a));
    const int own_end = ranges > 0 ? input.cell_end[std::size_t(ranges) - 1] : 0;
    input.states[a].intervals = grid.intervals;
    input.states[a].end_step = std::max(own_end, columns_end);
    input.states[a].ground_m = input.flat ? 0 : double(march.ground_msl_m[a * march.ground_steps]);
  }
  return input;
}

}  // namespace emscape::propagation
