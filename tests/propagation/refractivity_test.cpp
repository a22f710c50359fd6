// Profiles of refractivity: sums, means, ducts, bulk inputs, and the air along a path.
#include "propagation/parabolic_equation/air/refractivity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "emscape/base/units.h"
#include "propagation/air/moist_air.h"
#include "propagation/parabolic_equation/air/bulk_duct.h"
#include "propagation/parabolic_equation/air/ducts.h"
#include "propagation/parabolic_equation/air/path_air.h"
#include "propagation/parabolic_equation/air/refractivity_field.h"
#include "propagation/parabolic_equation/march/march.h"
#include "tests/support/errors.h"

namespace emscape::propagation {
namespace {

using testing::HasSubstr;

/// dM/dz about a height.
double gradient(const RefractivityProfile& profile, double z) {
  const double step = 0.01 * z;
  return (profile.at(z + step) - profile.at(z - step)) / (2 * step);
}

TEST(MoistAir, HasTheRefractivityOfP453) {
  // 1013 hPa, 15 C, 60 %: a published check of ITU-R P.453.
  const double vapour_hpa = 0.6 * saturationPressure_hpa(288.15);
  EXPECT_NEAR(vapour_hpa, 10.227, 1e-3);
  EXPECT_NEAR(refractivity_n(1013, 288.15, vapour_hpa), 318.78, 0.01);
}

TEST(Refractivity, WithAnEvaporationDuctHasBothGradientsBelowAndItsOwnAbove) {
  const RefractivityProfile layer = trilinearRefractivity(200, 300, 40, 330);
  const RefractivityProfile sum = withEvaporationDuct(layer, 14), duct = evaporationDuct(14, 330);
  for (const double z : {0.01, 0.5, 5.0, 14.0, 27.0}) {
    EXPECT_NEAR(sum.at(z), duct.at(z), 0.02) << z;
  }
  for (const double z : {43.0, 100.0, 250.0, 400.0}) {
    EXPECT_NEAR(gradient(sum, z), gradient(layer, z), 1e-9) << z;
  }
  // Half of the departure's gradient at 2.5 duct heights.
  EXPECT_NEAR(gradient(sum, 35), kStandardGradient_m + 0.5 * (gradient(duct, 35) - kStandardGradient_m),
              2.5e-3);
  EXPECT_EQ(withEvaporationDuct(layer, 0).levels.size(), layer.levels.size());
  EXPECT_THAT(test::errorOf([&] { withEvaporationDuct(layer, 61); }),
              HasSubstr("duct height: 61 m is not in 0 .. 60 m"));
}

TEST(Refractivity, AboveAMeasuredProfileIsStandardThenExponential) {
  const RefractivityProfile air = withUpperAir(profileOfLevels({{0, 330}, {100, 320}}));
  EXPECT_NEAR(gradient(air, 3000), kStandardGradient_m, 1e-9);
  const double n_at_5km = air.at(5000) - kFlatteningGradient_m * 5000;
  EXPECT_NEAR(air.at(12000) - kFlatteningGradient_m * 12000, n_at_5km * std::exp(-7.0 / 7.35), 2);
  EXPECT_EQ(air.top_gradient_m, kFlatteningGradient_m);
  EXPECT_FALSE(air.levels.back().height_msl_m < 30000);
}

TEST(Refractivity, IsThinnedWithinTheTolerance) {
  std::vector<RefractivityLevel> levels;
  for (int z = 0; z <= 3000; z += 10)
    levels.push_back({double(z), 330 + 0.118 * z + 8 * std::sin(z / 300.0) - (z > 1200 ? 20 : 0)});
  const RefractivityProfile all{levels}, few{thinned(levels, 0.5)};
  EXPECT_LT(few.levels.size(), 50u);
  for (const RefractivityLevel& level : levels)
    EXPECT_NEAR(few.at(level.height_msl_m), level.m_units, 0.5001);
  EXPECT_EQ(thinned({{0, 1}, {1, 2}, {2, 3}}, 0.1).size(), 2u);
}

TEST(Ducts, OfTheReferenceProfilesHoldTheirModes) {
  // The surface-based duct of the reference figures: 42 modes at 3 GHz.
  const std::vector<Duct> based = ductsOf(trilinearRefractivity(200, 300, 40, 330));
  ASSERT_EQ(based.size(), 1u);
  EXPECT_EQ(based[0].kind, DuctKind::surface_based);
  EXPECT_EQ(based[0].base_msl_m, 0);
  EXPECT_EQ(based[0].layer_base_msl_m, 200);
  EXPECT_EQ(based[0].top_msl_m, 300);
  EXPECT_NEAR(based[0].strength_m_units, 40, 1e-9);
  EXPECT_EQ(std::floor(based[0].modes(3e9)), 42);
  EXPECT_NEAR(based[0].criticalAngle_deg(), radToDeg(std::sqrt(80e-6)), 1e-9);
  EXPECT_NEAR(based[0].modes(based[0].oneModeFrequency_hz()), 1, 1e-12);

  // Evaporation duct of 14 m: one mode at 10 GHz, none at 3 GHz.
  const std::vector<Duct> evaporation = ductsOf(evaporationDuct(14));
  ASSERT_EQ(evaporation.size(), 1u);
  EXPECT_EQ(evaporation[0].kind, DuctKind::evaporation);
  EXPECT_EQ(evaporation[0].top_msl_m, 14);
  EXPECT_NEAR(evaporation[0].strength_m_units, 18.3, 0.05);
  EXPECT_EQ(std::floor(evaporation[0].modes(10e9)), 1);
  EXPECT_EQ(std::floor(evaporation[0].modes(3e9)), 0);
}

TEST(Ducts, AreOfFourKinds) {
  EXPECT_TRUE(ductsOf(standardRefractivity()).empty());
  const Duct surface = ductsOf(surfaceDuct(50, 10)).at(0);
  EXPECT_EQ(surface.kind, DuctKind::surface);
  // Closed form of one linear piece: 2/3 h sqrt(2e-6 D).
  EXPECT_NEAR(surface.phase_integral_m, 2.0 / 3 * 50 * std::sqrt(2e-6 * 10), 1e-12);
  // pywaveprop's elevated duct: down to where M is that of its top, 10, at 31.25 m.
  const Duct elevated = ductsOf(profileOfLevels({{0, 0}, {100, 32}, {150, 10}, {300, 45}})).at(0);
  EXPECT_EQ(elevated.kind, DuctKind::elevated);
  EXPECT_NEAR(elevated.base_msl_m, 31.25, 1e-9);
  EXPECT_NEAR(elevated.strength_m_units, 22, 1e-9);
  const RefractivityProfile both = withEvaporationDuct(trilinearRefractivity(200, 300, 40, 330), 14);
  ASSERT_EQ(ductsOf(both).size(), 2u);
  EXPECT_EQ(ductsOf(both)[0].kind, DuctKind::evaporation);
  EXPECT_EQ(ductsOf(both)[1].kind, DuctKind::surface_based);
}

// The forms of SHEBA and of Businger and Dyer: phi = 1 - zeta dpsi/dzeta.
TEST(BulkDuct, StabilityFunctionsAreIntegralsOfThePublishedForms) {
  const auto phiOf = [](double (*psi)(double), double zeta) {
    const double step = 1e-4 * std::fabs(zeta);
    return 1 - zeta * (psi(zeta + step) - psi(zeta - step)) / (2 * step);
  };
  for (const double z : {0.01, 0.3, 1.0, 5.0, 30.0}) {
    EXPECT_NEAR(phiOf(stabilityOfWind, z), 1 + 5 * z * std::cbrt(1 + z) / (1 + z / 1.3), 1e-5 * (1 + z)) << z;
    EXPECT_NEAR(phiOf(stabilityOfHeat, z), 1 + (10 * z + 4.5 * z * z) / (1 + 3 * z + z * z), 1e-5 * (1 + z));
    EXPECT_NEAR(phiOf(stabilityOfWind, -z), std::pow(1 + 16 * z, -0.25), 1e-6);
    EXPECT_NEAR(phiOf(stabilityOfHeat, -z), std::pow(1 + 16 * z, -0.5), 1e-6);
  }
  EXPECT_NEAR(stabilityOfWind(1e-9), 0, 1e-8);
  EXPECT_NEAR(stabilityOfHeat(-1e-9), 0, 1e-7);
}

BulkInputs bulk(double air_minus_sea_k, double humidity_percent, double wind_m_s = 5) {
  BulkInputs inputs;
  inputs.air_temperature_k = inputs.sea_temperature_k + air_minus_sea_k;
  inputs.relative_humidity_percent = humidity_percent;
  inputs.wind_m_s = wind_m_s;
  return inputs;
}

// Sea at 15 C, wind 5 m/s, sensors at 10 m, 1013.25 hPa. Figures of NAVSLaM 2.0's equations and constants,
// evaluated by a separate program (Python, levels of 0.1 m, with other saturation and refractivity formulas).
TEST(BulkDuct, HasTheHeightsOfNavslam) {
  struct Case {
    double humidity_percent, air_minus_sea_k, duct_height_m, friction_m_s, strength;
  };
  for (const Case& c : {Case{60, -5, 7.9, 0.1841, 35.11},
                        Case{60, 0, 11.6, 0.1660, 28.15},
                        Case{60, 2, 60.7, 0.1430, 29.69},
                        {70, -2, 7.6, 0.1750, 24.47},
                        {70, 1, 36.1, 0.1525, 19.66},
                        {70, 5, 17.3, 0.1122, 7.799},
                        {80, -1, 6.4, 0.1700, 15.35},
                        {80, 0, 7.7, 0.1632, 12.76},
                        {80, 1, 17.8, 0.1503, 10.22},
                        {90, -5, 5.2, 0.1832, 18.06},
                        {90, 0, 4.1, 0.1612, 5.315},
                        {90, 2, 0, 0.1367, 0}}) {
    const BulkAir air = bulkAir(bulk(c.air_minus_sea_k, c.humidity_percent));
    ASSERT_TRUE(air.duct_height_m.has_value());
    EXPECT_NEAR(*air.duct_height_m, c.duct_height_m, 0.06 + 0.01 * c.duct_height_m)
        << c.humidity_percent << " % " << c.air_minus_sea_k;
    EXPECT_NEAR(air.friction_velocity_m_s, c.friction_m_s, 2e-4);
    EXPECT_NEAR(air.profile.at(0) - air.profile.at(*air.duct_height_m), c.strength, 0.03 + 0.01 * c.strength);
  }
}

TEST(BulkDuct, OfNeutralAirIsLogarithmicWithTheDragOfSmith) {
  // Nearly saturated air at the sea's potential temperature: no buoyancy. Smith 1988 (Charnock 0.011): drag
  // coefficient 1.3e-3 at 10 m/s.
  const BulkAir neutral = bulkAir(bulk(-0.0976, 97, 10));
  EXPECT_GT(std::fabs(neutral.obukhov_length_m), 1000);
  EXPECT_NEAR(std::pow(neutral.friction_velocity_m_s / 10, 2), 1.3e-3, 0.03e-3);
  // Neutral and drier: M = M0 + c z - b ln z with the same b at all heights; the minimum of M at b / c.
  const BulkAir air = bulkAir(bulk(0.55, 70, 15));
  ASSERT_GT(std::fabs(air.obukhov_length_m), 500);
  const auto slope = [&](double z) {
    return (air.profile.at(1.5 * z) - air.profile.at(z) - 0.13 * 0.5 * z) / std::log(1.5);
  };
  EXPECT_NEAR(slope(2), slope(20), 0.12 * std::fabs(slope(2)));
  EXPECT_NEAR(*air.duct_height_m, -slope(10) / 0.13, 0.1 * *air.duct_height_m);
}

TEST(BulkDuct, OfUnstableAirGrowsWithDryness) {
  for (const double difference_k : {-5.0, -1.0, 0.0}) {
    double before_m = HUGE_VAL;
    for (const double humidity_percent : {50, 60, 70, 80, 90}) {
      const BulkAir air = bulkAir(bulk(difference_k, humidity_percent));
      ASSERT_TRUE(air.duct_height_m.has_value());
      EXPECT_LT(*air.duct_height_m, before_m);
      before_m = *air.duct_height_m;
    }
  }
}

TEST(BulkDuct, IsUndefinedWhereMFallsTo100Metres) {
  EXPECT_FALSE(bulkAir(bulk(2, 40)).duct_height_m.has_value());  // as with NAVSLaM's equations
}

TEST(BulkDuct, NeverGivesNanWithinItsLimits) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 300; ++i) {
    BulkInputs inputs;
    inputs.air_temperature_k = 223.15 + 100 * unit(random);
    inputs.sea_temperature_k = 270.55 + 38.6 * unit(random);
    inputs.relative_humidity_percent = 10 + 90 * unit(random);
    inputs.wind_m_s = i % 10 == 0 ? 0 : 30 * unit(random);
    inputs.pressure_hpa = 920 + 140 * unit(random);
    inputs.sensor_height_m = 0.5 + 49.5 * unit(random);
    inputs.wind_height_m = 0.5 + 49.5 * unit(random);
    const BulkAir air = bulkAir(inputs);
    for (const RefractivityLevel& level : air.profile.levels) ASSERT_TRUE(std::isfinite(level.m_units));
    ASSERT_TRUE(std::isfinite(air.friction_velocity_m_s));
  }
}

