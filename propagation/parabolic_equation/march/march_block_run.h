/// Steps of a block's march; see march_block.h.
#pragma once

#include "propagation/parabolic_equation/march/cell_span.h"
#include "propagation/parabolic_equation/march/march_block.h"

namespace emscape::propagation {

/// Kinds of marches; a GPU has one kernel per kind.
enum class BlockKind {
  tables,   ///< flat ground under one profile of the air, perfectly conducting: screens and propagator from
            ///< tables
  terrain,  ///< over terrain or through changing air, perfectly conducting
  mixed     ///< all with the mixed transform
};

/// March of an azimuth from its state to state.end_step, or to the step at which N is halved.
/// @param Team  runs the threads of a block: each(f) calls f(thread, its registers) for all and then is a
/// barrier of the block; eachInRows(f) is a barrier of the threads of a row alone; eachFree(f) is none
template <class Shape, BlockKind kKind, class Team>
class BlockMarch {
 public:
  EMSCAPE_HD BlockMarch(const MarchBlockTask& task, int azimuth, Team& team, const BlockMemory& memory)
      : task_(task), azimuth_(azimuth), team_(team), memory_(memory), state_(task.states[azimuth]) {}

  EMSCAPE_HD void run() {
    if (state_.intervals != N || state_.step >= state_.end_step) return;
    load();
    bool halve = false;
    int column = 0;
    while (column < task_.columns && task_.column_steps[column] <= state_.step) ++column;
    while (state_.step < state_.end_step && !halve) {
      step_ = flat() ? task_.flat : task_.planned[std::size_t(azimuth_) * task_.end_step + state_.step];
      prepareAir();
      if (kMixed) {
        splitSurface();
      } else {
        screenColumns();
      }
      const bool test =
          task_.halve && state_.step + 1 >= task_.halve_from && (state_.step + 1) % task_.halve_pause == 0;
      spectrum(test);
      if (kMixed) joinSurface();
      screened_half_m_ = step_.half_m;
      ++state_.step;
      state_.ground_m = step_.ground_m;
      state_.sine = step_.sine;
      if (step_.shift != 0) shift();
      if (state_.cell < task_.cell_ranges) addToCells();
      if (column < task_.columns && task_.column_steps[column] == state_.step) keepColumn(column++);
      if (test) halve = upperHalfIsEmpty();
    }
    save(halve);
  }

 private:
  static constexpr int N = Shape::kIntervals;
  static constexpr bool kMixed = kKind == BlockKind::mixed;

  /// True if the air's screens are in tables.
  EMSCAPE_HD bool steady() const {
    return kKind == BlockKind::tables || (kMixed && task_.half_screen != nullptr);
  }
  /// True if the propagator is in a table.
  EMSCAPE_HD bool flat() const { return kKind == BlockKind::tables || task_.planned == nullptr; }

  EMSCAPE_HD double groundAtSource() const {
    return task_.ground_msl_m == nullptr ? 0 : task_.ground_msl_m[std::size_t(azimuth_) * task_.ground_steps];
  }

  /// Calls f(height, value, t, place) for each height that a thread has, in columns or in runs.
  template <class Function>
  EMSCAPE_HD void forHeights(int t, BlockThread& x, const Function& f) {
    if (kMixed) {
      if (t >= Shape::kRuns) return;
      EMSCAPE_UNROLL
      for (int p = 0; p < 16; ++p) f(16 * t + p, x.v[p]);
    } else {
      if (t >= Shape::kHolders) return;
      EMSCAPE_UNROLL
      for (int q = 0; q < 16; ++q) {
        if (Shape::owns(t, q)) f(Shape::height(t, q), q < 8 ? x.v[q] : Complex<float>{} - x.v[q]);
      }
    }
  }
  /// Sets the field from value(height) for heights 0..N-1.
  template <class Function>
  EMSCAPE_HD void setHeights(int t, BlockThread& x, const Function& value) {
    if (kMixed) {
      if (t >= Shape::kRuns) return;
      EMSCAPE_UNROLL
      for (int p = 0; p < 16; ++p) x.v[p] = value(16 * t + p);
      x.below = t > 0 ? value(16 * t - 1) : Complex<float>{};
    } else {
      setColumn(t, x, value);
    }
  }
  template <class Function>
  EMSCAPE_HD void setColumn(int t, BlockThread& x, const Function& value) {
    if (t >= Shape::kHolders) return;
    EMSCAPE_UNROLL
    for (int q = 0; q < 16; ++q) {
      const int j = Shape::height(t, q);
      x.v[q] = j == 0 || j == N ? Complex<float>{} : value(j);
      if (q >= 8) x.v[q] = Complex<float>{} - x.v[q];
    }
  }

