// Properties of a map's picture that do not depend on its values.
#include "study/picture/map_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "emscape/study/maps/area.h"
#include "emscape/study/maps/map_grid.h"
#include "render/transfer/oklab.h"
#include "study/picture/map_colors.h"
#include "study/picture/map_frame.h"
#include "study/picture/map_marks.h"
#include "study/picture/map_relief.h"
#include "tests/support/errors.h"
#include "tests/support/temporary_folder.h"

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

double distance(const render::Oklab& a, const render::Oklab& b) {
  return std::hypot(a.lightness - b.lightness, a.a - b.a, a.b - b.b);
}

TEST(MapPicture, ReliefChangesOnlyTheLightnessOfColors) {
  std::vector<render::Rgb> colors;
  for (int n = 0; n < 21; ++n) colors.push_back(render::categoryColor(n));
  for (const char* name : {"viridis", "diverging"})
    for (double at = 0; at <= 1; at += 0.05) colors.push_back(render::colorMap(name).at(at));
  for (const render::Rgb& color : colors) {
    const render::Oklab legend = render::oklabOf(color);
    for (float shade = -1.7F; shade <= 0.3F; shade += 0.05F) {
      const render::Oklab shown = render::oklabOf(shadedColor(color, shade));
      EXPECT_LE(std::abs(shown.lightness - legend.lightness), kMaxRelief + 1e-3);
      EXPECT_LE(std::hypot(shown.a - legend.a, shown.b - legend.b), 3e-3) << "hue and chroma";
    }
    const render::Rgb level = shadedColor(color, 0);
    EXPECT_TRUE(level.r == color.r && level.g == color.g && level.b == color.b) << "level ground";
  }
}

/// Steep waves, with slopes in all directions.
std::vector<float> hills(const MapGrid& grid) {
  std::vector<float> ground_m;
  for (int p = 0; p < static_cast<int>(grid.pixels()); ++p) {
    const double i = p % grid.width, j = p / grid.width;
    ground_m.push_back(static_cast<float>(grid.cell_m * (std::sin(i) + std::cos(1.3 * j))));
  }
  return ground_m;
}

TEST(MapPicture, EachClassIsNearestToItsOwnColorInTheLegend) {
  const MapGrid grid = makeMapGrid(circularArea({10, 20, 8000}), 400, "local");
  Map map;
  map.name = map.title = "best";
  map.kind = MapKind::category;
  constexpr int kClasses = 7;
  for (int n = 0; n < kClasses; ++n) map.labels.push_back("radar " + std::to_string(n));
  for (std::size_t p = 0; p < grid.pixels(); ++p) map.values.push_back(static_cast<float>(p % kClasses));
  MapPictureOptions options;
  options.ground_msl_m = hills(grid);
  const render::Image8 image = drawMap(grid, map, options);
  const render::Style style({options.width, options.width * 3 / 4}, render::Theme::light);
  const double left = 84 * style.unit, top = 96 * style.unit;
  const double scale = (options.width - left - 190 * style.unit) / grid.width;
  int right = 0, all = 0;
  for (std::size_t p = 0; p < grid.pixels(); ++p) {
    if (std::isnan(grid.positions[p].latitude_deg)) continue;
    const std::uint8_t* const rgba =
        image.at(static_cast<int>(left + (static_cast<double>(p % grid.width) + 0.5) * scale),
                 static_cast<int>(top + (static_cast<double>(p / grid.width) + 0.5) * scale));
    const render::Oklab shown =
        render::oklabOf({static_cast<float>(rgba[0]) / 255, static_cast<float>(rgba[1]) / 255,
                         static_cast<float>(rgba[2]) / 255});
    int nearest = 0;
    for (int n = 1; n < kClasses; ++n) {
      if (distance(shown, render::oklabOf(render::categoryColor(n))) <
          distance(shown, render::oklabOf(render::categoryColor(nearest))))
        nearest = n;
    }
    ++all;
    right += nearest == static_cast<int>(p % kClasses) ? 1 : 0;
  }
  EXPECT_GT(right, 0.97 * all) << "the others are below the lines of the graticule";
}

