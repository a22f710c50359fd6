#include "render/cast/raycast.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "emscape/render/scene/renderer.h"
#include "tests/render/scenes.h"

namespace emscape::render {
namespace {

using testing::fog;
using testing::makeVolume;

constexpr ImageSize kOnePixel{1, 1};

/// Colour of a one-pixel picture by a camera that looks along an axis through the middle of a volume.
Rgba lookAlong(const std::shared_ptr<volume::DenseVolume>& volume, const TransferFunction& function,
               const std::string& camera, RenderSettings settings = {}) {
  settings.exact = true;
  settings.vertical_exaggeration = 1;
  Renderer renderer;
  renderer.setVolume(volume);
  renderer.setTransferFunction(function);
  renderer.setSettings(settings);
  renderer.setCamera(makeCamera(parseCamera(camera), renderer.sceneBox(), kOnePixel));
  return renderer.render(kOnePixel).at(0, 0);
}

const char* const kAlongX = "orbit:azimuth_deg=90,elevation_deg=0,distance=3,fov_deg=1";
const char* const kAlongZ = "orbit:azimuth_deg=0,elevation_deg=90,distance=3,fov_deg=1";

float one(int, int, int) {
  return 1.0F;
}

TEST(Dvr, HomogeneousFogLetsThroughOneMinusOpacityForEachVoxel) {
  const auto volume = makeVolume({20, 10, 7}, {3, 5, 2}, one);
  EXPECT_NEAR(lookAlong(volume, fog(0.03), kAlongX).a, 1 - std::pow(0.97, 20), 1e-5);
  EXPECT_NEAR(lookAlong(volume, fog(0.03), kAlongZ).a, 1 - std::pow(0.97, 7), 1e-5);
}

TEST(Dvr, HomogeneousFogDoesNotDependOnTheStep) {
  const auto volume = makeVolume({20, 10, 7}, {1, 1, 1}, one);
  for (double step : {0.05, 0.3, 0.7, 1.0, 1.9, 7.3}) {
    RenderSettings settings;
    settings.step_voxels = step;
    const Rgba pixel =
        lookAlong(volume, fog(0.03), "orbit:azimuth_deg=70,elevation_deg=11,distance=2,fov_deg=1", settings);
    settings.step_voxels = 0.11;
    EXPECT_NEAR(
        pixel.a,
        lookAlong(volume, fog(0.03), "orbit:azimuth_deg=70,elevation_deg=11,distance=2,fov_deg=1", settings)
            .a,
        2e-5)
        << step;
  }
}

TEST(Dvr, ARampSumsToItsOpticalDepth) {
  // Values rise from 0 to 1 between the first and the last centre; opacity is chosen small, so that it adds
  // up.
  const int n = 41;
  const auto volume =
      makeVolume({n, 3, 3}, {1, 1, 1}, [&](int i, int, int) { return static_cast<float>(i) / (n - 1); });
  const TransferFunction function = testing::makeFunction({{0, {1, 1, 1}}}, {{0, 0}, {1, 1e-3}});
  RenderSettings settings;
  settings.step_voxels = 0.25;
  const double expected = 1e-3 * (0.5 * (n - 1) + 0.5);  // the last half voxel holds the end value
  EXPECT_NEAR(lookAlong(volume, function, kAlongX, settings).a, expected, 0.02 * expected);
}

TEST(Dvr, ColourIsPremultiplied) {
  const auto volume = makeVolume({4, 4, 4}, {1, 1, 1}, one);
  const TransferFunction function = testing::makeFunction({{0, {0.5F, 0.25F, 1.0F}}}, {{0, 0.2}, {1, 0.2}});
  const Rgba pixel = lookAlong(volume, function, kAlongX);
  EXPECT_NEAR(pixel.r, 0.5 * pixel.a, 1e-5);
  EXPECT_NEAR(pixel.g, 0.25 * pixel.a, 1e-5);
  EXPECT_NEAR(pixel.b, pixel.a, 1e-5);
}

TEST(Mip, ShowsTheColourOfTheLargestValue) {
  const auto volume = makeVolume({9, 3, 3}, {1, 1, 1}, [](int i, int, int) { return i == 4 ? 0.75F : 0.1F; });
  const TransferFunction function =
      testing::makeFunction({{0, {0, 0, 0}}, {1, {1, 1, 1}}}, {{0, 0}, {1, 0.02}});
  RenderSettings settings;
  settings.mode = CompositingMode::mip;
  const Rgba pixel = lookAlong(volume, function, kAlongX, settings);
  EXPECT_NEAR(pixel.a, 0.75, 1e-3);
  EXPECT_NEAR(pixel.r, 0.75 * 0.75, 1e-3);
}

TEST(Mida, WithGammaMinusOneCastsTheDvrPicture) {
  const auto volume = testing::makeEmeVolume({24, 24, 12});
  const TransferFunction function = defaultTransferFunction(*volume);
  RenderSettings mida;
  mida.mode = CompositingMode::mida;
  mida.mida_gamma = -1;
  const Rgba a = lookAlong(volume, function, kAlongX, mida);
  const Rgba b = lookAlong(volume, function, kAlongX);
  EXPECT_NEAR(a.r, b.r, 1e-6);
  EXPECT_NEAR(a.a, b.a, 1e-6);
}

TEST(Sampling, IsTrilinearBetweenCentresAndConstantBeyond) {
  const auto volume = makeVolume(
      {3, 4, 5}, {1, 1, 1}, [](int i, int j, int k) { return static_cast<float>(i + 10 * j + 100 * k); });
  VolumeView view;
  view.values = volume->values.data();
  view.dims = volume->grid.dims;
  float value = 0;
  ASSERT_TRUE(TrilinearSampler::sample(view, {1.25F, 2.5F, 3.75F}, value));
  EXPECT_FLOAT_EQ(value, 1.25F + 25 + 375);
  ASSERT_TRUE(TrilinearSampler::sample(view, {-0.5F, 3.5F, 4.5F}, value));
  EXPECT_FLOAT_EQ(value, 0 + 30 + 400);
  ASSERT_TRUE(NearestSampler::sample(view, {1.4F, 1.6F, 2.1F}, value));
  EXPECT_FLOAT_EQ(value, 1 + 20 + 200);
}

TEST(Sampling, WorksInAVolumeOfOneVoxel) {
  const auto volume = makeVolume({1, 1, 1}, {10, 10, 10}, one);
  EXPECT_NEAR(lookAlong(volume, fog(0.25), kAlongX).a, 0.25, 1e-5);
}

TEST(Mask, MaskedVoxelsAreNeverDrawn) {
  auto volume = makeVolume({8, 8, 8}, {1, 1, 1}, one);
  volume->first_valid_k.assign(64, 8);
  EXPECT_EQ(lookAlong(volume, fog(0.5), kAlongX), Rgba{});
  volume->first_valid_k.assign(64, 3);
  EXPECT_NEAR(lookAlong(volume, fog(0.03), kAlongZ).a, 1 - std::pow(0.97, 5), 0.01);
}

TEST(Mask, MaskedVoxelsDoNotBleedIntoNeighbors) {
  // A cliff: half of the columns masked up to a height, with a value there that would be seen at once.
  auto volume =
      makeVolume({8, 8, 8}, {1, 1, 1}, [](int i, int, int k) { return i < 4 && k < 5 ? 1.0F : 0.0F; });
  volume->first_valid_k.assign(64, 0);
  for (int j = 0; j < 8; ++j) {
    for (int i = 0; i < 4; ++i) volume->first_valid_k[static_cast<std::size_t>(j) * 8 + i] = 5;
  }
  const TransferFunction function = testing::makeFunction({{0, {1, 1, 1}}}, {{0, 0}, {0.001, 1}, {1, 1}});
  for (const char* camera :
       {"orbit:azimuth_deg=90,elevation_deg=30", "orbit:azimuth_deg=300,elevation_deg=50", "orbit"}) {
    Renderer renderer;
    renderer.setVolume(volume);
    renderer.setTransferFunction(function);
    const ImageSize size{64, 48};
    renderer.setCamera(makeCamera(parseCamera(camera), renderer.sceneBox(), size));
    for (const Rgba& pixel : renderer.render(size).pixels) EXPECT_EQ(pixel.a, 0.0F) << camera;
  }
}

TEST(Nan, IsTransparent) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto all = makeVolume({8, 8, 8}, {1, 1, 1}, [&](int, int, int) { return nan; });
  EXPECT_EQ(lookAlong(all, fog(0.5), kAlongX), Rgba{});
  const auto some = makeVolume({20, 3, 3}, {1, 1, 1}, [&](int i, int, int) { return i < 10 ? 1.0F : nan; });
  EXPECT_NEAR(lookAlong(some, fog(0.03), kAlongX).a, 1 - std::pow(0.97, 9), 0.02);
}

TEST(Infinity, IsDrawnInTheLastColor) {
  auto volume = makeVolume({12, 12, 12}, {1, 1, 1}, [](int i, int j, int k) {
    if ((i + j + k) % 7 == 0) return std::numeric_limits<float>::infinity();
    return (i + 2 * j + k) % 11 == 0 ? -std::numeric_limits<float>::infinity() : 0.5F;
  });
  for (CompositingMode mode :
       {CompositingMode::dvr, CompositingMode::mida, CompositingMode::mip, CompositingMode::iso}) {
    RenderSettings settings;
    settings.mode = mode;
    settings.shading = true;
    for (const char* camera : {kAlongX, "orbit:azimuth_deg=70,elevation_deg=11,distance=2,fov_deg=1"}) {
      const Rgba pixel = lookAlong(volume, fog(0.1), camera, settings);
      for (float channel : {pixel.r, pixel.g, pixel.b, pixel.a}) {
        EXPECT_TRUE(channel >= 0 && channel <= 1.0001F) << toString(mode) << channel;
      }
    }
  }
}

TEST(Categories, AreDrawnInTheirOwnColoursWithoutOthersBetween) {
  auto volume = makeVolume({10, 10, 10}, {1, 1, 1}, [](int i, int, int) { return i < 5 ? 0.0F : 2.0F; });
  volume->info.categorical = true;
  volume->info.range_max = 2;
  TransferFunction function = defaultTransferFunction(volume->info);
  function.opacities = {{0, 1}, {2, 1}};
  const Rgba from_east = lookAlong(volume, function, kAlongX);
  EXPECT_NEAR(from_east.r, categoryColor(2).r, 1e-4);
  EXPECT_NEAR(from_east.b, categoryColor(2).b, 1e-4);
}

constexpr CompositingMode kModes[] = {CompositingMode::dvr, CompositingMode::mida, CompositingMode::mip,
                                      CompositingMode::iso};

/// Draws a scene with and without skipping; both renderers are reused, so that nothing of an earlier scene
/// may remain.
class SkippingPair {
 public:
  template <class Change>
  void change(const Change& change) {
    change(every_sample_);
    change(skipping_);
  }
  void set(RenderSettings settings) {
    settings.skip_empty = false;
    every_sample_.setSettings(settings);
    settings.skip_empty = true;
    skipping_.setSettings(settings);
  }
  void expectEqual(const std::string& scene) {
    const ImageSize size{40, 30};
    const Image expected = every_sample_.render(size);
    const Image skipped = skipping_.render(size);
    EXPECT_TRUE(skipped.pixels == expected.pixels) << scene;
    for (const Rgba& pixel : expected.pixels) drawn_ += pixel.a > 0 ? 1 : 0;
  }
  long long drawn() const { return drawn_; }

