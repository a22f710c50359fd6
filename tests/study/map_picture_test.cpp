// The picture of a map: what holds whatever its values are.
#include "emscape/study/map_picture.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "emscape/study/map_grid.h"
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

/// 20 x 10 pixels, none left out.
MapGrid smallGrid() {
  MapGrid grid;
  grid.width = 20;
  grid.height = 10;
  grid.cell_m = 1000;
  grid.places.resize(200, {5.0, 10.0});
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
