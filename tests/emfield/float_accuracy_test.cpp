// Differences between the models in single precision, as on a GPU, and in double precision. The differences
// for terrain profiles, ITM, two rays and rain are in the tests of these models.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "propagation/diffraction/edges.h"
#include "propagation/horizon/horizon.h"
#include "tests/emfield/random_profile.h"

namespace emscape::emfield {
namespace {

using namespace propagation;

using namespace emscape::emfield::testing;

constexpr double kGoal_db = 0.05;

template <class Real>
DiffractionModel<Real> modelAt(double frequency_hz) {
  DiffractionParameters parameters;
  parameters.frequency_hz = frequency_hz;
  parameters.effective_earth_radius_m = 6371000 * 4.0 / 3;
  return diffractionModel<Real>(parameters);
}

TEST(FloatAccuracy, SphericalEarthLossErrorIsSmall) {
  double largest_db = 0;
  for (const double frequency_hz : {30e6, 1e9, 20e9}) {
    const auto exact = modelAt<double>(frequency_hz).earth;
    const auto single = modelAt<float>(frequency_hz).earth;
    for (double distance_m = 500; distance_m < 500e3; distance_m *= 1.3) {
      for (double height_m = 1; height_m < 15e3; height_m *= 1.7) {
        for (const double other_m : {2.0, 30.0, 900.0}) {
          const double loss_db = sphericalEarthLossDb(exact, distance_m, other_m, height_m);
          const float rounded_db =
              sphericalEarthLossDb(single, float(distance_m), float(other_m), float(height_m));
          // beyond 250 dB the field's codes hold no more
          if (loss_db < 250) largest_db = std::max(largest_db, std::abs(loss_db - double(rounded_db)));
        }
      }
    }
  }
  EXPECT_LT(largest_db, kGoal_db);
}

TEST(FloatAccuracy, EdgeLossErrorOverGeneratedTerrainIsSmall) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(0, 1);
  int compared = 0, beyond = 0;
  double largest_db = 0;
  for (int i = 0; i < 300; ++i) {
    const ProfileData profile = madeUpProfile(random, 150, 5e3 + 60e3 * part(random), 500 * part(random));
    const double frequency_hz = 50e6 * std::pow(200, part(random));
    const auto exact = modelAt<double>(frequency_hz);
    const auto single = modelAt<float>(frequency_hz);
    const float tx_msl_m = profile.height_msl_m.front() + 20;
    for (int j = 0; j < 20; ++j) {
      const float rx_msl_m = profile.height_msl_m.back() + float(2 + 3000 * part(random) * part(random));
      const double edge_db = singleEdgeLossDb(exact, profile.view(), double(tx_msl_m), double(rx_msl_m));
      EXPECT_NEAR(double(singleEdgeLossDb(single, profile.view(), tx_msl_m, rx_msl_m)), edge_db, kGoal_db);
      const double deygout_db = deygoutLossDb(exact, profile.view(), double(tx_msl_m), double(rx_msl_m));
      const double difference_db =
          std::abs(double(deygoutLossDb(single, profile.view(), tx_msl_m, rx_msl_m)) - deygout_db);
      ++compared;
      beyond +=
          difference_db > kGoal_db;  // where rounding makes another post the main edge: the model's jump
      if (difference_db < kGoal_db) largest_db = std::max(largest_db, difference_db);
    }
  }
  EXPECT_LE(beyond, compared / 500);
  EXPECT_LT(largest_db, kGoal_db);
}

/// Position of a shadow's edge in metres, as `horizon` gives either no loss or no field.
TEST(FloatAccuracy, ShadowHeightErrorIsSmall) {
  std::mt19937 random(9);
  double largest_m = 0;
  for (int i = 0; i < 200; ++i) {
    const ProfileData profile = madeUpProfile(random, 150, 60e3, 400);
    const HorizonGeometry<double> exact{double(profile.height_msl_m.front()) + 20, 6371000 * 4.0 / 3};
    const HorizonGeometry<float> single{float(exact.station_height_msl_m),
                                        float(exact.effective_earth_radius_m)};
    const int last = int(profile.range_m.size()) - 1;
    double slope = -HUGE_VAL;
    float rounded = -HUGE_VALF;
    for (int post = 1; post < last; ++post) {
      slope = std::max(slope, exact.slopeTo(double(profile.height_msl_m[std::size_t(post)]),
                                            exact.termsAt(profile.range_m[std::size_t(post)])));
      rounded = std::max(rounded, single.slopeTo(profile.height_msl_m[std::size_t(post)],
                                                 single.termsAt(profile.range_m[std::size_t(post)])));
    }
    const double edge_m = exact.heightOn(slope, exact.termsAt(profile.range_m.back()));
    const double single_m = double(single.heightOn(rounded, single.termsAt(profile.range_m.back())));
    largest_m = std::max(largest_m, std::abs(edge_m - single_m));
  }
  EXPECT_LT(largest_m, 2);
}

}  // namespace
}  // namespace emscape::emfield