TEST(BulkDuct, RefusesInputsOutsideItsLimits) {
  EXPECT_THAT(test::errorOf([] { bulkAir(bulk(0, 5)); }, ErrorCode::bad_input),
              HasSubstr("relative humidity is 5, outside the allowed range 10 to 100 %"));
  EXPECT_THAT(test::errorOf([] { bulkAir(bulk(0, 80, 31)); }, ErrorCode::bad_input), HasSubstr("wind is 31"));
  EXPECT_THAT(test::errorOf([] { bulkAir(bulk(60, 80)); }), HasSubstr("air temperature is 348.15"));
}

constexpr Site kSite{50, 0, 20, 6371000, 6371000 * 4.0 / 3, 20};

Atmosphere atmosphereOf(Refractivity refractivity) {
  Atmosphere atmosphere;
  atmosphere.refractivity = std::make_shared<const Refractivity>(std::move(refractivity));
  return atmosphere;
}

TEST(PathAir, WithoutRefractivityHasTheGradientOfKFactor) {
  EXPECT_NEAR(gradient(pathAir({}, kSite, 1).at(0), 100), 0.1177, 1e-4);
  EXPECT_EQ(pathAirs({}, kSite, 1).size(), 1u);
}

TEST(PathAir, ByRangeCountsFromTheSite) {
  Refractivity refractivity;
  refractivity.air.profiles = {surfaceDuct(20, 10), surfaceDuct(40, 10)};
  refractivity.air.ranges_m = {0, 10000};
  const RefractivityAlongPath air = pathAir(atmosphereOf(refractivity), kSite, 2);
  EXPECT_NEAR(air.at(5000).levels.back().height_msl_m, 30, 1e-9);
}

