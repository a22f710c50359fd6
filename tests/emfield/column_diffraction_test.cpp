// The functions of `diffraction` and `horizon` that the GPU runs for each column, on the host, against those
// of the CPU.
#include "emfield/excess/column_diffraction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "emfield/excess/emitter_excess.h"
#include "emfield/excess/shadow.h"
#include "emfield/excess/shadow_edge.h"
#include "tests/emfield/made_terrain.h"
#include "tests/emfield/test_scenario.h"

namespace emscape::emfield {
namespace {

using testing::MadeTerrain;

/// Made once: it takes a second.
std::shared_ptr<const MadeTerrain> terrainOf(bool has_hole) {
  static const auto whole = std::make_shared<const MadeTerrain>(44.5, -71.5, 1.2);
  static const auto with_hole = std::make_shared<const MadeTerrain>(44.5, -71.5, 1.2, 0.1);
  return has_hole ? with_hole : whole;
}

/// An emitter in the middle of a region over made terrain.
struct SeenField {
  std::shared_ptr<const MadeTerrain> terrain;
  std::shared_ptr<scenario::Scenario> scenario;
  scenario::EmitterState state;
  Station station;
  GridColumns columns;
  std::vector<double> ranges_m;
  GroundPosts ground;
  ExcessGrid grid;

  SeenField(propagation::PropagationModel model, double side_m, double height_agl_m, double frequency_hz,
            bool has_hole = false, FrameKind frame = FrameKind::altitude,
            std::shared_ptr<const MadeTerrain> over = nullptr, Dims dims = {14, 11, 40})
      : terrain(over ? over : terrainOf(has_hole)) {
    scenario = testing::emptyScenario(frame, 44.5, -71.5, {side_m, side_m, 4000}, dims);
    scenario::Emitter emitter = testing::plainEmitter("radar", 0);
    emitter.frequency_hz = frequency_hz;
    emitter.propagation.model = model;
    const double ground_m = terrain->heightMsl_m(44.5, -71.5);
    testing::addEmitter(*scenario, {44.5, -71.5, ground_m + height_agl_m - 28}, emitter);
    state = scenario::snapshotAt(scenario, terrain.get(), 0).emitters[0];
    station = makeStation(state.position, state.height_msl_m, scenario->atmosphere);
    columns = makeGridColumns(gridOf(scenario->region), terrain.get());
    const propagation::PathExtent extent = pathExtent(station, columns);
    ranges_m = postRanges(extent.farthest_m, postSpacing_m(terrain.get()));
    ground = groundPosts(terrain.get(), ranges_m);
    grid = excessGrid(columns, terrain.get());
  }

