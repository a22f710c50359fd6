// Fields of which a part of the columns is computed and the others are interpolated, and their completion.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "emfield/excess/interpolate_columns.h"
#include "emfield/geometry/emitter_geometry.h"
#include "emfield/solver/column_step.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/scenario/file/scenario_file.h"
#include "tests/emfield/made_terrain.h"
#include "tests/emfield/test_scenario.h"
#include "tests/support/files.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;

constexpr double kLatitude_deg = 40, kLongitude_deg = 20;
constexpr Dims kDims{23, 18, 12};

std::size_t columnAt(int x, int y) {
  return static_cast<std::size_t>(y) * kDims.x + x;
}

TEST(ColumnPart, ContainsEveryStepThColumnAndTheLastOnes) {
  const ColumnPart part{4, 0};
  EXPECT_TRUE(part.contains(kDims, columnAt(0, 0)));
  EXPECT_TRUE(part.contains(kDims, columnAt(8, 16)));
  EXPECT_TRUE(part.contains(kDims, columnAt(22, 17))) << "the last column and row";
  EXPECT_FALSE(part.contains(kDims, columnAt(8, 15)));
  EXPECT_FALSE(part.contains(kDims, columnAt(9, 16)));
  for (const ColumnPart& each : {ColumnPart{1, 0}, ColumnPart{2, 0}, ColumnPart{4, 0}, ColumnPart{1, 4}}) {
    int count = 0;
    for (std::size_t c = 0; c < columnAt(0, kDims.y); ++c) count += each.contains(kDims, c) ? 1 : 0;
    EXPECT_DOUBLE_EQ(each.fraction(kDims), count / double(kDims.x * kDims.y));
  }
}

TEST(InterpolatedColumns, AreBilinearAndTakeTheNearerOneBesideUnknownColumns) {
  constexpr int kLayers = 2;
  const std::size_t columns = columnAt(0, kDims.y);
  std::vector<ExcessCode> codes(columns * kLayers, 9999);
  std::vector<float> edges_m(columns, -1);
  ExcessGrid grid;
  grid.column_count = columns;
  grid.layers = kLayers;
  grid.dims = kDims;
  grid.part = {4, 0};
  const auto planeAt = [](int x, int y, int k) { return 24 * x - 36 * y + 1000 * k; };
  const auto fill = [&] {
    for (int y = 0; y < kDims.y; ++y) {
      for (int x = 0; x < kDims.x; ++x) {
        if (!grid.part.contains(kDims, columnAt(x, y))) continue;
        edges_m[columnAt(x, y)] = static_cast<float>(planeAt(x, y, 0));
        for (int k = 0; k < kLayers; ++k)
          codes[k * columns + columnAt(x, y)] = static_cast<ExcessCode>(planeAt(x, y, k));
      }
    }
  };
  fill();
  interpolateColumnsCpu(grid, {{codes.data(), nullptr}, nullptr, nullptr, edges_m.data()});
  for (int y = 0; y < kDims.y; ++y) {
    for (int x = 0; x < kDims.x; ++x) {
      EXPECT_NEAR(edges_m[columnAt(x, y)], planeAt(x, y, 0), 1e-3);
      for (int k = 0; k < kLayers; ++k) ASSERT_NEAR(codes[k * columns + columnAt(x, y)], planeAt(x, y, k), 1);
    }
  }
  codes[columnAt(8, 8)] = kUnknownExcess;
  edges_m[columnAt(8, 8)] = NAN;
  edges_m[columnAt(16, 8)] = HUGE_VALF;
  interpolateColumnsCpu(grid, {{codes.data(), nullptr}, nullptr, nullptr, edges_m.data()});
  EXPECT_EQ(codes[columnAt(9, 8)], kUnknownExcess);
  EXPECT_EQ(codes[columnAt(11, 8)], planeAt(12, 8, 0));
  EXPECT_TRUE(std::isnan(edges_m[columnAt(9, 8)]));
  EXPECT_EQ(edges_m[columnAt(11, 8)], planeAt(12, 8, 0));
  EXPECT_EQ(edges_m[columnAt(15, 8)], HUGE_VALF);

  std::vector<std::uint16_t> first_valid(columns, 0);
  first_valid[columnAt(4, 4)] = 1;
  grid.first_valid_k = first_valid.data();
  fill();
  interpolateColumnsCpu(grid, {{codes.data(), nullptr}, nullptr, nullptr, edges_m.data()});
  EXPECT_NEAR(codes[columnAt(5, 4)], 0.75 * planeAt(4, 4, 1) + 0.25 * planeAt(8, 4, 0), 1)
      << "below the ground of a column its lowest layer above it counts";
}

