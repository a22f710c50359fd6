/// March of one azimuth by a block of threads with the field in registers: the parabolic equation on a GPU.
/// The same source runs on the host, thread after thread, for tests.
///
/// The field at the heights j = 0..N is continued oddly to 2N heights; its Fourier transform is 2i times the
/// sine transform. A thread holds 16 heights, L = N/8 apart: the column t, t + L, ... of which the column L -
/// t is the mirror image. So the threads 0..L/2 hold everything, and a transform of 16 numbers in each gives
/// the sixteen residues of the wavenumbers; those of r and 16 - r are also mirror images. The rows of the
/// residues 0..8, of L values each, are then transformed by L/16 threads each, without a barrier of the
/// block. The inverse applies these steps in reverse without reordering: the propagator is stored in the
/// order of the threads.
#pragma once

#include <cstddef>

#include "base/math/device_math.h"
#include "base/math/device_turn.h"
#include "emscape/base/host_device.h"
#include "propagation/parabolic_equation/march/march_step.h"
#include "propagation/parabolic_equation/march/small_fourier.h"

namespace emscape::propagation {

/// A complex number in memory, read and written in one access.
struct alignas(8) StoredComplex {
  float re, im;

  EMSCAPE_HD StoredComplex() : re(0), im(0) {}
  EMSCAPE_HD StoredComplex(Complex<float> a) : re(a.re), im(a.im) {}
  EMSCAPE_HD operator Complex<float>() const { return {re, im}; }
};

/// Wavenumber n = 0..N of element e of a thread of the spectrum.
EMSCAPE_HD constexpr int wavenumberOf(int intervals, int row, int lane, int e) {
  const int lanes = intervals / 128, second = lanes < 16 ? lanes : 16, third = lanes / second;
  const int b = lane + lanes * (e / third);
  const int m = third > 1 ? b / 16 + 16 * (b % 16) + 256 * (e % third)
                          : lane + lanes * (e / second) + 16 * (e % second);
  const int n = 16 * (lanes == 1 ? e : m) + row;
  return n <= intervals ? n : 2 * intervals - n;
}

/// Sizes and indices of a block for N intervals of height.
template <int kHeights>
struct BlockShape {
  static constexpr int kIntervals = kHeights;        ///< N
  static constexpr int kColumns = kHeights / 8;      ///< L
  static constexpr int kHolders = kColumns / 2 + 1;  ///< threads that hold heights
  static constexpr int kRows = 9;
  static constexpr int kLanes = kColumns / 16;      ///< threads of a row
  static constexpr int kSpectral = kRows * kLanes;  ///< threads that hold wavenumbers
  static constexpr int kRuns = 8 * kLanes;          ///< threads that hold 16 heights in sequence
  static constexpr int kThreads = ((kSpectral > kHolders ? kSpectral : kHolders) + 31) / 32 * 32;
  static constexpr int kPitch = kColumns + kColumns / 16;    ///< of a row in memory, padded
  static constexpr int kSecond = kLanes < 16 ? kLanes : 16;  ///< radix of a row's second pass
  static constexpr int kThird = kLanes / kSecond;            ///< of its third
  static constexpr int kGroups = (kRuns + 15) / 16;
  static_assert(kLanes >= 1 && kThird <= 16);

