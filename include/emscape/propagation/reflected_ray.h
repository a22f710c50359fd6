/// The reflected ray of a path, for models that add it to the direct one.
#pragma once

namespace emscape::propagation {

/// Smallest amplitude of the two rays' sum over that of the direct ray: nulls are 60 dB deep.
constexpr double kMinInterference = 1e-3;

/// As plain data, for host and device. The default is no reflected ray.
struct ReflectedRay {
  /// Complex amplitude over that of the direct ray, both between isotropic antennas; magnitude 0..1. With
  /// is_envelope: (magnitude, 0). Of two polarisations with half of the power each: re is the mean and
  /// re^2 + im^2 the mean square, im >= 0.
  float re = 0, im = 0;
  /// Part of the interference in the path's loss (dB), 0..1: 1 in sight, 0 from the horizon on, where the
  /// direct ray alone counts.
  float weight = 0;
  /// Sine of the angle below the horizontal at which the ray leaves the emitter, 0..1. Its azimuth is that of
  /// the direct ray.
  float depression_sine = 0;
  bool is_envelope = false;  ///< the rays' magnitudes add up: maxima of the lobes
};

}  // namespace emscape::propagation