  float highest_m() const { return highestPost_m(terrain->view()); }
  bool isCounted(std::size_t column, int layer) const {
    return layer >= grid.firstValid(column) && !grid.isWithoutGround(column);
  }
};

/// Losses (dB) of all voxels.
std::vector<float> lossesOfTheCpu(const SeenField& setup, const EmitterExcess& excess) {
  std::vector<float> loss_db(setup.columns.count() * setup.columns.t_m.size());
  std::vector<float> edge_m(setup.columns.count());
  fillExcessCpu(excess, setup.station, setup.grid, setup.ground, nullptr,
                {{nullptr, loss_db.data()}, nullptr, nullptr, edge_m.data()});
  return loss_db;
}
/// @param with_tiles  posts are left out by HighestOfTiles
template <int kReceivers>
std::vector<float> lossesOfTheDevice(const SeenField& setup, const EmitterExcess& excess,
                                     bool with_tiles = true) {
  std::vector<float> loss_db(setup.columns.count() * setup.columns.t_m.size());
  DiffractionTask task{
      std::get<propagation::DiffractionExcess>(excess.model), excess.air,      setup.station, setup.ground,
      {{nullptr, loss_db.data()}, nullptr, nullptr, nullptr}, excess.terminal, true};
  std::vector<float> tiles_msl_m;
  if (with_tiles) {
    tiles_msl_m = highestOfTiles(setup.ground.terrain.rasters[0], task.ground.tiles.columns);
    task.ground.tiles.msl_m = tiles_msl_m.data();
  }
  for (int c = 0; c < static_cast<int>(setup.columns.count()); ++c) {
    for (int segment = 0; segment < setup.grid.segments; ++segment)
      fillDiffraction<kReceivers>(task, setup.grid, c, segment);
  }
  return loss_db;
}

/// @param edge_losses  that may differ by more: the smooth earth's correction begins with a step
void expectSameLosses(const SeenField& setup, const std::vector<float>& device, const std::vector<float>& cpu,
                      int edge_losses = 2) {
  int lossy = 0, different = 0;
  for (std::size_t voxel = 0; voxel < cpu.size(); ++voxel) {
    const std::size_t column = voxel % setup.columns.count();
    if (!setup.isCounted(column, static_cast<int>(voxel / setup.columns.count()))) continue;
    ASSERT_EQ(std::isnan(device[voxel]), std::isnan(cpu[voxel])) << voxel;
    lossy += cpu[voxel] > 0;
    different += std::abs(device[voxel] - cpu[voxel]) > 0.005f;
  }
  EXPECT_GT(lossy, 50);
  EXPECT_LE(different, edge_losses);
}

EmitterExcess planned(const SeenField& setup) {
  return planExcess(*setup.scenario, setup.scenario->emitters[0], setup.state.beam, setup.station,
                    setup.terrain.get(), setup.columns);
}

TEST(ColumnDiffraction, OfTheDeviceIsThatOfTheCpu) {
  for (const double height_agl_m : {15.0, 1500.0}) {
    for (const double frequency_hz : {60e6, 3e9}) {
      SCOPED_TRACE(::testing::Message() << height_agl_m << " m, " << frequency_hz << " Hz");
      const SeenField setup(propagation::PropagationModel::diffraction, 50e3, height_agl_m, frequency_hz);
      const EmitterExcess excess = planned(setup);
      const std::vector<float> cpu = lossesOfTheCpu(setup, excess);
      expectSameLosses(setup, lossesOfTheDevice<8>(setup, excess), cpu);
      expectSameLosses(setup, lossesOfTheDevice<1>(setup, excess), cpu);
    }
  }
}

TEST(ColumnDiffraction, WithTerminalClutterIsThatOfTheCpu) {
  const SeenField setup(propagation::PropagationModel::diffraction, 50e3, 15, 3e9);
  EmitterExcess excess = planned(setup);
  excess.terminal.frequency_ghz = 3;
  excess.terminal.below_m = 300;  // of several layers
  for (const bool is_larger : {false, true}) {
    excess.terminal.is_larger = is_larger;
    expectSameLosses(setup, lossesOfTheDevice<8>(setup, excess), lossesOfTheCpu(setup, excess));
  }
}

TEST(ColumnDiffraction, OverClutterIsThatOfTheCpu) {
  for (const double frequency_hz : {60e6, 3e9}) {
    SeenField setup(propagation::PropagationModel::diffraction, 50e3, 15, frequency_hz);
    const MadeTerrain woods(44.5, -71.5, 1.2, [&](double east_deg, double north_deg) {
      const double ground_m = setup.terrain->heightMsl_m(43.9 + north_deg, -72.1 + east_deg);
      return ground_m + (std::fmod(east_deg, 0.01) < 0.004 ? 20 : 0);
    });
    const scenario::TerrainView with_woods = woods.view();
    setup.ground.terrain.surfaces = with_woods.rasters;
    setup.ground.terrain.surface_count = 1;
    setup.ground.is_raised = setup.ground.has_clutter = true;
    EmitterExcess excess = planned(setup);
    const std::vector<float> bare = lossesOfTheCpu(setup, excess);
    excess.is_raised = excess.has_clutter = true;
    const std::vector<float> cpu = lossesOfTheCpu(setup, excess);
    EXPECT_NE(cpu, bare);
    expectSameLosses(setup, lossesOfTheDevice<8>(setup, excess), cpu);
    expectSameLosses(setup, lossesOfTheDevice<1>(setup, excess), cpu);
  }
}

TEST(ColumnDiffraction, OfLeaningColumnsIsThatOfTheCpu) {
  const SeenField setup(propagation::PropagationModel::diffraction, 50e3, 15, 1e9, false, FrameKind::enu);
  const EmitterExcess excess = planned(setup);
  expectSameLosses(setup, lossesOfTheDevice<8>(setup, excess), lossesOfTheCpu(setup, excess));
}

TEST(ColumnDiffraction, PostsOfLowTilesAreOfNoAccount) {
  for (const double height_agl_m : {15.0, 900.0, 4000.0}) {
    for (const bool has_hole : {false, true}) {
      const SeenField setup(propagation::PropagationModel::diffraction, 50e3, height_agl_m, 1e9, has_hole);
      const EmitterExcess excess = planned(setup);
      const auto expectEqual = [](const std::vector<float>& a, const std::vector<float>& b) {
        for (std::size_t i = 0; i < a.size(); ++i)
          EXPECT_TRUE(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i])))
              << i << ": " << a[i] << ", " << b[i];
      };
      expectEqual(lossesOfTheDevice<8>(setup, excess), lossesOfTheDevice<8>(setup, excess, false));
      expectEqual(lossesOfTheDevice<1>(setup, excess), lossesOfTheDevice<1>(setup, excess, false));
    }
  }
}

