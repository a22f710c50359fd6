#include <gtest/gtest.h>

#include <cmath>

#include "emscape/base/error.h"
#include "emscape/render/scene/renderer.h"
#include "render/cast/rgba.h"
#include "tests/render/scenes.h"

namespace emscape::render {
namespace {

using testing::makeGround;
using testing::makeVolume;

constexpr ImageSize kSize{40, 40};
constexpr double kHeight_m = 120;

/// Colours of the values 0..1000; the fog is transparent.
TransferFunction ramp() {
  return testing::makeFunction({{0, {0, 0, 1}}, {1000, {1, 0.5F, 0}}}, {{0, 0}, {1000, 0}});
}

/// The value is the height (m), of voxels of 50 m; the ground is a slope.
class MapLayer : public ::testing::Test {
 protected:
  static double ground_m(double x_m) { return 60 + 0.1 * x_m; }

  MapLayer() {
    volume_ = makeVolume({20, 20, 10}, {100, 100, 50},
                         [](int, int, int k) { return static_cast<float>(50 * k + 25); });
    volume_->info.floor = -1;
    show(renderer_);
  }
  void show(Renderer& renderer) const {
    renderer.setVolume(volume_);
    renderer.setTransferFunction(ramp());
    renderer.setHeightField(makeGround(volume_->grid, 41, [](double x_m, double) { return ground_m(x_m); }));
    renderer.setCamera(
        makeCamera(parseCamera("orbit:azimuth_deg=180,elevation_deg=90,projection=orthographic"),
                   renderer.sceneBox(), kSize));
  }
  Image picture(std::optional<double> height_m, double opacity = 0.6) {
    RenderSettings settings = renderer_.settings();
    settings.map_height_agl_m = height_m;
    settings.map_opacity = opacity;
    renderer_.setSettings(settings);
    return renderer_.render(kSize);
  }
  /// The middle of a pixel on the ground (m).
  double x_m(int x) const {
    const Camera& camera = renderer_.camera();
    return camera.eye_m.x + camera.planeX(x, kSize) * camera.half_height * camera.right.x;
  }

  std::shared_ptr<volume::DenseVolume> volume_;
  Renderer renderer_;
};

TEST_F(MapLayer, HasTheColourOfTheVolumeAtItsHeightAboveTheGround) {
  const Image plain = picture(std::nullopt), mapped = picture(kHeight_m);
  int painted = 0;
  for (int x = 0; x < kSize.width; ++x) {
    const Rgba before = plain.at(x, 20), after = mapped.at(x, 20);
    if (before.a < 1) continue;
    const Rgb color = ramp().color(ground_m(x_m(x)) + kHeight_m);
    const Rgba expected = over(Rgba{color.r, color.g, color.b, 1} * 0.6F, before);
    EXPECT_NEAR(after.r, expected.r, 5e-3) << x;
    EXPECT_NEAR(after.g, expected.g, 5e-3) << x;
    EXPECT_NEAR(after.b, expected.b, 5e-3) << x;
    ++painted;
  }
  EXPECT_GT(painted, 20);
}

TEST_F(MapLayer, IsNotPaintedOutsideOfTheVolumeOrWhereItHasNoValue) {
  const Image plain = picture(std::nullopt);
  EXPECT_TRUE(picture(600).pixels == plain.pixels) << "above the box";
  volume_->info.floor = 0;
  std::fill(volume_->values.begin(), volume_->values.end(), 0.0F);
  renderer_.setVolume(volume_);
  EXPECT_TRUE(picture(kHeight_m).pixels == plain.pixels) << "no field";
  volume_->info.floor = -1;
  volume_->first_valid_k.assign(400, 10);
  renderer_.setVolume(volume_);
  EXPECT_TRUE(picture(kHeight_m).pixels == plain.pixels) << "masked";
}

TEST_F(MapLayer, OfADifferenceIsTransparentWhereNextToNothingDiffers) {
  const Image plain = picture(std::nullopt);
  volume_->info.floor = 0;
  volume_->info.extra[volume::kScaleKey] = volume::kDifferenceScale;
  const TransferFunction function = testing::makeFunction(
      {{-20, {0, 0, 1}}, {0, {1, 1, 1}}, {20, {1, 0.5F, 0}}}, {{-20, 0.1}, {-1, 0}, {1, 0}, {20, 0.1}});
  EXPECT_EQ(quietBelow(function), 1);
  const auto pictureOf = [&](float difference_db) {
    std::fill(volume_->values.begin(), volume_->values.end(), difference_db);
    renderer_.setVolume(volume_);
    renderer_.setTransferFunction(function);
    return picture(kHeight_m, 1);
  };
  const auto isPlain = [&](float difference_db) { return pictureOf(difference_db).pixels == plain.pixels; };
  for (const float quiet : {-0.9F, 0.0F, 0.5F}) EXPECT_TRUE(isPlain(quiet)) << quiet;
  for (const float visible : {-3.0F, 1.5F, 3.0F}) EXPECT_FALSE(isPlain(visible)) << visible;
  const Rgba full = pictureOf(-4).at(20, 20), color = Rgba{0.8F, 0.8F, 1, 1};
  EXPECT_NEAR(full.r, color.r, 0.02);
  EXPECT_NEAR(full.b, color.b, 0.02);
}

TEST_F(MapLayer, WithoutGroundNothingIsPainted) {
  renderer_.setHeightField(nullptr);
  const Image plain = picture(std::nullopt);
  EXPECT_TRUE(picture(kHeight_m).pixels == plain.pixels);
}

TEST_F(MapLayer, FollowsValuesColoursAndHeightInEveryPattern) {
  const auto restored = [&](Renderer& renderer) {
    Image image;
    renderer.draw({Pattern::quarter, {}}, kSize, image);
    renderer.restore(image);
    return image;
  };
  const auto isAsFresh = [&](const TransferFunction& function) {
    Renderer fresh;
    show(fresh);
    fresh.setTransferFunction(function);
    fresh.setSettings(renderer_.settings());
    return restored(renderer_).pixels == fresh.render(kSize).pixels;
  };
  picture(kHeight_m);
  EXPECT_TRUE(isAsFresh(ramp()));
  for (float& value : volume_->values) value = 1000 - value;
  renderer_.setVolume(std::make_shared<const volume::DenseVolume>(*volume_));
  EXPECT_TRUE(isAsFresh(ramp())) << "other values";
  TransferFunction other = ramp();
  other.colors.front().color = {0, 1, 0};
  renderer_.setTransferFunction(other);
  EXPECT_TRUE(isAsFresh(other)) << "other colours";
  RenderSettings settings = renderer_.settings();
  settings.map_height_agl_m = 200;
  renderer_.setSettings(settings);
  EXPECT_TRUE(isAsFresh(other)) << "another height";
  settings.map_opacity = 0.3;
  renderer_.setSettings(settings);
  EXPECT_TRUE(isAsFresh(other)) << "another opacity";
}

TEST_F(MapLayer, HeightAndOpacityHaveLimits) {
  RenderSettings settings;
  settings.map_height_agl_m = -1;
  EXPECT_THROW(renderer_.setSettings(settings), Error);
  settings.map_height_agl_m = 0;
  settings.map_opacity = 1.5;
  EXPECT_THROW(renderer_.setSettings(settings), Error);
}

}  // namespace
}  // namespace emscape::render
