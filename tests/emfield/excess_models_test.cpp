// Models in the field against their functions, and interpolation errors.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <random>
#include <type_traits>

#include "emfield/excess/model_check.h"
#include "emscape/base/error.h"
#include "emscape/scenario/file/scenario_file.h"
#include "propagation/air/gases.h"
#include "propagation/air/rain.h"
#include "propagation/diffraction/edges.h"
#include "propagation/p528/p528.h"
#include "propagation/registry/model_info.h"
#include "tests/emfield/excess_paths.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using namespace propagation;
using ::testing::FloatNear;
using ::testing::HasSubstr;
using ::testing::Pointwise;

/// The paths of a lone emitter at 52 degrees north.
PathInputs pathsOf(const scenario::Scenario& scenario, double station_msl_m, const PathExtent& extent) {
  PathInputs inputs;
  inputs.emitter = emitterInputs(scenario, scenario.emitters[0]);
  inputs.site = {52, 0, station_msl_m, 6371e3, 6371e3 * scenario.atmosphere.k_factor};
  inputs.extent = extent;
  return inputs;
}

AirLoss airOf(const scenario::Scenario& scenario, double station_msl_m, const PathExtent& extent,
              std::vector<float>& table) {
  const PathInputs inputs = pathsOf(scenario, station_msl_m, extent);
  return airLoss(inputs, hasGases(inputs.emitter), table);
}

/// An emitter's excess loss, column by column.
class Columns {
 public:
  Columns(const scenario::Scenario& scenario, double tx_msl_m, const PathExtent& extent, double step_m = 45)
      : station_(makeStation({44.43, -71.47, 0}, tx_msl_m, scenario.atmosphere.k_factor)) {
    PathInputs inputs = pathInputs(scenario, scenario.emitters[0], {}, station_, nullptr, extent);
    inputs.post_spacing_m = step_m;
    excess_ = planExcess(inputs);
  }

  std::vector<float> fill(const ProfileData& profile, const std::vector<float>& heights_msl_m) const {
    return filled(profile, heights_msl_m, [](const auto& model, const auto&... of) { return model(of...); });
  }
  /// The same in parts, highest first, for models with parts.
  std::vector<float> fillInParts(const ProfileData& profile, const std::vector<float>& heights_msl_m) const {
    return filled(
        profile, heights_msl_m,
        [](const auto& model, const ExcessColumn& column, const ExcessScratch& scratch, float* losses) {
          unsigned all = 0;
          if constexpr (std::decay_t<decltype(model)>::kInParts) {
            all |= model.begin(column, scratch, losses);
            float memory_db[kBisectionStep + 1];
            for (int end = column.count; end > 0;) {
              const int begin = (end - 1) / kBisectionStep * kBisectionStep;
              all |= model.fill(column, scratch, {begin, end, memory_db}, losses);
              end = begin;
            }
          }
          return all;
        });
  }
  const EmitterExcess& excess() const { return excess_; }

  mutable unsigned warnings = 0;

 private:
  /// @param fill  (model, column, scratch, losses) -> warnings
  template <class Fill>
  std::vector<float> filled(const ProfileData& profile, const std::vector<float>& heights_msl_m,
                            const Fill& fill) const {
    const int posts = static_cast<int>(profile.range_m.size()),
              count = static_cast<int>(heights_msl_m.size());
    std::vector<double> memory(ExcessScratch::bytes(posts + 1, count) / sizeof(double) + 1);
    const ExcessScratch scratch = ExcessScratch::in(memory.data(), posts + 1, count);
    ExcessColumn column;
    column.range_m = profile.range_m.back();
    column.ground_msl_m = profile.height_msl_m.back();
    column.profile = profile.view();
    column.height_msl_m = heights_msl_m.data();
    column.count = count;
    std::vector<float> losses(heights_msl_m.size());
    std::visit([&](const auto& model) { warnings |= fill(model, column, scratch, losses.data()); },
               excess_.model);
    return losses;
  }

  Station station_;
  EmitterExcess excess_;
};

std::vector<float> heightsFrom(float lowest_m, float step_m, int count) {
  std::vector<float> heights;
  for (int k = 0; k < count; ++k) heights.push_back(lowest_m + step_m * static_cast<float>(k));
  return heights;
}

