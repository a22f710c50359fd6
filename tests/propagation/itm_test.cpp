// ITM apart from its reference cases (check_test.cpp): errors, warnings, and results in float.
#include "propagation/itm/itm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "emfield/check/reference_table.h"

namespace emscape::propagation {
namespace {

using testing::ElementsAre;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

ItmLink<double> someLink() {
  ItmLink<double> link;
  link.height_agl_m[0] = 20;
  link.height_agl_m[1] = 5;
  link.frequency_hz = 900e6;
  return link;
}

/// Rolling hills, 200 intervals of 100 m.
std::vector<double> someHills() {
  std::vector<double> heights_m;
  for (int i = 0; i <= 200; ++i) heights_m.push_back(300 + 60 * std::sin(0.11 * i) + 15 * std::sin(0.7 * i));
  return heights_m;
}

template <class Height>
ItmProfile<Height> profileOf(const std::vector<Height>& heights_m, double step_m = 100) {
  return {heights_m.data(), static_cast<int>(heights_m.size()) - 1, step_m};
}

ItmResult<double> overHills(const ItmLink<double>& link, const ItmQuantiles<double>& quantiles = {}) {
  const std::vector<double> heights_m = someHills();
  return itmPointToPoint(profileOf(heights_m), link, quantiles);
}

ItmResult<double> overPlain(const ItmLink<double>& link, const ItmQuantiles<double>& quantiles = {}) {
  const ItmArea<double> area{20e3, 30, {ItmSiting::careful, ItmSiting::random}};
  return itmAreaMode(area, link, quantiles);
}

TEST(Itm, RefusesInputsOutsideItsLimits) {
  struct Case {
    void (*spoil)(ItmLink<double>&);
    ItmStatus status;
  };
  const Case cases[] = {
      {[](ItmLink<double>& link) { link.height_agl_m[0] = 0.4; }, ItmStatus::transmitter_height},
      {[](ItmLink<double>& link) { link.height_agl_m[1] = 3001; }, ItmStatus::receiver_height},
      {[](ItmLink<double>& link) { link.height_agl_m[1] = kNan; }, ItmStatus::receiver_height},
      {[](ItmLink<double>& link) { link.climate = static_cast<ItmClimate>(0); }, ItmStatus::climate},
      {[](ItmLink<double>& link) { link.climate = static_cast<ItmClimate>(8); }, ItmStatus::climate},
      {[](ItmLink<double>& link) { link.sea_level_refractivity = 249; }, ItmStatus::refractivity},
      {[](ItmLink<double>& link) { link.frequency_hz = 19.9e6; }, ItmStatus::frequency},
      {[](ItmLink<double>& link) { link.frequency_hz = 20.1e9; }, ItmStatus::frequency},
      {[](ItmLink<double>& link) { link.relative_permittivity = 0.9; }, ItmStatus::permittivity},
      {[](ItmLink<double>& link) { link.conductivity_s_m = 0; }, ItmStatus::conductivity},
      {[](ItmLink<double>& link) { link.variability_mode = 4; }, ItmStatus::variability_mode},
      {[](ItmLink<double>& link) { link.variability_mode = -1; }, ItmStatus::variability_mode},
      {[](ItmLink<double>& link) { link.variability_mode = 30; }, ItmStatus::variability_mode},
      {[](ItmLink<double>& link) {
         link.vertical_polarization = false;
         link.relative_permittivity = 1;
         link.conductivity_s_m = 0.01;
       },
       ItmStatus::ground_impedance},
  };
  for (const Case& spoilt : cases) {
    ItmLink<double> link = someLink();
    spoilt.spoil(link);
    for (const ItmResult<double>& result : {overHills(link), overPlain(link)}) {
      EXPECT_EQ(result.status, spoilt.status) << itmMessage(spoilt.status);
      EXPECT_TRUE(result.refused());
      EXPECT_TRUE(std::isnan(result.loss_db));
    }
  }
}

TEST(Itm, RefusesImpossiblePercentages) {
  EXPECT_EQ(overHills(someLink(), {0, 50, 50}).status, ItmStatus::time);
  EXPECT_EQ(overHills(someLink(), {50, 100, 50}).status, ItmStatus::location);
  EXPECT_EQ(overHills(someLink(), {50, 50, kNan}).status, ItmStatus::situation);
}

TEST(Itm, RefusesImpossibleAreas) {
  const auto status = [](const ItmArea<double>& area) {
    return itmAreaMode(area, someLink(), ItmQuantiles<double>()).status;
  };
  EXPECT_EQ(status({0, 30, {}}), ItmStatus::distance);
  EXPECT_EQ(status({20e3, -1, {}}), ItmStatus::irregularity);
  EXPECT_EQ(status({20e3, 30, {static_cast<ItmSiting>(3), ItmSiting::random}}),
            ItmStatus::transmitter_siting);
  EXPECT_EQ(status({20e3, 30, {ItmSiting::random, static_cast<ItmSiting>(-1)}}), ItmStatus::receiver_siting);
}

TEST(Itm, RefusesAnAtmosphereOutOfRangeAboveHighGround) {
  const std::vector<double> plateau_m(101, 7000.0);
  ItmLink<double> link = someLink();
  const auto result = itmPointToPoint(profileOf(plateau_m), link, ItmQuantiles<double>());
  EXPECT_EQ(result.status, ItmStatus::surface_refractivity_too_small);
  const std::vector<double> pit_m(101, -400.0);
  link.sea_level_refractivity = 399;
  EXPECT_EQ(itmPointToPoint(profileOf(pit_m), link, ItmQuantiles<double>()).status,
            ItmStatus::surface_refractivity_too_large);
}

TEST(Itm, MessagesNameTheLimits) {
  EXPECT_EQ(itmMessage(ItmStatus::frequency), "frequency outside 20..20000 MHz: refused");
  EXPECT_EQ(itmMessage(ItmStatus::receiver_height),
            "receiver: antenna height above ground outside 0.5..3000 m: refused");
  EXPECT_THAT(
      itmMessages(kItmWarnFrequency | kItmWarnTransmitterHorizonAngle),
      ElementsAre("frequency outside 40..10000 MHz: computed, with a warning",
                  "transmitter: elevation of a horizon outside -200..200 mrad: computed, with a warning"));
  EXPECT_EQ(itmMessages(0x7fff).size(), 15u);
  EXPECT_TRUE(itmMessages(0).empty());
}

TEST(Itm, WarnsOfShortAndOfLongPaths) {
  const auto warnings = [](double distance_m) {
    return itmAreaMode(ItmArea<double>{distance_m, 30, {}}, someLink(), ItmQuantiles<double>()).warnings;
  };
  EXPECT_EQ(warnings(20e3), 0u);
  EXPECT_EQ(warnings(900), kItmWarnDistanceUnder1km);
  EXPECT_EQ(warnings(50), kItmWarnDistanceUnder1km | kItmWarnDistanceUnderHeights);
  EXPECT_EQ(warnings(1100e3), kItmWarnDistanceOver1000km);
  EXPECT_EQ(warnings(2100e3), kItmWarnDistanceOver1000km | kItmWarnDistanceOver2000km);
}

TEST(Itm, WarnsOfExtremePercentages) {
  EXPECT_EQ(overPlain(someLink(), {99.95, 50, 50}).warnings, kItmWarnExtremeVariability);
  EXPECT_EQ(overPlain(someLink(), {99, 50, 50}).warnings, 0u);
}

// The traps of the specification.

TEST(Itm, ReturnCodeOneIsAWarningNotAnError) {
  ItmLink<double> link = someLink();
  link.frequency_hz = 12e9;
  const ItmResult<double> result = overPlain(link);
  EXPECT_EQ(result.status, ItmStatus::done_with_warnings);
  EXPECT_EQ(static_cast<int>(result.status), 1);
  EXPECT_EQ(result.warnings, kItmWarnFrequency);
  EXPECT_FALSE(result.refused());
  EXPECT_TRUE(std::isfinite(result.loss_db));
}

TEST(Itm, EarthCurvatureFollowsFromRefractivityAtSeaLevel) {
  const std::vector<double> sea_m(101, 0.0);
  const std::vector<double> plateau_m(101, 1000.0);
  const auto low = itmPointToPoint(profileOf(sea_m), someLink(), ItmQuantiles<double>());
  const auto high = itmPointToPoint(profileOf(plateau_m), someLink(), ItmQuantiles<double>());
  EXPECT_NEAR(low.path.surface_refractivity, 301, 1e-9);
  EXPECT_NEAR(high.path.surface_refractivity, 301 * std::exp(-1000 / 9460.0), 1e-9);
  // 4/3 of 6370 km at 301 N-units, less higher up
  EXPECT_NEAR(low.path.effective_earth_radius_m, 8493e3, 10e3);
  EXPECT_LT(high.path.effective_earth_radius_m, 8200e3);
}

TEST(Itm, ResultIncludesFreeSpaceLoss) {
  // two high antennas close together over a plain: hardly more than free space
  const std::vector<double> plain_m(51, 100.0);
  ItmLink<double> link = someLink();
  link.height_agl_m[0] = 300;
  link.height_agl_m[1] = 300;
  const auto result = itmPointToPoint(profileOf(plain_m), link, ItmQuantiles<double>());
  EXPECT_NEAR(result.free_space_db, 20 * std::log10(5.0) + 20 * std::log10(900.0) + 32.45, 1e-9);
  EXPECT_NEAR(result.loss_db, result.free_space_db + result.reference_db, 3);
}

TEST(Itm, MissingTerrainMustNeverLookLikeSeaLevel) {
  std::vector<double> heights_m = someHills();
  for (const std::size_t post : {std::size_t{0}, std::size_t{3}, std::size_t{77}, heights_m.size() - 1}) {
    std::vector<double> holed_m = heights_m;
    holed_m[post] = kNan;
    const auto result = itmPointToPoint(profileOf(holed_m), someLink(), ItmQuantiles<double>());
    EXPECT_EQ(result.status, ItmStatus::profile);
    EXPECT_TRUE(std::isnan(result.loss_db));
  }
  EXPECT_EQ(itmPointToPoint(ItmProfile<double>{heights_m.data(), 1, 100}, someLink(), ItmQuantiles<double>())
                .status,
            ItmStatus::profile);
  EXPECT_EQ(itmPointToPoint(ItmProfile<double>{heights_m.data(), 200, 0}, someLink(), ItmQuantiles<double>())
                .status,
            ItmStatus::profile);
}

TEST(Itm, ThresholdsAreNotContinuousInRange) {
  // A ridge: where it begins to count as the horizon of both, the estimated horizons give way to the real
  // ones. This jump is the model's; a change that removed it would no longer be ITM.
  std::vector<double> heights_m(401, 100.0);
  for (int i = 0; i < 5; ++i) heights_m[static_cast<std::size_t>(60 + i)] = 160 - 10.0 * std::abs(i - 2);
  double largest_jump_db = 0;
  double before_db = kNan;
  for (int intervals = 50; intervals <= 400; ++intervals) {
    const ItmProfile<double> profile{heights_m.data(), intervals, 100};
    const double loss_db = itmPointToPoint(profile, someLink(), ItmQuantiles<double>()).loss_db;
    ASSERT_TRUE(std::isfinite(loss_db));
    if (intervals > 50) largest_jump_db = std::max(largest_jump_db, std::fabs(loss_db - before_db));
    before_db = loss_db;
  }
  EXPECT_GT(largest_jump_db, 3);
  EXPECT_LT(largest_jump_db, 40);
}

// Its parts.

TEST(Itm, LossGrowsWithEveryPercentage) {
  for (const int mode : {0, 1, 2, 3, 10, 11, 12, 13, 20, 21, 22, 23}) {
    for (int climate = 1; climate <= 7; ++climate) {
      ItmLink<double> link = someLink();
      link.variability_mode = mode;
      link.climate = static_cast<ItmClimate>(climate);
      double before_db = 0;
      for (double percent = 1; percent < 100; percent += 7) {
        const double loss_db = overHills(link, {percent, percent, percent}).loss_db;
        EXPECT_GE(loss_db, before_db - 1e-9) << "mode " << mode << ", climate " << climate << ", " << percent;
        before_db = loss_db;
      }
    }
  }
}

TEST(Itm, DoesNotDependOnWhichEndTransmits) {
  std::vector<double> heights_m = someHills();
  const auto forth = itmPointToPoint(profileOf(heights_m), someLink(), ItmQuantiles<double>());
  std::reverse(heights_m.begin(), heights_m.end());
  ItmLink<double> reversed = someLink();
  std::swap(reversed.height_agl_m[0], reversed.height_agl_m[1]);
  const auto back = itmPointToPoint(profileOf(heights_m), reversed, ItmQuantiles<double>());
  EXPECT_NEAR(forth.loss_db, back.loss_db, 0.05);
}

TEST(ItmNormalDeviate, IsWithinThePublishedErrorOfTheApproximation) {
  EXPECT_NEAR(normalDeviate(0.5), 0, 4.5e-4);
  EXPECT_NEAR(normalDeviate(0.1), 1.281552, 4.5e-4);
  EXPECT_NEAR(normalDeviate(0.9), -1.281552, 4.5e-4);
  EXPECT_NEAR(normalDeviate(0.001), 3.090232, 4.5e-4);
}

TEST(ItmInterdecileRange, EqualsRangeOfSortedValues) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int repeat = 0; repeat < 300; ++repeat) {
    const int tenth = 4 + repeat % 22;
    const int count = 10 * tenth - 5;
    std::vector<double> values(static_cast<std::size_t>(count));
    for (double& value : values) {
      value = normal(random);
      if (repeat % 3 == 1) value = std::round(value);   // many that are equal
      if (repeat % 3 == 2) value = std::pow(value, 9);  // a few that are far out
      if (repeat % 5 == 4) value = std::fabs(value) < 2 ? 0 : value;
    }
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](int place) { return sorted[static_cast<std::size_t>(place)]; };
    EXPECT_EQ(itm_detail::interdecileRange<245>(values.data(), count, tenth),
              at(count - tenth) - at(tenth - 1));
  }
  const std::vector<double> flat(35, 7.0);
  EXPECT_EQ(itm_detail::interdecileRange<245>(flat.data(), 35, 4), 0);
}

