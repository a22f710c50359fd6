/// Packets of rays on every instruction set that they are built for.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdint>
#include <random>

#include "emscape/render/renderer.h"
#include "tests/render/random_scene.h"

namespace emscape::render {
namespace {

/// Packets use the instruction set of the parameter (HWY_AVX3 is AVX-512) until the test ends.
class Packets : public ::testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override {
    const std::int64_t target = GetParam();
    if (target != HWY_SCALAR && (hwy::SupportedTargets() & target) == 0) {
      GTEST_SKIP() << "the processor has no " << hwy::TargetName(target);
    }
    use(target);
  }
  void TearDown() override { use(0); }

 private:
  /// @param target  0: the best
  static void use(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

INSTANTIATE_TEST_SUITE_P(InstructionSets, Packets, ::testing::Values(HWY_AVX3, HWY_AVX2, HWY_SCALAR),
                         [](const auto& test) { return hwy::TargetName(test.param); });

TEST_P(Packets, AreWithinOneLevelOfThePlainForm) {
  std::mt19937 random(5);
  Renderer renderer;
  for (int scene = 0; scene < 60; ++scene) {
    const ImageSize size{1 + static_cast<int>(random() % 70), 1 + static_cast<int>(random() % 70)};
    testing::setRandomScene(renderer, random, size);
    const Image8 fast = quantize(renderer.render(size));
    RenderSettings settings = renderer.settings();
    settings.plain = true;
    renderer.setSettings(settings);
    const ImageDifference difference = compare(fast, quantize(renderer.render(size)));
    for (int channel = 0; channel < 4; ++channel) {
      EXPECT_LE(difference.max[static_cast<std::size_t>(channel)], 1)
          << "scene " << scene << ", " << toString(settings.mode) << ", channel " << channel;
    }
  }
}

TEST_P(Packets, CountTheirSamples) {
  Renderer renderer;
  RenderSettings settings;
  settings.exact = true;
  settings.skip_empty = false;
  settings.vertical_exaggeration = 1;
  renderer.setSettings(settings);
  renderer.setVolume(testing::makeVolume({20, 20, 20}, {1, 1, 1}, [](int, int, int) { return 0.5F; }));
  renderer.setTransferFunction(testing::fog(0.1));
  CameraSpec camera;
  camera.azimuth_deg = 0;
  camera.elevation_deg = 0;
  camera.projection = Projection::orthographic;
  const ImageSize size{5, 5};
  renderer.setCamera(makeCamera(camera, renderer.sceneBox(), size));
  FrameReport report;
  const Image image = renderer.render(size, {}, &report);
  long long hits = 0;
  for (const Rgba& pixel : image.pixels) hits += pixel.a > 0 ? 1 : 0;
  EXPECT_GT(hits, 0);
  EXPECT_EQ(report.samples, 20 * hits);
}

}  // namespace
}  // namespace emscape::render