  EMSCAPE_HD void load() {
    const StoredComplex* const field = task_.fields + std::size_t(azimuth_) * task_.pitch;
    team_.each([&](int t, BlockThread& x) {
      setHeights(t, x, [&](int j) -> Complex<float> { return field[j]; });
      if (kMixed) {
        const auto power = [&](double exponent) {
          const Complex<double> found =
              exponential({task_.log_ratio.re * exponent, task_.log_ratio.im * exponent});
          return Complex<float>{float(found.re), float(found.im)};
        };
        x.base = power(16.0 * t);
        x.base_below = power(16.0 * t - 1);
        x.lead = power(16.0 * (t % 16));
      }
      const int sums = task_.sumsOfCells();
      for (int i = t; i < sums; i += Shape::kThreads) {
        memory_.sums[i] = task_.sums[std::size_t(azimuth_) * sums + i];
        memory_.counts[i] = task_.counts[std::size_t(azimuth_) * sums + i];
      }
    });
  }

  /// Stores the initial state of the next march.
  EMSCAPE_HD void save(bool halve) {
    finishScreen();
    team_.each([&](int, BlockThread&) {});  // the sums of all threads are written
    StoredComplex* const field = task_.fields + std::size_t(azimuth_) * task_.pitch;
    state_.intervals = halve ? N / 2 : N;
    team_.each([&](int t, BlockThread& x) {
      forHeights(t, x, [&](int j, Complex<float> u) {
        if (!halve) field[j] = u;
        if (halve && j % 2 == 0) field[j / 2] = u;
      });
      const int sums = task_.sumsOfCells();
      for (int i = t; i < sums; i += Shape::kThreads) {
        task_.sums[std::size_t(azimuth_) * sums + i] = memory_.sums[i];
        task_.counts[std::size_t(azimuth_) * sums + i] = memory_.counts[i];
      }
      if (t == 0) {
        task_.states[azimuth_] = state_;
      }
    });
  }

  /// Levels of the air at the middle of the step.
  EMSCAPE_HD void prepareAir() {
    if (steady()) return;
    const int air = task_.common_air ? 0 : azimuth_;
    const int first = task_.first_segment[air], end = task_.first_segment[air + 1];
    if (end == first + 1 && levels_ > 0) return;
    const double range_m = (state_.step + 0.5) * task_.range_step_m;
    int i = first;
    while (i + 1 < end && task_.segments[i + 1].begin_m <= range_m) ++i;
    const AirSegment segment = task_.segments[i];
    const float part = float((range_m - segment.begin_m) * segment.per_m);
    levels_ = segment.levels;
    const AirLevel* const levels = task_.levels + segment.first;
    team_.each([&](int t, BlockThread&) {
      for (int l = t; l < segment.levels; l += Shape::kThreads) {
        const auto heightOf = [&](int n) {
          return levels[n].from_m + part * (levels[n].to_m - levels[n].from_m);
        };
        const auto unitsOf = [&](int n) {
          return levels[n].from_units + part * (levels[n].to_units - levels[n].from_units);
        };
        memory_.level_m[l] = heightOf(l);
        memory_.level_units[l] = unitsOf(l);
        memory_.level_gradient[l] = l + 1 < segment.levels
                                        ? (unitsOf(l + 1) - unitsOf(l)) / (heightOf(l + 1) - heightOf(l))
                                        : segment.top_from + part * (segment.top_to - segment.top_from);
      }
    });
    level_stride_ = 1;
    while (2 * level_stride_ < levels_) level_stride_ *= 2;
  }