TEST(ColumnDiffraction, OfMoreCandidatesThanThereIsRoomForIsTheSame) {
  // Over a calm sea each post is the horizon of some receiver.
  const auto sea = std::make_shared<const MadeTerrain>(
      44.5, -71.5, 1.9, [](double east_deg, double) { return 30 + std::sin(50 * east_deg); });
  const SeenField setup(propagation::PropagationModel::diffraction, 140e3, 15, 3e9, false,
                        FrameKind::altitude, sea);
  const EmitterExcess excess = planned(setup);
  const float half_curvature = std::get<propagation::DiffractionExcess>(excess.model).model.half_curvature;
  int too_many = 0;
  for (std::size_t c = 0; c < setup.columns.count(); ++c) {
    const FastInverse path = setup.grid.coordinatesOf(setup.station, c, 0);
    ColumnPosts posts(setup.station, setup.ground, path, true);
    const auto distance_m = static_cast<float>(path.distance_m);
    diffraction_detail::CandidatePosts candidates(false);
    const float clear = propagation::kKnifeEdgeClear<float> * std::sqrt(0.05f / distance_m);  // at 3 GHz
    diffraction_detail::CandidatePosts::Records records(0, clear);
    int kept = 0;
    posts.each([](float, float, float) { return false; },
               [&](const PathPost& post) {
                 if (records.add<true>({post, distance_m, 30, 15, half_curvature}))
                   candidates.set(kept++, post);
               });
    candidates.end(kept);
    too_many += !candidates.areComplete();
  }
  EXPECT_GT(too_many, 0);
  expectSameLosses(setup, lossesOfTheDevice<8>(setup, excess), lossesOfTheCpu(setup, excess), 10);
}

TEST(ColumnDiffraction, IsUnknownAcrossAHole) {
  const SeenField setup(propagation::PropagationModel::diffraction, 80e3, 15, 1e9, true);
  const EmitterExcess excess = planned(setup);
  expectSameLosses(setup, lossesOfTheDevice<8>(setup, excess), lossesOfTheCpu(setup, excess), 10);
}

TEST(ColumnDiffraction, BesideSingleVoidsIsThatOfTheCpu) {
  const auto with_voids =
      std::make_shared<const MadeTerrain>(44.5, -71.5, 1.2, [](double east_deg, double north_deg) {
        const auto i = static_cast<int>(std::lround(east_deg * 1200)),
                   j = static_cast<int>(std::lround(north_deg * 1200));
        return i % 97 == 11 && j % 89 == 7 ? NAN
                                           : 300 + 200 * std::sin(40 * east_deg) * std::cos(30 * north_deg);
      });
  const SeenField setup(propagation::PropagationModel::diffraction, 80e3, 15, 100e6, false,
                        FrameKind::altitude, with_voids);
  const EmitterExcess excess = planned(setup);
  expectSameLosses(setup, lossesOfTheDevice<8>(setup, excess), lossesOfTheCpu(setup, excess), 10);
}

TEST(ColumnDiffraction, WithTheShareOfTheSeaByHeightIsThatOfTheCpu) {
  const auto coast =
      std::make_shared<const MadeTerrain>(44.5, -71.5, 1.9, [](double east_deg, double north_deg) {
        return std::sin(260 * east_deg + 3 * std::sin(170 * north_deg)) > 0 ? 3 : 0;
      });
  SeenField setup(propagation::PropagationModel::diffraction, 140e3, 48, 30e6, false, FrameKind::altitude,
                  coast);
  setup.scenario->ground.sea_by_height = true;
  setup.scenario->emitters[0].polarization = propagation::Polarization::vertical;
  const EmitterExcess excess = planned(setup);
  expectSameLosses(setup, lossesOfTheDevice<8>(setup, excess), lossesOfTheCpu(setup, excess));
}