TEST(ColumnPace, TakesALargerStepOnlyWhereAllColumnsTakeTooLong) {
  const auto chosen = [](double goal_ms, double rest_ms, double columns_ms, int before = 1) {
    ColumnPace pace{goal_ms, rest_ms, before};
    pace.choose(columns_ms);
    return pace.step;
  };
  EXPECT_EQ(chosen(0, 100, 1e6), 1) << "without a goal";
  EXPECT_EQ(chosen(250, 0, 0), 1) << "not measured yet";
  EXPECT_EQ(chosen(250, 50, 190), 1);
  EXPECT_EQ(chosen(250, 50, 500), 2);
  EXPECT_EQ(chosen(250, 50, 3000), 4);
  EXPECT_EQ(chosen(250, 400, 3000), 4);
  EXPECT_EQ(chosen(250, 400, 30), 1) << "a larger step would gain nothing";
  EXPECT_EQ(chosen(250, 50, 190, 2), 2) << "near the goal the step stays";
  EXPECT_EQ(chosen(250, 50, 100, 2), 1);
}

class CompletedColumns : public ::testing::TestWithParam<propagation::PropagationModel> {};

/// The geometry of a mast over terrain with a hole.
TEST_P(CompletedColumns, AreThoseOfAFieldComputedAtOnceToTheLastBit) {
  for (const FrameKind frame : {FrameKind::altitude, FrameKind::enu}) {
    auto scenario = emptyScenario(frame, kLatitude_deg, kLongitude_deg, {20e3, 20e3, 3000}, kDims);
    const auto terrain = std::make_shared<MadeTerrain>(kLatitude_deg, kLongitude_deg, 0.5, 0.04);
    scenario::Emitter emitter = plainEmitter("mast", 0);
    emitter.propagation.model = GetParam();
    addEmitter(*scenario, {kLatitude_deg, kLongitude_deg, 1500}, emitter);
    scenario->terrain = scenario::TerrainSpec{};
    const GridColumns columns = makeGridColumns(gridOf(scenario->region), terrain.get());
    const scenario::EmitterState state = scenario::snapshotAt(scenario, terrain.get(), 0).emitters.front();
    const GeometryNeeds needs{true, false, false};
    const auto compute = [&](EmitterGeometry& geometry, ColumnPart part) {
      EmitterGeometry::Times times;
      geometry.compute(state, *scenario, scenario->emitters[0], columns, terrain.get(), times, nullptr, needs,
                       part);
    };
    EmitterGeometry whole, parts;
    compute(whole, {});
    compute(parts, {4, 0});
    const bool interpolates = EmitterGeometry::interpolates(*scenario, scenario->emitters[0], columns, needs);
    EXPECT_EQ(parts.columnStep(), interpolates ? 4 : 1);
    const ColumnGeometryView a = whole.view(), b = parts.view();
    const auto sameBits = [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); };
    const auto countOfOthers = [&](const ColumnPart& part) {
      int others = 0;
      for (std::size_t c = 0; c < columns.count(); ++c) {
        if (!part.contains(kDims, c)) continue;
        others += sameBits(a.shadow_edge_m[c], parts.view().shadow_edge_m[c]) ? 0 : 1;
        for (int k = 0; k < kDims.z && a.excess.codes != nullptr; ++k) {
          const std::size_t voxel = k * columns.count() + c;
          others += a.excess.codes[voxel] == parts.view().excess.codes[voxel] ? 0 : 1;
        }
      }
      return others;
    };
    EXPECT_EQ(countOfOthers({4, 0}), 0) << "computed columns are exact";
    compute(parts, {1, 4});
    EXPECT_EQ(countOfOthers({}), 0);
    EXPECT_EQ(parts.columnStep(), 1);
    EXPECT_EQ(parts.unknownColumns(), whole.unknownColumns());
    EXPECT_EQ(parts.warnings(), whole.warnings());
    EXPECT_EQ(a.excess.isEmpty(), b.excess.isEmpty());
  }
}

std::vector<propagation::PropagationModel> modelsOfColumns() {
  using Model = propagation::PropagationModel;
  return {Model::free_space, Model::horizon, Model::two_ray, Model::diffraction, Model::itm, Model::p528};
}

INSTANTIATE_TEST_SUITE_P(Models, CompletedColumns, ::testing::ValuesIn(modelsOfColumns()),
                         [](const auto& model) { return std::string(toString(model.param)); });

