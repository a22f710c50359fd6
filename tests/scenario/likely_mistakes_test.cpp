/// Warnings of what a scenario says but hardly means: positions, speeds, gains, widths, steps.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/units.h"
#include "emscape/scenario/file/scenario_file.h"
#include "scenario/file/far_outside.h"
#include "tests/scenario/scenario_files.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::scenario {
namespace {

using test::messagesOf;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(LikelyMistakes, EmittersOutsideTheRegionAreToldWithTheDistance) {
  const Region region = loadScenario(test::shippedScenario("quick.yaml"))->region;
  const auto eastBy = [&](double outside_m) {
    const GeodeticPosition at = geodesicDirect(region.origin.latitude_deg, region.origin.longitude_deg,
                                               kPi / 2, region.size_m.x / 2 + outside_m);
    return messagesOf("quick.yaml",
                      {{"platforms.mast.position.latitude_deg", fmt::format("{}", at.latitude_deg)},
                       {"platforms.mast.position.longitude_deg", fmt::format("{}", at.longitude_deg)}});
  };
  EXPECT_THAT(eastBy(700), HasSubstr("emitter 'transmitter' is outside the region, 700 m from it"));
  EXPECT_THAT(eastBy(2500), HasSubstr("is outside the region, 2.5 km from it"));
  EXPECT_THAT(eastBy(-100), Not(HasSubstr("outside the region")));
}

TEST(LikelyMistakes, PositionsThousandsOfKilometresAwayAreToldWithTheExchangeThatBringsThemNear) {
  const auto at = [](const std::string& latitude, const std::string& longitude) {
    return messagesOf("quick.yaml", {{"platforms.mast.position.latitude_deg", latitude},
                                     {"platforms.mast.position.longitude_deg", longitude}});
  };
  const auto scenario = loadScenario(test::shippedScenario("quick.yaml"));
  const SitePosition& mast = scenario->platforms.at(0).track.at(0).position;
  const std::string latitude = std::to_string(mast.latitude_deg),
                    longitude = std::to_string(mast.longitude_deg);
  EXPECT_THAT(at(longitude, latitude),
              AllOf(HasSubstr("platform 'mast': its position is "), HasSubstr(" km outside the region"),
                    HasSubstr("perhaps latitude and longitude are exchanged")));
  EXPECT_THAT(at("-" + latitude, longitude), HasSubstr("perhaps latitude has the other sign"));
  EXPECT_THAT(at("0", "100"), AllOf(HasSubstr("km outside the region"), Not(HasSubstr("perhaps"))));
  EXPECT_THAT(at(latitude, longitude), Not(HasSubstr("outside the region")));
  const Region& region = scenario->region;
  EXPECT_EQ(farOutsideText(region, {{mast.longitude_deg, mast.latitude_deg, 0},
                                    {mast.latitude_deg, mast.longitude_deg, 0}}),
            "")
      << "one is near";
  EXPECT_EQ(farOutsideText(region, {}), "");
}

TEST(LikelyMistakes, TracksFasterThanAnyObjectAreTold) {
  const auto track = [](const std::string& last) {
    return messagesOf("quick.yaml", {{"platforms.mast.position", "null"},
                                     {"platforms.mast.track",
                                      "{points: [{t_s: 0, latitude_deg: 52, longitude_deg: 5, height_agl_m: "
                                      "50}, {t_s: 4, latitude_deg: " +
                                          last + ", longitude_deg: 5, height_agl_m: 50}]}"}});
  };
  EXPECT_THAT(track("53"), HasSubstr("the track of 'mast' moves 111.3 km from 0 to 4 s, at 27.82 km/s"));
  EXPECT_THAT(track("52.1"), Not(HasSubstr("faster than any object")));
}

TEST(LikelyMistakes, GainsWidthsAndStepsThatAreHardlyMeantAreTold) {
  EXPECT_THAT(messagesOf("quick.yaml", {{"emitters.radar.antenna.gain_dbi", "-32"}}),
              HasSubstr("the gain of -32.00 dBi is "));
  EXPECT_THAT(messagesOf("quick.yaml", {{"emitters.radar.receiver.bandwidth_hz", "1"}}),
              HasSubstr("the receiver of radar 'radar' is 1 Hz wide, narrower than"));
  EXPECT_THAT(messagesOf("quick.yaml", {{"step_s", "100"}, {"duration_s", "60"}}),
              HasSubstr("'step_s' of 100 s is longer than 'duration_s', 60 s: there is one step"));
}

TEST(LikelyMistakes, FrequenciesOutsideThoseOfAnAntennasFileAreTold) {
  const test::TemporaryFolder folder;
  const std::string cuts =
      "\nGAIN 12 dBi\nHORIZONTAL 4\n0 0\n90 10\n180 20\n270 10\nVERTICAL 4\n0 0\n90 15\n180 20\n270 16\n";
  const auto at = [&](const std::string& frequency_hz, const std::string& stated) {
    const std::string file = folder.write("a.msi", stated + cuts);
    const std::vector<Edit> edits{{"emitters.transmitter.antenna", "{pattern: file, file: " + file + "}"},
                                  {"emitters.transmitter.frequency_hz", frequency_hz}};
    return messagesOf("quick.yaml", edits);
  };
  EXPECT_THAT(at("450e6", "FREQUENCY 880-960"),
              HasSubstr("emitter 'transmitter' transmits at 450 MHz, but the file of its antenna is for 880 "
                        "MHz to 960 MHz: gain and pattern may be others"));
  EXPECT_THAT(at("900e6", "FREQUENCY 880-960"), Not(HasSubstr("the file of its antenna")));
  EXPECT_THAT(at("1e9", "FREQUENCY 900"), Not(HasSubstr("the file of its antenna"))) << "around it";
  EXPECT_THAT(at("1.3e9", "FREQUENCY 900"), HasSubstr("is for 900 MHz: "));
  EXPECT_THAT(at("1.3e9", ""), Not(HasSubstr("the file of its antenna")));
}

TEST(LikelyMistakes, AreNotToldOfShippedScenarios) {
  for (const char* name : {"quick.yaml", "jacksboro.yaml", "links.yaml", "clutter.yaml", "jamming.yaml",
                           "ship_duct.yaml", "interval.yaml", "sinr.yaml"}) {
    EXPECT_THAT(messagesOf(name, {}),
                AllOf(Not(HasSubstr("of its power")), Not(HasSubstr("Hz wide, narrower")),
                      Not(HasSubstr("is longer than 'duration_s'")), Not(HasSubstr("faster than any")),
                      Not(HasSubstr("km outside")), Not(HasSubstr("narrower than the voxels"))))
        << name;
  }
}

/// The scenario of the README's first steps with a radar that stands still.
std::string narrowBeamOf(std::vector<Edit> edits) {
  edits.insert(edits.begin(), {{"region.size_m", "[40000, 40000, 4000]"},
                               {"duration_s", "0"},
                               {"region.dims", "[80, 80, 40]"},
                               {"output.quantities", "[detection_probability]"},
                               {"emitters.radar.scan", "null"},
                               {"emitters.radar.antenna.beamwidth_az_deg", "1.5"}});
  return messagesOf("quick.yaml", edits);
}

TEST(LikelyMistakes, BeamsBetweenTheVoxelsAreToldWithWhatHelps) {
  const std::string told = narrowBeamOf({});
  EXPECT_THAT(told, AllOf(HasSubstr("the beam of 'radar', 1.5 deg in azimuth, is narrower than the voxels of "
                                    "500 m up to 19.1 km"),
                          HasSubstr("does not turn: 'scan: {kind: rotate, rate_rpm: 12}' and 'output: "
                                    "{radar_look: target}' have it on each voxel"),
                          Not(HasSubstr("turns it")), Not(HasSubstr("has the beam on each voxel"))));
  const std::string before = "'region: {dims: ";
  const std::size_t from = told.find(before) + before.size();
  const std::string finer = told.substr(from, told.find(']', from) + 1 - from);
  EXPECT_THAT(narrowBeamOf({{"region.dims", finer}}), Not(HasSubstr("narrower than the voxels"))) << finer;
  EXPECT_THAT(
      narrowBeamOf({{"region.dims", "[80, 80, 400]"}, {"emitters.radar.antenna.beamwidth_az_deg", "0.1"}}),
      AllOf(HasSubstr("narrower than the voxels"), Not(HasSubstr("region: {dims"))))
      << "no more voxels than a scenario may have";
  EXPECT_THAT(
      narrowBeamOf({{"region.size_m", "[1, 1, 4e6]"}, {"emitters.radar.antenna.beamwidth_el_deg", "0.001"}}),
      Not(HasSubstr("region: {dims")));
  EXPECT_THAT(narrowBeamOf({{"output.radar_look", "target"}}),
              HasSubstr("does not turn, also with 'radar_look: target': 'scan: {kind: rotate, rate_rpm: 12}' "
                        "turns it"));
  const Edit turning{"emitters.radar.scan", "{kind: rotate, rate_rpm: 12}"};
  EXPECT_THAT(narrowBeamOf({turning, {"output.radar_look", "target"}}),
              Not(HasSubstr("narrower than the voxels")));
  EXPECT_THAT(narrowBeamOf({turning, {"output.quantities", "[power_density_dbwm2]"}}),
              HasSubstr("'output: {interval: {kind: max_hold, turns: 1}}' has all that it passes"));
  EXPECT_THAT(
      narrowBeamOf(
          {turning, {"output.quantities", "[power_density_dbwm2]"}, {"duration_s", "60"}, {"step_s", "1"}}),
      Not(HasSubstr("narrower than the voxels")))
      << "another time has it elsewhere";
  EXPECT_THAT(narrowBeamOf({turning,
                            {"output.quantities", "[power_density_dbwm2]"},
                            {"output.interval", "{kind: max_hold, turns: 1}"}}),
              Not(HasSubstr("narrower than the voxels")));
  EXPECT_THAT(
      narrowBeamOf(
          {turning, {"output.radar_look", "target"}, {"emitters.radar.antenna.beamwidth_el_deg", "0.5"}}),
      HasSubstr("0.5 deg in elevation, is narrower than the voxels of 100 m"))
      << "the beam stays at its elevation";
  EXPECT_THAT(narrowBeamOf({turning}),
              HasSubstr("'output: {radar_look: target}' has the beam on each voxel"));
}

TEST(LikelyMistakes, BeamsBetweenTheVoxelsAreThoseOfRolledPlatformsToo) {
  const auto rolledBy = [](int roll_deg) {
    return narrowBeamOf({{"platforms.radar site.attitude", fmt::format("{{roll_deg: {}}}", roll_deg)},
                         {"emitters.radar.scan", "{kind: fixed, azimuth_deg: 20}"},
                         {"emitters.radar.antenna.beamwidth_az_deg", "60"},
                         {"emitters.radar.antenna.beamwidth_el_deg", "0.5"}});
  };
  const std::string level = rolledBy(0), rolled = rolledBy(90);
  EXPECT_THAT(level, AllOf(HasSubstr("0.5 deg in elevation, is narrower than the voxels of 100 m up to"),
                           HasSubstr("'region: {dims: [80, 80, ")));
  // Of voxels five times wider than high: 500 m cos(60 deg) is more than 100 m sin(60 deg).
  EXPECT_THAT(rolledBy(60),
              HasSubstr("by tilt or roll along the ground, is narrower than the voxels of 500 m"));
  EXPECT_THAT(rolledBy(5), HasSubstr("0.5 deg in elevation, is narrower than the voxels of 100 m up to"));
  EXPECT_THAT(rolled,
              AllOf(HasSubstr("0.5 deg in elevation of the antenna, by tilt or roll along the ground, is "
                              "narrower than the voxels of 500 m in the whole region"),
                    HasSubstr(", 40]}' has them no farther"), Not(HasSubstr("rotate"))));
}

TEST(LikelyMistakes, BlankersThatNeverOpenAndSamplesThatAreNoneAreTold) {
  const auto jamming = [](std::vector<Edit> edits) {
    edits.insert(edits.begin(),
                 {"emitters.search radar.receiver.side_lobe_blanking", "{auxiliary_gain_dbi: 10}"});
    return messagesOf("jamming.yaml", edits);
  };
  EXPECT_THAT(jamming({}), HasSubstr("has no 'waveform' and jams without a pause"));
  EXPECT_THAT(jamming({{"emitters.stand-off jammer.waveform", "{prf_hz: 1000, pulse_width_s: 1.0e-4}"}}),
              Not(HasSubstr("without a pause")));
  EXPECT_THAT(jamming({{"emitters.stand-off jammer.frequency_hz", "1.0e10"}}),
              Not(HasSubstr("without a pause")))
      << "it jams no radar";
  EXPECT_THAT(messagesOf("clutter.yaml", {{"emitters.search radar.clutter.independent_samples", "5000"}}),
              HasSubstr("more than the"));
}

TEST(LikelyMistakes, BlankersWithMoreJammersOfPulsesThanAreToldApartAreTold) {
  const auto with = [](int jammers) {
    std::string emitters =
        "[{name: radar, platform: ridge site, kind: radar, frequency_hz: 3.0e9, power_w: 1.0e5, "
        "antenna: {pattern: gaussian, gain_dbi: 30, beamwidth_az_deg: 2, beamwidth_el_deg: 20}, "
        "receiver: {noise_figure_db: 4, bandwidth_hz: 1.0e6, side_lobe_blanking: {auxiliary_gain_dbi: 10}}}";
    for (int n = 0; n < jammers; ++n) {
      emitters += fmt::format(
          ", {{name: jammer {}, platform: helicopter, kind: jammer, frequency_hz: 3.0e9, power_w: 1, "
          "antenna: "
          "{{pattern: isotropic}}, waveform: {{prf_hz: 1000, pulse_width_s: 1.0e-4}}}}",
          n);
    }
    return messagesOf("jamming.yaml", {{"emitters", emitters + "]"}});
  };
  EXPECT_THAT(with(5), HasSubstr("of 5 jammers of pulses the 4 strongest count as such"));
  EXPECT_THAT(with(4), AllOf(Not(HasSubstr("strongest")), Not(HasSubstr("error"))));
}

TEST(LikelyMistakes, SignalsThatAreNotAsWideAsTheirPulsesAreToldWithTheWidth) {
  const auto with = [](std::vector<Edit> edits) {
    edits.insert(edits.begin(), {"receivers.handset.center_frequency_hz", "3.0e9"});
    return messagesOf("links.yaml", edits);
  };
  EXPECT_THAT(with({}), HasSubstr("the pulses of 'search radar' are 5e+05 Hz wide, but its signal has no "
                                  "'bandwidth_hz': all its power falls into receiver 'handset', 2.5e+04 Hz"));
  EXPECT_THAT(messagesOf("links.yaml", {}), Not(HasSubstr("the pulses of"))) << "the handset hears 450 MHz";
  EXPECT_THAT(with({{"emitters.search radar.bandwidth_hz", "5e+05"}}),
              AllOf(Not(HasSubstr("the pulses of")), Not(HasSubstr("than pulses of"))))
      << "the remedy";
  EXPECT_THAT(with({{"emitters.search radar.bandwidth_hz", "1000"}}),
              HasSubstr("is 1000 Hz wide, narrower than pulses of 2e-06 s can be"));
  EXPECT_THAT(with({{"emitters.search radar.clutter", "{land: woods, range_cell_m: 15}"}}),
              HasSubstr("the pulses of 'search radar' are 9.993e+06 Hz wide"))
      << "compressed";
}

TEST(LikelyMistakes, ClutterOfRainWithoutRainIsTold) {
  EXPECT_THAT(messagesOf("clutter.yaml", {{"atmosphere.rain_mm_h", "0"}}), HasSubstr("but it does not rain"));
  EXPECT_THAT(messagesOf("clutter.yaml", {}), Not(HasSubstr("does not rain")));
}

TEST(LikelyMistakes, TheIntervalThatAWarningOffersIsAccepted) {
  for (const char* quantity :
       {"power_density_dbwm2", "detection_probability", "power_density_dbwm2, detection_probability"}) {
    std::vector<Edit> edits{
        {"step_s", "10"}, {"duration_s", "60"}, {"output.quantities", "[" + std::string(quantity) + "]"}};
    const std::string told = messagesOf("jacksboro.yaml", edits);
    const std::string before = "the output's 'interval: ";
    const std::size_t begin = told.find(before);
    if (begin == std::string::npos) continue;  // no kind fits all quantities, or nothing is lost
    const std::size_t from = begin + before.size();
    edits.push_back({"output.interval", told.substr(from, told.find('}', from) + 1 - from)});
    std::string problems;
    for (const Problem& problem : parseScenario(test::shippedScenario("jacksboro.yaml"), edits).problems) {
      if (problem.severity == Severity::error) problems += problem.message;
    }
    EXPECT_EQ(problems, "") << quantity;
  }
}

TEST(LikelyMistakes, JammersOfAFewHertzAndWithoutABandwidthAreTold) {
  const auto with = [](const std::string& hz) {
    return messagesOf("jamming.yaml", {{"emitters.stand-off jammer.bandwidth_hz", hz}});
  };
  EXPECT_THAT(
      with("30"),
      AllOf(HasSubstr("the signal of jammer 'stand-off jammer' is 30 Hz wide, narrower than any noise"),
            HasSubstr("'bandwidth_hz' is in hertz")));
  EXPECT_THAT(with("null"),
              HasSubstr("jammer 'stand-off jammer' has no 'bandwidth_hz': it is narrower than any receiver"));
  EXPECT_THAT(with("30e6"), Not(HasSubstr("narrower than")));
  EXPECT_THAT(with("0"), Not(HasSubstr("narrower than"))) << "so it is written";
}

TEST(LikelyMistakes, RangesThatTheWaveformRulesOutAreTold) {
  const auto with = [](const std::string& path, const std::string& value) {
    return messagesOf("clutter.yaml", {{"emitters.search radar." + path, value}});
  };
  EXPECT_THAT(
      with("waveform.instrumented_range_m", "200000"),
      AllOf(HasSubstr("looks 200 km far, but its PRF of 1080 Hz has an unambiguous range of 138.8 km"),
            HasSubstr("a PRF up to 749 Hz is unambiguous to 200 km")));
  EXPECT_THAT(with("waveform.instrumented_range_m", "138000"), Not(HasSubstr("unambiguous")));
  EXPECT_THAT(with("waveform", "{prf_hz: 749, pulse_width_s: 1.0e-6, instrumented_range_m: 200000}"),
              Not(HasSubstr("unambiguous")))
      << "the remedy";
  EXPECT_THAT(
      with("waveform.pulse_width_s", "5.0e-4"),
      HasSubstr("range cell of radar 'search radar' is 74.95 km long (c pulse width / 2), its receiver of "
                "1e+06 Hz resolves 149.9 m"));
  EXPECT_THAT(messagesOf("clutter.yaml", {{"emitters.search radar.waveform.pulse_width_s", "5.0e-4"},
                                          {"emitters.search radar.clutter.range_cell_m", "150"}}),
              Not(HasSubstr("range cell")))
      << "the remedy";
}

TEST(LikelyMistakes, RegionsAboveAllEmittersOrBelowTheGroundAreTold) {
  const auto with = [](const std::string& height_m) {
    const auto scenario =
        loadScenario(test::shippedScenario("jacksboro.yaml"), {{"region.origin.height_msl_m", height_m}});
    const TerrainPtr terrain = loadTerrain(*scenario);
    return outsideHeightsText(snapshotAt(scenario, terrain.get(), 0), terrain.get());
  };
  EXPECT_EQ(with("0"), "");
  EXPECT_THAT(with("5000"), HasSubstr("have no emitter: the nearest is '"));
  EXPECT_THAT(with("-11000"), HasSubstr("are below all ground"));
}

TEST(ScenarioWarnings, StayWithTheScenarioAndItsEdits) {
  const std::vector<Edit> low{{"emitters.radar.antenna.gain_dbi", "-32"}};
  const auto scenario = loadScenario(test::shippedScenario("quick.yaml"), low);
  const auto told =
      testing::Contains(HasSubstr("emitters.radar.antenna.gain_dbi=-32: the gain of -32.00 dBi is "));
  EXPECT_THAT(warningsOf(*scenario), told);
  EXPECT_THAT(warningsOf(*editScenario(*scenario, {{"emitters.radar.power_w", "5"}}).scenario), told);
  EXPECT_THAT(warningsOf(*withEdits(*scenario, {})), Not(told));
}

TEST(ScenarioWarnings, OfStepsAreThoseForWhichTheScenarioWasRead) {
  const std::vector<Edit> long_step{{"step_s", "100"}, {"duration_s", "60"}};
  const auto read = [&](ReadFor read_for) {
    const auto scenario = loadScenario(test::shippedScenario("quick.yaml"), long_step, read_for);
    return warningsOf(*editScenario(*scenario, {{"emitters.radar.power_w", "5"}}).scenario);
  };
  EXPECT_THAT(read(ReadFor::series), testing::Contains(HasSubstr("'step_s'")));
  EXPECT_THAT(read(ReadFor::chosen_times), Not(testing::Contains(HasSubstr("'step_s'"))));
}

TEST(ScenarioWarnings, TellOfJammersOnTheRadarsOwnPlatform) {
  const auto told = HasSubstr(
      "jammer 'stand-off jammer' is on the platform of radar 'search radar', in its band, and left out "
      "there");
  EXPECT_THAT(messagesOf("jamming.yaml", {{"emitters.stand-off jammer.platform", "ridge site"}}), told);
  EXPECT_THAT(messagesOf("jamming.yaml", {{"emitters.stand-off jammer.platform", "ridge site"},
                                          {"emitters.stand-off jammer.frequency_hz", "5e9"}}),
              Not(told));
  EXPECT_THAT(messagesOf("jamming.yaml", {}), Not(told));
}

TEST(ScenarioWarnings, TellOfBlinkingBetweenTheSteps) {
  const auto blinking = [](const char* step_s, const char* interval) {
    return messagesOf("jamming.yaml", {{"step_s", step_s},
                                       {"output.quantities", "[detection_probability]"},
                                       {"output.interval", interval},
                                       {"emitters.stand-off jammer.blink", "{on_s: 1, off_s: 3}"}});
  };
  const auto told = HasSubstr("emitter 'stand-off jammer' switches on and off between the times");
  EXPECT_THAT(blinking("4", "{kind: instant}"), told);
  EXPECT_THAT(blinking("1", "{kind: instant}"), Not(told));
  EXPECT_THAT(blinking("4", "{kind: cumulative}"), Not(told));
}

TEST(ScenarioWarnings, TellOfWhatIsHeldDuringAnInterval) {
  const auto over = [](const char* interval, const std::vector<Edit>& more = {}) {
    std::vector<Edit> edits{{"output.quantities", "[detection_probability]"}, {"output.interval", interval}};
    edits.insert(edits.end(), more.begin(), more.end());
    return messagesOf("jamming.yaml", edits);
  };
  const std::vector<Edit> turning{{"emitters.stand-off jammer.scan", "{kind: rotate, rate_rpm: 6}"}};
  const auto of_beam = HasSubstr("the beam of jammer 'stand-off jammer' moves, but all looks"),
             of_motion = HasSubstr("platform 'helicopter' moves up to ");
  EXPECT_THAT(over("{kind: cumulative, seconds: 10}", turning), of_beam);
  EXPECT_THAT(over("{kind: instant}", turning), Not(of_beam));
  std::vector<Edit> idle = turning;
  idle.push_back({"emitters.stand-off jammer.frequency_hz", "9e9"});
  EXPECT_THAT(over("{kind: cumulative, seconds: 10}", idle), Not(of_beam));
  EXPECT_THAT(over("{kind: cumulative, seconds: 10}"), Not(of_beam));
  EXPECT_THAT(over("{kind: cumulative, seconds: 60}"), of_motion);
  EXPECT_THAT(over("{kind: cumulative, seconds: 0.1}"), Not(of_motion));
  for (const double seconds : {20, 41, 60, 77, 90}) {  // the remedy
    const std::string told = over(fmt::format("{{kind: cumulative, seconds: {}}}", seconds).c_str());
    const std::string before = "as all platforms: an interval of ";
    const std::size_t at = told.find(before);
    ASSERT_NE(at, std::string::npos) << told;
    const double fits_s = std::stod(told.substr(at + before.size()));
    EXPECT_GT(fits_s, 0);
    EXPECT_THAT(over(fmt::format("{{kind: cumulative, seconds: {}}}", fits_s).c_str()), Not(of_motion));
  }
  EXPECT_THAT(over("{kind: instant}"), Not(of_motion));
  const std::vector<Edit> two{
      {"output.combine", "sum"},
      {"emitters.stand-off jammer.blink", "{on_s: 1, off_s: 3}"},
      {"emitters.second",
       "{platform: ridge site, kind: radar, frequency_hz: 3e9, "
       "power_w: 100, antenna: {pattern: isotropic}, receiver: {noise_figure_db: 4, bandwidth_hz: 1e6}}"}};
  const auto of_sum = HasSubstr("jams all looks of an interval of kind max_hold for several radars");
  EXPECT_THAT(over("{kind: max_hold, seconds: 10}", two), of_sum);
  EXPECT_THAT(over("{kind: cumulative, seconds: 10}", two), Not(of_sum));
}

TEST(OtherFiles, InPlaceOfAScenarioAreNamedWithTheirUse) {
  const test::TemporaryFolder folder;
  const auto faultOf = [&](const std::string& name, const std::string& bytes) {
    folder.write(name, bytes);
    return messagesOf(parseScenario(folder / name));
  };
  EXPECT_EQ(faultOf("s.yaml", "scenario: a.yaml\nmeasures: []\nsweep: {}\n"),
            "a study, not a scenario: `emscape study` computes it; it names its scenario\n");
  EXPECT_EQ(faultOf("e.yaml", "schema_version: 1\nemitters:\n  - {name: a, match: {}, emitter: {}}\n"),
            "an emitter database, not a scenario: `emscape import` reads it with --emitters\n");
  EXPECT_EQ(faultOf("v.json", R"({"camera": "orbit"})"),
            "a view file, not a scenario: `render` and `view` read it with --state\n");
  EXPECT_EQ(faultOf("e.json", R"({"scenario": "x", "emitters": ["a"], "rows": [], "warnings": []})"),
            "a result of emscape, not a scenario\n");
  EXPECT_EQ(faultOf("g.json", R"({"type": "FeatureCollection", "features": []})"),
            "GeoJSON, not a scenario\n");
  EXPECT_EQ(faultOf("track.kml", "<?xml version=\"1.0\"?><kml/>"),
            "is a recording: `emscape import` makes a scenario of it\n");
  EXPECT_EQ(faultOf("field.vdb", std::string(100, '\0')),
            "is a volume: `render`, `view` and `info` read it\n");
  EXPECT_THAT(faultOf("N44W072.hgt", std::string(100, '\1')),
              HasSubstr("is an elevation file or another raster"));
  EXPECT_THAT(faultOf("p.msi", "NAME x"), HasSubstr("is an antenna's file"));
  EXPECT_THAT(faultOf("picture", std::string("\x89PNG\0\0", 6)), HasSubstr("is not text"));
}

TEST(ScenarioWarnings, NameWhatIsOutsideOfTheTimesOfTheScenario) {
  const auto warningsOf = [](const std::vector<Edit>& edits) { return messagesOf("quick.yaml", edits); };
  const std::string track =
      "{points: [{t_s: 1, latitude_deg: 52, longitude_deg: 5, height_agl_m: 50}, {t_s: 3, latitude_deg: 52, "
      "longitude_deg: 5.1, height_agl_m: 50}]}";
  EXPECT_THAT(
      warningsOf({{"platforms.mast.position", "null"}, {"platforms.mast.track", track}}),
      HasSubstr(
          "the track of 'mast' runs from 1 to 3 s, the scenario from 0 to 4 s: before 1 s and after 3 s "
          "the platform is absent, with all that it carries; 'outside: hold'"));
  EXPECT_THAT(warningsOf({{"platforms.mast.position", "null"},
                          {"platforms.mast.track", track.substr(0, track.size() - 1) + ", outside: hold}"}}),
              Not(HasSubstr("the track of")))
      << "who asks for it knows";
  EXPECT_THAT(
      warningsOf({{"emitters.radar.active_s", "[[10, 20]]"}}),
      HasSubstr("emitter 'radar' is active from 10 s, but the scenario ends at 4 s: it never transmits"));
  EXPECT_THAT(warningsOf({{"emitters.radar.active_s", "[[2, 20]]"}}), Not(HasSubstr("never transmits")));
}

TEST(Blinking, IsOnAndOffByTurnsWithinTheActiveTimes) {
  const auto activeTimes = [](std::vector<Edit> edits) {
    edits.push_back({"duration_s", "60"});
    const ParseResult result = parseScenario(test::shippedScenario("quick.yaml"), edits);
    std::string all;
    if (!result.scenario) return result.problems.front().message;
    for (const TimeInterval& time : result.scenario->emitters[1].active_s)
      all += fmt::format("{:g}-{:g} ", time.begin_s, time.end_s);
    return all;
  };
  const std::string key = "emitters.transmitter.blink";
  EXPECT_EQ(activeTimes({{key, "{on_s: 10, off_s: 20}"}}), "0-10 30-40 60-61 ");
  EXPECT_EQ(activeTimes({{key, "{on_s: 10, off_s: 20, begin_s: 15}"}}), "15-25 45-55 ");
  EXPECT_EQ(activeTimes({{key, "{on_s: 10, off_s: 20, begin_s: 5}"},
                         {"emitters.transmitter.active_s", "[[8, 20], [40, 100]]"}}),
            "8-15 40-45 ");
  EXPECT_THAT(activeTimes({{key, "{on_s: 0.001, off_s: 0.001}"}}),
              HasSubstr("'transmitter' blinks 30000 times in the 60 s of the scenario, at most 10000"));
}

TEST(ScenarioWarnings, NameAFilterThatRemovesAllClutter) {
  const auto warningsOf = [](const std::string& mti) {
    return messagesOf("clutter.yaml", {{"emitters.search radar.clutter.mti", mti}});
  };
  EXPECT_THAT(
      warningsOf("{kind: canceller, pulses: 2}"),
      HasSubstr("radar 'search radar': the filter removes all clutter of the surface and of rain, since "
                "neither its spread ('surface_spread_m_s' and 'rain_spread_m_s') nor a limit of the "
                "radar ('improvement_limit_db') is given"));
  EXPECT_THAT(warningsOf("{kind: canceller, pulses: 2, surface_spread_m_s: 0.4}"),
              HasSubstr("removes all clutter of rain, since neither its spread ('rain_spread_m_s')"));
  EXPECT_THAT(warningsOf("{kind: canceller, pulses: 2, improvement_limit_db: 50}"),
              Not(HasSubstr("removes all clutter")));
}

TEST(ScenarioWarnings, NameTheSpreadOfClutterByAMovingRadar) {
  const auto warningsWith = [](const std::string& spread, const std::string& to_latitude_deg = "36.48") {
    const std::string position = "latitude_deg: 36.3, longitude_deg: -84.25, height_msl_m: 3000";
    const std::string track = "{points: [{t_s: 0, " + position +
                              "}, {t_s: 100, latitude_deg: " + to_latitude_deg +
                              ", longitude_deg: -84.25, height_msl_m: 3000}]}";
    return messagesOf("clutter.yaml", {{"platforms.ridge site.position", "null"},
                                       {"platforms.ridge site.track", track},
                                       {"emitters.search radar.clutter.mti.surface_spread_m_s", spread}});
  };
  EXPECT_THAT(warningsWith("0.4"), HasSubstr("radar 'search radar' moves at up to 200 m/s"));
  EXPECT_THAT(warningsWith("0.4"), HasSubstr("abeam the width of the beam spreads the clutter by 1.6 m/s"));
  EXPECT_THAT(warningsWith("20"), HasSubstr("neither an altitude line"));
  EXPECT_THAT(warningsWith("20"), Not(HasSubstr("abeam")));
  EXPECT_THAT(warningsWith("20", "36.309"), Not(HasSubstr("moves at up to"))) << "10 m/s";
}

TEST(ScenarioWarnings, OfTheKeyOfClutteredEndsThatHasNoEffectAnyMore) {
  EXPECT_THAT(messagesOf("clutter.yaml", {{"ground", "{terminal_clutter_ends: receiver}"}}),
              HasSubstr("'receiver' is not used any more"));
  EXPECT_THAT(messagesOf("clutter.yaml", {{"ground", "{terminal_clutter_ends: both}"}}),
              Not(HasSubstr("not used any more")));
}

TEST(ScenarioWarnings, KindThatConcernsManyEmittersIsOneLine) {
  test::TemporaryFolder folder;
  std::string text =
      "schema_version: 1\nname: many\nregion: {origin: {latitude_deg: 52, longitude_deg: 5}, size_m: [9000, "
      "9000, "
      "900], dims: [9, 9, 9]}\nplatforms: [{name: p, position: {latitude_deg: 52, longitude_deg: 5, "
      "height_agl_m: "
      "9}}]\nemitters:\n";
  for (int i = 0; i < 7; ++i) {
    text += "- {name: e" + std::to_string(i) +
            ", platform: p, kind: transmitter, frequency_hz: 1e9, power_w: 1, antenna: {pattern: gaussian, "
            "gain_dbi: 20, beamwidth_az_deg: 60, beamwidth_el_deg: 30}}\n";
  }
  const ParseResult result = parseScenario(folder.write("many.yaml", text));
  ASSERT_EQ(result.problems.size(), 1u);
  EXPECT_EQ(result.problems[0].location.line, 6);
  EXPECT_THAT(result.problems[0].message, testing::EndsWith("; likewise 'e1', 'e2', 'e3', 'e4' and 2 more"));
}

}  // namespace
}  // namespace emscape::scenario
