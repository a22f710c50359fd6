#include "emscape/render/scene/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emscape/base/units.h"
#include "tests/support/errors.h"

namespace emscape::render {
namespace {

using ::testing::HasSubstr;

constexpr ImageSize kSize{1200, 900};
const SceneBox kBox{{-15000, -15000, 0}, {15000, 15000, 6000}, 2.0};

std::string errorOf(const std::string& text) {
  return test::errorOf([&] { parseCamera(text); }, ErrorCode::usage);
}

void expectBoxInside(const Camera& camera, ImageSize size, const FrameMargins& margins) {
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d frame_m{(corner & 1) != 0 ? kBox.upper_m.x : kBox.lower_m.x,
                        (corner & 2) != 0 ? kBox.upper_m.y : kBox.lower_m.y,
                        (corner & 4) != 0 ? kBox.upper_m.z : kBox.lower_m.z};
    const Projected p = project(camera, size, kBox.toDrawn(frame_m));
    EXPECT_TRUE(p.in_front);
    EXPECT_GE(p.x + 0.5, margins.left * size.width - 0.01);
    EXPECT_LE(p.x + 0.5, (1 - margins.right) * size.width + 0.01);
    EXPECT_GE(p.y + 0.5, margins.top * size.height - 0.01);
    EXPECT_LE(p.y + 0.5, (1 - margins.bottom) * size.height + 0.01);
  }
}

TEST(Camera, DefaultShowsTheWholeBoxWithinTheMargins) {
  const FrameMargins margins{0.05, 0.2, 0.1, 0.08};
  for (const char* text : {"orbit", "orbit:azimuth_deg=10,elevation_deg=-20", "orbit:elevation_deg=90",
                           "orbit:projection=orthographic", "orbit:fov_deg=90"}) {
    for (ImageSize size : {kSize, ImageSize{640, 360}, ImageSize{300, 800}}) {
      SCOPED_TRACE(text);
      expectBoxInside(makeCamera(parseCamera(text), kBox, size, margins), size, margins);
    }
  }
}

TEST(Camera, AzimuthIsCompassBearingFromTargetToCamera) {
  const Camera east = makeCamera(parseCamera("orbit:azimuth_deg=90,elevation_deg=0,distance=2"), kBox, kSize);
  EXPECT_NEAR(east.eye_m.x, 2 * kBox.drawnDiagonal_m(), 1e-6);
  EXPECT_NEAR(east.eye_m.y, 0, 1e-6);
  EXPECT_NEAR(east.eye_m.z, 6000, 1e-6);  // the drawn box is 12 km high
  EXPECT_NEAR(east.right.y, 1, 1e-12);    // looking west, north is to the right
}

TEST(Camera, TargetIsAtCentreOfFreeArea) {
  const Camera camera = makeCamera(parseCamera("lookat:eye_x_m=0,eye_y_m=-40000,eye_z_m=9000,target_x_m=100,"
                                               "target_y_m=200,target_z_m=300"),
                                   kBox, kSize, {0.0, 0.2, 0.1, 0.0});
  const Projected p = project(camera, kSize, kBox.toDrawn({100, 200, 300}));
  EXPECT_NEAR(p.x + 0.5, 0.4 * 1200, 1e-6);
  EXPECT_NEAR(p.y + 0.5, 0.55 * 900, 1e-6);
}

TEST(Camera, FovIsVertical) {
  const Camera camera =
      makeCamera(parseCamera("orbit:azimuth_deg=180,elevation_deg=0,distance=1,fov_deg=60"), kBox, kSize);
  const double distance_m = kBox.drawnDiagonal_m();
  const Vec3d top = kBox.drawnCenter_m() + Vec3d{0, 0, distance_m * std::tan(degToRad(30.0))};
  EXPECT_NEAR(project(camera, kSize, top).y + 0.5, 0, 1e-6);
}

TEST(Camera, OrthographicKeepsThePerspectivesScaleAtTheTarget) {
  const std::string view = "orbit:azimuth_deg=200,elevation_deg=20,distance=1.5";
  const Camera perspective = makeCamera(parseCamera(view), kBox, kSize);
  const Camera orthographic = makeCamera(parseCamera(view + ",projection=orthographic"), kBox, kSize);
  const Vec3d beside = kBox.drawnCenter_m() + perspective.right * 1000 + perspective.up * 700;
  EXPECT_NEAR(project(perspective, kSize, beside).x, project(orthographic, kSize, beside).x, 1e-6);
  EXPECT_NEAR(project(perspective, kSize, beside).y, project(orthographic, kSize, beside).y, 1e-6);
}

TEST(Camera, TextFormReadsBack) {
  for (const char* text :
       {"orbit:azimuth_deg=225,elevation_deg=30,distance=1.8,fov_deg=35",
        "orbit:azimuth_deg=1.25,elevation_deg=-3,target_x_m=1,target_y_m=2,target_z_m=3,fov_deg=20,"
        "projection=orthographic",
        "lookat:eye_x_m=1,eye_y_m=2,eye_z_m=3,target_x_m=4,target_y_m=5,target_z_m=6.5,fov_deg=40"}) {
    EXPECT_EQ(toString(parseCamera(text)), text);
  }
}

TEST(Camera, RefusalsNameKeyValueAndRange) {
  EXPECT_THAT(errorOf("orbit:azimut_deg=3"),
              HasSubstr("unknown key 'azimut_deg': expected projection, azimuth_deg"));
  EXPECT_THAT(errorOf("orbit:elevation_deg=91"), HasSubstr("elevation_deg '91': expected a number -90..90"));
  EXPECT_THAT(errorOf("orbit:fov_deg=nan"), HasSubstr("fov_deg 'nan': expected a number 1..150"));
  EXPECT_THAT(errorOf("orbit:distance="), HasSubstr("distance '': expected a number"));
  EXPECT_THAT(errorOf("orbit:distance=1,distance=2"), HasSubstr("distance is given twice"));
  EXPECT_THAT(errorOf("orbit:distance"), HasSubstr("'distance': expected KEY=VALUE"));
  EXPECT_THAT(errorOf("orbit:target_x_m=1"),
              HasSubstr("target_x_m, target_y_m and target_z_m are needed together"));
  EXPECT_THAT(errorOf("lookat:eye_x_m=1,eye_y_m=1,eye_z_m=1"), HasSubstr("target_x_m"));
  EXPECT_THAT(errorOf("orbit:eye_x_m=1"), HasSubstr("unknown key 'eye_x_m'"));
  EXPECT_THAT(errorOf("orbit:projection=fisheye"), HasSubstr("expected perspective or orthographic"));
  EXPECT_THAT(errorOf("from:above"), HasSubstr("expected orbit"));
  EXPECT_THAT(errorOf(""), HasSubstr("expected orbit"));
}

TEST(Camera, EyeAtTheTargetIsRefused) {
  const CameraSpec spec =
      parseCamera("lookat:eye_x_m=1,eye_y_m=2,eye_z_m=3,target_x_m=1,target_y_m=2,target_z_m=3");
  EXPECT_THROW(makeCamera(spec, kBox, kSize), Error);
}

TEST(SceneBox, ExaggerationStretchesHeightsAboutTheBottom) {
  const SceneBox box{{0, 0, 200}, {10, 10, 300}, 3};
  EXPECT_DOUBLE_EQ(box.toDrawn({1, 2, 200}).z, 200);
  EXPECT_DOUBLE_EQ(box.toDrawn({1, 2, 300}).z, 500);
  EXPECT_DOUBLE_EQ(box.toFrame(box.toDrawn({1, 2, 250})).z, 250);
}

TEST(SceneBox, DefaultExaggerationFollowsTheBoxAndIsOneForScans) {
  volume::Grid grid;
  grid.dims = {200, 200, 100};
  grid.spacing_m = {150, 150, 60};
  EXPECT_EQ(niceVerticalExaggeration(grid), 1);
  grid.georeferenced = true;
  EXPECT_EQ(niceVerticalExaggeration(grid), 2);
  grid.spacing_m.z = 1e-3;
  EXPECT_EQ(niceVerticalExaggeration(grid), 20);
  EXPECT_THROW(sceneBoxOf(grid, -1), Error);
}

}  // namespace
}  // namespace emscape::render