  /// Phase of half a screen at a height, in turns.
  EMSCAPE_HD float screenTurns(int j) const {
    const float z = step_.middle_m + float(j) * task_.dz_m;
    int level = 0;
    for (int stride = level_stride_; stride > 0; stride /= 2) {
      if (level + stride < levels_ && memory_.level_m[level + stride] <= z) level += stride;
    }
    const float units =
        memory_.level_units[level] + memory_.level_gradient[level] * (z - memory_.level_m[level]);
    const float m = 1e-6F * units;
    return (task_.wide ? m : m + m * m / 2) * (step_.half_m * task_.per_wavelength_m);
  }
  EMSCAPE_HD float absorbed(int j, float distance_m) const {
    const float t = (float(j) * task_.dz_m - task_.usable_m) * task_.per_absorber_m;
    return t > 0 ? powerOfTwo(task_.absorber_log2_per_m * t * t * t * distance_m) : 1.0F;
  }
  /// Half of the last step's screen, if still pending, the break of slope, and half of this step's screen.
  EMSCAPE_HD Complex<float> screen(int j, float& turns) const {
    const float before = screened_half_m_ > 0 ? turns : 0;
    turns = screenTurns(j);
    const float exact = step_.turns * float(j),
                whole = before + turns + (exact - rintf(exact)) + step_.turns_rest * float(j);
    Complex<float> factor;
    cosSinOfTurns(whole, factor.re, factor.im);
    return factor * absorbed(j, screened_half_m_ + step_.half_m);
  }

  EMSCAPE_HD void screenColumns() {
    const StoredComplex* const table = screened_half_m_ > 0 ? task_.whole_screen : task_.half_screen;
    team_.eachFree([&](int t, BlockThread& x) {
      if (t >= Shape::kHolders) return;
      EMSCAPE_UNROLL
      for (int q = 0; q < 16; ++q) {
        const int j = Shape::height(t, q);
        x.v[q] = x.v[q] * (steady() ? Complex<float>(table[j]) : screen(j, x.turns[q]));
      }
    });
  }

  /// The half screen of the last step, unless already applied.
  EMSCAPE_HD void finishScreen() {
    if (!(screened_half_m_ > 0)) return;
    const auto half = [&](int j, float turns) -> Complex<float> {
      if (steady()) return task_.half_screen[j];
      Complex<float> factor;
      cosSinOfTurns(turns, factor.re, factor.im);
      return factor * absorbed(j, screened_half_m_);
    };
    team_.each([&](int t, BlockThread& x) {
      if (kMixed) {
        if (t >= Shape::kRuns) return;
        EMSCAPE_UNROLL
        for (int p = 0; p < 16; ++p) x.v[p] = x.v[p] * half(16 * t + p, x.turns[p]);
        if (t > 0) x.below = x.below * half(16 * t - 1, x.below_turns);
      } else {
        if (t >= Shape::kHolders) return;
        EMSCAPE_UNROLL
        for (int q = 0; q < 16; ++q) x.v[q] = x.v[q] * half(Shape::height(t, q), x.turns[q]);
      }
    });
    screened_half_m_ = 0;
  }

