#include "emscape/volume/mesh/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/errors.h"
#include "tests/support/meshes.h"

namespace emscape::volume {
namespace {

using test::boxMesh;
using test::errorOf;
using ::testing::HasSubstr;

const SourceLocation kFile{"a.vtu"};

double volumeOf(const TetrahedralMesh& mesh) {
  double sum = 0;
  for (const auto& cell : mesh.cells) {
    const auto p = [&](std::size_t n) { return mesh.points_m[static_cast<std::size_t>(cell[n])]; };
    sum += dot(cross(p(1) - p(0), p(2) - p(0)), p(3) - p(0)) / 6;
  }
  return sum;
}

TetrahedralMesh oneCell() {
  TetrahedralMesh mesh;
  mesh.points_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.cells = {{0, 1, 2, 3}};
  return mesh;
}

TEST(Mesh, LatticeCellsFillTheBoxAndConform) {
  TetrahedralMesh mesh = boxMesh({4, 5, 6}, {-1, 0, 2}, {3, 7, 4}, 0.2);
  EXPECT_EQ(mesh.cells.size(), 6U * 3 * 4 * 5);
  EXPECT_EQ(orientCells(mesh, kFile), 0);
  EXPECT_NEAR(volumeOf(mesh), 4 * 7 * 2, 1e-12 * 56);
  const MeshFaces faces = facesOf(mesh, kFile);
  // Two triangles for each square of the box's sides.
  EXPECT_EQ(faces.boundary.size(), 2U * 2 * (3 * 4 + 4 * 5 + 5 * 3));
  for (std::size_t id = 0; id < faces.other_side.size(); ++id) {
    const FaceId other = faces.other_side[id];
    if (other == kNoFace) continue;
    EXPECT_EQ(faces.other_side[static_cast<std::size_t>(other)], static_cast<FaceId>(id));
  }
}

TEST(Mesh, ThinLayersOverSteepGroundAreNotInverted) {
  TetrahedralMesh mesh = boxMesh({9, 9, 5}, {0, 0, 0}, {800, 800, 4});
  for (Vec3d& point : mesh.points_m) point.z += 300 * std::sin(point.x) * std::cos(1.7 * point.y);
  EXPECT_EQ(orientCells(mesh, kFile), 0);
  EXPECT_NEAR(volumeOf(mesh), 800.0 * 800 * 4, 1e-6);
  EXPECT_EQ(facesOf(mesh, kFile).boundary.size(), 2U * 2 * (8 * 8 + 8 * 4 + 4 * 8));
}

TEST(Mesh, InvertedCellsAreReordered) {
  TetrahedralMesh mesh = oneCell();
  std::swap(mesh.cells[0][0], mesh.cells[0][3]);
  EXPECT_LT(volumeOf(mesh), 0);
  EXPECT_EQ(orientCells(mesh, kFile), 1);
  EXPECT_NEAR(volumeOf(mesh), 1.0 / 6, 1e-15);
  EXPECT_EQ(orientCells(mesh, kFile), 0);
}

TEST(Mesh, RefusesInvalidMeshes) {
  const auto errorAfter = [](const std::function<void(TetrahedralMesh&)>& damage) {
    TetrahedralMesh mesh = oneCell();
    damage(mesh);
    return errorOf([&] { orientCells(mesh, kFile); }, ErrorCode::bad_input);
  };
  EXPECT_THAT(errorAfter([](auto& m) { m.cells.clear(); }), HasSubstr("a.vtu: the mesh has no cells"));
  EXPECT_THAT(errorAfter([](auto& m) { m.points_m[2].y = std::nan(""); }),
              HasSubstr("point 2 has a coordinate that is not finite"));
  EXPECT_THAT(errorAfter([](auto& m) { m.cells[0][1] = 4; }),
              HasSubstr("cell 0 (points 0, 4, 2, 3): points must be 0..3"));
  EXPECT_THAT(errorAfter([](auto& m) { m.cells[0][1] = -1; }), HasSubstr("points must be 0..3"));
  EXPECT_THAT(errorAfter([](auto& m) { m.cells[0][1] = 0; }), HasSubstr("is degenerate"));
  EXPECT_THAT(errorAfter([](auto& m) {
                m.points_m[3] = {0.3, 0.4, 0};
              }),
              HasSubstr("cell 0 (points 0, 1, 2, 3) is degenerate: it has no volume"));
}

TEST(Mesh, ThinCellsAreNoFault) {
  TetrahedralMesh mesh = oneCell();
  for (Vec3d& point : mesh.points_m) point = {point.x * 1e4, point.y * 1e4, point.z * 1e-3};
  EXPECT_EQ(orientCells(mesh, kFile), 0);
}

TEST(Mesh, RefusesFacesThatDoNotConform) {
  TetrahedralMesh mesh = oneCell();
  mesh.points_m.push_back({1, 1, 1});
  mesh.points_m.push_back({2, 2, 1});
  mesh.cells.push_back({1, 2, 3, 4});
  orientCells(mesh, kFile);
  EXPECT_EQ(facesOf(mesh, kFile).boundary.size(), 6U);
  mesh.cells.push_back({1, 2, 3, 5});
  orientCells(mesh, kFile);
  EXPECT_THAT(errorOf([&] { facesOf(mesh, kFile); }, ErrorCode::bad_input),
              HasSubstr("the face of points 1, 2, 3 belongs to 3 cells, among them cell 0"));
  mesh.cells.erase(mesh.cells.begin());
  EXPECT_THAT(errorOf([&] { facesOf(mesh, kFile); }), HasSubstr("on its same side: they overlap"));
}

TEST(MeshContacts, MeshesThatConformHaveNone) {
  TetrahedralMesh mesh = boxMesh({5, 4, 6}, {-1, 0, 2}, {3, 7, 4});
  // Rugged ground, a gap above, and a box beside.
  for (Vec3d& point : mesh.points_m) point.z += 0.6 * std::sin(2 * point.x) * std::cos(1.7 * point.y);
  test::append(mesh, boxMesh({3, 5, 3}, {-1, 0, 6}, {3, 7, 7}));
  test::append(mesh, boxMesh({2, 2, 2}, {3.1, 0, 2}, {4, 7, 9}));
  EXPECT_EQ(touchingFaces(mesh, facesOf(mesh, kFile), kFile), 0);
  TetrahedralMesh thin = oneCell();
  for (Vec3d& point : thin.points_m) point = {point.x * 1e4, point.y * 1e4, point.z * 1e-3};
  EXPECT_EQ(touchingFaces(thin, facesOf(thin, kFile), kFile), 0);
}

TEST(MeshContacts, FacesOnFacesOfOthersAreCounted) {
  // The side of one box is cut into 8 faces, the one on it into 18: none is shared.
  TetrahedralMesh mesh = boxMesh({3, 3, 3}, {0, 0, 0}, {1, 1, 1});
  test::append(mesh, boxMesh({4, 4, 4}, {0, 0, 1}, {1, 1, 2}));
  EXPECT_EQ(touchingFaces(mesh, facesOf(mesh, kFile), kFile), 8 + 18);
  // So is rounding to single precision, far from the origin.
  for (Vec3d& point : mesh.points_m) {
    const auto stored = [](double at) { return static_cast<double>(static_cast<float>(at)); };
    point = {stored(1e3 * point.x + 5e5), stored(1e3 * point.y + 4e6),
             stored(100 * point.z + 0.3 * point.x - 0.2 * point.y)};
  }
  EXPECT_EQ(touchingFaces(mesh, facesOf(mesh, kFile), kFile), 8 + 18);
  // A vertex in the face of two cells divides it for one of them alone: 1 + 3 faces.
  TetrahedralMesh split = oneCell();
  split.points_m.push_back({1, 1, 1});
  split.points_m.push_back({1. / 3, 1. / 3, 1. / 3});
  split.cells.insert(split.cells.end(), {{1, 2, 5, 4}, {2, 3, 5, 4}, {3, 1, 5, 4}});
  orientCells(split, kFile);
  EXPECT_EQ(touchingFaces(split, facesOf(split, kFile), kFile), 4);
}

TEST(MeshContacts, RefusesCellsThatOverlapWithoutACommonFace) {
  const auto errorWith = [](const Vec3d& lower, const Vec3d& upper, const Dims& points) {
    TetrahedralMesh mesh = boxMesh({3, 3, 3}, {0, 0, 0}, {1, 1, 1});
    test::append(mesh, boxMesh(points, lower, upper));
    const MeshFaces faces = facesOf(mesh, kFile);
    return errorOf([&] { touchingFaces(mesh, faces, kFile); }, ErrorCode::bad_input);
  };
  const auto overlap = ::testing::MatchesRegex(
      "a.vtu: cell [0-9]+ \\(points [0-9 ,]+\\) and cell [0-9]+ \\(points [0-9 ,]+\\) overlap, at "
      "\\([-0-9. ,]+\\)");
  // Within a cell; through the box; shifted; the same box again; a corner alone.
  EXPECT_THAT(errorWith({0.1, 0.2, 0.3}, {0.12, 0.22, 0.32}, {2, 2, 2}), overlap);
  EXPECT_THAT(errorWith({0.3, 0.3, -1}, {0.4, 0.4, 2}, {2, 2, 2}), overlap);
  EXPECT_THAT(errorWith({0.5, 0, 0}, {1.5, 1, 1}, {3, 3, 3}), overlap);
  EXPECT_THAT(errorWith({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}, {3, 3, 3}), overlap);
  EXPECT_THAT(errorWith({0, 0, 0}, {1, 1, 1}, {4, 4, 4}), overlap);
  EXPECT_THAT(errorWith({0.97, 0.97, 0.97}, {2, 2, 2}, {3, 3, 3}), overlap);
  // Beside it.
  EXPECT_EQ(errorWith({1.001, 0, 0}, {2, 1, 1}, {3, 3, 3}), "");
}

TEST(Mesh, StatisticsOmitUnknownValues) {
  MeshField field = test::fieldOn(oneCell(), [](const Vec3d& p) { return p.x + 2 * p.y; });
  field.values[3] = std::numeric_limits<float>::quiet_NaN();
  const Statistics statistics = statisticsOf(field);
  EXPECT_EQ(statistics.voxels, 4);
  EXPECT_EQ(statistics.valid, 3);
  EXPECT_EQ(statistics.nan, 1);
  EXPECT_EQ(statistics.max, 2);
  EXPECT_DOUBLE_EQ(statistics.mean, 1);
  field.values[1] = std::numeric_limits<float>::infinity();
  EXPECT_THAT(errorOf([&] { checkMeshField(field, kFile); }), HasSubstr("is infinite at point 1"));
}

}  // namespace
}  // namespace emscape::volume
