#include "render/cast/ground.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "emscape/base/error.h"
#include "emscape/render/scene/renderer.h"
#include "render/cast/raycast.h"
#include "tests/render/scenes.h"

namespace emscape::render {
namespace {

using testing::makeGround;
using testing::makeVolume;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

volume::Grid grid() {
  return makeVolume({20, 20, 10}, {100, 100, 50}, [](int, int, int) { return 0.0F; })->grid;
}

double hills(double x, double y) {
  return 150 + 90 * std::sin(x / 210) * std::cos(y / 170) + 0.02 * x;
}

GroundHit hitOf(const GroundSurface& surface, const Vec3d& from, const Vec3d& to) {
  const Ray ray{from, normalized(to - from)};
  const GroundView view = surface.view();
  const RayInterval inside = clip(ray, view.lower, view.upper);
  if (!(inside.end > inside.begin)) return {};
  return view.firstHit(ray.origin, ray.direction, inside.begin, inside.end);
}

TEST(Ground, IsHitWhereAFineWalkAlongTheRayFindsIt) {
  const volume::Grid g = grid();
  const auto field = makeGround(g, 33, hills);
  const GroundSurface surface(*field, g, sceneBoxOf(g, 1));
  // The bilinear height, in index space, found without the hierarchy.
  const auto heightAt = [&](double x, double y) {
    const double u = std::clamp((x + 0.5) / 20 * 32, 0.0, 32.0);
    const double v = std::clamp((y + 0.5) / 20 * 32, 0.0, 32.0);
    const int i = std::min(static_cast<int>(u), 31);
    const int j = std::min(static_cast<int>(v), 31);
    const auto z = [&](int a, int b) {
      return field->heights_m[static_cast<std::size_t>(b) * 33 + a] / 50.0 - 0.5;
    };
    const double s = u - i;
    const double t = v - j;
    return (z(i, j) * (1 - s) + z(i + 1, j) * s) * (1 - t) +
           (z(i, j + 1) * (1 - s) + z(i + 1, j + 1) * s) * t;
  };
  int hits = 0;
  for (int n = 0; n < 400; ++n) {
    const double angle = 0.37 * n;
    const Vec3d from{10 + 30 * std::cos(angle), 10 + 30 * std::sin(angle), 6.0 + n % 12};
    const Vec3d to{10 + 9 * std::cos(2.1 * n), 10 + 9 * std::sin(1.3 * n), 1.0 + n % 4};
    const Vec3d direction = normalized(to - from);
    const GroundHit hit = hitOf(surface, from, to);
    double walked = -1;
    for (double t = 0; t < 80; t += 0.002) {
      const Vec3d p = from + direction * t;
      const bool inside =
          std::abs(p.x - 9.5) < 10 && std::abs(p.y - 9.5) < 10 && p.z > surface.view().lower.z;
      if (inside && p.z <= heightAt(p.x, p.y)) {
        walked = t;
        break;
      }
    }
    ASSERT_EQ(hit.found, walked >= 0) << n;
    if (!hit.found) continue;
    ++hits;
    EXPECT_NEAR(hit.distance, walked, 0.01) << n;
  }
  EXPECT_GT(hits, 250);
}

TEST(Ground, HidesTheFieldBehindIt) {
  auto volume = makeVolume({20, 20, 10}, {100, 100, 50}, [](int, int, int) { return 1.0F; });
  Renderer renderer;
  renderer.setVolume(volume);
  renderer.setTransferFunction(testing::fog(0.1));
  renderer.setHeightField(makeGround(volume->grid, 21, [](double, double) { return 250; }));
  const ImageSize size{1, 1};
  renderer.setCamera(makeCamera(parseCamera("orbit:azimuth_deg=0,elevation_deg=90,distance=3,fov_deg=1"),
                                renderer.sceneBox(), size));
  const Rgba pixel = renderer.render(size).at(0, 0);
  const double through = std::pow(0.9, 5);  // five voxels above the ground
  const Rgba ground = GroundSurface(*makeGround(volume->grid, 21, [](double, double) { return 250; }),
                                    volume->grid, renderer.sceneBox())
                          .view()
                          .colors[0];
  EXPECT_FLOAT_EQ(pixel.a, 1.0F);
  EXPECT_NEAR(pixel.r, (1 - through) + through * ground.r, 1e-4);
}

TEST(Ground, WithoutFieldIsOpaqueAndBelowIsASolidBlock) {
  const volume::Grid g = grid();
  const auto field = makeGround(g, 21, hills);
  const GroundSurface surface(*field, g, sceneBoxOf(g, 2));
  EXPECT_TRUE(hitOf(surface, {9, 9, 50}, {9, 9, 0}).found);
  EXPECT_TRUE(hitOf(surface, {9, 9, -50}, {9, 9, 0}).found);       // from below
  EXPECT_TRUE(hitOf(surface, {-50, 9, 0.5}, {10, 9, 0.5}).found);  // into its side
  EXPECT_FALSE(hitOf(surface, {-50, 9, 9}, {50, 9, 9}).found);     // above
  EXPECT_FALSE(hitOf(surface, {-50, 9, 9}, {-51, 9, -9}).found);   // beside
}

TEST(Ground, HoleIsDrawnAsHatchedPit) {
  const volume::Grid g = grid();
  const auto field = makeGround(g, 41, [](double x, double y) {
    return std::abs(x - 1000) < 420 && std::abs(y - 1000) < 420 ? kNaN : 200.0;
  });
  const GroundSurface surface(*field, g, sceneBoxOf(g, 1));
  const GroundHit outside = hitOf(surface, {2, 2, 30}, {2, 2, 0});
  const GroundHit hole = hitOf(surface, {9.5, 9.5, 30}, {9.5, 9.5, 0});
  ASSERT_TRUE(outside.found);
  ASSERT_TRUE(hole.found);
  EXPECT_NEAR(outside.distance, 30 - 3.5, 1e-3);
  EXPECT_NEAR(hole.distance, 30 - surface.view().lower.z, 1e-3);  // down to the base
  bool dark = false;
  bool hatched = false;
  for (int n = 0; n < 60; ++n) {
    const double x = 7.0 + 0.08 * n;
    const Rgba color = hitOf(surface, {x, 9.5, 30}, {x, 9.5, 0}).color;
    dark |= color.r == color.g;
    hatched |= color.r > 1.5F * color.g;
  }
  EXPECT_TRUE(dark && hatched);
  EXPECT_NEAR(hitOf(surface, {9.5, 9.5, 2}, {30, 9.5, 2}).distance, 4.5, 1e-3);  // the pit's wall
}

TEST(Ground, GroundOfHolesOnlyIsDrawn) {
  const volume::Grid g = grid();
  const GroundSurface surface(*makeGround(g, 5, [](double, double) { return kNaN; }), g, sceneBoxOf(g, 1));
  EXPECT_TRUE(hitOf(surface, {9.5, 9.5, 30}, {9.5, 9.5, 0}).found);
}

TEST(Ground, CoversTheBoxFromPostsAtVoxelCentresAndNoFurther) {
  const volume::Grid g = grid();
  HeightField field;
  field.columns = field.rows = 20;
  field.first_x_m = field.first_y_m = 50;
  field.spacing_x_m = field.spacing_y_m = 100;
  field.heights_m.assign(400, 100);
  const GroundSurface centres(field, g, sceneBoxOf(g, 1));
  EXPECT_NEAR(hitOf(centres, {-0.4, 19.4, 30}, {-0.4, 19.4, 0}).distance, 28.5, 1e-3);
  field.columns = 10;  // the eastern half is not known
  field.heights_m.assign(200, 100);
  const GroundSurface half(field, g, sceneBoxOf(g, 1));
  EXPECT_NEAR(hitOf(half, {15, 10, 30}, {15, 10, 0}).distance, 30 - half.view().lower.z, 1e-3);
}

/// The colour of level ground at the centre of a grid, from above.
Rgba colorAbove(HeightField field) {
  const volume::Grid g = grid();
  return hitOf(GroundSurface(field, g, sceneBoxOf(g, 1)), {9.5, 9.5, 30}, {9.5, 9.5, 0}).color;
}

TEST(Ground, WaterIsBluerThanLandAndPaleAtTheShore) {
  HeightField field = *makeGround(grid(), 21, [](double, double) { return 100; });
  const Rgba land = colorAbove(field);
  field.kinds.assign(field.heights_m.size(), GroundKind::water);
  const Rgba water = colorAbove(field);
  EXPECT_GT(water.b, 1.3F * water.r);
  EXPECT_GT(water.b - water.r, land.b - land.r + 0.1F);
  field.kinds[10 * 21 + 11] = GroundKind::land;  // beside the centre
  const Rgba shore = colorAbove(field);
  EXPECT_GT(shore.r + shore.g + shore.b, water.r + water.g + water.b);
  field.kinds.clear();
  EXPECT_EQ(colorAbove(field).b, land.b) << "land without kinds";
}

TEST(Ground, IsLighterForPicturesOnALightBackground) {
  HeightField field = *makeGround(grid(), 21, [](double, double) { return 100; });
  for (const bool is_water : {false, true}) {
    if (is_water) field.kinds.assign(field.heights_m.size(), GroundKind::water);
    field.light = false;
    const Rgba dark = colorAbove(field);
    field.light = true;
    const Rgba light = colorAbove(field);
    EXPECT_GT(light.r + light.g + light.b, 1.3F * (dark.r + dark.g + dark.b));
    EXPECT_LE(std::max({light.r, light.g, light.b}), 1);
  }
}

TEST(Ground, APictureCoversItAsFarAsItIsOpaque) {
  HeightField field = *makeGround(grid(), 21, [](double, double) { return 100; });
  const Rgba land = colorAbove(field);
  field.colors.assign(field.heights_m.size(), 0xFF0000FFU);
  EXPECT_NEAR(colorAbove(field).r, 1, 0.01);
  EXPECT_NEAR(colorAbove(field).g, 0, 0.01);
  field.colors.assign(field.heights_m.size(), 0x000000FFU);
  EXPECT_NEAR(colorAbove(field).r, land.r, 1e-6);
}

TEST(Ground, MalformedFieldsAreRefused) {
  const volume::Grid g = grid();
  HeightField field = *makeGround(g, 4, hills);
  field.heights_m.pop_back();
  EXPECT_THROW(GroundSurface(field, g, sceneBoxOf(g, 1)), Error);
  field = *makeGround(g, 4, hills);
  field.kinds.resize(3);
  EXPECT_THROW(GroundSurface(field, g, sceneBoxOf(g, 1)), Error);
  field = *makeGround(g, 4, hills);
  field.colors.resize(17);
  EXPECT_THROW(GroundSurface(field, g, sceneBoxOf(g, 1)), Error);
  field = *makeGround(g, 4, hills);
  field.spacing_x_m = 0;
  EXPECT_THROW(GroundSurface(field, g, sceneBoxOf(g, 1)), Error);
  field.spacing_x_m = 1e-9;
  EXPECT_THROW(GroundSurface(field, g, sceneBoxOf(g, 1)), Error);
}

TEST(Ground, HidesMarkersBehindARidgeAndNotThoseOnIt) {
  auto volume = makeVolume({20, 20, 10}, {100, 100, 50}, [](int, int, int) { return 0.0F; });
  Renderer renderer;
  renderer.setVolume(volume);
  renderer.setTransferFunction(testing::fog(0.1));
  EXPECT_FALSE(renderer.isHidden({1000, 1500, 100}));
  renderer.setHeightField(
      makeGround(volume->grid, 41, [](double, double y) { return std::abs(y - 1000) < 60 ? 400 : 50; }));
  for (const char* text : {"orbit:azimuth_deg=180,elevation_deg=5",
                           "orbit:azimuth_deg=180,elevation_deg=5,projection=orthographic"}) {
    renderer.setCamera(makeCamera(parseCamera(text), renderer.sceneBox(), {100, 100}));
    EXPECT_TRUE(renderer.isHidden({1000, 1500, 100}));
    EXPECT_FALSE(renderer.isHidden({1000, 500, 100}));
    EXPECT_FALSE(renderer.isHidden({1000, 1000, 405}));
  }
}

}  // namespace
}  // namespace emscape::render