TEST(PathAir, HasTheEvaporationDuctInItsProfiles) {
  Refractivity refractivity;
  refractivity.air.profiles = {trilinearRefractivity(200, 300, 40), trilinearRefractivity(300, 400, 40)};
  refractivity.air.ranges_m = {0, 10000};
  refractivity.air.evaporation_duct_m = 14;
  const RefractivityAlongPath air = pathAir(atmosphereOf(refractivity), kSite, 0);
  EXPECT_FALSE(air.pointwise());
  const RefractivityProfile expected = withEvaporationDuct(trilinearRefractivity(250, 350, 40), 14);
  for (const double z : {0.0, 1.0, 14.0, 40.0, 240.0, 300.0, 500.0})
    EXPECT_NEAR(air.at(5000).at(z), expected.at(z), 1e-9) << z;
  EXPECT_EQ(air.profiles().at(0).at(10), withEvaporationDuct(refractivity.air.profiles[0], 14).at(10));
}

TEST(PathAir, ByPositionEqualsProfileThereAndMeanBetween) {
  Refractivity refractivity;
  refractivity.air.profiles = {surfaceDuct(20, 10), surfaceDuct(40, 10)};
  refractivity.air.positions = {{50, 0}, {50.9, 0}};  // at the site; 100.1 km north of it
  const Atmosphere atmosphere = atmosphereOf(refractivity);
  const RefractivityAlongPath north = pathAir(atmosphere, kSite, 0),
                              east = pathAir(atmosphere, kSite, kPi / 2);
  const auto top_m = [](const RefractivityAlongPath& air, double range_m) {
    return air.at(range_m).levels.back().height_msl_m;
  };
  EXPECT_NEAR(top_m(north, 0), 20, 1e-3);
  EXPECT_NEAR(top_m(north, 50040), 30, 0.1);
  EXPECT_NEAR(top_m(north, 100080), 40, 0.1);
  // 100 km east the southern place is at 100 km, the northern one at 141 km: weights 2 to 1.
  EXPECT_NEAR(top_m(east, 100000), 20 + 20.0 / 3, 0.2);
  // Small changes of azimuth make small changes of the air.
  EXPECT_NEAR(top_m(pathAir(atmosphere, kSite, 0.01), 60000), top_m(north, 60000), 0.05);
}

