// Surface clutter of beams over mountains and hills against a 2-D integral over the visible ground.

#include "emfield/geometry/clutter_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "emfield/clutter/clutter_beam.h"
#include "emfield/columns/station.h"
#include "emfield/combine/clutter_echo.h"
#include "emscape/scenario/terrain/terrain.h"
#include "scenario/antenna/shapes.h"
#include "scenario/antenna/tables.h"
#include "tests/emfield/radar_duel.h"
#include "tests/support/files.h"
#include "tests/support/reference_data.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;

constexpr double kGamma_db = -15, kLowest_db = -80;

/// A part of elevation data, and sites in it.
struct Ground {
  std::string file;
  double south_deg, north_deg, west_deg, east_deg;
};
const Ground kMountains{test::sourceFile("tests/data/dem/N44W072.tif"), 44.3, 44.7, -71.7, -71.3};
const Ground kHills{test::shippedScenario("data/jacksboro.tif"), 36.27, 36.33, -84.28, -84.21};
const Ground kIsland{(test::referenceDir() / "dem/n00_e006_3arc_v2.dt1").string(), 0.15, 0.35, 6.5, 6.7};

/// A radar among mountains or hills.
struct Case {
  std::string name;
  Ground ground;
  scenario::AntennaPtr antenna;
  double mast_m, range_cell_m, nearest_m, farthest_m;
  double above_deg;     ///< largest elevation of the beam's axis above the ground's at the range
  double bound_db = 3;  ///< of 90 % of the cells
};

/// Two-way power in a direction beside the axis of a beam.
double twoWayPower(const scenario::Antenna& antenna, double off_rad, double elevation_rad, double axis_rad) {
  const double level = std::cos(elevation_rad) * std::cos(off_rad), up = std::sin(elevation_rad);
  return std::pow(antenna.amplitudeTowards({level * std::cos(axis_rad) + up * std::sin(axis_rad),
                                            std::cos(elevation_rad) * std::sin(off_rad),
                                            up * std::cos(axis_rad) - level * std::sin(axis_rad)},
                                           0, 0),
                  4);
}

/// A Gaussian beam as a measured pattern.
scenario::AntennaPtr measuredBeam(double beamwidth_deg) {
  std::vector<double> azimuths_deg, elevations_deg;
  for (double a = -180; a <= 180; a += 0.5) azimuths_deg.push_back(a);
  for (double e = -90; e <= 90; e += 0.5) elevations_deg.push_back(e);
  std::vector<float> amplitudes;
  for (const double e : elevations_deg) {
    for (const double a : azimuths_deg)
      amplitudes.push_back(
          static_cast<float>(std::pow(10, -0.6 * (a * a + e * e) / (beamwidth_deg * beamwidth_deg))));
  }
  return scenario::makeGridAntenna(scenario::gridNodes(azimuths_deg, elevations_deg), std::move(amplitudes),
                                   30, "measured");
}

/// The axis of a beam at a range cell.
struct Look {
  double range_m = 0, elevation_rad = 0;
};

/// The integral of reflectivity over range^4 in range cells, over the visible ground, along one azimuth:
/// faces of 10 m, each with the pattern towards it.
std::vector<double> integralAlong(const Case& c, const scenario::Terrain& terrain, const Station& station,
                                  double azimuth_rad, double off_rad, const std::vector<Look>& looks) {
  constexpr double kStep_m = 10;
  const int steps = static_cast<int>((c.farthest_m + c.range_cell_m) / kStep_m);
  const GeodeticPosition end =
      geodesicDirect(station.latitude_deg, station.longitude_deg, azimuth_rad, steps * kStep_m / 2);
  const GeodeticPosition far_end =
      geodesicDirect(station.latitude_deg, station.longitude_deg, azimuth_rad, steps * kStep_m);
  // a parabola through three points of the geodesic
  const auto along = [&](double from, double middle, double to, double t) {
    return from * (1 - t) * (1 - 2 * t) + 4 * middle * t * (1 - t) + to * t * (2 * t - 1);
  };
  std::vector<double> sums(looks.size(), 0);
  double highest = -HUGE_VAL, height_before_m = 0, below_before_m = 0;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps, range_m = i * kStep_m;
    const auto height_m = static_cast<double>(
        terrain.heightMsl_m(along(station.latitude_deg, end.latitude_deg, far_end.latitude_deg, t),
                            along(station.longitude_deg, end.longitude_deg, far_end.longitude_deg, t)));
    const double below_m =
        station.height_msl_m - height_m + range_m * range_m / (2 * station.effective_earth_radius_m);
    const bool is_visible = i > 0 && -below_m / range_m > highest;
    if (is_visible) highest = -below_m / range_m;
    if (is_visible && !std::isnan(below_before_m)) {  // of two posts that are known
      const double middle_m = range_m - kStep_m / 2, depth_m = (below_m + below_before_m) / 2;
      const double tilt =
          (height_m - height_before_m) / kStep_m - middle_m / station.effective_earth_radius_m;
      const double slant_m = std::hypot(middle_m, depth_m), stretch = std::sqrt(1 + tilt * tilt);
      const double sine = (middle_m * tilt + depth_m) / (slant_m * stretch);
      const double echo =
          dbToRatio(kGamma_db) * std::max(sine, 0.0) * middle_m * kStep_m * stretch / std::pow(slant_m, 4);
      for (std::size_t n = 0; n < looks.size(); ++n) {
        if (std::abs(slant_m - looks[n].range_m) < c.range_cell_m / 2)
          sums[n] +=
              echo * twoWayPower(*c.antenna, off_rad, std::asin(-depth_m / slant_m), looks[n].elevation_rad);
      }
    }
    height_before_m = height_m;
    below_before_m = below_m;
  }
  return sums;
}