  static EMSCAPE_HD constexpr int padded(int i) { return i + i / 16; }
  static EMSCAPE_HD constexpr int powerIndex(int j) { return j + j / 32; }
  /// Height of element q of a column, 0..N.
  static EMSCAPE_HD constexpr int height(int column, int q) {
    return q < 8 ? column + kColumns * q : 2 * kIntervals - column - kColumns * q;
  }
  /// True for exactly one of the elements that represent a height of 0..N-1.
  static EMSCAPE_HD constexpr bool owns(int column, int q) {
    return q < 8 || (column > 0 && column < kColumns / 2);
  }
  /// Wavenumber n = 0..N of element e of a thread of the spectrum.
  static EMSCAPE_HD constexpr int wavenumber(int row, int lane, int e) {
    return wavenumberOf(kIntervals, row, lane, e);
  }
};

/// Calls function(BlockShape<N>()) for an N of 128 .. kMax. @return false for another N
template <int kMax, int kFirst = 128, class Function>
bool withBlockShape(int intervals, const Function& function) {
  if (intervals == kFirst) {
    function(BlockShape<kFirst>());
    return true;
  }
  if constexpr (kFirst < kMax) return withBlockShape<kMax, 2 * kFirst>(intervals, function);
  return false;
}

/// Data of a step over terrain or through changing air, computed by planSteps() (march_block_tables.h).
struct PlannedStep {
  double ground_m = 0, sine = 0;  ///< at the end, above mean sea level, and of the slope
  float turns = 0,
        turns_rest = 0;        ///< phase of the break per height step, in turns: exact products, and the rest
  float middle_m = 0;          ///< height of the ground at the middle
  float half_m = 0;            ///< half of the step, along the slope
  float cube = 0, square = 0;  ///< 1 / cos^3 - 1, 1 / cos^2 - 1 of the slope
  StoredComplex wave;          ///< factor of the surface wave
  int shift = 0;               ///< height steps that the ground rises at the end
};

/// Levels of the air between two ranges; all levels change linearly with range.
struct AirSegment {
  double begin_m = 0, per_m = 0;  ///< of the range; per_m: 1 / length, 0: only the first profile
  int first = 0, levels = 0;
  float top_from = 0, top_to = 0;  ///< gradients above the last level
};
struct AirLevel {
  float from_m, from_units, to_m, to_units;
};

/// State of the march of an azimuth.
struct MarchState {
  int intervals = 0;  ///< N; less after halving
  int step = 0, cell = 0;
  int end_step = 0;  ///< at which it ends
  double ground_m = 0, sine = 0;
};

/// A march for one N. Pointers refer to memory of the processor that runs it.
struct MarchBlockTask {
  int azimuths = 0;
  int end_step = 0;       ///< the largest of all azimuths
  double slope_part = 1;  ///< MarchGrid::slope_part
  bool wide = true, mixed = false, halve = false;
  double range_step_m = 0, height_step_m = 0, wavelength_m = 0, usable_top_m = 0;
  double absorber_m = 0, absorber_per_m = 0;
  float dz_m = 0, usable_m = 0, per_absorber_m = 0, per_wavelength_m = 0;  ///< the same, for inner loops
  float absorber_log2_per_m = 0;                                           ///< at the top; negative
  float wavelengths = 0, per_step_m = 0;  ///< range step in wavelengths, and its inverse
  float sine_step = 0;                    ///< sine of the angle of the wavenumber 1
  int halve_from = 0, halve_pause = 1;    ///< steps
  double source_agl_m = 0;

  const float* ground_msl_m = nullptr;  ///< null: 0 m throughout
  std::size_t ground_steps = 0;
  PlannedStep flat;                           ///< of every step, where there is no terrain
  const PlannedStep* planned = nullptr;       ///< `end_step` of each azimuth; null: flat
  const StoredComplex* propagator = nullptr;  ///< flat: 16 x kSpectral, with 1 / 2N
  const StoredComplex* exponents =
      nullptr;  ///< terrain: the same in turns and log2 of the magnitude, without 1 / 2N
  /// Screens of half a step and of a whole one by height, and by position in a run; null: computed
  const StoredComplex *half_screen = nullptr, *whole_screen = nullptr;
  const StoredComplex *half_in_runs = nullptr, *whole_in_runs = nullptr;
  const AirSegment* segments = nullptr;
  const AirLevel* levels = nullptr;
  const int* first_segment = nullptr;  ///< of each azimuth's air, and one behind the last; of one, if common
  bool common_air = true;
  int max_levels = 0;

