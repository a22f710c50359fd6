#include "render/cells/cell_packets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "render/cells/integral/linear_transfer.h"
#include "tests/render/instruction_sets.h"
#include "tests/support/meshes.h"

namespace emscape::render {
namespace {

using test::boxMesh;

class CellPacketsTest : public test::OnInstructionSet {};
EMSCAPE_ON_INSTRUCTION_SETS(CellPacketsTest);

/// A wavy field on two boxes with a gap, unknown at some points.
CellMesh wavy() {
  volume::TetrahedralMesh mesh = boxMesh({9, 8, 7}, {-1, -1, -1}, {1, 1, 0.2}, 0.2);
  test::append(mesh, boxMesh({5, 4, 6}, {-1, -1, 0.4}, {1, 1, 1}, 0.2));
  const volume::MeshField field = test::fieldOn(std::move(mesh), [](const Vec3d& p) {
    return 0.5 + 0.4 * std::sin(4 * p.x + p.z) * std::cos(3 * p.y - 2 * p.z);
  });
  CellMesh cells;
  cells.mesh = field.mesh;
  cells.faces = std::make_shared<volume::MeshFaces>(volume::facesOf(*field.mesh, {}));
  cells.values = field.values;
  for (std::size_t n = 0; n < cells.values.size(); n += 61) cells.values[n] = std::nanf("");
  cells.points = field.mesh->points_m;
  return cells;
}

TransferFunction functionOf(std::vector<TransferFunction::OpacityPoint> opacities) {
  TransferFunction function;
  function.colors = {{0.2, {0.1F, 0.2F, 0.9F}}, {0.4, {0.9F, 0.8F, 0.1F}}, {0.8, {0.9F, 0.1F, 0.2F}}};
  function.opacities = std::move(opacities);
  return function;
}

/// Rays towards the boxes: along the lattice, askew, from within, some with an end.
std::vector<MarchTask> raysThrough(const CellMesh& cells, double least_through) {
  std::vector<MarchTask> tasks;
  std::mt19937 random(5);
  std::normal_distribution<double> any(0, 1);
  for (int n = 0; n < 1500; ++n) {
    Vec3d direction{any(random), any(random), any(random)};
    if (n % 7 == 0) direction = {n % 3 == 0 ? 1.0 : 0.0, n % 3 == 1 ? -1.0 : 0.0, n % 3 == 2 ? 1.0 : 0.0};
    direction = normalized(direction);
    const Vec3d target = Vec3d{any(random), any(random), any(random)} * (n % 14 == 0 ? 0.0 : 0.5);
    const RayFrame frame(Ray{target - direction * (n % 5 == 0 ? 0.3 : 5.0), direction});
    const double end = n % 4 == 0 ? 4.5 + 0.5 * any(random) : std::numeric_limits<double>::infinity();
    MarchTask task{frame, {end, least_through}, {}, {}};
    for (const volume::FaceId face : cells.faces->boundary) {
      EntryHit hit;
      if (entersThrough(cells.view(), frame, face, hit)) task.entries.push_back(hit);
    }
    std::sort(task.entries.begin(), task.entries.end());
    tasks.push_back(std::move(task));
  }
  return tasks;
}

TEST_P(CellPacketsTest, EqualSingleRays) {
  const CellMesh cells = wavy();
  const PsiLookup psi = PsiTable::shared().lookup();
  const auto opaque = [](double scale) {
    return functionOf(
        {{0.2, 0}, {0.3, 0}, {0.45, 0.4 * scale}, {0.5, 0}, {0.6, 0}, {0.6, scale}, {0.9, scale}});
  };
  // A step is a length of 1 here, and the boxes are 2 wide: opacities up to 1 for segments beyond the table.
  for (const TransferFunction& function : {opaque(0.05), opaque(0.9), opaque(1), functionOf({{0, 0.3}})}) {
    const LinearTransfer transfer(function);
    for (const double least_through : {0.0, 0.3}) {
      std::vector<MarchTask> expected = raysThrough(cells, least_through), got = expected;
      const int count = static_cast<int>(got.size());
      const long long in_turn = marchInTurn(cells.view(), transfer.view(), psi, expected.data(), count);
      const long long passed = CellPackets(cells.view(), transfer.view(), psi).march(got.data(), count);
      EXPECT_GT(in_turn, 5000);
      EXPECT_NEAR(static_cast<double>(passed), static_cast<double>(in_turn), 3);
      int hits = 0;
      for (int n = 0; n < count; ++n) {
        const Rgba &a = got[static_cast<std::size_t>(n)].color,
                   &b = expected[static_cast<std::size_t>(n)].color;
        hits += b.a > 0 ? 1 : 0;
        for (const float d : {a.r - b.r, a.g - b.g, a.b - b.b, a.a - b.a})
          ASSERT_LT(std::fabs(d), 1e-6F) << "ray " << n;
      }
      EXPECT_GT(hits, 500);
    }
  }
}

TEST_P(CellPacketsTest, TakeAnyNumberOfRays) {
  const CellMesh cells = wavy();
  const LinearTransfer transfer(functionOf({{0, 0.3}}));
  const CellPackets packets(cells.view(), transfer.view(), PsiTable::shared().lookup());
  EXPECT_EQ(packets.march(nullptr, 0), 0);
  const std::vector<MarchTask> all = raysThrough(cells, 0);
  for (const int count : {1, 2, 3, 9, 31}) {
    std::vector<MarchTask> some(all.begin(), all.begin() + count), alone = some;
    const long long passed = packets.march(some.data(), count);
    long long sum = 0;
    for (int n = 0; n < count; ++n) {
      MarchTask& task = alone[static_cast<std::size_t>(n)];
      sum += packets.march(&task, 1);
      EXPECT_EQ(some[static_cast<std::size_t>(n)].color.a, task.color.a);
    }
    EXPECT_EQ(passed, sum);
  }
}

}  // namespace
}  // namespace emscape::render
