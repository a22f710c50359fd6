/// Steps of eight azimuths at once in float, one in each lane of a vector, with the instructions that the
/// processor has: AVX-512, AVX2, or those of every x86-64. The transform is that of march_block.h, its rows
/// of residues in the cache of the first level.
#pragma once

#include <vector>

#include "propagation/parabolic_equation/march/march_block.h"
#include "propagation/parabolic_equation/march/sine_transform.h"

namespace emscape::propagation {

constexpr int kStepLanes = 8;
using StepLanes = LaneComplex<float, kStepLanes>;

/// Largest N of these steps.
constexpr int kMaxLaneIntervals = 32768;

/// A wavenumber over flat ground.
struct FlatExponent {
  float turns = 0;      ///< phase of a step, reduced
  float magnitude = 0;  ///< of the propagator, with 1 / 2N
  float logarithm = 0;  ///< ln of its loss
  float cosine = 0;     ///< sqrt(1 - sine^2); < 0: evanescent
};

/// Memory of a transform: twiddle factors and 9 rows of residues.
struct LaneTables {
  const StoredComplex *column_turns, *first_turns, *second_turns;
  StepLanes* rows;
};

/// Tables of the transforms for one N, and their memory. Not thread-safe.
class LaneTransform {
 public:
  explicit LaneTransform(int intervals);

  int intervals() const { return intervals_; }
  /// Wavenumbers in the order of the tables of propagator and exponents.
  const std::vector<int>& wavenumbers() const { return wavenumbers_; }

  /// Sums of |spectrum|^2, of all wavenumbers and of the upper half.
  struct Shares {
    double all[kStepLanes] = {}, upper[kStepLanes] = {};
  };
  /// field <- inverse transform of the propagator times its transform. field[0] becomes 0.
  /// @param propagator  of all lanes, with 1 / 2N
  /// @param shares  null: not computed
  void step(StepLanes* field, const std::vector<StoredComplex>& propagator, Shares* shares);

  /// Slopes of the lanes: 1 / cos^3 - 1, 1 / cos^2 - 1 and 1 / cos - 1.
  struct Slopes {
    float cube[kStepLanes] = {}, square[kStepLanes] = {}, stretch[kStepLanes] = {};
  };
  /// The same over slopes.
  /// @param sine_step    sine of the angle of the wavenumber 1
  /// @param wavelengths  of a range step
  void step(StepLanes* field, const std::vector<FlatExponent>& exponents, const Slopes& slopes,
            float sine_step, float wavelengths, Shares* shares);

 private:
  LaneTables tables();

  int intervals_;
  std::vector<int> wavenumbers_;
  std::vector<StoredComplex> column_turns_, first_turns_, second_turns_;
  std::vector<StepLanes> rows_;
};

/// field[j] *= factors[j], for heights 0..n-1.
void multiplyLanes(StepLanes* field, const StoredComplex* factors, int n);
void multiplyLanes(StepLanes* field, const StepLanes* factors, int n);

/// The air over the ground of each lane.
struct LaneAir {
  const float* level_m[kStepLanes];   ///< ascending
  const float* units[kStepLanes];     ///< M at the levels
  const float* gradient[kStepLanes];  ///< above each of them
  int levels[kStepLanes];
  float middle_m[kStepLanes];                       ///< ground at the middle of the step
  float reference_units[kStepLanes];                ///< subtracted from M
  float half_turns[kStepLanes];                     ///< turns of half a step per m - 1
  float stretch[kStepLanes];                        ///< 1 / cos of the slope - 1
  float turns[kStepLanes], turns_rest[kStepLanes];  ///< of the break, per height step
};
/// Half screens of the lanes, and the field through them and the breaks of slope.
/// @param absorbed  magnitude of half a step over flat ground by height, and its logarithm
void screenLanes(const LaneAir& air, float dz_m, bool wide, const StoredComplex* absorbed, int n,
                 StepLanes* half, StepLanes* field);

/// The mixed transform's r with its tables: r^j, and the weights of v[j] in the surface wave of the field
/// that v[j] leaves.
struct LaneSurface {
  Complex<float> ratio, inverse_power;
  std::vector<StoredComplex> powers, weights;
};
/// u -> v[j] = u[j] - r u[j-1], v[0] = 0. @param wave  the surface wave's amplitudes
void splitLanes(const LaneSurface& surface, StepLanes* field, int n, StepLanes& wave);
/// v -> u with a surface wave of given amplitudes.
void joinLanes(const LaneSurface& surface, StepLanes* field, int n, const StepLanes& wave);

/// F^2 by height and lane.
/// @param spreading_m2  wavelength times range
/// @param rise, dz      of the ground above the source, and a height step, over the range
/// @param wide          of the wide form, whose F is over the slant range
void powerLanes(const StepLanes* field, int n, float spreading_m2, const float* rise, float dz, bool wide,
                float* power);

}  // namespace emscape::propagation