  /// Transforms columns to the spectrum and back.
  EMSCAPE_HD void spectrum(bool test) {
    using Transform = BlockTransform<Shape, Team>;
    team_.each([&](int t, BlockThread& x) {
      if (t < Shape::kHolders) Transform::foldColumns(t, x, memory_);
    });
    Transform::transformRows(team_, memory_, [&](int row, int lane, int t, BlockThread& x) {
      if (test) {
        float all = 0, upper = 0;
        EMSCAPE_UNROLL
        for (int e = 0; e < 16; ++e) {
          const float power = norm(x.v[e]);
          all += power;
          if (Shape::wavenumber(row, lane, e) >= N / 2) upper += power;
        }
        const float part = row == 0 || row == 8 ? 0.5F : 1.0F;  // these rows hold each wavenumber twice
        memory_.shares[t] = Complex<float>{part * all, part * upper};
      }
      EMSCAPE_UNROLL
      for (int e = 0; e < 16; ++e) {
        const int at = e * Shape::kSpectral + t;
        x.v[e] = x.v[e] * (flat() ? Complex<float>(task_.propagator[at])
                                  : sloped(task_.exponents[at], Shape::wavenumber(row, lane, e)));
      }
    });
    team_.eachFree([&](int t, BlockThread& x) {
      if (t < Shape::kHolders) Transform::unfoldColumns(t, x, memory_);
    });
  }

  /// The propagator along the slope, from its exponent on flat ground; with p = k s, A^2 = 1 - s^2 and
  /// B^2 = 1 - s^2 / cos^2 the difference of the two phases is free of cancellation.
  EMSCAPE_HD Complex<float> sloped(Complex<float> flat, int n) const {
    const float s = float(n) * task_.sine_step, squared = s * s;
    const float steep = 1 - squared - squared * step_.square;
    if (!(steep > 0)) return {};
    const float a = rootOf(1 - squared), b = rootOf(steep);
    const float more =
        squared * quotient(step_.cube * (a + 1) + squared * quotient(step_.square, a + b), (a + 1) * (b + 1));
    Complex<float> factor;
    cosSinOfTurns(flat.re - more * task_.wavelengths, factor.re, factor.im);
    return factor * (powerOfTwo(flat.im * (2 * step_.half_m * task_.per_step_m)) * (0.5F / float(N)));
  }

  EMSCAPE_HD bool upperHalfIsEmpty() const {
    float all = 0, upper = 0;
    for (int t = 0; t < Shape::kSpectral; ++t) {
      all += memory_.shares[t].re;
      upper += memory_.shares[t].im;
    }
    return !(upper > 1e-6F * all);
  }

  /// u -> v[j] = u[j] - r u[j-1], v[0] = 0, in runs and then in columns; keeps the surface wave's amplitude.
  EMSCAPE_HD void splitSurface() {
    const bool whole = screened_half_m_ > 0;
    const StoredComplex* const table = whole ? task_.whole_in_runs : task_.half_in_runs;
    team_.each([&](int t, BlockThread& x) {
      if (t >= Shape::kRuns) return;
      const auto factor = [&](int p, int run, float& turns) {
        return steady() ? Complex<float>(table[p * Shape::kRuns + run]) : screen(16 * run + p, turns);
      };
      Complex<float> power{1, 0}, sum;
      Complex<float> below = t > 0 ? x.below * factor(15, t - 1, x.below_turns) : Complex<float>{};
      EMSCAPE_UNROLL
      for (int p = 0; p < 16; ++p) {
        const Complex<float> u = x.v[p] * factor(p, t, x.turns[p]);
        sum = sum + power * u;
        power = power * task_.ratio;
        const Complex<float> v = u - task_.ratio * below;
        memory_.rows[Shape::padded(16 * t + p)] = t == 0 && p == 0 ? Complex<float>{} : v;
        below = u;
      }
      memory_.starts[t] = sum * x.base;
    });
    team_.each([&](int t, BlockThread& x) {
      setColumn(t, x, [&](int j) -> Complex<float> { return memory_.rows[Shape::padded(j)]; });
    });
  }

