// Inputs of a path: datum of heights, refraction, antenna angle, near field, antimeridian and pole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "emfield/ground/ground_posts.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"
#include "emscape/emfield/link/path_budget.h"
#include "tests/emfield/test_scenario.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using propagation::PropagationModel;

/// An emitter 20 m above a smooth earth at mean sea level.
std::shared_ptr<scenario::Scenario> mastAt(double latitude_deg, double longitude_deg) {
  auto scenario =
      emptyScenario(FrameKind::altitude, latitude_deg, longitude_deg, {40e3, 40e3, 4000}, {10, 10, 10});
  addEmitter(*scenario, {latitude_deg, longitude_deg, 0}, plainEmitter("mast", 0));
  scenario->platforms[0].track[0].position.height_ellipsoid_m.reset();
  scenario->platforms[0].track[0].position.height_msl_m = 20;
  return scenario;
}

PathEnd pointAt(double latitude_deg, double longitude_deg, double height_msl_m) {
  return {{latitude_deg, longitude_deg, height_msl_m + geoidUndulation_m(latitude_deg, longitude_deg)},
          height_msl_m};
}

PathBudget budgetTo(const std::shared_ptr<scenario::Scenario>& scenario, const PathEnd& point,
                    PropagationModel model = PropagationModel::free_space) {
  return pathBudget(scenario::snapshotAt(scenario, nullptr, 0), 0, point, model, nullptr);
}

TEST(PathInputs, ItmUsesRefractivityAndDiffractionUsesKFactor) {
  const auto scenario = mastAt(50, 8);
  const PathEnd point = pointAt(50.4, 8, 100);
  const auto excess = [&](PropagationModel model, double k_factor) {
    scenario->atmosphere.k_factor = k_factor;
    return budgetTo(scenario, point, model).excess.parts.front().loss_db;
  };
  EXPECT_NEAR(excess(PropagationModel::itm, 1), excess(PropagationModel::itm, 2), 1e-6);
  EXPECT_GT(excess(PropagationModel::diffraction, 1), excess(PropagationModel::diffraction, 2) + 3);
}

TEST(PathInputs, AntennaAngleIsOfRefractedRay) {
  const auto scenario = mastAt(50, 8);
  const PathEnd point = pointAt(51.8, 8, 6000);
  const PathBudget straight = budgetTo(scenario, point);
  const double launch_deg = radToDeg(straight.geometry.launch_elevation_rad);
  EXPECT_GT(launch_deg, radToDeg(straight.geometry.straight_elevation_rad) + 0.2);
  scenario->emitters[0].antenna = scenario::makeGaussian(40, 1, 1, -60);
  scenario->emitters[0].scan.elevation_deg = launch_deg;
  EXPECT_NEAR(budgetTo(scenario, point).pointing.pattern_db, 0, 1e-3);
}

TEST(PathInputs, HeightsKeepTheirDatum) {
  // 47 m lie between the ellipsoid and mean sea level there
  const auto scenario = mastAt(50, 8);
  const double undulation_m = geoidUndulation_m(50, 8);
  EXPECT_NEAR(undulation_m, 47.5, 1.5);
  const auto end_msl_m = [&](double height_msl_m) {
    return budgetTo(scenario, pointAt(50.2, 8, height_msl_m)).profile.end;
  };
  EXPECT_EQ(end_msl_m(300).height_msl_m, 300);
  EXPECT_NEAR(end_msl_m(300).position.height_ellipsoid_m, 347.5, 1.5);
  EXPECT_NEAR(budgetTo(scenario, pointAt(50.2, 8, 300)).profile.begin.position.height_ellipsoid_m,
              20 + undulation_m, 1e-6);
}

TEST(PathInputs, PathsCrossAntimeridianAndPole) {
  const PathBudget across = budgetTo(mastAt(10, 179.95), pointAt(10, -179.95, 500));
  EXPECT_NEAR(across.profile.range_m, 10.96e3, 20);
  EXPECT_NEAR(radToDeg(across.profile.azimuth_rad), 90, 0.1);
  const PathBudget over_pole = budgetTo(mastAt(89.9, 20), pointAt(89.9, -160, 500));
  EXPECT_NEAR(over_pole.profile.range_m, 22.34e3, 20);
  for (const double height_msl_m : over_pole.profile.ray_msl_m) EXPECT_TRUE(std::isfinite(height_msl_m));
}

TEST(PathInputs, NearFieldIsMarkedAndFinite) {
  const auto scenario = mastAt(50, 8);
  scenario->emitters[0].antenna = scenario::makeGaussian(45, 0.8, 0.8, -60);
  const PathBudget near = budgetTo(scenario, pointAt(50.0001, 8, 20));
  ASSERT_LT(near.geometry.slant_range_m, near.geometry.far_field_m);
  EXPECT_THAT(near.warnings, ::testing::Contains(::testing::HasSubstr("closer than the far-field distance")));
  EXPECT_TRUE(std::isfinite(near.find("power_density_dbwm2")->value));
  const PathBudget far = budgetTo(scenario, pointAt(50.2, 8, 20));
  EXPECT_THAT(far.warnings, ::testing::IsEmpty());
}

}  // namespace
}  // namespace emscape::emfield