/// Calls visit(emitter's whole geometry, that with a part of the columns, column, layer) for all voxels above
/// ground in interpolated columns.
template <class Visit>
void visitInterpolated(const std::shared_ptr<scenario::Scenario>& scenario, const scenario::Terrain& terrain,
                       int step, const Visit& visit) {
  const GridColumns columns = makeGridColumns(gridOf(scenario->region), &terrain);
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, &terrain, 9);
  const ColumnPart part{step, 0};
  for (std::size_t e = 0; e < scenario->emitters.size(); ++e) {
    EmitterGeometry whole, parts;
    EmitterGeometry::Times times;
    for (EmitterGeometry* geometry : {&whole, &parts}) {
      geometry->compute(snapshot.emitters[e], *scenario, scenario->emitters[e], columns, &terrain, times,
                        nullptr, {true, false, false}, geometry == &parts ? part : ColumnPart{});
    }
    for (std::size_t c = 0; c < columns.count(); ++c) {
      if (part.contains(columns.dims, c)) continue;
      for (int k = columns.first_valid_k[c]; k < columns.dims.z; ++k)
        visit(whole.view(), parts.view(), columns, c, k);
    }
  }
}

std::shared_ptr<scenario::Scenario> jacksboro(propagation::PropagationModel model) {
  const auto scenario = std::make_shared<scenario::Scenario>(
      *scenario::loadScenario(emscape::test::shippedScenario("jacksboro.yaml")));
  for (scenario::Emitter& emitter : scenario->emitters) emitter.propagation.model = model;
  scenario->region.dims.z = 20;  // errors depend on the distance of the columns
  return scenario;
}

/// The bounds of docs/viewer.md, "Fields of moving emitters".
TEST(InterpolatedColumns, SLOW_ErrByTheStatedDecibels) {
  const auto scenario = jacksboro(propagation::PropagationModel::diffraction);
  const auto radars = std::make_shared<scenario::Scenario>(*scenario);
  radars->region.dims = {100, 100, 20};
  radars->emitters.assign(16, scenario->emitters.front());
  for (int n = 0; n < 16; ++n) {
    scenario::Platform site = radars->platforms[radars->emitters[n].platform];
    scenario::SitePosition& at = site.track.front().position;
    at.latitude_deg = 36.21 + 0.06 * (n % 4);
    at.longitude_deg = -84.36 + 0.075 * (n / 4);
    radars->emitters[n].name = site.name = "radar " + std::to_string(n);
    radars->emitters[n].platform = static_cast<int>(radars->platforms.size());
    radars->platforms.push_back(site);
  }
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
  struct Bound {
    const char* name;
    std::shared_ptr<scenario::Scenario> scenario;
    int step;
    double all_db, behind_median_db, behind_db;  ///< all and behind terrain: 95 % are below
  };
  for (const Bound& bound :
       {Bound{"jacksboro", scenario, 2, 1, 1, 5}, Bound{"jacksboro", scenario, 4, 2, 2, 10},
        Bound{"sixteen radars", radars, 2, 1, 1, 5}, Bound{"sixteen radars", radars, 4, 2.5, 2, 10}}) {
    std::vector<float> errors_db, behind_db;
    visitInterpolated(bound.scenario, *terrain, bound.step,
                      [&](const ColumnGeometryView& whole, const ColumnGeometryView& parts,
                          const GridColumns& columns, std::size_t c, int k) {
                        const std::size_t voxel = k * columns.count() + c;
                        const float exact_db = excessDb(whole.excess.codes[voxel]);
                        errors_db.push_back(std::abs(exact_db - excessDb(parts.excess.codes[voxel])));
                        if (exact_db > 1) behind_db.push_back(errors_db.back());
                      });
    std::sort(errors_db.begin(), errors_db.end());
    std::sort(behind_db.begin(), behind_db.end());
    const auto of = [](const std::vector<float>& errors, std::size_t percent) {
      return double{errors[errors.size() * percent / 100]};
    };
    std::printf(
        "%s, every %d columns: all median %.2f, 95 %% %.2f dB; behind terrain (%.0f %%) median %.2f, "
        "95 %% %.2f, largest %.1f dB\n",
        bound.name, bound.step, of(errors_db, 50), of(errors_db, 95),
        100.0 * static_cast<double>(behind_db.size()) / static_cast<double>(errors_db.size()),
        of(behind_db, 50), of(behind_db, 95), double{behind_db.back()});
    EXPECT_LE(of(errors_db, 95), bound.all_db) << bound.name << bound.step;
    EXPECT_LE(of(behind_db, 50), bound.behind_median_db) << bound.name << bound.step;
    EXPECT_LE(of(behind_db, 95), bound.behind_db) << bound.name << bound.step;
  }
}

