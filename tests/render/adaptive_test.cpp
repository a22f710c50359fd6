#include "render/patterns/adaptive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "emscape/base/parallel.h"
#include "emscape/render/scene/renderer.h"
#include "render/patterns/adaptive_predict.h"
#include "tests/render/scenes.h"

namespace emscape::render {
namespace {

using Picture = std::function<Rgba(int, int)>;

Rgba gray(double value) {
  const auto v = static_cast<float>(value);
  return {v, v, v, v};
}

Silhouette whole(ImageSize size) {
  Silhouette silhouette;
  wholePicture(size, silhouette);
  return silhouette;
}

/// Draws frames of a known picture, and counts how often each pixel was cast.
struct Drawing {
  Picture picture;
  Image image;
  std::vector<int> casts;
  AdaptiveFrame frame;
  long long rays = 0;

  Drawing(ImageSize size, Picture value)
      : picture(std::move(value)), image(size), casts(static_cast<std::size_t>(size.count())) {}

  void cast(const std::vector<Pixel>& pixels) {
    rays += static_cast<long long>(pixels.size());
    for (const Pixel& p : pixels) {
      image.at(p.x, p.y) = picture(p.x, p.y);
      ++casts[static_cast<std::size_t>(p.y) * image.size.width + p.x];
    }
  }
  void draw(const Silhouette& inside, double tolerance_levels, double max_rays = 1e9) {
    std::fill(casts.begin(), casts.end(), 0);
    for (Rgba& pixel : image.pixels) pixel = gray(std::nan(""));
    rays = 0;
    EXPECT_TRUE(
        frame.draw(image, inside, tolerance_levels, max_rays, [this](const std::vector<Pixel>& pixels) {
          cast(pixels);
          return true;
        }));
  }
  void draw(double tolerance_levels) { draw(whole(image.size), tolerance_levels); }
  double largestError_levels() const {
    double largest = 0;
    for (int y = 0; y < image.size.height; ++y) {
      for (int x = 0; x < image.size.width; ++x) {
        largest = std::max(largest, 255.0 * std::abs(image.at(x, y).r - picture(x, y).r));
      }
    }
    return largest;
  }
};

double ripple(double x, double y) {
  return 0.5 + 0.3 * std::sin(0.11 * x + 0.02 * y) * std::cos(0.07 * y);
}

TEST(Adaptive, CastAndMissingPixelsPartitionEverySize) {
  std::mt19937 random(1);
  const auto noise = [](int x, int y) { return gray(std::fmod(0.137 * x * y + 0.31 * x, 1.0)); };
  for (int height = 1; height <= 21; ++height) {
    for (int width = 1; width <= 21; ++width) {
      Drawing drawing({width, height}, noise);
      Silhouette inside = whole({width, height});
      for (Span& row : inside.rows) {
        if (random() % 2 == 0) continue;
        row.begin = static_cast<int>(random() % static_cast<unsigned>(width));
        row.end = row.begin + static_cast<int>(random() % static_cast<unsigned>(width - row.begin + 1));
      }
      drawing.draw(inside, 20);
      long long cast = 0;
      for (const int times : drawing.casts) cast += times;
      EXPECT_EQ(drawing.rays, cast);
      drawing.cast(drawing.frame.missing());
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          const bool shown = inside.rows[static_cast<std::size_t>(y)].contains(x);
          EXPECT_EQ(drawing.casts[static_cast<std::size_t>(y) * width + x], shown ? 1 : 0);
          EXPECT_EQ(drawing.image.at(x, y), shown ? noise(x, y) : Rgba{});
        }
      }
    }
  }
}

TEST(Adaptive, WritesEveryPixelOfEverySize) {
  for (int height = 1; height <= 21; ++height) {
    for (int width = 1; width <= 21; ++width) {
      Drawing drawing({width, height}, [](int, int) { return gray(0.4); });
      drawing.draw(0);
      for (const Rgba& pixel : drawing.image.pixels) EXPECT_FLOAT_EQ(pixel.a, 0.4F);
    }
  }
}