TEST(ItmFitLine, FindsAStraightLine) {
  std::vector<double> heights_m;
  for (int i = 0; i <= 40; ++i) heights_m.push_back(5 + 0.25 * i);
  const auto line = itm_detail::fitLine<double>(heights_m.data(), 40, 7.3, 29.8);
  EXPECT_NEAR(line.at_start_m, 5, 1e-10);
  EXPECT_NEAR(line.at_end_m, 15, 1e-10);
}

// Float, as on a GPU.

template <class Real>
ItmLink<Real> linkAs(const ItmLink<double>& link) {
  ItmLink<Real> same;
  for (int end = 0; end < 2; ++end) same.height_agl_m[end] = static_cast<Real>(link.height_agl_m[end]);
  same.frequency_hz = static_cast<Real>(link.frequency_hz);
  same.vertical_polarization = link.vertical_polarization;
  same.relative_permittivity = static_cast<Real>(link.relative_permittivity);
  same.conductivity_s_m = static_cast<Real>(link.conductivity_s_m);
  same.sea_level_refractivity = static_cast<Real>(link.sea_level_refractivity);
  same.climate = link.climate;
  same.variability_mode = link.variability_mode;
  return same;
}

TEST(ItmFloat, StaysCloseToDouble) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform;
  std::vector<double> differences_db;
  for (int i = 0; i < 3000; ++i) {
    std::vector<float> heights_m(static_cast<std::size_t>(60 + 500 * uniform(random)), 500.0f);
    for (double waves = 0.5; waves < 60; waves *= 1.6) {
      const double amplitude_m = 400 * uniform(random) / (1 + waves);
      const double phase = 6.28 * uniform(random);
      for (std::size_t post = 0; post < heights_m.size(); ++post) {
        const double at = static_cast<double>(post) / static_cast<double>(heights_m.size());
        heights_m[post] += static_cast<float>(amplitude_m * std::sin(phase + 6.28 * waves * at));
      }
    }
    ItmLink<double> link;
    link.height_agl_m[0] = static_cast<float>(1 + 999 * std::pow(uniform(random), 3));
    link.height_agl_m[1] = static_cast<float>(1 + 999 * std::pow(uniform(random), 3));
    link.frequency_hz = static_cast<float>(20e6 * std::pow(1000.0, uniform(random)));
    link.vertical_polarization = i % 2 == 0;
    link.climate = static_cast<ItmClimate>(1 + i % 7);
    const ItmProfile<float> profile{heights_m.data(), static_cast<int>(heights_m.size()) - 1, 90.0};
    const auto exact = itmPointToPoint(profile, link, ItmQuantiles<double>{90, 50, 50});
    const auto rounded = itmPointToPoint(profile, linkAs<float>(link), ItmQuantiles<float>{90, 50, 50});
    ASSERT_EQ(exact.refused(), rounded.refused()) << i;
    if (exact.refused()) continue;
    differences_db.push_back(std::fabs(static_cast<double>(rounded.loss_db) - exact.loss_db));
  }
  std::sort(differences_db.begin(), differences_db.end());
  EXPECT_LT(differences_db.back(), 0.01);
}

}  // namespace
}  // namespace emscape::propagation
