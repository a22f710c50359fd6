// Profiles with posts where a path crosses the lines between the posts of the elevation model.
#include "emfield/ground/chord_crossings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "emfield/ground/read_posts.h"
#include "emscape/base/error.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/emfield/link/path_profile.h"
#include "tests/emfield/made_terrain.h"

namespace emscape::emfield {
namespace {

using testing::MadeTerrain;

constexpr int kRows = 60, kColumns = 70;

/// A raster of random heights.
std::vector<float> randomHeights(std::mt19937& random) {
  std::uniform_real_distribution<float> height(0, 1000);
  std::vector<float> heights(kRows * kColumns);
  for (float& here : heights) here = height(random);
  return heights;
}

RasterChord chordThrough(const std::vector<float>& heights, const Parabola<float>& column,
                         const Parabola<float>& row) {
  RasterChord chord;
  chord.per_m = 1e-3;
  chord.corner_msl_m = heights.data();
  chord.row_posts = kColumns;
  chord.column = column;
  chord.row = row;
  return chord;
}

/// Random chords inside the raster; some nearly parallel to its lines, some of them turning back.
std::vector<RasterChord> randomChords(const std::vector<float>& heights, std::mt19937& random) {
  std::uniform_real_distribution<float> at(4, 55), small(-3, 3);
  std::vector<RasterChord> chords;
  for (int n = 0; n < 3000; ++n) {
    Parabola<float> column{{at(random), 0, small(random) * 0.3f}}, row{{at(random), 0, small(random) * 0.3f}};
    column.c[1] = n % 3 == 0 ? small(random) : at(random) - column.c[0];
    row.c[1] = n % 3 == 1 ? small(random) : at(random) - row.c[0];
    if (n % 7 == 0) column.c[0] = std::round(column.c[0]);
    if (n % 11 == 0) row.c[0] = std::round(row.c[0]);
    chords.push_back(chordThrough(heights, column, row));
  }
  return chords;
}

std::vector<Crossing> crossingsOf(const ChordCrossings& crossings) {
  std::vector<Crossing> all;
  for (int n = 0; n < crossings.columns.count; ++n) all.push_back(crossings.atColumn(n));
  for (int n = 0; n < crossings.rows.count; ++n) all.push_back(crossings.atRow(n));
  return all;
}

TEST(ChordCrossings, AreOnTheLinesAtTheHeightOfTheGround) {
  std::mt19937 random(1);
  const std::vector<float> heights = randomHeights(random);
  for (const RasterChord& chord : randomChords(heights, random)) {
    const ChordCrossings crossings(chord);
    const auto isOnALine = [](float coordinate) {
      return std::abs(coordinate - std::round(coordinate)) < 1e-4f;
    };
    for (const Crossing& crossing : crossingsOf(crossings)) {
      const float column = chord.column.at(crossing.part), row = chord.row.at(crossing.part);
      ASSERT_TRUE(isOnALine(column) || isOnALine(row)) << column << ' ' << row;
      ASSERT_NEAR(crossing.height_msl_m, bilinearHeight(chord.corner_msl_m, kColumns, column, row), 0.2);
    }
  }
}

TEST(ChordCrossings, OfNearlyStraightChordsAreTheSameWithoutDivision) {
  std::mt19937 random(6);
  const std::vector<float> heights = randomHeights(random);
  int straight = 0;
  for (RasterChord chord : randomChords(heights, random)) {
    chord.column.c[2] *= 0.3f;
    const ChordCrossings crossings(chord);
    if (!crossings.columns.is_straight) continue;
    for (int n = 0; n < crossings.columns.count; ++n, ++straight) {
      const Crossing general = crossings.atColumn(n), fast = crossings.atColumn<true>(n);
      ASSERT_NEAR(fast.part, general.part, 1e-6f);
      ASSERT_NEAR(fast.height_msl_m, general.height_msl_m, 0.2f);
    }
  }
  EXPECT_GT(straight, 5000);
}

TEST(ChordCrossings, AreAllThatAWalkInSmallStepsMeets) {
  std::mt19937 random(2);
  const std::vector<float> heights = randomHeights(random);
  constexpr int kSteps = 20000;
  for (const RasterChord& chord : randomChords(heights, random)) {
    const ChordCrossings crossings(chord);
    std::vector<float> parts;
    for (const Crossing& crossing : crossingsOf(crossings)) parts.push_back(crossing.part);
    std::sort(parts.begin(), parts.end());
    float before = 0;
    for (int step = 1; step <= kSteps; step += 7) {
      const float part = static_cast<float>(step) / kSteps;
      const auto changes = [&](const Parabola<float>& coordinate) {
        return std::floor(coordinate.at(before)) != std::floor(coordinate.at(part));
      };
      if (changes(chord.column) || changes(chord.row)) {
        const auto next = std::lower_bound(parts.begin(), parts.end(), before - 1e-5f);
        ASSERT_TRUE(next != parts.end() && *next <= part + 1e-5f) << before;
      }
      before = part;
    }
  }
}

TEST(ChordCrossings, PlacesAreInTheOrderOfParts) {
  std::mt19937 random(3);
  const std::vector<float> heights = randomHeights(random);
  int empty = 0, all = 0;
  for (const RasterChord& chord : randomChords(heights, random)) {
    const ChordCrossings crossings(chord);
    std::vector<float> part(static_cast<std::size_t>(crossings.count()) + 1, -1.0f);
    part[0] = 0;
    for (const Crossing& crossing : crossingsOf(crossings)) {
      ASSERT_GE(crossing.place, 1);
      ASSERT_LE(crossing.place, crossings.count());
      part[static_cast<std::size_t>(crossing.place)] = crossing.part;
    }
    float before = 0;
    for (const float here : part) {
      empty += here < 0;
      ++all;
      if (here < 0) continue;
      ASSERT_GE(here, before - 2e-5f);
      before = here;
    }
  }
  EXPECT_LT(empty, all / 500);
}

TEST(ChordCrossings, AlongADiagonalOfPostsAreHarmless) {
  std::mt19937 random(4);
  const std::vector<float> heights = randomHeights(random);
  for (const float sign : {1.0f, -1.0f}) {
    const RasterChord chord =
        chordThrough(heights, {{sign > 0 ? 5.0f : 45.0f, sign * 40, 0}}, {{10.0f, 40, 0}});
    const ChordCrossings crossings(chord);
    EXPECT_EQ(crossings.count(), 80);
    for (const Crossing& crossing : crossingsOf(crossings)) {
      const float column = chord.column.at(crossing.part), row = chord.row.at(crossing.part);
      const auto post = static_cast<std::size_t>(std::lround(row) * kColumns + std::lround(column));
      EXPECT_NEAR(crossing.height_msl_m, heights[post], 0.1f);
    }
  }
}

/// Random paths around the middle of a terrain, with both ends 20 m above the ground.
struct RandomPath {
  PathEnd begin, end;
};
std::vector<RandomPath> randomPaths(const scenario::Terrain& terrain, double half_side_deg, int count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> within(-half_side_deg, half_side_deg);
  const auto any = [&] {
    GeodeticPosition at{44.5 + within(random), -71.5 + within(random), 0};
    const double height_msl_m = terrain.heightMsl_m(at.latitude_deg, at.longitude_deg) + 20;
    at.height_ellipsoid_m = height_msl_m + geoidUndulation_m(at.latitude_deg, at.longitude_deg);
    return PathEnd{at, height_msl_m};
  };
  std::vector<RandomPath> paths;
  for (int n = 0; n < count; ++n) paths.push_back({any(), any()});
  return paths;
}

PathProfile profileOf(const scenario::Terrain& terrain, const RandomPath& path, bool at_crossings) {
  return readPathProfile(path.begin, path.end, 4.0 / 3, &terrain, at_crossings);
}

TEST(ProfileAtCrossings, NeverMissesACrestOnALineBetweenPosts) {
  // Walls one post wide along a meridian and along a parallel.
  constexpr double kWall_deg = 0.25, kPost_deg = 1.0 / 1200;
  const auto isOnWall = [](double at_deg) { return std::abs(at_deg - kWall_deg) < kPost_deg / 2; };
  const MadeTerrain terrain(44.5, -71.5, 0.5, [&](double east_deg, double north_deg) {
    return isOnWall(east_deg) || isOnWall(north_deg) ? 60.0 : 0.0;
  });
  int crossed = 0, missed_by_regular = 0;
  for (const RandomPath& path : randomPaths(terrain, 0.2, 100)) {
    const double east = (path.begin.position.longitude_deg + 71.5) * (path.end.position.longitude_deg + 71.5);
    const double north = (path.begin.position.latitude_deg - 44.5) * (path.end.position.latitude_deg - 44.5);
    if (!(std::min(east, north) < -1e-4)) continue;
    ++crossed;
    const auto highestOf = [&](bool at_crossings) {
      const PathProfile profile = profileOf(terrain, path, at_crossings);
      return *std::max_element(profile.ground_msl_m.begin(), profile.ground_msl_m.end());
    };
    EXPECT_NEAR(highestOf(true), 60, 0.1);
    missed_by_regular += highestOf(false) < 59;
  }
  EXPECT_GT(crossed, 40);
  EXPECT_GT(missed_by_regular, crossed / 2);
}

TEST(ProfileAtCrossings, IsInOrderBetweenItsEndsAndFitsItsMemory) {
  const MadeTerrain terrain(44.5, -71.5, 1.0);
  for (const RandomPath& path : randomPaths(terrain, 0.45, 200)) {
    const PathProfile profile = profileOf(terrain, path, true);
    const Station station = makeStation(path.begin.position, path.begin.height_msl_m, 4.0 / 3);
    const std::vector<double> regular_m = postRanges(profile.range_m, terrain.postSpacing_m());
    EXPECT_LE(profile.count(), maxPosts(station, groundPosts(&terrain, regular_m), true));
    EXPECT_EQ(profile.ranges_m[0], 0);
    for (int i = 1; i < profile.count(); ++i) {
      ASSERT_GT(profile.ranges_m[i], 0);
      ASSERT_GE(profile.ranges_m[i], profile.ranges_m[i - 1] - 0.01);
      if (i + 1 < profile.count()) {
        ASSERT_LT(static_cast<float>(profile.ranges_m[i]), static_cast<float>(profile.range_m));
      }
    }
  }
}

TEST(ProfileAtCrossings, HasTheHeightOfTheGroundAtEveryRange) {
  const MadeTerrain terrain(44.5, -71.5, 1.0);
  int posts = 0;
  for (const RandomPath& path : randomPaths(terrain, 0.45, 100)) {
    const PathProfile profile = profileOf(terrain, path, true);
    const Station station = makeStation(path.begin.position, path.begin.height_msl_m, 4.0 / 3);
    FastInverse to;
    to.distance_m = profile.range_m;
    to.sin_azimuth = std::sin(profile.azimuth_rad);
    to.cos_azimuth = std::cos(profile.azimuth_rad);
    const scenario::TerrainView view = terrain.view();
    TerrainWalk walk(station, view, to);
    for (int i = 0; i + 1 < profile.count(); ++i, ++posts) {
      ASSERT_NEAR(profile.ground_msl_m[i], walk.heightAt(profile.ranges_m[i]), 0.1) << profile.ranges_m[i];
    }
  }
  EXPECT_GT(posts, 50000);
}

TEST(ProfileAtCrossings, ReadsRegularPostsBesideAVoid) {
  const MadeTerrain terrain(44.5, -71.5, 1.0, 0.1);
  int unknown = 0;
  for (const RandomPath& path : randomPaths(terrain, 0.45, 200)) {
    if (std::isnan(path.begin.height_msl_m) || std::isnan(path.end.height_msl_m)) continue;
    const auto isKnown = [&](bool at_crossings) {
      try {
        return profileOf(terrain, path, at_crossings).count() > 0;
      } catch (const Error&) {
        return false;
      }
    };
    const bool is_known = isKnown(true);
    unknown += !is_known;
    EXPECT_EQ(is_known, isKnown(false));
  }
  EXPECT_GE(unknown, 10);
}

/// Hills with a void post, below which a second raster is whole.
class FilledHole : public MadeTerrain {
 public:
  FilledHole()
      : MadeTerrain(44.5, -71.5, 0.5,
                    [](double east_deg, double north_deg) {
                      const bool is_void = std::hypot(east_deg - 0.25, north_deg - 0.25) < 1e-4;
                      return is_void ? std::nan("") : heightAt(east_deg, north_deg);
                    }),
        whole(44.5, -71.5, 0.5, heightAt),
        rasters_{MadeTerrain::view().rasters[0], whole.view().rasters[0]} {}
  scenario::TerrainView view() const override { return {rasters_, 2}; }