TEST(HighestPost, IsThatOfTheWholeRasterAndInfiniteWithVoids) {
  const scenario::TerrainView terrain = terrainOf(false)->view();
  const scenario::TerrainRaster& raster = terrain.rasters[0];
  const float* const posts = raster.heights_msl_m;
  EXPECT_EQ(highestPost_m(terrain), *std::max_element(posts, posts + raster.columns * raster.rows));
  EXPECT_EQ(highestPost_m(terrainOf(true)->view()), HUGE_VALF);
  EXPECT_EQ(highestPost_m({&raster, 0}), HUGE_VALF);
  scenario::TerrainRaster framed;  // as of files: void beyond the limits of look-ups
  std::vector<float> heights_m(25, NAN);
  for (const int post : {6, 7, 8, 11, 12, 13, 16, 17, 18}) heights_m[post] = static_cast<float>(post);
  framed.heights_msl_m = heights_m.data();
  framed.columns = framed.rows = 5;
  framed.first_column = framed.first_row = 1;
  framed.last_column = framed.last_row = 3;
  EXPECT_EQ(highestPost_m({&framed, 1}), 18);
}

TEST(ShadowEdge, PostsBelowEveryLineOfSightAreOfNoAccount) {
  int left_out = 0, in_shadow = 0;
  for (const double height_agl_m : {15.0, 900.0, 1500.0, 4000.0}) {
    const SeenField setup(propagation::PropagationModel::horizon, 50e3, height_agl_m, 1e9);
    ShadowTask task{setup.station, setup.ground};
    const HorizonGeometry<float> geometry = task.geometry();
    std::vector<RangeTerms<float>> terms;
    for (const double range_m : setup.ranges_m) terms.push_back(geometry.termsAt(range_m));
    task.terms = terms.data();
    const float highest_m = setup.highest_m();
    for (std::size_t c = 0; c < setup.columns.count(); ++c) {
      const auto edgeOf = [&](float highest_msl_m) {
        task.highest_msl_m = highest_msl_m;
        return task.edge_m(setup.grid, c, [&](const FastInverse& path, int count) {
          propagation::GrazingSlope<float> slope;
          const int first = task.firstPost(setup.grid, c, path, count);
          left_out += first - 1;
          visitPosts(
              setup.station, setup.ground, path, count,
              [&](int i, float height_m) { slope.add(height_m, geometry.slopeTo(height_m, terms[i])); },
              first);
          return slope.value();
        });
      };
      const float all_m = edgeOf(HUGE_VALF), some_m = edgeOf(highest_m);
      for (int k = setup.grid.firstValid(c); k < setup.grid.layers; ++k) {
        const float t_m = setup.grid.t_m[k];
        ASSERT_EQ(t_m >= some_m, t_m >= all_m) << c << ' ' << k;
        in_shadow += t_m < all_m;
      }
    }
  }
  EXPECT_GT(left_out, 3000);
  EXPECT_GT(in_shadow, 100);
}

TEST(ShadowEdge, OfManyColumnsDecidesEveryVoxelAsThatOfWholePaths) {
  for (const double height_agl_m : {15.0, 1500.0}) {
    const SeenField setup(propagation::PropagationModel::horizon, 70e3, height_agl_m, 1e9, true,
                          FrameKind::altitude, nullptr, {130, 120, 40});
    const TerrainBounds bounds(setup.terrain->view());
    std::vector<float> whole_m(setup.columns.count()), by_sectors_m(setup.columns.count());
    findShadowEdgesCpu(setup.station, setup.ground, setup.grid, nullptr, whole_m.data());
    findShadowEdgesCpu(setup.station, setup.ground, setup.grid, &bounds, by_sectors_m.data());
    int in_shadow = 0, other_edges = 0;
    for (std::size_t c = 0; c < setup.columns.count(); ++c) {
      ASSERT_EQ(std::isnan(by_sectors_m[c]), std::isnan(whole_m[c])) << c;
      other_edges += std::abs(by_sectors_m[c] - whole_m[c]) > 0.01f;
      for (int k = 0; k < setup.grid.layers; ++k) {
        const float t_m = setup.grid.t_m[k];
        ASSERT_EQ(t_m >= by_sectors_m[c], t_m >= whole_m[c]) << c << ' ' << k;
        in_shadow += t_m < whole_m[c];
      }
    }
    EXPECT_GT(in_shadow, 1000);
    EXPECT_GT(other_edges, 1000);  // decided by bounds
  }
}

}  // namespace
}  // namespace emscape::emfield