TEST(Adaptive, CastsTheLatticeAndTheEdgesAloneWhereThePictureIsLinear) {
  Drawing drawing({121, 81}, [](int x, int y) { return gray(0.001 * x + 0.002 * y); });
  drawing.draw(0.01);
  EXPECT_EQ(drawing.rays, 31 * 21 + 2 * (120 - 30) + 2 * (80 - 20));
  EXPECT_LT(drawing.largestError_levels(), 1e-3);
}

TEST(Adaptive, KeepsAboutToTheToleranceWhereThePictureIsSmooth) {
  for (const double tolerance : {0.05, 0.5, 2.0}) {
    Drawing drawing({160, 120}, [](int x, int y) { return gray(ripple(x, y)); });
    drawing.draw(tolerance);
    EXPECT_LT(drawing.largestError_levels(), 1.1 * tolerance);
  }
}

TEST(Adaptive, FewerRaysForALargerTolerance) {
  Drawing drawing({160, 120}, [](int x, int y) { return gray(ripple(4 * x, 4 * y)); });
  long long last = drawing.image.size.count() + 1;
  for (const double tolerance : {0.0, 0.1, 0.5, 2.0, 8.0, 64.0}) {
    drawing.draw(tolerance);
    EXPECT_LT(drawing.rays, last) << tolerance;
    last = drawing.rays;
  }
}

TEST(Adaptive, FindsEdgesWhereverTheyRun) {
  for (int n = 0; n < 24; ++n) {
    const double angle = 0.2617 * n;
    Drawing drawing({97, 89}, [&](int x, int y) {
      return gray((x - 47) * std::cos(angle) + (y - 43) * std::sin(angle) < 0.3 * n ? 0.2 : 0.9);
    });
    drawing.draw(0.5);
    EXPECT_LT(drawing.largestError_levels(), 1) << n;
    EXPECT_LT(drawing.rays, 97 * 89 / 4) << n;
  }
}

TEST(Adaptive, FindsOutlinesOfEvenlyFilledSilhouette) {
  const ImageSize size{96, 96};
  Silhouette disk;
  for (int y = 0; y < size.height; ++y) {
    const int half = static_cast<int>(std::sqrt(std::max(0, 1600 - (y - 48) * (y - 48))));
    disk.rows.push_back(half > 0 ? Span{48 - half, 48 + half} : Span{});
  }
  Drawing drawing(size, [&](int x, int y) {
    return disk.rows[static_cast<std::size_t>(y)].contains(x) ? gray(0.7) : Rgba{};
  });
  drawing.draw(disk, 0.5);
  EXPECT_LT(drawing.largestError_levels(), 1);
}

TEST(Adaptive, PredictionEqualsHostDeviceFunction) {
  const auto color = [](int x, int y) {
    return Rgba{static_cast<float>(ripple(x, y)), static_cast<float>(ripple(y, x)),
                static_cast<float>(ripple(2 * x, y)), 0.9F};
  };
  Drawing drawing({64, 64}, color);
  drawing.draw(1e6);  // only the lattice is cast
  const Image& image = drawing.image;
  const auto along = [&](int x, int y, int dx, int dy) {
    return predictAlong(image.at(x - dx, y - dy), image.at(x + dx, y + dy), image.at(x - 3 * dx, y - 3 * dy),
                        image.at(x + 3 * dx, y + 3 * dy));
  };
  const auto expectNear = [&](int x, int y, const Rgba& expected) {
    EXPECT_NEAR(image.at(x, y).r, expected.r, 1e-6) << x << " " << y;
    EXPECT_NEAR(image.at(x, y).g, expected.g, 1e-6) << x << " " << y;
    EXPECT_NEAR(image.at(x, y).b, expected.b, 1e-6) << x << " " << y;
    EXPECT_NEAR(image.at(x, y).a, expected.a, 1e-6) << x << " " << y;
  };
  for (int y = 12; y < 48; ++y) {
    for (int x = 12; x < 48; ++x) {
      const int reach = x % 2 == 0 && y % 2 == 0 ? 2 : 1;
      if (x % (2 * reach) == 0 && y % (2 * reach) == 0) continue;
      const bool is_center = x % (2 * reach) != 0 && y % (2 * reach) != 0;
      expectNear(x, y,
                 is_center ? predict(along(x, y, reach, reach), along(x, y, reach, -reach)).color
                           : predict(along(x, y, reach, 0), along(x, y, 0, reach)).color);
    }
  }
}

