#include "render/cast/isosurface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "emscape/render/scene/renderer.h"
#include "render/cast/raycast.h"
#include "render/scene/prepared_volume.h"
#include "tests/render/scenes.h"
#include "tests/support/errors.h"

namespace emscape::render {
namespace {

using testing::makeVolume;

constexpr double kPi = 3.14159265358979323846;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

double degreesBetween(const Vec3d& a, const Vec3d& b) {
  return std::acos(std::min(1.0, dot(normalized(a), normalized(b)))) * 180 / kPi;
}

/// Distance in metres to a point, negative inside a sphere around it, of voxels as they are drawn.
struct SphereField {
  Dims dims;
  Vec3d drawn_voxel;
  Vec3d center;  ///< index space
  double radius;

  Vec3d drawn(const Vec3d& index) const {
    const Vec3d offset = index - center;
    return {offset.x * drawn_voxel.x, offset.y * drawn_voxel.y, offset.z * drawn_voxel.z};
  }
  std::shared_ptr<volume::DenseVolume> volume() const {
    return makeVolume(dims, {1, 1, 1}, [this](int i, int j, int k) {
      return static_cast<float>(radius - length(drawn({double(i), double(j), double(k)})));
    });
  }
};

/// A volume prepared for the ray caster.
struct Scene {
  PreparedVolume ready;
  VolumeView view;

