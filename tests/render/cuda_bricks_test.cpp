/// Bricks that can be skipped, and whether the GPU looks for them.
#include <gtest/gtest.h>

#include "emscape/volume/device_volume.h"
#include "render/cuda/device_scene.h"
#include "render/scene/prepared_volume.h"
#include "tests/render/cuda_scenes.h"

namespace emscape::render {
namespace {

using testing::makeEmeVolume;
using testing::onGpu;

constexpr ImageSize kSize{120, 90};

/// A volume in which values below a limit are replaced by the floor, which is transparent.
std::shared_ptr<volume::DenseVolume> cutVolume(float least) {
  auto volume = makeEmeVolume({64, 64, 32}, 3);
  for (float& value : volume->values) {
    if (value < least) value = volume->info.floor;
  }
  return volume;
}
constexpr float kKeepsMost = -1000;
constexpr float kKeepsLittle = 10;

/// Opaque above the floor.
TransferFunction functionOf(const volume::DenseVolume& volume) {
  TransferFunction function = defaultTransferFunction(volume.info);
  const double floor = volume.info.floor;
  function.opacities = {{floor, 0}, {floor + 1, 0}, {floor + 2, 0.01}, {volume.info.range_max, 0.05}};
  return function;
}

SkipLevels levelsOnHost(const Scene& scene, const std::shared_ptr<volume::DenseVolume>& volume) {
  PreparedVolume ready;
  ready.set(volume);
  return skipLevels(scene.skipRule(), ready.bricks());
}
double skippableShare(const SkipLevels& levels) {
  const auto skippable = std::count_if(levels.levels.begin(), levels.levels.end(),
                                       [](float level) { return level < SkipView::kNever; });
  return static_cast<double>(skippable) / static_cast<double>(levels.levels.size());
}

/// A scene on the GPU without a renderer.
struct Launcher {
  std::shared_ptr<volume::DeviceVolume> volume;
  Scene scene;
  cuda::DeviceScene device;
  emscape::cuda::Stream stream;

  void set(const std::shared_ptr<volume::DenseVolume>& from, CompositingMode mode) {
    volume = std::make_shared<volume::DeviceVolume>(from->grid);
    volume->upload(*from);
    device.volumeChanged();
    RenderSettings settings = scene.settings();
    settings.mode = mode;
    scene.setSettings(settings);
    scene.setVolume(from->grid, from->info);
    scene.setTransferFunction(functionOf(*from));
    scene.setCamera(makeCamera({}, scene.box(), kSize));
    scene.prepare();
  }
  /// Launches as for a frame, and waits. @return true if bricks are searched
  bool looksForBricks() {
    volume->storage().beginReading(stream);
    device.update(scene, volume->storage(), stream);
    const cuda::CastLaunch launch = device.launch(scene, volume->storage(), cuda::Sampling::filtered, kSize);
    volume->storage().endReading(stream);
    stream.wait();
    return launch.task.skip.levels != nullptr;
  }
};

TEST(CudaBricks, AreSearchedWherePreviousFrameShowsABenefit) {
  EMSCAPE_NEEDS_GPU();
  for (const CompositingMode mode : {CompositingMode::dvr, CompositingMode::mida}) {
    Launcher launcher;
    launcher.set(cutVolume(kKeepsMost), mode);
    EXPECT_LT(skippableShare(levelsOnHost(launcher.scene, cutVolume(kKeepsMost))), 0.1) << toString(mode);
    EXPECT_TRUE(launcher.looksForBricks()) << "nothing is known yet";
    EXPECT_FALSE(launcher.looksForBricks());

    launcher.set(cutVolume(kKeepsLittle), mode);
    EXPECT_GT(skippableShare(levelsOnHost(launcher.scene, cutVolume(kKeepsLittle))), 0.9) << toString(mode);
    EXPECT_FALSE(launcher.looksForBricks()) << "of the volume before";
    EXPECT_TRUE(launcher.looksForBricks());

    RenderSettings settings = launcher.scene.settings();
    settings.skip_empty = false;
    launcher.scene.setSettings(settings);
    EXPECT_FALSE(launcher.looksForBricks()) << "not to be skipped";
  }
}

TEST(CudaBricks, HaveTheLevelsOfTheHost) {
  EMSCAPE_NEEDS_GPU();
  for (const CompositingMode mode :
       {CompositingMode::dvr, CompositingMode::mida, CompositingMode::mip, CompositingMode::iso}) {
    Launcher launcher;
    const auto volume = cutVolume(-30);
    launcher.set(volume, mode);
    ASSERT_TRUE(launcher.looksForBricks());
    const cuda::CastLaunch launch =
        launcher.device.launch(launcher.scene, launcher.volume->storage(), cuda::Sampling::filtered, kSize);
    const SkipLevels expected = levelsOnHost(launcher.scene, volume);
    std::vector<float> levels(expected.levels.size());
    emscape::cuda::check(cudaMemcpy(levels.data(), launch.task.skip.levels, levels.size() * sizeof(float),
                                    cudaMemcpyDeviceToHost),
                         "cudaMemcpy");
    for (std::size_t n = 0; n < levels.size(); ++n) {
      EXPECT_NEAR(levels[n], expected.levels[n], 1e-4) << toString(mode) << " " << n;
    }
  }
}

TEST(CudaBricks, DoNotChangeThePicture) {
  EMSCAPE_NEEDS_GPU();
  for (const float least : {kKeepsMost, -30.0F, kKeepsLittle}) {
    const auto volume = cutVolume(least);
    for (const CompositingMode mode : {CompositingMode::dvr, CompositingMode::mida}) {
      Renderer renderer(onGpu());
      RenderSettings settings;
      settings.mode = mode;
      renderer.setSettings(settings);
      renderer.setVolume(std::shared_ptr<const volume::DenseVolume>(volume));
      renderer.setTransferFunction(functionOf(*volume));
      renderer.setCamera(makeCamera({}, renderer.sceneBox(), kSize));
      const Image first = renderer.render(kSize);  // searches for bricks: nothing is known yet
      EXPECT_TRUE(renderer.render(kSize).pixels == first.pixels) << toString(mode) << " " << least;
      settings.skip_empty = false;
      renderer.setSettings(settings);
      EXPECT_TRUE(renderer.render(kSize).pixels == first.pixels) << toString(mode) << " " << least;
    }
  }
}

}  // namespace
}  // namespace emscape::render
