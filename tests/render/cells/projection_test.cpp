#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <set>

#include "emscape/base/backend.h"
#include "emscape/base/error.h"
#include "emscape/render/cells/cell_renderer.h"
#include "render/cells/cell_order.h"
#include "render/cells/cell_renderer_impl.h"
#include "render/cells/projected_cells.h"
#include "tests/support/errors.h"
#include "tests/support/gpu.h"
#include "tests/support/meshes.h"

namespace emscape::render {
namespace {

using test::boxMesh;
using test::fieldOn;
using volume::MeshField;
using volume::TetrahedralMesh;

constexpr ImageSize kSize{160, 120};

TransferFunction lively() {
  TransferFunction function;
  function.colors = {{-2, {0.1F, 0.2F, 0.9F}}, {0.4, {0.9F, 0.8F, 0.1F}}, {3, {0.9F, 0.1F, 0.2F}}};
  function.opacities = {{-1, 0}, {0, 0}, {0.2, 0.3}, {0.4, 0.02}, {3, 0.1}};
  return function;
}

/// A mesh of jittered cells and a field that varies in all directions.
MeshField wavy(int points) {
  TetrahedralMesh mesh = boxMesh({points, points, points}, {0, 0, 0}, {1000, 800, 500}, 0.2);
  volume::orientCells(mesh, {});
  return fieldOn(std::move(mesh),
                 [](const Vec3d& p) { return std::sin(p.x / 150) + p.z / 300 + std::cos(p.y / 200); });
}

void prepare(CellRenderer& renderer, const MeshField& field, const TransferFunction& function,
             const char* camera) {
  RenderSettings settings;
  settings.exact = true;
  renderer.setSettings(settings);
  renderer.setField(field, std::make_shared<volume::MeshFaces>(volume::facesOf(*field.mesh, {})));
  renderer.setTransferFunction(function);
  renderer.setCamera(makeCamera(parseCamera(camera), renderer.sceneBox(), kSize));
}

/// The greatest difference of the components.
double differenceOf(const Rgba& p, const Rgba& q) {
  return static_cast<double>(
      std::max({std::fabs(p.r - q.r), std::fabs(p.g - q.g), std::fabs(p.b - q.b), std::fabs(p.a - q.a)}));
}

/// Differences of the pixels' components.
struct Difference {
  double max = 0, mean = 0;
  double above_1e5 = 0;  ///< part of the pixels