/// A radar's map, and clutter of beams over it.
class Mapped {
 public:
  Mapped(const scenario::Scenario& scenario, const scenario::Emitter& radar, const Station& station,
         const scenario::Terrain* terrain)
      : antenna_(radar.antenna) {
    std::optional<ClutterMapTask> task = clutterMapTask(scenario, radar, station);
    const std::vector<double> posts_m = clutterPostRanges(task->grid, postSpacing_m(terrain));
    task->ground = groundPosts(terrain, posts_m);
    cells_.resize(task->grid.cells());
    fillClutterMapCpu(*task, cells_.data());
    view_ = clutterMapView(task->grid, cells_.data());
  }

  /// The integral of reflectivity over range^4, weighted by the two-way pattern.
  double integral(double azimuth_rad, const Look& look) const {
    ClutterTask task;
    task.surface = static_cast<float>(clutterBeam(*antenna_).azimuth_rad);
    EmitterBeam beam;
    const double level = std::cos(look.elevation_rad), sine = std::sin(look.elevation_rad);
    beam.forward = vecCast<float>(Vec3d{std::sin(azimuth_rad) * level, std::cos(azimuth_rad) * level, sine});
    beam.right = vecCast<float>(Vec3d{std::cos(azimuth_rad), -std::sin(azimuth_rad), 0});
    beam.up = vecCast<float>(Vec3d{-std::sin(azimuth_rad) * sine, -std::cos(azimuth_rad) * sine, level});
    beam.pattern = antenna_->view();
    return scenario::onPattern(beam.pattern, [&](auto kind) {
      return static_cast<double>(
          clutterToNoise<kind>(task, view_, view_.trips, beam, Aim{}, static_cast<float>(look.range_m)));
    });
  }

 private:
  scenario::AntennaPtr antenna_;
  std::vector<ClutterCell> cells_;
  ClutterMapView view_;
};

class ClutterOverTerrain : public ::testing::TestWithParam<Case> {};

