#include "emscape/emfield/columns/terrain_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/scenario/file/scenario_file.h"
#include "tests/emfield/made_terrain.h"
#include "tests/emfield/test_scenario.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"

namespace emscape::emfield {
namespace {

using ::testing::HasSubstr;
using namespace emscape::emfield::testing;
using test::errorOf;

TEST(TerrainMeshSpec, IsParsed) {
  const TerrainMeshSpec spec = parseTerrainMesh("terrain:32,2.5,1.25");
  EXPECT_EQ(spec.layers, 32);
  EXPECT_EQ(spec.first_m.value(), 2.5);
  EXPECT_EQ(spec.ratio.value(), 1.25);
  EXPECT_FALSE(parseTerrainMesh("terrain:8").first_m);
  const auto errorAt = [](const char* text) {
    return errorOf([&] { parseTerrainMesh(text); }, ErrorCode::usage);
  };
  EXPECT_THAT(errorAt("grid:8"), HasSubstr("mesh 'grid:8': the only kind is terrain"));
  EXPECT_THAT(errorAt("terrain"), HasSubstr("mesh 'terrain': LAYERS is missing; expected terrain:LAYERS"));
  EXPECT_THAT(errorAt("terrain:0"), HasSubstr("LAYERS '0' must be a number 1..4096"));
  EXPECT_THAT(errorAt("terrain:2.5"), HasSubstr("LAYERS '2.5' is not whole"));
  EXPECT_THAT(errorAt("terrain:8,-1"), HasSubstr("FIRST_M '-1' must be a number 0.01..10000"));
  EXPECT_THAT(errorAt("terrain:8,1,nan"), HasSubstr("RATIO 'nan' must be a number 1..3"));
  EXPECT_THAT(errorAt("terrain:8,1,1.1,3"), HasSubstr("4 values; expected terrain:LAYERS"));
}

TEST(TerrainMeshSpec, LayersGrowUpToTheTop) {
  const std::vector<double> given = layerHeights_m({3, 2.0, 1.5}, 1000);
  EXPECT_EQ(given, (std::vector<double>{0, 2, 5, 9.5}));
  const std::vector<double> fitted = layerHeights_m({20, {}, {}}, 5764);
  EXPECT_EQ(fitted.size(), 21U);
  EXPECT_EQ(fitted.front(), 0);
  EXPECT_DOUBLE_EQ(fitted[1], 5);
  EXPECT_EQ(fitted.back(), 5764);
  const double ratio = (fitted[2] - fitted[1]) / 5;
  for (std::size_t n = 2; n < fitted.size(); ++n) {
    EXPECT_NEAR((fitted[n] - fitted[n - 1]) / (fitted[n - 1] - fitted[n - 2]), ratio, 1e-6);
  }
  // Even ones where the first would be too thick.
  EXPECT_NEAR(layerHeights_m({10, {}, {}}, 20)[1], 2, 1e-9);
  EXPECT_THAT(errorOf(
                  [] {
                    layerHeights_m({10, 3.0, {}}, 20);
                  },
                  ErrorCode::usage),
              HasSubstr("10 layers of at least 3 m are higher than the region, whose top is 20 m above its "
                        "lowest ground; FIRST_M must be at most 2"));
}

TEST(TerrainMeshSpec, LayersWithARatioEndAtTheHighestHeight) {
  const auto errorAt = [](const TerrainMeshSpec& spec) {
    return errorOf([&] { layerHeights_m(spec, 5000); }, ErrorCode::usage);
  };
  EXPECT_THAT(
      errorAt({40, 5.0, 2.0}),
      HasSubstr("mesh: 40 layers (LAYERS), the first of 5 m (FIRST_M), each 2 times as thick as the "
                "one below it (RATIO), reach 5.49756e+12 m above ground, outside the allowed range up "
                "to 100000 m"));
  EXPECT_THAT(errorAt({4096, 5.0, 3.0}), HasSubstr("reach an infinite height above ground"));
  EXPECT_EQ(layerHeights_m({10, 1e4, 1.0}, 5000).back(), 100e3);
  EXPECT_EQ(layerHeights_m({20, 1e4, 1.0}, 200e3).back(), 200e3) << "as high as the region";
}

class JacksboroMesh : public ::testing::Test {
 protected:
  std::shared_ptr<scenario::Scenario> load(
      const Dims& dims, propagation::PropagationModel model = propagation::PropagationModel::horizon) {
    auto loaded = std::make_shared<scenario::Scenario>(
        *scenario::loadScenario(test::sourceFile("scenarios/jacksboro.yaml")));
    loaded->region.dims = dims;
    loaded->output.quantities = {"power_density_dbwm2"};
    for (scenario::Emitter& emitter : loaded->emitters) emitter.propagation.model = model;
    if (!terrain_) terrain_ = scenario::loadTerrain(*loaded);
    return loaded;
  }
  /// The field at a time. @param surface  null: the region's voxels
  volume::DenseVolume solve(const std::shared_ptr<scenario::Scenario>& scenario,
                            const std::shared_ptr<const Surface>& surface) const {
    FieldOptions options;
    options.surface = surface;
    SolvedField solver(scenario, terrain_, options, 60);
    return *solver.volumes().front().host();
  }