  Difference(const Image& a, const Image& b) {
    for (std::size_t n = 0; n < a.pixels.size(); ++n) {
      const double here = differenceOf(a.pixels[n], b.pixels[n]);
      max = std::max(max, here);
      mean += here / static_cast<double>(a.pixels.size());
      above_1e5 += (here > 1e-5 ? 1.0 : 0.0) / static_cast<double>(a.pixels.size());
    }
  }
};

TEST(CudaCells, EqualPictureOfCpu) {
  EMSCAPE_NEEDS_GPU();
  auto ground = std::make_shared<HeightField>();
  ground->columns = ground->rows = 3;
  ground->spacing_x_m = 500;
  ground->spacing_y_m = 400;
  ground->heights_m = {0, 100, 0, 50, 450, 100, 0, 200, 0};
  MeshField holed = wavy(9);
  for (std::size_t point = 0; point < holed.values.size(); point += 50) holed.values[point] = std::nanf("");
  for (const MeshField& field : {wavy(8), holed}) {
    for (const char* camera : {"orbit", "orbit:projection=orthographic", "orbit:distance=0.1"}) {
      CellRenderer cpu, gpu(Backend::cuda);
      EXPECT_EQ(gpu.backend(), Backend::cuda);
      for (CellRenderer* renderer : {&cpu, &gpu}) {
        prepare(*renderer, field, lively(), camera);
        renderer->setHeightField(ground);
      }
      CellReport of_cpu, of_gpu;
      const Difference difference(gpu.render(kSize, nullptr, &of_gpu), cpu.render(kSize, nullptr, &of_cpu));
      EXPECT_LT(difference.max, 1e-5) << camera;
      EXPECT_EQ(of_gpu.rays, of_cpu.rays);
      EXPECT_NEAR(static_cast<double>(of_gpu.cells), static_cast<double>(of_cpu.cells),
                  1e-3 * static_cast<double>(of_cpu.cells));  // along edges
    }
  }
}

ProjectionOptions byOpenGl(CellProjection projection = CellProjection::exact) {
  return {projection, CellSorting::visibility, Rasterizer::opengl};
}

/// Projection by OpenGL needs EGL.
class Projection : public ::testing::Test {
 protected:
  void SetUp() override {
    try {
      CellRenderer renderer;
      prepare(renderer, wavy(2), lively(), "orbit");
      renderer.project({4, 4}, byOpenGl());
    } catch (const Error& error) {
      if (error.code() != ErrorCode::device) throw;
      GTEST_SKIP() << error.what();
    }
  }
};

TEST_F(Projection, EqualsMarchedPicture) {
  for (const char* camera :
       {"orbit", "orbit:projection=orthographic", "orbit:azimuth_deg=20,elevation_deg=70",
        "orbit:distance=0.1", "orbit:distance=0.4,elevation_deg=-20"}) {
    CellRenderer renderer;
    prepare(renderer, wavy(8), lively(), camera);
    const Image marched = renderer.render(kSize);
    ProjectionReport report;
    const Difference difference(renderer.project(kSize, byOpenGl(), &report), marched);
    EXPECT_LT(difference.max, 2e-2) << camera;
    EXPECT_LT(difference.above_1e5, 0.02) << camera;
    EXPECT_LT(difference.mean, 2e-6) << camera;
    EXPECT_EQ(report.cycles, 0);
    // With parallel rays the published form is exact, too.
    if (std::string(camera).find("orthographic") == std::string::npos) continue;
    EXPECT_LT(Difference(renderer.project(kSize, byOpenGl(CellProjection::published)), marched).max, 2e-2);
  }
}

/// The edges of a mesh in a picture.
class ProjectedEdges {
 public:
  ProjectedEdges(const TetrahedralMesh& mesh, const CellRenderer& renderer) {
    std::set<std::array<std::int32_t, 2>> edges;
    for (const auto& cell : mesh.cells) {
      for (std::size_t n = 1; n < 4; ++n)
        for (std::size_t m = 0; m < n; ++m)
          edges.insert({std::min(cell[m], cell[n]), std::max(cell[m], cell[n])});
    }
    std::vector<Projected> points;
    for (const Vec3d& point_m : mesh.points_m)
      points.push_back(project(renderer.camera(), kSize, renderer.sceneBox().toDrawn(point_m)));
    for (const auto& [a, b] : edges)
      edges_.push_back({points[static_cast<std::size_t>(a)], points[static_cast<std::size_t>(b)]});
  }
  /// Whether one is nearer to a pixel's centre (pixels).
  bool areNear(int x, int y, double distance) const {
    return std::any_of(edges_.begin(), edges_.end(), [&](const auto& edge) {
      const auto& [a, b] = edge;
      const double to_x = b.x - a.x, to_y = b.y - a.y, from_x = x - a.x, from_y = y - a.y;
      const double squared = to_x * to_x + to_y * to_y;
      const double part = squared > 0 ? std::clamp((from_x * to_x + from_y * to_y) / squared, 0.0, 1.0) : 0;
      const double off_x = part * to_x - from_x, off_y = part * to_y - from_y;
      return off_x * off_x + off_y * off_y < distance * distance;
    });
  }

 private:
  std::vector<std::array<Projected, 2>> edges_;
};

// What is left of 1e-5: rasterisers round vertices to 1/256 pixel, and a ray beside an edge may be given to
// the cell on its wrong side; else the interpolation in single precision, which grows with the cells' optical
// depth (here up to 5).
TEST_F(Projection, EqualsMarchedPictureAwayFromEdges) {
  constexpr double kNear = 1.0 / 32;  // pixels
  const MeshField field = wavy(8);
  for (const char* camera :
       {"orbit", "orbit:projection=orthographic", "orbit:azimuth_deg=20,elevation_deg=70"}) {
    SCOPED_TRACE(camera);
    CellRenderer renderer;
    prepare(renderer, field, lively(), camera);
    const Image marched = renderer.render(kSize), projected = renderer.project(kSize, byOpenGl());
    const ProjectedEdges edges(*field.mesh, renderer);
    int far = 0, far_off = 0;
    double worst = 0;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        if (edges.areNear(x, y, kNear)) continue;
        const double difference = differenceOf(marched.at(x, y), projected.at(x, y));
        worst = std::max(worst, difference);
        ++far;
        far_off += difference > 1e-5 ? 1 : 0;
      }
    }
    std::printf("%s: %d pixels, %d above 1e-5, worst %.1e\n", camera, far, far_off, worst);
    EXPECT_GT(far, 10000);
    // llvmpipe 2.9e-5 and 0.1 %, an H100 5.9e-4 and 0.6 %.
    EXPECT_LT(worst, 1e-3);
    EXPECT_LT(far_off, 0.01 * far);
  }
}

