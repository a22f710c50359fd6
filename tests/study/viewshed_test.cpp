// Minimum heights of the model `horizon` against a walk along each line of sight and against GDAL's viewshed,
// on the same pixels.
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/snapshot.h"
#include "emscape/study/maps/coverage.h"
#include "scenario/antenna/shapes.h"
#include "study/maps/least_heights.h"
#include "study/picture/map_picture.h"
#include "tests/support/files.h"

namespace emscape::study {
namespace {

struct Close {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, Close>;

/// Heights above ground (m) from which a point above ground is seen, by GDAL. The earth's curvature is 1/k:
/// 0.75.
std::vector<double> viewshedOf(const MapGrid& grid, const std::vector<float>& ground_msl_m,
                               long long observer, double observer_agl_m) {
  GDALAllRegister();
  GDALDriver* const memory = GetGDALDriverManager()->GetDriverByName("MEM");
  const Dataset terrain(memory->Create("", grid.width, grid.height, 1, GDT_Float32, nullptr));
  double transform[6] = {grid.left_m, grid.cell_m, 0, grid.top_m, 0, -grid.cell_m};
  terrain->SetGeoTransform(transform);
  terrain->SetProjection(grid.wkt.c_str());
  EXPECT_EQ(terrain->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, grid.width, grid.height,
                                                const_cast<float*>(ground_msl_m.data()), grid.width,
                                                grid.height, GDT_Float32, 0, 0, nullptr),
            CE_None);
  const double x = grid.left_m + (static_cast<double>(observer % grid.width) + 0.5) * grid.cell_m;
  const double y = grid.top_m - (static_cast<double>(observer / grid.width) + 0.5) * grid.cell_m;
  const Dataset seen(static_cast<GDALDataset*>(GDALViewshedGenerate(
      terrain->GetRasterBand(1), "MEM", "", nullptr, x, y, observer_agl_m, 0, 255, 0, 0, -1, 0.75, GVM_Edge,
      0, nullptr, nullptr, GVOT_MIN_TARGET_HEIGHT_FROM_GROUND, nullptr)));
  std::vector<double> heights_m(grid.pixels(), NAN);
  if (seen == nullptr) return heights_m;
  EXPECT_EQ(seen->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, grid.width, grid.height, heights_m.data(),
                                             grid.width, grid.height, GDT_Float64, 0, 0, nullptr),
            CE_None);
  return heights_m;
}

TEST(MinHeight, SLOW_EqualsLineOfSight) {
  constexpr double kAntenna_agl_m = 25, kCell_m = 30;
  auto scenario =
      std::make_shared<scenario::Scenario>(*scenario::loadScenario(test::shippedScenario("jacksboro.yaml")));
  const MapArea area = circularArea({36.29, -84.24, 12e3});
  const MapGrid grid = makeMapGrid(area, kCell_m, "utm");
  const scenario::TerrainPtr terrain = loadTerrain(*scenario, area);
  const std::vector<float> ground_msl_m = groundOf(grid, *terrain);
  // In a valley the ground near the antenna decides, and its pixels differ from its posts; on a summit it
  // does not.
  long long observer = 0;
  float highest_m = -1;
  for (std::size_t p = 0; p < grid.pixels(); ++p) {
    if (!(ground_msl_m[p] > highest_m)) continue;
    highest_m = ground_msl_m[p];
    observer = static_cast<long long>(p);
  }

  // A transmitter at the centre of the observer's pixel, strong enough to exceed the threshold wherever it is
  // in sight.
  scenario::Emitter emitter = scenario->emitters.front();
  emitter.kind = scenario::EmitterKind::transmitter;
  emitter.antenna = scenario::makeIsotropic(0);
  emitter.scan = {};
  emitter.propagation.model = propagation::PropagationModel::horizon;
  emitter.power_w = 1e12;
  emitter.platform = 0;
  emitter.active_s.clear();
  scenario->emitters = {emitter};
  scenario->platforms.resize(1);
  scenario->placed_receivers.clear();
  scenario->targets.clear();
  scenario::TrackPoint point;
  point.position.latitude_deg = grid.positions[static_cast<std::size_t>(observer)].latitude_deg;
  point.position.longitude_deg = grid.positions[static_cast<std::size_t>(observer)].longitude_deg;
  point.position.height_agl_m = kAntenna_agl_m;
  scenario->platforms[0].track = {point};
  scenario->output.quantities = {"power_density_dbwm2"};
  scenario->output.floor = -200;
  const std::vector<float> least_m = LeastHeights(grid, {-150.0}, {}).compute(scenario, terrain, 0).front();

  const std::vector<double> seen_m = viewshedOf(grid, ground_msl_m, observer, kAntenna_agl_m);
  // The same by walking along the line of sight over the pixels, a quarter of one at a time.
  const auto groundAt = [&](double x, double y) {  // in pixels
    const int i = static_cast<int>(x), j = static_cast<int>(y);
    const double u = x - i, v = y - j;
    const auto at = [&](int column, int row) {
      return static_cast<double>(ground_msl_m[static_cast<std::size_t>(row) * grid.width + column]);
    };
    return (1 - v) * ((1 - u) * at(i, j) + u * at(i + 1, j)) +
           v * ((1 - u) * at(i, j + 1) + u * at(i + 1, j + 1));
  };
  const auto walkedTo_m = [&](int i, int j) {
    const double from_x = static_cast<double>(observer % grid.width),
                 from_y = static_cast<double>(observer / grid.width);
    const double length = std::hypot(i - from_x, j - from_y);
    const double eye_m = groundAt(from_x, from_y) + kAntenna_agl_m;
    const auto fall_m = [&](double range_m) { return range_m * range_m / (2 * 6371e3 * 4 / 3); };
    double steepest = -HUGE_VAL;
    for (double at = 0.25; at < length; at += 0.25) {
      const double range_m = at * grid.cell_m;
      const double ground_m =
          groundAt(from_x + (i - from_x) * at / length, from_y + (j - from_y) * at / length);
      steepest = std::max(steepest, (ground_m - fall_m(range_m) - eye_m) / range_m);
    }
    const double range_m = length * grid.cell_m;
    return std::max(0.0, eye_m + steepest * range_m + fall_m(range_m) - groundAt(i, j));
  };
  int compared = 0, hidden = 0, of_walk = 0, of_viewshed = 0, viewshed_of_walk = 0;
  for (int j = 1; j + 1 < grid.height; j += 5) {
    for (int i = 1; i + 1 < grid.width; i += 5) {
      const std::size_t p = static_cast<std::size_t>(j) * grid.width + i;
      if (std::isnan(least_m[p]) || std::isnan(seen_m[p])) continue;
      // Half a post's slope: the rise of the ground from a pixel to its neighbours.
      double rise_m = 0;
      for (const int step : {-1, 1, -grid.width, grid.width}) {
        const double neighbour_m = static_cast<double>(ground_msl_m[p + step]);
        rise_m = std::max(rise_m, std::abs(neighbour_m - static_cast<double>(ground_msl_m[p])));
      }
      const auto areNear = [&](double a_m, double b_m) {
        return std::abs(a_m - b_m) <= std::max(2.0, rise_m / 2);
      };
      const double own_m = static_cast<double>(least_m[p]), walked_m = walkedTo_m(i, j);
      ++compared;
      hidden += walked_m > 1 ? 1 : 0;
      of_walk += areNear(own_m, walked_m) ? 1 : 0;
      of_viewshed += areNear(own_m, seen_m[p]) ? 1 : 0;
      viewshed_of_walk += areNear(walked_m, seen_m[p]) ? 1 : 0;
    }
  }
  EXPECT_GT(compared, 10000);
  EXPECT_GT(hidden, 5000);
  EXPECT_GE(of_walk, 0.95 * compared) << of_walk << " of " << compared;
  // GDAL's viewshed interpolates from pixel to pixel outwards, and differs from the walk by as much.
  EXPECT_GE(of_viewshed, 0.65 * compared) << of_viewshed << " of " << compared;
  EXPECT_NEAR(of_viewshed, viewshed_of_walk, 0.05 * compared);
}

}  // namespace
}  // namespace emscape::study