/// Columns of 100 heights at once against each height by itself, on random profiles.
Spread bisectionErrors(const scenario::Scenario& scenario, const scenario::Terrain& terrain, int profiles) {
  std::mt19937 random(11);
  Spread spread;
  for (int p = 0; p < profiles; ++p) {
    const ProfileData profile = randomProfile(terrain, random, 250);
    const Columns columns(scenario, static_cast<double>(profile.height_msl_m.front()) + 15, {60e3, 0, 6000});
    const std::vector<float> heights = heightsFrom(profile.height_msl_m.back() + 20, 40, 100);
    const std::vector<float> losses = columns.fill(profile, heights);
    for (std::size_t k = 0; k < heights.size(); k += 3) {
      spread.add(static_cast<double>(losses[k] - columns.fill(profile, {heights[k]})[0]));
    }
  }
  return spread;
}

TEST(ExcessModels, HeightsBetweenEvaluationsOfEdgesAreWithinATenthOfADecibel) {
  const scenario::TerrainPtr terrain = whiteMountainsTile();
  const auto scenario = whiteMountains(1e9, 15);
  for (const auto method :
       {propagation::DiffractionMethod::single_edge, propagation::DiffractionMethod::deygout}) {
    scenario->emitters[0].propagation.diffraction.method = method;
    Spread spread = bisectionErrors(*scenario, *terrain, 60);
    EXPECT_LT(spread.quantile(0.99), 0.1) << toString(method);
    EXPECT_LT(spread.largest(), 0.5) << toString(method);
  }
}

TEST(ExcessModels, HeightsBetweenEvaluationsOfItmAreWithinATenthOfADecibelButForItsJumps) {
  const scenario::TerrainPtr terrain = whiteMountainsTile();
  const auto scenario = whiteMountains(1e9, 15);
  scenario->emitters[0].propagation.model = PropagationModel::itm;
  Spread spread = bisectionErrors(*scenario, *terrain, 60);
  EXPECT_LT(spread.quantile(0.99), 0.1);
  EXPECT_LT(spread.largest(), 1);
}

TEST(ExcessModels, HeightsBetweenEvaluationsOfP1812AndP452AreWithinATenthOfADecibel) {
  const scenario::TerrainPtr terrain = whiteMountainsTile();
  const auto scenario = whiteMountains(1e9, 15);
  scenario::Emitter& emitter = scenario->emitters[0];
  for (const double time_percent : {1.0, 50.0}) {
    emitter.propagation.p1812.time_percent = emitter.propagation.p452.time_percent = time_percent;
    for (const auto model : {PropagationModel::p1812, PropagationModel::p452}) {
      emitter.propagation.model = model;
      Spread spread = bisectionErrors(*scenario, *terrain, 60);
      EXPECT_LT(spread.quantile(0.99), 0.1) << toString(model) << ", " << time_percent << " %";
      EXPECT_LT(spread.largest(), 1) << toString(model) << ", " << time_percent << " %";
    }
  }
}

// Whole columns of p1812 and p452 are computed by vector instructions, parts post by post.
TEST(ExcessModels, ColumnInPartsEqualsWholeColumn) {
  std::mt19937 random(12);
  const auto scenario = whiteMountains(4e8, 15);
  scenario::Emitter& emitter = scenario->emitters[0];
  for (const auto propagation :
       {PropagationModel::diffraction, PropagationModel::p1812, PropagationModel::p452}) {
    emitter.propagation.model = propagation;
    emitter.propagation.diffraction.method = propagation::DiffractionMethod::deygout;
    for (int p = 0; p < 20; ++p) {
      const ProfileData profile = madeUpProfile(random, 200, 30e3, 600);
      const Columns whole(*scenario, static_cast<double>(profile.height_msl_m.front()) + 15, {60e3, 0, 6000});
      const Columns parts = whole;
      for (const int count : {1, 16, 17, 32, 33, 100}) {
        const std::vector<float> heights = heightsFrom(profile.height_msl_m.back() + 20, 45, count);
        EXPECT_THAT(whole.fill(profile, heights),
                    Pointwise(FloatNear(1e-3f), parts.fillInParts(profile, heights)));
      }
      EXPECT_EQ(whole.warnings, parts.warnings);
    }
  }
}

