// Shadows of the model `horizon` against a walk along every ray over real terrain.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "emscape/base/geodesy/geoid.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/scenario/terrain/terrain.h"
#include "tests/emfield/test_scenario.h"
#include "tests/support/files.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;

/// The terrain along the geodesic to a point of the ground, sampled densely, and the straight rays above it
/// on the k-factor earth in polar coordinates: 1 / r = (sin(psi - theta) / r1 + sin(theta) / r2) / sin(psi).
class RayWalk {
 public:
  RayWalk(const scenario::Terrain* terrain, const GeodeticPosition& site, double site_msl_m,
          const GeodeticPosition& target)
      : site_radius_m_(kEarth_m + site_msl_m) {
    const GeodesicInverse path =
        geodesicInverse(site.latitude_deg, site.longitude_deg, target.latitude_deg, target.longitude_deg);
    angle_ = path.distance_m / kEarth_m;
    const double step_m = terrain == nullptr ? kKnot_m : kStep_m;
    // Exact every kKnot_m, on the chord between: it leaves the geodesic by less than a centimetre.
    GeodeticPosition from = geodesicDirect(site.latitude_deg, site.longitude_deg, path.azimuth_rad, 0);
    for (double knot_m = 0; knot_m < path.distance_m; knot_m += kKnot_m) {
      const GeodeticPosition to =
          geodesicDirect(site.latitude_deg, site.longitude_deg, path.azimuth_rad, knot_m + kKnot_m);
      for (double beyond_m = step_m; beyond_m <= kKnot_m; beyond_m += step_m) {
        if (knot_m + beyond_m >= path.distance_m) break;
        const double part = beyond_m / kKnot_m;
        const double angle = (knot_m + beyond_m) / kEarth_m;
        of_site_.push_back(std::sin(angle_ - angle) / std::sin(angle_) / site_radius_m_);
        of_target_.push_back(std::sin(angle) / std::sin(angle_));
        heights_m_.push_back(
            terrain == nullptr
                ? 0
                : terrain->heightMsl_m(from.latitude_deg + part * (to.latitude_deg - from.latitude_deg),
                                       from.longitude_deg + part * (to.longitude_deg - from.longitude_deg)));
      }
      from = to;
    }
  }

  bool isLit(double target_msl_m) const {
    const double target_radius_m = kEarth_m + target_msl_m;
    for (std::size_t s = 0; s < heights_m_.size(); ++s) {
      const double ray_radius_m = 1 / (of_site_[s] + of_target_[s] / target_radius_m);
      if (heights_m_[s] > ray_radius_m - kEarth_m) return false;
    }
    return true;
  }

 private:
  static constexpr double kEarth_m = 6371000.0 * 4 / 3;
  static constexpr double kStep_m = 10, kKnot_m = 400;

  double site_radius_m_;
  double angle_ = 0;
  std::vector<double> of_site_, of_target_, heights_m_;
};

struct Tally {
  int lit = 0, dark = 0, near_edge = 0, wrong = 0;
};

/// Compares every voxel of the solved volume with the walk, except within half a voxel of the shadow's edge,
/// where the walk's result changes half a voxel up, down, or to the sides.
Tally compareWithWalk(const volume::DenseVolume& volume, const scenario::Terrain* terrain,
                      const GeodeticPosition& site, double site_msl_m) {
  const volume::Grid& grid = volume.grid;
  const GeoFrame frame(grid.frame);
  const Vec3d half = grid.spacing_m * 0.5;
  const Vec3d offsets[] = {{0, 0, 0}, {half.x, 0, 0}, {-half.x, 0, 0}, {0, half.y, 0}, {0, -half.y, 0}};
  Tally tally;
  for (int j = 0; j < grid.dims.y; ++j) {
    for (int i = 0; i < grid.dims.x; ++i) {
      std::vector<RayWalk> walks;
      for (const Vec3d& offset : offsets) {
        walks.emplace_back(terrain, site, site_msl_m,
                           frame.toGeodetic(grid.center_m(i, j, grid.dims.z / 2) + offset));
      }
      for (int k = 0; k < grid.dims.z; ++k) {
        if (volume.isMasked(i, j, k)) continue;
        const double height_m = frame.heightMsl_m(grid.center_m(i, j, k));
        const bool is_lit = walks[0].isLit(height_m);
        bool is_near_edge =
            walks[0].isLit(height_m - half.z) != is_lit || walks[0].isLit(height_m + half.z) != is_lit;
        for (std::size_t w = 1; w < walks.size(); ++w)
          is_near_edge = is_near_edge || walks[w].isLit(height_m) != is_lit;
        if (is_near_edge) {
          ++tally.near_edge;
          continue;
        }
        ++(is_lit ? tally.lit : tally.dark);
        if ((valueAt(volume, i, j, k) > volume.info.floor) != is_lit) ++tally.wrong;
      }
    }
  }
  return tally;
}

