// Pixels of maps equal the budgets of the paths to their centres, with every model of the registry.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "emscape/base/geodesy/geoid.h"
#include "emscape/emfield/link/path_budget.h"
#include "emscape/study/maps/area.h"
#include "emscape/study/maps/coverage.h"
#include "propagation/registry/model_info.h"
#include "tests/emfield/test_scenario.h"
#include "tests/support/files.h"

namespace emscape::study {
namespace {

using namespace emscape::emfield::testing;
using emfield::HeightReference;
using propagation::ModelInfo;
using propagation::PropagationModel;

struct Site {
  const char* name;
  const char* terrain;  ///< null: a smooth earth
  double latitude_deg, longitude_deg, height_agl_m;
  double frequency_hz;
  double radius_m, cell_m;  ///< of the map
};

const Site kSites[] = {
    {"ridge", "scenarios/data/jacksboro.tif", 36.27, -84.24167, 20, 3e9, 12e3, 400},
    {"mountain", "tests/data/dem/N44W072.tif", 44.27, -71.303, 10, 450e6, 25e3, 900},
    {"valley", "tests/data/dem/N44W072.tif", 44.6, -71.55, 30, 9.4e9, 25e3, 900},
    {"sea", nullptr, 44.6, -71.55, 30, 9.4e9, 40e3, 1500},
};

const std::vector<MapHeight> kHeights{
    {HeightReference::ground, 2},           {HeightReference::ground, 30},
    {HeightReference::ground, 150},         {HeightReference::ground, 1000},
    {HeightReference::mean_sea_level, 900}, {HeightReference::mean_sea_level, 3000}};

std::shared_ptr<scenario::Scenario> radarAt(const Site& site, PropagationModel model) {
  auto scenario = emptyScenario(FrameKind::altitude, site.latitude_deg, site.longitude_deg,
                                {2 * site.radius_m, 2 * site.radius_m, 1e3}, {4, 4, 4});
  if (site.terrain != nullptr) scenario->terrain = scenario::TerrainSpec{};
  scenario::Emitter emitter = plainEmitter("radar", 0);
  emitter.kind = scenario::EmitterKind::radar;
  emitter.frequency_hz = site.frequency_hz;
  emitter.power_w = 20e3;
  emitter.antenna = scenario::makeGaussian(34, 3, 8, -40);
  emitter.receiver.bandwidth_hz = 1e6;
  emitter.propagation.model = model;
  emitter.scan.kind = scenario::ScanKind::track;
  addEmitter(*scenario, {site.latitude_deg, site.longitude_deg, 0}, emitter);
  scenario->platforms[0].track[0].position.height_ellipsoid_m.reset();
  scenario->platforms[0].track[0].position.height_agl_m = site.height_agl_m;
  scenario->output.radar_look = scenario::RadarAim::target;
  return scenario;
}

scenario::TerrainPtr terrainOf(const Site& site) {
  if (site.terrain == nullptr) return nullptr;
  scenario::TerrainSpec spec;
  spec.files = {test::sourceFile(site.terrain)};
  spec.locations = {{spec.files[0]}};
  return scenario::Terrain::load(spec, scenario::Terrain::describe(spec.files[0]).box);
}

/// Differences of maps from the budgets: of power density (dB) and of the probability of detection, which is
/// left out where the model marches, because a second map would take minutes.
struct Differences {
  std::vector<double> power_db, probability;

