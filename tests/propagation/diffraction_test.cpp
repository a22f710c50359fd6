// Diffraction: single edges, delta-Bullington path by path.
#include "propagation/diffraction/diffraction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "propagation/diffraction/bullington_lanes.h"
#include "propagation/diffraction/edges.h"
#include "propagation/diffraction/smooth_earth.h"
#include "tests/emfield/random_profile.h"

namespace emscape::propagation {
namespace {

using emfield::testing::madeUpProfile;
using emfield::testing::ProfileData;

constexpr double kEarth_m = 6371000.0 * 4 / 3;

DiffractionParameters parametersAt(double frequency_hz) {
  DiffractionParameters parameters;
  parameters.frequency_hz = frequency_hz;
  parameters.effective_earth_radius_m = kEarth_m;
  return parameters;
}

ProfileData flatProfile(double length_m, int posts, float height_msl_m = 0) {
  ProfileData profile;
  for (int i = 0; i < posts; ++i) {
    profile.range_m.push_back(length_m * i / (posts - 1));
    profile.height_msl_m.push_back(height_msl_m);
  }
  return profile;
}

TEST(KnifeEdge, AtGrazingIsSixDecibels) {
  EXPECT_NEAR(knifeEdgeExactDb(0), 20 * std::log10(2), 1e-9);
  EXPECT_NEAR(knifeEdgeDb(0.0), 6.03, 0.01);
}

TEST(Bullington, VectorLoopFormEqualsPlainForm) {
  for (const double distance_m : {100.0, 5e3, 50e3, 500e3}) {
    for (double nu = -2; nu < 100; nu += 0.0137) {
      const double rounded = static_cast<float>(nu);
      ASSERT_NEAR(bullingtonLossInLoopDb(static_cast<float>(nu), static_cast<float>(distance_m)),
                  bullingtonLossDb(rounded, distance_m), 5e-5)
          << nu;
    }
  }
  EXPECT_EQ(bullingtonLossInLoopDb(kKnifeEdgeClear<float>, 1e3f), 0);
  EXPECT_TRUE(std::isnan(bullingtonLossInLoopDb(NAN, 1e3f)));
}

TEST(KnifeEdge, ExactLossFarInShadowIsItsAsymptote) {
  for (const double nu : {20.0, 100.0, 1000.0}) {
    EXPECT_NEAR(knifeEdgeExactDb(nu), 20 * std::log10(kPi * std::sqrt(2.0) * nu), 1e-3) << nu;
  }
}

TEST(KnifeEdge, ExactLossHasNoStepWhereItsFormsMeet) {
  EXPECT_NEAR(knifeEdgeExactDb(1.5 - 1e-9), knifeEdgeExactDb(1.5), 1e-7);
  EXPECT_NEAR(knifeEdgeExactDb(2.5 - 1e-9), knifeEdgeExactDb(2.5 + 1e-9), 1e-7);
  EXPECT_NEAR(knifeEdgeExactDb(-1.5 - 1e-9), knifeEdgeExactDb(-1.5 + 1e-9), 1e-7);
  EXPECT_NEAR(knifeEdgeExactDb(-200), 0, 0.02);
}

TEST(KnifeEdge, ApproximationIsWithinItsAccuracy) {
  for (double nu = -0.5; nu < 50; nu += 0.01) EXPECT_NEAR(knifeEdgeDb(nu), knifeEdgeExactDb(nu), 0.13) << nu;
  for (double nu = -3.01; nu < 100; nu += 0.037) {
    EXPECT_NEAR(knifeEdgeDb(float(nu)), knifeEdgeDb(double(float(nu))), 1e-5) << nu;
  }
  EXPECT_EQ(knifeEdgeDb(-HUGE_VAL), 0);
  EXPECT_TRUE(std::isnan(knifeEdgeDb(std::nan(""))));
}

TEST(Diffraction, OneWallEqualsKnifeEdgeWithCorrection) {
  ProfileData profile = flatProfile(20000, 401, -500);
  profile.height_msl_m[200] = 60;
  profile.height_msl_m.front() = profile.height_msl_m.back() = 0;
  const auto model = diffractionModel<double>(parametersAt(1e9));
  const double bulge_m = 1e4 * 1e4 / (2 * kEarth_m);
  const double nu = (60 - 20 + bulge_m) * std::sqrt(2 * 20000 / (wavelength_m(1e9) * 1e4 * 1e4));
  const DeltaBullington<double> loss = deltaBullington(model, profile.view(), 20.0, 20.0);
  const double edge_db = knifeEdgeDb(nu);
  EXPECT_NEAR(loss.terrain_db, edge_db + (1 - std::exp(-edge_db / 6)) * 10.4, 1e-9);
  EXPECT_NEAR(singleEdgeLossDb(model, profile.view(), 20.0, 20.0), edge_db, 1e-9);
  EXPECT_NEAR(deygoutLossDb(model, profile.view(), 20.0, 20.0), edge_db + (1 - std::exp(-edge_db / 6)) * 10.8,
              1e-9);
}

TEST(Diffraction, DeygoutTakesTheEdgesOnBothSidesOfTheMainOne) {
  ProfileData profile = flatProfile(40000, 401, -500);
  profile.height_msl_m.front() = profile.height_msl_m.back() = 0;
  profile.height_msl_m[100] = 150;
  profile.height_msl_m[200] = 320;
  profile.height_msl_m[300] = 180;
  const auto model = diffractionModel<double>(parametersAt(3e8));
  const TerrainProfile view = profile.view();
  const double main_db = singleEdgeLossDb(model, view, 10.0, 10.0);
  const double tx_db = knifeEdgeDb(mainEdge(model, view, 0, 10.0, 200, 320.0).nu);
  const double rx_db = knifeEdgeDb(mainEdge(model, view, 200, 320.0, 400, 10.0).nu);
  ASSERT_GT(tx_db, 0);
  EXPECT_NEAR(deygoutLossDb(model, view, 10.0, 10.0),
              main_db + (1 - std::exp(-main_db / 6)) * (tx_db + rx_db + 11.6), 1e-9);
}

TEST(Diffraction, SmoothEarthGivesSphericalEarthLoss) {
  const auto model = diffractionModel<double>(parametersAt(6e8));
  for (const double length_m : {20e3, 60e3, 120e3}) {
    const ProfileData profile = flatProfile(length_m, 2001);
    const DeltaBullington<double> loss = deltaBullington(model, profile.view(), 30.0, 30.0);
    EXPECT_NEAR(loss.loss_db, std::max(loss.spherical_db, loss.smooth_db), 1e-6) << length_m;
    EXPECT_EQ(loss.effective.tx_m, 30);
    EXPECT_NEAR(loss.terrain_db, loss.spherical_db > 0 ? loss.smooth_db : loss.terrain_db, 1e-9);
  }
}

TEST(Diffraction, TallerTreesOverFlatGroundNeverLowerTheLoss) {
  const ProfileData ground = flatProfile(13350, 535, 100);
  for (const double frequency_hz : {60e6, 1e9, 5e9}) {
    const auto model = diffractionModel<double>(parametersAt(frequency_hz));
    for (const double antenna_msl_m : {102.0, 105.0, 130.0}) {
      const double bare_db = deltaBullington(model, ground.view(), 105.0, antenna_msl_m).loss_db;
      double before_db = bare_db;
      for (const float trees_m : {0.0f, 1.0f, 3.0f, 6.0f, 10.0f, 15.0f, 22.0f, 30.0f, 45.0f}) {
        ProfileData wood = ground;
        for (int post = 200; post < 210; ++post) wood.height_msl_m[post] += trees_m;
        TerrainProfile profile = wood.view();
        profile.bare_msl_m = ground.height_msl_m.data();
        const double loss_db = deltaBullington(model, profile, 105.0, antenna_msl_m).loss_db;
        EXPECT_GE(loss_db, before_db - 1e-9) << frequency_hz << " Hz, " << trees_m << " m";
        before_db = loss_db;
      }
      EXPECT_GT(before_db, bare_db + 3) << frequency_hz;
    }
  }
}

TEST(Diffraction, OverTheSeaDiffersOnlyInTheSphericalPart) {
  DiffractionParameters land = parametersAt(5e7), sea = land;
  land.polarization = sea.polarization = LinearPolarization::vertical;
  sea.sea_fraction = 1;
  const ProfileData profile = flatProfile(100e3, 501);
  const auto on_land = deltaBullington(diffractionModel<double>(land), profile.view(), 10.0, 10.0);
  const auto at_sea = deltaBullington(diffractionModel<double>(sea), profile.view(), 10.0, 10.0);
  EXPECT_GT(on_land.spherical_db, at_sea.spherical_db + 10);
  EXPECT_EQ(on_land.terrain_db, at_sea.terrain_db);
  sea.sea_fraction = 0.5;
  const auto half = deltaBullington(diffractionModel<double>(sea), profile.view(), 10.0, 10.0);
  EXPECT_NEAR(half.spherical_db, (on_land.spherical_db + at_sea.spherical_db) / 2, 1e-9);
}

TEST(Diffraction, UnknownTerrainIsNeverAClearPath) {
  ProfileData profile = flatProfile(30e3, 101);
  profile.height_msl_m[40] = std::nanf("");
  const auto model = diffractionModel<double>(parametersAt(1e9));
  EXPECT_TRUE(std::isnan(deltaBullington(model, profile.view(), 5000.0, 5000.0).loss_db));
}

TEST(Diffraction, FrequencyMovesTheLossWithoutJumps) {
  std::mt19937 random(23);
  const ProfileData profile = madeUpProfile(random, 200, 60e3, 40);
  double before = 0;
  for (int n = 0; n < 2000; ++n) {
    const auto model = diffractionModel<double>(parametersAt(2e7 * std::pow(1.0035, n)));
    const double loss = deltaBullington(model, profile.view(), 100.0, 120.0).loss_db;
    if (n > 0) {
      EXPECT_NEAR(loss, before, 0.2) << n;
    }
    before = loss;
  }
}

TEST(Diffraction, EffectiveEarthRadiusIsAppliedOnce) {
  // The horizon over a smooth earth of a radius that is given: 6 dB of bulge where the path grazes.
  for (const double radius_m : {6371000.0, kEarth_m, 8.5e6}) {
    DiffractionParameters parameters = parametersAt(1e10);
    parameters.effective_earth_radius_m = radius_m;
    const auto model = diffractionModel<double>(parameters);
    const double horizon_m = 2 * std::sqrt(2 * radius_m * 50);
    const auto clearance = leastClearance(model.earth, horizon_m, 50.0, 50.0);
    EXPECT_NEAR(clearance.clearance_m, 0, 1e-6);
  }
}

TEST(Diffraction, MissingTerrainIsNotSeaLevel) {
  ProfileData profile = flatProfile(30e3, 101, 300);
  const auto model = diffractionModel<float>(parametersAt(1e9));
  profile.height_msl_m[100] = std::nanf("");
  EXPECT_TRUE(std::isnan(deltaBullington(model, profile.view(), 310.f, 310.f).loss_db));
  profile.height_msl_m[0] = std::nanf("");
  EXPECT_TRUE(std::isnan(deltaBullington(model, profile.view().upTo(0), 310.f, 310.f).loss_db));
}

TEST(Diffraction, AntennaBelowGroundIsRaisedToOneMetre) {
  const ProfileData profile = flatProfile(30e3, 101, 300);
  const auto model = diffractionModel<double>(parametersAt(1e9));
  EXPECT_EQ(deltaBullington(model, profile.view(), 310.0, 120.0).loss_db,
            deltaBullington(model, profile.view(), 310.0, 301.0).loss_db);
}

// Two lines between posts are often crossed within centimetres, where clearances differ by rounding alone.
TEST(SmoothEarth, EdgeWithPostsNearEachOtherIsThatOfAllPosts) {
  std::mt19937 random(1);
  const auto between = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  const auto exact = diffractionModel<double>(parametersAt(3e9));
  const auto model = diffractionModel<float>(parametersAt(3e9));
  for (int path = 0; path < 2000; ++path) {
    const double distance_m = between(5e3, 60e3);
    std::vector<double> range_m{0};
    while (range_m.back() < distance_m - 100) {
      range_m.push_back(range_m.back() + (between(0, 1) < 0.2 ? between(0.005, 0.3) : between(1, 60)));
    }
    const std::vector<float> posts(range_m.begin() + 1, range_m.end());
    range_m.push_back(distance_m);
    const EffectiveHeights<double> heights{between(1, 200), between(1, 300)};
    const auto around = [&](float at_m) {
      const auto after = std::lower_bound(posts.begin(), posts.end(), at_m);
      PostsAround<float> found;
      if (after != posts.begin()) found.before_m = after[-1];
      if (after != posts.end()) found.after_m = *after;
      return found;
    };
    const EffectiveHeights<float> of_heights{static_cast<float>(heights.tx_m),
                                             static_cast<float>(heights.rx_m)};
    const double nu = bullingtonNu(exact, range_m.data(), static_cast<int>(range_m.size()), heights.tx_m,
                                   heights.rx_m, [](int) { return 0.0; });
    EXPECT_NEAR(smoothEarthNu(model, static_cast<float>(distance_m), of_heights, around), nu, 1e-3) << path;
  }
}

TEST(SphericalEarth, ReflectionPointSolvesItsCubic) {
  const auto model = diffractionModel<double>(parametersAt(1e9));
  for (const double h1 : {1.0, 20.0, 500.0, 9000.0}) {
    for (const double h2 : {1.0, 3.0, 20.0, 2000.0}) {
      const double horizon_m = std::sqrt(2 * kEarth_m) * (std::sqrt(h1) + std::sqrt(h2));
      for (const double part : {1e-3, 0.1, 0.5, 0.9, 0.999999}) {
        const double d = part * horizon_m;
        // P.526-15 eq. (25), unmodified
        const double c = (h1 - h2) / (h1 + h2), m = d * d / (4 * kEarth_m * (h1 + h2));
        const double argument = 1.5 * c * std::sqrt(3 * m / std::pow(m + 1, 3));
        const double b = 2 * std::sqrt((m + 1) / (3 * m)) *
                         std::cos(kPi / 3 + std::acos(std::clamp(argument, -1.0, 1.0)) / 3);
        const double d1 = d / 2 * (1 + b), d2 = d - d1;
        const double clearance =
            ((h1 - d1 * d1 / (2 * kEarth_m)) * d2 + (h2 - d2 * d2 / (2 * kEarth_m)) * d1) / d;
        const auto least = leastClearance(model.earth, d, h1, h2);
        EXPECT_NEAR(least.clearance_m, clearance, 1e-6 * (h1 + h2)) << h1 << ", " << h2 << ", " << part;
      }
    }
  }
}

TEST(SphericalEarth, IsFreeOfLossFromTheClearHeightUpwards) {
  for (const double frequency_hz : {3e7, 1e9, 2e10}) {
    const auto earth = diffractionModel<double>(parametersAt(frequency_hz)).earth;
    for (const double distance_m : {1e3, 5e3, 40e3, 200e3}) {
      for (const double other_m : {2.0, 15.0, 800.0}) {
        bool was_clear = false;
        for (double height_m = 1; height_m < 12000; height_m += 7) {
          const bool is_clear = isClearThroughout(earth, distance_m, other_m, height_m);
          EXPECT_TRUE(is_clear || !was_clear);
          was_clear = is_clear;
          const double horizon_m = std::sqrt(2 * kEarth_m) * (std::sqrt(other_m) + std::sqrt(height_m));
          if (distance_m >= horizon_m) {
            EXPECT_FALSE(is_clear);
            continue;
          }
          // by P.526 itself: where the ray would be reflected
          const auto least = leastClearance(earth, distance_m, other_m, height_m);
          const bool is_clear_there = least.clearance_m > least.required_m;
          EXPECT_TRUE(is_clear_there || !is_clear) << frequency_hz << ", " << distance_m << ", " << height_m;
        }
      }
    }
  }
}

}  // namespace
}  // namespace emscape::propagation
