#include "render/patterns/edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "emscape/render/scene/renderer.h"
#include "tests/render/random_scene.h"
#include "tests/support/on_backends.h"

namespace emscape::render {
namespace {

using testing::makeGround;
using testing::on;
using testing::setRandomScene;

FramePlan smooth() {
  return FramePlan::exact();
}

/// An opaque slope under an empty volume, from the side: its silhouette crosses the picture.
void setSlope(Renderer& renderer, ImageSize size) {
  const auto volume = testing::makeVolume({8, 8, 8}, {100, 100, 100}, [](int, int, int) { return 0.0F; });
  renderer.setVolume(volume);
  renderer.setTransferFunction(testing::fog(0));
  renderer.setHeightField(makeGround(volume->grid, 9, [](double x, double) { return 120 + 0.37 * x; }));
  CameraSpec camera;
  camera.azimuth_deg = 180;
  camera.elevation_deg = 0;
  camera.projection = Projection::orthographic;
  renderer.setCamera(makeCamera(camera, renderer.sceneBox(), size));
}

TEST(Edges, RaysOfAPixelHaveDifferentPositionsAlongEachAxis) {
  CameraView camera;
  camera.size = {40, 30};
  std::set<double> columns, rows;
  double column = 0, row = 0;
  for (int n = 0; n < kEdgeRays; ++n) {
    const CameraView shifted = edgeCamera(camera, n);
    const double x = shifted.shift_x * camera.size.height / 2, y = -shifted.shift_y * camera.size.height / 2;
    EXPECT_LT(std::abs(x), 0.5);
    EXPECT_LT(std::abs(y), 0.5);
    columns.insert(x);
    rows.insert(y);
    column += x;
    row += y;
  }
  EXPECT_EQ(columns.size(), std::size_t{kEdgeRays});
  EXPECT_EQ(rows.size(), std::size_t{kEdgeRays});
  EXPECT_NEAR(column, 0, 1e-12) << "around the middle of the pixel";
  EXPECT_NEAR(row, 0, 1e-12);
}

TEST(Edges, AreTheHighestContrastsOfASixtyFourthOfThePicture) {
  const ImageSize size{640, 640};
  ASSERT_EQ(maxEdgePixels(size), 6400);
  ContrastCounts counts{};
  counts[0] = 31000;
  counts[11] = 300;
  EXPECT_EQ(edgeContrast_levels(counts, size), 12) << "as low as that";
  counts[40] = 6000;
  counts[200] = 390;
  EXPECT_EQ(edgeContrast_levels(counts, size), 12);
  counts[20] = 11;
  EXPECT_EQ(edgeContrast_levels(counts, size), 21);
  counts[255] = 6401;
  EXPECT_EQ(edgeContrast_levels(counts, size), 256) << "noise has no edges";
}

TEST(Edges, OfThePictureAreThePixelsOfTheirContrast) {
  std::mt19937 random(8);
  for (const ImageSize size : {ImageSize{1, 1}, ImageSize{1, 7}, ImageSize{9, 1}, ImageSize{37, 53}}) {
    Image image(size);
    for (Rgba& pixel : image.pixels) {
      const auto level = [&] { return static_cast<float>(random() % 30) / 255; };
      pixel = {level(), level(), level(), level()};
    }
    const Image8 bytes = quantize(image);
    const auto contrastAt = [&](int x, int y) {
      return contrast_levels(size, x, y, [&](int at_x, int at_y) { return bytes.at(at_x, at_y); });
    };
    ContrastCounts counts{};
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) ++counts[static_cast<std::size_t>(contrastAt(x, y))];
    const int least = edgeContrast_levels(counts, size);
    std::set<std::pair<int, int>> expected, found;
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        if (contrastAt(x, y) >= least) expected.insert({x, y});
    for (const Pixel& pixel : edgePixels(image)) found.insert({pixel.x, pixel.y});
    EXPECT_EQ(found, expected) << size.width << "x" << size.height;
  }
}

class SmoothEdges : public test::OnBackends {};
EMSCAPE_ON_BACKENDS(SmoothEdges);

TEST_P(SmoothEdges, CoverageOfASilhouetteIsNearTheExactArea) {
  Renderer renderer(on(GetParam()));
  const ImageSize size{120, 90};
  setSlope(renderer, size);
  const Image stairs = renderer.render(size), smoothed = renderer.render(size, smooth());
  // Along a row the exact edge is a straight line; its area in a pixel is the mean over many pictures that
  // are shifted by parts of a pixel.
  constexpr int kParts = 16;
  Image exact(size);
  const Camera camera = renderer.camera();
  for (int n = 0; n < kParts * kParts; ++n) {
    Camera shifted = camera;
    shifted.shift_x += ((n % kParts + 0.5) / kParts - 0.5) * 2 / size.height;
    shifted.shift_y += ((n / kParts + 0.5) / kParts - 0.5) * 2 / size.height;
    renderer.setCamera(shifted);
    const Image part = renderer.render(size);
    for (std::size_t p = 0; p < exact.pixels.size(); ++p)
      exact.pixels[p].a += part.pixels[p].a / (kParts * kParts);
  }
  double largest = 0, largest_of_stairs = 0;
  for (std::size_t p = 0; p < exact.pixels.size(); ++p) {
    largest = std::max(largest, std::abs(double{smoothed.pixels[p].a} - double{exact.pixels[p].a}));
    largest_of_stairs =
        std::max(largest_of_stairs, std::abs(double{stairs.pixels[p].a} - double{exact.pixels[p].a}));
  }
  EXPECT_GT(largest_of_stairs, 0.45);
  EXPECT_LE(largest, 0.26);
}

TEST_P(SmoothEdges, RestoredPicturesEqualThoseThatAreCastInFull) {
  std::mt19937 random(9);
  Renderer renderer(on(GetParam()));
  for (int scene = 0; scene < 30; ++scene) {
    const ImageSize size{1 + static_cast<int>(random() % 60), 1 + static_cast<int>(random() % 60)};
    setRandomScene(renderer, random, size);
    if (scene % 3 == 0) testing::addRandomPlanes(renderer, random);
    const Image as_cast = renderer.render(size), full = renderer.render(size, smooth());
    for (const Pattern pattern : allPatterns()) {
      Image image = renderer.render(size, {pattern});
      EXPECT_TRUE(renderer.restore(image, nullptr, Edges::smooth).complete);
      EXPECT_TRUE(image.pixels == full.pixels) << scene << " " << toString(pattern);
    }
    EXPECT_TRUE(renderer.render(size).pixels == as_cast.pixels) << "smoothing leaves nothing behind";
  }
}

TEST_P(SmoothEdges, APictureThatIsStoppedIsTheSameWhenItIsDrawnAgain) {
  std::mt19937 random(10);
  Renderer renderer(on(GetParam()));
  const ImageSize size{60, 50};
  setRandomScene(renderer, random, size);
  const Image full = renderer.render(size, smooth());
  Image image = renderer.render(size, {Pattern::quarter});
  StopFlag stop{true};
  EXPECT_FALSE(renderer.restore(image, &stop, Edges::smooth).complete);
  stop = false;
  EXPECT_TRUE(renderer.restore(image, &stop, Edges::smooth).complete);
  EXPECT_TRUE(image.pixels == full.pixels);
}

TEST_P(SmoothEdges, OnlySomePixelsAreCastAgain) {
  std::mt19937 random(11);
  Renderer renderer(on(GetParam()));
  for (int scene = 0; scene < 5; ++scene) {
    const ImageSize size{300, 280};
    setRandomScene(renderer, random, size);
    FrameReport report;
    renderer.render(size, smooth(), &report);
    EXPECT_LE(report.rays, size.count() + maxEdgePixels(size) * kEdgeRays);
  }
}

}  // namespace
}  // namespace emscape::render
