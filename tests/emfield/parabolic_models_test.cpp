// The model parabolic_equation beside other models: two rays, diffraction, free space, and which one is
// dominant where.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "emscape/emfield/link/path_budget.h"
#include "scenario/antenna/shapes.h"
#include "tests/emfield/parabolic_samples.h"
#include "volume/labels.h"

namespace emscape::emfield {
namespace {

using propagation::PropagationModel;
using namespace testing;

// Lobes that the voxels resolve.
TEST(ParabolicField, IsTwoRayInsideTheHorizonOverTheSea) {
  const auto scenario = around(1e9, 30, {20e3, 300, 200}, {400, 3, 80});
  scenario->ground.kind = propagation::GroundKind::sea;
  const auto volume = solve(scenario);
  scenario->emitters[0].propagation.model = PropagationModel::two_ray;
  const auto expected = solve(scenario);
  std::vector<double> differences;
  for (int i = 0; i < 400; ++i) {
    if (std::abs(i - 199.5) * 50 < 4000) continue;
    for (int k = 0; k < 80; ++k) {
      const double expected_db = static_cast<double>(testing::valueAt(*expected, i, 1, k));
      differences.push_back(std::abs(static_cast<double>(testing::valueAt(*volume, i, 1, k)) - expected_db));
    }
  }
  EXPECT_LT(quantileOf(differences, 0.5), 0.2);
  EXPECT_LT(quantileOf(differences, 0.8), 1.0);  // the rest are nulls, which the cells fill
}

/// Differences (dB) from two rays weighed by the antenna, where those are not in a null.
std::vector<double> differencesFromWeighedRays(const std::shared_ptr<scenario::Scenario>& scenario) {
  scenario->emitters[0].propagation.model = PropagationModel::two_ray;
  const auto expected = solve(scenario);
  scenario->emitters[0].propagation.model = PropagationModel::parabolic_equation;
  const auto volume = solve(scenario);
  std::vector<double> differences;
  for (int i = 140; i < 200; ++i) {  // 4 km and more to the east
    for (int k = 0; k < 80; ++k) {
      differences.push_back(std::abs(
          static_cast<double>(testing::valueAt(*volume, i, 1, k) - testing::valueAt(*expected, i, 1, k))));
    }
  }
  return differences;
}

TEST(ParabolicField, PatternWeightsBothRaysByTheirAngles) {
  const auto scenario = around(1e9, 30, {20e3, 300, 200}, {200, 3, 80});
  scenario->ground.kind = propagation::GroundKind::sea;
  scenario::Emitter& emitter = scenario->emitters[0];
  const auto aim = [&](double width_deg, double tilt_deg, propagation::PeRadiator source) {
    emitter.antenna = scenario::makeGaussian(20, 30, width_deg, -40);
    emitter.scan.azimuth_deg = 90;
    emitter.scan.elevation_deg = tilt_deg;
    emitter.propagation.parabolic_equation.source = source;
  };
  using propagation::PeRadiator;
  for (const double tilt_deg : {1.0, -0.5}) {
    SCOPED_TRACE(tilt_deg);
    aim(2, tilt_deg, PeRadiator::pattern);
    const std::vector<double> differences = differencesFromWeighedRays(scenario);
    EXPECT_LT(quantileOf(differences, 0.5), 0.2);
    EXPECT_LT(quantileOf(differences, 0.8), 1.0);
  }
  aim(2, 1, PeRadiator::isotropic);
  EXPECT_GT(quantileOf(differencesFromWeighedRays(scenario), 0.5), 2.0) << "lobes and nulls";

  // A pattern that is wide for the equation's angles changes nothing.
  aim(60, 0, PeRadiator::pattern);
  const auto weighed = solve(scenario);
  aim(60, 0, PeRadiator::isotropic);
  const auto isotropic = solve(scenario);
  std::vector<double> differences;
  for (std::size_t v = 0; v < weighed->values.size(); ++v)
    differences.push_back(std::abs(static_cast<double>(weighed->values[v] - isotropic->values[v])));
  EXPECT_LT(quantileOf(differences, 0.99), 0.1);
}

/// Differences (dB) between the equation and two rays where they are blended, by the angle and by the range,
/// over a smooth earth.
struct Seam {
  std::vector<double> all, outside_nulls;
  double largest_step_db = 0;  ///< by the blend alone, from a voxel to the one above or below
};

Seam seamOf(double frequency_hz, double height_m) {
  const auto scenario = around(frequency_hz, height_m, {12e3, 300, 800}, {240, 3, 160});
  const Made made(*scenario, nullptr);
  const Marched marched(made);
  const propagation::PeExcess& excess = marched.excess;
  Seam seam;
  for (double range_m = 1.5 * made.plan.min_range_m; range_m < 6e3; range_m += 13) {
    propagation::ExcessColumn column;
    column.range_m = range_m;
    for (float at_m = 22.5F; at_m < 700; at_m += 5) {
      const propagation::PeLoss loss = excess.equationAt(column, excess.azimuthsAt(column.azimuth_rad), at_m,
                                                         0, [](float) { return 0.0F; });
      if (loss.equation_part <= 0 || loss.equation_part >= 1) continue;
      column.height_msl_m = &at_m;
      column.count = 1;
      float other_db = 0;
      excess.others.fill(column, {}, &other_db);
      seam.all.push_back(static_cast<double>(std::abs(loss.equation_db - other_db)));
      for (const float beside_m : {at_m - 5, at_m + 5}) {
        const float beside = excess.others.equationPart(static_cast<float>(range_m), beside_m, 0, 0);
        seam.largest_step_db =
            std::max(seam.largest_step_db, std::abs(double(beside - loss.equation_part)) * seam.all.back());
      }
      if (other_db < 3) seam.outside_nulls.push_back(seam.all.back());
    }
  }
  return seam;
}

TEST(ParabolicField, HasNoSeamOverASmoothEarth) {
  const struct {
    double frequency_hz, height_m;
  } kAntennas[] = {{3e8, 30}, {1e9, 30}, {1e9, 100}, {3e9, 15}, {3e9, 60}, {1e10, 10}};
  for (const auto& antenna : kAntennas) {
    const std::string what = fmt::format("{:g} MHz, {:g} m", antenna.frequency_hz / 1e6, antenna.height_m);
    SCOPED_TRACE(what);
    const Seam seam = seamOf(antenna.frequency_hz, antenna.height_m);
    ASSERT_GT(seam.outside_nulls.size(), 1900u);
    recordDifferences(what, seam.all);
    recordDifferences(what + ", outside nulls", seam.outside_nulls);
    EXPECT_LT(quantileOf(seam.all, 0.5), 0.2);
    EXPECT_LT(quantileOf(seam.all, 0.95), 0.5) << quantileOf(seam.all, 0.95);
    EXPECT_LT(quantileOf(seam.all, 1), 1.2) << quantileOf(seam.all, 1);
    recordDifferences(what + ", step", {seam.largest_step_db});
    EXPECT_LT(seam.largest_step_db, 0.5);
  }
}

// The places' exact paths, which are not averaged, against voxels that are smaller than lobes.
TEST(ParabolicField, EqualsExplainedPathOverSmoothEarth) {
  const auto scenario = around(1e9, 50, {120e3, 300, 300}, {400, 3, 60});
  const auto volume = solve(scenario);
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, nullptr, 0);
  const GeoFrame frame(volume->grid.frame);
  for (int i : {10, 60, 110, 160}) {
    for (int k : {4, 30, 55}) {
      const GeodeticPosition position = frame.toGeodetic(volume->grid.center_m(i, 1, k));
      const PathEnd end{position, volume->grid.center_m(i, 1, k).z};
      const PathBudget budget = pathBudget(snapshot, 0, end, PropagationModel::parabolic_equation, nullptr);
      if (budget.excess.loss_db > 10) continue;  // nulls
      EXPECT_NEAR(budget.find("power_density_dbwm2")->value,
                  static_cast<double>(testing::valueAt(*volume, i, 1, k)), 0.7)
          << i << ", " << k << ": " << budget.excess.why;
    }
  }
}

// The loss is the same from a low antenna to a high place and back.
TEST(ParabolicField, IsReciprocalOverASmoothEarth) {
  const auto low = around(3e8, 12.5, {80e3, 300, 300}, {160, 3, 60});
  const auto high = around(3e8, 202.5, {80e3, 300, 300}, {160, 3, 60});
  const auto upwards = solve(low), downwards = solve(high);
  for (int i : {4, 20, 50}) {
    const double up = static_cast<double>(testing::valueAt(*upwards, i, 1, 40));
    EXPECT_NEAR(up, static_cast<double>(testing::valueAt(*downwards, i, 1, 2)), 0.3) << i;
  }
}

/// Differences (dB) from diffraction where the equation speaks.
struct OverDiffraction {
  std::vector<double> in_sight_db, in_shadow_db;  ///< in shadow: 10 dB and more below free space
};

OverDiffraction overDiffraction(const std::shared_ptr<scenario::Scenario>& scenario,
                                const scenario::TerrainPtr& terrain) {
  const auto power = solve(scenario, terrain);
  scenario->output.quantities = {"dominant_model"};
  const auto model = solve(scenario, terrain);
  const Made made(*scenario, terrain.get());
  scenario->output.quantities = {"power_density_dbwm2"};
  scenario->emitters[0].propagation.model = PropagationModel::diffraction;
  const auto other = solve(scenario, terrain);
  OverDiffraction differences;
  const Dims dims = power->grid.dims;
  for (int k = 0; k < dims.z; ++k) {
    for (int j = 0; j < dims.y; ++j) {
      for (int i = 0; i < dims.x; ++i) {
        const auto column = static_cast<std::size_t>(j * dims.x + i);
        if (k < made.columns.first_valid_k[column] ||
            testing::valueAt(*model, i, j, k) !=
                static_cast<float>(propagation::Mechanism::parabolic_equation))
          continue;
        const bool is_shadow = excessIn(*other, made, i, j, k) >= 10;
        (is_shadow ? differences.in_shadow_db : differences.in_sight_db)
            .push_back(
                static_cast<double>(testing::valueAt(*power, i, j, k) - testing::valueAt(*other, i, j, k)));
      }
    }
  }
  return differences;
}

TEST(ParabolicField, IsNearDiffractionOverHills) {
  const auto scenario = around(3e8, 180, {24e3, 24e3, 400}, {40, 40, 20}, 80);
  const OverDiffraction differences = overDiffraction(scenario, gentleHills());
  for (const double part : {0.1, 0.5, 0.9})
    RecordProperty("in_sight_" + std::to_string(part),
                   std::to_string(quantileOf(differences.in_sight_db, part)));
  ASSERT_GT(differences.in_sight_db.size(), 5000u);
  EXPECT_LT(std::abs(quantileOf(differences.in_sight_db, 0.5)), 6);
}

// Steep mountains of the SRTM: behind ridges the two models agree within some dB, and a march that does not
// see them is 20 dB and more above.
TEST(ParabolicField, IsNearDiffractionOverMountains) {
  const auto scenario = around(3e8, 0, {16e3, 16e3, 1600}, {24, 24, 16}, 500);
  const auto terrain = standOn("tests/data/dem/N44W072.tif", 44.26, -71.25, 30, *scenario);
  scenario->emitters[0].propagation.parabolic_equation.max_angle_deg = 10;
  const OverDiffraction differences = overDiffraction(scenario, terrain);
  for (const double part : {0.1, 0.5, 0.9}) {
    RecordProperty("in_sight_" + std::to_string(part),
                   std::to_string(quantileOf(differences.in_sight_db, part)));
    RecordProperty("in_shadow_" + std::to_string(part),
                   std::to_string(quantileOf(differences.in_shadow_db, part)));
  }
  ASSERT_GT(differences.in_shadow_db.size(), 500u);
  ASSERT_GT(differences.in_sight_db.size(), 500u);
  EXPECT_LT(std::abs(quantileOf(differences.in_sight_db, 0.5)), 3);
  EXPECT_LT(std::abs(quantileOf(differences.in_shadow_db, 0.5)), 6);
}

// A ridge at 4 degrees of elevation: a band of 3 degrees does not hold the rays over it.
TEST(ParabolicField, DiffractionUsedBehindSteepRidge) {
  constexpr double kMetresPerDegree = 70e3;  // eastwards; degrees count from the western side
  const auto terrain =
      std::make_shared<const MadeTerrain>(kLatitude_deg, kLongitude_deg, 1.0, [](double east, double) {
        return std::max(0.0, 450 - std::abs((east - 0.5) * kMetresPerDegree - 6000) * 0.18);
      });
  const auto scenario = around(3e8, 30, {24e3, 4e3, 500}, {80, 8, 10});
  scenario->emitters[0].propagation.model = PropagationModel::diffraction;
  const auto diffraction = solve(scenario, terrain);
  scenario->emitters[0].propagation.model = PropagationModel::parabolic_equation;
  scenario->emitters[0].propagation.parabolic_equation.max_angle_deg = 3;
  const auto volume = solve(scenario, terrain);
  for (int i = 66; i < 80; ++i) {  // from 8 km to 12 km, in the shadow
    for (int j = 0; j < 8;
         ++j)  // the equation's profiles have regular posts, those of `diffraction` crossings
      EXPECT_NEAR(testing::valueAt(*volume, i, j, 1), testing::valueAt(*diffraction, i, j, 1), 0.08);
  }
  scenario->emitters[0].propagation.parabolic_equation.max_angle_deg = 10;
  EXPECT_GT(std::abs(testing::valueAt(*solve(scenario, terrain), 70, 4, 1) -
                     testing::valueAt(*diffraction, 70, 4, 1)),
            1);  // the equation
}

// Marches toward that ridge end behind it, others at the region's border.
TEST(ParabolicField, MarchEndsAtSteepRidge) {
  constexpr double kMetresPerDegree = 70e3;
  const auto terrain =
      std::make_shared<const MadeTerrain>(kLatitude_deg, kLongitude_deg, 1.0, [](double east, double) {
        return std::max(0.0, 450 - std::abs((east - 0.5) * kMetresPerDegree - 6000) * 0.18);
      });
  const auto scenario = around(3e8, 30, {24e3, 4e3, 500}, {80, 8, 10});
  scenario->emitters[0].propagation.parabolic_equation.max_angle_deg = 3;
  const Made made(*scenario, terrain.get());
  const propagation::PeField field = peField(made.inputs, made.radials);
  const propagation::AzimuthMarch& march = field.march.march;
  const auto reached_m = [&](double azimuth_deg) {
    const int a = static_cast<int>(std::lround(degToRad(azimuth_deg) / made.plan.azimuth_step_rad));
    return march.rangesOf(a) * march.cells.range_step_m;
  };
  EXPECT_GT(reached_m(90), 6000 - 2500);  // where the slope is seen at 3 degrees
  EXPECT_LT(reached_m(90), 6000 + 1000);
  EXPECT_GT(reached_m(270), 11.9e3);
}

// In rugged country rays must stay in the band whatever the slopes below them, else the field in sight is
// lost.
TEST(ParabolicField, SLOW_EqualsFreeSpaceHighAboveRuggedGround) {
  const auto terrain =
      std::make_shared<const MadeTerrain>(kLatitude_deg, kLongitude_deg, 1.0, [](double east, double north) {
        return 150 + 120 * std::sin(250 * east + 1) * std::cos(200 * north);  // slopes to 24 degrees
      });
  const auto scenario = around(3e8, 500, {24e3, 24e3, 800}, {40, 40, 10});
  const auto volume = solve(scenario, terrain);
  const Made made(*scenario, terrain.get());
  std::vector<double> excess_db;
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j) excess_db.push_back(excessIn(*volume, made, i, j, 5));  // 440 m high
  }
  EXPECT_NEAR(quantileOf(excess_db, 0.5), 0, 2);
  EXPECT_LT(quantileOf(excess_db, 0.95), 8);
}