TEST_P(ClutterOverTerrain, SLOW_IsNearAnIntegralOverVisibleGround) {
  constexpr int kPerBeamwidth = 32, kBeside = 64, kSites = 24, kLooks = 8;
  const Case& c = GetParam();
  if (!std::filesystem::exists(c.ground.file)) GTEST_SKIP() << "no " << c.ground.file;
  scenario::TerrainSpec spec;
  spec.files = {c.ground.file};
  spec.locations = {{spec.files[0]}};
  std::mt19937 random(5);
  const auto within = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  std::vector<double> differences_db;
  int cells = 0, of_one = 0, too_weak = 0;
  double largest_of_one_db = -HUGE_VAL;
  for (int site = 0; site < kSites; ++site) {
    const double latitude_deg = within(c.ground.south_deg, c.ground.north_deg);
    const double longitude_deg = within(c.ground.west_deg, c.ground.east_deg);
    const auto scenario = emptyScenario(FrameKind::altitude, latitude_deg, longitude_deg,
                                        {2 * c.farthest_m, 2 * c.farthest_m, 1000}, {8, 8, 2});
    scenario::Emitter radar = trackingRadar();
    radar.antenna = c.antenna;
    radar.clutter.emplace();
    radar.clutter->land_gamma_db = kGamma_db;
    radar.clutter->range_cell_m = c.range_cell_m;
    const auto terrain = scenario::Terrain::load(spec, scenario::terrainBox(*scenario));
    const double height_m = terrain->heightMsl_m(latitude_deg, longitude_deg) + c.mast_m;
    if (std::isnan(height_m)) continue;  // no post is known there
    const Station station = makeStation({latitude_deg, longitude_deg, height_m}, height_m, 4.0 / 3);
    const Mapped map(*scenario, radar, station, terrain.get());
    const double axis_rad = within(-kPi, kPi),
                 step_rad = degToRad(c.antenna->beamwidth_az_deg) / kPerBeamwidth;
    std::vector<Look> looks(kLooks);
    for (Look& look : looks) {
      double ground_m = NAN;
      while (std::isnan(ground_m)) {
        look.range_m = within(c.nearest_m, c.farthest_m);
        const GeodeticPosition below = geodesicDirect(latitude_deg, longitude_deg, axis_rad, look.range_m);
        ground_m = static_cast<double>(terrain->heightMsl_m(below.latitude_deg, below.longitude_deg));
      }
      look.elevation_rad = std::atan2(ground_m - height_m, look.range_m) + degToRad(within(0, c.above_deg));
    }
    std::vector<double> exact(kLooks, 0);
    for (int i = -kBeside; i <= kBeside; ++i) {
      const std::vector<double> sums =
          integralAlong(c, *terrain, station, axis_rad + i * step_rad, i * step_rad, looks);
      for (std::size_t n = 0; n < looks.size(); ++n) exact[n] += sums[n] * step_rad;
    }
    for (std::size_t n = 0; n < looks.size(); ++n) {
      // grazing angles of 0.001, 20 dB below the beam's maximum: below, the echo is lost in others
      const double least = 1e-6 * dbToRatio(kGamma_db) * c.range_cell_m / std::pow(looks[n].range_m, 3) *
                           degToRad(c.antenna->beamwidth_az_deg);
      const double found = map.integral(axis_rad, looks[n]);
      if (found < least && exact[n] < least) continue;
      ++cells;
      if (found < least || exact[n] < least) {
        ++of_one;
        largest_of_one_db = std::max(largest_of_one_db, ratioToDb(std::max(found, exact[n]) / least));
      } else {
        differences_db.push_back(std::abs(ratioToDb(found / exact[n])));
        if (found < exact[n]) ++too_weak;
      }
    }
  }
  std::sort(differences_db.begin(), differences_db.end());
  const std::size_t count = differences_db.size();
  ASSERT_GT(count, 30u);
  const auto part = [&](double of) {
    return differences_db[static_cast<std::size_t>(of * static_cast<double>(count - 1))];
  };
  std::cout << c.name << ": " << cells << " cells, differences of half " << part(0.5) << ", 90 % "
            << part(0.9) << ", all " << part(1) << " dB; too weak " << too_weak << "; of one only " << of_one
            << ", up to " << largest_of_one_db << " dB above the least\n";
  EXPECT_LT(part(0.5), 0.5);
  EXPECT_LT(part(0.9), c.bound_db);
  EXPECT_LE(of_one, cells / 15);
}

INSTANTIATE_TEST_SUITE_P(
    Radars, ClutterOverTerrain,
    ::testing::Values(
        Case{"mountains", kMountains, scenario::makeGaussian(30, 2, 2, kLowest_db), 30, 300, 1500, 10e3, 3},
        Case{"short cells", kMountains, scenario::makeGaussian(30, 1.5, 1.5, kLowest_db), 30, 75, 1500, 10e3,
             2},
        Case{"long cells from above", kMountains, scenario::makeGaussian(30, 5, 5, kLowest_db), 1000, 3000,
             5e3, 15e3, 8},
        Case{"cosecant squared over hills", kHills, scenario::makeCosecant2(30, 1.5, 4.8, 30, kLowest_db), 15,
             150, 1000, 9e3, 2},
        Case{"aperture over hills", kHills, scenario::makeSinc(30, 2, 3, kLowest_db), 200, 600, 1000, 9e3, 3},
        Case{"array over an island", kIsland, scenario::makePhasedArray(30, 50, 30, 0.5, 0.5, kLowest_db), 30,
             150, 1500, 10e3, 2},
        Case{"measured beam over hills", kHills, measuredBeam(3), 30, 300, 1000, 9e3, 3},
        // slopes of which a cell spans more than two beamwidths
        Case{"steep slopes from above", kIsland, measuredBeam(3), 500, 450, 1500, 10e3, 4.5, 5}),
    [](const auto& tested) {
      std::string name = tested.param.name;
      std::replace(name.begin(), name.end(), ' ', '_');
      return name;
    });

}  // namespace
}  // namespace emscape::emfield
