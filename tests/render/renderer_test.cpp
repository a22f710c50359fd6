#include "emscape/render/scene/renderer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "emscape/base/backend.h"
#include "emscape/base/error.h"
#include "emscape/base/work.h"
#include "render/patterns/reconstruction.h"
#include "render/scene/ground_layer.h"
#include "tests/render/random_scene.h"
#include "tests/support/on_backends.h"

namespace emscape::render {
namespace {

using testing::makeEmeVolume;
using testing::on;
using testing::setRandomScene;

class Restore : public test::OnBackends {};
EMSCAPE_ON_BACKENDS(Restore);

TEST_P(Restore, IsBitIdenticalToAFullCast) {
  const bool gpu = GetParam() == Backend::cuda;
  const unsigned longest = gpu ? 70 : 40;  // several tiles of a launch
  std::mt19937 random(7);
  Renderer renderer(on(GetParam()));  // kept: nothing of an earlier scene may remain
  for (int scene = 0; scene < (gpu ? 60 : 40); ++scene) {
    const ImageSize size{1 + static_cast<int>(random() % longest), 1 + static_cast<int>(random() % longest)};
    setRandomScene(renderer, random, size);
    const Image full = renderer.render(size);
    for (Pattern pattern : allPatterns()) {
      for (Interpolation interpolation : {Interpolation::float32, Interpolation::bits8}) {
        if (gpu && interpolation == Interpolation::bits8) continue;  // quantises the pixels it reads, too
        Image image = renderer.render(size, {pattern, interpolation});
        const FrameReport report = renderer.restore(image);
        EXPECT_TRUE(report.complete);
        if (pattern != Pattern::adaptive) {
          EXPECT_EQ(report.rays, pixelCount(missingLattices(pattern, size)));
        }
        EXPECT_TRUE(image.pixels == full.pixels) << scene << " " << toString(pattern);
      }
    }
  }
}

TEST(Cast, SourcePixelsEqualFullCast) {
  std::mt19937 random(11);
  Renderer renderer;
  const ImageSize size{33, 21};
  setRandomScene(renderer, random, size);
  const Image full = renderer.render(size);
  FrameReport report;
  const Image quarter = renderer.render(size, {Pattern::quarter}, &report);
  EXPECT_EQ(report.rays, 17 * 11);
  for (int y = 0; y < size.height; y += 2) {
    for (int x = 0; x < size.width; x += 2) EXPECT_EQ(quarter.at(x, y), full.at(x, y));
  }
}

class Draw : public test::OnBackends {};
EMSCAPE_ON_BACKENDS(Draw);

TEST(GroundLayer, IsUnknownIfItsMemoryWasPreparedInPartOnly) {
  GroundLayer layer;
  Work work;
  work.stop();
  const WorkScope scope(&work);
  EXPECT_THROW(layer.reset({4000, 3000}), Stopped);
  EXPECT_EQ(layer.size.count(), 0);
}

TEST_P(Draw, ReportsThatItWasStopped) {
  std::mt19937 random(3);
  Renderer renderer(on(GetParam()));
  const ImageSize size{64, 64};
  setRandomScene(renderer, random, size);
  for (const Pattern pattern : {Pattern::full, Pattern::adaptive}) {
    StopFlag stop{true};
    EXPECT_FALSE(renderer.draw({pattern}, size, &stop).complete);
    stop = false;
    EXPECT_TRUE(renderer.draw({pattern}, size, &stop).complete);
  }
}

TEST(Renderer, ShowsTheVolumeThatWasSetLast) {
  const ImageSize size{20, 20};
  const auto first = makeEmeVolume({16, 16, 16}, 1);
  const auto second = makeEmeVolume({16, 16, 16}, 2);
  const auto fresh = [&](const std::shared_ptr<volume::DenseVolume>& volume) {
    Renderer renderer;
    renderer.setVolume(volume);
    renderer.setTransferFunction(defaultTransferFunction(*first));
    renderer.setCamera(makeCamera({}, renderer.sceneBox(), size));
    return renderer.render(size);
  };
  Renderer kept;
  kept.setVolume(first);
  kept.setTransferFunction(defaultTransferFunction(*first));
  kept.setCamera(makeCamera({}, kept.sceneBox(), size));
  EXPECT_TRUE(kept.render(size).pixels == fresh(first).pixels);
  kept.setVolume(second);
  EXPECT_TRUE(kept.render(size).pixels == fresh(second).pixels);
  EXPECT_FALSE(fresh(first).pixels == fresh(second).pixels);
}

TEST(Renderer, TakesTheBackendThatAutomaticResolvesTo) {
  RendererOptions options;
  options.backend = Backend::automatic;
  const Renderer renderer(options);
  EXPECT_EQ(renderer.backend(), resolveBackend(Backend::automatic).backend);
}

class Refusals : public test::OnBackends {};
EMSCAPE_ON_BACKENDS(Refusals);

TEST_P(Refusals, InvalidScenesAreRefused) {
  Renderer renderer(on(GetParam()));
  EXPECT_THROW(renderer.sceneBox(), Error);
  EXPECT_THROW(renderer.draw({}, {8, 8}), Error);
  EXPECT_THROW(renderer.setVolume(volume::Volume()), Error);
  auto volume = makeEmeVolume({4, 4, 4});
  volume->values.pop_back();
  EXPECT_THROW(renderer.setVolume(volume), Error);
  RenderSettings settings;
  settings.step_voxels = 0;
  EXPECT_THROW(renderer.setSettings(settings), Error);
  settings = {};
  settings.mida_gamma = 2;
  EXPECT_THROW(renderer.setSettings(settings), Error);
}

}  // namespace
}  // namespace emscape::render