  const MadeTerrain whole;

 private:
  static double heightAt(double east_deg, double north_deg) {
    return 300 + 200 * std::sin(70 * east_deg) * std::cos(90 * north_deg);
  }

  const scenario::TerrainRaster rasters_[2];
};

TEST(ProfileAtCrossings, KeepsCrossingsWhereOnlyPostsInTheEmittersCellAreBesideAVoid) {
  const FilledHole terrain;
  const double height_msl_m = terrain.whole.heightMsl_m(44.5, -71.5) + 20;
  const RandomPath path{{{44.5002, -71.4998, height_msl_m}, height_msl_m},
                        {{44.6, -71.37, height_msl_m}, height_msl_m}};
  const PathProfile with_void = profileOf(terrain, path, true), whole = profileOf(terrain.whole, path, true);
  EXPECT_EQ(with_void.ranges_m, whole.ranges_m);
  EXPECT_EQ(with_void.ground_msl_m, whole.ground_msl_m);
}

/// Height (m) above the end of a path at which its shadow ends, over posts at some ranges.
double shadowEdge_m(const PathProfile& path, const std::vector<double>& ranges_m,
                    const std::vector<double>& ground_msl_m) {
  const double curvature = 0.5 / path.effective_earth_radius_m, tx_m = path.begin.height_msl_m;
  double steepest = -HUGE_VAL;
  for (std::size_t i = 0; i < ranges_m.size(); ++i) {
    if (!(ranges_m[i] > 0 && ranges_m[i] < path.range_m)) continue;
    steepest = std::max(steepest, (ground_msl_m[i] - tx_m) / ranges_m[i] - curvature * ranges_m[i]);
  }
  return tx_m + steepest * path.range_m + curvature * path.range_m * path.range_m;
}

TEST(ProfileAtCrossings, IsNearerToAFinelySampledPath) {
  const MadeTerrain terrain(44.5, -71.5, 1.0);
  std::vector<double> errors_m[2];
  for (const RandomPath& path : randomPaths(terrain, 0.45, 60)) {
    const PathProfile posts[2] = {profileOf(terrain, path, false), profileOf(terrain, path, true)};
    std::vector<double> fine_m, fine_msl_m;
    for (double range_m = 0; range_m < posts[0].range_m; range_m += terrain.postSpacing_m() / 20) {
      const GeodeticPosition at = geodesicDirect(
          path.begin.position.latitude_deg, path.begin.position.longitude_deg, posts[0].azimuth_rad, range_m);
      fine_m.push_back(range_m);
      fine_msl_m.push_back(terrain.heightMsl_m(at.latitude_deg, at.longitude_deg));
    }
    const double truth_m = shadowEdge_m(posts[0], fine_m, fine_msl_m);
    for (const int n : {0, 1}) {
      const std::vector<double> ground_msl_m(posts[n].ground_msl_m.begin(), posts[n].ground_msl_m.end());
      errors_m[n].push_back(std::abs(shadowEdge_m(posts[n], posts[n].ranges_m, ground_msl_m) - truth_m));
    }
  }
  for (std::vector<double>& errors : errors_m) std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors_m[1][30], errors_m[0][30] / 3);  // median
  EXPECT_LT(errors_m[1][54], errors_m[0][54] / 3);  // 90 %
}

}  // namespace
}  // namespace emscape::emfield