 private:
  Renderer every_sample_, skipping_;
  long long drawn_ = 0;
};

/// Steps, gaps and jumps between -60 and 40.
TransferFunction randomFunction(std::mt19937& random) {
  std::uniform_real_distribution<double> part(0, 1);
  TransferFunction function = testing::makeFunction({{-60, {1, 0, 0}}, {40, {0, 1, 1}}}, {});
  double at = -60;
  while (at < 40) {
    const double opacity = part(random) < 0.5 ? 0 : std::pow(part(random), 3);
    function.opacities.push_back({at, opacity});
    if (part(random) < 0.5) function.opacities.push_back({at, part(random) < 0.5 ? 0 : part(random)});
    at += 1 + 30 * part(random) * part(random);
  }
  return function;
}

std::shared_ptr<volume::DenseVolume> randomVolume(std::mt19937& random) {
  const auto below = [&](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
  auto volume =
      testing::makeEmeVolume({1 + below(40), 1 + below(40), 1 + below(30)}, static_cast<unsigned>(below(99)));
  if (below(3) == 0) volume->first_valid_k.clear();
  if (below(3) == 0) {
    for (float& value : volume->values) value = below(4) == 0 ? value : -60.0F;  // scattered peaks
  }
  if (below(3) == 0) {
    for (int n = below(200); n >= 0; --n) {
      volume->values[random() % volume->values.size()] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  return volume;
}

TEST(Skipping, SLOW_DoesNotChangeThePictureAfterAnyChange) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> part(0, 1);
  SkippingPair pair;
  for (int scene = 0; scene < 12; ++scene) {
    const auto volume = randomVolume(random);
    CameraSpec camera;
    camera.azimuth_deg = 360 * part(random);
    camera.elevation_deg = 180 * part(random) - 90;
    camera.distance = 0.2 + 1.5 * part(random);  // some eyes are inside
    pair.change([&](Renderer& renderer) {
      renderer.setVolume(volume);
      renderer.setCamera(makeCamera(camera, renderer.sceneBox(), {40, 30}));
    });
    for (int edit = 0; edit < 3; ++edit) {
      const TransferFunction function = randomFunction(random);
      pair.change([&](Renderer& renderer) { renderer.setTransferFunction(function); });
      for (CompositingMode mode : kModes) {
        for (int variant = 0; variant < 4; ++variant) {
          RenderSettings settings;
          settings.mode = mode;
          settings.shading = variant % 2 == 1;
          settings.plain = variant < 2;
          settings.exact = part(random) < 0.5;
          settings.step_voxels = 0.2 + 2 * part(random) * part(random);
          settings.iso_value = 80 * part(random) - 50;
          settings.mida_gamma = 2 * part(random) - 1;
          pair.set(settings);
          pair.expectEqual(std::string(toString(mode)) + (settings.plain ? " plain" : " packets") +
                           (settings.shading ? " shaded" : "") + (settings.exact ? " exact" : "") +
                           ", scene " + std::to_string(scene) + ", edit " + std::to_string(edit));
        }
      }
    }
  }
  EXPECT_GT(pair.drawn(), 100000);  // there was something to be seen
}

TEST(Mida, EndsEarlyOnlyWhereNoLaterSampleOfTheRayExceedsTheMaximum) {
  // An opaque wall, fog behind it, and behind that in one half of the picture a peak that must show.
  auto volume = makeVolume({64, 16, 4}, {1, 1, 1}, [](int i, int j, int) {
    if (i == 60 && j >= 10) return 1.0F;
    return i == 2 ? 0.5F : 0.2F;
  });
  const TransferFunction function = testing::makeFunction(
      {{0, {0, 0, 1}}, {1, {1, 0, 0}}}, {{0, 0}, {0.1, 0.01}, {0.4, 0.01}, {0.5, 0.995}, {1, 1}});
  const ImageSize size{2, 1};
  Renderer renderer;
  renderer.setVolume(volume);
  renderer.setTransferFunction(function);
  renderer.setCamera(makeCamera(
      parseCamera("orbit:azimuth_deg=270,elevation_deg=0,projection=orthographic,fov_deg=7,distance=1"),
      renderer.sceneBox(), size));
  RenderSettings settings;
  settings.mode = CompositingMode::mida;
  settings.plain = true;
  settings.exact = true;
  renderer.setSettings(settings);
  const Image exact = renderer.render(size);
  settings.exact = false;
  renderer.setSettings(settings);
  const Image early = renderer.render(size);
  // From the west the north (large j) is on the left.
  EXPECT_EQ(early.at(0, 0), exact.at(0, 0));  // nothing shows through the peak
  EXPECT_FALSE(early.at(1, 0) == exact.at(1, 0));
  EXPECT_NEAR(early.at(1, 0).a, exact.at(1, 0).a, 0.01);
  EXPECT_GT(early.at(0, 0).r, 0.7F);
  EXPECT_LT(early.at(1, 0).r, 0.6F);
}

TEST(Rays, ProjectBackToTheirPixels) {
  const auto volume = makeVolume({20, 30, 10}, {100, 50, 30}, one);
  const ImageSize size{31, 17};
  const SceneBox box = sceneBoxOf(volume->grid, 2.5);
  for (const char* text : {"orbit", "orbit:projection=orthographic,azimuth_deg=77"}) {
    const Camera camera = makeCamera(parseCamera(text), box, size, {0.1, 0.3, 0.05, 0.2});
    const Vec3d frame_m{700, 300, 222};
    const Projected p = project(camera, size, box.toDrawn(frame_m));
    // The drawn position on the plane of that pixel, at that depth.
    const double scale = camera.half_height * (camera.projection == Projection::orthographic ? 1 : p.depth_m);
    const Vec3d back = camera.eye_m + camera.forward * p.depth_m +
                       camera.right * (camera.planeX(p.x, size) * scale) +
                       camera.up * (camera.planeY(p.y, size) * scale);
    EXPECT_NEAR(length(back - box.toDrawn(frame_m)), 0, 1e-6);
  }
}

}  // namespace
}  // namespace emscape::render
