#include "playback/frames/ground.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/log.h"
#include "emscape/emfield/solver/field_solver.h"
#include "playback/frames/ground_marks.h"
#include "playback/pictures/scenery.h"
#include "scenario/map/coast.h"
#include "tests/playback/playback_samples.h"
#include "tests/scenario/dem_file.h"

namespace emscape::playback::test {
namespace {

using render::GroundKind;
using ::testing::HasSubstr;

/// quick.yaml over a terrain of 0.5 x 0.5 degrees.
LoadedScenario overTerrain(const TemporaryFolder& folder,
                           const std::function<double(double latitude_deg, double longitude_deg)>& height) {
  emscape::test::geographicDem(4.75, 52.25, 0.002, 250, 250, height).write(folder / "dem.tif");
  return loadScenarioWithTerrain(
      quickScenario(folder, {{"platforms:", "terrain: {files: [dem.tif]}\nplatforms:"}}));
}

volume::Grid gridOf(const LoadedScenario& scene) {
  return emfield::gridOf(scene.scenario->region);
}

double waterPart(const render::HeightField& ground) {
  return static_cast<double>(std::count(ground.kinds.begin(), ground.kinds.end(), GroundKind::water)) /
         static_cast<double>(ground.kinds.size());
}

TEST(Drape, OfLandCoverNamesItsClassesTheMostFrequentFirst) {
  const TemporaryFolder folder;
  emscape::test::geographicDem(4.75, 52.25, 0.002, 250, 250, [](double, double longitude_deg) {
    return longitude_deg < 4.9 ? 80.0 : 10.0;  // water and trees of WorldCover
  }).write(folder / "codes.tif");
  emscape::test::wholeNumbers(folder / "codes.tif", folder / "cover.tif");
  emscape::test::geographicDem(4.75, 52.25, 0.002, 250, 250, [](double, double) {
    return 20.0;
  }).write(folder / "dem.tif");
  const LoadedScenario scene = loadScenarioWithTerrain(quickScenario(
      folder, {{"platforms:",
                "terrain: {files: [dem.tif], land_cover: {files: [cover.tif], classes: worldcover}}\n"
                "platforms:"}}));
  const volume::Grid grid = gridOf(scene);
  render::HeightField ground = *groundOf(scene, grid, nullptr, true).field;
  const std::vector<render::Category> classes = drape(ground, "land-cover", scene.terrain.get(), grid);
  ASSERT_FALSE(classes.empty());
  EXPECT_EQ(classes[0].name, "tree cover");
  ASSERT_TRUE(classes[0].color);
  EXPECT_FLOAT_EQ(classes[0].color->g, 100.0F / 255);
  ViewState view;
  view.drape = "land-cover";
  Scenery scenery;
  scenery.update(view, &scene, grid);
  render::Annotations annotations;
  scenery.annotate(annotations, view, {});
  EXPECT_EQ(annotations.ground_classes.size(), classes.size());
  view.drape.clear();
  scenery.update(view, &scene, grid);
  scenery.annotate(annotations, view, {});
  EXPECT_TRUE(annotations.ground_classes.empty());
}

TEST(GroundOf, TerrainIsSeaWhereItIsFlatAtSeaLevel) {
  const TemporaryFolder folder;
  // Sea in the west; land that rises to the east, with a flat pond at sea level that is too small, and a flat
  // plain at 3 m.
  const LoadedScenario scene = overTerrain(folder, [](double latitude_deg, double longitude_deg) {
    if (longitude_deg < 5) return 0.0;
    if (std::hypot(latitude_deg - 52, longitude_deg - 5.06) < 0.006) return 0.0;
    if (latitude_deg > 52.04) return 3.0;
    return 1 + 4000 * (longitude_deg - 5);
  });
  const Ground ground = groundOf(scene, gridOf(scene), nullptr, false);
  EXPECT_TRUE(ground.is_sea_by_heights);
  EXPECT_NEAR(waterPart(*ground.field), 0.5, 0.02);
  const int middle = ground.field->rows / 2 * ground.field->columns;
  EXPECT_EQ(ground.field->kinds[static_cast<std::size_t>(middle)], GroundKind::water);
  EXPECT_EQ(ground.field->kinds[static_cast<std::size_t>(middle + ground.field->columns - 1)],
            GroundKind::land);
}

TEST(GroundOf, LandBelowSeaLevelIsNoSea) {
  const TemporaryFolder folder;
  const LoadedScenario scene =
      overTerrain(folder, [](double latitude_deg, double) { return -4 + 10 * (latitude_deg - 52); });
  EXPECT_EQ(waterPart(*groundOf(scene, gridOf(scene), nullptr, false).field), 0);
}

TEST(GroundOf, FlatTerrainThatIsLandByTheCoastsIsNoSea) {
  const TemporaryFolder folder;
  const auto nowhere = scenario::Coast();  // all land
  const LoadedScenario polder = overTerrain(folder, [](double, double) { return 0.0; });
  EXPECT_EQ(waterPart(*groundOf(polder, gridOf(polder), nullptr, false).field), 1);
  EXPECT_EQ(waterPart(*groundOf(polder, gridOf(polder), &nowhere, false).field), 0);
}

TEST(GroundOf, TheSmoothEarthIsSeaOrLandAsTheScenarioSays) {
  const TemporaryFolder folder;
  LoadedScenario scene = loadScenarioWithTerrain(quickScenario(folder));
  const volume::Grid grid = gridOf(scene);
  EXPECT_TRUE(drawsSmoothEarth(scene, grid));
  const Ground land = groundOf(scene, grid, nullptr, false);
  EXPECT_EQ(waterPart(*land.field), 0);
  EXPECT_FALSE(land.is_sea_by_heights);
  for (const float height_m : land.field->heights_m) ASSERT_EQ(height_m, 0);
  scene = loadScenarioWithTerrain(quickScenario(folder, {{"platforms:", "ground: {kind: sea}\nplatforms:"}}));
  EXPECT_EQ(waterPart(*groundOf(scene, grid, nullptr, false).field), 1);
  volume::Grid high = grid;
  high.first_center_m.z += 20000;
  EXPECT_FALSE(drawsSmoothEarth(scene, high)) << "far below the volume";
}

TEST(Scenery, HasItsLinesAgainWhenTheGroundIsShownAgain) {
  const TemporaryFolder folder;
  const LoadedScenario scene = loadScenarioWithTerrain(quickScenario(folder));
  const volume::Grid grid = gridOf(scene);
  Scenery scenery;
  ViewState view;
  const auto lines = [&](bool shows_ground) {
    view.show_terrain = shows_ground;
    scenery.update(view, &scene, grid);
    render::Annotations annotations;
    scenery.annotate(annotations, view, {});
    return annotations.ground_lines.size();
  };
  const std::size_t graticule = lines(true);
  EXPECT_GT(graticule, 0);
  EXPECT_EQ(lines(false), 0);
  EXPECT_EQ(lines(true), graticule);
}

TEST(GroundMarks, LieOnTheGroundWithinTheBox) {
  const TemporaryFolder folder;
  const LoadedScenario scene =
      overTerrain(folder, [](double latitude_deg, double) { return 500 + 3000 * (latitude_deg - 52); });
  const volume::Grid grid = gridOf(scene);
  const Ground ground = groundOf(scene, grid, nullptr, false);
  GroundMarks marks(markedPlane(grid, ground.field.get(), &scene));
  marks.addGraticule(PositionFormat::decimal);
  const std::size_t graticule = marks.lines.size();
  EXPECT_GE(graticule, 6U);
  EXPECT_LE(graticule, 24U);
  render::Marker marker;
  marker.label = "radar: 1";
  marker.position_m = {2000, 1000, 700};
  marks.addRings({{"radar: 1", 3000, 2}, {"other", 1000, 1}}, ringCenters({marker}, grid.frame),
                 Units::metric);
  ASSERT_EQ(marks.lines.size(), graticule + 2);
  EXPECT_EQ(marks.lines[graticule].label, "3 km");
  const Vec3d lower = grid.lower_m(), upper = grid.upper_m();
  for (const render::GroundLine& line : marks.lines) {
    for (const Vec3d& point : line.points_m) {
      EXPECT_TRUE(point.x >= lower.x - 1e-6 && point.x <= upper.x + 1e-6 && point.y >= lower.y - 1e-6 &&
                  point.y <= upper.y + 1e-6);
      EXPECT_NEAR(point.z, heightAt_m(*ground.field, point.x, point.y), 1e-6);
    }
  }
  for (const Vec3d& point : marks.lines[graticule + 1].points_m)
    EXPECT_NEAR(std::hypot(point.x - 2000, point.y - 1000), 6000, 10);
}

TEST(GroundMarks, PlacesAreCutAtTheSidesOfTheBox) {
  const TemporaryFolder folder;
  const LoadedScenario scene = loadScenarioWithTerrain(quickScenario(folder));
  const volume::Grid grid = gridOf(scene);
  GroundMarks marks(markedPlane(grid, nullptr, &scene));
  using Place = scenario::Place;
  marks.addPlaces({{Place::Kind::point, "inside", {{{52, 5, 0}}}},
                   {Place::Kind::point, "outside", {{{53, 5, 0}}}},
                   {Place::Kind::line, "through", {{{52, 4, 0}, {52, 6, 0}}}},
                   {Place::Kind::area, "everywhere", {{{51, 4, 0}, {51, 6, 0}, {53, 6, 0}, {53, 4, 0}}}}});
  ASSERT_EQ(marks.points.size(), 1U);
  EXPECT_EQ(marks.points[0].label, "inside");
  ASSERT_EQ(marks.lines.size(), 2U);
  EXPECT_NEAR(marks.lines[0].points_m.front().x, -10000, 1e-6);
  EXPECT_NEAR(marks.lines[0].points_m.back().x, 10000, 1e-6);
  EXPECT_TRUE(marks.lines[1].is_area);
}

TEST(GroundMarks, PlacesOutsideAreToldWithTheNearestThree) {
  const TemporaryFolder folder;
  const LoadedScenario scene = loadScenarioWithTerrain(quickScenario(folder));
  const MarkedPlane plane = markedPlane(gridOf(scene), nullptr, &scene);
  using Place = scenario::Place;
  const auto point = [](const std::string& name, double latitude_deg, double longitude_deg = 5) {
    return Place{Place::Kind::point, name, {{{latitude_deg, longitude_deg, 0}}}};
  };
  const Place inside = point("inside", 52), outside = point("o", 53), exchanged = point("exchanged", 5, 52),
              through{Place::Kind::line, "through", {{{52, 4, 0}, {52, 6, 0}}}};
  const auto toldOf = [&](const std::vector<Place>& places) {
    std::string told;
    setLogSink([&](LogLevel level, const std::string& message) {
      told += (level == LogLevel::warning ? "warning: " : "") + message;
    });
    tellPlacesOutside("p.csv", places, plane, &scene.scenario->region);
    setLogSink({});
    return told;
  };
  EXPECT_EQ(toldOf({inside, through}), "");
  EXPECT_EQ(toldOf({outside}), "warning: p.csv: none of its places is in the area, so that none is drawn");
  EXPECT_THAT(toldOf({exchanged}), HasSubstr("perhaps "));
  EXPECT_EQ(toldOf({inside, point("near", 52.0991)}),
            "p.csv: 1 of 2 places is outside of the area, and not drawn: 'near', 1.03 km away");
  EXPECT_EQ(toldOf({outside, point("b", 52.21), inside, point("", 52.15), point("c", 52.3)}),
            "p.csv: 4 of 5 places are outside of the area, and not drawn: one without a name, 6.69 km away; "
            "'b', 13.4 km away; 'c', 23.4 km away; ...");
}

}  // namespace
}  // namespace emscape::playback::test