TEST(ExcessModels, EdgesInTheFieldAgreeWithTheModelPathByPath) {
  const scenario::TerrainPtr terrain = whiteMountainsTile();
  const auto scenario = whiteMountains(1e9, 15);
  DiffractionParameters parameters;
  parameters.frequency_hz = 1e9;
  parameters.effective_earth_radius_m = kEffectiveEarth_m;
  const auto model = diffractionModel<double>(parameters);
  for (const auto method :
       {propagation::DiffractionMethod::single_edge, propagation::DiffractionMethod::deygout}) {
    scenario->emitters[0].propagation.diffraction.method = method;
    const auto volume = solve(scenario, terrain);
    const scenario::EmitterState state = scenario::snapshotAt(scenario, terrain.get(), 0).emitters[0];
    const GeoFrame geo(volume->grid.frame);
    std::mt19937 random(9);
    Spread spread;
    while (spread.size() < 300) {
      const int i = int(random() % 50), j = int(random() % 50), k = int(random() % 40);
      const Vec3d center = volume->grid.center_m(i, j, k);
      const GeodeticPosition to = geo.toGeodetic(center);
      if (center.z < terrain->heightMsl_m(to.latitude_deg, to.longitude_deg) + 1) continue;
      const ProfileData profile = profileTo(*terrain, state.position, to, false);
      const double expected = method == propagation::DiffractionMethod::deygout
                                  ? deygoutLossDb(model, profile.view(), state.height_msl_m, center.z)
                                  : singleEdgeLossDb(model, profile.view(), state.height_msl_m, center.z);
      spread.add(excessIn(*volume, i, j, k, state.position) - expected);
    }
    EXPECT_LT(spread.quantile(0.9), 0.1) << toString(method);
    EXPECT_LT(spread.quantile(0.98), 0.5) << toString(method);
  }
}

TEST(ExcessModels, ItmNearGroundBlendsIntoDiffractionAbove) {
  const scenario::TerrainPtr terrain = whiteMountainsTile();
  const auto scenario = whiteMountains(300e6, 15);
  std::mt19937 random(5);
  const ProfileData profile = randomProfile(*terrain, random, 250);
  const double tx_msl_m = static_cast<double>(profile.height_msl_m.front()) + 15;
  const float ground_m = profile.height_msl_m.back();
  const PathExtent extent{60e3, 0, 6000};
  const Columns diffraction(*scenario, tx_msl_m, extent);
  scenario->emitters[0].propagation.model = PropagationModel::itm;
  const double step_m = profile.range_m.back() / 249 * 1.0001;
  const Columns itm(*scenario, tx_msl_m, extent, step_m);

  ItmProfile<float> even{profile.height_msl_m.data(), 249, profile.range_m.back() / 249};
  ItmLink<double> link;
  link.frequency_hz = 300e6;
  link.height_agl_m[0] = 15;
  for (const float above_m : {2.0f, 30.0f, 500.0f, 1900.0f}) {
    link.height_agl_m[1] = static_cast<double>(above_m);
    const ItmResult<double> expected = itmPointToPoint(even, link, ItmQuantiles<double>{});
    EXPECT_NEAR(itm.fill(profile, {ground_m + above_m})[0], expected.loss_db - expected.free_space_db, 0.05)
        << above_m;
  }
  for (const float above_m : {3000.0f, 5000.0f}) {
    EXPECT_EQ(itm.fill(profile, {ground_m + above_m}), diffraction.fill(profile, {ground_m + above_m}));
  }
  const float at_2500 = itm.fill(profile, {ground_m + 2500})[0];
  link.height_agl_m[1] = 2500;
  const ItmResult<double> pure = itmPointToPoint(even, link, ItmQuantiles<double>{});
  EXPECT_NEAR(at_2500,
              (pure.loss_db - pure.free_space_db +
               static_cast<double>(diffraction.fill(profile, {ground_m + 2500})[0])) /
                  2,
              0.05)
      << "half and half";
  EXPECT_NEAR(itm.fill(profile, {ground_m + 2999.9f})[0], itm.fill(profile, {ground_m + 3000.1f})[0], 0.02);
}

TEST(ExcessModels, ItmQuantilesAndAreaFormReachTheField) {
  const auto scenario = smoothEarth(PropagationModel::itm, 300e6, 20);
  const auto median = solve(scenario)->values;
  scenario->emitters[0].propagation.itm.time_percent = 99;
  const auto rare = solve(scenario)->values;
  scenario->emitters[0].propagation.itm.time_percent = 50;
  scenario->emitters[0].propagation.itm.form = propagation::ItmForm::area;
  scenario->emitters[0].propagation.itm.irregularity_m = 200;
  const auto hilly = solve(scenario)->values;
  const std::size_t corner = 0;
  EXPECT_GT(median[corner], rare[corner] + 1);
  EXPECT_GT(median[corner], hilly[corner] + 1);
}

