#include "render/cells/tile_projection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "emscape/base/error.h"
#include "emscape/render/cells/cell_renderer.h"
#include "tests/render/instruction_sets.h"
#include "tests/support/errors.h"
#include "tests/support/meshes.h"
#include "tests/support/on_backends.h"

namespace emscape::render {
namespace {

using test::boxMesh;
using test::fieldOn;
using volume::MeshField;
using volume::TetrahedralMesh;

constexpr ImageSize kSize{161, 121};  // the middle pixel is on the axis
const Vec3d kUpper{1000, 800, 500};

double wave(const Vec3d& p) {
  return std::sin(p.x / 150) + p.z / 300 + std::cos(p.y / 200);
}

MeshField oriented(TetrahedralMesh mesh) {
  volume::orientCells(mesh, {});
  return fieldOn(std::move(mesh), wave);
}
MeshField wavy(int points, double jitter = 0.2) {
  return oriented(boxMesh({points, points, points}, {0, 0, 0}, kUpper, jitter));
}

std::shared_ptr<const HeightField> hill() {
  auto ground = std::make_shared<HeightField>();
  ground->columns = ground->rows = 3;
  ground->spacing_x_m = 500;
  ground->spacing_y_m = 400;
  ground->heights_m = {0, 100, 0, 50, 450, 100, 0, 200, 0};
  return ground;
}

void prepare(CellRenderer& renderer, const MeshField& field, const std::string& camera, bool exact = true) {
  TransferFunction function;
  function.colors = {{-2, {0.1F, 0.2F, 0.9F}}, {0.4, {0.9F, 0.8F, 0.1F}}, {3, {0.9F, 0.1F, 0.2F}}};
  function.opacities = {{-1, 0}, {0, 0}, {0.2, 0.3}, {0.4, 0.02}, {3, 0.1}};
  RenderSettings settings;
  settings.exact = exact;
  renderer.setSettings(settings);
  renderer.setField(field, std::make_shared<volume::MeshFaces>(volume::facesOf(*field.mesh, {})));
  renderer.setTransferFunction(function);
  renderer.setCamera(makeCamera(parseCamera(camera), renderer.sceneBox(), kSize));
}

ProjectionOptions byTiles(CellSorting sorting = CellSorting::visibility) {
  return {CellProjection::exact, sorting, Rasterizer::tiles};
}

double greatestDifference(const Image& a, const Image& b) {
  double greatest = 0;
  for (std::size_t n = 0; n < a.pixels.size(); ++n) {
    const Rgba &p = a.pixels[n], &q = b.pixels[n];
    for (const float d : {p.r - q.r, p.g - q.g, p.b - q.b, p.a - q.a})
      greatest = std::max(greatest, static_cast<double>(std::fabs(d)));
  }
  return greatest;
}

constexpr const char* kCameras[] = {
    "orbit", "orbit:projection=orthographic", "orbit:azimuth_deg=20,elevation_deg=70",
    "orbit:azimuth_deg=180,elevation_deg=-40,projection=orthographic",
    // Within the mesh, and before a side of it.
    "orbit:distance=0.1", "orbit:distance=0.4,elevation_deg=-20",
    "lookat:eye_x_m=300,eye_y_m=200,eye_z_m=240,target_x_m=900,target_y_m=700,"
    "target_z_m=260,fov_deg=100"};

class TileProjections : public test::OnBackends {
 protected:
  /// Max difference between the projected and the marched picture.
  static double difference(const MeshField& field, const std::string& camera,
                           std::shared_ptr<const HeightField> ground = nullptr, bool exact = true) {
    CellRenderer march, project(GetParam());
    for (CellRenderer* renderer : {&march, &project}) {
      prepare(*renderer, field, camera, exact);
      renderer->setHeightField(ground);
    }
    ProjectionReport report;
    const Image image = project.project(kSize, byTiles(), &report);
    EXPECT_EQ(report.rasterizer, Rasterizer::tiles);
    EXPECT_EQ(report.device, toString(GetParam()));
    EXPECT_EQ(report.cycles, 0);
    EXPECT_GT(report.cells, 0);
    return greatestDifference(image, march.render(kSize));
  }
};
EMSCAPE_ON_BACKENDS(TileProjections);

TEST_P(TileProjections, SLOW_EqualMarchedPictureInAllPixels) {
  const MeshField field = wavy(8);
  for (const char* camera : kCameras) {
    EXPECT_LT(difference(field, camera), 1e-5) << camera;
    EXPECT_LT(difference(field, camera, nullptr, false), 1e-5) << camera << " by table";
  }
}

TEST_P(TileProjections, SLOW_KeepRaysInPlanesAndAlongEdgesOfCells) {
  // Rows and columns of pixels are in inner planes of a regular lattice, some pixels on its edges.
  const MeshField field = wavy(9, 0);
  const double fov_deg = 2 * std::atan(0.5 * 121 * 3.125 / 2000) * 180 / 3.14159265358979323846;
  const std::string along_y =
      "lookat:eye_x_m=500,eye_y_m=-1600,eye_z_m=250,target_x_m=500,target_y_m=400,"
      "target_z_m=250,fov_deg=" +
      std::to_string(fov_deg);
  for (const std::string& camera :
       {along_y, along_y + ",projection=orthographic", std::string("orbit:elevation_deg=90"),
        std::string("orbit:elevation_deg=90,projection=orthographic"),
        std::string("orbit:azimuth_deg=90,elevation_deg=0,projection=orthographic"),
        std::string("orbit:azimuth_deg=45,elevation_deg=0,projection=orthographic"),
        // At a point of the lattice, and in one of its planes.
        std::string(
            "lookat:eye_x_m=500,eye_y_m=400,eye_z_m=250,target_x_m=900,target_y_m=400,target_z_m=250"),
        std::string(
            "lookat:eye_x_m=510,eye_y_m=400,eye_z_m=260,target_x_m=900,target_y_m=410,target_z_m=250")}) {
    EXPECT_LT(difference(field, camera), 1e-5) << camera;
  }
}

TEST_P(TileProjections, AreRightInMeshesWithGapsAndHoles) {
  TetrahedralMesh slabs = boxMesh({7, 6, 3}, {0, 0, 0}, {1000, 800, 150}, 0.2);
  test::append(slabs, boxMesh({5, 7, 4}, {0, 0, 300}, kUpper, 0.2));
  MeshField holed = wavy(9);
  for (std::size_t point = 0; point < holed.values.size(); point += 50) holed.values[point] = std::nanf("");
  for (const char* camera : {"orbit:elevation_deg=80", "orbit:elevation_deg=70,projection=orthographic"}) {
    EXPECT_LT(difference(oriented(slabs), camera), 1e-5) << camera;
    EXPECT_LT(difference(holed, camera), 1e-5) << camera;
  }
}

TEST_P(TileProjections, TheGroundEndsRays) {
  for (const char* camera : {"orbit", "orbit:projection=orthographic", "orbit:distance=0.3"}) {
    EXPECT_LT(difference(wavy(8), camera, hill()), 1e-5) << camera;
  }
}

TEST_P(TileProjections, SLOW_TheOrderOfVerticesAndCellsDoesNotMatter) {
  const MeshField field = wavy(8);
  TetrahedralMesh shuffled = *field.mesh;
  std::mt19937 random(11);
  for (auto& cell : shuffled.cells) std::shuffle(cell.begin(), cell.end(), random);
  std::shuffle(shuffled.cells.begin(), shuffled.cells.end(), random);
  const MeshField other = oriented(std::move(shuffled));
  for (const char* camera : kCameras) {
    CellRenderer a(GetParam()), b(GetParam());
    prepare(a, field, camera);
    prepare(b, other, camera);
    EXPECT_LT(greatestDifference(a.project(kSize, byTiles()), b.project(kSize, byTiles())), 1e-5) << camera;
  }
}

TEST_P(TileProjections, AreOrderedByCentroidsAlikeOnAllBackends) {
  for (const char* camera : kCameras) {
    CellRenderer cpu, other(GetParam());
    prepare(cpu, wavy(8), camera);
    prepare(other, wavy(8), camera);
    const ProjectionOptions options = byTiles(CellSorting::centroids);
    EXPECT_LT(greatestDifference(cpu.project(kSize, options), other.project(kSize, options)), 1e-5) << camera;
  }
}

TEST_P(TileProjections, HaveOnlyTheExactForm) {
  CellRenderer renderer(GetParam());
  prepare(renderer, wavy(4), "orbit");
  ProjectionOptions published = byTiles();
  published.projection = CellProjection::published;
  EXPECT_THAT(test::errorOf([&] { renderer.project(kSize, published); }, ErrorCode::usage),
              ::testing::HasSubstr("tiles of pixels support only the exact form"));
  // With parallel rays both forms are equal.
  prepare(renderer, wavy(4), "orbit:projection=orthographic");
  EXPECT_EQ(greatestDifference(renderer.project(kSize, published), renderer.project(kSize, byTiles())), 0);
}

TEST(TileProjection, ReplacesOpenGlOnCpu) {
  CellRenderer renderer;
  prepare(renderer, wavy(4), "orbit");
  bool on_gpu = false;
  try {
    on_gpu = !renderer.projectsOnCpu();
  } catch (const Error&) {
  }
  ProjectionReport report;
  renderer.project(kSize, {}, &report);
  EXPECT_EQ(report.rasterizer, on_gpu ? Rasterizer::opengl : Rasterizer::tiles);
}

// From low cameras cells on both sides of a gap are in the wrong order by their centroids.
TEST_P(TileProjections, SortRaysWhereTheOrderOfCellsIsWrong) {
  TetrahedralMesh slabs = boxMesh({12, 12, 3}, {0, 0, 0}, {1000, 800, 150}, 0.2);
  test::append(slabs, boxMesh({3, 2, 2}, {0, 0, 160}, kUpper, 0));
  const MeshField field = oriented(std::move(slabs));
  for (const char* camera : {"orbit:elevation_deg=10", "orbit:azimuth_deg=30,elevation_deg=25",
                             "orbit:elevation_deg=-15,projection=orthographic"}) {
    for (const bool exact : {true, false}) {
      CellRenderer renderer(GetParam());
      prepare(renderer, field, camera, exact);
      const Image marched = renderer.render(kSize);
      EXPECT_LT(greatestDifference(renderer.project(kSize, byTiles()), marched), 1e-5) << camera << exact;
      EXPECT_GT(greatestDifference(renderer.project(kSize, byTiles(CellSorting::centroids)), marched), 1e-3);
    }
  }
}

class TileLanes : public test::OnInstructionSet {};
EMSCAPE_ON_INSTRUCTION_SETS(TileLanes);

TEST_P(TileLanes, EqualPlainForm) {
  const MeshField field = wavy(8);
  for (const char* camera : kCameras) {
    CellRenderer renderer;
    prepare(renderer, field, camera, false);
    renderer.setHeightField(hill());
    EXPECT_LT(greatestDifference(renderer.project(kSize, byTiles()), renderer.render(kSize)), 1e-5) << camera;
  }
}

TEST(TileLists, HaveEachBoxInTheTilesThatItTouches) {
  const TileGrid grid{{70, 40}};
  EXPECT_EQ(grid.count(), 15);
  std::vector<PixelBox> boxes;
  std::mt19937 random(3);
  const auto upTo = [&](int limit) { return static_cast<int>(random() % static_cast<unsigned>(limit + 1)); };
  for (int n = 0; n < 100000; ++n) boxes.push_back({upTo(70), upTo(40), upTo(70), upTo(40)});
  const TileLists lists(grid, boxes.size(), [&](std::size_t n) { return boxes[n]; });
  for (int tile = 0; tile < grid.count(); ++tile) {
    std::vector<int> expected;
    for (std::size_t n = 0; n < boxes.size(); ++n) {
      if (!boxes[n].isEmpty() && !common(boxes[n], grid.pixelsOf(tile)).isEmpty())
        expected.push_back(static_cast<int>(n));
    }
    const auto begin = lists.members().begin();
    const std::vector<int> got(begin + static_cast<std::ptrdiff_t>(lists.first(tile)),
                               begin + static_cast<std::ptrdiff_t>(lists.first(tile + 1)));
    ASSERT_EQ(got, expected);
  }
}

}  // namespace
}  // namespace emscape::render
