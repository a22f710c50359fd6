#include "render/scene/prepared_volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "emscape/render/scene/renderer.h"
#include "tests/render/scenes.h"

namespace emscape::render {
namespace {

float codedValue(const VolumeView& view, std::size_t voxel) {
  return view.coded.value(static_cast<float>(view.coded.codes[voxel] * QuantizedValues::kWeights));
}

TEST(PreparedVolume, CodesAreWithinHalfAStepOfTheValues) {
  const auto volume = testing::makeEmeVolume({23, 17, 11}, 3);
  PreparedVolume ready;
  ready.set(volume);
  const VolumeView view = ready.view();
  ASSERT_NE(view.coded.codes, nullptr);
  const auto [least, most] = std::minmax_element(volume->values.begin(), volume->values.end());
  EXPECT_LE(view.coded.step(), (*most - *least) / 65534 * 1.001F);
  for (std::size_t voxel = 0; voxel < volume->values.size(); ++voxel) {
    EXPECT_NEAR(codedValue(view, voxel), view.values[voxel], 0.502F * view.coded.step()) << "voxel " << voxel;
  }
}

TEST(PreparedVolume, CodedValuesLieInTheirBricksRange) {
  const Dims dims{30, 20, 10};
  PreparedVolume ready;
  ready.set(testing::makeEmeVolume(dims, 8));
  const VolumeView view = ready.view();
  const volume::BricksView bricks = ready.bricks();
  for (int k = 0; k < dims.z; ++k) {
    for (int j = 0; j < dims.y; ++j) {
      for (int i = 0; i < dims.x; ++i) {
        const volume::ValueRange range = bricks.at(i / bricks.edge, j / bricks.edge, k / bricks.edge);
        if (range.empty()) continue;
        const float value = codedValue(view, static_cast<std::size_t>((k * dims.y + j) * dims.x + i));
        EXPECT_GE(value, range.min);
        EXPECT_LE(value, range.max);
        EXPECT_LE(value, ready.highest());
      }
    }
  }
}

TEST(PreparedVolume, AConstantIsCodedExactly) {
  PreparedVolume ready;
  ready.set(testing::makeVolume({4, 4, 4}, {1, 1, 1}, [](int, int, int) { return 0.3F; }));
  EXPECT_EQ(codedValue(ready.view(), 5), 0.3F);
}

TEST(PreparedVolume, NonFiniteValuesHaveNoCodes) {
  for (const float odd : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    PreparedVolume ready;
    ready.set(testing::makeVolume({4, 4, 4}, {1, 1, 1},
                                  [&](int i, int, int k) { return i + k == 0 ? odd : 1.0F; }));
    EXPECT_EQ(ready.view().coded.codes, nullptr);
    EXPECT_FALSE(ready.view().all_finite);
  }
}

TEST(PreparedVolume, AnOutlierDoesNotCoarsenThePicture) {
  Renderer renderer;
  renderer.setVolume(testing::makeVolume({20, 20, 20}, {1, 1, 1}, [](int i, int j, int k) {
    return i + j + k == 0 ? 1e7F : static_cast<float>((7 * i + 5 * j + 3 * k) % 11) / 10;
  }));
  renderer.setTransferFunction(testing::fog(0.1));
  const ImageSize size{40, 30};
  renderer.setCamera(makeCamera({}, renderer.sceneBox(), size));
  const Image8 fast = quantize(renderer.render(size));
  RenderSettings settings;
  settings.plain = true;
  renderer.setSettings(settings);
  const ImageDifference difference = compare(fast, quantize(renderer.render(size)));
  for (int channel = 0; channel < 4; ++channel) {
    EXPECT_LE(difference.max[static_cast<std::size_t>(channel)], 1) << "channel " << channel;
  }
}

}  // namespace
}  // namespace emscape::render