TEST(Adaptive, StaysWithinRayBudgetAfterSomeFrames) {
  const ImageSize size{200, 200};
  Drawing drawing(size,
                  [](int x, int y) { return gray(0.5 + 0.2 * std::sin(0.35 * x) * std::sin(0.3 * y)); });
  const Silhouette all = whole(size);
  drawing.draw(all, 0.5);
  EXPECT_GT(drawing.rays, size.count() / 2);
  const double max_rays = 0.25 * static_cast<double>(size.count());
  for (int frame = 0; frame < 12; ++frame) drawing.draw(all, 0.5, max_rays);
  EXPECT_NEAR(drawing.rays, max_rays, 0.05 * max_rays);
  for (int frame = 0; frame < 20; ++frame) drawing.draw(all, 0.5);
  EXPECT_GT(drawing.rays, size.count() / 2) << "the tolerance is that asked for again";
}

TEST(Adaptive, MissingPixelsComeWorstFirst) {
  Drawing drawing({128, 128}, [](int x, int y) {
    return gray(0.5 + 0.4 * std::sin(0.3 * x) * std::sin(0.31 * y) * std::exp(-0.05 * y));
  });
  drawing.draw(16);
  const std::vector<Pixel> missing = drawing.frame.missing();
  const auto meanError = [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Pixel p = missing[i];
      sum += std::abs(drawing.image.at(p.x, p.y).r - drawing.picture(p.x, p.y).r);
    }
    return sum / static_cast<double>(end - begin);
  };
  const std::size_t quarter = missing.size() / 4;
  EXPECT_GT(meanError(0, quarter), 2 * meanError(quarter, 2 * quarter));
  EXPECT_GT(meanError(quarter, 2 * quarter), 3 * meanError(3 * quarter, missing.size()));
}

TEST(Adaptive, DoesNotDependOnNumberOfThreads) {
  std::vector<Pixel> first;
  for (const int threads : {1, 4}) {
    setThreadLimit(threads);
    Drawing drawing({300, 200}, [](int x, int y) { return gray(ripple(7 * x, 3 * y)); });
    std::vector<Pixel> order;
    Silhouette inside = whole(drawing.image.size);
    drawing.frame.draw(drawing.image, inside, 0.5, 1e9, [&](const std::vector<Pixel>& pixels) {
      drawing.cast(pixels);
      order.insert(order.end(), pixels.begin(), pixels.end());
      return true;
    });
    const std::vector<Pixel>& missing = drawing.frame.missing();
    order.insert(order.end(), missing.begin(), missing.end());
    if (threads == 1) first = order;
    ASSERT_EQ(order.size(), first.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      ASSERT_TRUE(order[i].x == first[i].x && order[i].y == first[i].y) << i;
    }
  }
  setThreadLimit(0);
}

TEST(Adaptive, ReportsThatItWasStopped) {
  for (int passes = 0; passes < 3; ++passes) {
    Image image({50, 40});
    for (Rgba& pixel : image.pixels) pixel = gray(1);
    AdaptiveFrame frame;
    int left = passes;
    EXPECT_FALSE(frame.draw(image, whole(image.size), 0.5, 1e9, [&](const std::vector<Pixel>& pixels) {
      for (const Pixel& p : pixels) image.at(p.x, p.y) = gray(std::fmod(p.x * 0.37, 1));
      return left-- > 0;
    }));
  }
}

