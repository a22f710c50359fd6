// Diffraction of a column of receivers, as devices find it, against path by path.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "propagation/diffraction/column.h"
#include "tests/emfield/random_profile.h"

namespace emscape::propagation {
namespace {

using namespace emfield::testing;

/// A profile whose last post stands below the receivers.
class ProfilePosts {
 public:
  ProfilePosts(const TerrainProfile& profile, double half_curvature) : profile_(profile) {
    TerrainSums sums;
    for (int i = 0; i < count(); ++i) {
      const double lowered = double(height_msl_m(i)) - half_curvature * range_m(i) * range_m(i);
      if (i % kDiffractionBlock == 0) {
        blocks_.push_back({height_msl_m(i), float(lowered), sums});
      }
      blocks_.back().highest = std::max(blocks_.back().highest, height_msl_m(i));
      blocks_.back().lowered = std::max(blocks_.back().lowered, float(lowered));
      if (i > 0) sums.add(profile_, i);
    }
  }

  const TerrainProfile& profile() const { return profile_; }
  int count() const { return profile_.count - 1; }
  double range_m(int i) const { return profile_.range_m[i]; }
  float height_msl_m(int i) const { return profile_.height_msl_m[i]; }
  float highest_msl_m(int block) const { return blocks_[block].highest; }
  float lowered_msl_m(int block) const { return blocks_[block].lowered; }
  TerrainSums sumsBefore(int block) const { return blocks_[block].before; }
  double distance_m() const { return profile_.range_m[profile_.count - 1]; }
  float ground_msl_m() const { return profile_.height_msl_m[profile_.count - 1]; }
  int lastBefore(double range_m) const {
    const double* const end = profile_.range_m + profile_.count - 1;
    const int after = static_cast<int>(std::lower_bound(profile_.range_m, end, range_m) - profile_.range_m);
    return std::max(0, after - 1);
  }

 private:
  struct Block {
    float highest, lowered;
    TerrainSums before;
  };
  TerrainProfile profile_;
  std::vector<Block> blocks_;
};

DiffractionParameters parametersAt(double frequency_hz) {
  DiffractionParameters parameters;
  parameters.frequency_hz = frequency_hz;
  parameters.effective_earth_radius_m = 8.5e6;
  return parameters;
}

/// Largest difference (dB) of columns from paths in double, over 96 receivers above each of some posts.
double largestDifferenceDb(const ProfileData& data, double frequency_hz, double above_ground_m,
                           double top_msl_m, std::mt19937& random) {
  const auto parameters = parametersAt(frequency_hz);
  const auto model = diffractionModel<double>(parameters);
  const auto single = diffractionModel<float>(parameters);
  const double tx = data.height_msl_m[0] + above_ground_m;
  std::uniform_int_distribution<int> any_post(1, int(data.range_m.size()) - 1);
  double largest = 0;
  for (int n = 0; n < 6; ++n) {
    const ProfilePosts posts(data.view().upTo(any_post(random)), model.half_curvature);
    DiffractionColumn<float, ProfilePosts> column(single, posts, float(tx));
    EXPECT_FALSE(column.isUnknown());
    const double lowest = posts.ground_msl_m();
    bool is_free = false;
    for (int group = 0; group < 12; ++group) {
      float heights[8], losses[8];
      for (int j = 0; j < 8; ++j) heights[j] = float(lowest + (top_msl_m - lowest) * (group * 8 + j) / 95);
      if (is_free) {
        std::fill_n(losses, 8, 0.0f);
      } else {
        is_free = column.losses(heights, losses);
      }
      for (int j = 0; j < 8; ++j) {
        const double truth = deltaBullington(model, posts.profile(), tx, double(heights[j])).loss_db;
        largest = std::max(largest, std::abs(double(losses[j]) - truth));
      }
    }
  }
  return largest;
}

TEST(DiffractionColumn, InSinglePrecisionIsThatOfEachPathInDouble) {
  std::mt19937 random(11);
  double largest = 0;
  for (const double frequency_hz : {3e7, 3e8, 3e9, 2e10}) {
    for (const double length_m : {3e3, 40e3, 300e3}) {
      for (const double relief_m : {0.0, 20.0, 500.0}) {
        const ProfileData profile = madeUpProfile(random, 300, length_m, relief_m);
        for (const double above_ground_m : {2.0, 30.0, 3000.0}) {
          largest =
              std::max(largest, largestDifferenceDb(profile, frequency_hz, above_ground_m, 5000, random));
        }
      }
    }
  }
  RecordProperty("largest_db", std::to_string(largest));
  EXPECT_LT(largest, 0.05);
}

TEST(DiffractionColumn, OverRealTerrainIsThatOfEachPathInDouble) {
  const scenario::TerrainPtr terrain = whiteMountainsTile();
  std::mt19937 random(12);
  double largest = 0;
  for (int n = 0; n < 40; ++n) {
    const ProfileData profile = randomProfile(*terrain, random, 400);
    largest = std::max(largest, largestDifferenceDb(profile, n % 2 == 0 ? 1e8 : 5e9, 15, 4000, random));
  }
  RecordProperty("largest_db", std::to_string(largest));
  EXPECT_LT(largest, 0.05);
}

TEST(DiffractionColumn, MissingTerrainIsUnknown) {
  std::mt19937 random(13);
  ProfileData profile = madeUpProfile(random, 50, 10e3, 100);
  profile.height_msl_m[20] = std::nanf("");
  const auto model = diffractionModel<float>(parametersAt(1e9));
  const ProfilePosts before(profile.view().upTo(19), double(model.half_curvature));
  const ProfilePosts beyond(profile.view().upTo(30), double(model.half_curvature));
  EXPECT_FALSE((DiffractionColumn<float, ProfilePosts>(model, before, 500.0f).isUnknown()));
  EXPECT_TRUE((DiffractionColumn<float, ProfilePosts>(model, beyond, 500.0f).isUnknown()));
}

}  // namespace
}  // namespace emscape::propagation