TEST_F(Projection, IsHomogeneousWhereTheFieldIs) {
  TetrahedralMesh mesh = boxMesh({5, 5, 5}, {0, 0, 0}, {100, 100, 100}, 0.2);
  volume::orientCells(mesh, {});
  const MeshField field = fieldOn(std::move(mesh), [](const Vec3d&) { return 1.0; });
  TransferFunction fog;
  fog.colors = {{0, {1, 1, 1}}};
  fog.opacities = {{0, 0.01}};
  CellRenderer renderer;
  // Along an axis all rays cross 100 reference steps.
  prepare(renderer, field, fog,
          "lookat:eye_x_m=50,eye_y_m=-300,eye_z_m=50,target_x_m=50,target_y_m=50,target_z_m=50,"
          "projection=orthographic,fov_deg=10");
  const Image image = renderer.project(kSize, byOpenGl());
  const double expected = 1 - std::pow(0.99, 100);
  int near = 0;
  for (const Rgba& pixel : image.pixels) {
    near += std::fabs(pixel.a - expected) < 5e-6;
    ASSERT_NEAR(pixel.a, expected, 5e-4);  // a ray within 1/256 pixel of an edge
  }
  EXPECT_GT(near, 0.99 * kSize.count());
}

TEST_F(Projection, TheGroundEndsRays) {
  auto ground = std::make_shared<HeightField>();
  ground->columns = ground->rows = 3;
  ground->spacing_x_m = 500;
  ground->spacing_y_m = 400;
  ground->heights_m = {0, 100, 0, 50, 450, 100, 0, 200, 0};
  for (const char* camera : {"orbit", "orbit:projection=orthographic", "orbit:distance=0.3"}) {
    CellRenderer renderer;
    prepare(renderer, wavy(8), lively(), camera);
    const Image without = renderer.project(kSize, byOpenGl());
    renderer.setHeightField(ground);
    const Image image = renderer.project(kSize, byOpenGl());
    EXPECT_GT(Difference(image, without).mean, 0.01) << camera;
    const Difference difference(image, renderer.render(kSize));
    EXPECT_LT(difference.max, 2e-2) << camera;
    EXPECT_LT(difference.mean, 2e-6) << camera;
  }
}

TEST_F(Projection, SendsFewerNumbersThanThePublishedAccount) {
  CellRenderer renderer;
  prepare(renderer, wavy(6), lively(), "orbit");
  const long long cells = 6 * 5 * 5 * 5;
  ProjectionReport report;
  renderer.project(kSize, byOpenGl(CellProjection::published), &report);
  EXPECT_EQ(report.cells, cells);
  EXPECT_EQ(report.sent_bytes,
            24 * sizeof(float) * cells);  // 28 with the indices of vertices, which are their places
  renderer.project(kSize, byOpenGl(), &report);
  EXPECT_EQ(report.sent_bytes, 21 * sizeof(float) * cells);  // 25
}

TEST_F(Projection, LeavesOutCellsWithoutAField) {
  MeshField field = wavy(6);
  field.values[3 * 36 + 2 * 6 + 2] = std::nanf("");
  CellRenderer renderer;
  prepare(renderer, field, lively(), "orbit");
  const Difference difference(renderer.project(kSize, byOpenGl()), renderer.render(kSize));
  EXPECT_LT(difference.max, 2e-2);
  EXPECT_LT(difference.mean, 2e-6);
}