  Complex<double> log_ratio;               ///< ln r
  Complex<float> ratio, inverse_power;     ///< r; 1 / sum of r^2j
  const StoredComplex* weights = nullptr;  ///< of v[j] in the surface wave of the field that v[j] leaves

  int cell_heights = 0, cell_ranges = 0;
  double cell_bottom_msl_m = 0, cell_height_m = 0, cell_mean_height_m = 0;
  bool cells_above_ground = false;  ///< the bottom counts from the ground
  bool cells_are_points = false;    ///< RadialCells::are_points
  bool cells_overlap = false;       ///< RadialCells::overlap
  const int* cell_end = nullptr;    ///< steps at the end of each range of cells
  float* excess_db = nullptr;       ///< azimuths x cell_ranges x cell_heights

  int columns = 0;                    ///< to be kept
  const int* column_steps = nullptr;  ///< ascending
  float* amplitudes = nullptr;        ///< azimuths x columns x pitch
  int* column_intervals = nullptr;    ///< azimuths x columns
  double* column_ground_m = nullptr;

  MarchState* states = nullptr;
  std::size_t pitch = 0;            ///< of fields and amplitudes
  StoredComplex* fields = nullptr;  ///< azimuths x pitch, by height
  /// azimuths x sumsOfCells(): of the unfinished range of cells, then of the one before, if they overlap
  float* sums = nullptr;
  int* counts = nullptr;

  EMSCAPE_HD int sumsOfCells() const { return cells_overlap ? 2 * cell_heights : cell_heights; }
};

/// Shared memory of a block.
struct BlockMemory {
  StoredComplex *rows, *column_turns, *first_turns, *second_turns;
  StoredComplex *ends, *group_ends, *parts, *part_groups, *starts, *start_groups, *shares;
  float *power, *sums, *level_m, *level_units, *level_gradient;
  int* counts;

  /// @return bytes from base
  template <class Shape>
  EMSCAPE_HD std::size_t place(char* base, const MarchBlockTask& task) {
    std::size_t used = 0;
    take(base, used, rows, Shape::kRows * Shape::kPitch);
    take(base, used, column_turns, 9 * Shape::kHolders);
    take(base, used, first_turns, 16 * Shape::kLanes);
    take(base, used, second_turns, 16 * Shape::kThird);
    take(base, used, shares, Shape::kSpectral);
    const int mixed = task.mixed ? 1 : 0;
    take(base, used, ends, mixed * Shape::kRuns);
    take(base, used, group_ends, mixed * Shape::kGroups);
    take(base, used, parts, mixed * Shape::kHolders);
    take(base, used, part_groups, mixed * (Shape::kGroups + 1));
    take(base, used, starts, mixed * Shape::kRuns);
    take(base, used, start_groups, mixed * Shape::kGroups);
    take(base, used, power, task.cell_heights > 0 ? Shape::powerIndex(Shape::kIntervals) + 1 : 0);
    take(base, used, sums, task.sumsOfCells());
    take(base, used, counts, task.sumsOfCells());
    take(base, used, level_m, task.max_levels);
    take(base, used, level_units, task.max_levels);
    take(base, used, level_gradient, task.max_levels);
    return used;
  }

 private:
  template <class T>
  static EMSCAPE_HD void take(char* base, std::size_t& used, T*& pointer, int count) {
    pointer = reinterpret_cast<T*>(base + used);
    used += (std::size_t(count) * sizeof(T) + 7) / 8 * 8;
  }
};

/// Registers of a thread.
struct BlockThread {
  Complex<float> v[16];  ///< the field in a column, its spectrum, or the field in a run of heights
  float turns[16];       ///< phases of the half screens of the last step
  Complex<float> below;  ///< field below the run
  float below_turns = 0;
  Complex<float> base, base_below, lead, carry;  ///< r^(16 i), r^(16 i - 1), r^(16 (i mod 16))
};

/// Transforms of a block. Each function ends with a barrier of the block.
template <class Shape, class Team>
struct BlockTransform {
  static constexpr int L = Shape::kColumns, G = Shape::kLanes;

