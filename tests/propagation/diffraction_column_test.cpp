// Diffraction of a column of receivers against path by path.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "propagation/diffraction/excess.h"
#include "tests/emfield/random_profile.h"

namespace emscape::propagation {
namespace {

using namespace emfield::testing;

DiffractionParameters parametersAt(double frequency_hz) {
  DiffractionParameters parameters;
  parameters.frequency_hz = frequency_hz;
  parameters.effective_earth_radius_m = 8.5e6;
  return parameters;
}

DiffractionParameters anyParameters(std::mt19937& random) {
  std::uniform_real_distribution<double> part(0, 1);
  DiffractionParameters parameters = parametersAt(3e7 * std::pow(1000, part(random)));
  parameters.effective_earth_radius_m = 6371000 * (0.8 + 1.2 * part(random));
  if (part(random) < 0.5) parameters.polarization = LinearPolarization::vertical;
  if (part(random) < 0.3) parameters.sea_fraction = part(random);
  return parameters;
}

/// Flat land 5 m high with sea from one post to another.
ProfileData coast(int posts, double step_m, int first_at_sea, int last_at_sea) {
  ProfileData data;
  for (int i = 0; i < posts; ++i) {
    data.range_m.push_back(i * step_m);
    data.height_msl_m.push_back(i >= first_at_sea && i <= last_at_sea ? 0.0f : 5.0f);
  }
  return data;
}

/// Losses of receivers above the end of a profile; NaN over missing terrain.
std::vector<float> excessOf(const TerrainProfile& profile, const DiffractionModel<float>& model,
                            float tx_msl_m, const std::vector<float>& heights) {
  const int count = int(heights.size());
  std::vector<double> memory(ExcessScratch::bytes(profile.count, count) / sizeof(double) + 1);
  ExcessColumn column;
  column.profile = profile;
  column.height_msl_m = heights.data();
  column.count = count;
  std::vector<float> losses(heights.size());
  const unsigned warnings = DiffractionExcess{model, tx_msl_m}(
      column, ExcessScratch::in(memory.data(), profile.count, count), losses.data());
  for (const float loss_db : losses) EXPECT_EQ(warnings == kMissingTerrain, std::isnan(loss_db));
  return losses;
}

/// Clutter of up to 40 m on some of the posts, from 50 m of the ends on.
std::vector<float> raisedByClutter(const TerrainProfile& profile, std::mt19937& random) {
  std::uniform_real_distribution<float> height_m(-40, 40);
  std::vector<float> raised_msl_m(profile.height_msl_m, profile.height_msl_m + profile.count);
  for (int i = 0; i < profile.count; ++i) {
    const double end_m =
        std::min(profile.range_m[i], profile.range_m[profile.count - 1] - profile.range_m[i]);
    if (end_m >= 50) raised_msl_m[static_cast<std::size_t>(i)] += std::max(height_m(random), 0.0f);
  }
  return raised_msl_m;
}

/// Largest difference (dB) of columns in float from paths in double, over 96 receivers above each of some
/// posts.
double largestDifferenceDb(const ProfileData& data, bool has_clutter, const DiffractionParameters& parameters,
                           double above_ground_m, double top_msl_m, std::mt19937& random) {
  const auto model = diffractionModel<double>(parameters);
  const auto single = diffractionModel<float>(parameters);
  const double tx = data.height_msl_m[0] + above_ground_m;
  std::uniform_int_distribution<int> any_post(1, int(data.range_m.size()) - 1);
  double largest = 0;
  for (int n = 0; n < 6; ++n) {
    TerrainProfile profile = data.view().upTo(any_post(random));
    const std::vector<float> raised_msl_m = raisedByClutter(profile, random);
    if (has_clutter) {
      profile.bare_msl_m = profile.height_msl_m;
      profile.height_msl_m = raised_msl_m.data();
    }
    const double lowest = double(profile.height_msl_m[profile.count - 1]) - 10;
    std::vector<float> heights;
    for (int j = 0; j < 96; ++j) heights.push_back(float(lowest + (top_msl_m - lowest) * j / 95));
    const std::vector<float> losses = excessOf(profile, single, float(tx), heights);
    for (std::size_t j = 0; j < heights.size(); ++j) {
      const double truth = deltaBullington(model, profile, tx, double(heights[j])).loss_db;
      largest = std::max(largest, std::abs(double(losses[j]) - truth));
      if (j % 16 != 0) continue;
      const float alone_db = excessOf(profile, single, float(tx), {heights[j]})[0];
      largest = std::max(largest, std::abs(double(alone_db) - truth));
    }
  }
  return largest;
}

TEST(DiffractionColumn, FloatColumnEqualsEachPathInDouble) {
  std::mt19937 random(11);
  double largest = 0;
  for (const double frequency_hz : {3e7, 3e8, 3e9, 2e10}) {
    for (const double length_m : {3e3, 40e3, 300e3}) {
      for (const double relief_m : {0.0, 20.0, 500.0}) {
        const ProfileData profile = madeUpProfile(random, 300, length_m, relief_m);
        for (const double above_ground_m : {2.0, 30.0, 3000.0}) {
          for (const bool has_clutter : {false, true}) {
            largest = std::max(largest, largestDifferenceDb(profile, has_clutter, parametersAt(frequency_hz),
                                                            above_ground_m, 5000, random));
          }
        }
      }
    }
  }
  RecordProperty("largest_db", std::to_string(largest));
  EXPECT_LT(largest, 0.002);
}

TEST(DiffractionColumn, FloatColumnOverRealTerrainEqualsEachPathInDouble) {
  const scenario::TerrainPtr terrain = whiteMountainsTile();
  std::mt19937 random(12);
  double largest = 0;
  for (int n = 0; n < 120; ++n) {
    const ProfileData profile = randomProfile(*terrain, random, 60 + 3 * n);
    const double above_ground_m = n % 3 == 0 ? 2 : n % 3 == 1 ? 30 : 1500;
    largest = std::max(largest, largestDifferenceDb(profile, n % 2 == 0, anyParameters(random),
                                                    above_ground_m, 800 + 30 * n, random));
  }
  RecordProperty("largest_db", std::to_string(largest));
  EXPECT_LT(largest, 0.002);
}

// A processor uses one of them.
TEST(DiffractionColumn, VectorsOf8And16NumbersHaveTheSameLosses) {
  std::mt19937 random(14);
  std::vector<float> heights;
  for (int j = 0; j < 100; ++j) heights.push_back(20.0f * static_cast<float>(j));
  for (const double relief_m : {0.0, 20.0, 500.0}) {
    const ProfileData profile = madeUpProfile(random, 300, 40e3, relief_m);
    ExcessColumn column;
    column.profile = profile.view();
    column.height_msl_m = heights.data();
    column.count = static_cast<int>(heights.size());
    const DiffractionExcess excess{diffractionModel<float>(parametersAt(1e9)), profile.height_msl_m[0] + 20};
    std::vector<float> by_8(heights.size(), -1), by_16(heights.size(), -2);
    excess.fillByLanes(8, column, by_8.data());
    excess.fillByLanes(16, column, by_16.data());
    for (std::size_t j = 0; j < heights.size(); ++j) EXPECT_NEAR(by_8[j], by_16[j], 1e-4) << heights[j];
    EXPECT_GT(by_8[0], relief_m > 0 ? 6.0f : 0.0f) << "a path with a loss";
  }
}

TEST(DiffractionColumn, MissingTerrainIsUnknown) {
  std::mt19937 random(13);
  ProfileData profile = madeUpProfile(random, 50, 10e3, 100);
  profile.height_msl_m[20] = std::nanf("");
  const auto model = diffractionModel<float>(parametersAt(1e9));
  EXPECT_FALSE(std::isnan(excessOf(profile.view().upTo(19), model, 500, {900})[0]));
  EXPECT_TRUE(std::isnan(excessOf(profile.view().upTo(30), model, 500, {900})[0]));
  EXPECT_TRUE(std::isnan(excessOf(profile.view().upTo(20), model, 500, {900})[0])) << "below the receivers";
}

TEST(DiffractionColumn, HasNoJumpsOverRealTerrain) {
  const auto terrain = whiteMountainsTile();
  std::mt19937 random(22);
  const auto model = diffractionModel<float>(parametersAt(1e9));
  for (int n = 0; n < 5; ++n) {
    const ProfileData profile = randomProfile(*terrain, random, 300);
    for (int post = 5; post < 290; post += 29) {
      std::vector<float> heights;
      for (int j = 0; j < 4000; ++j)
        heights.push_back(profile.height_msl_m[post] - 5 + 0.05f * static_cast<float>(j));
      const auto losses = excessOf(profile.view().upTo(post), model, profile.height_msl_m[0] + 10, heights);
      for (std::size_t j = 1; j < losses.size(); ++j) {
        // 5 cm up: steep only close behind an edge
        ASSERT_NEAR(losses[j], losses[j - 1], 1.0) << "post " << post << ", " << heights[j] << " m";
      }
    }
  }
}

TEST(DiffractionColumn, IsFiniteNextToTheAntenna) {
  ProfileData profile;
  for (int i = 0; i <= 1000; ++i) {
    profile.range_m.push_back(i);
    profile.height_msl_m.push_back(300);
  }
  const auto model = diffractionModel<float>(parametersAt(1e9));
  const std::vector<float> heights = {200, 301, 310, 5000};
  for (int post = 1; post < 4; ++post) {
    const TerrainProfile path = profile.view().upTo(post);
    const std::vector<float> losses = excessOf(path, model, 310, heights);
    for (std::size_t j = 0; j < heights.size(); ++j) {
      const float expected_db = deltaBullington(model, path, 310.f, heights[j]).loss_db;
      EXPECT_NEAR(losses[j], expected_db, 1e-3) << post << ", " << heights[j];
    }
  }
}

// P.526-15 section 3.1.2 with the parts of the path, which the posts give.
TEST(DiffractionColumn, TakesSeaFromThePostsAtMeanSeaLevel) {
  const ProfileData data = coast(401, 500, 100, 279);  // 90 of 200 km
  DiffractionParameters parameters = parametersAt(60e6);
  parameters.polarization = LinearPolarization::vertical;
  const std::vector<float> heights{15, 40, 100, 300};
  const auto losses = [&] { return excessOf(data.view(), diffractionModel<float>(parameters), 25, heights); };
  parameters.sea_by_height = true;
  const std::vector<float> found = losses();
  const double reference_db =
      deltaBullington(diffractionModel<double>(parameters), data.view(), 25.0, 15.0).loss_db;
  parameters.sea_by_height = false;
  const std::vector<float> land = losses();
  parameters.sea_fraction = 0.45;
  const std::vector<float> expected = losses();
  EXPECT_NEAR(double(found[0]), reference_db, 1e-3);
  for (std::size_t k = 0; k < heights.size(); ++k) EXPECT_NEAR(found[k], expected[k], 1e-4f);
  EXPECT_GT(land[0], found[0] + 5) << "the sea carries a vertically polarised wave of 60 MHz better";
}

TEST(DiffractionColumn, LastPostMayBeAtTheReceivers) {
  ProfileData profile;
  for (int i = 0; i <= 40; ++i) profile.range_m.push_back(250.0 * i);
  profile.range_m.push_back(10e3 + 1e-5);  // the same in float
  profile.height_msl_m.assign(profile.range_m.size(), 100);
  const auto model = diffractionModel<float>(parametersAt(3e9));
  const std::vector<float> heights = {150, 300, 1000, 1100, 1200, 1300, 1400, 1500, 1600, 1700};
  const std::vector<float> losses = excessOf(profile.view(), model, 400, heights);
  for (std::size_t j = 0; j < heights.size(); ++j) {
    EXPECT_NEAR(losses[j], deltaBullington(model, profile.view(), 400.f, heights[j]).loss_db, 1e-3)
        << heights[j];
  }
}

}  // namespace
}  // namespace emscape::propagation
