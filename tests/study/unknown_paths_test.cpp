// Radars of which some see a pixel only across missing elevation data: what the others find is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "emscape/study/exposure/exposure.h"
#include "emscape/study/maps/coverage.h"
#include "tests/emfield/made_terrain.h"
#include "tests/emfield/radar_duel.h"

namespace emscape::study {
namespace {

using propagation::PropagationModel;
using ScenarioPtr = std::shared_ptr<scenario::Scenario>;
using Maps = std::map<std::string, CoverageMap>;

const MapHeight kAboveGround{emfield::HeightReference::ground, 300},
    kAboveSea{emfield::HeightReference::mean_sea_level, 900};

/// Two radars on either side of a hole of the elevation data.
class AcrossAHole : public ::testing::TestWithParam<PropagationModel> {
 protected:
  AcrossAHole() {
    using namespace emfield::testing;
    both = emptyScenario(FrameKind::altitude, 44.75, -71.25, {50e3, 40e3, 4000}, {10, 10, 4});
    for (const double longitude_deg : {-71.45, -71.05}) {
      scenario::Emitter radar = trackingRadar();
      radar.name = longitude_deg < -71.25 ? "west" : "east";
      radar.power_w = 300;
      radar.propagation.model = GetParam();
      addEmitter(*both, {44.75, longitude_deg, 1500}, radar);
    }
    grid = makeMapGrid(areaOf(both->region), 1500, "utm");
  }

  ScenarioPtr alone(std::size_t emitter) const {
    auto one = std::make_shared<scenario::Scenario>(*both);
    one->emitters = {both->emitters[emitter]};
    return one;
  }

  Maps mapsOf(const ScenarioPtr& scenario, const std::vector<Product>& products, const MapHeight& height,
              const std::vector<double>& times_s = {0},
              scenario::Quantity quantity = scenario::Quantity::detection_probability,
              double threshold = 0.5) const {
    Maps maps;
    computeCoverage(scenario, terrain, grid, {{height}, products, quantity, threshold, times_s}, {},
                    [&](CoverageMap map) { maps[map.name] = std::move(map); });
    return maps;
  }