TEST(ExcessModels, TwoRayInTheFieldEqualsModelAtEveryVoxel) {
  for (const auto polarization : {propagation::Polarization::horizontal, propagation::Polarization::vertical,
                                  propagation::Polarization::slant_45}) {
    for (const double frequency_hz : {100e6, 3e9}) {
      const auto scenario = smoothEarth(PropagationModel::two_ray, frequency_hz, 30, 200e3);
      scenario->emitters[0].polarization = polarization;
      scenario->ground.kind = propagation::GroundKind::sea;
      scenario->ground.roughness_m = 0.2;
      const auto volume = solve(scenario);
      const GeodeticPosition from = scenario::snapshotAt(scenario, nullptr, 0).emitters[0].position;
      TwoRayParameters parameters;
      parameters.frequency_hz = frequency_hz;
      parameters.effective_earth_radius_m = makeStation(from, 30, 4.0 / 3).effective_earth_radius_m;
      parameters.ground = groundConstants(GroundKind::sea, frequency_hz);
      parameters.roughness_m = 0.2;
      const auto excessOf = [&](LinearPolarization of, double range_m, double height_m) {
        parameters.polarization = of;
        return twoRayExcessDb(twoRayModel<double>(parameters), range_m, 30.0, height_m);
      };
      for (int i = 0; i < 20; i += 3) {
        for (int k = 0; k < 32; k += 3) {
          const Vec3d center = volume->grid.center_m(i, 4, k);
          const double range_m = std::hypot(center.x, center.y);
          const double h = excessOf(LinearPolarization::horizontal, range_m, center.z);
          const double v = excessOf(LinearPolarization::vertical, range_m, center.z);
          const double expected = polarization == propagation::Polarization::horizontal ? h
                                  : polarization == propagation::Polarization::vertical
                                      ? v
                                      : -ratioToDb((dbToRatio(-h) + dbToRatio(-v)) / 2);
          // In nulls tiny differences of path length have a large effect.
          EXPECT_NEAR(excessIn(*volume, i, 4, k, from), expected, 0.05 + 0.05 * std::max(0.0, expected));
        }
      }
    }
  }
}

TEST(ExcessModels, TwoRayLobesLieWhereFlatGroundPutsThem) {
  // lambda d / (4 h1): first lobe at 125 m and first null at 250 m, 10 km from an antenna 20 m over the sea
  const double frequency_hz = kSpeedOfLight;
  auto scenario = smoothEarth(PropagationModel::two_ray, frequency_hz, 20);
  scenario->region.size_m = {20e3, 400, 375};
  scenario->region.dims = {2, 2, 3};
  scenario->region.origin.longitude_deg = 5 + radToDeg(15e3 / (6378137.0 * std::cos(degToRad(52.0))));
  scenario->emitters[0].polarization = propagation::Polarization::horizontal;
  scenario->ground.kind = propagation::GroundKind::sea;
  const auto volume = solve(scenario);
  const GeodeticPosition from = scenario::snapshotAt(scenario, nullptr, 0).emitters[0].position;
  // layers at 62.5, 187.5 and 312.5 m: half way up the lobe, half way down, half way up the next
  EXPECT_NEAR(volume->grid.center_m(0, 0, 1).z, 187.5, 1e-3);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(excessIn(*volume, 0, 0, k, from), -3.0, 0.8) << k;

  scenario->region.size_m.z = 250;
  scenario->region.dims.z = 2;
  scenario->region.origin.height_msl_m =
      62.5 + 4;  // the earth falls away by 4 m between reflection and target
  const auto shifted = solve(scenario);
  EXPECT_LT(excessIn(*shifted, 0, 0, 0, from), -5.5) << "lobe";
  EXPECT_GT(excessIn(*shifted, 0, 0, 1, from), 10) << "null";
  scenario->emitters[0].propagation.two_ray.sum = propagation::TwoRaySum::envelope;
  EXPECT_LT(excessIn(*solve(scenario), 0, 0, 1, from), -5.5) << "the lobes' tops";
}

