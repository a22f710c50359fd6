/// The reflected ray of a path, for models that add it to the direct ray.
#pragma once

namespace emscape::propagation {

/// Lower limit of the amplitude of the two rays' sum relative to the direct ray: nulls are at most 60 dB
/// deep.
constexpr double kMinInterference = 1e-3;

/// Plain data for host and device. The default is no reflected ray.
struct ReflectedRay {
  /// Complex amplitude relative to the direct ray, both between isotropic antennas; magnitude 0..1. With
  /// is_envelope: (magnitude, 0). For two polarisations with half of the power each: re is the mean and re^2
  /// + im^2 the mean square, im >= 0.
  float re = 0, im = 0;
  /// Weight of the interference in the path's loss (dB), 0..1: 1 in line of sight, 0 at and beyond the
  /// horizon, where only the direct ray counts.
  float weight = 0;
  /// Sine of the angle below the horizontal at which the ray leaves the emitter, 0..1. Its azimuth is that of
  /// the direct ray.
  float depression_sine = 0;
  bool is_envelope = false;  ///< the magnitudes of the rays are added, which gives the maxima of the lobes
};

}  // namespace emscape::propagation
