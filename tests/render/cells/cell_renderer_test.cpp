#include "emscape/render/cells/cell_renderer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "emscape/base/error.h"
#include "render/cells/cell_march.h"
#include "render/cells/integral/linear_transfer.h"
#include "render/scene/scene.h"
#include "tests/support/errors.h"
#include "tests/support/meshes.h"

namespace emscape::render {
namespace {

using test::boxMesh;
using test::fieldOn;
using ::testing::HasSubstr;
using volume::MeshField;
using volume::TetrahedralMesh;

constexpr ImageSize kSize{97, 71};

/// Colours and opacities with a thin feature and a jump.
TransferFunction lively() {
  TransferFunction function;
  function.colors = {{0, {0.1F, 0.2F, 0.9F}}, {0.4, {0.9F, 0.8F, 0.1F}}, {1, {0.9F, 0.1F, 0.2F}}};
  function.opacities = {{0, 0},     {0.5, 0.02}, {0.62, 0},  {0.621, 0.9},
                        {0.622, 0}, {0.8, 0},    {0.8, 0.3}, {1, 0.1}};
  return function;
}
TransferFunction constant(double opacity) {
  TransferFunction function;
  function.colors = {{0, {1, 1, 1}}};
  function.opacities = {{0, opacity}};
  return function;
}

void prepare(CellRenderer& renderer, const MeshField& field, const TransferFunction& function,
             const char* camera = "orbit", bool exact = true) {
  TetrahedralMesh mesh = *field.mesh;
  MeshField oriented = field;
  volume::orientCells(mesh, {});
  auto faces = std::make_shared<volume::MeshFaces>(volume::facesOf(mesh, {}));
  oriented.mesh = std::make_shared<TetrahedralMesh>(std::move(mesh));
  RenderSettings settings;
  settings.exact = exact;
  renderer.setSettings(settings);
  renderer.setField(oriented, faces);
  renderer.setTransferFunction(function);
  renderer.setCamera(makeCamera(parseCamera(camera), renderer.sceneBox(), kSize));
}

Image draw(const MeshField& field, const TransferFunction& function, const char* camera = "orbit",
           bool exact = true) {
  CellRenderer renderer;
  prepare(renderer, field, function, camera, exact);
  return renderer.render(kSize);
}

double greatestDifference(const Image& a, const Image& b) {
  double greatest = 0;
  for (std::size_t n = 0; n < a.pixels.size(); ++n) {
    const Rgba &p = a.pixels[n], &q = b.pixels[n];
    for (const float d : {p.r - q.r, p.g - q.g, p.b - q.b, p.a - q.a})
      greatest = std::max(greatest, std::abs(static_cast<double>(d)));
  }
  return greatest;
}

/// Chords of a picture's rays in a grid's box (voxels).
std::vector<double> chordsOf(const CellRenderer& renderer, const TetrahedralMesh& mesh) {
  Scene scene;
  scene.setVolume(referenceGridOf(mesh), {});
  scene.setCamera(renderer.camera());
  scene.setTransferFunction(constant(0.1));
  scene.prepare();
  const RaycastTask task = scene.task(kSize);
  std::vector<double> chords;
  const Vec3d lower{-0.5, -0.5, -0.5},
      upper{kReferenceSteps - 0.5, kReferenceSteps - 0.5, kReferenceSteps - 0.5};
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const RayInterval inside = clip(task.camera.ray(x, y), lower, upper);
      chords.push_back(std::max(0.0, inside.end - inside.begin));
    }
  }
  return chords;
}

constexpr const char* kCameras[] = {
    "orbit", "orbit:projection=orthographic", "orbit:azimuth_deg=0,elevation_deg=0,projection=orthographic",
    "orbit:azimuth_deg=90,elevation_deg=90",
    // In the box: the eye is in a cell.
    "lookat:eye_x_m=1,eye_y_m=2,eye_z_m=1.5,target_x_m=9,target_y_m=7,target_z_m=2,fov_deg=80"};

TEST(CellRenderer, OpacityOfHomogeneousBoxFollowsChordLength) {
  const MeshField field =
      fieldOn(boxMesh({6, 5, 7}, {0, 0, 0}, {9, 8, 4}, 0.2), [](const Vec3d&) { return 1.0; });
  constexpr double kOpacity = 0.02;
  const double extinction = -std::log1p(-kOpacity);
  for (const char* camera : kCameras) {
    SCOPED_TRACE(camera);
    CellRenderer renderer;
    prepare(renderer, field, constant(kOpacity), camera);
    CellReport report;
    const Image image = renderer.render(kSize, nullptr, &report);
    EXPECT_TRUE(report.complete);
    const std::vector<double> chords = chordsOf(renderer, *field.mesh);
    int hits = 0;
    for (std::size_t n = 0; n < chords.size(); ++n) {
      hits += chords[n] > 0 ? 1 : 0;
      EXPECT_NEAR(static_cast<double>(image.pixels[n].a), -std::expm1(-extinction * chords[n]), 1e-6);
    }
    EXPECT_GT(hits, 1000);
    EXPECT_NEAR(static_cast<double>(report.rays), hits, 3);
  }
}