  /// Tables of the twiddle factors.
  static EMSCAPE_HD void prepare(Team& team, const BlockMemory& memory) {
    team.each([&](int t, BlockThread&) {
      for (int i = t; i < 9 * Shape::kHolders; i += Shape::kThreads) {
        memory.column_turns[i] =
            turn(double(i / Shape::kHolders) * (i % Shape::kHolders), 2 * Shape::kIntervals);
      }
      for (int i = t; i < 16 * G; i += Shape::kThreads)
        memory.first_turns[i] = turn(double(i / G) * (i % G), L);
      for (int i = t; i < 16 * Shape::kThird; i += Shape::kThreads) {
        memory.second_turns[i] = turn(double(i / Shape::kThird) * (i % Shape::kThird), G);
      }
    });
  }

  /// Writes the columns' residues into the rows.
  static EMSCAPE_HD void foldColumns(int t, BlockThread& x, const BlockMemory& memory) {
    SmallFourier<16, 1, float>::run(x.v);
    const bool pair = t > 0 && t < L / 2;
    const int at = Shape::padded(t), mirrored = Shape::padded(L - t);
    memory.rows[at] = x.v[0];
    if (pair) memory.rows[mirrored] = Complex<float>{} - x.v[0];
    EMSCAPE_UNROLL
    for (int r = 1; r <= 8; ++r) {
      const Complex<float> w = memory.column_turns[r * Shape::kHolders + t];
      StoredComplex* const row = memory.rows + r * Shape::kPitch;
      row[at] = x.v[r] * w;
      if (pair) row[mirrored] = Complex<float>{} - x.v[16 - r] * conjugate(w);
    }
  }

  /// Writes the rows' residues into the columns.
  static EMSCAPE_HD void unfoldColumns(int t, BlockThread& x, const BlockMemory& memory) {
    const int at = Shape::padded(t), mirrored = Shape::padded(t == 0 ? 0 : L - t);
    x.v[0] = memory.rows[at];
    EMSCAPE_UNROLL
    for (int r = 1; r <= 8; ++r) {
      const Complex<float> w = memory.column_turns[r * Shape::kHolders + t];
      const StoredComplex* const row = memory.rows + r * Shape::kPitch;
      x.v[r] = Complex<float>(row[at]) * conjugate(w);
      if (r < 8) x.v[16 - r] = Complex<float>{} - Complex<float>(row[mirrored]) * w;
    }
    SmallFourier<16, -1, float>::run(x.v);
  }