/// How pictures of a pattern differ from the full one.
ImageDifference differenceOf(Renderer& renderer, ImageSize size, const FramePlan& plan, long long& rays) {
  FrameReport report;
  const Image8 picture = quantize(renderer.render(size, plan, &report));
  rays = report.rays;
  return compare(picture, quantize(renderer.render(size)));
}

TEST(Adaptive, IsFarBetterThanQuarterOnAnEmeVolumeWithFewerRays) {
  const auto volume = testing::makeEmeVolume({64, 64, 32});
  const ImageSize size{480, 360};
  Renderer renderer;
  renderer.setVolume(volume);
  renderer.setTransferFunction(defaultTransferFunction(*volume));
  renderer.setCamera(makeCamera({}, renderer.sceneBox(), size));
  long long quarter_rays = 0;
  long long rays = 0;
  const ImageDifference quarter = differenceOf(renderer, size, {Pattern::quarter}, quarter_rays);
  const ImageDifference adaptive = differenceOf(renderer, size, {Pattern::adaptive}, rays);
  EXPECT_LT(rays, quarter_rays);
  EXPECT_GT(adaptive.psnr_db, quarter.psnr_db + 8);
}

TEST(Adaptive, SkipsTransparentPixelsAndRestoresThem) {
  // A small ball in a large empty box, seen from outside and inside.
  const auto volume = testing::makeVolume({64, 48, 40}, {1, 1, 1}, [](int i, int j, int k) {
    return std::hypot(i - 40, j - 20, k - 12) < 6 ? 0.8F : 0.1F;
  });
  const ImageSize size{90, 70};
  Renderer renderer;
  renderer.setVolume(volume);
  renderer.setTransferFunction(
      testing::makeFunction({{0, {1, 1, 1}}}, {{0, 0}, {0.2, 0}, {0.3, 0.2}, {1, 0.4}}));
  for (int n = 0; n < 24; ++n) {
    CameraSpec camera;
    camera.azimuth_deg = 15 * n;
    camera.elevation_deg = 7 * n - 80;
    camera.projection = n % 3 == 0 ? Projection::orthographic : Projection::perspective;
    if (n % 4 == 1) camera.distance = 0.2;
    renderer.setCamera(makeCamera(camera, renderer.sceneBox(), size));
    const Image full = renderer.render(size);
    FrameReport report;
    Image image = renderer.render(size, {Pattern::adaptive}, &report);
    EXPECT_LT(report.rays, size.count() / 3);
    renderer.restore(image);
    EXPECT_TRUE(image.pixels == full.pixels) << n;
  }
}

TEST(AdaptiveTolerance, ApproachesABudgetWithoutSwinging) {
  for (const double start : {0.07, 0.5, 30.0}) {
    for (const double exponent : {0.2, 0.5, 1.0}) {
      const auto cost = [&](double tolerance) { return 5 + 10 * std::pow(tolerance, -exponent); };
      double tolerance = start;
      for (int frame = 0; frame < 60; ++frame) {
        const double error = cost(tolerance) - 12;
        tolerance = nextTolerance_levels(tolerance, cost(tolerance), 12);
        const double next_error = cost(tolerance) - 12;
        EXPECT_LE(std::abs(next_error), std::abs(error) + 1e-9);
      }
      EXPECT_NEAR(cost(tolerance), 12, 0.2) << start << " " << exponent;
    }
  }
}

TEST(AdaptiveTolerance, StaysInItsBoundsAndMovesAtMostByAFactorOfTwo) {
  EXPECT_EQ(nextTolerance_levels(1, 1000, 1), 2);
  EXPECT_EQ(nextTolerance_levels(1, 0, 1), 0.5);
  double tolerance = 1;
  for (int frame = 0; frame < 20; ++frame) tolerance = nextTolerance_levels(tolerance, 1000, 1);
  EXPECT_EQ(tolerance, kMaxTolerance_levels);
  for (int frame = 0; frame < 20; ++frame) tolerance = nextTolerance_levels(tolerance, 0, 1);
  EXPECT_EQ(tolerance, kMinTolerance_levels);
}

}  // namespace
}  // namespace emscape::render