TEST(InterpolatedColumns, ShowTheShadowsOfHorizonNearlyWhereTheyAre) {
  const auto scenario = jacksboro(propagation::PropagationModel::horizon);
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
  for (const int step : {2, 4}) {
    long long all = 0, other = 0;
    visitInterpolated(
        scenario, *terrain, step,
        [&](const ColumnGeometryView& whole, const ColumnGeometryView& parts, const GridColumns& columns,
            std::size_t c, int k) {
          ++all;
          other +=
              (columns.t_m[k] < whole.shadow_edge_m[c]) != (columns.t_m[k] < parts.shadow_edge_m[c]) ? 1 : 0;
        });
    const double percent = 100.0 * double(other) / double(all);
    std::printf("jacksboro by horizon, every %d columns: %.2f %% of the voxels\n", step, percent);
    EXPECT_LE(percent, step == 2 ? 1.5 : 3);
  }
}

/// Time in which no update can be computed.
constexpr double kUnreachable_ms = 1e-3;

TEST(BusyField, IsTheFieldComputedAtOnceWhenItRests) {
  const auto scenario = std::make_shared<scenario::Scenario>(*scenario::loadScenario(
      emscape::test::shippedScenario("jacksboro.yaml"), {{"region.dims", "[60, 60, 30]"}}));
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
  const auto movedBy = [&](double north_deg) {
    scenario::Snapshot snapshot = scenario::snapshotAt(scenario, terrain.get(), 9);
    for (scenario::EmitterState& emitter : snapshot.emitters) emitter.position.latitude_deg += north_deg;
    return snapshot;
  };
  const auto valuesOf = [](const FieldSolver& solver) { return solver.volumes().front().host()->values; };
  FieldSolver solver(scenario, terrain), fresh(scenario, terrain);
  solver.setTimeGoal(kUnreachable_ms);
  solver.update(movedBy(0));
  EXPECT_EQ(solver.columnStep(), 1) << "the first update has every column";
  solver.update(movedBy(0.01));
  EXPECT_GT(solver.columnStep(), 1);
  solver.update(movedBy(0.01));
  EXPECT_GT(solver.columnStep(), 1) << "nothing has moved, and nothing is completed";
  fresh.update(movedBy(0.01));
  EXPECT_NE(valuesOf(solver), valuesOf(fresh));
  solver.setTimeGoal(0);
  EXPECT_TRUE(solver.update(movedBy(0.01)).any);
  EXPECT_EQ(solver.columnStep(), 1);
  EXPECT_EQ(valuesOf(solver), valuesOf(fresh));
  EXPECT_FALSE(solver.update(movedBy(0.01)).any);

  solver.setTimeGoal(kUnreachable_ms);
  solver.update(movedBy(0.02));
  EXPECT_GT(solver.columnStep(), 1);
  solver.setTimeGoal(0);
  solver.update(movedBy(0));
  fresh.update(movedBy(0));
  EXPECT_EQ(valuesOf(solver), valuesOf(fresh)) << "moved again without a goal";
}

TEST(BusyField, KeepsItsMeasuredTimesWhenEmittersAreAdded) {
  const auto loaded = [](const std::vector<scenario::Edit>& edits) {
    std::vector<scenario::Edit> all{{"region.dims", "[60, 60, 30]"}};
    all.insert(all.end(), edits.begin(), edits.end());
    return scenario::loadScenario(emscape::test::shippedScenario("jacksboro.yaml"), all);
  };
  const auto scenario = loaded({});
  auto fewer = std::make_shared<scenario::Scenario>(*scenario);
  fewer->emitters.pop_back();
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
  const auto movedBy = [&](const std::shared_ptr<const scenario::Scenario>& of, double north_deg) {
    scenario::Snapshot snapshot = scenario::snapshotAt(of, terrain.get(), 9);
    for (scenario::EmitterState& emitter : snapshot.emitters) emitter.position.latitude_deg += north_deg;
    return snapshot;
  };
  FieldSolver solver(fewer, terrain), fresh(scenario, terrain);
  solver.setTimeGoal(kUnreachable_ms);
  solver.update(movedBy(fewer, 0), terrain);
  solver.update(movedBy(scenario, 0.01), terrain);
  EXPECT_GT(solver.columnStep(), 1);
  solver.setTimeGoal(0);
  solver.update(movedBy(scenario, 0.01), terrain);
  fresh.update(movedBy(scenario, 0.01), terrain);
  EXPECT_EQ(solver.columnStep(), 1);
  EXPECT_EQ(solver.volumes().front().host()->values, fresh.volumes().front().host()->values);
}

}  // namespace
}  // namespace emscape::emfield