TEST(ParabolicField, DominantModelMarksMarchAndDiffraction) {
  const auto scenario = overTheSea(6000, 30);
  const auto power = solve(scenario);
  scenario->output.quantities = {"dominant_model"};
  const auto model = solve(scenario);
  const Made made(*scenario, nullptr);
  const Marched marched(made);
  const propagation::PeExcess& excess = marched.excess;
  const std::vector<std::string> labels = volume::labelsOf(model->info);
  std::map<std::string, int> seen;
  for (int i = 0; i < 160; ++i) {
    const GridColumn column = made.columns.view()[static_cast<std::size_t>(160 + i)];
    const auto range_m = static_cast<float>(footInverse(made.station, column, 0).distance_m);
    for (int k = 0; k < 30; ++k) {
      const auto height_m =
          static_cast<float>(heightMsl_m(column, static_cast<double>(made.columns.t_m[std::size_t(k)])));
      const bool is_equation = excess.others.equationPart(range_m, height_m, 0, 0) >= 0.5F;
      const std::string& name =
          labels.at(static_cast<std::size_t>(std::lround(testing::valueAt(*model, i, 1, k))));
      ++seen[name];
      const bool is_high = height_m > excess.top_msl_m;
      EXPECT_TRUE(name != "two_ray" || !is_equation) << i << ", " << k;
      EXPECT_TRUE(name != "parabolic_equation" || (is_equation && !is_high)) << i << ", " << k;
      EXPECT_TRUE(name != "extended_optics" || (is_equation && is_high)) << i << ", " << k;
      EXPECT_TRUE(name != "troposcatter" || excessIn(*power, made, i, 1, k) > 30) << i << ", " << k;
    }
  }
  for (const char* name : {"two_ray", "parabolic_equation", "extended_optics"})
    EXPECT_GT(seen[name], 10) << name;
}

