/// Pictures of the GPU against those of the CPU.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "render/patterns/reconstruction.h"
#include "tests/render/cuda_scenes.h"
#include "tests/support/errors.h"

namespace emscape::render {
namespace {

using testing::Agreement;
using testing::makeEmeVolume;
using testing::onGpu;
using testing::setRandomScene;
using testing::setSameRandomScene;

constexpr double kShareApart = 1e-3;

/// A scene like those of the program: half as many voxels along each side as eme_200.
void setEmeScene(Renderer& renderer, CompositingMode mode, bool shading, ImageSize size) {
  static const auto volume = makeEmeVolume({100, 100, 50}, 3);
  RenderSettings settings;
  settings.mode = mode;
  settings.shading = shading;
  settings.step_voxels = 0.5;
  settings.iso_value = -20;
  renderer.setSettings(settings);
  renderer.setVolume(std::shared_ptr<const volume::DenseVolume>(volume));
  renderer.setTransferFunction(defaultTransferFunction(*volume));
  renderer.setCamera(makeCamera({}, renderer.sceneBox(), size));
}

TEST(CudaCast, EmeVolumeEqualsCpu) {
  EMSCAPE_NEEDS_GPU();
  const ImageSize size{400, 300};
  Renderer cpu, gpu(onGpu());
  for (const CompositingMode mode :
       {CompositingMode::dvr, CompositingMode::mida, CompositingMode::mip, CompositingMode::iso}) {
    for (const bool shading : {false, true}) {
      setEmeScene(cpu, mode, shading, size);
      setEmeScene(gpu, mode, shading, size);
      Agreement agreement;
      agreement.add(gpu.render(size), cpu.render(size));
      std::printf("%s%s: %.4f %% of the pixels more than a level apart, at most %d\n", toString(mode),
                  shading ? ", shaded" : "", 100 * agreement.shareApart(), agreement.largest_levels);
      EXPECT_LE(agreement.shareApart(), kShareApart) << toString(mode) << " " << shading;
    }
  }
}

TEST(CudaCast, RandomScenesEqualCpu) {
  EMSCAPE_NEEDS_GPU();
  std::mt19937 random(21);
  Renderer cpu, gpu(onGpu());  // kept: nothing of an earlier scene may remain
  Agreement all;
  for (int scene = 0; scene < 80; ++scene) {
    const ImageSize size{1 + static_cast<int>(random() % 60), 1 + static_cast<int>(random() % 60)};
    setSameRandomScene(cpu, gpu, random, size);
    Agreement agreement;
    agreement.add(gpu.render(size), cpu.render(size));
    all.add(gpu.render(size), cpu.render(size));
    if (agreement.apart > 0) {
      const RenderSettings& settings = cpu.settings();
      std::printf("scene %d, %s%s, step %g: %lld of %lld pixels apart, at most %d levels\n", scene,
                  toString(settings.mode), settings.shading ? ", shaded" : "", settings.step_voxels,
                  agreement.apart, agreement.pixels, agreement.largest_levels);
    }
  }
  std::printf("all: %.4f %% apart\n", 100 * all.shareApart());
  EXPECT_LE(all.shareApart(), kShareApart);
}

TEST(CudaCast, PlainFormEqualsPlainFormOfCpu) {
  EMSCAPE_NEEDS_GPU();
  std::mt19937 random(22);
  Renderer cpu, gpu(onGpu());
  Agreement all;
  for (int scene = 0; scene < 40; ++scene) {
    const ImageSize size{1 + static_cast<int>(random() % 60), 1 + static_cast<int>(random() % 60)};
    setSameRandomScene(cpu, gpu, random, size);
    RenderSettings settings = cpu.settings();
    settings.plain = true;
    cpu.setSettings(settings);
    gpu.setSettings(settings);
    all.add(gpu.render(size), cpu.render(size));
  }
  EXPECT_LE(all.shareApart(), kShareApart);
}

TEST(CudaCast, CutVolumesEqualCpu) {
  EMSCAPE_NEEDS_GPU();
  std::mt19937 random(23);
  Renderer cpu, gpu(onGpu());
  Agreement all;
  for (int scene = 0; scene < 60; ++scene) {
    const ImageSize size{1 + static_cast<int>(random() % 60), 1 + static_cast<int>(random() % 60)};
    setSameRandomScene(cpu, gpu, random, size);
    std::mt19937 again = random;
    testing::addRandomPlanes(cpu, random);
    testing::addRandomPlanes(gpu, again);
    all.add(gpu.render(size), cpu.render(size));
  }
  std::printf("cut: %.4f %% apart, at most %d levels\n", 100 * all.shareApart(), all.largest_levels);
  EXPECT_LE(all.shareApart(), kShareApart);
}

TEST(CudaCast, SmoothEdgesEqualCpu) {
  EMSCAPE_NEEDS_GPU();
  // A pixel whose contrast is on the edge of being smoothed may be so on only one of them.
  constexpr double kShareOnTheEdge = 5e-3;
  std::mt19937 random(28);
  Renderer cpu, gpu(onGpu());
  Agreement all;
  for (int scene = 0; scene < 60; ++scene) {
    const ImageSize size{1 + static_cast<int>(random() % 60), 1 + static_cast<int>(random() % 60)};
    setSameRandomScene(cpu, gpu, random, size);
    if (scene % 3 == 0) {
      std::mt19937 again = random;
      testing::addRandomPlanes(cpu, random);
      testing::addRandomPlanes(gpu, again);
    }
    all.add(gpu.render(size, FramePlan::exact()), cpu.render(size, FramePlan::exact()));
  }
  std::printf("smooth edges: %.4f %% apart, at most %d levels\n", 100 * all.shareApart(), all.largest_levels);
  EXPECT_LE(all.shareApart(), kShareApart + kShareOnTheEdge);
}

TEST(CudaCast, IndicesEqualCpu) {
  EMSCAPE_NEEDS_GPU();
  const ImageSize size{80, 60};
  auto volume = testing::makeVolume({12, 9, 7}, {100, 100, 100}, [](int i, int j, int k) {
    return static_cast<float>((i + 2 * j + 3 * k) % 5 - 1);
  });
  volume->info.categorical = true;
  volume->info.range_min = -1;
  volume->info.range_max = 3;
  Renderer cpu, gpu(onGpu());
  for (Renderer* renderer : {&cpu, &gpu}) {
    renderer->setVolume(std::shared_ptr<const volume::DenseVolume>(volume));
    renderer->setTransferFunction(defaultTransferFunction(volume->info));
    renderer->setCamera(makeCamera({}, renderer->sceneBox(), size));
  }
  Agreement agreement;
  agreement.add(gpu.render(size), cpu.render(size));
  EXPECT_LE(agreement.shareApart(), kShareApart);
}

TEST(CudaCast, SkippingKeepsThePicture) {
  EMSCAPE_NEEDS_GPU();
  std::mt19937 random(23);
  Renderer gpu(onGpu());
  for (int scene = 0; scene < 40; ++scene) {
    const ImageSize size{1 + static_cast<int>(random() % 60), 1 + static_cast<int>(random() % 60)};
    setRandomScene(gpu, random, size);
    RenderSettings settings = gpu.settings();
    settings.skip_empty = true;
    gpu.setSettings(settings);
    const Image skipped = gpu.render(size);
    settings.skip_empty = false;
    gpu.setSettings(settings);
    EXPECT_TRUE(gpu.render(size).pixels == skipped.pixels) << scene << " " << toString(settings.mode);
  }
}

TEST(CudaCast, HalfPrecisionIsNearFloat) {
  EMSCAPE_NEEDS_GPU();
  const ImageSize size{200, 150};
  RendererOptions half = onGpu();
  half.precision = volume::VoxelPrecision::float16;
  Renderer in_float(onGpu()), in_half(half);
  setEmeScene(in_float, CompositingMode::dvr, false, size);
  setEmeScene(in_half, CompositingMode::dvr, false, size);
  Agreement agreement;
  agreement.add(in_half.render(size), in_float.render(size));
  EXPECT_LE(agreement.shareApart(), 10 * kShareApart);
}

const ImageSize kEvenAndOddSizes[] = {{64, 48}, {61, 47}, {64, 47}, {61, 48}, {1, 1},
                                      {1, 8},   {9, 1},   {2, 2},   {3, 2},   {130, 5}};

TEST(CudaCast, InterpolationEqualsHost) {
  EMSCAPE_NEEDS_GPU();
  std::mt19937 random(24);
  Renderer gpu(onGpu());
  for (int scene = 0; scene < 3; ++scene) {
    for (const ImageSize size : kEvenAndOddSizes) {
      setRandomScene(gpu, random, size);
      gpu.setHeightField(nullptr);
      const Image full = gpu.render(size);
      for (const Pattern pattern : {Pattern::columns, Pattern::checkerboard, Pattern::quarter}) {
        Image expected = full;
        interpolate(pattern, Interpolation::float32, expected);
        EXPECT_TRUE(gpu.render(size, {pattern}).pixels == expected.pixels)
            << toString(pattern) << " " << size.width << "x" << size.height;

        expected = full;
        interpolate(pattern, Interpolation::bits8, expected);
        const Image picture = gpu.render(size, {pattern, Interpolation::bits8});
        for (std::size_t n = 0; n < picture.pixels.size(); ++n) {
          constexpr float kLevel = 1.0F / 255 + 1e-6F;  // a source pixel may be on the edge between two
          EXPECT_NEAR(picture.pixels[n].r, expected.pixels[n].r, kLevel) << toString(pattern);
          EXPECT_NEAR(picture.pixels[n].a, expected.pixels[n].a, kLevel) << toString(pattern);
        }
      }
    }
  }
}

TEST(CudaCast, InterpolatedPicturesEqualCpu) {
  EMSCAPE_NEEDS_GPU();
  std::mt19937 random(26);
  Renderer cpu, gpu(onGpu());
  Agreement all;
  for (int scene = 0; scene < 6; ++scene) {
    for (const ImageSize size : kEvenAndOddSizes) {
      setSameRandomScene(cpu, gpu, random, size);
      cpu.render(size);  // finds the ground; until then the CPU interpolates it too
      for (const Pattern pattern : {Pattern::columns, Pattern::checkerboard, Pattern::quarter}) {
        for (const Interpolation interpolation : {Interpolation::float32, Interpolation::bits8}) {
          all.add(gpu.render(size, {pattern, interpolation}), cpu.render(size, {pattern, interpolation}));
        }
      }
    }
  }
  EXPECT_LE(all.shareApart(), kShareApart);
}

TEST(CudaCast, QuantizedPictureEqualsQuantizationOnHost) {
  EMSCAPE_NEEDS_GPU();
  std::mt19937 random(25);
  Renderer gpu(onGpu());
  for (const ImageSize size : kEvenAndOddSizes) {
    setRandomScene(gpu, random, size);
    for (const Pattern pattern : allPatterns()) {
      for (const Interpolation interpolation : {Interpolation::float32, Interpolation::bits8}) {
        gpu.draw({pattern, interpolation}, size);
        Image image;
        Image8 image8;
        gpu.fetch(image);
        gpu.fetch(image8);
        const Image8 expected = quantize(image);
        ASSERT_EQ(image8.rgba.size(), expected.rgba.size());
        for (std::size_t n = 0; n < expected.rgba.size(); ++n) {
          EXPECT_NEAR(image8.rgba[n], expected.rgba[n], 1) << toString(pattern);  // on the edge of a level
        }
      }
    }
  }
}

TEST(CudaCast, PicturesDoNotDependOnPreviousOnes) {
  EMSCAPE_NEEDS_GPU();
  // Another view, mode or size before must leave nothing behind.
  std::mt19937 random(27);
  Renderer kept(onGpu());
  const ImageSize sizes[] = {{400, 300}, {401, 300}, {100, 400}};
  for (int frame = 0; frame < 60; ++frame) {
    const ImageSize size = sizes[random() % 3];
    const auto mode = random() % 3 == 0 ? CompositingMode::mida : CompositingMode::dvr;
    const Pattern pattern = allPatterns()[random() % (allPatterns().size() - 1)];
    CameraSpec view;
    view.azimuth_deg = static_cast<double>(random() % 360);
    view.distance = 0.5 + 0.5 * static_cast<double>(random() % 4);
    const auto draw = [&](Renderer& renderer) {
      setEmeScene(renderer, mode, false, size);
      renderer.setCamera(makeCamera(view, renderer.sceneBox(), size));
      return renderer.render(size, {pattern});
    };
    Renderer fresh(onGpu());
    EXPECT_TRUE(draw(kept).pixels == draw(fresh).pixels) << frame << " " << toString(pattern);
  }
}

TEST(CudaCast, ReportsRaysAndTimes) {
  EMSCAPE_NEEDS_GPU();
  const ImageSize size{200, 150};
  Renderer gpu(onGpu());
  EXPECT_EQ(gpu.backend(), Backend::cuda);
  setEmeScene(gpu, CompositingMode::dvr, false, size);
  const FrameReport report = gpu.draw({Pattern::quarter}, size);
  EXPECT_TRUE(report.complete);
  EXPECT_EQ(report.rays, 100 * 75);
  EXPECT_GT(report.cast_ms, 0);
  EXPECT_EQ(gpu.restore().rays, 200 * 150 - 100 * 75);
}

TEST(CudaCast, IsRefusedWhereThereIsNoGpu) {
  if (findDevice().usable) GTEST_SKIP() << "there is a GPU";
  EXPECT_THAT(test::errorOf([] { Renderer gpu(onGpu()); }, ErrorCode::device),
              ::testing::HasSubstr("backend cuda: "));
}

}  // namespace
}  // namespace emscape::render