TEST(ExcessModels, GasesAttenuateLevelPathPerKilometre) {
  for (const double frequency_hz : {10e9, 22.235e9, 60e9}) {
    auto scenario = smoothEarth(PropagationModel::free_space, frequency_hz, 5, 4000);
    scenario->atmosphere.gases = propagation::GasLosses::always;
    scenario->region.size_m.z = 20;
    scenario->region.dims.z = 2;
    const auto volume = solve(scenario);
    const GeodeticPosition from = scenario::snapshotAt(scenario, nullptr, 0).emitters[0].position;
    const double per_km = gasAttenuation(frequency_hz, standardAtmosphere(5)).total_db_per_km();
    for (int i = 0; i < 20; i += 4) {
      const Vec3d center = volume->grid.center_m(i, 3, 0);
      const double length_km = std::hypot(center.x, center.y) / 1000;
      EXPECT_NEAR(excessIn(*volume, i, 3, 0, from), per_km * length_km, 0.006 + 1e-3 * per_km * length_km);
    }
    scenario->atmosphere.gases = propagation::GasLosses::automatic;
    EXPECT_NEAR(excessIn(*solve(scenario), 0, 3, 0, from), 0, 1e-3) << "free space alone stays that";
  }
}

TEST(ExcessModels, GasesBetweenTableNodesEqualRay) {
  auto scenario = smoothEarth(PropagationModel::free_space, 60e9, 0);
  scenario->atmosphere.gases = propagation::GasLosses::always;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(0, 1);
  Spread spread;
  for (const double tx_m : {10.0, 3000.0, 12000.0}) {
    for (const double frequency_hz : {22.235e9, 60e9}) {
      scenario->emitters[0].frequency_hz = frequency_hz;
      std::vector<float> table;
      const AirLoss air = airOf(*scenario, tx_m, {300e3, 0, 20e3}, table);
      for (int n = 0; n < 100; ++n) {
        const double range_m = 300e3 * part(random), height_m = 20e3 * part(random);
        double mean_db_per_m = 0;
        constexpr int kSteps = 4000;
        for (int s = 0; s < kSteps; ++s) {
          const double t = (s + 0.5) / kSteps;
          const double at_m =
              tx_m + t * (height_m - tx_m) - t * (1 - t) * range_m * range_m / (2 * kEffectiveEarth_m);
          const AirState state = standardAtmosphere(std::max(at_m, -1000.0));
          // 20 m apart the air is the same: keeps the test fast
          static std::map<std::pair<double, int>, double> known;
          double& gamma = known[{frequency_hz, static_cast<int>(std::lround(at_m / 20))}];
          if (gamma == 0) gamma = gasAttenuation(frequency_hz, state).total_db_per_km() / 1000;
          mean_db_per_m += gamma / kSteps;
        }
        const double expected =
            mean_db_per_m * static_cast<double>(AirColumn(air, float(range_m)).slantRange_m(float(height_m)));
        spread.add((static_cast<double>(air.lossDb(float(range_m), float(height_m))) - expected) /
                   std::max(expected, 0.5));
      }
    }
  }
  EXPECT_LT(spread.largest(), 0.005);
}

TEST(ExcessModels, RainIsBelowItsTopOnly) {
  auto scenario = smoothEarth(PropagationModel::free_space, 10e9, 0);
  scenario->atmosphere.rain_mm_h = 30;
  scenario->emitters[0].polarization = propagation::Polarization::horizontal;
  std::vector<float> none;
  const auto airAt = [&](double station_m) { return airOf(*scenario, station_m, {200e3, 0, 12e3}, none); };
  const double top_m = rainHeight_m(52);
  EXPECT_NEAR(top_m, 2825, 1e-9);
  EXPECT_EQ(rainHeight_m(10), 5000);
  EXPECT_EQ(rainHeight_m(-31), 4000);
  const double per_m = rainCoefficients(10e9, 0, 0).specificAttenuation_db_per_km(30.0) / 1000;

  std::mt19937 random(4);
  std::uniform_real_distribution<float> part(0, 1);
  for (const float station_m : {10.0f, 2000.0f, 6000.0f}) {
    const AirLoss air = airAt(static_cast<double>(station_m));
    EXPECT_NEAR(static_cast<double>(air.lossDb(10e3f, station_m)), station_m < 2825 ? per_m * 10e3 : 0.0,
                0.01 * per_m * 10e3 + 1e-6);
    for (int n = 0; n < 200; ++n) {
      const float range_m = 200e3f * part(random), height_m = 12e3f * part(random);
      int below = 0;
      constexpr int kSteps = 20000;
      for (int s = 0; s < kSteps; ++s) {
        const double t = (s + 0.5) / kSteps;
        const double at_m = static_cast<double>(station_m) + t * static_cast<double>(height_m - station_m) -
                            t * (1 - t) * static_cast<double>(range_m) * static_cast<double>(range_m) /
                                (2 * kEffectiveEarth_m);
        below += at_m < top_m ? 1 : 0;
      }
      EXPECT_NEAR(air.partBelowRainTop(range_m, height_m), static_cast<double>(below) / kSteps, 2e-3)
          << station_m << " " << range_m << " " << height_m;
    }
  }
  EXPECT_NEAR(airAt(0).partBelowRainTop(0, 5650), 0.5f, 1e-4) << "straight up";
}