TEST(MapPicture, TheAreaEndsAtItsBorderNotAtPixels) {
  const MapGrid grid = makeMapGrid(parseArea("bbox:-84.4,36,-84,36.3"), 1000, "utm");
  Map map = jamLoss(grid);
  std::fill(map.values.begin(), map.values.end(), 1.0F);
  const render::Image8 image = drawMap(grid, map, {});
  const render::Style style({1200, 900}, render::Theme::light);
  const double width = 1200 - (84 + 190) * style.unit;
  const MapFrame frame(grid, {84 * style.unit, 96 * style.unit, width, width * grid.height / grid.width},
                       style);
  const auto isWhite = [&](const render::Point2& at) {
    const std::uint8_t* const rgba = image.at(static_cast<int>(at.x), static_cast<int>(at.y));
    return rgba[0] == 255 && rgba[1] == 255 && rgba[2] == 255;
  };
  for (double latitude_deg = 36.02; latitude_deg < 36.28; latitude_deg += 0.005) {
    for (const auto& [longitude_deg, out] : {std::pair{-84.4, -1.0}, std::pair{-84.0, 1.0}}) {
      const render::Point2 at = frame.at({GeoPoint{latitude_deg, longitude_deg}}).front();
      EXPECT_FALSE(isWhite({at.x - 3 * out, at.y})) << latitude_deg << " " << longitude_deg;
      const double outside = at.x + 3 * out;
      if (outside < frame.rect().x || outside > frame.rect().x + frame.rect().width) continue;
      EXPECT_TRUE(isWhite({outside, at.y})) << latitude_deg << " " << longitude_deg;
    }
  }
}

TEST(MapPicture, WithoutGroundTheSeaIsThatOfTheCoastLines) {
  const MapGrid grid = makeMapGrid(parseArea("bbox:6.3,0,6.9,0.5"), 2000, "utm");  // the island of Sao Tome
  MapPictureOptions options;
  addCoast(grid, grid, options);
  if (options.water.empty()) GTEST_SKIP() << "no coast lines are installed";
  const auto waterAt = [&](double latitude_deg, double longitude_deg) {
    return options.water[static_cast<std::size_t>(grid.pixelAt(latitude_deg, longitude_deg))] != 0;
  };
  EXPECT_FALSE(waterAt(0.25, 6.6)) << "the middle of the island";
  EXPECT_TRUE(waterAt(0.45, 6.4)) << "the sea to the north-west";
  EXPECT_FALSE(options.shores.empty());
  const render::Image8 image = drawMap(grid, jamLoss(grid), options);
  const std::uint8_t* const sea = image.at(110, 130);
  EXPECT_GT(sea[2], sea[0] + 15) << "blue";
}

TEST(MapPicture, DegreesGoOnAcrossTheAntimeridian) {
  std::vector<std::string> texts;
  for (const DegreeTick& tick : degreeTicks(179.3, 180.8, 3, true)) texts.push_back(tick.text);
  EXPECT_EQ(texts, (std::vector<std::string>{"179.5°E", "180.0°", "179.5°W"}));
  texts.clear();
  for (const DegreeTick& tick : degreeTicks(-1, 1, 2, false)) texts.push_back(tick.text);
  EXPECT_EQ(texts, (std::vector<std::string>{"1°S", "0°", "1°N"}));
}

