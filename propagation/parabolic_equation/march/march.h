/// March of the parabolic equation outwards over a group of azimuths, one per vector lane.
///
/// Split-step Fourier (Feit and Fleck's wide-angle form): a step multiplies the field by half of the air's
/// screen, multiplies its sine spectrum by the propagator, and multiplies by the other half. Over terrain the
/// heights are above the ground, piecewise linear (wide-angle shift map after Donohue and Kuttler 2000, T-AP
/// 48(2)): the propagator belongs to the slope, and the phase turns at each break of it. The surface is
/// Dirichlet's or that of the mixed transform (surface.h). Time goes as exp(-i omega t). The field is
/// normalised so that |u| = 1 / sqrt(lambda x) in free space.
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "propagation/parabolic_equation/air/refractivity.h"
#include "propagation/parabolic_equation/march/march_grid.h"
#include "propagation/parabolic_equation/march/sine_transform.h"
#include "propagation/parabolic_equation/march/source.h"
#include "propagation/parabolic_equation/march/surface.h"

namespace emscape::propagation {

/// One azimuth.
struct RadialPath {
  PeSource source;
  RefractivityAlongPath air;
  PeSurface surface;
  /// Heights above mean sea level at 0, 1, 2, ... range steps; level beyond the last. Empty: 0 m everywhere.
  std::vector<double> ground_msl_m;
};

/// The reference of LaneMarch and of the march on a GPU. Not thread-safe. Compiled for double and float with
/// one lane.
template <class Real, int kLanes>
class RadialMarch {
 public:
  static constexpr int kLaneCount = kLanes;

  /// Starts at range 0 with the sources.
  /// @throws Error (bad_input) for a grid outside its limits (checkGrid()), a source below the ground (on
  /// a perfect surface: at it) or above the usable domain, terrain with holes (NaN), or a surface outside the
  /// mixed transform's limits
  RadialMarch(const MarchGrid& grid, std::array<RadialPath, kLanes> paths);

  /// Advances by one range step.
  void advance();
  /// Range: number of steps done times the range step.
  double range_m() const { return steps_ * grid_.range_step_m; }
  const MarchGrid& grid() const { return grid_; }

  /// Height of the ground under the field (m above mean sea level); beyond a staircase it differs from the
  /// given height by up to half a height step.
  double ground_m(int lane) const { return lanes_[std::size_t(lane)].ground_m; }
  /// Current number of height steps: N, or less after halving.
  int intervals() const { return sines_.intervals(); }
  double heightStep_m() const { return grid_.top_m / intervals(); }
  /// |u| at a height above the ground, 0 .. top; linear between the heights.
  double amplitude(int lane, double height_agl_m) const;
  /// 20 log10 of the propagation factor: the field over that in free space at the slant range. Range > 0. A
  /// receiver has the band and the obliquity of the source, so that the factor is the same with exchanged
  /// ends.
  double factorDb(int lane, double height_agl_m) const;
  /// Mean of the squared factor over heights above the ground, z1 < z2, both within 0 .. top.
  double meanSquaredFactor(int lane, double z1_m, double z2_m) const;

  /// Sets the field to zero below an absorbing edge and halves it at the edge, at the current range.
  void screenBelow(int lane, double height_agl_m);
  /// Replaces the field of a lane.
  /// @param values  at the heights 0, 1, ... N-1
  void setField(int lane, const std::vector<std::complex<double>>& values);
  /// Sum of |u|^2 over the heights of a lane, times the height step.
  double energy(int lane) const;

 private:
  using Value = LaneComplex<Real, kLanes>;
  struct Lane {
    RadialPath path;
    double ground_m = 0;             ///< under the field
    double sine = 0, cosine = 1;     ///< of the slope
    std::complex<double> ratio = 0;  ///< r of the mixed transform; 0: Dirichlet
    Complex<Real> surface_wave;      ///< A
  };

  /// Sine of the band's current largest angle.
  double maxSine() const { return wavelength_m(grid_.frequency_hz) / (2 * heightStep_m()); }
  double groundAt(const RadialPath& path, int step) const;
  void setRatio(int lane);
  /// Slope of the next segment; turns the field's phase at a break.
  /// @return rise (m) at the end of a segment that is replaced by a step; else 0
  double bend(int lane);
  void setScreen(int lane);
  void setPropagator(int lane);
  void splitSurface(int lane);
  void joinSurface(int lane);
  void shift(int lane, double rise_m);
  void halveIfEmpty();
  /// Square of slant range over range, for a rise above the source; 1 in the narrow form, whose field has no
  /// obliquity.
  double slantSquared(double rise_m) const;

  MarchGrid grid_;
  std::vector<Lane> lanes_;
  SineTransform<Real, kLanes> sines_;
  int steps_ = 0;
  std::vector<Value> field_, spectrum_, scratch_;
  std::vector<Value> half_screen_;  ///< air of half a step, absorber included
  std::vector<Value> propagator_;   ///< of a step, with the transforms' 2 / N
};

}  // namespace emscape::propagation
