// The ground below a path is that of the elevation model's posts, whatever the grid.
#include "emfield/ground/ground_posts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "emfield/excess/shadow_edge.h"
#include "emfield/ground/read_posts.h"
#include "emscape/base/units.h"
#include "emscape/emfield/link/path_budget.h"
#include "tests/emfield/made_terrain.h"
#include "tests/emfield/test_scenario.h"
#include "tests/support/files.h"
#include "tests/support/on_backends.h"
#include "tests/support/reference_data.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using propagation::PropagationModel;

TEST(GroundPosts, LongerListOfRangesBeginsWithShorterOne) {
  const std::vector<double> shorter = postRanges(5e3, 90), longer = postRanges(200e3, 90);
  ASSERT_LT(shorter.size(), longer.size());
  EXPECT_TRUE(std::equal(shorter.begin(), shorter.end(), longer.begin()));
  EXPECT_GE(shorter.back(), 5e3);
  EXPECT_LE(shorter.back(), 5e3 + 45);
}

TEST(GroundPosts, LastBeforeARangeIsTheFarthestNearerPost) {
  const std::vector<double> all_m = postRanges(30e3, 90);
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{7}, all_m.size()}) {
    const GroundPosts ground{{}, false, all_m.data(), static_cast<int>(count)};
    std::vector<double> ranges_m{-1, 0, 1e-9, 1e5, HUGE_VAL, NAN};
    for (const double post_m : all_m) {
      for (const double away_m : {-1e-9, 0.0, 1e-9, 3.0}) ranges_m.push_back(post_m + away_m);
    }
    for (const double range_m : ranges_m) {
      int expected = 0;
      while (expected + 1 < ground.range_count && all_m[expected + 1] < range_m) ++expected;
      ASSERT_EQ(ground.lastBefore(range_m), expected) << count << " posts, " << range_m << " m";
    }
  }
}

TEST(GroundPosts, ChordsFollowTheGeodesic) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(0, 1);
  for (const double latitude_deg : {0.0, 45.0, -59.0, 62.0, 79.0, 84.0}) {
    for (int n = 0; n < 30; ++n) {
      const Station station = makeStation({latitude_deg, 179.9, 100}, 100, 4.0 / 3);
      const double azimuth_rad = 2 * kPi * part(random);
      const FastInverse path{1e3 + 150e3 * part(random), std::sin(azimuth_rad), std::cos(azimuth_rad)};
      const scenario::TerrainView none;
      TerrainWalk walk(station, none, path);
      double largest_m = 0;
      for (double range_m = 0; range_m < path.distance_m; range_m += 333) {
        const TerrainChord& chord = walk.chordAt(range_m);
        const double along = (range_m - chord.in_raster.begin_m) * chord.in_raster.per_m;
        const FastDirect exact = fastDirect(station.geodesy, path.sin_azimuth, path.cos_azimuth, range_m);
        const double north_m = 6371e3 * (chord.position.latitude_rad.at(along) - exact.latitude_rad);
        const double east_rad =
            std::remainder(chord.position.longitude_rad.at(along) - exact.longitude_rad, 2 * kPi);
        largest_m =
            std::max(largest_m, std::hypot(north_m, 6371e3 * std::cos(exact.latitude_rad) * east_rad));
      }
      EXPECT_LT(largest_m, 0.2) << latitude_deg << " deg";
    }
  }
}

TEST(GroundPosts, VectorLoopsReadHeightsOfTerrain) {
  // A hole, and paths that leave the raster.
  const MadeTerrain terrain(44.5, -71.5, 1.0, 0.1);
  const std::vector<double> ranges_m = postRanges(70e3, terrain.postSpacing_m());
  const GroundPosts ground = groundPosts(&terrain, ranges_m);
  const Station station = makeStation({44.5, -71.5, 900}, 900, 4.0 / 3);
  std::vector<propagation::RangeTerms<float>> terms;
  const propagation::HorizonGeometry<float> geometry{900, float(station.effective_earth_radius_m)};
  for (const double range_m : ranges_m) terms.push_back(geometry.termsAt(range_m));
  int unknown = 0;
  for (double azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 7.3) {
    const double azimuth_rad = degToRad(azimuth_deg);
    const FastInverse path{60e3, std::sin(azimuth_rad), std::cos(azimuth_rad)};
    const int count = ground.lastBefore(path.distance_m) + 1;
    std::vector<float> plain(static_cast<std::size_t>(count)), vectors(plain);
    visitPosts(station, ground, path, count, [&](int i, float here) { plain[std::size_t(i)] = here; });
    readPostsCpu(station, ground, path, 0, count, vectors.data());
    propagation::GrazingSlope<float> slope;
    for (int i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const FastDirect point = fastDirect(station.geodesy, path.sin_azimuth, path.cos_azimuth, ranges_m[at]);
      const float exact = terrain.view().heightAt(point.latitude_rad, point.longitude_rad);
      ASSERT_EQ(std::isnan(plain[at]), std::isnan(vectors[at]));
      unknown += std::isnan(plain[at]);
      if (i > 0) slope.add(plain[at], geometry.slopeTo(plain[at], terms[at]));
      if (std::isnan(plain[at]) || std::isnan(exact)) continue;
      ASSERT_NEAR(plain[at], exact, 0.05);
      ASSERT_NEAR(plain[at], vectors[at], 0.01);
    }
    const float of_vectors = grazingSlopeCpu(geometry, vectors.data() + 1, terms.data() + 1, count - 1);
    ASSERT_EQ(std::isnan(slope.value()), std::isnan(of_vectors));
    if (!std::isnan(of_vectors)) {
      ASSERT_NEAR(slope.value(), of_vectors, 1e-6);
    }
  }
  EXPECT_GT(unknown, 100);
}