TEST(MapPicture, LabelsStayOnTheMap) {
  MapGrid grid = makeMapGrid(circularArea({10, 20, 5000}), 500, "local");
  Map map = jamLoss(grid);
  MapPictureOptions options;
  const render::Image8 without = drawMap(grid, map, options);
  options.markers = {{10, 20.04, "a radar at the eastern edge of the map", render::MarkerKind::radar,
                      render::Affiliation::none, ""}};
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

/// Number of pixels near a colour in a rectangle of the picture's map.
int countNear(const render::Image8& image, const render::Rgb& color) {
  int count = 0;
  for (int y = 0; y < image.size.height; ++y) {
    for (int x = 0; x < image.size.width; ++x) {
      const std::uint8_t* const at = image.at(x, y);
      const float off = std::abs(static_cast<float>(at[0]) - 255 * color.r) +
                        std::abs(static_cast<float>(at[1]) - 255 * color.g) +
                        std::abs(static_cast<float>(at[2]) - 255 * color.b);
      count += off < 6 ? 1 : 0;
    }
  }
  return count;
}

TEST(MapPicture, UnknownPixelsAreHatchedAndInTheLegend) {
  const MapGrid grid = smallGrid();
  Map map = jamLoss(grid);
  const int nothing_px = countNear(drawMap(grid, map, {}), groundColor(0, false));
  map.answers.assign(grid.pixels(), PixelAnswer::exact);
  EXPECT_EQ(legendOf(map).hatched, "");
  for (std::size_t p = 0; p < grid.pixels() / 2; ++p) {
    map.answers[p] = PixelAnswer::unknown;
    map.values[p] = NAN;
  }
  EXPECT_EQ(legendOf(map).hatched, "unknown");
  const int left_px = countNear(drawMap(grid, map, {}), groundColor(0, false));
  EXPECT_LT(left_px, 0.95 * nothing_px) << "lines";
  EXPECT_GT(left_px, 0.8 * nothing_px) << "and the ground between them";
  map.answers.assign(grid.pixels(), PixelAnswer::none);
  EXPECT_EQ(legendOf(map).hatched, "") << "below the ground";
}

TEST(MapPicture, LengthsAndFieldsAreShownInTheChosenUnits) {
  Map map;
  map.kind = MapKind::level;
  map.unit = "m";
  map.values = {0, 304.8F};
  map.name = map.title = "min_height";
  render::Legend legend = legendOf(map, Units::nautical);
  EXPECT_EQ(legend.unit, "ft");
  EXPECT_NEAR(legend.scale.shown(304.8), 1000, 1e-9);
  map.name = "max_range";
  legend = legendOf(map, Units::nautical);
  EXPECT_EQ(legend.unit, "NM");
  EXPECT_NEAR(legend.scale.stored(legend.scale.shown(1852)), 1852, 1e-9);
  EXPECT_EQ(legendOf(map).unit, "m");
  map.title = "power density";
  map.unit = "dBW/m2";
  legend = legendOf(map, Units::metric, FieldUnit::v_per_m);
  EXPECT_EQ(legend.unit, "V/m");
  EXPECT_EQ(legend.quantity, "Field strength");
  map.height = MapHeight{emfield::HeightReference::ground, 150};
  map.subject = "coverage (SNR >= 10 dB)";
  map.description = "coverage (SNR >= 10 dB) at 150 m above ground";
  EXPECT_EQ(descriptionOf(map, Units::nautical), "coverage (SNR >= 10 dB) at 492 ft above ground");
  EXPECT_EQ(descriptionOf(map, Units::metric), map.description);
}

TEST(MapPicture, APictureOnTheGroundShowsWhereTheMapHasNoColor) {
  const MapGrid grid = smallGrid();
  Map map = jamLoss(grid);
  map.values[5] = 1;
  MapPictureOptions options;
  options.drape.assign(grid.pixels(), 0xff00ff00U);
  const render::Image8 image = drawMap(grid, map, options);
  EXPECT_GT(countNear(image, {0, 1, 0}), 1000);
  options.drape.assign(grid.pixels(), 0x0000ff00U);
  EXPECT_EQ(countNear(drawMap(grid, map, options), {0, 1, 0}), 0) << "outside of the picture";
}

TEST(MapPicture, PlacesAndRingsAreWhereTheyAreOnTheEarth) {
  const test::TemporaryFolder folder;
  const std::string places = folder.write("places.geojson",
                                          R"({"type": "FeatureCollection", "features": [
         {"type": "Feature", "properties": {"name": "Town"}, "geometry": {"type": "Point", "coordinates": [20.02, 10.01]}},
         {"type": "Feature", "properties": {"name": "Far"}, "geometry": {"type": "Point", "coordinates": [22, 10]}}]})");
  const MapGrid grid = makeMapGrid(circularArea({10, 20, 8000}), 500, "local");
  auto scenario = std::make_shared<scenario::Scenario>();
  scenario->emitters.emplace_back().name = "radar";
  MapStudy study;
  study.scenarios = {scenario};
  study.grid = std::make_shared<const MapGrid>(grid);
  study.view.places = {places};
  study.view.range_rings = {playback::parseRangeRings("radar:spacing_m=3000,count=2")};
  scenario::Snapshot snapshot;
  snapshot.scenario = scenario;
  snapshot.emitters.resize(1);
  snapshot.emitters[0].position = {10, 20, 0};
  MapPictureOptions options;
  MapMarks(study).addTo(options, snapshot);
  ASSERT_EQ(options.points.size(), 1U);
  const double east_m = geodesicInverse(10, 20, 10, 20.02).distance_m;
  EXPECT_NEAR(options.points[0].position_m.x, east_m, 1);
  ASSERT_EQ(options.lines.size(), 2U);
  EXPECT_EQ(options.lines[1].label, "6 km");
  for (const Vec3d& point : options.lines[1].points_m) EXPECT_NEAR(std::hypot(point.x, point.y), 6000, 12);
  study.view.range_rings = {playback::parseRangeRings("raddar:spacing_m=3000")};
  EXPECT_THAT(test::errorOf([&] { MapMarks marks(study); }, ErrorCode::usage),
              ::testing::HasSubstr("there is no emitter 'raddar'; the scenario has 'radar'"));
}

TEST(MapPicture, LakesThatCannotBeSeenAreLand) {
  const std::vector<std::uint8_t> map{0, 0, 0, 0, 0, 0, 0, 1,  //
                                      0, 1, 1, 0, 0, 0, 0, 0,  //
                                      0, 0, 1, 0, 1, 1, 1, 0,  //
                                      0, 0, 0, 0, 0, 0, 0, 0};
  std::vector<std::uint8_t> water = map;
  dropSmallWater(water, 8, 4, 3);
  std::vector<std::uint8_t> expected = map;
  expected[9] = expected[10] = expected[18] = 0;
  EXPECT_EQ(water, expected) << "but one at the edge, and one that is wide enough, stay";
}

}  // namespace
}  // namespace emscape::study
