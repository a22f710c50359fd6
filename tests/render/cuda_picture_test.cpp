/// Finished pictures that stay on the GPU.
#include <gtest/gtest.h>

#include "emscape/base/error.h"
#include "tests/render/cuda_scenes.h"
#include "tests/render/layered_picture.h"

namespace emscape::render {
namespace {

OverlayLayers randomLayers(std::mt19937& random, ImageSize size) {
  OverlayLayers layers;
  layers.size = size;
  for (long long i = 0; i < size.count(); ++i) {
    layers.behind.push_back(0xFF000000U | random());
    const std::uint32_t alpha = random() % 256;
    const auto level = [&] { return random() % (alpha + 1); };
    layers.front.push_back(alpha << 24 | level() << 16 | level() << 8 | level());
  }
  return layers;
}

TEST(CudaPicture, CompositionEqualsCpu) {
  EMSCAPE_NEEDS_GPU();
  std::mt19937 random(11);
  Renderer renderer(testing::onGpu());
  for (int scene = 0; scene < 10; ++scene) {
    const ImageSize size{1 + static_cast<int>(random() % 90), 1 + static_cast<int>(random() % 90)};
    testing::setRandomScene(renderer, random, size);
    renderer.draw({}, size);
    Image8 cast;
    renderer.fetch(cast);
    const OverlayLayers layers = randomLayers(random, size);
    const auto picture = renderer.compose(layers);
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->size(), size);
    EXPECT_TRUE(picture->host().rgba == testing::putTogether(cast, layers).rgba) << scene;
  }
}

TEST(CudaPicture, IsUnchangedWhileHeld) {
  EMSCAPE_NEEDS_GPU();
  std::mt19937 random(12);
  const ImageSize size{40, 30};
  Renderer renderer(testing::onGpu());
  testing::setRandomScene(renderer, random, size);
  renderer.draw({}, size);
  const auto held = renderer.compose(randomLayers(random, size));
  const Image8 before = held->host();
  for (int n = 0; n < 5; ++n) {
    const auto next = renderer.compose(randomLayers(random, size));
    EXPECT_NE(next, held);
    EXPECT_FALSE(next->host().rgba == before.rgba);
  }
  EXPECT_TRUE(held->host().rgba == before.rgba);
}

TEST(CudaPicture, RefusesLayersOfAnotherSize) {
  EMSCAPE_NEEDS_GPU();
  std::mt19937 random(13);
  const ImageSize size{20, 10};
  Renderer renderer(testing::onGpu());
  testing::setRandomScene(renderer, random, size);
  renderer.draw({}, size);
  EXPECT_THROW(renderer.compose(randomLayers(random, {10, 20})), Error);
}

TEST(CudaPicture, NeedsAnOpenGlContextToBeShared) {
  EXPECT_FALSE(openGlSharesGpu());
}

}  // namespace
}  // namespace emscape::render