TEST(GroundPosts, TilesLeaveOutOnlyPostsBelowTheHorizon) {
  const MadeTerrain terrain(44.5, -71.5, 1.0, 0.1);
  const std::vector<double> ranges_m = postRanges(70e3, terrain.postSpacing_m());
  GroundPosts ground = groundPosts(&terrain, ranges_m);
  const std::vector<float> tiles = highestOfTiles(terrain.view().rasters[0], ground.tiles.columns);
  ground.tiles.msl_m = tiles.data();
  long long visited = 0, all = 0;
  for (const double height_m : {20, 600, 900, 2500}) {
    ShadowTask task{makeStation({44.5, -71.5, height_m}, height_m, 4.0 / 3), ground};
    std::vector<RangeTerms<float>> terms;
    for (const double range_m : ranges_m) terms.push_back(task.geometry().termsAt(range_m));
    task.terms = terms.data();
    for (double azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 1.7) {
      const double azimuth_rad = degToRad(azimuth_deg);
      const FastInverse path{60e3, std::sin(azimuth_rad), std::cos(azimuth_rad)};
      const int count = ground.lastBefore(path.distance_m) + 1;
      propagation::GrazingSlope<float> slope, of_all;
      const auto addTo = [&](propagation::GrazingSlope<float>& to, long long& visits) {
        return [&](int i, float here_msl_m) {
          to.add(here_msl_m, task.geometry().slopeTo(here_msl_m, terms[static_cast<std::size_t>(i)]));
          ++visits;
        };
      };
      visitPosts(task.station, ground, path, count, addTo(of_all, all), 1);
      visitPosts(task.station, ground, path, count, addTo(slope, visited), 1,
                 [&](int first, int last, float highest_msl_m) {
                   return task.slopeBound(first, last, highest_msl_m) <= slope.highest;
                 });
      if (std::isnan(of_all.value())) {
        ASSERT_TRUE(std::isnan(slope.value())) << azimuth_deg << " deg, " << height_m << " m";
      } else {
        ASSERT_EQ(slope.value(), of_all.value()) << azimuth_deg << " deg, " << height_m << " m";
      }
    }
  }
  EXPECT_LT(visited, all * 8 / 10);
}

