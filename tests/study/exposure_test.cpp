#include "emscape/study/exposure/exposure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "emscape/emfield/link/link.h"
#include "emscape/emfield/link/path_budget.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/snapshot.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::study {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;

/// A shipped scenario and its terrain.
struct Given {
  explicit Given(const std::string& name)
      : scenario(scenario::loadScenario(test::shippedScenario(name))),
        terrain(scenario::loadTerrain(*scenario)) {}
  Given(const std::string& file, scenario::TerrainPtr ground)
      : scenario(scenario::loadScenario(file)), terrain(std::move(ground)) {}
  std::shared_ptr<const scenario::Scenario> scenario;
  scenario::TerrainPtr terrain;
};

TEST(Exposure, ValueEqualsProfileAtThePlatform) {
  const Given given("links.yaml");
  constexpr int kDrone = 4;
  ExposureRequest request;
  request.platform = kDrone;
  request.quantity = scenario::Quantity::power_density_dbwm2;
  request.threshold = -60;
  request.look = scenario::RadarAim::scan;
  for (int t = 0; t <= 60; ++t) request.times_s.push_back(t);  // more than are solved at once
  const Exposure exposure = computeExposure(given.scenario, given.terrain, request, {});
  ASSERT_EQ(exposure.rows.size(), 61u);
  ASSERT_EQ(exposure.names, (std::vector<std::string>{"search radar", "mast", "jammer"}));
  for (const ExposureRow& row : exposure.rows) {
    const scenario::Snapshot snapshot = scenario::instantAt(given.scenario, given.terrain.get(), row.time_s);
    const scenario::PlatformState& state = snapshot.platforms[kDrone];
    EXPECT_EQ(row.latitude_deg, state.position.latitude_deg);
    double sum = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      const int e = exposure.emitters[n];
      const emfield::PathBudget budget = emfield::powerBudget(
          snapshot, e, {state.position, state.height_msl_m},
          given.scenario->emitters[static_cast<std::size_t>(e)].propagation.model, given.terrain.get());
      const double expected = budget.find("power_density_dbwm2")->value;
      EXPECT_NEAR(row.each[n], std::max(expected, given.scenario->output.floor), 0.01)
          << row.time_s << " s, " << exposure.names[n];
      sum += std::pow(10, expected / 10);
    }
    EXPECT_NEAR(row.value, std::max(10 * std::log10(sum), given.scenario->output.floor), 0.01);
    ASSERT_GE(row.best, 0);
    for (const double value : row.each) EXPECT_LE(value, row.each[static_cast<std::size_t>(row.best)]);
  }
}

/// A radar and an aircraft that flies from 100 to 130 s of 200 s, with a target, a receiver and a jammer.
Given passingAircraft(const TemporaryFolder& folder, const char* outside = "absent") {
  const std::string text = R"(schema_version: 1
name: passing
duration_s: 200
step_s: 10
region: {origin: {latitude_deg: 52, longitude_deg: 5}, size_m: [40000, 40000, 5000], dims: [20, 20, 10]}
platforms:
  - {name: site, position: {latitude_deg: 52, longitude_deg: 5, height_agl_m: 20}}
  - name: aircraft
    track:
      outside: )" + std::string(outside) +
                           R"(
      points:
        - {t_s: 100, latitude_deg: 52.1, longitude_deg: 5, height_msl_m: 3000}
        - {t_s: 130, latitude_deg: 52.12, longitude_deg: 5.1, height_msl_m: 3000}
emitters:
  - name: radar
    platform: site
    kind: radar
    frequency_hz: 3.0e9
    power_w: 50000
    antenna: {pattern: gaussian, gain_dbi: 33, beamwidth_az_deg: 2, beamwidth_el_deg: 8}
    scan: {kind: rotate, rate_rpm: 6}
    receiver: {noise_figure_db: 4, bandwidth_hz: 1.0e6}
  - {name: jammer, platform: aircraft, kind: jammer, frequency_hz: 3.0e9, bandwidth_hz: 1.0e6, power_w: 1, antenna: {pattern: isotropic}}
receivers:
  - {name: warning, platform: aircraft, gain_dbi: 0, noise_figure_db: 5, bandwidth_hz: 1.0e6, center_frequency_hz: 3.0e9}
targets:
  - {name: skin, platform: aircraft, rcs_m2: 5}
)";
  return Given(folder.write(std::string(outside) + ".yaml", text), nullptr);
}