  /// v -> u, in columns and then in runs, with the surface wave one step further.
  EMSCAPE_HD void joinSurface() {
    team_.each([&](int, BlockThread&) {});  // all rows have been read
    team_.each([&](int t, BlockThread& x) {
      if (t >= Shape::kHolders) return;
      Complex<float> part;
      EMSCAPE_UNROLL
      for (int q = 0; q < 16; ++q) {
        if (!Shape::owns(t, q)) continue;
        const int j = Shape::height(t, q);
        const Complex<float> v = q < 8 ? x.v[q] : Complex<float>{} - x.v[q];
        memory_.rows[Shape::padded(j)] = j == 0 ? Complex<float>{} : v;
        if (j > 0) part = part + v * Complex<float>(task_.weights[j]);
      }
      memory_.parts[t] = part;
    });
    team_.each([&](int t, BlockThread& x) {
      if (t < Shape::kGroups + 1) memory_.part_groups[t] = sumOf(memory_.parts, 16 * t, Shape::kHolders);
      if (t < Shape::kGroups) memory_.start_groups[t] = sumOf(memory_.starts, 16 * t, Shape::kRuns);
      if (t >= Shape::kRuns) return;
      Complex<float> y;
      EMSCAPE_UNROLL
      for (int p = 0; p < 16; ++p) {
        y = Complex<float>(memory_.rows[Shape::padded(16 * t + p)]) + task_.ratio * y;
        x.v[p] = y;
      }
      memory_.ends[t] = y;
    });
    const Complex<float> over_run = powerOf16(task_.ratio), over_group = powerOf16(over_run);
    team_.each([&](int t, BlockThread& x) {
      if (t >= Shape::kRuns) return;
      Complex<float> carry;
      for (int i = t / 16 * 16; i < t; ++i) carry = Complex<float>(memory_.ends[i]) + over_run * carry;
      x.carry = carry;
      if (t % 16 == 15) memory_.group_ends[t / 16] = x.v[15] + over_run * carry;
    });
    team_.each([&](int t, BlockThread& x) {
      if (t >= Shape::kRuns) return;
      Complex<float> carry, start, held;
      for (int g = 0; g < t / 16; ++g) carry = Complex<float>(memory_.group_ends[g]) + over_group * carry;
      carry = x.carry + x.lead * carry;
      for (int g = 0; g < Shape::kGroups; ++g) start = start + Complex<float>(memory_.start_groups[g]);
      for (int g = 0; g < Shape::kGroups + 1; ++g) held = held + Complex<float>(memory_.part_groups[g]);
      const Complex<float> wave = start * task_.inverse_power * Complex<float>(step_.wave) - held;
      Complex<float> above = task_.ratio * carry, surface = wave * x.base;
      x.below = t > 0 ? carry + wave * x.base_below : Complex<float>{};
      EMSCAPE_UNROLL
      for (int p = 0; p < 16; ++p) {
        x.v[p] = x.v[p] + above + surface;
        above = above * task_.ratio;
        surface = surface * task_.ratio;
      }
    });
  }
  static EMSCAPE_HD Complex<float> sumOf(const StoredComplex* values, int begin, int end) {
    Complex<float> sum;
    for (int i = begin; i < begin + 16 && i < end; ++i) sum = sum + Complex<float>(values[i]);
    return sum;
  }
  static EMSCAPE_HD Complex<float> powerOf16(Complex<float> a) {
    for (int i = 0; i < 4; ++i) a = a * a;
    return a;
  }

  /// Shifts the field by whole height steps.
  EMSCAPE_HD void shift() {
    finishScreen();  // ends with a barrier: the rows are no longer read
    const int by = step_.shift;
    team_.each([&](int t, BlockThread& x) {
      forHeights(t, x, [&](int j, Complex<float> u) { memory_.rows[Shape::padded(j)] = u; });
    });
    team_.each([&](int t, BlockThread& x) {
      setHeights(t, x, [&](int j) -> Complex<float> {
        const int from = j + by;
        if (j == 0 || from < 0 || from >= N) return {};
        return memory_.rows[Shape::padded(from)];
      });
    });
  }

