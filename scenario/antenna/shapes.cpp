#include "scenario/antenna/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "scenario/antenna/tables.h"
#include "scenario/antenna/taper.h"

namespace emscape::scenario {
namespace {

/// Beamwidth (rad) times side over wavelength of a narrow, uniformly illuminated aperture.
constexpr double kEvenApertureFactor = 0.885892941;
/// Table steps as fractions of the beamwidth: within 1e-3 dB down to -40 dB, where the error of linear
/// interpolation is largest relative to the amplitude; finer where the shape has a corner.
constexpr double kStepsPerBeamwidth = 768;
constexpr double kStepsPerBeamwidthAtCorners = 2048;

double amplitudeOfDb(double decibels) {
  return std::pow(10.0, decibels / 20);
}

void requireBeamwidth(const char* name, double beamwidth_deg, double most_deg) {
  requireWithin(name, beamwidth_deg, 1e-3, most_deg, "deg");
}
void requireSideLobe(double side_lobe_db) {
  requireWithin("side_lobe_db", side_lobe_db, -200, 0, "dB");
}

/// a of exp(-a angle^2), in 1/rad^2, with half power at half the beamwidth; 0 for the full circle or half
/// circle, which have no half-power points.
double gaussianCoefficient(double beamwidth_deg, double full_deg) {
  const double half_rad = degToRad(beamwidth_deg / 2);
  return beamwidth_deg < full_deg ? 0.5 * std::log(2.0) / (half_rad * half_rad) : 0.0;
}

class IsotropicAntenna : public Antenna {
 public:
  PatternView view() const override { return {}; }
  double signedAmplitudeTowards(const Vec3d&, double, double) const override { return 1; }
};

class GaussianAntenna : public Antenna {
 public:
  GaussianAntenna(double azimuth, double elevation, double side_lobe_amplitude)
      : azimuth_(azimuth), elevation_(elevation), side_lobe_amplitude_(side_lobe_amplitude) {}

  PatternView view() const override {
    PatternView view;
    view.kind = PatternKind::gaussian;
    view.gaussian_azimuth = static_cast<float>(azimuth_);
    view.gaussian_elevation = static_cast<float>(elevation_);
    view.side_lobe_amplitude = static_cast<float>(side_lobe_amplitude_);
    view.lobe_tangent = lobeTangent(std::sqrt(-std::log(side_lobe_amplitude_) / azimuth_));
    return view;
  }
  double signedAmplitudeTowards(const Vec3d& direction, double, double) const override {
    const Angles angles = patternAngles(direction);
    return std::max(std::exp(-(azimuth_ * angles.azimuth_rad * angles.azimuth_rad +
                               elevation_ * angles.elevation_rad * angles.elevation_rad)),
                    side_lobe_amplitude_);
  }

 private:
  double azimuth_, elevation_, side_lobe_amplitude_;
};

/// Lobe limit of a pattern that covers the forward half space.
constexpr float kHalfSpaceTangent = 1e30f;

/// A planar aperture in direction cosines, continuous or of elements.
class PlanarAntenna : public Antenna {
 public:
  PlanarAntenna(ShapeTable u, ShapeTable v, double element_exponent, double side_lobe_amplitude)
      : u_(std::move(u)),
        v_(std::move(v)),
        element_exponent_(element_exponent),
        side_lobe_amplitude_(side_lobe_amplitude) {}

  PatternView view() const override {
    PatternView view;
    view.kind = PatternKind::phased_array;
    view.side_lobe_amplitude = static_cast<float>(side_lobe_amplitude_);
    view.lobe_tangent = kHalfSpaceTangent;
    view.azimuth_table = u_.values.data();
    view.elevation_table = v_.values.data();
    view.azimuth_count = u_.count();
    view.elevation_count = v_.count();
    view.element_exponent = static_cast<float>(element_exponent_);
    return view;
  }
  double signedAmplitudeTowards(const Vec3d& direction, double steer_u, double steer_v) const override {
    if (!(direction.x > 0)) return side_lobe_amplitude_;
    const double array = u_.shape(direction.y - steer_u) * v_.shape(direction.z - steer_v);
    const double magnitude = std::abs(array) * std::pow(direction.x, element_exponent_);
    return std::copysign(std::max(magnitude, side_lobe_amplitude_), array);
  }

