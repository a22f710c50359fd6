// The loss of a path is the same with its ends exchanged, over mountains (models of smooth ground: a smooth
// earth), with the automatic settings of every model.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/emfield/link/path_budget.h"
#include "tests/emfield/made_terrain.h"
#include "tests/emfield/test_scenario.h"
#include "tests/support/reference_data.h"
#include "tests/support/sanitizers.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using propagation::PropagationModel;

constexpr int kPaths = 20;
constexpr double kMast_m = 30, kVehicle_m = 2;

struct Ends {
  GeodeticPosition first, second;
};

/// Pairs of places in the tile, 5 to 15 km apart.
std::vector<Ends> pathsInTile(int count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(0.08, 0.92);
  const auto place = [&] {
    const double latitude_deg = 44 + part(random), longitude_deg = -72 + part(random);
    return GeodeticPosition{latitude_deg, longitude_deg, 0};
  };
  std::vector<Ends> paths;
  while (int(paths.size()) < count) {
    const Ends ends{place(), place()};
    const double length_m = geodesicInverse(ends.first.latitude_deg, ends.first.longitude_deg,
                                            ends.second.latitude_deg, ends.second.longitude_deg)
                                .distance_m;
    if (length_m > 5e3 && length_m < 15e3) paths.push_back(ends);
  }
  return paths;
}

double ground_m(const scenario::TerrainPtr& terrain, const GeodeticPosition& at) {
  return terrain ? terrain->heightMsl_m(at.latitude_deg, at.longitude_deg) : 0;
}

class Reciprocity : public ::testing::TestWithParam<PropagationModel> {
 protected:
  /// Excess loss (dB) from an emitter to a point.
  double excess_db(const scenario::TerrainPtr& terrain, const GeodeticPosition& from, double from_agl_m,
                   const GeodeticPosition& to, double to_agl_m) const {
    const auto scenario = emptyScenario(FrameKind::altitude, 44.5, -71.5, {90e3, 90e3, 4000}, {10, 10, 10});
    scenario::Emitter emitter = plainEmitter("mast", 0);
    emitter.frequency_hz = 3e8;
    emitter.propagation.model = GetParam();
    addEmitter(*scenario, from, emitter);
    scenario->platforms[0].track[0].position.height_ellipsoid_m.reset();
    scenario->platforms[0].track[0].position.height_msl_m = ground_m(terrain, from) + from_agl_m;
    const double height_msl_m = ground_m(terrain, to) + to_agl_m;
    const PathEnd end{{to.latitude_deg, to.longitude_deg,
                       height_msl_m + geoidUndulation_m(to.latitude_deg, to.longitude_deg)},
                      height_msl_m};
    return pathBudget(scenario::snapshotAt(scenario, terrain.get(), 0), 0, end, GetParam(), terrain.get())
        .excess.loss_db;
  }
};

TEST_P(Reciprocity, ExchangedEndsHaveTheSameLoss) {
  const auto file = test::referenceFile("dem/N44W072.tif");
  if (!file) GTEST_SKIP() << test::notInRepository("dem/N44W072.tif");
  if (emscape::test::kIsSanitized && GetParam() == PropagationModel::parabolic_equation)
    GTEST_SKIP() << "the sanitizers take minutes for these marches";
  scenario::TerrainSpec spec;
  spec.files = {*file};
  spec.locations = {{*file}};
  const auto scenario = emptyScenario(FrameKind::altitude, 44.5, -71.5, {90e3, 90e3, 4000}, {10, 10, 10});
  const bool is_smooth = GetParam() == PropagationModel::two_ray || GetParam() == PropagationModel::p528;
  const auto terrain = is_smooth ? nullptr : scenario::Terrain::load(spec, scenario::terrainBox(*scenario));
  std::vector<double> differences_db;
  for (const Ends& path : pathsInTile(kPaths)) {
    const double there_db = excess_db(terrain, path.first, kMast_m, path.second, kVehicle_m);
    const double back_db = excess_db(terrain, path.second, kVehicle_m, path.first, kMast_m);
    // `horizon` has no field behind it
    differences_db.push_back(there_db == back_db ? 0 : std::abs(there_db - back_db));
  }
  std::sort(differences_db.begin(), differences_db.end());
  EXPECT_LE(differences_db[kPaths * 9 / 10 - 1], 1);
  EXPECT_LE(differences_db[kPaths - 1], 3);
}

// Over ground that the band holds the march is the same matrix with its ends exchanged, if it is over the
// same posts. With posts at even distances from the emitter they differed by 0.1 dB here.
TEST(ReciprocityOfMarches, MarchesBothWaysAreOverTheSamePosts) {
  const auto hills = std::make_shared<const MadeTerrain>(51, 5, 0.4, [](double east, double north) {
    return 200 + 15 * std::sin(600 * east + 1) * std::cos(450 * north);
  });
  const auto scenario = emptyScenario(FrameKind::altitude, 51, 5, {20e3, 20e3, 1000}, {4, 4, 4});
  scenario::Emitter emitter = plainEmitter("mast", 0);
  emitter.frequency_hz = 4e8;
  emitter.propagation.model = PropagationModel::parabolic_equation;
  const auto pathFrom_db = [&](const GeodeticPosition& from, double from_agl_m, const GeodeticPosition& to,
                               double to_agl_m) {
    const auto endAt = [&](const GeodeticPosition& at, double agl_m) {
      const double height_msl_m = ground_m(hills, at) + agl_m;
      return PathEnd{{at.latitude_deg, at.longitude_deg,
                      height_msl_m + geoidUndulation_m(at.latitude_deg, at.longitude_deg)},
                     height_msl_m};
    };
    const PathProfile profile = readPathProfile(endAt(from, from_agl_m), endAt(to, to_agl_m),
                                                scenario->atmosphere, hills.get(), false);
    return pathExcess(*scenario, emitter, {}, profile, hills.get()).loss_db;
  };
  const GeodeticPosition mast{50.95, 4.93, 0};
  for (const GeodeticPosition& vehicle :
       {GeodeticPosition{51.02, 4.96, 0}, {50.97, 5.06, 0}, {50.98, 4.87, 0}}) {
    const double there_db = pathFrom_db(mast, kMast_m, vehicle, kVehicle_m);
    const double back_db = pathFrom_db(vehicle, kVehicle_m, mast, kMast_m);
    EXPECT_NEAR(there_db, back_db, 0.005);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Models, Reciprocity,
    ::testing::Values(PropagationModel::free_space, PropagationModel::horizon, PropagationModel::diffraction,
                      PropagationModel::two_ray, PropagationModel::itm, PropagationModel::p1812,
                      PropagationModel::p452, PropagationModel::p528, PropagationModel::parabolic_equation),
    [](const auto& model) {
      return std::string(propagation::namesOf(model.param)[static_cast<std::size_t>(model.param)]);
    });

}  // namespace
}  // namespace emscape::emfield