TEST(ProjectedCells, OrderOfVerticesDoesNotMatter) {
  SeenCell cell{{Vec3d{3, 0.2, 0.1}, Vec3d{4, 0.3, -0.2}, Vec3d{3.3, 1.4, 0}, Vec3d{3.5, 0.5, 1.1}},
                {1, 2, 4, 8}};
  const std::array<int, 4> even[] = {{0, 1, 2, 3}, {1, 2, 0, 3}, {0, 2, 3, 1}, {1, 0, 3, 2}};
  for (const CellProjection form : {CellProjection::exact, CellProjection::published}) {
    std::array<float, 16> vertices{};
    std::array<float, 8> first{}, numbers{};
    projectCell(cell, nullptr, form, vertices.data(), first.data());
    for (const auto& order : even) {
      SeenCell moved = cell;
      for (std::size_t i = 0; i < 4; ++i) {
        moved.points[i] = cell.points[static_cast<std::size_t>(order[i])];
        moved.values[i] = cell.values[static_cast<std::size_t>(order[i])];
      }
      projectCell(moved, nullptr, form, vertices.data(), numbers.data());
      for (std::size_t i = 0; i < 4; ++i)
        EXPECT_FLOAT_EQ(numbers[i], first[static_cast<std::size_t>(order[i])]);
      EXPECT_FLOAT_EQ(numbers[4], form == CellProjection::exact ? first[4] : numbers[4]);
    }
  }
}

TEST(ProjectedCells, KnowWhetherTheyHoldTheEye) {
  SeenCell cell{{Vec3d{-1, -1, -1}, Vec3d{3, -1, -1}, Vec3d{-1, 3, -1}, Vec3d{-1, -1, 3}}, {1, 2, 4, 8}};
  std::array<float, 16> vertices{};
  std::array<float, 5> numbers{};
  EXPECT_FALSE(projectCell(cell, nullptr, CellProjection::exact, vertices.data(), numbers.data()));
  EXPECT_FLOAT_EQ(numbers[4], 3.75F);  // the eye is the centroid
  for (Vec3d& point : cell.points) point = point + Vec3d{5, 0, 0};
  EXPECT_TRUE(projectCell(cell, nullptr, CellProjection::exact, vertices.data(), numbers.data()));
}

/// The exit of a ray that enters a cell at a point with the given weights of its vertices, as the fragment
/// shader finds it. @return the face; -1: none
int exitFace(const std::array<float, 8>& numbers, const std::array<double, 4>& weights, CellProjection form) {
  int exit = -1;
  double nearest = HUGE_VAL;
  for (std::size_t i = 0; i < 4; ++i) {
    const double here = static_cast<double>(numbers[i]) * weights[i];
    if (numbers[i] > 0 && (form == CellProjection::published || here < 1) && here < nearest) {
      nearest = here;
      exit = static_cast<int>(i);
    }
  }
  return exit;
}

/// Part of the samples with a wrong exit face, of random cells in a cube of half side 1 at a distance.
double wrongExits(double distance, CellProjection form) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> within(-1, 1), positive(0, 1);
  int wrong = 0, samples = 0;
  while (samples < 20000) {
    SeenCell cell;
    for (Vec3d& point : cell.points) point = {distance + within(random), within(random), within(random)};
    const auto& p = cell.points;
    const double volume6 = dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]);
    if (std::fabs(volume6) < 0.08) continue;
    if (volume6 < 0) std::swap(cell.points[2], cell.points[3]);
    std::array<float, 16> vertices{};
    std::array<float, 8> numbers{};
    projectCell(cell, nullptr, form, vertices.data(), numbers.data());
    for (std::size_t face = 0; face < 4; ++face) {
      const auto& v = volume::kFaceVertices[face];
      const auto at = [&](int n) { return p[static_cast<std::size_t>(v[n])]; };
      if (!(dot(cross(at(1) - at(0), at(2) - at(0)), at(0)) < 0)) continue;  // not an entry
      double a = positive(random), b = positive(random);
      if (a + b > 1) a = 1 - a, b = 1 - b;
      std::array<double, 4> weights{};
      weights[static_cast<std::size_t>(v[0])] = 1 - a - b;
      weights[static_cast<std::size_t>(v[1])] = a;
      weights[static_cast<std::size_t>(v[2])] = b;
      const Vec3d entry = at(0) * (1 - a - b) + at(1) * a + at(2) * b;
      // The nearest plane of another face that the ray crosses outwards, beyond its entry.
      int expected = -1;
      double nearest = HUGE_VAL;
      for (std::size_t other = 0; other < 4; ++other) {
        const auto& w = volume::kFaceVertices[other];
        const Vec3d& corner = p[static_cast<std::size_t>(w[0])];
        const Vec3d outward =
            cross(p[static_cast<std::size_t>(w[1])] - corner, p[static_cast<std::size_t>(w[2])] - corner);
        const double speed = dot(outward, entry);
        if (other == face || !(speed > 0)) continue;
        const double t = dot(outward, corner - entry) / speed;
        if (t < nearest) {
          nearest = t;
          expected = static_cast<int>(other);
        }
      }
      ++samples;
      wrong += exitFace(numbers, weights, form) != expected;
    }
  }
  return static_cast<double>(wrong) / samples;
}