TEST(ParabolicField, DominantModelMarksScatterAndFloor) {
  const auto scenario = overTheSea(20, 5);
  scenario->output.quantities = {"dominant_model"};
  EXPECT_EQ(testing::valueAt(*solve(scenario), 0, 1, 2),
            static_cast<float>(propagation::Mechanism::troposcatter));
  scenario->output.quantities = {"power_density_dbwm2"};
  scenario->emitters[0].propagation.parabolic_equation.floor_db = -30;
  const auto power = solve(scenario);
  FieldSolver solver(scenario, nullptr, {});
  solver.update(scenario::snapshotAt(scenario, nullptr, 0));
  const auto asked = std::make_shared<scenario::Scenario>(*scenario);
  asked->output.quantities = {"dominant_model"};
  EXPECT_THAT(solver.update(scenario::snapshotAt(asked, nullptr, 0)).moved, ::testing::ElementsAre(0));
  const auto model = solver.volumes()[0].host();
  const Made made(*scenario, nullptr);
  EXPECT_EQ(testing::valueAt(*model, 20, 1, 2), static_cast<float>(propagation::Mechanism::floor));
  EXPECT_NEAR(excessIn(*power, made, 20, 1, 2), 30, 0.1);
  EXPECT_EQ(testing::valueAt(*model, 70, 1, 2),
            static_cast<float>(propagation::Mechanism::parabolic_equation));
}

}  // namespace
}  // namespace emscape::emfield