TEST(CellRenderer, LinearFieldIsDrawnEquallyOnAnyMesh) {
  const auto linear = [](const Vec3d& p) { return 0.03 + 0.05 * p.x + 0.03 * p.y + 0.06 * p.z; };
  const Vec3d lower{0, 0, 0}, upper{9, 8, 4};
  const MeshField coarse = fieldOn(boxMesh({3, 2, 2}, lower, upper), linear);
  const MeshField middle = fieldOn(boxMesh({7, 6, 7}, lower, upper, 0.15), linear);
  const MeshField fine = fieldOn(boxMesh({27, 26, 27}, lower, upper, 0.2), linear);
  EXPECT_EQ(coarse.mesh->cells.size(), 12U);
  EXPECT_EQ(middle.mesh->cells.size(), 1080U);
  EXPECT_EQ(fine.mesh->cells.size(), 101400U);
  for (const char* camera : kCameras) {
    SCOPED_TRACE(camera);
    const Image a = draw(coarse, lively(), camera);
    EXPECT_LT(greatestDifference(a, draw(middle, lively(), camera)), 1e-4);
    EXPECT_LT(greatestDifference(a, draw(fine, lively(), camera)), 1e-4);
    // By the table, and with early termination: within what that allows.
    EXPECT_LT(greatestDifference(a, draw(fine, lively(), camera, false)), 0.0102);
  }
}

TEST(CellRenderer, SLOW_TheOrderOfVerticesCellsAndPointsDoesNotMatter) {
  const auto wavy = [](const Vec3d& p) { return 0.5 + 0.5 * std::sin(p.x) * std::cos(p.y + p.z); };
  const MeshField field = fieldOn(boxMesh({8, 7, 6}, {0, 0, 0}, {9, 8, 4}, 0.2), wavy);
  TetrahedralMesh shuffled = *field.mesh;
  std::mt19937 random(11);
  for (auto& cell : shuffled.cells) std::shuffle(cell.begin(), cell.end(), random);
  std::shuffle(shuffled.cells.begin(), shuffled.cells.end(), random);
  const MeshField other = fieldOn(std::move(shuffled), wavy);
  for (const char* camera : kCameras) {
    SCOPED_TRACE(camera);
    EXPECT_LT(greatestDifference(draw(field, lively(), camera), draw(other, lively(), camera)), 1e-6);
  }
}

TEST(CellRenderer, AThinFeatureIsNotLostBetweenTheEndsOfACell) {
  // Two hexahedra; the feature is a thousandth of the value's course through them.
  const MeshField field =
      fieldOn(boxMesh({2, 2, 2}, {0, 0, 0}, {1, 1, 1}), [](const Vec3d& p) { return p.x; });
  TransferFunction function = constant(0);
  function.opacities = {{0.5, 0}, {0.5, 0.9}, {0.501, 0.9}, {0.501, 0}};
  const Image image = draw(field, function, "orbit:azimuth_deg=90,elevation_deg=0,projection=orthographic");
  // 0.1 reference steps of opacity 0.9.
  EXPECT_NEAR(static_cast<double>(image.at(kSize.width / 2, kSize.height / 2).a), 1 - std::pow(0.1, 0.1),
              2e-6);
}

TEST(CellRenderer, AMeshThatIsNotConvexIsEnteredAgain) {
  // Two slabs with a gap, and a third that touches the second without sharing its points: by rounding of
  // single precision it lies in it.
  TetrahedralMesh mesh = boxMesh({4, 4, 2}, {0, 0, 0}, {9, 8, 1});
  test::append(mesh, boxMesh({3, 5, 3}, {0, 0, 2}, {9, 8, 3}));
  test::append(mesh, boxMesh({6, 3, 2}, {0, 0, 3 - 3e-7}, {9, 8, 4}));
  const MeshField field = fieldOn(std::move(mesh), [](const Vec3d&) { return 1.0; });
  constexpr double kOpacity = 0.05;
  const Image image = draw(field, constant(kOpacity), "orbit:elevation_deg=90,projection=orthographic");
  // Straight down: three of four quarters are filled.
  const double expected = -std::expm1(std::log1p(-kOpacity) * 0.75 * kReferenceSteps);
  EXPECT_NEAR(static_cast<double>(image.at(kSize.width / 2, kSize.height / 2).a), expected, 1e-6);
}

TEST(CellRenderer, CellsWithoutAKnownFieldAreClear) {
  MeshField field = fieldOn(boxMesh({2, 2, 5}, {0, 0, 0}, {1, 1, 4}), [](const Vec3d&) { return 1.0; });
  for (std::size_t n = 0; n < field.values.size(); ++n) {
    if (field.mesh->points_m[n].z == 2) field.values[n] = std::numeric_limits<float>::quiet_NaN();
  }
  const Image image = draw(field, constant(0.05), "orbit:elevation_deg=90,projection=orthographic");
  const double expected = -std::expm1(std::log1p(-0.05) * 0.5 * kReferenceSteps);
  EXPECT_NEAR(static_cast<double>(image.at(kSize.width / 2, kSize.height / 2).a), expected, 1e-6);
}