scenario::TerrainPtr whiteMountains(const scenario::Scenario& scenario) {
  const std::string file = test::sourceFile("tests/data/dem/N44W072.tif");
  scenario::TerrainSpec spec;
  spec.files = {file};
  spec.locations = {{file}};
  return scenario::Terrain::load(spec, scenario::terrainBox(scenario));
}

/// A radar on a site, and the terrain that it and the region need.
std::shared_ptr<scenario::Scenario> radarOn(const std::shared_ptr<scenario::Scenario>& scenario,
                                            const GeodeticPosition& site) {
  scenario::Emitter emitter = plainEmitter("radar", 0);
  emitter.propagation.model = propagation::PropagationModel::horizon;
  addEmitter(*scenario, site, emitter);
  return scenario;
}

TEST(Shadow, SLOW_EqualsWalkAlongEachRay) {
  // A valley, a slope and a summit of the White Mountains; one site outside the region.
  const double sites[][3] = {
      {44.42, -71.68, 12}, {44.30, -71.33, 20}, {44.2706, -71.3033, 5}, {44.55, -71.80, 30}};
  for (const auto& site : sites) {
    SCOPED_TRACE(::testing::Message() << site[0] << ", " << site[1]);
    auto scenario = emptyScenario(FrameKind::altitude, 44.45, -71.45, {48e3, 40e3, 3000}, {16, 14, 30});
    radarOn(scenario, {site[0], site[1], 0});
    const auto terrain = whiteMountains(*scenario);
    const double site_msl_m = terrain->heightMsl_m(site[0], site[1]) + site[2];
    const GeodeticPosition position{site[0], site[1], site_msl_m + geoidUndulation_m(site[0], site[1])};
    scenario->platforms[0].track[0].position.height_ellipsoid_m = position.height_ellipsoid_m;
    const Tally tally = compareWithWalk(*solve(scenario, terrain), terrain.get(), position, site_msl_m);
    EXPECT_EQ(tally.wrong, 0) << tally.lit << " lit, " << tally.dark << " dark, " << tally.near_edge
                              << " near the edge";
    EXPECT_GT(tally.lit, 1000);
    EXPECT_GT(tally.dark, 200);
  }
}

TEST(Shadow, SmoothEarthShadowBeginsAtRadioHorizon) {
  auto scenario = emptyScenario(FrameKind::altitude, 10, 20, {240e3, 6e3, 1500}, {120, 3, 30});
  const GeodeticPosition site{10, 20, 50 + geoidUndulation_m(10, 20)};
  radarOn(scenario, site);
  const auto volume = solve(scenario);
  const Tally tally = compareWithWalk(*volume, nullptr, site, 50);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_GT(tally.dark, 500);
  // Closed form: two horizons of sqrt(2 k a h).
  const double earth_m = 2 * 6371000.0 * 4 / 3;
  for (int k = 0; k < 30; k += 7) {
    const double horizon_m = std::sqrt(earth_m * 50) + std::sqrt(earth_m * volume->grid.center_m(0, 0, k).z);
    for (int i = 0; i < 120; ++i) {
      const double x_m = std::abs(volume->grid.center_m(i, 1, k).x);
      if (std::abs(x_m - horizon_m) < 1500) continue;
      EXPECT_EQ(valueAt(*volume, i, 1, k) > volume->info.floor, x_m < horizon_m) << x_m << " m, layer " << k;
    }
  }
}

TEST(Shadow, TangentPlaneFrameHasTheSameShadow) {
  auto scenario = emptyScenario(FrameKind::enu, 44.45, -71.45, {24e3, 20e3, 2500}, {24, 20, 25});
  const auto terrain = whiteMountains(*scenario);
  const double site_msl_m = terrain->heightMsl_m(44.42, -71.5) + 15;
  const GeodeticPosition site{44.42, -71.5, site_msl_m + geoidUndulation_m(44.42, -71.5)};
  radarOn(scenario, site);
  const auto leaning = solve(scenario, terrain);
  const Tally tally = compareWithWalk(*leaning, terrain.get(), site, site_msl_m);
  EXPECT_EQ(tally.wrong, 0) << tally.lit << " lit, " << tally.dark << " dark, " << tally.near_edge
                            << " near the edge";
  EXPECT_GT(tally.dark, 200);
}

}  // namespace
}  // namespace emscape::emfield
