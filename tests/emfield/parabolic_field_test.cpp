// The model parabolic_equation in the field: surfaces, edits, ducts, limits and warnings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emfield/excess/model_check.h"
#include "emscape/emfield/link/path_budget.h"
#include "emscape/propagation/steep_ground.h"
#include "propagation/parabolic_equation/march/march_step.h"
#include "scenario/antenna/shapes.h"
#include "tests/emfield/parabolic_samples.h"
#include "tests/support/errors.h"

namespace emscape::emfield {
namespace {

using propagation::Polarization;
using propagation::PropagationModel;
using namespace testing;

TEST(ParabolicField, SLOW_PathsAcrossAHoleAreUnknownAndOthersAreNot) {
  const auto terrain = std::make_shared<const MadeTerrain>(kLatitude_deg, kLongitude_deg, 0.6, 0.05);
  const auto scenario = around(3e8, 1200, {36e3, 36e3, 1000}, {24, 24, 4}, 1100);
  EXPECT_THAT(test::errorOf([&] { solve(scenario, terrain); }, ErrorCode::bad_input),
              ::testing::HasSubstr("missing"));
  FieldOptions options;
  options.allow_missing_terrain = true;
  const auto volume = solve(scenario, terrain, options);
  const auto known = std::count_if(volume->first_valid_k.begin(), volume->first_valid_k.end(),
                                   [](std::uint16_t k) { return k < 4; });
  EXPECT_GT(known, 500);
  EXPECT_LT(known, 24 * 24);
}

TEST(ParabolicField, SLOW_SurfacesNearGroundEqualPaths) {
  const scenario::TerrainPtr terrain = gentleHills();
  const auto scenario = around(3e8, 180, {24e3, 24e3, 400}, {4, 4, 4}, 80);
  const auto made_surface = std::make_shared<Surface>();
  Surface& surface = *made_surface;
  surface.width = surface.height = 30;
  for (int n = 0; n < 900; ++n) {
    surface.positions.push_back(
        {kLatitude_deg - 0.1 + 0.2 * (n / 30) / 29, kLongitude_deg - 0.15 + 0.3 * (n % 30) / 29});
  }
  surface.heights_m = {3, 30, 100};
  FieldOptions options;
  options.surface = made_surface;
  const auto volume = solve(scenario, terrain, options);
  const scenario::Snapshot snapshot = scenario::snapshotAt(scenario, terrain.get(), 0);
  std::vector<double> differences;
  for (int n = 7; n < 900; n += 47) {
    for (int k = 0; k < 3; ++k) {
      scenario::SitePosition position;
      const auto& at = surface.positions[static_cast<std::size_t>(n)];
      const double height_msl_m = terrain->heightMsl_m(at.latitude_deg, at.longitude_deg) +
                                  surface.heights_m[static_cast<std::size_t>(k)];
      const PathBudget budget =
          pathBudget(snapshot, 0, {{at.latitude_deg, at.longitude_deg, height_msl_m}, height_msl_m},
                     PropagationModel::parabolic_equation, terrain.get());
      differences.push_back(std::abs(budget.find("power_density_dbwm2")->value -
                                     static_cast<double>(testing::valueAt(*volume, n % 30, n / 30, k))));
    }
  }
  EXPECT_LT(quantileOf(differences, 0.5), 0.8);
  EXPECT_LT(quantileOf(differences, 0.9), 4);  // nulls between hills
}

TEST(ParabolicField, TurnedBeamIsCombinedAndSettingsRepeatMarch) {
  const auto scenario = around(1e9, 30, {20e3, 20e3, 200}, {20, 20, 10});
  FieldSolver solver(scenario, nullptr, {});
  solver.update(scenario::snapshotAt(scenario, nullptr, 0));
  const auto editedBy = [&](auto edit) {
    auto edited = std::make_shared<scenario::Scenario>(*scenario);
    edit(*edited);
    return solver.update(scenario::snapshotAt(edited, nullptr, 0));
  };
  EXPECT_THAT(editedBy([](auto& s) { s.emitters[0].power_w *= 2; }).moved, ::testing::IsEmpty());
  EXPECT_THAT(editedBy([](auto& s) { s.emitters[0].propagation.parabolic_equation.max_angle_deg = 2; }).moved,
              ::testing::ElementsAre(0));
  EXPECT_THAT(editedBy([](auto& s) { s.atmosphere.k_factor = 1.5; }).moved, ::testing::ElementsAre(0));
}

TEST(ParabolicField, PatternRepeatsMarchWhenBeamTiltsOnly) {
  const auto scenario = around(1e9, 30, {20e3, 20e3, 200}, {20, 20, 10});
  scenario::Emitter& emitter = scenario->emitters[0];
  emitter.antenna = scenario::makeSinc(20, 2, 2, -30);
  emitter.propagation.parabolic_equation.source = propagation::PeRadiator::pattern;
  FieldSolver solver(scenario, nullptr, {});
  solver.update(scenario::snapshotAt(scenario, nullptr, 0));
  const auto movedBy = [&](auto edit) {
    auto edited = std::make_shared<scenario::Scenario>(*scenario);
    edit(edited->emitters[0]);
    return solver.update(scenario::snapshotAt(edited, nullptr, 0)).moved;
  };
  EXPECT_THAT(movedBy([](auto& e) { e.scan.azimuth_deg = 77; }), ::testing::IsEmpty());
  EXPECT_THAT(movedBy([](auto& e) { e.antenna = scenario::makeSinc(30, 2, 2, -30); }), ::testing::IsEmpty());
  EXPECT_THAT(movedBy([](auto& e) { e.scan.elevation_deg = 1; }), ::testing::ElementsAre(0));
  EXPECT_THAT(movedBy([](auto& e) { e.antenna = scenario::makeSinc(20, 2, 3, -30); }),
              ::testing::ElementsAre(0));
}

TEST(ParabolicField, SlantPolarizationIsMeanOfBoth) {
  const auto scenario = around(3e8, 30, {20e3, 300, 200}, {40, 3, 20});
  const auto powerOf = [&](Polarization polarization) {
    scenario->emitters[0].polarization = polarization;
    return std::pow(10.0, static_cast<double>(testing::valueAt(*solve(scenario), 3, 1, 5)) / 10);
  };
  const double mean = (powerOf(Polarization::horizontal) + powerOf(Polarization::vertical)) / 2;
  EXPECT_NEAR(10 * std::log10(powerOf(Polarization::slant_45) / mean), 0, 0.02);
}

TEST(ParabolicField, ReportsChosenGrid) {
  const auto scenario = around(1e9, 30, {20e3, 20e3, 200}, {20, 20, 10});
  const Made made(*scenario, nullptr);
  std::string all;
  for (const propagation::ModelChoice& choice : made.plan.choices)
    all += choice.name + " " + choice.text + "\n";
  for (const char* name :
       {"largest angle 3 degrees", "height step", "range step", "absorber", "azimuths 1:", "cells", "cost"})
    EXPECT_THAT(all, ::testing::HasSubstr(name));
}

// Over terrain as many heights as a power of two below the wanted one hold, if they hold most of the angle.
TEST(ParabolicField, AngleIsReducedByAQuarterForHalfTheHeights) {
  constexpr double kMetresPerDegree = 70e3;
  const auto terrain =
      std::make_shared<const MadeTerrain>(kLatitude_deg, kLongitude_deg, 1.0, [](double east, double) {
        return (east - 0.5) * kMetresPerDegree > 1500 ? 0.0 : 450.0;  // a cliff, no slopes
      });
  int halved = 0;
  for (const double frequency_hz : {4.0e9, 5.0e9, 5.5e9, 7e9}) {
    const auto scenario = around(frequency_hz, 480, {8e3, 8e3, 1000}, {8, 8, 10});
    const PePlan automatic = Made(*scenario, terrain.get()).plan;
    scenario->emitters[0].propagation.parabolic_equation.max_angle_deg = 3;
    const PePlan given = Made(*scenario, terrain.get()).plan;
    EXPECT_NEAR(given.max_angle_rad, degToRad(3.0), 1e-12);
    if (automatic.grid.intervals == given.grid.intervals) {
      EXPECT_NEAR(automatic.max_angle_rad, given.max_angle_rad, 1e-12) << frequency_hz;
      continue;
    }
    ++halved;
    EXPECT_EQ(2 * automatic.grid.intervals, given.grid.intervals) << frequency_hz;
    EXPECT_GE(automatic.max_angle_rad, degToRad(2.25)) << frequency_hz;
    EXPECT_LT(automatic.max_angle_rad, given.max_angle_rad) << frequency_hz;
  }
  EXPECT_GT(halved, 0);
  EXPECT_LT(halved, 4);
}

// The figure of duct_fields.csv: 10 to 10 m at 60 km 6.84 dB over free space in a duct of 14 m; without, deep
// behind the horizon.
TEST(ParabolicField, AnEvaporationDuctGuidesBeyondTheHorizon) {
  const auto scenario = overTheSea(20, 5);
  const auto plain = solve(scenario);
  scenario->atmosphere.refractivity = duct({14});
  const auto ducted = solve(scenario);
  const Made made(*scenario, nullptr);
  EXPECT_NEAR(-excessIn(*ducted, made, 20, 1, 2), 6.84, 1.0);
  EXPECT_LT(-excessIn(*plain, made, 20, 1, 2), -40);
}

TEST(ParabolicField, DuctsHaveNoEffectHighUpAndAtLargeAngles) {
  const auto scenario = overTheSea(6000, 30);
  const auto plain = solve(scenario);
  scenario->atmosphere.refractivity = duct({14});
  const auto ducted = solve(scenario);
  int compared = 0;
  for (int i = 0; i < 160; ++i) {
    for (int k = 10; k < 30; ++k) {
      const double height_m = 200.0 * k + 100, range_m = std::abs(i - 79.5) * 1000;
      if (height_m / range_m < std::tan(degToRad(5.0))) continue;
      ++compared;
      EXPECT_NEAR(static_cast<double>(testing::valueAt(*ducted, i, 1, k)),
                  static_cast<double>(testing::valueAt(*plain, i, 1, k)), 0.1);
    }
  }
  EXPECT_GT(compared, 500);
}

TEST(ParabolicField, AnEnsembleHasTheMeanPowerOrAQuantile) {
  const auto scenario = overTheSea(20, 5);
  const auto valueOf = [&](const std::shared_ptr<propagation::Refractivity>& refractivity) {
    scenario->atmosphere.refractivity = refractivity;
    return static_cast<double>(testing::valueAt(*solve(scenario), 20, 1, 2));
  };
  const double low = valueOf(duct({6})), middle = valueOf(duct({10})), high = valueOf(duct({14}));
  const double mean =
      10 * std::log10((std::pow(10, low / 10) + std::pow(10, middle / 10) + std::pow(10, high / 10)) / 3);
  EXPECT_NEAR(valueOf(duct({6, 10, 14})), mean, 0.3);
  const auto one = duct({10});
  one->members.push_back(one->air);
  EXPECT_EQ(valueOf(one), middle) << "an ensemble of one";
  const auto median = duct({6, 10, 14});
  median->quantile = 0.5;
  EXPECT_NEAR(valueOf(median), middle, 0.3);
}

// An antenna above the heights that are wanted raises the domain.
TEST(ParabolicField, HoldsAnAntennaAboveTheField) {
  const auto scenario = around(1e9, 3000, {20e3, 300, 200}, {20, 3, 10});
  EXPECT_GT(Made(*scenario, nullptr).plan.top_msl_m, 3000);
  const auto volume = solve(scenario);
  for (const float power_dbwm2 : volume->values) EXPECT_TRUE(std::isfinite(power_dbwm2));
}

// Planes hold the field over free space: power is a factor in the combination, and over a smooth earth all
// azimuths are one.
TEST(ParabolicField, DoesNotDependOnPowerAndAzimuth) {
  const auto scenario = around(1e9, 30, {20e3, 20e3, 200}, {21, 21, 10});
  const auto volume = solve(scenario);
  for (const int i : {0, 3, 8}) {
    for (int k = 0; k < 10; ++k) {
      const float west = testing::valueAt(*volume, i, 10, k), south = testing::valueAt(*volume, 10, i, k);
      EXPECT_NEAR(west, testing::valueAt(*volume, 20 - i, 10, k), 0.02) << i << ", " << k;
      EXPECT_NEAR(west, south, 0.1) << i << ", " << k;  // the earth is not a sphere
    }
  }
  scenario->emitters[0].power_w *= 100;
  const auto stronger = solve(scenario);
  for (std::size_t v = 0; v < volume->values.size(); ++v)
    EXPECT_NEAR(stronger->values[v] - volume->values[v], 20, 0.01);
}

// At large angles it is longer than a quarter of the absorber's length.
TEST(ParabolicField, TakesItsAutomaticRangeStepAlsoWhenItIsGiven) {
  const auto scenario = around(1e9, 30, {11e3, 11e3, 200}, {11, 11, 10});
  propagation::ParabolicEquationSettings& settings = scenario->emitters[0].propagation.parabolic_equation;
  settings.max_angle_deg = 35;
  const auto automatic = solve(scenario);
  settings.range_step_m = 50;
  EXPECT_EQ(solve(scenario)->values, automatic->values);
}

struct Refusal {
  const char* name;
  std::function<void(scenario::Scenario&)> edit;
  const char* message;
};

TEST(ParabolicField, RefusesInputsOutsideItsLimits) {
  const std::vector<Refusal> refusals{
      {"frequency", [](auto& s) { s.emitters[0].frequency_hz = 20e6; },
       "frequency 20 MHz is outside 30..40000"},
      {"top", [](auto& s) { s.emitters[0].propagation.parabolic_equation.top_m = 25; }, "'top_m' is 25 m"},
      {"antenna on the ground", [](auto& s) { s.platforms[0].track[0].position.height_msl_m = 0; },
       "antenna 0 m above the ground; expected above 0, up to "},
      {"step", [](auto& s) { s.emitters[0].propagation.parabolic_equation.range_step_m = 2000; },
       "'range_step_m' is 2000 m; the absorber allows at most"},
      {"distance",
       [](auto& s) {
         s.region.size_m = {2.9e6, 300, 200};
       },
       "outside 0..1000 km"},
      {"steps",
       [](auto& s) {
         s.region.size_m.x = 400e3;
         s.emitters[0].propagation.parabolic_equation.range_step_m = 5;
       },
       "is outside 1..20000"},
      {"heights",
       [](auto& s) {
         s.emitters[0].frequency_hz = 10e9;
         s.emitters[0].propagation.parabolic_equation.max_angle_deg = 15;
         s.emitters[0].propagation.parabolic_equation.top_m = 5000;
       },
       "at most 32768"},
      {"raster",
       [](auto& s) {
         s.emitters[0].propagation.parabolic_equation.source = propagation::PeRadiator::pattern;
         s.emitters[0].scan = {scenario::ScanKind::raster, 0, 0, 0, 90, 30, 1.5, 3, {}};
       },
       "emitter 'tower': 'parabolic_equation': 'source' is pattern, which marches the beam at one elevation, "
       "but "
       "its raster has 3 bars, 1.5 degrees apart; expected isotropic, or a beam that stays in elevation"},
      {"dwells",
       [](auto& s) {
         s.emitters[0].propagation.parabolic_equation.source = propagation::PeRadiator::pattern;
         s.emitters[0].scan.kind = scenario::ScanKind::dwell_list;
         s.emitters[0].scan.dwells = {{0, 1, 1}, {0, 2, 1}};
       },
       "its dwells are at 1 to 2 degrees"},
      {"array",
       [](auto& s) {
         s.emitters[0].propagation.parabolic_equation.source = propagation::PeRadiator::pattern;
         s.emitters[0].kind = scenario::EmitterKind::radar;
         s.output.radar_look = scenario::RadarAim::target;
         s.emitters[0].antenna = scenario::makePhasedArray(20, 8, 8, 0.5, 1);
       },
       "the radar's beam follows targets"},
  };
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(refusal.name);
    const auto scenario = around(1e9, 30, {20e3, 300, 200}, {20, 3, 10});
    refusal.edit(*scenario);
    EXPECT_THAT(test::errorOf([&] { solve(scenario); }, ErrorCode::bad_input),
                ::testing::HasSubstr(refusal.message));
  }
}

TEST(ParabolicField, WarnsOutsideMeasuredSettings) {
  const auto warningsOf = [](auto edit) {
    const auto scenario = around(1e9, 30, {20e3, 300, 200}, {20, 3, 10});
    edit(*scenario);
    FieldSolver solver(scenario, nullptr, {});
    solver.update(scenario::snapshotAt(scenario, nullptr, 0));
    std::string all;
    for (const std::string& warning : solver.warnings()) all += warning + "\n";
    return all;
  };
  EXPECT_EQ(warningsOf([](auto&) {}), "");
  const auto ductOver = [](propagation::GroundKind kind) {
    return [kind](auto& s) {
      s.ground.kind = kind;
      s.atmosphere.refractivity = duct({14});
    };
  };
  EXPECT_EQ(warningsOf(ductOver(propagation::GroundKind::sea)), "");
  EXPECT_THAT(warningsOf(ductOver(propagation::GroundKind::dry_ground)),
              ::testing::HasSubstr("the evaporation duct is left out over land"));
  const auto measuredTo = [](double height_m) {
    return [height_m](auto& s) {
      const auto air = std::make_shared<propagation::Refractivity>();
      air->air.profiles = {propagation::withUpperAir(
          propagation::profileOfLevels({{0, 330}, {height_m, 330 + 0.118 * height_m}}))};
      s.atmosphere.refractivity = air;
    };
  };
  EXPECT_EQ(warningsOf(measuredTo(200)), "");
  EXPECT_THAT(warningsOf(measuredTo(150)), ::testing::HasSubstr("the profile of the air ends below"));
  EXPECT_THAT(warningsOf([](auto& s) { s.emitters[0].frequency_hz = 25e9; }),
              ::testing::HasSubstr("frequency 25000 MHz is outside 30..20000 MHz"));
  EXPECT_THAT(warningsOf([](auto& s) { s.ground.roughness_m = 3; }),
              ::testing::HasSubstr("roughness (rms) 3 m"));
}

/// A warning of steep ground: what is lost (percent), 0 without one, and the advice.
struct Steep {
  double lost = 0;
  std::string advice;  ///< value of max_angle_deg; empty: none helps
};

Steep steepOf(const std::vector<std::string>& warnings) {
  Steep found;
  int sentences = 0;
  for (const std::string& text : warnings) {
    if (text.find("of the length of its marches") == std::string::npos) continue;
    ++sentences;
    const auto numberBefore = [&](const char* words) {
      const std::size_t end = text.find(words);
      if (end == std::string::npos) return 0.0;
      const std::size_t begin = text.find_last_of(' ', end - 1);
      return std::stod(text.substr(begin, end - begin));
    };
    found.lost = numberBefore(" % of the length") + numberBefore(" % is behind");
    const std::string key = "; 'max_angle_deg: ";
    const std::size_t at = text.find(key);
    if (at != std::string::npos)
      found.advice = text.substr(at + key.size(), text.find('\'', at + key.size()) - at - key.size());
  }
  EXPECT_LE(sentences, 1) << "one per emitter";
  return found;
}

/// Over mountains and in a crater: who follows the advice loses at most half.
TEST(ParabolicField, SLOW_AdviceOnTheLargestAngleHelps) {
  const auto crater = std::make_shared<const MadeTerrain>(
      kLatitude_deg, kLongitude_deg, 0.4,
      [](double east, double north) { return std::hypot(east - 0.2, north - 0.2) > 0.03 ? 500.0 : 100.0; });
  const auto ridges = std::make_shared<const MadeTerrain>(
      kLatitude_deg, kLongitude_deg, 0.4,
      [](double east, double) { return east > 0.2 ? 100 + 25 * std::sin(700 * east) : 100.0; });
  const auto steepWith = [](const scenario::TerrainPtr& terrain, double antenna_msl_m, double max_angle_deg) {
    const auto scenario = around(3e8, antenna_msl_m, {20e3, 20e3, 400}, {20, 20, 4}, 520);
    scenario->emitters[0].propagation.parabolic_equation.max_angle_deg = max_angle_deg;
    FieldSolver solver(scenario, terrain, {});
    solver.update(scenario::snapshotAt(scenario, terrain.get(), 0));
    return steepOf(solver.warnings());
  };
  for (const auto& [terrain, antenna_msl_m] :
       {std::pair<scenario::TerrainPtr, double>{crater, 110}, {ridges, 300}}) {
    const Steep before = steepWith(terrain, antenna_msl_m, 3);
    EXPECT_GT(before.lost, 10);
    ASSERT_FALSE(before.advice.empty());
    const double advised_deg = before.advice == "auto" ? 0 : std::stod(before.advice);
    const Steep after = steepWith(terrain, antenna_msl_m, advised_deg);
    EXPECT_LE(after.lost, before.lost / 2);
  }
}

TEST(ParabolicField, CountsGroundThatIsTooSteep) {
  const auto terrain = std::make_shared<const MadeTerrain>(
      kLatitude_deg, kLongitude_deg, 0.4, [](double east, double) { return east > 0.3 ? 400.0 : 100.0; });
  const auto scenario = around(3e8, 200, {20e3, 2e3, 400}, {20, 3, 4}, 420);
  FieldSolver solver(scenario, terrain, {});
  solver.update(scenario::snapshotAt(scenario, terrain.get(), 0));
  EXPECT_THAT(solver.warnings(), ::testing::Contains(::testing::HasSubstr("taken as steps of a staircase")));
}

/// A march at 3 GHz and 4096 height steps over ground up and down.
propagation::SteepGround marchOver(double slope_deg, double azimuth_deg, double angle_deg,
                                   bool is_automatic = true) {
  constexpr int kSteps = 200;
  constexpr double kStep_m = 50;
  std::vector<float> ground_m;
  for (int i = 0; i <= kSteps; ++i)
    ground_m.push_back(float(kStep_m * std::tan(degToRad(slope_deg)) * (i % 20 < 10 ? i % 20 : 20 - i % 20)));
  propagation::SteepGround march;
  march.max_angle_deg = angle_deg;
  march.is_automatic = is_automatic;
  march.with = [=](double max_angle_deg) -> std::vector<propagation::SteepAzimuth> {
    if (max_angle_deg > 35) return {};
    const double automatic_deg = std::ceil(radToDeg(std::asin(1.5 * std::sin(degToRad(slope_deg)))));
    const double sine =
        std::sin(degToRad(max_angle_deg > 0 ? max_angle_deg : automatic_deg)) / propagation::kPeEvenBand;
    const double part =
        propagation::staircasePart(ground_m.data(), kSteps, kStep_m, sine, propagation::kPeMaxSlopePart);
    return {{degToRad(azimuth_deg), kSteps * kStep_m, part * kSteps * kStep_m, 0}};
  };
  march.azimuths = march.with(angle_deg);
  return march;
}

// Ground of 8 degrees fills 0.4 of the band of 13 degrees.
TEST(ParabolicField, NamesTheLeastAngleThatHoldsTheGround) {
  const std::string text = propagation::steepGroundWarning({marchOver(8, 359.8, 3)});
  EXPECT_THAT(text, ::testing::HasSubstr("100.0 % of the length"));
  EXPECT_THAT(text, ::testing::HasSubstr("at azimuth 0 degrees"));
  EXPECT_THAT(text, ::testing::HasSubstr("'max_angle_deg: 13' leaves 0.0 %"));
  EXPECT_EQ(propagation::steepGroundWarning({marchOver(8, 359.8, 13)}), "");
}

// An angle that holds the hills of one azimuth would lose the mountains of another, which is marched with a
// larger one.
TEST(ParabolicField, AdviceIsForAllMarchesOfAnEmitter) {
  const std::string text = propagation::steepGroundWarning({marchOver(4, 10, 5), marchOver(16, 350, 24)});
  EXPECT_THAT(text, ::testing::HasSubstr("between azimuths 350 and 10 degrees"));
  EXPECT_THAT(text, ::testing::HasSubstr("'max_angle_deg: 25' leaves 0.0"));
}

TEST(ParabolicField, AdviceIsAutomaticWhereAGivenAngleLosesTheGround) {
  EXPECT_THAT(propagation::steepGroundWarning({marchOver(4, 10, 9, false), marchOver(16, 350, 9, false)}),
              ::testing::HasSubstr("'max_angle_deg: auto' leaves 0.0"));
}

TEST(ParabolicField, OfAnEmitterThatMovesTheMarchThatLosesMostIsKept) {
  SteepGrounds kept;
  keepSteepest(kept, {{"a", {marchOver(8, 10, 13)}}, {"b", {marchOver(8, 0, 3)}}});
  keepSteepest(kept, {{"a", {marchOver(8, 350, 3)}}});
  keepSteepest(kept, {{"a", {marchOver(8, 20, 13)}}});
  ASSERT_EQ(kept.size(), 2u);
  ASSERT_EQ(kept["a"].size(), 1u);
  EXPECT_EQ(kept["a"][0].max_angle_deg, 3);
  EXPECT_THAT(steepGroundWarnings(kept), ::testing::SizeIs(2));
}

TEST(ParabolicField, TrialsOfOtherAnglesHaveTheGridOfTheirPlans) {
  const auto terrain = std::make_shared<const MadeTerrain>(
      kLatitude_deg, kLongitude_deg, 0.4,
      [](double east, double) { return 100 + 50 * std::sin(300 * east); });
  Made made(*around(3e8, 300, {20e3, 20e3, 400}, {20, 20, 4}, 520), terrain.get());
  const propagation::DomainNeeds needs = propagation::domainNeeds(made.inputs, made.radials);
  for (const double max_angle_deg : {0.0, 2.0, 9.0}) {
    made.inputs.emitter.settings.parabolic_equation.max_angle_deg = max_angle_deg;
    const PePlan plan = planMarch(made.inputs, made.radials, needs),
                 trial = planWithoutAir(made.inputs, made.radials, needs, 1);
    EXPECT_EQ(trial.grid.intervals, plan.grid.intervals);
    EXPECT_EQ(trial.grid.range_step_m, plan.grid.range_step_m);
    EXPECT_EQ(trial.max_angle_rad, plan.max_angle_rad);
    EXPECT_EQ(trial.azimuths, plan.azimuths);
    EXPECT_EQ(trial.ranges, plan.ranges);
  }
}

TEST(ParabolicField, SaysThatNoAngleHelps) {
  propagation::SteepGround cliff = marchOver(50, 200, 20);
  EXPECT_THAT(propagation::steepGroundWarning({cliff}),
              ::testing::HasSubstr("no 'max_angle_deg' up to 35 leaves half of it or less"));
  cliff.with = [](double) { return std::vector<propagation::SteepAzimuth>(); };
  EXPECT_THAT(propagation::steepGroundWarning({cliff}),
              ::testing::HasSubstr("the height steps afford no larger 'max_angle_deg'"));
}

}  // namespace
}  // namespace emscape::emfield
