// Properties of a map's picture that do not depend on its values.
#include "study/files/map_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "emscape/study/maps/area.h"
#include "emscape/study/maps/map_grid.h"
#include "study/files/map_colors.h"

namespace emscape::study {
namespace {

/// Whether all pixels of a rectangle have one colour.
bool isPlain(const render::Image8& image, int left, int top, int right, int bottom) {
  const std::uint8_t* const first = image.at(left, top);
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      if (!std::equal(first, first + 4, image.at(x, y))) return false;
    }
  }
  return true;
}

/// 20 x 10 pixels, all in the area.
MapGrid smallGrid() {
  MapGrid grid;
  grid.width = 20;
  grid.height = 10;
  grid.cell_m = 1000;
  grid.positions.resize(200, {5.0, 10.0});
  return grid;
}

Map jamLoss(const MapGrid& grid) {
  Map map;
  map.name = map.title = "jam_loss";
  map.kind = MapKind::classes;
  map.labels = {"no", "yes"};
  map.values.assign(grid.pixels(), 0.0f);
  return map;
}

TEST(MapPicture, ALongTitleFits) {
  const MapGrid grid = smallGrid();
  MapPictureOptions options;
  options.title = std::string(120, 'W') + " at 1500 m above mean sea level";
  const render::Image8 image = drawMap(grid, jamLoss(grid), options);
  EXPECT_TRUE(isPlain(image, image.size.width - 8, 0, image.size.width, 80))
      << "the title ends before the edge";
  EXPECT_FALSE(isPlain(image, image.size.width - 60, 0, image.size.width, 80)) << "it takes the whole width";
}

TEST(MapPicture, ClassesThatDoNotOccurAreInTheLegend) {
  const MapGrid grid = smallGrid();
  const render::Legend legend = legendOf(jamLoss(grid));
  ASSERT_EQ(legend.categories.size(), 1u);
  EXPECT_EQ(legend.categories[0].name, "yes");
  EXPECT_EQ(legend.note, "no colour: no jam_loss");
}

TEST(MapPicture, TheLegendOfManyEmittersHoldsAllThatAreOnTheMap) {
  const MapGrid grid = smallGrid();
  Map map;
  map.name = map.title = "best";
  map.kind = MapKind::category;
  for (int n = 0; n < 40; ++n) map.labels.push_back("radar " + std::to_string(n));
  map.values.assign(grid.pixels(), -1.0f);
  map.values[0] = 2;
  EXPECT_EQ(legendOf(map).categories.size(), 1u);
  EXPECT_EQ(legendOf(map).note, "no colour: none");
  Map few = map;
  few.labels.resize(4);
  EXPECT_EQ(legendOf(few).categories.size(), 3u) << "of few also those that win nowhere, up to the last";
  map.values[1] = 35;
  render::Legend legend = legendOf(map);
  ASSERT_EQ(legend.categories.size(), 2u);
  EXPECT_EQ(legend.categories[1].name, "radar 35");
  for (std::size_t p = 0; p < grid.pixels(); ++p) map.values[p] = static_cast<float>(p % 40);
  legend = legendOf(map);
  ASSERT_EQ(legend.categories.size(), 40u);
  EXPECT_EQ(legend.note, "") << "all pixels have an emitter";
  const render::Image8 image = drawMap(grid, map, {});
  const int right = image.size.width - 8, bottom = image.size.height;
  EXPECT_TRUE(isPlain(image, right - 150, bottom - 10, right, bottom));
  EXPECT_FALSE(isPlain(image, right - 150, bottom - 60, right, bottom)) << "the last entry";
}

/// A map of counts that rise from left to right, without a value in the last pixel.
Map counts(const MapGrid& grid, float factor) {
  Map map;
  map.name = "count";
  map.title = "number of emitters";
  map.kind = MapKind::count;
  for (std::size_t p = 0; p < grid.pixels(); ++p)
    map.values.push_back(factor * std::floor(static_cast<float>(p % grid.width) / 5));
  map.values.back() = NAN;
  return map;
}

TEST(MapPicture, CountOfZeroHasAColor) {
  const MapGrid grid = smallGrid();
  const Map map = counts(grid, 1);
  const render::Legend legend = legendOf(map);
  EXPECT_EQ(legend.quantity, "Number of emitters");
  ASSERT_EQ(legend.categories.size(), 4u);
  EXPECT_EQ(legend.categories[0].name, "0");
  EXPECT_EQ(legend.categories[3].name, "3");
  for (int n = 0; n < 4; ++n) {
    const auto color = colorOf(map, legend, static_cast<float>(n));
    ASSERT_TRUE(color && legend.categories[static_cast<std::size_t>(n)].color);
    EXPECT_EQ(color->g, legend.categories[static_cast<std::size_t>(n)].color->g) << n;
  }
  EXPECT_FALSE(colorOf(map, legend, NAN));
  const render::Image8 image = drawMap(grid, map, {});
  const auto first = image.at(90, image.size.height / 2);
  EXPECT_GT(std::abs(first[1] - first[2]), 20) << "the ground is grey";
}

TEST(MapPicture, ManyCountsHaveABarWithWholeNumbers) {
  const MapGrid grid = smallGrid();
  const Map map = counts(grid, 50);
  const render::Legend legend = legendOf(map);
  EXPECT_TRUE(legend.categories.empty());
  EXPECT_FALSE(legend.function.categorical);
  EXPECT_TRUE(legend.whole_numbers);
  EXPECT_EQ(legend.function.lowest(), 0);
  EXPECT_EQ(legend.function.highest(), 150);
  EXPECT_TRUE(colorOf(map, legend, 0));
}

TEST(MapPicture, LabelsStayOnTheMap) {
  MapGrid grid = makeMapGrid(circularArea({10, 20, 5000}), 500, "local");
  Map map = jamLoss(grid);
  MapPictureOptions options;
  const render::Image8 without = drawMap(grid, map, options);
  options.markers = {{10, 20.04, "a radar at the eastern edge of the map", render::MarkerKind::radar}};
  const render::Image8 with = drawMap(grid, map, options);
  ASSERT_EQ(with.size, without.size);
  const int edge = 84 + static_cast<int>((1200 - 84 - 190)) + 12;  // the frame of the map
  for (int y = 0; y < with.size.height; ++y) {
    for (int x = edge; x < with.size.width; ++x)
      ASSERT_TRUE(std::equal(with.at(x, y), with.at(x, y) + 4, without.at(x, y))) << x << ", " << y;
  }
}

TEST(MapPicture, ASlopeIsShadedUpToTheEdges) {
  const MapGrid grid = smallGrid();
  MapPictureOptions options;
  for (std::size_t p = 0; p < grid.pixels(); ++p) {
    options.ground_msl_m.push_back(400.0f * static_cast<float>(p % grid.width));
  }
  const render::Image8 image = drawMap(grid, jamLoss(grid), options);
  const int y = image.size.height / 2, middle = image.size.width / 2;
  const int left = 90 * options.width / 1200;  // in the first column of pixels, right of the frame
  EXPECT_TRUE(std::equal(image.at(left, y), image.at(left, y) + 4, image.at(middle, y)));
}

}  // namespace
}  // namespace emscape::study
