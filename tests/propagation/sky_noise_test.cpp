#include "propagation/air/sky_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "emscape/base/units.h"
#include "propagation/air/gases.h"

namespace emscape::propagation {
namespace {

TEST(SkyNoise, BelowAHundredMegahertzTheGalaxyDecides) {
  // P.372-16 eq. (13): 52 - 23 log f dB over 290 K.
  for (const double mhz : {20.0, 30.0, 60.0, 100.0}) {
    const double expected_db = 52 - 23 * std::log10(mhz);
    EXPECT_NEAR(ratioToDb(skyTemperature_k(mhz * 1e6, kPi / 2, {}) / 290), expected_db, 0.05) << mhz;
  }
}

TEST(SkyNoise, TheGalaxyFallsByThePowerOfP372) {
  // P.372 Part 4: T(f) = T(f0) (f / f0)^-2.75 + 2.7 K. Without air there is no other noise.
  Atmosphere none;
  none.pressure_hpa = 1e-9;
  none.vapour_g_m3 = 0;
  const double at_408 = skyTemperature_k(408e6, kPi / 2, none) - 2.7;
  EXPECT_NEAR(skyTemperature_k(1e9, kPi / 2, none) - 2.7, at_408 * std::pow(1000 / 408.0, -2.75), 0.01);
  EXPECT_NEAR(skyTemperature_k(100e9, kPi / 2, none), 2.7, 0.01);
}

TEST(SkyNoise, ZenithTemperatureFollowsFromZenithAttenuation) {
  // A thin layer of mean temperature T radiates T (1 - 1 / L); the mean radiating temperature of the clear
  // atmosphere is between those of the ground and of 5 km of height.
  for (const double ghz : {10.0, 20.0, 35.0}) {
    const double loss = dbToRatio(-slantGasAttenuationDb(ghz * 1e9, kPi / 2, {}));
    const double sky_k = skyTemperature_k(ghz * 1e9, kPi / 2, {}) - 2.7 * loss;
    EXPECT_GT(sky_k, 0.95 * 255 * (1 - loss)) << ghz;
    EXPECT_LT(sky_k, 1.05 * 288 * (1 - loss)) << ghz;
  }
}

TEST(SkyNoise, RisesTowardHorizonAndEqualsGroundBelow) {
  for (const double hz : {1.3e9, 3e9, 10e9}) {
    double above_k = 0;
    for (double elevation_deg = 90; elevation_deg >= 0; elevation_deg -= 2) {
      const double sky_k = skyTemperature_k(hz, degToRad(elevation_deg), {});
      EXPECT_GT(sky_k, above_k);
      EXPECT_LT(sky_k, 290);
      above_k = sky_k;
    }
    EXPECT_EQ(skyTemperature_k(hz, degToRad(-1.0), {}), 290);
    EXPECT_NEAR(antennaTemperature_k(hz, degToRad(-2.0), degToRad(1.0), {}), 290, 0.01);
  }
  // A dark gas: at the oxygen line the sky is as warm as the air.
  EXPECT_NEAR(skyTemperature_k(60e9, kPi / 2, {}), 285, 5);
  // The share of the ground is left on a cold sky.
  EXPECT_NEAR(antennaTemperature_k(3e9, kPi / 2, degToRad(2.0), {}),
              0.876 * skyTemperature_k(3e9, kPi / 2, {}) + 36, 0.1);
}

TEST(SkyNoise, EqualsDocumentedTable) {
  // Rows of the table in docs/models.md.
  const double expected_k[][4] = {{0, 100e6, 661, 1}, {0, 3e9, 197, 1},   {1, 9.4e9, 133, 1},
                                  {5, 16e9, 88, 1},   {30, 430e6, 59, 1}, {90, 35e9, 53, 1}};
  for (const auto& [elevation_deg, frequency_hz, value_k, tolerance_k] : expected_k)
    EXPECT_NEAR(antennaTemperature_k(frequency_hz, degToRad(elevation_deg), degToRad(2.0), {}), value_k,
                tolerance_k);
}

TEST(SkyNoise, ChangesSlowlyWhereTheBeamPassesTheHorizon) {
  constexpr double kStep_deg = 0.1, kWidth_deg = 2, kSkyToGround_k = 290;
  double before_k = antennaTemperature_k(3e9, degToRad(-6.0), degToRad(kWidth_deg), {});
  EXPECT_NEAR(before_k, 290, 0.1);
  for (double elevation_deg = -6 + kStep_deg; elevation_deg < 6; elevation_deg += kStep_deg) {
    const double here_k = antennaTemperature_k(3e9, degToRad(elevation_deg), degToRad(kWidth_deg), {});
    EXPECT_LE(here_k, before_k + 0.01) << elevation_deg;
    EXPECT_LT(before_k - here_k, kSkyToGround_k * kStep_deg / kWidth_deg) << elevation_deg;
    before_k = here_k;
  }
  // On the horizon one half of the main beam sees the ground.
  const double on_horizon_k = antennaTemperature_k(3e9, 0, degToRad(0.2), {});
  EXPECT_NEAR(on_horizon_k, 0.124 * 290 + 0.876 * (290 + skyTemperature_k(3e9, degToRad(0.05), {})) / 2, 3);
}

}  // namespace
}  // namespace emscape::propagation
