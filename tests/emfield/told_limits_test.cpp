/// Warnings and verdicts of what a model or a scenario leaves out on a path.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "emfield/excess/model_check.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"
#include "emscape/emfield/link/path_budget.h"
#include "tests/emfield/made_terrain.h"
#include "tests/emfield/parabolic_samples.h"
#include "tests/emfield/radar_duel.h"
#include "tests/emfield/test_scenario.h"

namespace emscape::emfield {
namespace {

using namespace emscape::emfield::testing;
using propagation::PropagationModel;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kLatitude_deg = 45, kLongitude_deg = 10;

/// An emitter 30 m above the sea in the middle of a region.
std::shared_ptr<scenario::Scenario> atSea(scenario::Emitter emitter, double size_m = 40e3) {
  auto scenario =
      emptyScenario(FrameKind::altitude, kLatitude_deg, kLongitude_deg, {size_m, size_m, 200}, {20, 20, 10});
  addEmitter(*scenario,
             {kLatitude_deg, kLongitude_deg, geoidUndulation_m(kLatitude_deg, kLongitude_deg) + 30},
             std::move(emitter));
  return scenario;
}

PathBudget budgetTo(const std::shared_ptr<scenario::Scenario>& scenario, double distance_m, double height_m,
                    const scenario::Terrain* terrain = nullptr) {
  const GeodeticPosition foot = geodesicDirect(kLatitude_deg, kLongitude_deg, kPi / 2, distance_m);
  const double undulation_m = geoidUndulation_m(foot.latitude_deg, foot.longitude_deg);
  return pathBudget(scenario::snapshotAt(scenario, terrain, 0), 0,
                    {{foot.latitude_deg, foot.longitude_deg, undulation_m + height_m}, height_m},
                    scenario->emitters[0].propagation.model, terrain);
}

std::string joined(const std::vector<std::string>& warnings) {
  std::string all;
  for (const std::string& warning : warnings) all += warning + "\n";
  return all;
}

std::string toldAt(const std::shared_ptr<scenario::Scenario>& scenario, double distance_m, double height_m) {
  return joined(budgetTo(scenario, distance_m, height_m).warnings);
}

TEST(ToldLimits, FieldsBelowTroposcatterAreToldWithWhatItWouldBe) {
  constexpr double kFar_m = 200e3;
  for (const PropagationModel model : {PropagationModel::diffraction, PropagationModel::two_ray}) {
    SCOPED_TRACE(toString(model));
    scenario::Emitter emitter = plainEmitter("ship", 0);
    emitter.frequency_hz = 3e9;
    emitter.propagation.model = model;
    const auto scenario = atSea(emitter);
    const std::string told = toldAt(scenario, kFar_m, 10);
    ASSERT_THAT(told, HasSubstr("by troposcatter, which the model lacks, it would be "));
    const std::string before = "it would be ";
    const double scatter_db = std::stod(told.substr(told.find(before) + before.size()));
    EXPECT_THAT(toldAt(scenario, 25e3, 10), Not(HasSubstr("troposcatter"))) << "close behind the horizon";
    EXPECT_THAT(joined(FieldSolver(scenario, nullptr).warnings()), Not(HasSubstr("troposcatter")));
    EXPECT_THAT(joined(FieldSolver(atSea(emitter, 300e3), nullptr).warnings()), HasSubstr("troposcatter"));
    for (const PropagationModel other :
         {PropagationModel::itm, PropagationModel::p1812, PropagationModel::p452, PropagationModel::p528}) {
      scenario->emitters[0].propagation.model = other;
      const PathBudget budget = budgetTo(scenario, kFar_m, 10);
      EXPECT_NEAR(budget.excess.loss_db, scatter_db, 8) << toString(other);
      EXPECT_THAT(joined(budget.warnings), Not(HasSubstr("troposcatter"))) << toString(other);
    }
  }
}

TEST(ToldLimits, ClutterThatCountsAsIndependentIsToldUnlessItIsSaidOrFiltered) {
  scenario::Emitter radar = trackingRadar();
  radar.waveform = scenario::Waveform{1000, 1e-6, {}};
  radar.clutter.emplace();
  radar.clutter->range_cell_m = 150;
  radar.clutter->sea_state = 5;
  radar.power_w = 1e6;
  radar.receiver.pulses = 16;
  const auto told = [&radar] { return toldAt(atSea(radar), 8e3, 30); };
  EXPECT_THAT(told(), HasSubstr("counts as independent in each of the 16 pulses"));
  scenario::Emitter plain = radar;
  radar.clutter->independent_samples = 1;
  EXPECT_THAT(told(), Not(HasSubstr("counts as independent"))) << "the remedy";
  radar = plain;
  radar.clutter->mti.emplace();
  EXPECT_THAT(told(), Not(HasSubstr("counts as independent"))) << "the other remedy";
  radar = plain;
  radar.receiver.pulses = 1;
  EXPECT_THAT(told(), Not(HasSubstr("counts as independent")));
  radar = plain;
  radar.power_w = 1e-6;
  EXPECT_THAT(told(), Not(HasSubstr("counts as independent"))) << "noise is stronger";
}

TEST(ToldLimits, ClutterThatEndsAtTheHorizonIsToldWhereEchoesGoByDucts) {
  scenario::Emitter radar = trackingRadar();
  radar.waveform = scenario::Waveform{1000, 1e-6, {}};
  radar.clutter.emplace();
  radar.clutter->range_cell_m = 150;
  radar.clutter->sea_state = 4;
  const auto expectTold = [](const scenario::Emitter& told, bool has_duct, const char* text) {
    const auto scenario = atSea(told);
    if (has_duct) scenario->atmosphere.refractivity = duct({25});
    const auto is_told = *text != '\0'
                             ? ::testing::Matcher<std::string>(HasSubstr(text))
                             : ::testing::Matcher<std::string>(Not(HasSubstr("not that of the surface")));
    EXPECT_THAT(toldAt(scenario, 15e3, 30), is_told);
    EXPECT_THAT(joined(FieldSolver(scenario, nullptr).warnings()), is_told) << "before any field";
  };
  const std::pair<PropagationModel, double*> by_time[] = {
      {PropagationModel::p1812, &radar.propagation.p1812.time_percent},
      {PropagationModel::p452, &radar.propagation.p452.time_percent}};
  for (const auto& [model, time_percent] : by_time) {
    radar.propagation.model = model;
    *time_percent = 1;
    expectTold(radar, false, "losses of 1 % of the time are those of ducts, which carry the echo");
    *time_percent = 50;
    expectTold(radar, false, "");
  }
  radar.propagation.model = PropagationModel::parabolic_equation;
  expectTold(radar, true, "the air has ducts, which carry the echo");
  expectTold(radar, false, "");
}

TEST(ToldLimits, TiltedBeamsOfAnIsotropicSourceAreToldAndThePatternIsTheRemedy) {
  scenario::Emitter emitter = plainEmitter("mast", 0);
  emitter.propagation.model = PropagationModel::parabolic_equation;
  emitter.antenna = scenario::makeGaussian(30, 3, 3, -40);
  const auto told = [&emitter](double elevation_deg) {
    emitter.scan.elevation_deg = elevation_deg;
    return joined(checkModels(*atSea(emitter)));
  };
  EXPECT_THAT(told(5), HasSubstr("the beam of 3 degrees points 5 degrees above the horizon"));
  EXPECT_THAT(told(-2), HasSubstr("points 2 degrees below the horizon"));
  EXPECT_THAT(told(1.4), Not(HasSubstr("isotropic source")));
  emitter.propagation.parabolic_equation.source = propagation::PeRadiator::pattern;
  EXPECT_THAT(told(5), Not(HasSubstr("isotropic source")));
  emitter.propagation.parabolic_equation.source = propagation::PeRadiator::isotropic;
  emitter.scan.kind = scenario::ScanKind::raster;
  emitter.scan.bars = 3;
  emitter.scan.elevation_step_deg = 3;
  EXPECT_THAT(told(0), AllOf(HasSubstr("isotropic source"), HasSubstr("'two_ray' weighs each ray")));
  emitter.antenna = scenario::makeIsotropic();
  EXPECT_THAT(told(5), Not(HasSubstr("isotropic source")));
}

TEST(ToldLimits, AVerdictAtTheFloorOfTheMarchSaysAtLeast) {
  scenario::Emitter emitter = plainEmitter("mast", 0);
  emitter.propagation.model = PropagationModel::parabolic_equation;
  emitter.propagation.parabolic_equation.floor_db = -20;
  emitter.propagation.parabolic_equation.max_angle_deg = 4;
  const auto scenario = atSea(emitter);
  scenario->atmosphere.gases = propagation::GasLosses::never;
  const PathBudget budget = budgetTo(scenario, 45e3, 2);
  EXPECT_NEAR(budget.excess.loss_db, 20, 1e-3);
  EXPECT_THAT(budget.verdict, HasSubstr("costs at least 20.0 dB over free space (the floor of the march)"));
  EXPECT_NE(budget.find("floor_db"), nullptr);
  scenario->emitters[0].propagation.parabolic_equation.floor_db = -80;
  EXPECT_THAT(budgetTo(scenario, 45e3, 2).verdict, Not(HasSubstr("at least")));
}

TEST(ToldLimits, AVerdictOfASmoothSurfaceSaysSoOverTerrain) {
  const MadeTerrain terrain(kLatitude_deg, kLongitude_deg, 1);
  for (const PropagationModel model : {PropagationModel::two_ray, PropagationModel::p528}) {
    scenario::Emitter emitter = plainEmitter("mast", 0);
    emitter.propagation.model = model;
    const auto scenario = atSea(emitter);
    scenario->platforms[0].track[0].position.height_ellipsoid_m.reset();
    scenario->platforms[0].track[0].position.height_agl_m = 20;
    const PathBudget over_terrain = budgetTo(scenario, 15e3, 3000, &terrain);
    EXPECT_THAT(over_terrain.verdict, HasSubstr("above a smooth surface without terrain")) << toString(model);
    EXPECT_THAT(over_terrain.excess.why, HasSubstr("the ground below the emitter")) << toString(model);
    scenario->ground.surface_msl_m = 0;
    EXPECT_THAT(budgetTo(scenario, 15e3, 3000, &terrain).excess.why, Not(HasSubstr("below the emitter")));
  }
}

}  // namespace
}  // namespace emscape::emfield