  /// @param part  of the points, 0..1
  static double within(std::vector<double> values, double part) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
  }
};

/// Compares random pixels at all heights.
Differences compare(const Site& site, PropagationModel model, int pixels, std::mt19937& random) {
  const scenario::TerrainPtr terrain = terrainOf(site);
  const auto scenario = radarAt(site, model);
  MapGrid grid =
      makeMapGrid(circularArea({site.latitude_deg, site.longitude_deg, site.radius_m}), site.cell_m, "utm");
  // Every fourth pixel: the map costs less.
  for (std::size_t p = 0; p < grid.pixels(); ++p) {
    if (p % 4 != 0) grid.positions[p].latitude_deg = NAN;
  }
  std::vector<CoverageMap> power, probability;
  computeCoverage(scenario, terrain, grid,
                  {kHeights, {Product::value}, scenario::Quantity::power_density_dbwm2, -60, {0}}, {},
                  [&](CoverageMap map) { power.push_back(std::move(map)); });
  const bool has_probability = propagation::modelInfo(model).radial == nullptr;
  if (has_probability) {
    computeCoverage(scenario, terrain, grid,
                    {kHeights, {Product::value}, scenario::Quantity::detection_probability, 0.5, {0}}, {},
                    [&](CoverageMap map) { probability.push_back(std::move(map)); });
  }
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, terrain.get(), 0);
  Differences differences;
  for (int n = 0; n < pixels;) {
    const std::size_t p = random() % grid.pixels();
    const auto [latitude_deg, longitude_deg] = grid.positions[p];
    if (std::isnan(latitude_deg)) continue;
    ++n;
    const double ground_msl_m =
        terrain != nullptr ? static_cast<double>(terrain->heightMsl_m(latitude_deg, longitude_deg)) : 0;
    for (std::size_t m = 0; m < power.size(); ++m) {
      if (std::isnan(power[m].values[p])) continue;  // below ground
      const bool is_agl = power[m].height->reference == HeightReference::ground;
      const double height_msl_m = power[m].height->metres + (is_agl ? ground_msl_m : 0);
      const emfield::PathEnd end{
          {latitude_deg, longitude_deg, height_msl_m + geoidUndulation_m(latitude_deg, longitude_deg)},
          height_msl_m};
      const auto budget = emfield::pathBudget(snapshot, 0, end, model, terrain.get());
      const double level_db = std::max(budget.find("power_density_dbwm2")->value, scenario->output.floor);
      differences.power_db.push_back(std::abs(static_cast<double>(power[m].values[p]) - level_db));
      if (!has_probability) continue;
      differences.probability.push_back(std::abs(static_cast<double>(probability[m].values[p]) -
                                                 budget.find("detection_probability")->value));
    }
  }
  return differences;
}

TEST(PixelsOfMaps, SLOW_EqualProfileWithEveryModel) {
  std::mt19937 random(7);
  std::size_t compared = 0;
  for (const ModelInfo& model : propagation::models()) {
    if (model.radial != nullptr) continue;  // the next test
    for (const Site& site : kSites) {
      SCOPED_TRACE(model.name + " at the " + site.name);
      const Differences found = compare(site, model.model, 30, random);
      compared += found.power_db.size();
      // Maps of p528 are from a table, which is farther off at the steps of the model itself.
      const bool is_of_table = model.model == propagation::PropagationModel::p528;
      EXPECT_LE(Differences::within(found.power_db, is_of_table ? 0.95 : 1), 0.01);
      EXPECT_LE(Differences::within(found.power_db, 1), is_of_table ? 0.03 : 0.01);
      EXPECT_LE(Differences::within(found.probability, 1), is_of_table ? 0.01 : 1e-4);
    }
  }
  EXPECT_GT(compared, 3000u);
}

// A map has the mean over cells between marched azimuths, `profile` the field of the path's own. A map has at
// most 4096 heights, `profile` 32768: at high frequencies its largest angle is smaller, and less field comes
// down behind steep ridges.
// With EMSCAPE_PIXELS, that many pixels of each site; otherwise 8 of one site.
TEST(PixelsOfMaps, SLOW_ParabolicEquationGivesMeansOfCells) {
  const char* const pixels = std::getenv("EMSCAPE_PIXELS");
  std::mt19937 random(7);
  const std::vector<Site> sites =
      pixels != nullptr ? std::vector<Site>(std::begin(kSites), std::end(kSites)) : std::vector{kSites[0]};
  for (const Site& site : sites) {
    SCOPED_TRACE(site.name);
    const Differences found = compare(site, PropagationModel::parabolic_equation,
                                      pixels != nullptr ? std::atoi(pixels) : 8, random);
    for (const double part : {0.5, 0.9, 1.0}) {
      RecordProperty(fmt::format("{}, {} points, {:g} within", site.name, found.power_db.size(), part),
                     fmt::format("{:.2f} dB", Differences::within(found.power_db, part)));
    }
    EXPECT_LE(Differences::within(found.power_db, 0.5), 2);
    EXPECT_LE(Differences::within(found.power_db, 0.9), 30);
  }
}

}  // namespace
}  // namespace emscape::study