/// Excess (dB) of a table of p528 minus that of the curve itself.
double p528TableError_db(const P528Excess& table, const std::shared_ptr<const P528Atmosphere>& atmosphere,
                         const scenario::Emitter& emitter, double tx_m, double range_m, float height_m) {
  const P528Loss loss = P528Curve(atmosphere, emitter.frequency_hz, tx_m, static_cast<double>(height_m), true)
                            .at(range_m, emitter.propagation.p528.time_percent);
  ExcessColumn column;
  column.range_m = range_m;
  column.height_msl_m = &height_m;
  column.count = 1;
  float excess = 0;
  table(column, {}, &excess);
  return static_cast<double>(excess) - (loss.loss_db - loss.free_space_db);
}

TEST(ExcessModels, SLOW_P528BetweenTableNodesEqualsCurve) {
  auto scenario = smoothEarth(PropagationModel::p528, 1.2e9, 20);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> part(0, 1);
  for (const double frequency_hz : {1.2e9, 9.4e9}) {
    for (const double percent : {50.0, 95.0}) {
      for (const double tx_m : {15.0, 3000.0}) {
        SCOPED_TRACE(::testing::Message() << frequency_hz << " Hz, " << percent << " %, " << tx_m << " m");
        scenario->emitters[0].frequency_hz = frequency_hz;
        scenario->emitters[0].propagation.p528.time_percent = percent;
        std::vector<float> tables;
        const P528Excess table = p528Excess(pathsOf(*scenario, tx_m, {400e3, 100, 12000}), tables);
        const auto atmosphere = std::make_shared<const P528Atmosphere>(frequency_hz);
        Spread spread;
        for (int n = 0; n < 100; ++n) {
          const double range_m = 400e3 * part(random);
          const auto height_m = static_cast<float>(100 + 11900 * part(random));
          spread.add(p528TableError_db(table, atmosphere, scenario->emitters[0], tx_m, range_m, height_m));
        }
        EXPECT_LT(spread.median(), 0.01);
        EXPECT_LT(spread.quantile(0.95), 0.2);
        // Between two aircraft the model itself steps at the horizon.
        EXPECT_LT(spread.largest(), tx_m < 100 ? 0.5 : 5);
      }
    }
  }
}

TEST(ExcessModels, SLOW_P528OfSteepRaysBetweenTableNodesEqualsCurve) {
  auto scenario = smoothEarth(PropagationModel::p528, 3e9, 20);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(0, 1);
  for (const double frequency_hz : {300e6, 15e9}) {
    for (const double percent : {1.0, 95.0, 99.0}) {
      for (const double tx_m : {15.0, 300.0, 3000.0, 8000.0}) {
        SCOPED_TRACE(::testing::Message() << frequency_hz << " Hz, " << percent << " %, " << tx_m << " m");
        scenario->emitters[0].frequency_hz = frequency_hz;
        scenario->emitters[0].propagation.p528.time_percent = percent;
        std::vector<float> tables;
        const P528Excess table = p528Excess(pathsOf(*scenario, tx_m, {50e3, 100, 12000}), tables);
        const auto atmosphere = std::make_shared<const P528Atmosphere>(frequency_hz);
        Spread spread;
        for (int n = 0; n < 60; ++n) {
          const auto height_m = static_cast<float>(100 + 11900 * std::pow(part(random), 2));
          // of the reflected ray; the reflection of vertical waves is least at 14 degrees
          const double grazing_rad = degToRad(n == 0 ? 90 : 6 + 84 * part(random));
          const double range_m =
              n == 0 ? 0.0 : (tx_m + static_cast<double>(height_m)) / std::tan(grazing_rad);
          // Between two aircraft the model itself has a narrow minimum for level rays.
          if (std::fabs(static_cast<double>(height_m) - tx_m) < 0.05 * range_m) continue;
          spread.add(p528TableError_db(table, atmosphere, scenario->emitters[0], tx_m, range_m, height_m));
        }
        EXPECT_LT(spread.median(), 0.02);
        EXPECT_LT(spread.quantile(0.95), 0.1);
        EXPECT_LT(spread.largest(), 0.5);
      }
    }
  }
}