TEST(PathAirs, HaveOneAirPerMember) {
  Refractivity refractivity;
  refractivity.air.profiles = {surfaceDuct(30, 10)};
  for (const double top_m : {20, 40}) {
    RefractivityField member;
    member.profiles = {surfaceDuct(top_m, 10)};
    refractivity.members.push_back(member);
  }
  const Atmosphere atmosphere = atmosphereOf(refractivity);
  const std::vector<RefractivityAlongPath> airs = pathAirs(atmosphere, kSite, 0);
  ASSERT_EQ(airs.size(), 2u);
  EXPECT_EQ(airs[1].at(0).levels.back().height_msl_m, 40);
  EXPECT_EQ(pathAir(atmosphere, kSite, 0).at(0).levels.back().height_msl_m, 30);
}

TEST(Refractivity, IsTheSameByValue) {
  Refractivity a;
  a.air.profiles = {surfaceDuct(30, 10)};
  Refractivity b = a;
  const auto same = [](const Refractivity& x, const Refractivity& y) {
    return areSame(std::make_shared<const Refractivity>(x), std::make_shared<const Refractivity>(y));
  };
  EXPECT_TRUE(same(a, b));
  b.air.evaporation_duct_m = 1;
  EXPECT_FALSE(same(a, b));
  b = a;
  b.members = {a.air};
  EXPECT_FALSE(same(a, b));
  b = a;
  b.air.profiles[0].levels[1].m_units += 1;
  EXPECT_FALSE(same(a, b));
  EXPECT_FALSE(areSame(nullptr, std::make_shared<const Refractivity>(a)));
  EXPECT_TRUE(areSame(nullptr, nullptr));
}

