// Profiles with posts where a path crosses the lines between the posts of the elevation model.
#include "emfield/ground/chord_crossings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace emscape::emfield {
namespace {

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

}  // namespace
}  // namespace emscape::emfield