TEST(ProjectedCells, PublishedFormTakesWrongExitsNearTheEyeAndTheExactOneNone) {
  EXPECT_NEAR(wrongExits(3, CellProjection::published), 0.096, 0.01);
  EXPECT_NEAR(wrongExits(10, CellProjection::published), 0.030, 0.004);
  EXPECT_NEAR(wrongExits(100, CellProjection::published), 0.003, 0.001);
  for (const double distance : {2.0, 3.0, 10.0, 100.0}) {
    EXPECT_LT(wrongExits(distance, CellProjection::exact), 1e-4) << distance;  // ties within float
  }
}

CellMesh cellMeshOf(const TetrahedralMesh& mesh) {
  CellMesh cells;
  cells.mesh = std::make_shared<TetrahedralMesh>(mesh);
  cells.faces = std::make_shared<volume::MeshFaces>(volume::facesOf(mesh, {}));
  cells.points = mesh.points_m;
  cells.values.assign(mesh.points_m.size(), 0.0F);
  return cells;
}

CameraView cameraAt(const Vec3d& eye, const Vec3d& forward, bool orthographic) {
  CameraView camera;
  camera.eye = eye;
  camera.forward = forward;
  camera.right = {forward.y, -forward.x, 0};
  camera.up = cross(camera.right, forward);
  camera.orthographic = orthographic;
  camera.size = kSize;
  return camera;
}

TEST(CellOrder, VisibilityDrawsEveryCellAfterThoseBehindItsFaces) {
  TetrahedralMesh mesh = boxMesh({7, 6, 5}, {0, 0, 0}, {6, 5, 4}, 0.2);
  volume::orientCells(mesh, {});
  const CellMesh cells = cellMeshOf(mesh);
  for (const bool orthographic : {false, true}) {
    const CameraView camera = cameraAt({-2, 2.3, 1.9}, {0.9, 0.3, -0.2}, orthographic);
    const CellOrder order = visibilityOrder(cells, camera);
    EXPECT_EQ(order.cycles, 0);
    ASSERT_EQ(order.cells.size(), mesh.cells.size());
    std::vector<std::size_t> place(order.cells.size(), ~std::size_t{0});
    for (std::size_t n = 0; n < order.cells.size(); ++n) place[static_cast<std::size_t>(order.cells[n])] = n;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      ASSERT_NE(place[c], ~std::size_t{0});
      for (std::size_t i = 0; i < 4; ++i) {
        const volume::FaceId there = cells.faces->other_side[4 * c + i];
        if (there == volume::kNoFace) continue;
        const auto& v = volume::kFaceVertices[i];
        const auto at = [&](int n) {
          return mesh.points_m[static_cast<std::size_t>(mesh.cells[c][static_cast<std::size_t>(v[n])])];
        };
        const Vec3d outward = cross(at(1) - at(0), at(2) - at(0));
        const double away = orthographic ? dot(outward, camera.forward) : dot(outward, at(0) - camera.eye);
        if (std::fabs(away) < 1e-12) continue;
        EXPECT_EQ(away > 0, place[c] > place[static_cast<std::size_t>(there / 4)]);
      }
    }
  }
}

TEST(CellOrder, CentroidsAreOrderedFarthestFirst) {
  TetrahedralMesh mesh = boxMesh({40, 30, 20}, {0, 0, 0}, {4, 3, 2}, 0.2);
  volume::orientCells(mesh, {});
  const CellMesh cells = cellMeshOf(mesh);
  const Vec3d eye{-2, 1.3, 1.9};
  const CellOrder order = centroidOrder(cells, cameraAt(eye, {1, 0, 0}, false));
  double last = HUGE_VAL;
  std::vector<bool> seen(mesh.cells.size());
  for (const std::int32_t cell : order.cells) {
    Vec3d sum{0, 0, 0};
    for (const std::int32_t point : mesh.cells[static_cast<std::size_t>(cell)]) {
      sum = sum + mesh.points_m[static_cast<std::size_t>(point)];
    }
    const double here = length(sum * 0.25 - eye);
    ASSERT_LE(here, last * (1 + 1e-6));
    last = here;
    seen[static_cast<std::size_t>(cell)] = true;
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), false), 0);
}

}  // namespace
}  // namespace emscape::render
