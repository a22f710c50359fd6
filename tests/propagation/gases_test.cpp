// Gaseous attenuation and the standard atmosphere.
#include "propagation/air/gases.h"

#include <gtest/gtest.h>

#include <cmath>

#include "emscape/base/units.h"
#include "propagation/air/gases_equivalent_height.h"

namespace emscape::propagation {
namespace {

TEST(Gases, OxygenPeaksAt60GigahertzAndVapourAtItsLines) {
  const AirState air;
  EXPECT_GT(gasAttenuation(60e9, air).oxygen_db_per_km, 14);
  EXPECT_LT(gasAttenuation(60e9, air).oxygen_db_per_km, 16);
  const double at_line = gasAttenuation(22.235e9, air).vapour_db_per_km;
  EXPECT_GT(at_line, 2 * gasAttenuation(15e9, air).vapour_db_per_km);
  EXPECT_GT(at_line, 1.5 * gasAttenuation(30e9, air).vapour_db_per_km);
  EXPECT_EQ(gasAttenuation(1e10, 1013, 288, 0).vapour_db_per_km, 0);
}

TEST(Gases, StandardAtmosphereMeetsItsPublishedFigures) {
  // ICAO standard atmosphere, which P.835's is up to 32 km
  EXPECT_NEAR(standardAtmosphere(0).pressure_hpa, 1013.25, 1e-9);
  EXPECT_NEAR(standardAtmosphere(5000).pressure_hpa, 540.48, 0.02);
  EXPECT_NEAR(standardAtmosphere(5000).temperature_k, 255.676, 0.01);
  EXPECT_NEAR(standardAtmosphere(11000).pressure_hpa, 226.999, 0.02);
  EXPECT_NEAR(standardAtmosphere(20000).pressure_hpa, 55.293, 0.01);
  EXPECT_NEAR(standardAtmosphere(30000).pressure_hpa, 11.970, 0.005);
  EXPECT_NEAR(standardAtmosphere(2000).vapour_g_m3, 7.5 / std::exp(1), 1e-9);
  EXPECT_EQ(standardAtmosphere(1e6).pressure_hpa, 0);
}

TEST(Gases, StandardAtmosphereHasNoSteps) {
  AirState before = standardAtmosphere(-500);
  for (double h = -400; h < 1e5; h += 100) {
    const AirState air = standardAtmosphere(h);
    EXPECT_LT(air.pressure_hpa, before.pressure_hpa) << h;
    EXPECT_GT(air.pressure_hpa, 0.97 * before.pressure_hpa) << h;
    EXPECT_NEAR(air.temperature_k, before.temperature_k, 2) << h;
    before = air;
  }
}

TEST(Gases, AttenuationAtAHeightFallsWithTheAir) {
  double before = 1e9;
  for (double h = 0; h <= 20000; h += 500) {
    const double gamma = gasAttenuation(10e9, standardAtmosphere(h)).total_db_per_km();
    EXPECT_LT(gamma, before);
    EXPECT_GT(gamma, 0);
    before = gamma;
  }
  EXPECT_EQ(gasAttenuation(10e9, standardAtmosphere(2e5)).total_db_per_km(), 0);
}

TEST(Gases, ThinnedTableOfOxygenHeightsKeepsTheRowsLeftOut) {
  // of the table that comes with P.676-13
  const struct {
    double f, a, b, c, d;
  } rows[] = {{5, -2.290567e+00, 2.726019e-02, -5.333499e-04, -5.269089e-04},
              {11, -2.299464e+00, 2.738779e-02, -5.819270e-04, -6.135092e-04},
              {35, -2.504421e+00, 2.840651e-02, -6.319744e-04, -1.155244e-03},
              {43, -2.573279e+00, 2.874452e-02, -6.526856e-04, -1.400218e-03},
              {47.5, -2.521017e+00, 2.852592e-02, -6.659091e-04, -1.476919e-03},
              {72.5, -3.025851e+00, 3.109597e-02, -8.091306e-04, -2.758537e-03},
              {80.5, -3.517542e+00, 3.338218e-02, -8.416345e-04, -3.355942e-03},
              {101.5, -4.163833e+00, 3.672923e-02, -9.497631e-04, -4.043501e-03},
              {111.5, -4.218024e+00, 3.701577e-02, -8.039116e-04, -4.114297e-03},
              {125.5, -4.381546e+00, 3.785050e-02, -8.041469e-04, -4.421764e-03},
              {137.5, -4.701652e+00, 3.956180e-02, -1.079505e-03, -4.073956e-03},
              {185, -4.897583e+00, 4.036947e-02, -1.120527e-03, -1.021137e-03},
              {245, -4.410213e+00, 3.817071e-02, -1.054979e-03, 6.335241e-04},
              {345, -3.981773e+00, 3.621803e-02, -9.914801e-04, 1.103203e-03}};
  for (const auto& row : rows) {
    for (const AirState& air :
         {AirState{1013.25, 288.15, 7.5}, AirState{900, 260, 1}, AirState{1013, 310, 30}}) {
      const double published =
          row.a + row.b * air.temperature_k + row.c * air.pressure_hpa + row.d * air.vapour_g_m3;
      EXPECT_NEAR(oxygenEquivalentHeight_km(row.f, air) / published, 1, 2e-3) << row.f;
    }
  }
}

TEST(Gases, SlantPathsOutsideTheMethodAreRefused) {
  EXPECT_TRUE(std::isnan(slantGasAttenuationDb(400e9, 1, {})));
  EXPECT_TRUE(std::isnan(slantGasAttenuationDb(10e9, degToRad(4.0), {})));
  EXPECT_FALSE(std::isnan(slantGasAttenuationDb(10e9, degToRad(5.0), {})));
  EXPECT_EQ(outsideMessage(kGasesElevation, degToRad(4.0)),
            "elevation (slant path) 4 deg is outside 5..90 deg: refused");
}

TEST(Gases, ZenithAttenuationIsTheIntegralOfTheLayers) {
  for (const double f : {5e9, 15e9, 35e9, 94e9}) {
    double integral_db = 0;
    constexpr double kStep_m = 50;
    for (double h = kStep_m / 2; h < 8e4; h += kStep_m) {
      integral_db += gasAttenuation(f, standardAtmosphere(h)).total_db_per_km() * kStep_m / 1000;
    }
    EXPECT_NEAR(slantGasAttenuationDb(f, kPi / 2, standardAtmosphere(0)) / integral_db, 1, 0.07) << f;
  }
}

}  // namespace
}  // namespace emscape::propagation
