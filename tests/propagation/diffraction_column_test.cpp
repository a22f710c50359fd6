// Diffraction of a column of receivers against path by path.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "propagation/diffraction/excess.h"
#include "propagation/diffraction/obstacle_maxima.h"
#include "propagation/diffraction/profile_posts.h"
#include "tests/emfield/random_profile.h"

namespace emscape::propagation {
namespace {

using namespace emfield::testing;

/// A profile with the memory of its posts.
class Posts {
 public:
  Posts(const TerrainProfile& profile, double half_curvature)
      : profile_(profile),
        maxima_(2 * std::size_t(ProfilePosts::blockCount(profile))),
        posts_(profile, half_curvature, maxima_.data(), maxima_.data() + maxima_.size() / 2) {}

  const TerrainProfile& profile() const { return profile_; }
  const ProfilePosts& posts() const { return posts_; }

 private:
  TerrainProfile profile_;
  std::vector<float> maxima_;
  ProfilePosts posts_;
};

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

/// Losses of receivers above the end of a profile.
template <class Real>
std::vector<Real> lossesOf(const Posts& posts, const DiffractionModel<Real>& model, Real tx_msl_m,
                           const std::vector<Real>& heights) {
  constexpr std::size_t kGroup = kDiffractionReceivers;
  DiffractionColumn<Real, ProfilePosts> column(model, posts.posts(), tx_msl_m);
  EXPECT_FALSE(column.isUnknown());
  std::vector<Real> losses(heights.size(), 0);
  bool is_free = false;
  for (std::size_t k = 0; k < heights.size() && !is_free; k += kGroup) {
    Real group[kGroup], loss_db[kGroup];
    for (std::size_t j = 0; j < kGroup; ++j) group[j] = heights[std::min(k + j, heights.size() - 1)];
    is_free = column.losses(group, loss_db);
    for (std::size_t j = 0; j < kGroup && k + j < heights.size(); ++j) losses[k + j] = loss_db[j];
  }
  return losses;
}

/// The same by the vector loops of the CPU; NaN over missing terrain.
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

/// Largest difference (dB) of columns in float from paths in double, over 96 receivers above each of some
/// posts.
double largestDifferenceDb(const ProfileData& data, const DiffractionParameters& parameters,
                           double above_ground_m, double top_msl_m, std::mt19937& random) {
  const auto model = diffractionModel<double>(parameters);
  const auto single = diffractionModel<float>(parameters);
  const double tx = data.height_msl_m[0] + above_ground_m;
  std::uniform_int_distribution<int> any_post(1, int(data.range_m.size()) - 1);
  double largest = 0;
  for (int n = 0; n < 6; ++n) {
    const Posts posts(data.view().upTo(any_post(random)), model.half_curvature);
    const double lowest = posts.posts().ground_msl_m() - 10;
    std::vector<float> heights;
    for (int j = 0; j < 96; ++j) heights.push_back(float(lowest + (top_msl_m - lowest) * j / 95));
    const std::vector<float> losses = lossesOf(posts, single, float(tx), heights);
    const std::vector<float> lanes = excessOf(posts.profile(), single, float(tx), heights);
    for (std::size_t j = 0; j < heights.size(); ++j) {
      const double truth = deltaBullington(model, posts.profile(), tx, double(heights[j])).loss_db;
      largest = std::max({largest, std::abs(double(losses[j]) - truth), std::abs(double(lanes[j]) - truth)});
      if (j % 16 != 0) continue;
      const float alone_db = excessOf(posts.profile(), single, float(tx), {heights[j]})[0];
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
          largest = std::max(largest, largestDifferenceDb(profile, parametersAt(frequency_hz), above_ground_m,
                                                          5000, random));
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
    largest = std::max(
        largest, largestDifferenceDb(profile, anyParameters(random), above_ground_m, 800 + 30 * n, random));
  }
  RecordProperty("largest_db", std::to_string(largest));
  EXPECT_LT(largest, 0.002);
}

TEST(ObstacleMaxima, EqualEachPathInDouble) {
  const scenario::TerrainPtr terrain = whiteMountainsTile();
  std::mt19937 random(14);
  std::uniform_real_distribution<double> part(0, 1);
  double largest = 0;
  int blocked = 0, clear = 0;
  for (int n = 0; n < 2000; ++n) {
    const ProfileData data = randomProfile(*terrain, random, 3 + n % 200);
    const TerrainProfile profile = data.view();
    const DiffractionParameters parameters = anyParameters(random);
    const auto model = diffractionModel<double>(parameters);
    const auto single = diffractionModel<float>(parameters);
    const int last = profile.count - 1;
    const float base = profile.height_msl_m[0], tx_m = n % 3 == 0 ? 2.0f : n % 3 == 1 ? 30.0f : 1500.0f;
    float rx_m[3];
    for (float& height_m : rx_m) {
      height_m = profile.height_msl_m[last] - base + float(1 + 3000 * std::pow(part(random), 3.0));
    }
    ObstacleMaxima<float, 3> obstacles(single, float(profile.range_m[last]), tx_m, rx_m);
    for (int i = 1; i < last; ++i) obstacles.add(float(profile.range_m[i]), profile.height_msl_m[i] - base);
    for (int j = 0; j < 3; ++j) {
      const double truth_db =
          deltaBullington(model, profile, double(base) + double(tx_m), double(base) + double(rx_m[j]))
              .terrain_db;
      ++(truth_db > 6.1 ? blocked : clear);
      largest = std::max(largest, std::abs(double(obstacles.lossDb(single, j)) - truth_db));
    }
  }
  RecordProperty("largest_db", std::to_string(largest));
  EXPECT_LT(largest, 0.002);
  EXPECT_GT(blocked, 500);
  EXPECT_GT(clear, 500);
}

TEST(ObstacleMaxima, PathWithoutObstacleHasNoLoss) {
  const auto model = diffractionModel<float>(parametersAt(1e9));
  EXPECT_EQ((ObstacleMaxima<float, 1>(model, 100, 20, {30}).lossDb(model, 0)), 0);
}

TEST(DiffractionColumn, MissingTerrainIsUnknown) {
  std::mt19937 random(13);
  ProfileData profile = madeUpProfile(random, 50, 10e3, 100);
  profile.height_msl_m[20] = std::nanf("");
  const auto model = diffractionModel<float>(parametersAt(1e9));
  const Posts before(profile.view().upTo(19), double(model.half_curvature));
  const Posts beyond(profile.view().upTo(30), double(model.half_curvature));
  EXPECT_FALSE((DiffractionColumn<float, ProfilePosts>(model, before.posts(), 500.0f).isUnknown()));
  EXPECT_TRUE((DiffractionColumn<float, ProfilePosts>(model, beyond.posts(), 500.0f).isUnknown()));
  EXPECT_FALSE(std::isnan(excessOf(before.profile(), model, 500, {900})[0]));
  EXPECT_TRUE(std::isnan(excessOf(beyond.profile(), model, 500, {900})[0]));
  EXPECT_TRUE(std::isnan(excessOf(profile.view().upTo(20), model, 500, {900})[0])) << "below the receivers";
}

TEST(DiffractionColumn, HasNoJumpsOverRealTerrain) {
  const auto terrain = whiteMountainsTile();
  std::mt19937 random(22);
  const auto model = diffractionModel<double>(parametersAt(1e9));
  for (int n = 0; n < 5; ++n) {
    const ProfileData profile = randomProfile(*terrain, random, 300);
    for (int post = 5; post < 290; post += 29) {
      const Posts posts(profile.view().upTo(post), model.half_curvature);
      std::vector<double> heights;
      for (int j = 0; j < 4000; ++j) heights.push_back(double(posts.posts().ground_msl_m()) - 5 + 0.05 * j);
      const auto losses = lossesOf(posts, model, double(profile.height_msl_m[0]) + 10, heights);
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
    const Posts posts(profile.view().upTo(post), double(model.half_curvature));
    const std::vector<float> losses = lossesOf(posts, model, 310.0f, heights);
    const std::vector<float> lanes = excessOf(posts.profile(), model, 310.0f, heights);
    for (std::size_t j = 0; j < heights.size(); ++j) {
      const float expected_db = deltaBullington(model, posts.profile(), 310.f, heights[j]).loss_db;
      EXPECT_NEAR(losses[j], expected_db, 1e-3) << post << ", " << heights[j];
      EXPECT_NEAR(lanes[j], expected_db, 1e-3) << post << ", " << heights[j];
    }
  }
}

// P.526-15 section 3.1.2 with the parts of the path, which the posts give.
TEST(DiffractionColumn, TakesSeaFromThePostsAtMeanSeaLevel) {
  const ProfileData data = coast(401, 500, 100, 279);  // 90 of 200 km
  DiffractionParameters parameters = parametersAt(60e6);
  parameters.polarization = LinearPolarization::vertical;
  const std::vector<double> heights{15, 40, 100, 300};
  const Posts posts(data.view(), 0.5 / parameters.effective_earth_radius_m);
  parameters.sea_by_height = true;
  const std::vector<double> found = lossesOf(posts, diffractionModel<double>(parameters), 25.0, heights);
  const double reference_db =
      deltaBullington(diffractionModel<double>(parameters), data.view(), 25.0, heights[0]).loss_db;
  parameters.sea_by_height = false;
  const std::vector<double> land = lossesOf(posts, diffractionModel<double>(parameters), 25.0, heights);
  parameters.sea_fraction = 0.45;
  const std::vector<double> expected = lossesOf(posts, diffractionModel<double>(parameters), 25.0, heights);
  EXPECT_NEAR(found[0], reference_db, 1e-9);
  for (std::size_t k = 0; k < heights.size(); ++k) EXPECT_NEAR(found[k], expected[k], 1e-6);
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