  scenario::TerrainPtr terrain_;
};

TEST_F(JacksboroMesh, FollowsTheGroundInBothFrames) {
  for (const FrameKind kind : {FrameKind::altitude, FrameKind::enu}) {
    const auto scenario = load({12, 9, 10});
    scenario->region.origin.kind = kind;
    const TerrainMesh made(*scenario, terrain_.get(), {6, 10.0, {}});
    volume::TetrahedralMesh mesh = *made.mesh();
    EXPECT_EQ(mesh.points_m.size(), 12U * 9 * 7);
    EXPECT_EQ(volume::orientCells(mesh, {}), 0);
    EXPECT_EQ(volume::facesOf(mesh, {}).boundary.size(), 2U * 2 * (11 * 8 + 8 * 6 + 6 * 11));
    const GeoFrame frame(mesh.frame);
    for (std::size_t n = 0; n < mesh.points_m.size(); n += 7) {
      const GeodeticPosition at = frame.toGeodetic(mesh.points_m[n]);
      const double height_m = made.surface()->heights_m[n / (12 * 9)];
      EXPECT_NEAR(at.height_ellipsoid_m - geoidUndulation_m(at.latitude_deg, at.longitude_deg),
                  terrain_->heightMsl_m(at.latitude_deg, at.longitude_deg) + height_m, 0.01);
      const Surface::Position& position = made.surface()->positions[n % (12 * 9)];
      EXPECT_NEAR(at.latitude_deg, position.latitude_deg, 1e-7);
      EXPECT_NEAR(at.longitude_deg, position.longitude_deg, 1e-7);
    }
  }
}

TEST_F(JacksboroMesh, HoldsTheSolversValuesAtItsPoints) {
  const auto scenario = load({9, 8, 10});
  const TerrainMesh mesh(*scenario, terrain_.get(), {5, {}, {}});
  volume::DenseVolume values = solve(scenario, mesh.surface());
  const volume::MeshField field = mesh.field(values);
  EXPECT_THAT(field.values, ::testing::ElementsAreArray(values.values));
  EXPECT_EQ(field.info.quantity, "power_density_dbwm2");
  values.first_valid_k.assign(72, 0);
  values.first_valid_k[3] = 2;
  EXPECT_EQ(volume::statisticsOf(mesh.field(values)).nan, 2);
}

TEST_F(JacksboroMesh, ColumnsOverHolesAreLeftOut) {
  const auto scenario = load({20, 20, 10});
  const MadeTerrain holed(36.303, -84.246, 0.42, 0.05);
  const TerrainMesh made(*scenario, &holed, {4, {}, {}});
  volume::TetrahedralMesh mesh = *made.mesh();
  EXPECT_EQ(volume::orientCells(mesh, {}), 0);
  EXPECT_GT(volume::facesOf(mesh, {}).boundary.size(), 2U * 2 * (19 * 19 + 2 * 19 * 4) - 2U * 2 * 40);
  EXPECT_LT(mesh.points_m.size(), 20U * 20 * 5);
  EXPECT_GT(mesh.points_m.size(), 20U * 20 * 5 - 5U * 40);
  // Each point has the value of its position and height.
  volume::DenseVolume values;
  for (int n = 0; n < 20 * 20 * 5; ++n) values.values.push_back(static_cast<float>(n));
  const volume::MeshField field = made.field(values);
  const volume::Grid grid = gridOf(scenario->region);
  for (std::size_t n = 0; n < field.values.size(); ++n) {
    const int index = static_cast<int>(field.values[n]) % 400;
    EXPECT_NEAR(mesh.points_m[n].x, grid.center_m(index % 20, 0, 0).x, 1e-6);
    EXPECT_NEAR(mesh.points_m[n].y, grid.center_m(0, index / 20, 0).y, 1e-6);
  }
}

TEST_F(JacksboroMesh, RefusesRegionsThatHoldNone) {
  const auto scenario = load({1, 8, 10});
  EXPECT_THAT(errorOf(
                  [&] {
                    TerrainMesh(*scenario, terrain_.get(), {5, {}, {}});
                  },
                  ErrorCode::bad_input),
              HasSubstr("a mesh over 1 x 8 columns (region.dims): at least 2 x 2 are needed"));
  scenario->region.dims = {4000, 4000, 10};
  EXPECT_THAT(errorOf([&] {
                TerrainMesh(*scenario, terrain_.get(), {4000, {}, {}});
              }),
              HasSubstr("at most 536870912 can be used"));
  scenario->region.dims = {4, 4, 4};
  scenario->region.size_m.z = 10;
  EXPECT_THAT(errorOf([&] {
                TerrainMesh(*scenario, terrain_.get(), {5, {}, {}});
              }),
              HasSubstr("the region ends below the ground"));
}

/// A regular grid's value, trilinear; below ground its columns repeat their lowest value, as they are drawn.
double gridValue(const volume::DenseVolume& volume, const Vec3d& at_m) {
  const volume::Grid& grid = volume.grid;
  const Vec3d offset = at_m - grid.first_center_m;
  const double p[3] = {offset.x / grid.spacing_m.x, offset.y / grid.spacing_m.y, offset.z / grid.spacing_m.z};
  const int last[3] = {grid.dims.x - 1, grid.dims.y - 1, grid.dims.z - 1};
  int low[3];
  double part[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double held = std::clamp(p[axis], 0.0, static_cast<double>(last[axis]));
    low[axis] = std::min(static_cast<int>(held), last[axis] - 1);
    part[axis] = held - low[axis];
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1, dy = (corner >> 1) & 1, dz = corner >> 2;
    const int i = low[0] + dx, j = low[1] + dy;
    int k = low[2] + dz;
    if (!volume.first_valid_k.empty())
      k = std::max<int>(k, volume.first_valid_k[static_cast<std::size_t>(j) * grid.dims.x + i]);
    sum += (dx != 0 ? part[0] : 1 - part[0]) * (dy != 0 ? part[1] : 1 - part[1]) *
           (dz != 0 ? part[2] : 1 - part[2]) *
           static_cast<double>(volume.values[static_cast<std::size_t>(grid.index(i, j, k))]);
  }
  return sum;
}

/// A field on a mesh of a lattice of columns, linear in each cell; NaN outside.
double meshValue(const volume::MeshField& field, const volume::Grid& grid, int layers, const Vec3d& at_m) {
  const int i =
      std::min(static_cast<int>((at_m.x - grid.first_center_m.x) / grid.spacing_m.x), grid.dims.x - 2);
  const int j =
      std::min(static_cast<int>((at_m.y - grid.first_center_m.y) / grid.spacing_m.y), grid.dims.y - 2);
  for (int k = 0; k < layers; ++k) {
    const std::size_t first = 6 * (static_cast<std::size_t>(k) * (grid.dims.y - 1) * (grid.dims.x - 1) +
                                   static_cast<std::size_t>(j) * (grid.dims.x - 1) + i);
    for (std::size_t n = first; n < first + 6; ++n) {
      const auto& cell = field.mesh->cells[n];
      const auto corner = [&](int c) {
        return field.mesh->points_m[static_cast<std::size_t>(cell[static_cast<std::size_t>(c)])] - at_m;
      };
      double weight[4], total = 0, value = 0;
      for (int c = 0; c < 4; ++c) {
        const int* v = volume::kFaceVertices[c];
        weight[c] = dot(cross(corner(v[0]), corner(v[1])), corner(v[2]));
        total += weight[c];
      }
      if (std::any_of(weight, weight + 4, [&](double w) { return w < -1e-9 * total; })) continue;
      for (int c = 0; c < 4; ++c)
        value +=
            weight[c] / total *
            static_cast<double>(field.values[static_cast<std::size_t>(cell[static_cast<std::size_t>(c)])]);
      return value;
    }
  }
  return std::nan("");
}

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class JacksboroMeshOfModel : public JacksboroMesh,
                             public ::testing::WithParamInterface<propagation::PropagationModel> {};

TEST_P(JacksboroMeshOfModel, NearTheGroundErrsAtMostAThirdAsMuchAsAGridOfAsManyPoints) {
  const Dims grid_dims{72, 72, 40};
  const TerrainMeshSpec spec{19, 5.0, {}};
  const Dims mesh_dims{102, 102, 40};
  ASSERT_LE(mesh_dims.x * mesh_dims.y * (spec.layers + 1), 1.005 * grid_dims.count());
  const auto scenario = load(grid_dims, GetParam());
  const volume::DenseVolume grid = solve(scenario, nullptr);
  const auto for_mesh = load(mesh_dims, GetParam());
  const TerrainMesh mesh(*for_mesh, terrain_.get(), spec);
  const volume::MeshField field = mesh.field(solve(for_mesh, mesh.surface()));

  // At random within the columns of both, below 200 m above ground.
  constexpr int kPoints = 20000;
  const GeoFrame frame(grid.grid.frame);
  const double half_m = -grid.grid.first_center_m.x;
  std::mt19937 random(20);
  std::uniform_real_distribution<double> across(-half_m, half_m), above(0, 200);
  auto surface = std::make_shared<Surface>();
  surface->width = kPoints;
  surface->height = 1;
  surface->heights_m = {0};
  std::vector<Vec3d> points_m;
  for (int n = 0; n < kPoints; ++n) {
    const double x_m = across(random), y_m = across(random);
    const auto height_m = static_cast<float>(above(random));
    const GeodeticPosition at = frame.toGeodetic({x_m, y_m, 0});
    surface->positions.push_back({at.latitude_deg, at.longitude_deg});
    surface->offsets_m.push_back(height_m);
    points_m.push_back(
        {x_m, y_m, terrain_->heightMsl_m(at.latitude_deg, at.longitude_deg) + static_cast<double>(height_m)});
  }
  const volume::DenseVolume truth = solve(scenario, surface);
  std::vector<double> grid_db, mesh_db;
  int below = 0;
  for (std::size_t n = 0; n < points_m.size(); ++n) {
    // In shadow (horizon) both hold the floor, and the error is 0.
    if (truth.values[n] == truth.info.floor) continue;
    const double exact = static_cast<double>(truth.values[n]);
    // Where the ground is lower than the mesh between its columns: the lowest value above, as for the grid.
    Vec3d inside_m = points_m[n];
    const auto value = [&] { return meshValue(field, gridOf(for_mesh->region), spec.layers, inside_m); };
    double on_mesh = value();
    if (std::isnan(on_mesh)) ++below;
    while (std::isnan(on_mesh) && inside_m.z < points_m[n].z + 500) {
      inside_m.z += 1;
      on_mesh = value();
    }
    ASSERT_FALSE(std::isnan(on_mesh));
    mesh_db.push_back(std::abs(on_mesh - exact));
    grid_db.push_back(std::abs(gridValue(grid, points_m[n]) - exact));
  }
  std::printf(
      "%s: below 200 m above ground, %zu points in the field: median error %.3f dB on a grid of %lld points, "
      "%.3f dB on a mesh of %zu; %d of them below its floor\n",
      propagation::toString(GetParam()), mesh_db.size(), medianOf(grid_db), grid_dims.count(),
      medianOf(mesh_db), field.values.size(), below);
  EXPECT_LE(medianOf(mesh_db), medianOf(grid_db) / 3);
}

INSTANTIATE_TEST_SUITE_P(EachModel, JacksboroMeshOfModel,
                         ::testing::Values(propagation::PropagationModel::horizon,
                                           propagation::PropagationModel::diffraction));

}  // namespace
}  // namespace emscape::emfield
