// Two rays: reflection, roughness, geometry over the sphere, lobes, and the way over to diffraction.
#include "propagation/two_ray/two_ray.h"

#include <gtest/gtest.h>

#include <cmath>

namespace emscape::propagation {
namespace {

constexpr double kEarth_m = 6371000.0 * 4 / 3;

TwoRayParameters seaAt(double frequency_hz) {
  TwoRayParameters parameters;
  parameters.frequency_hz = frequency_hz;
  parameters.effective_earth_radius_m = kEarth_m;
  parameters.ground = groundConstants(GroundKind::sea, frequency_hz);
  return parameters;
}

TEST(GroundConstants, SeaWaterMeetsPublishedFigures) {
  // P.527-6 fig. 3 and the measurements behind it: sea water at 20 degrees, 35 g/kg
  EXPECT_NEAR(waterConstants(1e8, 20, 35).conductivity_s_per_m, 4.8, 0.1);
  EXPECT_NEAR(waterConstants(1e8, 20, 35).relative_permittivity, 70, 2);
  const GroundConstants x_band = waterConstants(1e10, 20, 35);
  EXPECT_NEAR(x_band.relative_permittivity, 53, 3);
  EXPECT_NEAR(x_band.lossFactor(1e10), 38, 3);
  EXPECT_NEAR(waterConstants(1e8, 20, 0).relative_permittivity, 80, 1);
}

TEST(Fresnel, ReflectsPerfectlyAtGrazingAndAtMetal) {
  const Complex<double> ground{15, -3}, metal{1, -1e12};
  for (const auto polarization : {LinearPolarization::horizontal, LinearPolarization::vertical}) {
    const auto grazing = fresnelReflection(ground, polarization, 1e-9);
    EXPECT_NEAR(grazing.re, -1, 1e-6);
    EXPECT_NEAR(grazing.im, 0, 1e-6);
  }
  EXPECT_NEAR(fresnelReflection(metal, LinearPolarization::horizontal, 0.3).re, -1, 1e-5);
  EXPECT_NEAR(fresnelReflection(metal, LinearPolarization::vertical, 0.3).re, 1, 1e-4);
}

TEST(Fresnel, VanishesAtBrewstersAngleAndAgreesAtNormalIncidence) {
  const Complex<double> ground{9, 0};
  const double sine = 1 / std::sqrt(10.0);  // sin^2 = 1 / (1 + eps)
  EXPECT_NEAR(abs(fresnelReflection(ground, LinearPolarization::vertical, sine)), 0, 1e-12);
  EXPECT_NEAR(fresnelReflection(ground, LinearPolarization::horizontal, 1.0).re, -0.5, 1e-12);
  EXPECT_NEAR(fresnelReflection(ground, LinearPolarization::vertical, 1.0).re, 0.5, 1e-12);
}

TEST(Roughness, TakesFromSteepRaysMost) {
  EXPECT_EQ(roughnessFactor(RoughnessModel::ament, 0.0, 0.5, 0.1), 1);
  EXPECT_NEAR(roughnessFactor(RoughnessModel::miller_brown, 0.0, 0.5, 0.1), 1, 1e-12);
  // Rayleigh's criterion: sigma sin psi = lambda / 8, z = pi^2 / 8
  const double z = kPi * kPi / 8;
  EXPECT_NEAR(roughnessFactor(RoughnessModel::ament, 0.25, 0.05, 0.1), std::exp(-z), 1e-12);
  EXPECT_NEAR(roughnessFactor(RoughnessModel::miller_brown, 0.25, 0.05, 0.1),
              std::exp(-z) * std::cyl_bessel_i(0, z), 1e-6);
  for (double x = 0.01; x < 300; x *= 1.3) {
    EXPECT_NEAR(scaledBesselI0(x), std::exp(-x) * std::cyl_bessel_i(0, x), 2e-7) << x;
  }
}

TEST(TwoRay, ReflectsWhereThePathIsShortest) {
  // Fermat: over all points of the sphere the reflected path is shortest at the reflection.
  const auto segment = [](double range_m, double height_m) {
    const double chord = 2 * kEarth_m * std::sin(range_m / (2 * kEarth_m));
    return std::sqrt(height_m * height_m + chord * chord * (1 + height_m / kEarth_m));
  };
  const double cases[][3] = {
      {10e3, 20, 100}, {40e3, 30, 1000}, {100e3, 300, 3000}, {15e3, 10, 12}, {200e3, 50, 9000}};
  for (const auto& [d, h1, h2] : cases) {
    const double chord = 2 * kEarth_m * std::sin(d / (2 * kEarth_m));
    const double direct =
        std::sqrt((h2 - h1) * (h2 - h1) + chord * chord * (1 + h1 / kEarth_m) * (1 + h2 / kEarth_m));
    double low = 0, high = d;
    for (int i = 0; i < 200; ++i) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      if (segment(a, h1) + segment(d - a, h2) < segment(b, h1) + segment(d - b, h2)) {
        high = b;
      } else {
        low = a;
      }
    }
    const double shortest = segment(low, h1) + segment(d - low, h2) - direct;
    const auto path = reflectedPath(kEarth_m, d, h1, h2);
    EXPECT_NEAR(path.path_difference_m / shortest, 1, 2e-4) << d << ", " << h1 << ", " << h2;
    EXPECT_NEAR(low, h1 < h2 ? reflectionFromLower_m(d, h1, h2, kEarth_m) : 0, 1e-3 * d);
  }
}

TEST(TwoRay, LobesLieAtOddQuarterWavesOfHeight) {
  // Flat earth, reflection -1: maxima of 6 dB where h1 h2 / d is an odd multiple of lambda / 4
  TwoRayParameters parameters = seaAt(1e9);
  parameters.effective_earth_radius_m = 1e15;
  parameters.ground = {1, 1e15};
  const auto model = twoRayModel<double>(parameters);
  const double lambda = wavelength_m(1e9), d = 20e3, h1 = 30;
  EXPECT_NEAR(twoRayExcessDb(model, d, h1, lambda / 4 * d / h1), -6.02, 0.02);
  EXPECT_NEAR(twoRayExcessDb(model, d, h1, 3 * lambda / 4 * d / h1), -6.02, 0.02);
  EXPECT_GT(twoRayExcessDb(model, d, h1, 2 * lambda / 4 * d / h1), 25);
}

TEST(TwoRay, EnvelopeIsNeverBelowTheLobes) {
  TwoRayParameters parameters = seaAt(3e9);
  parameters.roughness_m = 0.3;
  const auto lobes = twoRayModel<double>(parameters);
  parameters.sum = TwoRaySum::envelope;
  const auto envelope = twoRayModel<double>(parameters);
  for (double h = 50; h < 3000; h += 1) {
    EXPECT_LE(twoRayExcessDb(envelope, 20e3, 25.0, h), twoRayExcessDb(lobes, 20e3, 25.0, h) + 1e-9);
  }
}

TEST(TwoRay, DivergesLessTheSteeperItIs) {
  const auto near_horizon = reflectedPath(kEarth_m, 35e3, 30.0, 30.0);
  const auto steep = reflectedPath(kEarth_m, 2e3, 30.0, 30.0);
  EXPECT_LT(near_horizon.divergence, 0.6);
  EXPECT_GT(steep.divergence, 0.99);
  // equal antennas: sin psi from h / d1 - d1 / 2 a
  const double d1 = 17.5e3;
  EXPECT_NEAR(near_horizon.sine, 30 / d1 - d1 / (2 * kEarth_m), 1e-7);
}

TEST(TwoRay, GoesOverToDiffractionWithoutJumps) {
  for (const auto polarization : {LinearPolarization::horizontal, LinearPolarization::vertical}) {
    for (const double frequency_hz : {1e8, 3e9}) {
      TwoRayParameters parameters = seaAt(frequency_hz);
      parameters.polarization = polarization;
      const auto model = twoRayModel<double>(parameters);
      const double horizon_m = std::sqrt(2 * kEarth_m) * (std::sqrt(30.0) + std::sqrt(200.0));
      // over the horizon
      const double before = twoRayExcessDb(model, horizon_m - 1, 30.0, 200.0);
      const double after = twoRayExcessDb(model, horizon_m + 1, 30.0, 200.0);
      EXPECT_NEAR(before, after, 0.05) << frequency_hz;
      EXPECT_NEAR(after, sphericalEarthLossDb(model.earth, horizon_m + 1, 30.0, 200.0), 1e-9);
      // where the clearance becomes what is required
      double last = twoRayExcessDb(model, 0.5 * horizon_m, 30.0, 200.0);
      for (double d = 0.5 * horizon_m; d < 1.2 * horizon_m; d += 5) {
        const double here = twoRayExcessDb(model, d, 30.0, 200.0);
        if (here < 15 || d > 0.95 * horizon_m) {
          ASSERT_NEAR(here, last, 0.3) << d << " m of " << horizon_m;
        }
        last = here;
      }
    }
  }
}

TEST(TwoRay, FloatIsCloseToDoubleOutsideTheNulls) {
  double worst = 0;
  for (const double frequency_hz : {1e8, 1e9, 1e10}) {
    for (const auto polarization : {LinearPolarization::horizontal, LinearPolarization::vertical}) {
      TwoRayParameters parameters = seaAt(frequency_hz);
      parameters.polarization = polarization;
      const auto model = twoRayModel<double>(parameters);
      const auto single = twoRayModel<float>(parameters);
      for (double d = 1000; d < 200e3; d *= 1.07) {
        for (double h = 2; h < 5000; h *= 1.13) {
          const float fd = float(d), fh = float(h);
          const double excess_db = twoRayExcessDb(model, double(fd), 20.0, double(fh));
          const auto path = reflectedPath(kEarth_m, double(fd), 20.0, double(fh));
          if (excess_db > 20 && excess_db < 61 && path.sine > 0) continue;
          if (path.path_difference_m > 3000 * wavelength_m(frequency_hz)) continue;
          worst = std::max(worst, std::abs(double(twoRayExcessDb(single, fd, 20.f, fh)) - excess_db));
        }
      }
    }
  }
  EXPECT_LT(worst, 0.05);
}

TEST(TwoRay, StraightAboveAntennaIsFinite) {
  const auto model = twoRayModel<float>(seaAt(1e9));
  for (const float d : {0.f, 1e-3f, 1.f, 10.f}) {
    for (const float h : {0.f, 1.f, 20.f, 5000.f}) {
      EXPECT_TRUE(std::isfinite(twoRayExcessDb(model, d, 20.f, h))) << d << ", " << h;
    }
  }
}

TEST(TwoRay, FieldsAddAsPowersAndRaysAsAmplitudes) {
  // A lobe of two equal rays is 6 dB above one, two incoherent powers 3 dB.
  ReflectedPath<double> path{wavelength_m(1e9) / 2, 1, 0.01, 1};
  TwoRayParameters parameters = seaAt(1e9);
  parameters.ground = {1, 1e15};
  EXPECT_NEAR(20 * std::log10(interferenceFactor(twoRayModel<double>(parameters), path)), 6.02, 0.01);
  EXPECT_NEAR(ratioToDb(dbToRatio(0) + dbToRatio(0)), 3.01, 0.01);
}

}  // namespace
}  // namespace emscape::propagation
