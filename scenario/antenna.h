/// Antenna patterns: gain by direction in the antenna's own coordinates.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/host_device.h"
#include "base/vec.h"

namespace emscape::scenario {

/// How a pattern is stored for the loops. Azimuth is clockwise (right of boresight) and elevation upwards, in the
/// antenna's coordinates: azimuth = atan2(right, forward), elevation = asin(up).
enum class PatternKind {
  isotropic,        ///< 1 everywhere
  gaussian,         ///< exp of a quadratic form in azimuth and elevation, not below side_lobe
  separable,        ///< azimuth_table(azimuth) * elevation_table(elevation)
  phased_array,     ///< u_table(u - u0) * v_table(v - v0) * element pattern; u = right, v = up (direction cosines)
  grid,             ///< bilinear in azimuth and elevation
};

/// A pattern as plain data: what the host and device loops read. Amplitudes are relative voltages: 1 at the maximum.
/// Tables are uniform: azimuth tables run from -pi to pi and elevation tables from -pi/2 to pi/2, both ends included;
/// u and v tables run from -2 to 2 (a steered array reaches |u - u0| = 2).
struct PatternView {
  PatternKind kind = PatternKind::isotropic;
  /// gaussian: amplitude = max(exp(-(a az^2 + b el^2)), side_lobe_amplitude); a, b in 1/rad^2.
  float gaussian_azimuth = 0;
  float gaussian_elevation = 0;
  float side_lobe_amplitude = 0;
  /// separable, phased_array, grid. Grid: row-major, elevation rows, azimuth fastest, azimuth_count x elevation_count.
  const float* azimuth_table = nullptr;
  const float* elevation_table = nullptr;
  const float* grid_table = nullptr;
  int azimuth_count = 0;
  int elevation_count = 0;
  /// phased_array: the element's pattern is cos(angle off boresight)^element_exponent in amplitude; 0 behind the array.
  float element_exponent = 0;
};

/// Amplitude (relative voltage, 0..1) towards a direction of the antenna's frame.
/// @param direction  unit vector (forward, right, up)
/// @param steer_u, steer_v  phased_array: the direction cosines (right, up) to which the array is steered; else ignored
/// @accuracy within 1e-4 dB of the pattern's closed form for gaussian, 1e-3 dB for tables, down to 40 dB below the maximum
EMSCAPE_HD inline float patternAmplitude(const PatternView& pattern, const Vec3f& direction, float steer_u,
                                         float steer_v);

/// An antenna: its pattern, its gain, and the data that the view points to. Immutable once made; shared by pointer.
class Antenna {
 public:
  virtual ~Antenna() = default;
  /// Valid as long as this object lives.
  virtual PatternView view() const = 0;

  double gain_dbi = 0;          ///< at the maximum of the pattern
  double beamwidth_az_deg = 360;  ///< between the half-power points
  double beamwidth_el_deg = 180;
  std::string description;      ///< one line for `emscape info`

  /// Gain (dBi) towards a direction (forward, right, up; unit). For tests, tables and reports, not for loops.
  double gainTowards_dbi(const Vec3d& direction, double steer_azimuth_rad = 0, double steer_elevation_rad = 0) const;
  /// Largest dimension D (m) of an aperture with this gain or beamwidth: for the far-field distance 2 D^2 / lambda.
  double apertureDimension_m(double wavelength_m) const;
};

using AntennaPtr = std::shared_ptr<const Antenna>;

}  // namespace emscape::scenario

#include "scenario/antenna_impl.h"