TEST(Exposure, AbsentPlatformHasNoValuesAndIsNoGap) {
  const TemporaryFolder folder;
  const Given given = passingAircraft(folder);
  ExposureRequest request;
  request.platform = 1;
  request.quantity = scenario::Quantity::power_density_dbwm2;
  request.threshold = -190;
  for (int t = 0; t <= 200; t += 10) request.times_s.push_back(t);
  const Exposure exposure = computeExposure(given.scenario, given.terrain, request, {});
  for (const ExposureRow& row : exposure.rows) {
    const bool is_there = row.time_s >= 100 && row.time_s <= 130;
    EXPECT_EQ(row.state == ExposureState::absent, !is_there) << row.time_s;
    EXPECT_EQ(std::isnan(row.latitude_deg), !is_there);
    EXPECT_EQ(std::isnan(row.value), !is_there);
  }
  EXPECT_EQ(exposure.together.unknown_fraction, 0) << "absence is not unknown";
  EXPECT_GT(exposure.together.fraction, 0.9) << "of the time in which it is there";
  EXPECT_THAT(exposure.warnings,
              testing::Contains(HasSubstr("'aircraft' is absent at 17 of 21 times, which have no values: its "
                                          "track runs from 100 to 130 s")));
  request.times_s = {0, 10};
  EXPECT_THAT(
      test::errorOf([&] { computeExposure(given.scenario, given.terrain, request, {}); }, ErrorCode::usage),
      HasSubstr("'aircraft' is absent at t = 0 s"));
}

TEST(Links, AbsentEndsHaveNoPath) {
  const TemporaryFolder folder;
  for (const char* outside : {"absent", "hold"}) {
    const Given given = passingAircraft(folder, outside);
    emfield::LinkOptions options;
    options.times_s = {0, 100, 110, 130, 140};
    options.emitters = {0};
    options.receivers = {0};
    options.targets = {0};
    const emfield::LinkReport report = emfield::computeLinks(given.scenario, nullptr, options);
    ASSERT_EQ(report.links.size(), 1u);
    ASSERT_EQ(report.detections.size(), 1u);
    for (std::size_t t = 0; t < options.times_s.size(); ++t) {
      const double time_s = options.times_s[t];
      const bool is_there = std::string(outside) == "hold" || (time_s >= 100 && time_s <= 130);
      EXPECT_EQ(report.links[0].rows[t].has_path, is_there) << outside << " " << time_s;
      EXPECT_EQ(std::isfinite(report.links[0].rows[t].received_power_dbm), is_there);
      EXPECT_EQ(report.detections[0].rows[t].has_path, is_there);
      EXPECT_EQ(std::isfinite(report.detections[0].rows[t].snr_db), is_there);
      if (is_there) continue;
      EXPECT_EQ(report.detections[0].rows[t].looks, 0);
      EXPECT_THAT(report.links[0].rows[t].verdict, HasSubstr("No path: 'aircraft' is absent at t = "));
    }
    // Its jammer does not jam while it is absent, and explains itself.
    const scenario::Snapshot early = scenario::instantAt(given.scenario, nullptr, 0);
    EXPECT_EQ(early.emitters[1].active, std::string(outside) == "hold");
    if (early.platforms[1].present) continue;
    EXPECT_THAT(test::errorOf(
                    [&] {
                      emfield::pathBudget(early, 1, {early.platforms[0].position, 20},
                                          propagation::PropagationModel::diffraction, nullptr);
                    },
                    ErrorCode::usage),
                HasSubstr("'aircraft' is absent at t = 0 s"));
  }
}

TEST(Exposure, DetectionEqualsLinkToTheTarget) {
  const Given given("links.yaml");
  emfield::LinkOptions options;
  for (int t = 0; t <= 60; t += 3) options.times_s.push_back(t);
  options.emitters = {0};
  options.targets = {0, 1};
  const emfield::LinkReport links = emfield::computeLinks(given.scenario, given.terrain.get(), options);
  for (const emfield::Detection& detection : links.detections) {
    ExposureRequest request;
    request.target = detection.target;
    request.platform = given.scenario->targets[static_cast<std::size_t>(detection.target)].platform;
    request.times_s = options.times_s;
    const Exposure exposure = computeExposure(given.scenario, given.terrain, request, {});
    ASSERT_EQ(exposure.names, std::vector<std::string>{"search radar"});
    ASSERT_EQ(exposure.rows.size(), detection.rows.size());
    for (std::size_t t = 0; t < exposure.rows.size(); ++t) {
      EXPECT_NEAR(exposure.rows[t].each[0], detection.rows[t].detection_probability, 2e-3) << t;
      EXPECT_NEAR(exposure.rows[t].value, exposure.rows[t].each[0], 1e-6);
      EXPECT_NEAR(exposure.rows[t].cumulative_probability, detection.rows[t].cumulative_probability, 5e-3);
    }
    EXPECT_EQ(exposure.together.first_s, detection.firstDetection_s());
    EXPECT_THAT(exposure.cross_section, HasSubstr("that of target"));
  }
}

