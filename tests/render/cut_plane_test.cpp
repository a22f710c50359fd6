#include "emscape/render/scene/cut_plane.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "emscape/render/scene/renderer.h"
#include "render/scene/plane_frame.h"
#include "tests/render/random_scene.h"
#include "tests/support/errors.h"
#include "tests/support/on_backends.h"

namespace emscape::render {
namespace {

using testing::fog;
using testing::makeVolume;

constexpr ImageSize kOnePixel{1, 1};
const char* const kFromEast = "orbit:azimuth_deg=90,elevation_deg=0,distance=3,fov_deg=1";
const char* const kFromAbove = "orbit:azimuth_deg=0,elevation_deg=90,distance=3,fov_deg=1";
constexpr CompositingMode kModes[] = {CompositingMode::dvr, CompositingMode::mida, CompositingMode::mip,
                                      CompositingMode::iso};

std::string errorOf(const std::string& text) {
  return test::errorOf([&] { parseCutPlane(text); });
}

void show(Renderer& renderer, const std::shared_ptr<volume::DenseVolume>& volume,
          const TransferFunction& function) {
  renderer.setVolume(std::shared_ptr<const volume::DenseVolume>(volume));
  renderer.setTransferFunction(function);
}

/// Colour of a one-pixel picture by a camera that looks along an axis through the middle of a volume.
Rgba look(Renderer& renderer, const std::string& camera, const std::vector<std::string>& planes,
          CompositingMode mode = CompositingMode::dvr, double exaggeration = 1) {
  RenderSettings settings;
  settings.exact = true;
  settings.vertical_exaggeration = exaggeration;
  settings.mode = mode;
  for (const std::string& plane : planes) settings.planes.push_back(parseCutPlane(plane));
  renderer.setSettings(settings);
  renderer.setCamera(makeCamera(parseCamera(camera), renderer.sceneBox(), kOnePixel));
  return renderer.render(kOnePixel).at(0, 0);
}

void expectColor(const Rgba& pixel, const Rgb& color, const std::string& what) {
  EXPECT_NEAR(pixel.r, color.r, 2e-3) << what;
  EXPECT_NEAR(pixel.g, color.g, 2e-3) << what;
  EXPECT_NEAR(pixel.b, color.b, 2e-3) << what;
  EXPECT_EQ(pixel.a, 1.0F) << what;
}

TEST(CutPlane, TextIsReadBackToTheSamePlane) {
  for (const char* text :
       {"horizontal:altitude_m=1500", "horizontal:altitude_m=-20.5,keep=above,on=false", "vertical",
        "vertical:bearing_deg=33,offset_m=-4000,keep=right", "vertical:x_m=10,y_m=20.25,bearing_deg=-90",
        "vertical:bearing_deg=45,ground=keep"}) {
    const CutPlane plane = parseCutPlane(text);
    EXPECT_EQ(parseCutPlane(toString(plane)), plane) << text;
  }
}

TEST(CutPlane, TwoPointsGiveALineAndItsBearing) {
  const CutPlane plane = parseCutPlane("vertical:x1_m=100,y1_m=200,x2_m=300,y2_m=200");
  EXPECT_EQ(plane.x_m, 100);
  EXPECT_EQ(plane.y_m, 200);
  EXPECT_NEAR(plane.bearing_deg, 90, 1e-12);
}

TEST(CutPlane, ErrorsNameKeyValueAndAllowedOnes) {
  EXPECT_EQ(errorOf("slanted:altitude_m=1"),
            "plane 'slanted:altitude_m=1': expected horizontal:altitude_m=.. or vertical:KEY=VALUE,...");
  EXPECT_EQ(errorOf("horizontal"), "plane 'horizontal': altitude_m is needed");
  EXPECT_EQ(errorOf("horizontal:altitude_m=high"),
            "plane 'horizontal:altitude_m=high': altitude_m 'high': expected a number -1000000..1000000");
  EXPECT_EQ(errorOf("horizontal:altitude_m=1,keep=left"),
            "plane 'horizontal:altitude_m=1,keep=left': keep 'left': expected below or above");
  EXPECT_EQ(errorOf("horizontal:height_m=1"),
            "plane 'horizontal:height_m=1': unknown key 'height_m': expected keep, on, altitude_m");
  EXPECT_EQ(errorOf("vertical:ground=whole"),
            "plane 'vertical:ground=whole': ground 'whole': expected cut or keep");
  EXPECT_EQ(errorOf("horizontal:altitude_m=1,ground=cut"),
            "plane 'horizontal:altitude_m=1,ground=cut': ground: a horizontal plane leaves it whole");
  EXPECT_EQ(errorOf("vertical:bearing_deg=400"),
            "plane 'vertical:bearing_deg=400': bearing_deg '400': expected a number -360..360");
  EXPECT_EQ(errorOf("vertical:x_m=1"), "plane 'vertical:x_m=1': x_m and y_m are needed together");
  EXPECT_EQ(errorOf("vertical:x1_m=1,y1_m=2"),
            "plane 'vertical:x1_m=1,y1_m=2': x1_m, y1_m, x2_m and y2_m are needed together");
}

TEST(CutPlane, FrameIsTheSectionOfTheBox) {
  const SceneBox box{{-1000, -2000, 0}, {1000, 2000, 500}, 3};
  const auto horizontal = frameOf(parseCutPlane("horizontal:altitude_m=200"), box);
  ASSERT_TRUE(horizontal);
  for (const Vec3d& corner : horizontal->corners_m) {
    EXPECT_EQ(std::abs(corner.x), 1000);
    EXPECT_EQ(std::abs(corner.y), 2000);
    EXPECT_EQ(corner.z, 200);
  }
  EXPECT_FALSE(frameOf(parseCutPlane("horizontal:altitude_m=501"), box));
  const CutPlane to_north = parseCutPlane("vertical:bearing_deg=0,offset_m=300");
  const auto vertical = frameOf(to_north, box);
  ASSERT_TRUE(vertical);
  EXPECT_NEAR(vertical->center_m().x, 300, 1e-9) << "right of north is east";
  EXPECT_NEAR(vertical->center_m().z, 250, 1e-9);
  EXPECT_NEAR(vertical->normal.x, 1, 1e-12);
  EXPECT_NEAR(length(vertical->corners_m[1] - vertical->corners_m[0]), 4000, 1e-6);
  EXPECT_FALSE(frameOf(parseCutPlane("vertical:bearing_deg=0,offset_m=1001"), box));
  EXPECT_EQ(captionOf(to_north), "bearing 0°, offset 300 m");
  const CutPlane level = parseCutPlane("horizontal:altitude_m=200");
  EXPECT_EQ(captionOf(level), "altitude 200 m");
  EXPECT_EQ(captionOf(level, Units::nautical), "altitude 656 ft");
  EXPECT_EQ(captionOf(level, Units::metric, /*is_on_earth=*/false), "z = 200");
}

TEST(CutPlane, MoreThanThreeAreRefused) {
  Renderer renderer;
  RenderSettings settings;
  settings.planes.resize(4);
  EXPECT_EQ(test::errorOf([&] { renderer.setSettings(settings); }), "4 cutting planes: expected at most 3");
}

TEST(Cut, HalfOfAHomogeneousBoxHasTheOpacityOfHalfItsLength) {
  const auto volume = makeVolume({20, 10, 8}, {3, 5, 2}, [](int, int, int) { return 1.0F; });
  volume->info.floor = 1;  // no field: the sections are transparent
  Renderer renderer;
  show(renderer, volume, fog(0.03));
  for (const char* keep : {"left", "right"}) {
    const std::string plane = std::string("vertical:bearing_deg=0,keep=") + keep;
    EXPECT_NEAR(look(renderer, kFromEast, {plane}).a, 1 - std::pow(0.97, 10), 1e-5) << keep;
  }
  EXPECT_NEAR(look(renderer, kFromEast, {"vertical:bearing_deg=0,offset_m=15"}).a, 1 - std::pow(0.97, 15),
              1e-5);
  for (const char* keep : {"below", "above"}) {
    const std::string plane = std::string("horizontal:altitude_m=8,keep=") + keep;
    EXPECT_NEAR(look(renderer, kFromAbove, {plane}).a, 1 - std::pow(0.97, 4), 1e-5) << keep;
  }
  EXPECT_NEAR(
      look(renderer, kFromAbove, {"horizontal:altitude_m=12", "horizontal:altitude_m=8,keep=above"}).a,
      1 - std::pow(0.97, 2), 1e-5);
}

TEST(Cut, InactivePlanesKeepThePictureBitIdentical) {
  const auto volume = testing::makeEmeVolume({24, 20, 12});
  Renderer renderer;
  show(renderer, volume, defaultTransferFunction(*volume));
  const ImageSize size{60, 40};
  renderer.setCamera(makeCamera({}, renderer.sceneBox(), size));
  const Image whole = renderer.render(size);
  for (const char* plane : {"horizontal:altitude_m=100,on=false", "horizontal:altitude_m=1e5",
                            "vertical:bearing_deg=10,offset_m=1e6"}) {
    RenderSettings settings;
    settings.planes = {parseCutPlane(plane)};
    renderer.setSettings(settings);
    EXPECT_TRUE(renderer.render(size).pixels == whole.pixels) << plane;
  }
}

TEST(Cut, HorizontalSectionShowsTheColorOfTheVoxelInEveryModeAndExaggeration) {
  const auto volume = makeVolume({6, 6, 10}, {10, 10, 10}, [](int, int, int k) { return 0.1F * (k + 1); });
  const TransferFunction function =
      testing::makeFunction({{0, {1, 0, 0}}, {1, {0, 0, 1}}}, {{0, 0}, {1, 0.01}});
  Renderer renderer;
  show(renderer, volume, function);
  for (const CompositingMode mode : kModes) {
    for (const double exaggeration : {1.0, 4.0}) {
      // The centre of layer 3, of value 0.4.
      expectColor(look(renderer, kFromAbove, {"horizontal:altitude_m=35"}, mode, exaggeration),
                  function.color(0.4), toString(mode));
    }
  }
}

TEST(Cut, SectionLiesBehindTheKeptVolume) {
  const auto volume = makeVolume({20, 10, 7}, {1, 1, 1}, [](int, int, int) { return 1.0F; });
  const TransferFunction function =
      testing::makeFunction({{0, {1, 1, 1}}, {1, {0, 1, 0}}}, {{0, 0.1}, {1, 0.1}});
  Renderer renderer;
  show(renderer, volume, function);
  for (const CompositingMode mode : {CompositingMode::dvr, CompositingMode::mida, CompositingMode::mip}) {
    // The side of the camera is kept.
    const Rgba pixel = look(renderer, kFromEast, {"vertical:bearing_deg=0,keep=right"}, mode);
    expectColor(pixel, {0, 1, 0}, toString(mode));
  }
}

TEST(Cut, IsosurfaceIsDrawnBeforeTheSectionAndClipped) {
  const auto volume =
      makeVolume({20, 10, 7}, {1, 1, 1}, [](int i, int, int) { return i < 15 ? 0.2F : 1.0F; });
  const TransferFunction function =
      testing::makeFunction({{0, {1, 1, 1}}, {1, {0, 1, 0}}}, {{0, 0.1}, {1, 0.1}});
  Renderer renderer;
  show(renderer, volume, function);
  // From the east the surface of 0.6 is the box's face; without it the section at 0.2 is seen.
  const Rgba surface = look(renderer, kFromEast, {"vertical:bearing_deg=0,keep=right"}, CompositingMode::iso);
  EXPECT_GT(surface.a, 0.99F);
  EXPECT_NE(surface.r, function.color(0.2).r);
  expectColor(look(renderer, kFromEast, {"vertical:bearing_deg=0"}, CompositingMode::iso),
              function.color(0.2), "clipped");
}

TEST(Cut, SectionIsTransparentWithoutField) {
  const auto volume =
      makeVolume({6, 6, 6}, {10, 10, 10}, [](int i, int, int) { return i < 3 ? 0.0F : 1.0F; });
  volume->first_valid_k.assign(36, 6);
  Renderer masked;
  show(masked, volume, fog(0.1));
  EXPECT_EQ(look(masked, kFromAbove, {"horizontal:altitude_m=30"}).a, 0.0F);
  const auto empty = makeVolume({6, 6, 6}, {10, 10, 10}, [](int, int, int) { return 0.0F; });
  Renderer floor;
  show(floor, empty, testing::makeFunction({{0, {1, 1, 1}}}, {{0, 0}, {1, 0.1}}));
  EXPECT_EQ(look(floor, kFromAbove, {"horizontal:altitude_m=30"}).a, 0.0F);
}

TEST(Cut, PositionsOnTheRemovedSideAreHidden) {
  Renderer renderer;
  // Without a value: sections hide nothing.
  show(renderer, makeVolume({20, 10, 8}, {3, 5, 2}, [](int, int, int) { return 0.0F; }), fog(0.03));
  const SceneBox box = renderer.sceneBox();
  const Vec3d center = (box.lower_m + box.upper_m) * 0.5;
  const Vec3d step{0, 0, 0.1 * (box.upper_m.z - box.lower_m.z)};
  EXPECT_FALSE(renderer.isHidden(center + step));
  for (const double exaggeration : {1.0, 3.0}) {
    RenderSettings settings = renderer.settings();
    settings.vertical_exaggeration = exaggeration;
    CutPlane plane;
    plane.altitude_m = center.z;
    settings.planes = {plane};
    renderer.setSettings(settings);
    EXPECT_TRUE(renderer.isHidden(center + step));
    EXPECT_FALSE(renderer.isHidden(center - step));
    settings.planes = {flipped(plane)};
    renderer.setSettings(settings);
    EXPECT_FALSE(renderer.isHidden(center + step));
    EXPECT_TRUE(renderer.isHidden(center - step));
    plane.on = false;
    settings.planes = {plane};
    renderer.setSettings(settings);
    EXPECT_FALSE(renderer.isHidden(center + step));
  }
}

TEST(Cut, PositionsBehindASectionWithAValueAreHidden) {
  Renderer renderer;
  const auto half = makeVolume({20, 10, 8}, {3, 5, 2}, [](int i, int, int) { return i < 10 ? 1.0F : 0.0F; });
  show(renderer, half, testing::makeFunction({{0, {1, 1, 1}}}, {{0, 0}, {1, 0.1}}));
  const SceneBox box = renderer.sceneBox();
  const Vec3d center = (box.lower_m + box.upper_m) * 0.5;
  const Vec3d aside{0.25 * (box.upper_m.x - box.lower_m.x), 0, 0}, up{0, 0, 4};
  look(renderer, kFromAbove, {fmt::format("horizontal:altitude_m={}", center.z)});
  EXPECT_TRUE(renderer.isHidden(center - aside - up)) << "below the section";
  EXPECT_FALSE(renderer.isHidden(center - aside)) << "on the plane";
  EXPECT_FALSE(renderer.isHidden(center + aside - up)) << "the section is transparent there";
  look(renderer, "orbit:azimuth_deg=0,elevation_deg=-90,distance=3,fov_deg=1",
       {fmt::format("horizontal:altitude_m={}", center.z)});
  EXPECT_FALSE(renderer.isHidden(center - aside - up)) << "in front of it";
}

TEST(Cut, VerticalPlanesCutTheGroundAndHorizontalOnesLeaveIt) {
  const auto volume = makeVolume({10, 10, 10}, {10, 10, 10}, [](int, int, int) { return 0.0F; });
  Renderer renderer;
  show(renderer, volume, testing::makeFunction({{0, {1, 1, 1}}}, {{0, 0}, {1, 0.1}}));
  renderer.setHeightField(testing::makeGround(volume->grid, 11, [](double, double) { return 40; }));
  const char* const at_east =
      "lookat:eye_x_m=80,eye_y_m=51,eye_z_m=300,target_x_m=80,target_y_m=50,target_z_m=0,fov_deg=1";
  EXPECT_EQ(look(renderer, at_east, {}).a, 1.0F);
  EXPECT_EQ(look(renderer, at_east, {"horizontal:altitude_m=20"}).a, 1.0F);
  EXPECT_EQ(look(renderer, at_east, {"vertical:bearing_deg=0"}).a, 0.0F);
  EXPECT_EQ(look(renderer, at_east, {"vertical:bearing_deg=0,keep=right"}).a, 1.0F);
}

class CutRestore : public test::OnBackends {};
EMSCAPE_ON_BACKENDS(CutRestore);

TEST_P(CutRestore, IsBitIdenticalToAFullCast) {
  std::mt19937 random(31);
  Renderer renderer(testing::on(GetParam()));
  for (int scene = 0; scene < 40; ++scene) {
    const ImageSize size{1 + static_cast<int>(random() % 70), 1 + static_cast<int>(random() % 70)};
    testing::setRandomScene(renderer, random, size);
    testing::addRandomPlanes(renderer, random);
    const Image full = renderer.render(size);
    for (const Pattern pattern : allPatterns()) {
      Image image;
      renderer.draw({pattern, Interpolation::float32, 0.3}, size, image);
      renderer.restore(image);
      EXPECT_TRUE(image.pixels == full.pixels) << scene << " " << toString(pattern);
    }
  }
}

TEST(Cut, PacketsAreWithinOneLevelOfThePlainForm) {
  std::mt19937 random(32);
  Renderer renderer;
  for (int scene = 0; scene < 40; ++scene) {
    const ImageSize size{1 + static_cast<int>(random() % 60), 1 + static_cast<int>(random() % 60)};
    testing::setRandomScene(renderer, random, size);
    testing::addRandomPlanes(renderer, random);
    const ImageDifference difference = testing::differenceFromPlain(renderer, size);
    for (std::size_t channel = 0; channel < 4; ++channel) {
      EXPECT_LE(difference.max[channel], 1)
          << "scene " << scene << ", " << toString(renderer.settings().mode);
    }
  }
}

TEST(Cut, BricksAreSkippedWithoutAChange) {
  std::mt19937 random(33);
  Renderer renderer;
  for (int scene = 0; scene < 30; ++scene) {
    const ImageSize size{40, 30};
    testing::setRandomScene(renderer, random, size);
    testing::addRandomPlanes(renderer, random);
    const Image skipped = renderer.render(size);
    RenderSettings settings = renderer.settings();
    settings.skip_empty = false;
    renderer.setSettings(settings);
    EXPECT_TRUE(renderer.render(size).pixels == skipped.pixels) << scene << " " << toString(settings.mode);
  }
}

}  // namespace
}  // namespace emscape::render
