/// Packets of rays on every instruction set that they are built for.
#include <gtest/gtest.h>

#include <random>

#include "emscape/render/scene/renderer.h"
#include "tests/render/instruction_sets.h"
#include "tests/render/random_scene.h"

namespace emscape::render {
namespace {

class Packets : public test::OnInstructionSet {};

EMSCAPE_ON_INSTRUCTION_SETS(Packets);

TEST_P(Packets, AreWithinOneLevelOfThePlainForm) {
  std::mt19937 random(5);
  Renderer renderer;
  for (int scene = 0; scene < 60; ++scene) {
    const ImageSize size{1 + static_cast<int>(random() % 70), 1 + static_cast<int>(random() % 70)};
    testing::setRandomScene(renderer, random, size);
    const ImageDifference difference = testing::differenceFromPlain(renderer, size);
    for (int channel = 0; channel < 4; ++channel) {
      EXPECT_LE(difference.max[static_cast<std::size_t>(channel)], 1)
          << "scene " << scene << ", " << toString(renderer.settings().mode) << ", channel " << channel;
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