// Levels at random within the limits: the march, the ducts and the sums stay finite.
TEST(Refractivity, OfRandomLevelsNeverGivesNan) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 40; ++i) {
    std::vector<RefractivityLevel> levels{{-5 + 10 * unit(random), 300 + 100 * unit(random)}};
    const int count = 2 + int(20 * unit(random));
    while (int(levels.size()) < count) {
      const double step_m = std::pow(10, -2 + 4.5 * unit(random));
      const double m_units = levels.back().m_units + step_m * (10 * unit(random) - 5) * unit(random);
      levels.push_back({levels.back().height_msl_m + step_m, std::min(std::max(m_units, 0.0), 2500.0)});
    }
    RefractivityProfile profile = profileOfLevels(levels);
    if (i % 2 == 0) profile = withUpperAir(withEvaporationDuct(profile, 60 * unit(random)));
    for (const double z : {-100.0, 0.0, 1e-3, 10.0, 1e3, 1e5}) ASSERT_TRUE(std::isfinite(profile.at(z)));
    for (const Duct& duct : ductsOf(profile)) {
      ASSERT_TRUE(duct.modes(3e9) >= 0.25 && std::isfinite(duct.modes(3e9)));
      ASSERT_TRUE(std::isfinite(duct.oneModeFrequency_hz()) && duct.base_msl_m < duct.top_msl_m);
    }
    MarchGrid grid;
    grid.frequency_hz = 3e9;
    grid.top_m = 128;
    grid.intervals = 256;
    grid.range_step_m = 100;
    RadialPath path;
    path.source.height_agl_m = 20;
    path.air = profile;
    RadialMarch<float, 1> march(grid, {path});
    for (int step = 0; step < 20; ++step) march.advance();
    ASSERT_TRUE(std::isfinite(march.energy(0)));
    ASSERT_TRUE(std::isfinite(march.amplitude(0, 30)));
  }
}

}  // namespace
}  // namespace emscape::propagation
