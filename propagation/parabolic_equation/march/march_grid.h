/// Steps and domain of a march, and their automatic choice.
#pragma once

#include <cmath>
#include <vector>

#include "emscape/base/units.h"
#include "propagation/choice.h"
#include "propagation/limits.h"

namespace emscape::propagation {

constexpr ModelLimit kPeFrequency{
    "frequency", "MHz", 1e6, 30, 40000, Beyond::refused, "heights and steps get too small"};
constexpr ModelLimit kPeAngle{
    "largest angle", "degrees", kPi / 180, 0.1, 35, Beyond::refused, "other models serve at larger angles"};
constexpr int kPeMaxIntervals = 32768;
constexpr double kPeEvenBand = 0.6;  ///< fraction of the band with a flat source spectrum (source.h)
/// Fractions of the band by which slopes may turn the rays in automatic grids over terrain: with the flat
/// part of the source and the absorbed last tenth they fill the band; and, where that holds all slopes, with
/// a part of the absorbed tenth.
constexpr double kPeSlopePart = 0.9 - kPeEvenBand, kPeMaxSlopePart = 1 - kPeEvenBand;
constexpr double kPeUsable = 0.8;          ///< fraction of the height below the absorber
constexpr double kPeAbsorberPart = 0.125;  ///< of the domain

/// Form of the one-way equation.
enum class PeForm {
  wide,    ///< Feit and Fleck: exact in air without gradient
  narrow,  ///< of small angles; for comparisons with its closed forms
};

/// Parameters common to all azimuths of a group.
struct MarchGrid {
  double frequency_hz = 0;
  double top_m = 0;   ///< of the domain above the ground, absorber included
  int intervals = 0;  ///< N, a power of two: the field is at heights j top_m / N above the ground
  double range_step_m = 0;
  double absorber_m = 0;  ///< thickness of the absorber below the top; 0: none
  /// Its rate at the top: the field decays as exp(-rate t^3 x), t = 0..1 in the layer.
  double absorber_per_m = 0;
  PeForm form = PeForm::wide;
  /// Fraction of the band by which slopes may turn the rays, at most 1. The rest of steeper slopes becomes a
  /// staircase.
  double slope_part = 1;
  bool halving = false;  ///< halves N where the upper half of the spectrum has left the domain

  double wavenumber() const { return 2 * kPi / wavelength_m(frequency_hz); }
  double heightStep_m() const { return top_m / intervals; }
  /// Sine of the largest angle of the sine transform.
  double maxSine() const { return wavelength_m(frequency_hz) / (2 * heightStep_m()); }
  /// Height above the ground up to which the domain's top does not affect the field.
  double usableTop_m() const { return top_m - absorber_m; }
};

/// Absorber whose two-way loss at the largest angle is 90 dB: the thickness is absorber_m, or else an eighth
/// of the domain.
void setAbsorber(MarchGrid& grid, double absorber_m = 0);

/// Largest range step (m): a quarter of the absorber's length along its steepest ray.
double absorberStep_m(const MarchGrid& grid);

/// @throws Error (bad_input) that names the value and its range: a frequency outside its limits, N not a
/// power of two in 8 .. 32768, a step or the domain not above 0, an absorber that is negative or fills the
/// domain
void checkGrid(const MarchGrid& grid);

/// Inputs of the automatic choice of steps.
struct MarchNeeds {
  double frequency_hz = 0;
  double max_height_m = 0;  ///< above the ground, up to which the field is wanted, the source included
  double max_angle_rad = degToRad(3.0);  ///< from the horizontal, up to which the field is wanted
  double post_spacing_m = 0;             ///< of the terrain; 0: smooth surface
  bool traps = false;                    ///< the air has a layer that traps
  double trapping_top_m = HUGE_VAL;      ///< of the highest layer that traps
};

struct AutomaticGrid {
  MarchGrid grid;
  double wanted_intervals = 0;  ///< of which grid.intervals is the next power of two
  std::vector<ModelChoice> choices;
};

/// Steps for a splitting error of 0.2 dB in nine of ten points, and a domain that holds the wanted heights
/// below 0.8 of what the absorber leaves.
/// @throws Error (bad_input) outside the limits; the message gives the largest angle possible with N = 32768
AutomaticGrid automaticGrid(const MarchNeeds& needs);

}  // namespace emscape::propagation
