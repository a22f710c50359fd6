// The map of surface clutter over mountains against an integral over the visible ground.

#include "emfield/geometry/clutter_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "emfield/columns/station.h"
#include "emscape/scenario/terrain/terrain.h"
#include "scenario/antenna/shapes.h"
#include "tests/emfield/radar_duel.h"
#include "tests/support/files.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;

constexpr double kBeamwidth_deg = 2, kRangeCell_m = 300, kGamma_db = -15, kFarthest_m = 10e3;

/// Two-way power of a Gaussian beam.
double twoWayPower(double from_axis_rad) {
  return std::pow(10, -2.4 * std::pow(from_axis_rad / degToRad(kBeamwidth_deg), 2));
}

/// The integral of reflectivity over range^4 in range cells, over the visible ground, along one azimuth:
/// faces of 10 m.
std::vector<double> integralAlong(const scenario::Terrain& terrain, const Station& station,
                                  double azimuth_rad, const std::vector<double>& ranges_m) {
  constexpr double kStep_m = 10;
  const int steps = static_cast<int>((kFarthest_m + kRangeCell_m) / kStep_m);
  const GeodeticPosition end =
      geodesicDirect(station.latitude_deg, station.longitude_deg, azimuth_rad, steps * kStep_m / 2);
  const GeodeticPosition far_end =
      geodesicDirect(station.latitude_deg, station.longitude_deg, azimuth_rad, steps * kStep_m);
  // a parabola through three points of the geodesic
  const auto along = [&](double a, double b, double c, double t) {
    return a * (1 - t) * (1 - 2 * t) + 4 * b * t * (1 - t) + c * t * (2 * t - 1);
  };
  std::vector<double> sums(ranges_m.size(), 0);
  double highest = -HUGE_VAL, height_before_m = 0, below_before_m = 0;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps, range_m = i * kStep_m;
    const auto height_m = static_cast<double>(
        terrain.heightMsl_m(along(station.latitude_deg, end.latitude_deg, far_end.latitude_deg, t),
                            along(station.longitude_deg, end.longitude_deg, far_end.longitude_deg, t)));
    const double below_m =
        station.height_msl_m - height_m + range_m * range_m / (2 * station.effective_earth_radius_m);
    if (i > 0 && -below_m / range_m > highest) {
      highest = -below_m / range_m;
      const double middle_m = range_m - kStep_m / 2, depth_m = (below_m + below_before_m) / 2;
      const double tilt =
          (height_m - height_before_m) / kStep_m - middle_m / station.effective_earth_radius_m;
      const double slant_m = std::hypot(middle_m, depth_m), stretch = std::sqrt(1 + tilt * tilt);
      const double sine = (middle_m * tilt + depth_m) / (slant_m * stretch);
      const double echo =
          dbToRatio(kGamma_db) * std::max(sine, 0.0) * middle_m * kStep_m * stretch / std::pow(slant_m, 4);
      for (std::size_t n = 0; n < ranges_m.size(); ++n) {
        if (std::abs(slant_m - ranges_m[n]) < kRangeCell_m / 2) sums[n] += echo;
      }
    }
    height_before_m = height_m;
    below_before_m = below_m;
  }
  return sums;
}

TEST(ClutterMap, SLOW_OverMountainsIsNearAnIntegralOverVisibleGround) {
  constexpr int kPerBeamwidth = 32, kBeside = 64;  // azimuths of the integral
  scenario::TerrainSpec spec;
  spec.files = {test::sourceFile("tests/data/dem/N44W072.tif")};
  spec.locations = {{spec.files[0]}};
  std::mt19937 random(5);
  const auto within = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  std::vector<double> differences_db;
  int cells = 0, of_one = 0;
  for (int site = 0; site < 24; ++site) {
    const double latitude_deg = within(44.3, 44.7), longitude_deg = within(-71.7, -71.3);
    const auto scenario =
        emptyScenario(FrameKind::altitude, latitude_deg, longitude_deg, {20e3, 20e3, 1000}, {8, 8, 2});
    scenario::Emitter radar = trackingRadar();
    radar.antenna = scenario::makeGaussian(30, kBeamwidth_deg, kBeamwidth_deg, -80);
    radar.clutter.emplace();
    radar.clutter->land_gamma_db = kGamma_db;
    radar.clutter->range_cell_m = kRangeCell_m;
    const auto terrain = scenario::Terrain::load(spec, scenario::terrainBox(*scenario));
    const double height_m = terrain->heightMsl_m(latitude_deg, longitude_deg) + 30;
    const Station station = makeStation({latitude_deg, longitude_deg, height_m}, height_m, 4.0 / 3);
    std::optional<ClutterMapTask> task = clutterMapTask(*scenario, radar, station);
    const std::vector<double> posts_m = clutterPostRanges(task->grid, postSpacing_m(terrain.get()));
    task->ground = groundPosts(terrain.get(), posts_m);
    std::vector<ClutterCell> map(task->grid.cells());
    fillClutterMapCpu(*task, map.data());
    const double axis_rad = within(-kPi, kPi), step_rad = degToRad(kBeamwidth_deg) / kPerBeamwidth;
    std::vector<double> ranges_m(8), exact(8, 0);
    for (double& range_m : ranges_m) range_m = within(1500, kFarthest_m);
    double weights = 0;
    for (int i = -kBeside; i <= kBeside; ++i) {
      const double weight = twoWayPower(i * step_rad);
      const std::vector<double> sums = integralAlong(*terrain, station, axis_rad + i * step_rad, ranges_m);
      for (std::size_t n = 0; n < ranges_m.size(); ++n) exact[n] += weight * sums[n];
      weights += weight;
    }
    const ClutterMapView view = clutterMapView(task->grid, map.data());
    for (std::size_t n = 0; n < ranges_m.size(); ++n) {
      // grazing angles of 0.001: below, the echo is lost in others
      const double least = 1e-4 * dbToRatio(kGamma_db) * kRangeCell_m / std::pow(ranges_m[n], 3);
      const auto found = static_cast<double>(
          view.cellAt(static_cast<float>(axis_rad), static_cast<float>(ranges_m[n])).echo);
      const double wanted = exact[n] / weights;
      if (found < least && wanted < least) continue;
      ++cells;
      if (found < least || wanted < least) {
        ++of_one;
      } else {
        differences_db.push_back(std::abs(ratioToDb(found / wanted)));
      }
    }
  }
  std::sort(differences_db.begin(), differences_db.end());
  const std::size_t count = differences_db.size();
  ASSERT_GT(count, 30u);
  RecordProperty("cells", cells);
  RecordProperty("of one only", of_one);
  for (const double part : {0.5, 0.9, 1.0}) {
    RecordProperty(
        "difference (dB) " + std::to_string(part),
        std::to_string(differences_db[static_cast<std::size_t>(part * static_cast<double>(count - 1))]));
  }
  EXPECT_LT(differences_db[count / 2], 0.5);
  EXPECT_LT(differences_db[count * 9 / 10], 3);
  EXPECT_LT(of_one, cells / 5);
}

}  // namespace
}  // namespace emscape::emfield
