#include "render/scene/silhouette.h"

#include <gtest/gtest.h>

#include <random>

namespace emscape::render {
namespace {

const Vec3d kLower{-0.5, -0.5, -0.5};

bool meets(const CameraView& camera, const Vec3d& upper, int x, int y) {
  const RayInterval inside = clip(camera.ray(x, y), kLower, upper);
  return inside.end > inside.begin;
}

/// Compares a silhouette with a test of every single ray.
void expectExact(const CameraView& camera, const Vec3d& upper, const std::string& name) {
  Silhouette silhouette;
  findSilhouette(camera, kLower, upper, silhouette);
  ASSERT_EQ(silhouette.rows.size(), static_cast<std::size_t>(camera.size.height));
  long long wrong = 0;
  long long hits = 0;
  for (int y = 0; y < camera.size.height; ++y) {
    for (int x = 0; x < camera.size.width; ++x) {
      const bool hit = meets(camera, upper, x, y);
      hits += hit ? 1 : 0;
      wrong += hit != silhouette.rows[static_cast<std::size_t>(y)].contains(x) ? 1 : 0;
    }
  }
  EXPECT_EQ(wrong, 0) << name << " of " << hits << " at " << camera.size.width << "x" << camera.size.height;
  EXPECT_EQ(silhouette.count(), hits) << name;
}

/// A view whose axes are scaled by voxels that are not cubes.
CameraView viewFrom(const Vec3d& eye, const Vec3d& target, const Vec3d& scale, ImageSize size) {
  const auto scaled = [&](const Vec3d& v) { return Vec3d{v.x * scale.x, v.y * scale.y, v.z * scale.z}; };
  CameraView view;
  view.eye = eye;
  const Vec3d toward = target - eye;
  const Vec3d forward = normalized(Vec3d{toward.x / scale.x, toward.y / scale.y, toward.z / scale.z});
  const Vec3d right = normalized(cross(forward, Vec3d{0.01, 0.02, 1}));
  view.forward = scaled(forward);
  view.right = scaled(right);
  view.up = scaled(cross(right, forward));
  view.size = size;
  return view;
}

TEST(Silhouette, EqualsRaysOfAllPixelsForAnyCamera) {
  std::mt19937 random(5);
  const auto between = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  for (int n = 0; n < 400; ++n) {
    const Vec3d upper{between(0.5, 60), between(0.5, 60), between(0.5, 40)};
    const double far = n % 3 == 0 ? 20 : 150;  // a third of the eyes are in the box or close to it
    const Vec3d eye{between(-far, far), between(-far, far), between(-far, far)};
    const Vec3d target{between(0, upper.x), between(0, upper.y), between(0, upper.z)};
    const ImageSize size{1 + static_cast<int>(random() % 70), 1 + static_cast<int>(random() % 70)};
    CameraView view = viewFrom(eye, target, {1, between(0.3, 3), between(0.3, 3)}, size);
    view.orthographic = n % 4 == 0;
    view.half_height = view.orthographic ? between(1, 60) : between(0.05, 2);
    view.shift_x = between(-0.3, 0.3);
    view.shift_y = between(-0.3, 0.3);
    expectExact(view, upper, "view " + std::to_string(n));
  }
}

TEST(Silhouette, FillsThePictureFromInsideTheBox) {
  CameraView view = viewFrom({5, 6, 7}, {50, 3, 4}, {1, 1, 1}, {40, 30});
  Silhouette silhouette;
  findSilhouette(view, kLower, {20, 20, 20}, silhouette);
  EXPECT_EQ(silhouette.count(), 40 * 30);
}

TEST(Silhouette, IsEmptyForABoxBehindTheEye) {
  CameraView view = viewFrom({-100, 5, 5}, {-200, 5, 5}, {1, 1, 1}, {40, 30});
  Silhouette silhouette;
  findSilhouette(view, kLower, {20, 20, 20}, silhouette);
  EXPECT_EQ(silhouette.count(), 0);
  view.orthographic = true;
  view.half_height = 50;
  findSilhouette(view, kLower, {20, 20, 20}, silhouette);
  EXPECT_EQ(silhouette.count(), 0);
}

TEST(Silhouette, IsExactForABoxAcrossTheEyesPlane) {
  for (const bool orthographic : {false, true}) {
    CameraView view = viewFrom({10, -3, 25}, {10, 100, 25}, {1, 1, 1}, {90, 70});
    view.orthographic = orthographic;
    view.half_height = orthographic ? 40 : 1.2;
    view.eye.y = 8;  // beside the box, whose ends lie before and behind it
    expectExact(view, {20, 20, 20}, "across");
  }
}

TEST(Silhouette, IsExactForViewsAlongAnAxis) {
  for (const ImageSize size : {ImageSize{1, 1}, ImageSize{64, 64}, ImageSize{33, 20}}) {
    for (const bool orthographic : {false, true}) {
      CameraView view;
      view.eye = {9.5, 9.5, 100};
      view.forward = {0, 0, -1};
      view.right = {1, 0, 0};
      view.up = {0, 1, 0};
      view.half_height = orthographic ? 16 : 0.2;
      view.orthographic = orthographic;
      view.size = size;
      expectExact(view, {19.5, 19.5, 9.5}, "axis");
    }
  }
}

TEST(WideSilhouette, HoldsRaysInTheBoxesFaces) {
  CameraView view;
  view.eye = {9.5, 9.5, 100};
  view.forward = {0, 0, -1};
  view.right = {1, 0, 0};
  view.up = {0, 1, 0};
  view.half_height = 16;
  view.orthographic = true;
  view.size = {41, 32};  // the ray of pixel (x, y) runs through (x - 10.5, 25 - y), exactly
  const Vec3d upper{19.5, 19.5, 9.5};
  Silhouette exact, wide;
  findSilhouette(view, kLower, upper, exact);
  findWideSilhouette(view, kLower, upper, wide);
  for (int y = 0; y < view.size.height; ++y) {
    const bool is_inside = y >= 6 && y <= 25;
    const Span& narrow_row = exact.rows[static_cast<std::size_t>(y)];
    const Span& wide_row = wide.rows[static_cast<std::size_t>(y)];
    EXPECT_EQ(narrow_row.begin, is_inside ? 11 : 0) << y;
    EXPECT_EQ(narrow_row.end, is_inside ? 30 : 0) << y;
    EXPECT_EQ(wide_row.begin, is_inside ? 10 : 0) << y;
    EXPECT_EQ(wide_row.end, is_inside ? 31 : 0) << y;
  }
}

TEST(NarrowSilhouette, KeepsEveryPixelWhoseRayMeetsABox) {
  std::mt19937 random(8);
  const auto between = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  const Vec3d upper{31.5, 23.5, 15.5};
  for (int n = 0; n < 200; ++n) {
    const double far = n % 3 == 0 ? 20 : 120;
    CameraView view = viewFrom({between(-far, far), between(-far, far), between(-far, far)}, {15, 12, 8},
                               {1, between(0.3, 3), 1}, {50, 40});
    view.orthographic = n % 4 == 0;
    view.half_height = view.orthographic ? 25 : 0.5;
    std::vector<IndexBox> boxes;
    for (int i = 0; i < n % 4; ++i) {
      const Vec3d low{between(0, 20), between(0, 15), between(0, 10)};
      boxes.push_back({low, low + Vec3d{between(1, 10), between(1, 8), between(1, 5)}});
    }
    Silhouette whole;
    findSilhouette(view, kLower, upper, whole);
    Silhouette narrowed = whole;
    narrowSilhouette(view, boxes, narrowed);
    EXPECT_LE(narrowed.count(), whole.count());
    for (int y = 0; y < view.size.height; ++y) {
      const Span& row = narrowed.rows[static_cast<std::size_t>(y)];
      for (int x = 0; x < view.size.width; ++x) {
        for (const IndexBox& box : boxes) {
          const RayInterval inside = clip(view.ray(x, y), box.lower, box.upper);
          if (inside.end > inside.begin) {
            EXPECT_TRUE(row.contains(x)) << n << ": " << x << ", " << y;
          }
        }
      }
    }
    if (boxes.empty()) {
      EXPECT_EQ(narrowed.count(), 0);
    }
  }
}

TEST(NarrowSilhouette, BoxesHoldTheBricksThatMayShow) {
  std::vector<float> levels(4 * 3 * 2, 0.5F);
  const auto brick = [](int x, int y, int z) { return static_cast<std::size_t>((z * 3 + y) * 4 + x); };
  levels[brick(1, 0, 0)] = SkipView::kNever;
  levels[brick(2, 0, 0)] = SkipView::kNever;
  levels[brick(3, 2, 1)] = SkipView::kNever;
  const SkipView skip{nullptr, levels.data(), {4, 3, 2}};
  const std::vector<IndexBox> boxes = visibleBoxes(skip, {30, 20, 10});
  ASSERT_EQ(boxes.size(), 2U);
  EXPECT_NEAR(boxes[0].lower.x, 8, 0.1);
  EXPECT_NEAR(boxes[0].upper.x, 24, 0.1);
  EXPECT_LT(boxes[0].lower.y, -0.5);  // the outer bricks reach beyond the volume's box
  EXPECT_GT(boxes[1].upper.x, 29.5);
  EXPECT_GT(boxes[1].upper.y, 19.5);
  EXPECT_GT(boxes[1].upper.z, 9.5);
  EXPECT_NEAR(boxes[1].lower.x, 24, 0.1);
}

}  // namespace
}  // namespace emscape::render