  /// |u| by height; the pending half screen has magnitude 1 below the absorber.
  EMSCAPE_HD void keepColumn(int column) {
    const std::size_t of = std::size_t(azimuth_) * task_.columns + column;
    team_.eachFree([&](int t, BlockThread& x) {
      forHeights(t, x,
                 [&](int j, Complex<float> u) { task_.amplitudes[of * task_.pitch + j] = rootOf(norm(u)); });
      if (t == 0) {
        task_.column_intervals[of] = N;
        task_.column_ground_m[of] = state_.ground_m;
      }
    });
  }

  /// Adds F^2 of the step to the cells; writes losses at the end of a range of cells.
  EMSCAPE_HD void addToCells() {
    const bool ends = task_.cell_end[state_.cell] == state_.step;
    if (task_.cells_are_points && !ends) return;
    const double range_m = task_.range_step_m * state_.step;
    const float spreading_m2 = float(task_.wavelength_m * range_m);
    const float dz = float(task_.height_step_m / range_m);
    const float rise = float((state_.ground_m - groundAtSource() - task_.source_agl_m) / range_m);
    team_.each([&](int t, BlockThread& x) {
      forHeights(t, x, [&](int j, Complex<float> u) {
        const float tangent = rise + float(j) * dz;
        memory_.power[Shape::powerIndex(j)] =
            norm(u) * spreading_m2 * (task_.wide ? 1 + tangent * tangent : 1.0F);
      });
    });
    const double ground_m = task_.cells_above_ground ? 0 : state_.ground_m;
    const double below_m = task_.cell_bottom_msl_m - ground_m, per_step = 1 / task_.height_step_m;
    team_.eachFree([&](int t, BlockThread&) {
      for (int h = t; h < task_.cell_heights; h += Shape::kThreads) {
        const auto [z1_m, z2_m] = cellSpan(below_m, task_.cell_height_m, task_.cell_mean_height_m, h,
                                           task_.cells_are_points, task_.height_step_m, task_.usable_top_m);
        float sum = memory_.sums[h];
        int count = memory_.counts[h];
        if (z2_m > z1_m) {
          sum += meanPower(float(z1_m * per_step), float(z2_m * per_step));
          ++count;
        }
        if (ends) {
          const std::size_t at =
              (std::size_t(azimuth_) * task_.cell_ranges + state_.cell) * task_.cell_heights + h;
          float sum_of_cell = sum;
          int count_of_cell = count;
          if (task_.cells_overlap) {
            float& before = memory_.sums[task_.cell_heights + h];
            int& count_before = memory_.counts[task_.cell_heights + h];
            sum_of_cell += before;
            count_of_cell += count_before;
            before = sum;
            count_before = count;
          }
          task_.excess_db[at] =
              count_of_cell > 0 ? -10.0F * log10f(sum_of_cell / float(count_of_cell)) : nanf("");
          sum = 0;
          count = 0;
        }
        memory_.sums[h] = sum;
        memory_.counts[h] = count;
      }
    });
    if (ends) ++state_.cell;
  }
  /// Mean power between two heights (in height steps); the power is linear between the grid's heights.
  EMSCAPE_HD float meanPower(float z1, float z2) const {
    const int first = z1 < float(N - 2) ? int(z1) : N - 2;
    int last = int(ceilf(z2));
    last = last < first + 1 ? first + 1 : last > N - 1 ? N - 1 : last;
    float sum = 0, here = memory_.power[Shape::powerIndex(first)];
    for (int j = first; j < last; ++j) {
      const float next = memory_.power[Shape::powerIndex(j + 1)];
      const float a = fmaxf(z1 - float(j), 0.0F), b = fminf(z2 - float(j), 1.0F);
      sum += (b - a) * (here + (a + b) / 2 * (next - here));
      here = next;
    }
    return sum / fmaxf(z2 - z1, 1e-30F);
  }

  const MarchBlockTask& task_;
  const int azimuth_;
  Team& team_;
  const BlockMemory& memory_;
  MarchState state_;
  PlannedStep step_;
  float screened_half_m_ = 0;  ///< half step whose screen is pending
  int levels_ = 0, level_stride_ = 0;
};

}  // namespace emscape::propagation
