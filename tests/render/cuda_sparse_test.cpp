/// Pictures of sparse volumes on the GPU against those of the dense ones.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/render/cuda_scenes.h"

namespace emscape::render {
namespace {

using testing::Agreement;
using testing::makeEmeVolume;
using testing::onGpu;
using testing::setSameRandomScene;

constexpr double kShareApart = 1e-3;

RendererOptions sparseOnGpu() {
  RendererOptions options = onGpu();
  options.precision = volume::VoxelPrecision::sparse32;
  return options;
}

/// A volume with few values above the floor, and none in the east.
std::shared_ptr<volume::DenseVolume> cutVolume(float least) {
  constexpr int kEast = 30;
  auto volume = makeEmeVolume({100, 100, 50}, 3);
  for (std::size_t i = 0; i < volume->values.size(); ++i) {
    float& value = volume->values[i];
    if (value < least || static_cast<int>(i % 100) >= kEast) value = volume->info.floor;
  }
  return volume;
}

void setScene(Renderer& renderer, const std::shared_ptr<volume::DenseVolume>& volume, CompositingMode mode,
              ImageSize size) {
  RenderSettings settings;
  settings.mode = mode;
  settings.step_voxels = 0.5;
  settings.iso_value = -15;
  renderer.setSettings(settings);
  renderer.setVolume(std::shared_ptr<const volume::DenseVolume>(volume));
  renderer.setTransferFunction(defaultTransferFunction(*volume));
  renderer.setCamera(makeCamera({}, renderer.sceneBox(), size));
}

TEST(CudaSparse, EqualsDenseVolumeWithLessMemory) {
  EMSCAPE_NEEDS_GPU();
  const ImageSize size{400, 300};
  Renderer cpu, dense(onGpu()), sparse(sparseOnGpu());
  const auto volume = cutVolume(-20);
  for (const CompositingMode mode :
       {CompositingMode::dvr, CompositingMode::mida, CompositingMode::mip, CompositingMode::iso}) {
    for (Renderer* renderer : {&cpu, &dense, &sparse}) setScene(*renderer, volume, mode, size);
    Agreement with_dense, with_cpu;
    const Image picture = sparse.render(size);
    with_dense.add(picture, dense.render(size));
    with_cpu.add(picture, cpu.render(size));
    std::printf("%s: %.4f %% of the pixels more than a level from the dense volume, %.4f %% from the CPU\n",
                toString(mode), 100 * with_dense.shareApart(), 100 * with_cpu.shareApart());
    EXPECT_LE(with_dense.shareApart(), kShareApart) << toString(mode);
    EXPECT_LE(with_cpu.shareApart(), kShareApart) << toString(mode);
  }
  EXPECT_LT(sparse.volumeBytes(), dense.volumeBytes());
}

TEST(CudaSparse, RandomScenesEqualCpu) {
  EMSCAPE_NEEDS_GPU();
  std::mt19937 random(41);
  Renderer cpu, gpu(sparseOnGpu());
  Agreement all;
  for (int scene = 0; scene < 40; ++scene) {
    const ImageSize size{1 + static_cast<int>(random() % 60), 1 + static_cast<int>(random() % 60)};
    setSameRandomScene(cpu, gpu, random, size);
    if (scene % 2 == 1) {
      std::mt19937 again = random;
      testing::addRandomPlanes(cpu, random);
      testing::addRandomPlanes(gpu, again);
    }
    all.add(gpu.render(size), cpu.render(size));
  }
  EXPECT_LE(all.shareApart(), kShareApart);
}

TEST(CudaSparse, IndicesAreNotInterpolated) {
  EMSCAPE_NEEDS_GPU();
  const ImageSize size{120, 90};
  auto volume = cutVolume(-20);
  for (float& value : volume->values)
    value = value < -20 ? -1.F : std::fmod(std::abs(value), 3.F) < 1 ? 1 : 2;
  volume->info.categorical = true;
  volume->info.floor = -1;
  volume->info.range_min = 0;
  volume->info.range_max = 2;
  for (float& value : volume->values) value = std::round(value);
  Renderer dense(onGpu()), sparse(sparseOnGpu());
  for (Renderer* renderer : {&dense, &sparse}) setScene(*renderer, volume, CompositingMode::dvr, size);
  EXPECT_EQ(sparse.render(size).pixels, dense.render(size).pixels);
}

TEST(CudaSparse, PatternsAreRestoredToTheFullPicture) {
  EMSCAPE_NEEDS_GPU();
  const ImageSize size{200, 150};
  Renderer sparse(sparseOnGpu());
  setScene(sparse, cutVolume(-20), CompositingMode::dvr, size);
  const Image full = sparse.render(size);
  for (const Pattern pattern : allPatterns()) {
    FramePlan plan;
    plan.pattern = pattern;
    Image image;
    sparse.draw(plan, size, image);
    sparse.restore(image);
    EXPECT_EQ(image.pixels, full.pixels) << toString(pattern);
  }
}

}  // namespace
}  // namespace emscape::render
