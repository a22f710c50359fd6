/// Frames of the GPU: restored, stopped, and of volumes that change.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "emscape/base/error.h"
#include "tests/render/cuda_scenes.h"

namespace emscape::render {
namespace {

using testing::makeEmeVolume;
using testing::onGpu;

/// A large picture of many samples, so that a restoration takes many launches.
void setLongScene(Renderer& renderer, ImageSize size) {
  const auto volume = makeEmeVolume({60, 60, 40}, 5);
  RenderSettings settings;
  settings.step_voxels = 0.05;
  settings.exact = true;
  settings.skip_empty = false;
  renderer.setSettings(settings);
  renderer.setVolume(std::shared_ptr<const volume::DenseVolume>(volume));
  renderer.setTransferFunction(defaultTransferFunction(*volume));
  renderer.setCamera(makeCamera({}, renderer.sceneBox(), size));
}

TEST(CudaRestore, CanBeStoppedAndRestarted) {
  EMSCAPE_NEEDS_GPU();
  const ImageSize size{2400, 1800};
  Renderer renderer(onGpu());
  setLongScene(renderer, size);
  const Image full = renderer.render(size);
  for (const Pattern pattern : {Pattern::quarter, Pattern::adaptive}) {
    const FramePlan plan{pattern, Interpolation::float32, 0.1};
    renderer.draw(plan, size);
    StopFlag stop{true};
    EXPECT_FALSE(renderer.restore(&stop).complete);
    // Few launches precede the stop.
    stop = false;
    std::thread stopper([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      stop = true;
    });
    const FrameReport stopped = renderer.restore(&stop);
    stopper.join();
    EXPECT_FALSE(stopped.complete) << toString(pattern);
    stop = false;
    EXPECT_TRUE(renderer.restore(&stop).complete);
    Image image;
    renderer.fetch(image);
    EXPECT_TRUE(image.pixels == full.pixels) << toString(pattern);
  }
}

TEST(CudaAdaptive, KeepsItsErrorSmallWithFewRays) {
  EMSCAPE_NEEDS_GPU();
  const ImageSize size{600, 450};
  const auto volume = makeEmeVolume({100, 100, 50}, 3);
  Renderer renderer(onGpu());
  RenderSettings settings;
  settings.step_voxels = 0.5;
  renderer.setSettings(settings);
  renderer.setVolume(std::shared_ptr<const volume::DenseVolume>(volume));
  renderer.setTransferFunction(defaultTransferFunction(*volume));
  renderer.setCamera(makeCamera({}, renderer.sceneBox(), size));
  Image full = renderer.render(size);
  Image8 drawn;
  FramePlan plan{Pattern::adaptive};
  plan.ray_share = 1;
  const FrameReport report = renderer.draw(plan, size);
  renderer.fetch(drawn);
  const ImageDifference difference = compare(drawn, quantize(full));
  EXPECT_LT(report.rays, size.count() / 2);
  EXPECT_GT(report.rays, size.count() / 32);
  EXPECT_LE(difference.mean_all, 0.2);

  // No tolerance: nearly everything is cast.
  plan.tolerance_levels = 0;
  EXPECT_GT(renderer.draw(plan, size).rays, report.rays);
  renderer.fetch(drawn);
  EXPECT_LE(compare(drawn, quantize(full)).mean_all, difference.mean_all);
}

TEST(CudaAdaptive, StaysWithinRayBudget) {
  EMSCAPE_NEEDS_GPU();
  const ImageSize size{300, 225};
  Renderer renderer(onGpu());
  setLongScene(renderer, size);
  const FramePlan plan{Pattern::adaptive, Interpolation::float32, 0.01};
  FrameReport report;
  for (int frame = 0; frame < 12; ++frame) report = renderer.draw(plan, size);
  EXPECT_LE(static_cast<double>(report.rays), 0.27 * static_cast<double>(size.count()));
}

TEST(CudaVolume, DeviceVolumeEqualsHostVolume) {
  EMSCAPE_NEEDS_GPU();
  const ImageSize size{90, 70};
  const auto volume = makeEmeVolume({20, 20, 20}, 2);
  auto device = std::make_shared<volume::DeviceVolume>(volume->grid);
  device->upload(*volume);
  const auto picture = [&](Renderer& renderer) {
    renderer.setTransferFunction(defaultTransferFunction(*volume));
    renderer.setCamera(makeCamera({}, renderer.sceneBox(), size));
    return renderer.render(size);
  };
  Renderer from_host(onGpu()), from_device(onGpu()), cpu, cpu_from_device;
  from_host.setVolume(std::shared_ptr<const volume::DenseVolume>(volume));
  from_device.setVolume(std::shared_ptr<const volume::DeviceVolume>(device));
  EXPECT_TRUE(picture(from_host).pixels == picture(from_device).pixels);
  cpu.setVolume(std::shared_ptr<const volume::DenseVolume>(volume));
  cpu_from_device.setVolume(std::shared_ptr<const volume::DeviceVolume>(device));
  EXPECT_TRUE(picture(cpu).pixels == picture(cpu_from_device).pixels);
}

TEST(CudaVolume, FramesNeverShowHalfAnUpdate) {
  EMSCAPE_NEEDS_GPU();
  const ImageSize size{200, 150};
  const auto first = makeEmeVolume({64, 64, 32}, 1);
  auto second = makeEmeVolume({64, 64, 32}, 2);
  second->first_valid_k = first->first_valid_k;
  Renderer renderer(onGpu());
  const auto pictureOf = [&](const std::shared_ptr<volume::DenseVolume>& volume) {
    renderer.setVolume(std::shared_ptr<const volume::DenseVolume>(volume));
    return renderer.render(size);
  };
  renderer.setVolume(std::shared_ptr<const volume::DenseVolume>(first));
  renderer.setTransferFunction(defaultTransferFunction(*first));
  renderer.setCamera(makeCamera({}, renderer.sceneBox(), size));
  const Image picture1 = pictureOf(first);
  const Image picture2 = pictureOf(second);
  ASSERT_FALSE(picture1.pixels == picture2.pixels);

  std::atomic<bool> ends{false};
  std::thread updater([&] {
    volume::DeviceVolumeRing ring;
    for (int update = 0; !ends; ++update) {
      auto volume = ring.next(first->grid, volume::VoxelPrecision::float32);
      volume->upload(update % 2 == 0 ? *first : *second);
      renderer.setVolume(std::shared_ptr<const volume::DeviceVolume>(std::move(volume)));
    }
  });
  int shown1 = 0, shown2 = 0;
  for (int frame = 0; frame < 200; ++frame) {
    const Image picture = renderer.render(size);
    shown1 += picture.pixels == picture1.pixels ? 1 : 0;
    shown2 += picture.pixels == picture2.pixels ? 1 : 0;
  }
  ends = true;
  updater.join();
  EXPECT_EQ(shown1 + shown2, 200);
}

}  // namespace
}  // namespace emscape::render