  /// Transforms rows to spectra, applies onSpectrum(row, lane, thread) in registers, and transforms back.
  template <class OnSpectrum>
  static EMSCAPE_HD void transformRows(Team& team, const BlockMemory& memory, const OnSpectrum& onSpectrum) {
    constexpr int kSecond = Shape::kSecond, kThird = Shape::kThird;
    const auto rowOf = [&](int t) { return memory.rows + t / G * Shape::kPitch; };
    const auto secondIndex = [](int lane, int e) {
      const int b = lane + G * (e / kSecond);
      return Shape::padded(b / kThird * G + b % kThird + kThird * (e % kSecond));
    };
    const auto thirdIndex = [](int lane, int e) {
      return Shape::padded((lane + G * (e / kThird)) * kThird + e % kThird);
    };
    team.eachInRows([&](int t, BlockThread& x) {
      if (t >= Shape::kSpectral) return;
      const int lane = t % G;
      StoredComplex* const row = rowOf(t);
      EMSCAPE_UNROLL
      for (int p = 0; p < 16; ++p) x.v[p] = row[Shape::padded(lane + G * p)];
      SmallFourier<16, 1, float>::run(x.v);
      if (G > 1) {
        EMSCAPE_UNROLL
        for (int a = 0; a < 16; ++a) {
          if (a > 0) x.v[a] = x.v[a] * Complex<float>(memory.first_turns[a * G + lane]);
          row[Shape::padded(lane + G * a)] = x.v[a];
        }
      }
    });
    if (kThird > 1) {
      team.eachInRows([&](int t, BlockThread& x) {
        if (t >= Shape::kSpectral) return;
        const int lane = t % G;
        StoredComplex* const row = rowOf(t);
        EMSCAPE_UNROLL
        for (int e = 0; e < 16; ++e) x.v[e] = row[secondIndex(lane, e)];
        EMSCAPE_UNROLL
        for (int i = 0; i < 16 / kSecond; ++i) SmallFourier<kSecond, 1, float>::run(x.v + i * kSecond);
        const int rest = lane % kThird;  // G is a multiple of it
        EMSCAPE_UNROLL
        for (int e = 0; e < 16; ++e) {
          row[secondIndex(lane, e)] =
              x.v[e] * Complex<float>(memory.second_turns[e % kSecond * kThird + rest]);
        }
      });
    }
    team.eachInRows([&](int t, BlockThread& x) {
      if (t >= Shape::kSpectral) return;
      const int lane = t % G;
      StoredComplex* const row = rowOf(t);
      constexpr int kLast = kThird > 1 ? kThird : kSecond;
      const auto place = [&](int e) { return kThird > 1 ? thirdIndex(lane, e) : secondIndex(lane, e); };
      if (G > 1) {
        EMSCAPE_UNROLL
        for (int e = 0; e < 16; ++e) x.v[e] = row[place(e)];
        EMSCAPE_UNROLL
        for (int i = 0; i < 16 / kLast; ++i) SmallFourier<kLast, 1, float>::run(x.v + i * kLast);
      }
      onSpectrum(t / G, lane, t, x);
      if (G > 1) {
        EMSCAPE_UNROLL
        for (int i = 0; i < 16 / kLast; ++i) SmallFourier<kLast, -1, float>::run(x.v + i * kLast);
        EMSCAPE_UNROLL
        for (int e = 0; e < 16; ++e) row[place(e)] = x.v[e];
      }
    });
    if (kThird > 1) {
      team.eachInRows([&](int t, BlockThread& x) {
        if (t >= Shape::kSpectral) return;
        const int lane = t % G, rest = lane % kThird;
        StoredComplex* const row = rowOf(t);
        EMSCAPE_UNROLL
        for (int e = 0; e < 16; ++e) {
          x.v[e] = Complex<float>(row[secondIndex(lane, e)]) *
                   conjugate<float>(memory.second_turns[e % kSecond * kThird + rest]);
        }
        EMSCAPE_UNROLL
        for (int i = 0; i < 16 / kSecond; ++i) SmallFourier<kSecond, -1, float>::run(x.v + i * kSecond);
        EMSCAPE_UNROLL
        for (int e = 0; e < 16; ++e) row[secondIndex(lane, e)] = x.v[e];
      });
    }
    team.each([&](int t, BlockThread& x) {
      if (t >= Shape::kSpectral) return;
      const int lane = t % G;
      StoredComplex* const row = rowOf(t);
      if (G > 1) {
        EMSCAPE_UNROLL
        for (int a = 0; a < 16; ++a) {
          x.v[a] = row[Shape::padded(lane + G * a)];
          if (a > 0) x.v[a] = x.v[a] * conjugate<float>(memory.first_turns[a * G + lane]);
        }
      }
      SmallFourier<16, -1, float>::run(x.v);
      EMSCAPE_UNROLL
      for (int p = 0; p < 16; ++p) row[Shape::padded(lane + G * p)] = x.v[p];
    });
  }

 private:
  static EMSCAPE_HD Complex<float> turn(double numerator, int denominator) {
    const double angle = 2 * kPi * numerator / denominator;
    return {float(std::cos(angle)), float(std::sin(angle))};
  }
};

}  // namespace emscape::propagation