TEST(Exposure, NamesWhatDecidesWhereTheThresholdIsNotReached) {
  const Given given("links.yaml");
  ExposureRequest request;
  request.platform = 3;
  ASSERT_EQ(given.scenario->platforms[3].name, "helicopter");
  request.times_s = {0, 10, 20, 40};
  const Exposure exposure = computeExposure(given.scenario, given.terrain, request, {});
  for (const ExposureRow& row : exposure.rows)
    EXPECT_EQ(row.decides.has_value(), row.state == ExposureState::below) << row.time_s;
  EXPECT_EQ(exposure.rows.front().decides, emfield::PathCause::terrain) << "behind the ridge";
}

TEST(Exposure, ThePlatformsOwnEmittersAreLeftOut) {
  const Given given("jacksboro.yaml");
  constexpr int kHelicopter = 3;
  ExposureRequest request;
  request.platform = kHelicopter;
  request.times_s = {60, 90};
  const Exposure detected = computeExposure(given.scenario, given.terrain, request, {});
  EXPECT_EQ(detected.names, (std::vector<std::string>{"search radar", "tracking radar"}));
  auto quiet = std::make_shared<scenario::Scenario>(*given.scenario);
  quiet->set("emitters.jammer.active_s", "[[0, 1]]");
  const Exposure unjammed = computeExposure(quiet, given.terrain, request, {});
  EXPECT_LT(detected.rows[1].each[0], 0.5) << "its jammer protects it";
  EXPECT_GT(unjammed.rows[1].each[0], 0.9);
  request.quantity = scenario::Quantity::power_density_dbwm2;
  request.threshold = -60;
  EXPECT_EQ(computeExposure(given.scenario, given.terrain, request, {}).names.size(), 3u);
}

TEST(Exposure, WarnsIfAllRadarsAreOnThePlatform) {
  const Given given("jamming.yaml");
  ExposureRequest request;
  request.platform = given.scenario->emitters.front().platform;
  request.times_s = {0, 10};
  auto alone = std::make_shared<scenario::Scenario>(*given.scenario);
  alone->emitters.resize(1);
  const Exposure exposure = computeExposure(alone, given.terrain, request, {});
  EXPECT_TRUE(exposure.names.empty());
  EXPECT_THAT(exposure.warnings, ::testing::Contains(HasSubstr("radars are on platform")));
}

TEST(Exposure, AWarningComesOnceForAllTimes) {
  const Given given("jacksboro.yaml");
  auto scenario = std::make_shared<scenario::Scenario>(*given.scenario);
  scenario->set("emitters.search radar.propagation", "parabolic_equation");
  scenario->set("emitters.search radar.frequency_hz", "25e9");  // above what was measured
  ExposureRequest request;
  while (given.scenario->platforms[static_cast<std::size_t>(request.platform)].name != "helicopter")
    ++request.platform;
  for (int t = 0; t < 80; ++t) request.times_s.push_back(t);  // three groups that are solved at once
  const Exposure exposure = computeExposure(scenario, given.terrain, request, {});
  EXPECT_THAT(exposure.warnings,
              ::testing::Contains(::testing::AllOf(HasSubstr("'search radar'"), HasSubstr("frequency"),
                                                   ::testing::Not(HasSubstr("times)"))))
                  .Times(1));
}

