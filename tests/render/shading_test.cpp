#include "render/cast/shading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "emscape/render/scene/renderer.h"
#include "tests/render/scenes.h"

namespace emscape::render {
namespace {

using testing::makeVolume;

VolumeView viewOf(const volume::DenseVolume& volume) {
  VolumeView view;
  view.values = volume.values.data();
  view.dims = volume.grid.dims;
  return view;
}

Vec3f gradientOf(const volume::DenseVolume& volume, const Vec3f& position) {
  const VolumeView view = viewOf(volume);
  float value = 0;
  EXPECT_TRUE(TrilinearSampler::sample(view, position, value));
  return gradientAt<TrilinearSampler>(view, position, value);
}

void expectNear(const Vec3f& a, const Vec3f& b, float tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Gradient, LinearFieldHasItsSlopeUpToTheBorder) {
  const auto volume = makeVolume({7, 5, 6}, {1, 1, 1}, [](int i, int j, int k) {
    return 3.0F * static_cast<float>(i) - 2.0F * j + 0.5F * k;
  });
  for (const Vec3f& position :
       {Vec3f{3, 2, 2}, Vec3f{0.3F, 3.8F, 4.9F}, Vec3f{-0.5F, 4.5F, 5.5F}, Vec3f{6.4F, -0.4F, 0}}) {
    expectNear(gradientOf(*volume, position), {3, -2, 0.5F}, 1e-4F);
  }
}

TEST(Gradient, IsZeroAlongAnAxisOfOneVoxel) {
  const auto volume = makeVolume({4, 1, 4}, {1, 1, 1}, [](int i, int, int) { return static_cast<float>(i); });
  expectNear(gradientOf(*volume, {1.5F, 0, 1.5F}), {1, 0, 0}, 1e-5F);
}

TEST(Gradient, IsOneSidedBesideUnknownVoxels) {
  const auto volume = makeVolume({9, 3, 3}, {1, 1, 1}, [](int i, int, int) {
    return i < 5 ? 2.0F * static_cast<float>(i) : std::numeric_limits<float>::quiet_NaN();
  });
  expectNear(gradientOf(*volume, {3, 1, 1}), {2, 0, 0}, 1e-5F);
}

TEST(Shading, NormalsArePerpendicularToDrawnSurfaces) {
  // The plane 2 x + y - 3 z = const of drawn space, for voxels of 1 x 4 x 0.5.
  ShadingView shading;
  shading.voxel = {1, 4, 0.5F};
  const Vec3f index_gradient{2 * 1, 1 * 4, -3 * 0.5F};
  expectNear(shading.normal(index_gradient), normalized(Vec3f{2, 1, -3}), 1e-6F);
}

TEST(Shading, KeepsOpacityAndPremultiplication) {
  const ShadingView shading;
  for (float angle = 0; angle < 6.3F; angle += 0.1F) {
    const Vec3f normal{std::sin(angle), 0, std::cos(angle)};
    const Rgba lit = shading.lit({0.2F, 0.05F, 0.4F, 0.4F}, normal, {0, 0, 1});
    EXPECT_EQ(lit.a, 0.4F);
    for (float channel : {lit.r, lit.g, lit.b}) {
      EXPECT_GE(channel, 0.0F);
      EXPECT_LE(channel, 0.4F);
    }
  }
}

TEST(Shading, BothSidesOfASurfaceLookTheSame) {
  const ShadingView shading;
  const Rgba color{0.3F, 0.2F, 0.1F, 0.5F};
  const Vec3f normal = normalized(Vec3f{0.3F, -0.5F, 0.7F});
  EXPECT_EQ(shading.lit(color, normal, {0, 0, 1}), shading.lit(color, -normal, {0, 0, 1}));
}

TEST(Shading, DarkensSurfacesThatFaceAway) {
  const ShadingView shading;
  const Rgba color{0.3F, 0.2F, 0.1F, 1};
  const Rgba facing = shading.lit(color, {0, 0, 1}, {0, 0, 1});
  const Rgba grazing = shading.lit(color, {1, 0, 0}, {0, 0, 1});
  EXPECT_GE(facing.r, color.r);
  EXPECT_NEAR(grazing.r, ShadingView::kAmbient * color.r, 1e-6);
}

TEST(Shading, FogWithoutGradientIsUnchanged) {
  const ShadingView shading;
  const Rgba color{0.3F, 0.2F, 0.1F, 0.5F};
  EXPECT_EQ(shading.litFog(color, {0, 0, 0}, {0, 0, 1}), color);
  const Rgba noise = shading.litFog(color, {1e-4F, 0, 0}, {0, 0, 1});
  EXPECT_NEAR(noise.r, color.r, 0.002);
  const Rgba edge = shading.litFog(color, {0.3F, 0, 0}, {0, 0, 1});
  EXPECT_NEAR(edge.r, ShadingView::kAmbient * color.r, 0.01);
}

Image pictureOf(const std::shared_ptr<volume::DenseVolume>& volume, const RenderSettings& settings) {
  const ImageSize size{60, 40};
  Renderer renderer;
  renderer.setVolume(volume);
  renderer.setTransferFunction(defaultTransferFunction(*volume));
  renderer.setSettings(settings);
  renderer.setCamera(makeCamera({}, renderer.sceneBox(), size));
  return renderer.render(size);
}

TEST(Shading, ChangesColoursButNotOpacities) {
  const auto volume = testing::makeEmeVolume({24, 24, 12});
  for (CompositingMode mode : {CompositingMode::dvr, CompositingMode::mida, CompositingMode::mip}) {
    RenderSettings settings;
    settings.mode = mode;
    settings.plain = true;
    const Image flat = pictureOf(volume, settings);
    settings.shading = true;
    const Image shaded = pictureOf(volume, settings);
    EXPECT_EQ(shaded.pixels == flat.pixels, mode == CompositingMode::mip) << toString(mode);
    for (std::size_t n = 0; n < flat.pixels.size(); ++n) EXPECT_EQ(shaded.pixels[n].a, flat.pixels[n].a);
  }
}

}  // namespace
}  // namespace emscape::render