  const scenario::TerrainPtr terrain =
      std::make_shared<const emfield::testing::MadeTerrain>(44.5, -71.5, 1.0, 0.03);
  ScenarioPtr both;
  MapGrid grid;
};

INSTANTIATE_TEST_SUITE_P(Models, AcrossAHole,
                         ::testing::Values(PropagationModel::horizon, PropagationModel::diffraction),
                         [](const auto& instance) { return std::string(toString(instance.param)); });

TEST_P(AcrossAHole, CoverageIsThatOfKnownOrUnknownRadars) {
  for (const MapHeight& height : {kAboveGround, kAboveSea}) {
    const Maps of_both = mapsOf(both, {Product::covered, Product::value}, height);
    const Maps of_west = mapsOf(alone(0), {Product::covered, Product::value}, height),
               of_east = mapsOf(alone(1), {Product::covered, Product::value}, height);
    int rescued = 0, undecided = 0;
    for (std::size_t p = 0; p < grid.pixels(); ++p) {
      if (std::isnan(grid.positions[p].latitude_deg)) continue;
      const float west = of_west.at("covered").values[p], east = of_east.at("covered").values[p],
                  found = of_both.at("covered").values[p], value = of_both.at("value").values[p];
      const PixelAnswer answer = of_both.at("covered").answers[p];
      const bool is_unknown = std::isnan(west) || std::isnan(east);
      if (west == 1 || east == 1) {
        ASSERT_EQ(found, 1) << p;
        EXPECT_EQ(answer, is_unknown ? PixelAnswer::bound : PixelAnswer::exact);
        rescued += is_unknown ? 1 : 0;
        const float a = of_west.at("value").values[p], b = of_east.at("value").values[p];
        const float missed = (std::isnan(a) ? 1 : 1 - a) * (std::isnan(b) ? 1 : 1 - b);
        EXPECT_NEAR(value, 1 - missed, 1e-5) << "at least that of the known radars";
      } else if (is_unknown) {
        EXPECT_TRUE(std::isnan(found) && std::isnan(value)) << p;
        EXPECT_TRUE(answer == PixelAnswer::unknown ||
                    (answer == PixelAnswer::none && height.reference == kAboveSea.reference));
        undecided += answer == PixelAnswer::unknown ? 1 : 0;
      } else {
        EXPECT_EQ(found, 0) << p;
        EXPECT_EQ(answer, PixelAnswer::exact);
      }
    }
    EXPECT_GT(rescued, 20);
    EXPECT_GT(undecided, 5);
    EXPECT_GE(of_both.at("covered").class_area_m2,
              std::max(of_west.at("covered").class_area_m2, of_east.at("covered").class_area_m2));
  }
}

TEST_P(AcrossAHole, CountsAndRangesAreThoseOfKnownRadarsTheBestNeedsAll) {
  const std::vector<Product> products{Product::count, Product::redundancy, Product::best, Product::max_range};
  const Maps of_both = mapsOf(both, products, kAboveGround),
             of_west = mapsOf(alone(0), products, kAboveGround),
             of_east = mapsOf(alone(1), products, kAboveGround);
  int bounds = 0;
  for (std::size_t p = 0; p < grid.pixels(); ++p) {
    const float west = of_west.at("count").values[p], east = of_east.at("count").values[p];
    const float known = (west == 1 ? 1.0f : 0.0f) + (east == 1 ? 1.0f : 0.0f);
    if ((std::isnan(west) || std::isnan(east)) && known > 0) {
      ++bounds;
      EXPECT_EQ(of_both.at("count").values[p], known);
      EXPECT_EQ(of_both.at("redundancy").values[p], 0);
      EXPECT_EQ(of_both.at("max_range").values[p],
                std::fmax(of_west.at("max_range").values[p], of_east.at("max_range").values[p]));
      EXPECT_EQ(of_both.at("best").answers[p], PixelAnswer::unknown);
      EXPECT_TRUE(std::isnan(of_both.at("best").values[p]));
    } else if (std::isnan(west) || std::isnan(east)) {
      EXPECT_TRUE(std::isnan(of_both.at("count").values[p]));
    } else {
      EXPECT_EQ(of_both.at("count").values[p], known);
    }
  }
  EXPECT_GT(bounds, 20);
}

TEST_P(AcrossAHole, MinimumHeightIsThatOfKnownRadars) {
  const Maps of_both = mapsOf(both, {Product::min_height}, kAboveGround),
             of_west = mapsOf(alone(0), {Product::min_height}, kAboveGround),
             of_east = mapsOf(alone(1), {Product::min_height}, kAboveGround);
  const CoverageMap &all = of_both.at("min_height"), &west = of_west.at("min_height"),
                    &east = of_east.at("min_height");
  int bounds = 0;
  for (std::size_t p = 0; p < grid.pixels(); ++p) {
    const float known_m = std::fmin(west.values[p], east.values[p]);
    const bool is_unknown =
        west.answers[p] == PixelAnswer::unknown || east.answers[p] == PixelAnswer::unknown;
    if (!is_unknown) continue;
    if (std::isnan(known_m)) {
      EXPECT_EQ(all.answers[p], PixelAnswer::unknown);
      continue;
    }
    EXPECT_EQ(all.values[p], known_m);
    EXPECT_EQ(all.answers[p], PixelAnswer::bound);
    ++bounds;
  }
  EXPECT_GT(bounds, 20);
  EXPECT_GE(all.known_area_m2, std::max(west.class_area_m2, east.class_area_m2));
}

TEST_P(AcrossAHole, JammingIsAnsweredWhereTheKnownRadarsCover) {
  both->emitters[1].kind = scenario::EmitterKind::radar;
  emfield::testing::addEmitter(*both, {44.9, -71.25, 2500}, emfield::testing::jammerOf(0.01));
  auto west = std::make_shared<scenario::Scenario>(*both);
  west->emitters.erase(west->emitters.begin() + 1);
  const std::vector<Product> products{Product::covered, Product::jam_loss, Product::burn_through};
  const Maps of_both = mapsOf(both, products, kAboveGround), of_west = mapsOf(west, products, kAboveGround);
  for (std::size_t p = 0; p < grid.pixels(); ++p) {
    const float covered = of_both.at("covered").values[p];
    if (of_west.at("covered").values[p] == 1) {
      EXPECT_EQ(covered, 1);
    }
    if (covered != 1) continue;
    EXPECT_EQ(of_both.at("burn_through").values[p], 2);
    EXPECT_EQ(of_both.at("jam_loss").values[p], 0);
  }
}

TEST_P(AcrossAHole, TimesWithKnownCoverageCount) {
  both->emitters[0].active_s = {{0, 5}};
  both->clock = {"", 30, 10};
  const std::vector<double> times_s{0, 10, 20};
  const std::vector<Product> products{Product::first_detection, Product::fraction, Product::gaps};
  const Maps of_both = mapsOf(both, products, kAboveGround, times_s),
             of_west = mapsOf(alone(0), products, kAboveGround, times_s),
             of_east = mapsOf(alone(1), {Product::covered}, kAboveGround);
  int bounds = 0;
  for (std::size_t p = 0; p < grid.pixels(); ++p) {
    if (of_east.at("covered").answers[p] != PixelAnswer::unknown) continue;
    const bool is_seen = of_west.at("first_detection").values[p] == 0;
    EXPECT_EQ(of_both.at("first_detection").answers[p], is_seen ? PixelAnswer::bound : PixelAnswer::unknown);
    EXPECT_EQ(of_both.at("gaps").answers[p], PixelAnswer::unknown) << "later times may be covered";
    if (!is_seen) continue;
    ++bounds;
    EXPECT_EQ(of_both.at("first_detection").values[p], 0);
    EXPECT_EQ(of_both.at("fraction").values[p], 0.5f) << "at least";
  }
  EXPECT_GT(bounds, 10);
}

TEST_P(AcrossAHole, ThresholdsOfOtherQuantitiesAreReachedByKnownEmitters) {
  using scenario::Quantity;
  for (const auto& [quantity, threshold] : {std::pair{Quantity::power_density_dbwm2, -90.0},
                                            {Quantity::snr_db, 10.0},
                                            {Quantity::emitter_count, 1.0}}) {
    const auto of = [&](const ScenarioPtr& scenario) {
      return mapsOf(scenario, {Product::covered}, kAboveGround, {0}, quantity, threshold).at("covered");
    };
    const CoverageMap all = of(both), west = of(alone(0)), east = of(alone(1));
    for (std::size_t p = 0; p < grid.pixels(); ++p)
      if (west.values[p] == 1 || east.values[p] == 1) {
        ASSERT_EQ(all.values[p], 1) << p;
      }
  }
}

TEST_P(AcrossAHole, ExposureIsKnownWhereAKnownRadarReachesThePlatform) {
  emfield::testing::addEmitter(*both, {44.72, -71.5, 1700}, emfield::testing::plainEmitter("radio", 1));
  scenario::Platform& aircraft = both->platforms.back();
  aircraft.track = {};
  for (int n = 0; n <= 40; ++n) {
    scenario::TrackPoint point;
    point.t_s = 10 * n;
    point.position.latitude_deg = 44.77;
    point.position.longitude_deg = -71.5 + 0.0125 * n;
    point.position.height_ellipsoid_m = 1600;
    aircraft.track.push_back(point);
  }
  both->clock = {"", 400, 10};
  ExposureRequest request;
  request.platform = static_cast<int>(both->platforms.size()) - 1;
  for (int n = 0; n <= 40; ++n) request.times_s.push_back(10 * n);
  const Exposure exposure = computeExposure(both, terrain, request, {});
  int bounds = 0;
  for (const ExposureRow& row : exposure.rows) {
    const bool is_unknown = std::isnan(row.each[0]) || std::isnan(row.each[1]);
    const bool is_reached = row.each[0] >= 0.5 || row.each[1] >= 0.5;
    if (is_reached) {
      EXPECT_EQ(row.state, ExposureState::reached) << row.time_s;
    }
    if (is_unknown && !is_reached) {
      EXPECT_EQ(row.state, ExposureState::unknown) << row.time_s;
    }
    EXPECT_EQ(row.state == ExposureState::unknown, std::isnan(row.value));
    bounds += is_unknown && is_reached ? 1 : 0;
  }
  EXPECT_GT(bounds, 2);
}

}  // namespace
}  // namespace emscape::study
