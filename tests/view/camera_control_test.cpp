#include "apps/view/tools/camera_control.h"

#include <gtest/gtest.h>

#include <cmath>

namespace emscape::view {
namespace {

const Viewport kViewport{{{-10000, -10000, 0}, {10000, 10000, 5000}, 2}, {800, 600}, {0.04, 0.15, 0.1, 0.08}};

render::Camera cameraOf(const CameraControl& control) {
  return render::makeCamera(control.spec(), kViewport.box, kViewport.size, kViewport.margins);
}

render::Projected pixelOf(const CameraControl& control, const Vec3d& frame_m) {
  return render::project(cameraOf(control), kViewport.size, kViewport.box.toDrawn(frame_m));
}

TEST(CameraControl, TheFirstMovementOfAFittedCameraDoesNotJump) {
  CameraControl control;
  const render::Projected before = pixelOf(control, {0, 0, 2500});
  control.orbit(0, 0, kViewport);
  ASSERT_TRUE(control.spec().distance);
  const render::Projected after = pixelOf(control, {0, 0, 2500});
  EXPECT_NEAR(after.x, before.x, 0.02 * kViewport.size.width);
  EXPECT_NEAR(after.y, before.y, 0.02 * kViewport.size.height);
  const double width_before = pixelOf(CameraControl(), {10000, 0, 2500}).x - before.x;
  EXPECT_NEAR(pixelOf(control, {10000, 0, 2500}).x - after.x, width_before, 0.03 * std::abs(width_before));
}

TEST(CameraControl, OrbitTurnsAndStopsAtTheZenith) {
  CameraControl control(render::parseCamera("orbit:azimuth_deg=350,elevation_deg=80,distance=1.5"));
  control.orbit(20, 30, kViewport);
  EXPECT_NEAR(control.spec().azimuth_deg, 10, 1e-9);
  EXPECT_DOUBLE_EQ(control.spec().elevation_deg, 90);
  EXPECT_DOUBLE_EQ(*control.spec().distance, 1.5);
}

TEST(CameraControl, PanMovesTheTargetWithTheCursor) {
  CameraControl control(render::parseCamera("orbit:distance=1.5"));
  control.orbit(0, 0, kViewport);
  const Vec3d target_m = *control.spec().target_m;
  const render::Projected before = pixelOf(control, target_m);
  control.pan(37, -21, kViewport);
  const render::Projected after = pixelOf(control, target_m);
  EXPECT_NEAR(after.x - before.x, 37, 1);
  EXPECT_NEAR(after.y - before.y, -21, 1);
}

TEST(CameraControl, DollyKeepsThePointUnderTheCursor) {
  CameraControl control(render::parseCamera("orbit:distance=1.5"));
  control.orbit(0, 0, kViewport);
  const render::Camera camera = cameraOf(control);
  const Vec3d drawn_m =
      kViewport.box.toDrawn(*control.spec().target_m) + camera.right * 3000 + camera.up * 1500;
  const Vec3d position_m = kViewport.box.toFrame(drawn_m);
  const render::Projected before = pixelOf(control, position_m);
  control.dolly(0.5, before.x, before.y, kViewport);
  EXPECT_DOUBLE_EQ(*control.spec().distance, 0.75);
  const render::Projected after = pixelOf(control, position_m);
  EXPECT_NEAR(after.x, before.x, 1e-6);
  EXPECT_NEAR(after.y, before.y, 1e-6);
}

TEST(CameraControl, DollyHasLimits) {
  CameraControl control;
  for (int i = 0; i < 100; ++i) control.dolly(0.5, 400, 300, kViewport);
  EXPECT_GE(*control.spec().distance, 0.02);
  for (int i = 0; i < 100; ++i) control.dolly(2, 400, 300, kViewport);
  EXPECT_LE(*control.spec().distance, 50);
}

TEST(CameraControl, TheTargetStaysWhereTheCameraCanBeSaved) {
  CameraControl control;
  for (int i = 0; i < 50; ++i) control.dolly(2, 400, 300, kViewport);
  for (int i = 0; i < 1000; ++i) control.pan(1e5, -1e5, kViewport);
  control.focus({1e300, 0, 0}, 0.4, kViewport);
  const double reach_m = 51 * kViewport.box.drawnDiagonal_m();
  EXPECT_LE(length(*control.spec().target_m), 2 * reach_m);
  EXPECT_NO_THROW(render::parseCamera(render::toString(control.spec())));
}

TEST(CameraControl, LookKeepsTheEye) {
  CameraControl control(render::parseCamera("orbit:azimuth_deg=120,distance=1.2"));
  control.orbit(0, 0, kViewport);
  const Vec3d eye_m = cameraOf(control).eye_m;
  control.look(25, 10, kViewport);
  EXPECT_NEAR(length(cameraOf(control).eye_m - eye_m), 0, 1e-6 * length(eye_m));
  EXPECT_NEAR(control.spec().azimuth_deg, 145, 1e-9);
}

TEST(CameraControl, FlyMovesTheEyeAlongTheView) {
  CameraControl control(render::parseCamera("orbit:distance=1.2"));
  control.orbit(0, 0, kViewport);
  const render::Camera before = cameraOf(control);
  control.fly(0.1, 0, 0, kViewport);
  const Vec3d moved_m = cameraOf(control).eye_m - before.eye_m;
  EXPECT_NEAR(dot(moved_m, before.forward), 0.1 * kViewport.box.drawnDiagonal_m(),
              1e-6 * length(before.eye_m));
}

TEST(CameraControl, ALookatCameraBecomesTheOrbitWithTheSameEye) {
  CameraControl control(render::parseCamera(
      "lookat:eye_x_m=9000,eye_y_m=-15000,eye_z_m=6000,target_x_m=500,target_y_m=1000,target_z_m=800"));
  const Vec3d eye_m = cameraOf(control).eye_m;
  control.orbit(0, 0, kViewport);
  EXPECT_EQ(control.spec().kind, render::CameraSpec::Kind::orbit);
  EXPECT_NEAR(length(cameraOf(control).eye_m - eye_m), 0, 1e-6 * length(eye_m));
}

TEST(CameraControl, ACameraStraightAboveKeepsNorthUpWhenItIsMoved) {
  for (const char* spec :
       {"orbit:azimuth_deg=180,elevation_deg=90,projection=orthographic",
        "lookat:eye_x_m=0,eye_y_m=0,eye_z_m=30000,target_x_m=0,target_y_m=0,target_z_m=0"}) {
    CameraControl control(render::parseCamera(spec));
    control.pan(5, 0, kViewport);
    const render::Camera camera = cameraOf(control);
    EXPECT_NEAR(camera.up.y, 1, 1e-9) << spec;
    EXPECT_NEAR(camera.right.x, 1, 1e-9) << spec;
  }
}

TEST(CameraControl, OtherProjectionKeepsTheScaleAtTheTarget) {
  for (const char* spec : {"orbit", "orbit:distance=0.7,elevation_deg=50"}) {
    CameraControl control(render::parseCamera(spec));
    control.pan(0, 0, kViewport);
    const auto widthOf = [&] {
      const Vec3d target_m = *control.spec().target_m;
      const Vec3d right_m = cameraOf(control).right * 1000;
      return pixelOf(control, target_m + right_m).x - pixelOf(control, target_m).x;
    };
    const double before = widthOf();
    control.setProjection(render::Projection::orthographic, kViewport);
    EXPECT_EQ(cameraOf(control).projection, render::Projection::orthographic);
    EXPECT_NEAR(widthOf(), before, 1e-3 * before);
  }
}

TEST(CameraControl, FocusLooksAtAPositionFromTheSameDirection) {
  CameraControl control;
  control.focus({4000, -3000, 700}, 0.4, kViewport);
  const render::Projected at = pixelOf(control, {4000, -3000, 700});
  EXPECT_TRUE(at.in_front);
  EXPECT_NEAR(at.x, kViewport.size.width * (0.04 + 0.5 * (1 - 0.04 - 0.15)) - 0.5, 1);
  EXPECT_DOUBLE_EQ(control.spec().azimuth_deg, 155);
}

}  // namespace
}  // namespace emscape::view