TEST(ExcessModels, TheScenarioOfEachModelIsComputed) {
  const std::filesystem::path folder = test::shippedScenario("models");
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path().filename());
    const auto loaded = scenario::loadScenario(entry.path().string());
    const scenario::TerrainPtr terrain = scenario::loadTerrain(*loaded);
    SolvedField solver(loaded, terrain);
    EXPECT_GT(solver.volumes().front().host()->info.range_max, -60);
    EXPECT_LT(solver.volumes().front().host()->info.range_min, -70);
    ++count;
  }
  EXPECT_EQ(count, 11);
}

TEST(ExcessModels, LimitsOfTableAreReportedWithLocation) {
  auto scenario = smoothEarth(PropagationModel::p528, 50e6, 20);
  scenario->emitters[0].frequency_location = {"my.yaml", 12, 7};
  const auto messageOf = [&] {
    const Error error = test::thrownBy([&] { FieldSolver solver(scenario, nullptr, {}); });
    return toString(error.location()) + ": " + error.message();
  };
  EXPECT_EQ(messageOf(),
            "my.yaml:12:7: emitter 'site': 'p528': frequency 50 MHz is outside 100..30000 MHz: refused");
  scenario->emitters[0].frequency_hz = 1e9;
  scenario->emitters[0].propagation.p528.time_percent = 0.5;
  scenario->emitters[0].propagation.location = {"my.yaml", 20, 3};
  EXPECT_EQ(messageOf(),
            "my.yaml:20:3: emitter 'site': 'p528': percentage of time 0.5 % is outside 1..99 %: refused");
  scenario->emitters[0].propagation.model = PropagationModel::itm;
  scenario->emitters[0].frequency_hz = 35e9;
  EXPECT_EQ(messageOf(),
            "my.yaml:12:7: emitter 'site': 'itm': frequency 35000 MHz is outside 20..20000 MHz: refused");
  scenario->emitters[0].frequency_hz = 1e9;
  scenario->ground.conductivity_s_m = 0;
  scenario->ground.location = {"my.yaml", 5, 9};
  EXPECT_THAT(messageOf(), HasSubstr("my.yaml:5:9: emitter 'site': 'itm': "));

  scenario->emitters[0].propagation.model = PropagationModel::diffraction;
  scenario->emitters[0].frequency_hz = 10e6;
  EXPECT_THAT(
      checkModels(*scenario),
      ::testing::ElementsAre("emitter 'site': 'diffraction': frequency 10 MHz is outside 20..50000 MHz: "
                             "computed, with a warning"));
}

TEST(ExcessModels, RainBelowItsFrequenciesIsNegligibleAndNotWarnedOf) {
  static_assert(propagation::kRainFrequency.beyond == propagation::Beyond::clamped_quietly);
  const auto scenario = smoothEarth(PropagationModel::free_space, 300e6, 20);
  scenario->atmosphere.rain_mm_h = 50;
  EXPECT_THAT(checkModels(*scenario), ::testing::IsEmpty());
}

TEST(ExcessModels, HeightsOutsideAModelWarnOnce) {
  auto scenario = smoothEarth(PropagationModel::p528, 1e9, 20);
  scenario->region.size_m.z = 30e3;
  SolvedField solver(scenario);
  EXPECT_THAT(solver.warnings(),
              ::testing::ElementsAre(HasSubstr("29531.2 m is outside 1.5..20000 m: taken as the nearest")));
}

}  // namespace
}  // namespace emscape::emfield