 private:
  ShapeTable u_, v_;
  double element_exponent_, side_lobe_amplitude_;
};

/// Largest |u - u0| of a steered aperture.
constexpr double kDirectionCosineSpan = 2;

/// Pattern of a continuous aperture by direction cosine, with half power at the sine of half the beamwidth.
ShapeTable apertureTable(const Taper& taper, double beamwidth_deg) {
  const double side_wavelengths = taper.halfPower() / std::sin(degToRad(beamwidth_deg / 2));
  const auto pattern = [taper, side_wavelengths](double cosine) {
    return taper.pattern(side_wavelengths * cosine);
  };
  return tabulate(pattern, kDirectionCosineSpan, kEvenApertureFactor / side_wavelengths / kStepsPerBeamwidth);
}

/// Half-power width in direction cosine of an unsteered array with uniform weights.
double arrayWidth(int elements, double spacing_wavelengths) {
  return kEvenApertureFactor / (elements * spacing_wavelengths);
}

ShapeTable arrayTable(const Taper& taper, int elements, double spacing_wavelengths) {
  const auto factor = [taper, elements, spacing_wavelengths](double cosine) {
    return taper.arrayPattern(elements, kPi * spacing_wavelengths * cosine);
  };
  return tabulate(factor, kDirectionCosineSpan,
                  arrayWidth(elements, spacing_wavelengths) / kStepsPerBeamwidth);
}

/// Half-power width (deg) of the unsteered array in one of its principal planes.
double arrayBeamwidth_deg(const Shape& array_factor, double width_guess_rad, double element_exponent) {
  const auto cut = [&](double angle_rad) {
    return array_factor(std::sin(angle_rad)) * std::pow(std::max(std::cos(angle_rad), 0.0), element_exponent);
  };
  constexpr double kSteps = 128;
  const ShapeTable table = tabulate(cut, kPi / 2, std::min(width_guess_rad, 1.0) / kSteps);
  return radToDeg(halfPowerWidth(table.values, table.half_span, false));
}

}  // namespace

AntennaPtr makeIsotropic(double gain_dbi) {
  requireGain(gain_dbi);
  auto antenna = std::make_shared<IsotropicAntenna>();
  antenna->gain_dbi = gain_dbi;
  antenna->description = fmt::format("isotropic, {:.2f} dBi", gain_dbi);
  return antenna;
}

AntennaPtr makeGaussian(double gain_dbi, double beamwidth_az_deg, double beamwidth_el_deg,
                        double side_lobe_db) {
  requireGain(gain_dbi);
  requireBeamwidth("beamwidth_az_deg", beamwidth_az_deg, 360);
  requireBeamwidth("beamwidth_el_deg", beamwidth_el_deg, 180);
  requireSideLobe(side_lobe_db);
  return describedAntenna(std::make_shared<GaussianAntenna>(gaussianCoefficient(beamwidth_az_deg, 360),
                                                            gaussianCoefficient(beamwidth_el_deg, 180),
                                                            amplitudeOfDb(side_lobe_db)),
                          gain_dbi, beamwidth_az_deg, beamwidth_el_deg, "Gaussian beam");
}

AntennaPtr makeSinc(double gain_dbi, double beamwidth_az_deg, double beamwidth_el_deg, double side_lobe_db,
                    const Taper& taper) {
  requireGain(gain_dbi);
  requireBeamwidth("beamwidth_az_deg of a sinc pattern", beamwidth_az_deg, 180);
  requireBeamwidth("beamwidth_el_deg", beamwidth_el_deg, 180);
  requireSideLobe(side_lobe_db);
  auto antenna = std::make_shared<PlanarAntenna>(apertureTable(taper, beamwidth_az_deg),
                                                 apertureTable(taper, beamwidth_el_deg), 0.0,
                                                 amplitudeOfDb(side_lobe_db));
  antenna->aperture_factor = 2 * taper.halfPower();
  return describedAntenna(antenna, gain_dbi, beamwidth_az_deg, beamwidth_el_deg,
                          fmt::format("aperture, {} taper", toString(taper.kind())));
}

AntennaPtr makeCosecant2(double gain_dbi, double beamwidth_az_deg, double beamwidth_el_deg,
                         double max_elevation_deg, double side_lobe_db) {
  requireGain(gain_dbi);
  requireBeamwidth("beamwidth_az_deg", beamwidth_az_deg, 360);
  requireBeamwidth("beamwidth_el_deg", beamwidth_el_deg, 180);
  requireWithin("max_elevation_deg", max_elevation_deg, beamwidth_el_deg / 2, 90, "deg");
  requireSideLobe(side_lobe_db);
  const double azimuth_a = gaussianCoefficient(beamwidth_az_deg, 360);
  const auto azimuth = [azimuth_a](double angle_rad) { return std::exp(-azimuth_a * angle_rad * angle_rad); };
  const double nose_a = gaussianCoefficient(beamwidth_el_deg, std::numeric_limits<double>::infinity());
  const double nose_rad = degToRad(beamwidth_el_deg / 2);
  const double end_rad = degToRad(max_elevation_deg);
  const auto elevation = [nose_a, nose_rad, end_rad](double angle_rad) {
    if (angle_rad <= nose_rad) return std::exp(-nose_a * angle_rad * angle_rad);
    const double beyond_rad = std::max(angle_rad - end_rad, 0.0);
    return std::sqrt(0.5) * std::sin(nose_rad) / std::sin(std::min(angle_rad, end_rad)) *
           std::exp(-nose_a * beyond_rad * beyond_rad);
  };
  return describedAntenna(
      std::make_shared<SeparableAntenna>(
          tabulate(azimuth, kPi, degToRad(beamwidth_az_deg) / kStepsPerBeamwidth),
          tabulate(elevation, kPi / 2, degToRad(beamwidth_el_deg) / kStepsPerBeamwidthAtCorners),
          amplitudeOfDb(side_lobe_db)),
      gain_dbi, beamwidth_az_deg, beamwidth_el_deg,
      fmt::format("cosecant-squared to {:.4g} deg", max_elevation_deg));
}

AntennaPtr makePhasedArray(double gain_dbi, int columns, int rows, double spacing_wavelengths,
                           double element_exponent, double side_lobe_db, const Taper& taper) {
  requireGain(gain_dbi);
  requireWithin("columns", columns, 1, 1024, "elements");
  requireWithin("rows", rows, 1, 1024, "elements");
  requireWithin("spacing_wavelengths", spacing_wavelengths, 0.1, 1, "wavelengths");
  requireWithin("element_exponent", element_exponent, 0, 10, "");
  requireSideLobe(side_lobe_db);
  ShapeTable u = arrayTable(taper, columns, spacing_wavelengths);
  ShapeTable v = arrayTable(taper, rows, spacing_wavelengths);
  const double azimuth_deg =
      arrayBeamwidth_deg(u.shape, arrayWidth(columns, spacing_wavelengths), element_exponent);
  const double elevation_deg =
      arrayBeamwidth_deg(v.shape, arrayWidth(rows, spacing_wavelengths), element_exponent);
  auto antenna = std::make_shared<PlanarAntenna>(std::move(u), std::move(v), element_exponent,
                                                 amplitudeOfDb(side_lobe_db));
  antenna->aperture_factor = 2 * taper.halfPower();
  antenna->is_array = true;
  return describedAntenna(
      antenna, gain_dbi, azimuth_deg, elevation_deg,
      fmt::format("phased array of {} x {} elements, {} taper", columns, rows, toString(taper.kind())));
}

double gainFromBeamwidths_dbi(double beamwidth_az_deg, double beamwidth_el_deg) {
  return std::max(ratioToDb(26000 / (beamwidth_az_deg * beamwidth_el_deg)), 0.0);
}

double gainFromArray_dbi(int columns, int rows, double spacing_wavelengths, const Taper& taper) {
  return std::max(ratioToDb(4 * kPi * columns * rows * spacing_wavelengths * spacing_wavelengths *
                            taper.arrayEfficiency(columns) * taper.arrayEfficiency(rows)),
                  0.0);
}

}  // namespace emscape::scenario