TEST(Exposure, TimesOverMissingTerrainAreUnknown) {
  // To the east, out of the elevation file, and back.
  const TemporaryFolder folder;
  const std::string track = folder.write("track.csv",
                                         "t_s,latitude_deg,longitude_deg,height_msl_m\n"
                                         "0,36.30,-84.20,1500\n"
                                         "100,36.30,-83.95,1500\n"
                                         "200,36.30,-84.20,1500\n");
  auto scenario =
      std::make_shared<scenario::Scenario>(*scenario::loadScenario(test::shippedScenario("links.yaml")));
  scenario->set("platforms.drone.track.file", track);
  ExposureRequest request;
  request.platform = 4;
  for (int t = 0; t <= 200; t += 5) request.times_s.push_back(t);
  const Exposure exposure = computeExposure(scenario, scenario::loadTerrain(*scenario), request, {});
  double unknown_s = 0, reached_s = 0;
  for (std::size_t t = 0; t + 1 < exposure.rows.size(); ++t) {
    const ExposureRow& row = exposure.rows[t];
    EXPECT_EQ(row.state == ExposureState::unknown, row.longitude_deg > -84.078) << row.time_s;
    EXPECT_EQ(row.state == ExposureState::unknown, std::isnan(row.value)) << row.time_s;
    unknown_s += row.state == ExposureState::unknown ? 5 : 0;
    reached_s += row.state == ExposureState::reached ? 5 : 0;
  }
  EXPECT_DOUBLE_EQ(exposure.together.unknown_fraction, unknown_s / 200);
  EXPECT_DOUBLE_EQ(exposure.together.fraction, reached_s / (200 - unknown_s));
  EXPECT_LT(exposure.together.longest_gap_s, 50) << "unknown times are no gap";
  EXPECT_GT(unknown_s, 90);
}

TEST(Exposure, RefusesInvalidOptions) {
  const Given given("links.yaml");
  const auto refusalOf = [&](const ExposureRequest& request) {
    return test::errorOf([&] { computeExposure(given.scenario, given.terrain, request, {}); });
  };
  ExposureRequest request;
  request.platform = 3;
  EXPECT_THAT(refusalOf(request), HasSubstr("needs a time"));
  request.times_s = {0};
  request.target = 1;
  EXPECT_THAT(refusalOf(request), HasSubstr("target 'drone' is on platform 'drone', not on 'helicopter'"));
  request.target.reset();
  request.quantity = scenario::Quantity::dominant_emitter;
  EXPECT_THAT(refusalOf(request), HasSubstr("is an index"));
}

TEST(Exposure, StepsLongerThanScanAreReported) {
  const Given given("links.yaml");
  ExposureRequest request;
  request.platform = 4;
  request.times_s = {0, 4, 8};
  request.look = scenario::RadarAim::scan;
  const Exposure exposure = computeExposure(given.scenario, given.terrain, request, {});
  EXPECT_THAT(exposure.warnings, testing::Contains(HasSubstr("passes the platform every 5 s")));
  EXPECT_TRUE(std::isnan(exposure.together.cumulative_probability));
}

TEST(Exposure, TellsOfLooksThatFallBetweenTwoTimesAndWhenAllLooksReachTheThreshold) {
  const Given given("links.yaml");
  ExposureRequest request;
  request.platform = 4;
  request.times_s = {0, 4, 8, 12, 16, 20};
  const auto looks = ::testing::Contains(HasSubstr(" looks, one every "));
  const Exposure fine = computeExposure(given.scenario, given.terrain, request, {});
  EXPECT_THAT(fine.warnings, ::testing::Not(looks));
  request.times_s = {0, 20};
  const Exposure coarse = computeExposure(given.scenario, given.terrain, request, {});
  EXPECT_THAT(coarse.warnings, looks);
  EXPECT_THAT(coarse.warnings, ::testing::Contains(HasSubstr("s or less take each look by itself")));
  std::optional<double> first_s;
  for (const ExposureRow& row : fine.rows)
    if (!first_s && row.cumulative_probability >= request.threshold) first_s = row.time_s;
  EXPECT_EQ(fine.together.cumulative_first_s, first_s);
  request.look = scenario::RadarAim::scan;
  EXPECT_THAT(computeExposure(given.scenario, given.terrain, request, {}).warnings, ::testing::Not(looks));
}

TEST(Exposure, CarriesTheWarningsOfTheScenariosCheck) {
  const auto scenario = scenario::loadScenario(test::shippedScenario("links.yaml"),
                                               {{"emitters.search radar.receiver.bandwidth_hz", "1"}});
  ExposureRequest request;
  request.platform = 4;
  request.times_s = {0};
  EXPECT_THAT(computeExposure(scenario, scenario::loadTerrain(*scenario), request, {}).warnings,
              ::testing::Contains(HasSubstr("is 1 Hz wide")));
}

}  // namespace
}  // namespace emscape::study