/// A path over an elevation model, and grids of large and of small voxels with its end at a voxel's centre.
class FieldAtPosts : public test::OnBackends {
 protected:
  /// @param file  elevation model of about a quarter of a degree at least
  void expectTheSameInEveryGrid(const std::string& file) {
    const scenario::TerrainFileInfo info = scenario::Terrain::describe(file);
    scenario::TerrainSpec spec;
    spec.files = {file};
    spec.locations = {{file}};
    const auto terrain = scenario::Terrain::load(spec, info.box);
    std::mt19937 random(17);
    std::uniform_real_distribution<double> part(0, 1);
    const auto between = [&](double low, double high, double margin) {
      return low + margin + (high - low - 2 * margin) * part(random);
    };
    constexpr double kNearBorder_deg = 0.01, kHalfGrid_deg = 0.1;
    double largest_db = 0;
    int shadowed = 0;
    int paths = 0;
    for (int tries = 0; paths < 40 && tries < 4000; ++tries) {
      const scenario::GeoBox& box = info.box;
      const GeodeticPosition site{between(box.south_deg, box.north_deg, kNearBorder_deg),
                                  between(box.west_deg, box.east_deg, kNearBorder_deg), 0};
      const double latitude_deg = between(box.south_deg, box.north_deg, kHalfGrid_deg),
                   longitude_deg = between(box.west_deg, box.east_deg, kHalfGrid_deg);
      const double above_m = 5 + 200 * part(random);
      if (crossesVoids(*terrain, site, {latitude_deg, longitude_deg, 0})) continue;
      ++paths;
      double powers_dbwm2[2], levels_dbwm2[2];
      for (const int large : {0, 1}) {
        const auto [scenario, end] = gridAround(latitude_deg, longitude_deg, large == 1 ? 4000 : 100,
                                                terrain->heightMsl_m(latitude_deg, longitude_deg) + above_m);
        addSite(*scenario, site, PropagationModel::diffraction);
        const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, terrain.get(), 0);
        powers_dbwm2[large] = pathBudget(snapshot, 0, end, PropagationModel::diffraction, terrain.get())
                                  .find("power_density_dbwm2")
                                  ->value;
        levels_dbwm2[large] = valueAt(*solve(scenario, terrain, options()), 1, 1, 1);
        largest_db = std::max(largest_db, std::abs(levels_dbwm2[large] - powers_dbwm2[large]));

        scenario->emitters[0].propagation.model = PropagationModel::horizon;
        shadowed += expectTheShadowOfThePath(scenario, terrain, end);
      }
      EXPECT_EQ(powers_dbwm2[0], powers_dbwm2[1]);
      EXPECT_NEAR(levels_dbwm2[0], levels_dbwm2[1], 0.05);
    }
    EXPECT_EQ(paths, 40);
    EXPECT_LE(largest_db, 0.05);
    EXPECT_GT(shadowed, 10);
  }

 private:
  FieldOptions options() const {
    FieldOptions options;
    options.backend = GetParam();
    options.allow_missing_terrain = true;  // beside the path
    return options;
  }

  static bool crossesVoids(const scenario::Terrain& terrain, const GeodeticPosition& from,
                           const GeodeticPosition& to) {
    try {
      return std::isnan(terrain.heightMsl_m(from.latitude_deg, from.longitude_deg)) ||
             readPathProfile({from, 0}, {to, 0}, 1, &terrain, true).count() < 2;
    } catch (const Error&) {
      return true;
    }
  }

  /// Three by three columns around a point, whose height is that of the middle layer.
  static std::pair<std::shared_ptr<scenario::Scenario>, PathEnd> gridAround(double latitude_deg,
                                                                            double longitude_deg,
                                                                            double voxel_m,
                                                                            double height_msl_m) {
    constexpr double kLayer_m = 40;
    auto scenario = emptyScenario(FrameKind::altitude, latitude_deg, longitude_deg,
                                  {3 * voxel_m, 3 * voxel_m, 3 * kLayer_m}, {3, 3, 3});
    scenario->region.origin.height_msl_m = height_msl_m - 1.5 * kLayer_m;
    scenario->terrain = scenario::TerrainSpec{};
    scenario->atmosphere.gases = propagation::GasLosses::never;
    const volume::Grid grid = gridOf(scenario->region);
    const GeoFrame frame(grid.frame);
    const Vec3d center = grid.center_m(1, 1, 1);
    return {scenario, {frame.toGeodetic(center), frame.heightMsl_m(center)}};
  }

  static void addSite(scenario::Scenario& scenario, const GeodeticPosition& site, PropagationModel model) {
    scenario::Emitter emitter = plainEmitter("site", 0);
    emitter.frequency_hz = 3e9;
    emitter.propagation.model = model;
    addEmitter(scenario, site, emitter);
    scenario.platforms[0].track[0].position.height_ellipsoid_m.reset();
    scenario.platforms[0].track[0].position.height_agl_m = 10;
  }

  /// The voxel is illuminated if the path is, unless the shadow's edge is within 0.1 m. @return 1 if it is in
  /// shadow
  int expectTheShadowOfThePath(const std::shared_ptr<scenario::Scenario>& scenario,
                               const scenario::TerrainPtr& terrain, const PathEnd& end) const {
    const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, terrain.get(), 0);
    const auto isLit = [&](double above_m) {
      PathEnd here = end;
      here.height_msl_m += above_m;
      return std::isfinite(pathBudget(snapshot, 0, here, PropagationModel::horizon, terrain.get())
                               .find("power_density_dbwm2")
                               ->value);
    };
    const bool is_lit = isLit(0);
    const auto volume = solve(scenario, terrain, options());
    if (isLit(-0.1) == is_lit && isLit(0.1) == is_lit) {
      EXPECT_EQ(valueAt(*volume, 1, 1, 1) > volume->info.floor, is_lit);
    }
    return is_lit ? 0 : 1;
  }
};

TEST_P(FieldAtPosts, EqualsPathInAllVoxelSizesOverShippedTerrain) {
  expectTheSameInEveryGrid(test::sourceFile("scenarios/data/jacksboro.tif"));
}

// The same over a tile with two post spacings, if the file exists.
TEST_P(FieldAtPosts, EqualsPathInAllVoxelSizesOverWholeDegrees) {
  expectTheSameInEveryGrid(test::sourceFile("tests/data/dem/N44W072.tif"));
  if (const auto file = test::referenceFile("dem/n00_e006_3arc_v2.dt1")) expectTheSameInEveryGrid(*file);
}

EMSCAPE_ON_BACKENDS(FieldAtPosts);

}  // namespace
}  // namespace emscape::emfield