  explicit Scene(std::shared_ptr<const volume::DenseVolume> volume) {
    ready.set(std::move(volume));
    view = ready.view();
  }
  /// The first crossing on the way from one point of index space to another, both in the box.
  IsoHit cross(const Vec3d& from, const Vec3d& to, float iso, float step, bool enters = false) const {
    const Vec3d along = to - from;
    const RaySegments segments(vecCast<float>(from), vecCast<float>(normalized(along)),
                               static_cast<float>(length(along)), step);
    return firstCrossing<TrilinearSampler>(view, {}, segments, iso, enters);
  }
};

TEST(Isosurface, SurfaceOfPlaneLiesOnThePlane) {
  const auto volume = makeVolume({30, 20, 10}, {1, 1, 1},
                                 [](int i, int j, int k) { return static_cast<float>(i + 2 * j - 3 * k); });
  const Scene scene(volume);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(0, 1);
  for (int ray = 0; ray < 200; ++ray) {
    const Vec3d from{29 * part(random), 19 * part(random), 9 * part(random)};
    const Vec3d to{29 * part(random), 19 * part(random), 9 * part(random)};
    const Vec3d slope{1, 2, -3};
    const double before = dot(from, slope) - 20.3;
    const double after = dot(to, slope) - 20.3;
    for (float step : {0.3F, 1.0F, 4.0F}) {
      const IsoHit hit = scene.cross(from, to, 20.3F, step);
      ASSERT_EQ(hit.found, before * after < 0);
      if (hit.found) {
        EXPECT_NEAR(hit.distance, length(to - from) * before / (before - after), 1e-3);
      }
    }
  }
}

TEST(Isosurface, SurfaceOfSphereLiesOnTheSphere) {
  // A cap of a sphere so large that trilinear interpolation keeps its shape to 1e-3 voxels.
  const SphereField field{{40, 40, 40}, {1, 1, 1}, {20, 20, -480}, 500};
  const Scene scene(field.volume());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(0, 39);
  int hits = 0;
  for (int ray = 0; ray < 200; ++ray) {
    const Vec3d from{part(random), part(random), 39};
    const Vec3d to{part(random), part(random), 0};
    const Vec3d along = normalized(to - from);
    const Vec3d offset = from - field.center;
    const double b = dot(offset, along);
    const double root = b * b - dot(offset, offset) + field.radius * field.radius;
    if (root < 0 || -b - std::sqrt(root) > length(to - from)) continue;
    const IsoHit hit = scene.cross(from, to, 0, 1);
    ASSERT_TRUE(hit.found);
    EXPECT_NEAR(hit.distance, -b - std::sqrt(root), 1e-3);
    ++hits;
  }
  EXPECT_GT(hits, 100);
}

TEST(Isosurface, NormalsEqualDrawnSphere) {
  // Anisotropic voxels, stretched heights.
  const SphereField field{{60, 40, 50}, {1, 1.5, 0.5 * 2.5}, {30, 20, 25}, 24};
  const Scene scene(field.volume());
  ShadingView shading;
  shading.voxel = vecCast<float>(field.drawn_voxel);
  std::mt19937 random(5);
  std::normal_distribution<double> any;
  for (int ray = 0; ray < 200; ++ray) {
    const Vec3d direction = normalized(Vec3d{any(random), any(random), any(random)});
    const double drawn_per_voxel = length(field.drawn(field.center + direction));
    const double distance = field.radius / drawn_per_voxel;
    const IsoHit hit = scene.cross(field.center + direction * (distance + 1.5),
                                   field.center + direction * (distance - 4), 0, 0.7F);
    ASSERT_TRUE(hit.found);
    EXPECT_NEAR(hit.distance, 1.5, 0.02);  // what trilinear interpolation makes of a small sphere
    const Vec3d at = field.center + direction * (distance + 1.5 - hit.distance);
    const Vec3f gradient = gradientAt<TrilinearSampler>(scene.view, vecCast<float>(at), hit.value);
    EXPECT_LT(degreesBetween(vecCast<double>(shading.normal(-gradient)), field.drawn(at)), 0.5);
  }
}

TEST(Isosurface, IsMetFromBothSides) {
  const auto volume =
      makeVolume({20, 2, 2}, {1, 1, 1}, [](int i, int, int) { return static_cast<float>(i); });
  const Scene scene(volume);
  EXPECT_NEAR(scene.cross({0, 1, 1}, {19, 1, 1}, 7.25F, 1).distance, 7.25, 1e-3);
  EXPECT_NEAR(scene.cross({19, 1, 1}, {0, 1, 1}, 7.25F, 1).distance, 19 - 7.25, 1e-3);
}

TEST(Isosurface, IsMetInTheLastShorterSegment) {
  const auto volume =
      makeVolume({20, 2, 2}, {1, 1, 1}, [](int i, int, int) { return static_cast<float>(i); });
  const Scene scene(volume);
  EXPECT_NEAR(scene.cross({0, 1, 1}, {18.9, 1, 1}, 18.8F, 2.5F).distance, 18.8, 1e-3);
  EXPECT_NEAR(scene.cross({0, 1, 1}, {0.9, 1, 1}, 0.5F, 2.5F).distance, 0.5, 1e-3);
  EXPECT_FALSE(scene.cross({0, 1, 1}, {18.7, 1, 1}, 18.8F, 2.5F).found);
}

TEST(Isosurface, IsCappedOnlyWhereARayEntersTheBoxInsideIt) {
  const auto volume =
      makeVolume({20, 2, 2}, {1, 1, 1}, [](int i, int, int) { return 20 - static_cast<float>(i); });
  const Scene scene(volume);
  const IsoHit cap = scene.cross({0, 1, 1}, {19, 1, 1}, 15, 1, true);
  EXPECT_TRUE(cap.found && cap.cap);
  EXPECT_EQ(cap.distance, 0);
  const IsoHit from_inside = scene.cross({0, 1, 1}, {19, 1, 1}, 15, 1, false);
  EXPECT_TRUE(from_inside.found && !from_inside.cap);
  EXPECT_NEAR(from_inside.distance, 5, 1e-3);
  const IsoHit from_below = scene.cross({19, 1, 1}, {0, 1, 1}, 15, 1, true);
  EXPECT_TRUE(from_below.found && !from_below.cap);
}

TEST(Isosurface, IsNotDrawnAgainstMaskedOrUnknownVoxels) {
  auto volume = makeVolume({4, 4, 20}, {1, 1, 1}, [](int, int, int k) { return k < 10 ? 5.0F : 20.0F + k; });
  volume->first_valid_k.assign(16, 10);
  EXPECT_FALSE(Scene(volume).cross({1, 1, 19}, {1, 1, 0}, 15, 1).found);
  volume->first_valid_k.assign(16, 8);
  EXPECT_TRUE(Scene(volume).cross({1, 1, 19}, {1, 1, 0}, 15, 1).found);
  const auto unknown = makeVolume({4, 4, 20}, {1, 1, 1}, [](int, int, int k) {
    return k < 9 ? 5.0F : k < 11 ? kNan : 20.0F;
  });
  for (float step : {0.5F, 1.0F, 7.0F})
    EXPECT_FALSE(Scene(unknown).cross({1, 1, 19}, {1, 1, 0}, 15, step).found) << step;
}

TEST(IsoValue, OutsideTheValuesIsReportedWithTheirRange) {
  auto volume =
      makeVolume({4, 4, 4}, {1, 1, 1}, [](int i, int, int) { return 10.0F * static_cast<float>(i); });
  volume->info.unit = "dBW/m2";
  const volume::ValueRange series{0, 80};
  EXPECT_EQ(missingIsosurface(80, *volume, series), "");
  EXPECT_EQ(missingIsosurface(0, *volume, series), "");
  EXPECT_EQ(missingIsosurface(80.5, *volume, series), "iso value 80.5 dBW/m2: test ranges from 0 to 80");
  EXPECT_EQ(missingIsosurface(-1, *volume, series), "iso value -1 dBW/m2: test ranges from 0 to 80");
  const volume::ValueRange narrow{0, 20};
  EXPECT_EQ(missingIsosurface(30, *volume, narrow), "");
  EXPECT_EQ(missingIsosurface(-1, *volume, narrow), "iso value -1 dBW/m2: test ranges from 0 to 30");
  volume->info.categorical = true;
  EXPECT_THAT(test::errorOf([&] { missingIsosurface(1, *volume); }),
              ::testing::HasSubstr("test holds indices"));
}

class IsoPicture : public ::testing::Test {
 protected:
  /// Colour of a one-pixel picture by a camera that looks along an axis through the middle of the volume.
  Rgba look(const std::shared_ptr<volume::DenseVolume>& volume, const std::string& camera) {
    Renderer renderer;
    renderer.setVolume(volume);
    renderer.setTransferFunction(
        testing::makeFunction({{0, {0, 0, 0}}, {10, {0.5F, 0.25F, 1}}}, {{0, 0}, {10, 0.1}}));
    settings_.mode = CompositingMode::iso;
    renderer.setSettings(settings_);
    renderer.setCamera(makeCamera(parseCamera(camera), renderer.sceneBox(), {1, 1}));
    return renderer.render({1, 1}).at(0, 0);
  }
  RenderSettings settings_;
};

TEST_F(IsoPicture, HasTheTransferFunctionsColourAndTheOpacityAskedFor) {
  const auto volume =
      makeVolume({20, 20, 20}, {1, 1, 1}, [](int i, int, int) { return 0.5F * static_cast<float>(i); });
  const char* from_west = "orbit:azimuth_deg=270,elevation_deg=0,fov_deg=1,projection=orthographic";
  settings_.iso_value = 5;
  const Rgba opaque = look(volume, from_west);
  EXPECT_EQ(opaque.a, 1);
  EXPECT_NEAR(opaque.r / opaque.b, 0.5, 0.1);  // the gleam is white
  settings_.iso_opacity = 0.4;
  EXPECT_EQ(look(volume, from_west).a, 0.4F);
  settings_.iso_value = 12;
  EXPECT_EQ(look(volume, from_west), Rgba{});
  settings_.iso_value = kNan;  // the middle, 5
  settings_.iso_opacity = 1;
  EXPECT_EQ(look(volume, from_west), opaque);
}

TEST_F(IsoPicture, CapIsShadedAsFlatFace) {
  const auto volume = makeVolume({8, 8, 8}, {1, 1, 1}, [](int i, int j, int k) {
    return 8 - 0.3F * static_cast<float>(i) - 0.2F * static_cast<float>(j) - 0.1F * static_cast<float>(k);
  });
  settings_.iso_value = 1;  // everywhere inside
  const Rgba from_west = look(volume, "orbit:azimuth_deg=270,elevation_deg=0,projection=orthographic");
  EXPECT_EQ(from_west.a, 1);
  for (const char* camera : {"orbit:azimuth_deg=90,elevation_deg=0,projection=orthographic",
                             "orbit:azimuth_deg=0,elevation_deg=0,projection=orthographic"}) {
    const Rgba face = look(volume, camera);
    EXPECT_NEAR(face.r, from_west.r, 1e-5) << camera;
    EXPECT_NEAR(face.b, from_west.b, 1e-5) << camera;
  }
}

TEST_F(IsoPicture, IsLitByItsNormalAsDrawn) {
  // The same scene as drawn: cubes, and flat boxes that are stretched to cubes.
  const auto slope = [](int i, int j, int k) {
    return 0.1F * static_cast<float>(i) + 0.2F * static_cast<float>(j) + 0.3F * static_cast<float>(k);
  };
  const auto cubes = makeVolume({16, 16, 16}, {10, 10, 10}, slope);
  const auto boxes = makeVolume({16, 16, 16}, {10, 10, 4}, slope);
  settings_.iso_value = 4.5;
  settings_.vertical_exaggeration = 1;
  const char* camera = "orbit:azimuth_deg=50,elevation_deg=40";
  const Rgba expected = look(cubes, camera);
  const Rgba unlike = look(boxes, camera);
  settings_.vertical_exaggeration = 2.5;
  const Rgba stretched = look(boxes, camera);
  EXPECT_NEAR(stretched.r, expected.r, 1e-5);
  EXPECT_NEAR(stretched.b, expected.b, 1e-5);
  EXPECT_GT(std::abs(unlike.r - expected.r), 1e-3);
}

TEST_F(IsoPicture, OfCategoriesIsDrawnWithoutValuesBetweenThem) {
  auto volume = makeVolume({8, 8, 8}, {1, 1, 1}, [](int i, int, int) { return i < 4 ? 0.0F : 9.0F; });
  volume->info.categorical = true;
  settings_.iso_value = 5;
  settings_.shading = true;
  EXPECT_EQ(look(volume, "orbit:azimuth_deg=270,elevation_deg=0").a, 1);
}

TEST_F(IsoPicture, RefusesImpossibleSettings) {
  Renderer renderer;
  settings_.iso_opacity = 1.5;
  EXPECT_THROW(renderer.setSettings(settings_), Error);
  settings_.iso_opacity = 1;
  settings_.iso_value = std::numeric_limits<double>::infinity();
  EXPECT_THROW(renderer.setSettings(settings_), Error);
}

}  // namespace
}  // namespace emscape::render
