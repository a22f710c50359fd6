#include "study/maps/contour_lines.h"

#include <gtest/gtest.h>

#include <cmath>

namespace emscape::study {
namespace {

std::vector<float> sampled(int width, int height, double (*function)(double x, double y)) {
  std::vector<float> values;
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) values.push_back(static_cast<float>(function(i, j)));
  }
  return values;
}

TEST(ContourLines, OfAConeAreCircles) {
  const auto cone = [](double x, double y) { return std::hypot(x - 20.3, y - 15.6); };
  const std::vector<GridLine> lines = contourLines(sampled(41, 31, cone), 41, 31, 12);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].front().x, lines[0].back().x) << "closed";
  EXPECT_EQ(lines[0].front().y, lines[0].back().y);
  double length = 0;
  for (std::size_t n = 0; n + 1 < lines[0].size(); ++n) {
    EXPECT_NEAR(cone(lines[0][n].x, lines[0][n].y), 12, 0.02);
    length += std::hypot(lines[0][n + 1].x - lines[0][n].x, lines[0][n + 1].y - lines[0][n].y);
  }
  EXPECT_NEAR(length, 2 * M_PI * 12, 0.1);
}

TEST(ContourLines, EndAtTheEdgeAndWhereValuesAreMissing) {
  std::vector<float> values = sampled(10, 8, [](double x, double y) { return y + 0 * x; });
  ASSERT_EQ(contourLines(values, 10, 8, 3.25f).size(), 1u);
  EXPECT_EQ(contourLines(values, 10, 8, 3.25f)[0].size(), 10u);
  values[3 * 10 + 5] = NAN;
  const std::vector<GridLine> lines = contourLines(values, 10, 8, 3.25f);
  ASSERT_EQ(lines.size(), 2u);
  for (const GridLine& line : lines) {
    for (const GridPoint& point : line) {
      EXPECT_EQ(point.y, 3.25);
      EXPECT_TRUE(point.x <= 4 || point.x >= 6);
    }
  }
}

TEST(ContourLines, PartASaddleByItsMean) {
  // The corners that are high are joined where the middle is high.
  for (const float other : {0.2f, 0.9f}) {
    const std::vector<GridLine> lines = contourLines({1, 0, other, 1}, 2, 2, 0.5f);
    EXPECT_EQ(lines.size(), other > 0.5f ? 1u : 2u);
  }
  EXPECT_TRUE(contourLines({0, 0, 0, 0}, 2, 2, 0.5f).empty());
}

TEST(ContourLines, BesideValuesAtTheFloorRunMidwayBetweenThePosts) {
  const std::vector<float> values{-120, 20, -120, 20};
  EXPECT_NEAR(contourLines(values, 2, 2, 10).front().front().x, 130.0 / 140, 1e-6);
  const std::vector<GridLine> lines = contourLines(values, 2, 2, 10, -120);
  for (const GridPoint& point : lines.front()) EXPECT_EQ(point.x, 0.5);
}

}  // namespace
}  // namespace emscape::study