TEST(CellRenderer, GroundHidesCellsBehindIt) {
  const MeshField field = fieldOn(boxMesh({4, 4, 4}, {0, 0, 0}, {1, 1, 1}), [](const Vec3d&) { return 1.0; });
  CellRenderer renderer;
  prepare(renderer, field, constant(0.01), "orbit:elevation_deg=90,projection=orthographic");
  auto ground = std::make_shared<HeightField>();
  ground->columns = ground->rows = 2;
  ground->spacing_x_m = ground->spacing_y_m = 1;
  ground->heights_m = {0.25F, 0.25F, 0.25F, 0.25F};
  const double alone = static_cast<double>(renderer.render(kSize).at(48, 35).a);
  EXPECT_NEAR(alone, -std::expm1(std::log1p(-0.01) * kReferenceSteps), 1e-6);
  renderer.setHeightField(ground);
  const Rgba covered = renderer.render(kSize).at(48, 35);
  EXPECT_EQ(covered.a, 1);
  EXPECT_TRUE(renderer.isHidden({0.5, 0.5, 0.1}));
  EXPECT_FALSE(renderer.isHidden({0.5, 0.5, 0.9}));
  // White fog over three quarters of the height lets the ground through.
  renderer.setTransferFunction(constant(0));
  const Rgba bare = renderer.render(kSize).at(48, 35);
  const double through = std::pow(0.99, 0.75 * kReferenceSteps);
  EXPECT_NEAR(static_cast<double>(covered.r), 1 - through + through * static_cast<double>(bare.r), 1e-5);
}

TEST(CellRenderer, RefusesUnsupportedSettings) {
  CellRenderer renderer;
  RenderSettings settings;
  settings.mode = CompositingMode::mida;
  EXPECT_THAT(test::errorOf([&] { renderer.setSettings(settings); }, ErrorCode::usage),
              HasSubstr("mode mida: fields on tetrahedra support only mode dvr"));
  settings = {};
  settings.shading = true;
  EXPECT_THAT(test::errorOf([&] { renderer.setSettings(settings); }, ErrorCode::usage), HasSubstr("shading"));
  MeshField field = fieldOn(boxMesh({2, 2, 2}, {0, 0, 0}, {1, 1, 1}), [](const Vec3d&) { return 1.0; });
  field.info.categorical = true;
  EXPECT_THAT(test::errorOf([&] { renderer.setField(field, nullptr); }, ErrorCode::bad_input),
              HasSubstr("density holds indices"));
}

TEST(CellMarch, LengthsAlongARayAddUpToTheChord) {
  const MeshField field =
      fieldOn(boxMesh({9, 9, 9}, {-1, -1, -1}, {1, 1, 1}, 0.2), [](const Vec3d& p) { return p.x; });
  CellMesh cells;
  cells.mesh = field.mesh;
  cells.faces = std::make_shared<volume::MeshFaces>(volume::facesOf(*field.mesh, {}));
  cells.values = field.values;
  for (const Vec3d& p : field.mesh->points_m) cells.points.push_back({p.x, p.y, p.z});
  const LinearTransfer transfer(constant(0));
  std::mt19937 random(5);
  std::normal_distribution<double> any(0, 1);
  for (int n = 0; n < 500; ++n) {
    // Also rays in planes of the lattice and along its edges.
    const bool on_lattice = n % 5 == 0;
    const Vec3d direction =
        on_lattice ? Vec3d{n % 3 == 0 ? 1.0 : 0.0, n % 3 == 1 ? -1.0 : 0.0, n % 3 == 2 ? 1.0 : 0.0}
                   : normalized(Vec3d{any(random), any(random), any(random)});
    const Vec3d target =
        on_lattice ? Vec3d{0, 0, 0} : Vec3d{0.3 * any(random), 0.3 * any(random), 0.3 * any(random)};
    const Ray ray{target - direction * 5.0, direction};
    const RayFrame frame(ray);
    std::vector<EntryHit> entries;
    for (const volume::FaceId face : cells.faces->boundary) {
      EntryHit hit;
      if (entersThrough(cells.view(), frame, face, hit)) entries.push_back(hit);
    }
    const RayInterval inside = clip(ray, {-1, -1, -1}, {1, 1, 1});
    if (!(inside.end > inside.begin + 1e-6)) continue;
    ASSERT_FALSE(entries.empty());
    RayIntegral integral(transfer.view(), {});
    long long passed = 0;
    const double end = march(cells.view(), frame, entries.front(), -1e9, {1e9, 0}, integral, passed);
    EXPECT_NEAR(entries.front().distance, inside.begin, 1e-12);
    EXPECT_NEAR(end, inside.end, 1e-12);
    EXPECT_GE(passed, 1);
  }
}

}  // namespace
}  // namespace emscape::render
