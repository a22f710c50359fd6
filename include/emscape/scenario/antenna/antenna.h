/// Antenna patterns: gain by direction in the antenna's own coordinates.
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "emscape/base/vec.h"

namespace emscape::scenario {

/// Representation of a pattern in host and device loops.
///
/// Directions are (forward, right, up) in the antenna's frame. Azimuth = atan2(right, forward), clockwise
/// seen from above, -pi..pi; elevation = atan2(up, hypot(forward, right)), -pi/2..pi/2: the spherical angles
/// of pattern cuts in 3GPP TR 38.901, 7.3, and in most measurements. An azimuth cut has the same width in
/// azimuth at every elevation, so that its angular width on the sphere falls with cos(elevation). At +-pi/2
/// azimuth is undefined (0 is used), and a separable pattern or a grid may depend on azimuth there. Planar
/// apertures are stored in direction cosines instead, which have no such pole: their beams widen in azimuth
/// by 1/cos(elevation).
enum class PatternKind {
  isotropic,     ///< 1 everywhere
  gaussian,      ///< exp of a quadratic form in azimuth and elevation, at least side_lobe_amplitude
  separable,     ///< azimuth_table(azimuth) * elevation_table(elevation), at least side_lobe_amplitude
  phased_array,  ///< planar aperture, continuous or of elements: azimuth_table(u - u0) * elevation_table(v -
                 ///< v0) * element pattern, at least side_lobe_amplitude, and equal to it behind the array; u
                 ///< = right, v = up (direction cosines)
  grid,          ///< bilinear in azimuth and elevation, at least side_lobe_amplitude
  refined_grid,  ///< the same with rows and columns at uneven angles
};

/// A pattern as plain data, for host and device loops. Amplitudes are relative voltages: 1 at the maximum;
/// table entries are signed, so that they pass smoothly through nulls. Tables are uniform, include both ends
/// and have an odd number of entries, so that the middle one is at 0: azimuth from -pi to pi, elevation from
/// -pi/2 to pi/2; for phased_array from -2 to 2 (a steered array reaches |u - u0| = 2).
struct PatternView {
  PatternKind kind = PatternKind::isotropic;
  /// gaussian: amplitude = max(exp(-(a az^2 + b el^2)), side_lobe_amplitude); a, b in 1/rad^2.
  float gaussian_azimuth = 0;
  float gaussian_elevation = 0;
  float side_lobe_amplitude = 0;
  /// Where |right| > lobe_tangent * forward, the amplitude is side_lobe_amplitude at every elevation, so that
  /// loops may skip these directions; 0: no such directions. See depthInLobe().
  float lobe_tangent = 0;
  /// separable, phased_array: amplitudes. refined_grid: positions in the grid, counted in columns and rows.
  const float* azimuth_table = nullptr;
  const float* elevation_table = nullptr;
  int azimuth_count = 0;
  int elevation_count = 0;
  /// grid, refined_grid: row-major, elevation rows, azimuth fastest.
  const float* grid_table = nullptr;
  int columns = 0;
  int rows = 0;
  /// phased_array: the element's pattern is cos(angle off boresight)^element_exponent in amplitude.
  float element_exponent = 0;
};

/// An antenna: its pattern, its gain, and the data that the view points to. Immutable; shared by pointer.
class Antenna {
 public:
  virtual ~Antenna() = default;
  /// Valid as long as this object lives.
  virtual PatternView view() const = 0;
  /// Amplitude (relative voltage, -1..1) in double: the closed form, or the interpolated measurement. It has
  /// the sign of the field, which changes from lobe to lobe of apertures and arrays. For tests and reports.
  virtual double signedAmplitudeTowards(const Vec3d& direction, double steer_u, double steer_v) const = 0;
  /// Its magnitude, 0..1.
  double amplitudeTowards(const Vec3d& direction, double steer_u, double steer_v) const;

  double gain_dbi = 0;            ///< at the maximum of the pattern
  double beamwidth_az_deg = 360;  ///< between the half-power points; 360 if there are none
  double beamwidth_el_deg = 180;  ///< 180 if there are none
  /// Beamwidth (rad) times aperture over wavelength: 0.886 for a uniform taper, 1.2 for a typical one.
  double aperture_factor = 1.2;
  bool is_array = false;    ///< steered electronically; other antennas turn
  std::string description;  ///< one line for `emscape info`

  /// Largest dimension D (m) of the aperture, D = aperture_factor * lambda / beamwidth with the narrower of
  /// the two beamwidths; for the far-field distance 2 D^2 / lambda. 0 (no near field) without a beam.
  double apertureDimension_m(double wavelength_m) const;
  /// Directivity (dBi): 4 pi over the integral of the unsteered pattern's power over the sphere. No passive
  /// antenna with this pattern has a larger gain. Computed at the first call, in milliseconds. Threads may
  /// share the antenna.
  /// @accuracy 0.1 dB for beamwidths of 0.05 degree and more
  double directivity_dbi() const;

 private:
  mutable std::once_flag directivity_once_;
  mutable double directivity_dbi_ = 0;
};

using AntennaPtr = std::shared_ptr<const Antenna>;

}  // namespace emscape::scenario
