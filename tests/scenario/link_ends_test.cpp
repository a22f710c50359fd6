// Receivers and targets on platforms: reading, errors and edits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "emscape/base/units.h"
#include "emscape/scenario/file/scenario_file.h"
#include "propagation/air/sky_noise.h"
#include "tests/scenario/scenario_files.h"

namespace emscape::scenario {
namespace {

using ::testing::HasSubstr;

class LinkEnds : public ::testing::Test {
 protected:
  ParseResult parse(const std::string& sections) {
    return parseScenario(folder_.write("links.yaml", R"(schema_version: 1
name: links
region: {origin: {latitude_deg: 50, longitude_deg: 8}, size_m: [1e4, 1e4, 1e3], dims: [4, 4, 4]}
platforms: [{name: site, position: {latitude_deg: 50, longitude_deg: 8, height_agl_m: 10}}, {name: balloon, position: {latitude_deg: 50, longitude_deg: 8, height_agl_m: 900}}]
emitters:
  - {name: mast, platform: site, kind: transmitter, frequency_hz: 4e8, power_w: 1, antenna: {pattern: isotropic}}
)" + sections));
  }
  /// All problems of a scenario that is refused.
  std::string refusal(const std::string& sections) {
    const ParseResult result = parse(sections);
    EXPECT_FALSE(result.scenario) << sections;
    return test::messagesOf(result);
  }
  std::shared_ptr<const Scenario> valid(const std::string& sections) {
    const ParseResult result = parse(sections);
    EXPECT_TRUE(result.problems.empty()) << result.problems.front().message;
    return result.scenario;
  }
  void writeTable(const std::string& rows) {
    folder_.write("rcs.csv", "azimuth_deg,elevation_deg,rcs_dbsm\n" + rows);
  }

  test::TemporaryFolder folder_;
};

TEST_F(LinkEnds, ReceiverWithoutPlatformIsAtEveryVoxel) {
  const auto scenario = valid(R"(receivers:
  - {name: everywhere, gain_dbi: 3}
  - name: post
    platform: site
    antenna: {pattern: gaussian, gain_dbi: 12, beamwidth_az_deg: 30, beamwidth_el_deg: 30}
    scan: {kind: fixed, azimuth_deg: 45}
    noise_figure_db: 6
    bandwidth_hz: 25.0e3
    sensitivity_dbm: -100
  - {name: whip, platform: site, gain_dbi: 2, noise_figure_db: 8, bandwidth_hz: 1.0e6, required_sinr_db: 10}
)");
  ASSERT_TRUE(scenario);
  ASSERT_EQ(scenario->receivers.size(), 1u);
  EXPECT_EQ(scenario->receivers[0].name, "everywhere");
  ASSERT_EQ(scenario->placed_receivers.size(), 2u);
  const PlacedReceiver& post = scenario->placed_receivers[0];
  EXPECT_EQ(post.platform, 0);
  EXPECT_EQ(post.antenna->gain_dbi, 12);
  EXPECT_EQ(post.scan.azimuth_deg, 45);
  EXPECT_EQ(post.sensitivity_dbm, -100);
  EXPECT_EQ(post.antenna_temperature_k, 290);
  const PlacedReceiver& whip = scenario->placed_receivers[1];
  EXPECT_EQ(whip.antenna->gain_dbi, 2);
  EXPECT_EQ(whip.required_sinr_db, 10);
}

TEST_F(LinkEnds, SkyNoiseDependsOnFrequencyAndElevation) {
  const auto scenario = valid(R"(atmosphere: {refraction: exponential, vapour_g_m3: 3}
receivers:
  - name: post
    platform: site
    antenna: {pattern: gaussian, gain_dbi: 12, beamwidth_az_deg: 30, beamwidth_el_deg: 30}
    scan: {kind: fixed, elevation_deg: 20}
    noise_figure_db: 6
    bandwidth_hz: 25.0e3
    center_frequency_hz: 10.0e9
    antenna_noise: sky
)");
  ASSERT_TRUE(scenario);
  EXPECT_EQ(scenario->atmosphere.refraction, propagation::RefractionProfile::exponential);
  propagation::Atmosphere air;
  air.vapour_g_m3 = 3;
  EXPECT_DOUBLE_EQ(
      scenario->placed_receivers[0].antenna_temperature_k,
      propagation::antennaTemperature_k(
          10e9, degToRad(20.0), degToRad(scenario->placed_receivers[0].antenna->beamwidth_el_deg), air));
}

TEST_F(LinkEnds, TheSkysNoiseNeedsAFrequencyAndNoOtherTemperature) {
  const auto receiver = [this](const std::string& keys) {
    return refusal(
        "receivers: [{name: post, platform: site, noise_figure_db: 6, bandwidth_hz: 1.0e6, antenna_noise: "
        "sky" +
        keys + "}]\n");
  };
  EXPECT_THAT(receiver(""), HasSubstr("'antenna_noise' needs the receiver's 'center_frequency_hz'"));
  EXPECT_THAT(receiver(", center_frequency_hz: 1.0e9, antenna_temperature_k: 50"),
              HasSubstr("'antenna_temperature_k' and 'antenna_noise' exclude each other"));
}

TEST_F(LinkEnds, IncompleteReceiversAreRefused) {
  const auto receiver = [this](const std::string& keys) {
    return refusal("receivers: [{name: post, " + keys + "}]\n");
  };
  EXPECT_THAT(receiver("platform: site, bandwidth_hz: 1e6"), HasSubstr("'noise_figure_db'"));
  EXPECT_THAT(receiver("platform: site, noise_figure_db: 3"), HasSubstr("'bandwidth_hz'"));
  EXPECT_THAT(receiver("scan: {kind: fixed}, antenna: {pattern: isotropic}"), HasSubstr("'platform'"));
  EXPECT_THAT(receiver("platform: sight, noise_figure_db: 3, bandwidth_hz: 1e6"),
              HasSubstr("there is no platform 'sight'"));
  EXPECT_THAT(receiver("platform: site, noise_figure_db: 3, bandwidth_hz: 1e6, gain_dbi: 3, antenna: "
                       "{pattern: isotropic}"),
              HasSubstr("'antenna' has its own gain"));
}

TEST_F(LinkEnds, AReceiversGainAboveItsPatternsDirectivityIsAWarning) {
  const ParseResult result = parse(R"(receivers:
  - {name: whip, platform: site, gain_dbi: 9, noise_figure_db: 8, bandwidth_hz: 1.0e6}
  - name: post
    platform: site
    antenna: {pattern: gaussian, gain_dbi: 30, beamwidth_az_deg: 30, beamwidth_el_deg: 30}
    noise_figure_db: 6
    bandwidth_hz: 25.0e3
)");
  ASSERT_TRUE(result.scenario);
  ASSERT_EQ(result.problems.size(), 1u);
  EXPECT_THAT(result.problems[0].message, HasSubstr("the gain of 30.00 dBi is "));
  EXPECT_THAT(result.problems[0].message, HasSubstr("would receive more power than reaches it"));
  EXPECT_EQ(result.problems[0].location.line, 11);
}

TEST_F(LinkEnds, QuantitiesOfAReceiverNameItAndTheWantedEmitter) {
  const std::string receivers = R"(receivers:
  - {name: plain}
  - {name: radio, noise_figure_db: 6, bandwidth_hz: 25.0e3, required_sinr_db: 10}
  - {name: warner, sensitivity_dbm: -60}
)";
  const auto scenario =
      valid(receivers +
            "output: {quantities: [sinr_db, intercept_margin_db], receiver: radio, wanted_emitter: mast}\n");
  ASSERT_TRUE(scenario);
  EXPECT_EQ(scenario->output.receiver, 1);
  EXPECT_EQ(scenario->output.wanted_emitter, 0);
  EXPECT_EQ(scenario->receivers[1].noise_figure_db, 6);
  Scenario edited = *scenario;
  edited.set({{"output.receiver", "warner"}, {"output.quantities", "[intercept_margin_db]"}});
  EXPECT_EQ(edited.output.receiver, 2);
}

TEST_F(LinkEnds, MissingInputOfReceiverQuantitiesIsNamedOnce) {
  const std::string radio =
      "receivers: [{name: plain}, {name: radio, noise_figure_db: 6, bandwidth_hz: 25.0e3}]\n";
  const auto faultOf = [&](const std::string& output) {
    const std::string all = refusal(radio + "output: {" + output + "}\n");
    EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 1) << all;
    return all;
  };
  EXPECT_THAT(faultOf("quantities: [sinr_db]"), HasSubstr("sinr_db needs 'wanted_emitter' in the output"));
  EXPECT_THAT(faultOf("quantities: [sinr_db], receiver: radio, wanted_emitter: mist"),
              HasSubstr("there is no emitter 'mist'; did you mean 'mast'?"));
  EXPECT_THAT(faultOf("quantities: [sinr_db], receiver: rodio, wanted_emitter: mast"),
              HasSubstr("there is no receiver without a platform 'rodio'"));
  EXPECT_THAT(
      faultOf("quantities: [sinr_db], wanted_emitter: mast"),
      HasSubstr("sinr_db needs the noise of the receiver 'plain': its noise_figure_db and bandwidth_hz"));
  EXPECT_THAT(faultOf("quantities: [intercept_margin_db], receiver: radio"),
              HasSubstr("intercept_margin_db needs a threshold of the receiver 'radio'"));
  EXPECT_THAT(faultOf("quantities: [sinr_db], receiver: radio, wanted_emitter: mast, interval: {kind: mean}"),
              HasSubstr("sinr_db has no meaning over an interval of kind mean"));
  EXPECT_THAT(refusal("output: {quantities: [sinr_db], wanted_emitter: mast}\n"),
              HasSubstr("sinr_db needs a receiver without a platform; the scenario has none"));
  EXPECT_THAT(
      refusal("receivers: [{name: radio, noise_figure_db: 6, bandwidth_hz: 25.0e3, "
              "center_frequency_hz: 4.1e8}]\noutput: {quantities: [sinr_db], wanted_emitter: mast}\n"),
      HasSubstr("the wanted emitter 'mast' (400000000 Hz, 0 Hz wide) is outside the band"));
}

TEST_F(LinkEnds, ATargetHasOneCrossSectionOrATable) {
  writeTable(
      "0,-90,0\n0,0,10\n0,90,0\n90,-90,0\n90,0,20\n90,90,0\n180,-90,0\n180,0,10\n180,90,0\n-90,-90,0\n"
      "-90,0,20\n-90,90,0\n");
  const auto scenario = valid(R"(targets:
  - {name: balloon, platform: site, rcs_m2: 0.5, swerling: 0}
  - {name: aircraft, platform: site, rcs_file: rcs.csv}
)");
  ASSERT_TRUE(scenario);
  ASSERT_EQ(scenario->targets.size(), 2u);
  EXPECT_EQ(scenario->targets[0].rcsTowards_m2(12, 34), 0.5);
  EXPECT_EQ(scenario->targets[0].swerling, 0);
  const Target& aircraft = scenario->targets[1];
  EXPECT_EQ(aircraft.swerling, 1);
  EXPECT_NEAR(aircraft.table->rcs_dbsm(0, 0), 10, 1e-12);
  EXPECT_NEAR(aircraft.table->rcs_dbsm(45, 0), 15, 1e-12);
  EXPECT_NEAR(aircraft.table->rcs_dbsm(-135, 0), 15, 1e-12);
  EXPECT_NEAR(aircraft.table->rcs_dbsm(90, 45), 10, 1e-12);
  EXPECT_NEAR(aircraft.rcsTowards_m2(90, 0), 100, 1e-9);
}

TEST_F(LinkEnds, AFluctuatingTargetOfARadarForSteadyTargetsIsWarnedOfOnce) {
  const auto with = [this](const std::string& detection) {
    std::string radars;
    for (const std::string name : {"near", "far"}) {
      radars += "  - {name: " + name +
                ", platform: site, kind: radar, frequency_hz: 3e9, power_w: 1e4, "
                "antenna: {pattern: isotropic}, receiver: {noise_figure_db: 4, bandwidth_hz: 1e6, "
                "swerling: 0, target_rcs_m2: 1, detection: " +
                detection + "}}\n";
    }
    return parse(radars + R"(targets:
  - {name: own, platform: site, rcs_m2: 1}
  - {name: steady, platform: balloon, rcs_m2: 1, swerling: 0}
  - {name: aircraft, platform: balloon, rcs_m2: 1}
)");
  };
  const ParseResult result = with("albersheim");
  ASSERT_TRUE(result.scenario);
  ASSERT_EQ(result.problems.size(), 1u);
  EXPECT_EQ(result.problems[0].severity, Severity::warning);
  EXPECT_EQ(result.problems[0].message,
            "the target 'aircraft' of swerling 1 is taken as steady (swerling 0) by radars whose 'detection' "
            "is albersheim: 'near', 'far'");
  EXPECT_TRUE(with("shnidman").problems.empty());
}

TEST_F(LinkEnds, FaultsOfTargetsAndTheirTablesAreNamed) {
  EXPECT_THAT(refusal("targets: [{name: t, platform: site}]\n"), HasSubstr("rcs_m2"));
  EXPECT_THAT(refusal("targets: [{name: t, platform: site, rcs_file: none.csv}]\n"), HasSubstr("none.csv"));
  const std::string target = "targets: [{name: t, platform: site, rcs_file: rcs.csv}]\n";
  writeTable("0,-90,0\n0,0,x\n");
  const ParseResult result = parse(target);
  ASSERT_EQ(result.problems.size(), 1u);
  EXPECT_EQ(result.problems[0].location.line, 3);
  EXPECT_THAT(result.problems[0].message, HasSubstr("rcs_dbsm is 'x', not a number"));
  writeTable("0,-90,0\n0,90,0\n");
  EXPECT_THAT(refusal(target), HasSubstr("gaps of up to 90 deg are allowed"));
}

TEST_F(LinkEnds, AreEdited) {
  const auto scenario = valid(R"(receivers:
  - {name: whip, platform: site, noise_figure_db: 8, bandwidth_hz: 1.0e6}
targets: [{name: balloon, platform: site, rcs_m2: 0.5}]
)");
  ASSERT_TRUE(scenario);
  Scenario edited = *scenario;
  edited.set({{"receivers.whip.noise_figure_db", "3"}, {"targets.balloon.rcs_m2", "2"}});
  EXPECT_EQ(edited.placed_receivers[0].noise_figure_db, 3);
  EXPECT_EQ(edited.targets[0].rcs_m2, 2);
  EXPECT_NE(edited.hash, scenario->hash);
}

}  // namespace
}  // namespace emscape::scenario
