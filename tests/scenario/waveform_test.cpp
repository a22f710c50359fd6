#include "emscape/scenario/model/waveform.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emscape/base/units.h"
#include "emscape/scenario/file/scenario_file.h"
#include "propagation/air/sky_noise.h"
#include "tests/scenario/scenario_files.h"

namespace emscape::scenario {
namespace {

using ::testing::HasSubstr;

TEST(Waveform, EqualsTextbookFigures) {
  const Waveform waveform{1000, 1e-6, std::nullopt};
  EXPECT_DOUBLE_EQ(waveform.dutyCycle(), 1e-3);
  EXPECT_NEAR(waveform.unambiguousRange_m(), 149896.2, 0.1);
  EXPECT_NEAR(waveform.minRange_m(), 149.9, 0.01);
  // v (m/s) = lambda (m) f (Hz) / 2: 50 m/s at 3 GHz
  EXPECT_NEAR(waveform.firstBlindSpeed_mps(kSpeedOfLight / 0.1), 50, 1e-9);
}

TEST(Waveform, EchoesAreLostWhileThePulseIsSent) {
  const Waveform waveform{1000, 10e-6, std::nullopt};
  const double repeat_m = waveform.unambiguousRange_m(), half_m = waveform.minRange_m() / 2;
  EXPECT_DOUBLE_EQ(waveform.eclipsedPart(0), 1);
  EXPECT_NEAR(waveform.eclipsedPart(half_m), 0.5, 1e-12);
  EXPECT_EQ(waveform.eclipsedPart(1.001 * waveform.minRange_m()), 0);
  EXPECT_NEAR(waveform.eclipsedPart(3 * repeat_m - half_m), 0.5, 1e-9);
  EXPECT_NEAR(waveform.eclipsedPart(3 * repeat_m + half_m), 0.5, 1e-9);
  EXPECT_EQ(waveform.eclipsedPart(2.5 * repeat_m), 0);
}

TEST(Waveform, HitsOfAScan) {
  ScanSpec scan;
  EXPECT_FALSE(hitsPerScan(scan, 1.5, 300));
  EXPECT_FALSE(scanPeriod_s(scan));
  scan.kind = ScanKind::rotate;
  scan.rate_rpm = -5;
  EXPECT_DOUBLE_EQ(*hitsPerScan(scan, 1.5, 300), 15);  // Skolnik's example
  EXPECT_DOUBLE_EQ(*scanPeriod_s(scan), 12);
  EXPECT_EQ(scannedPlanes(scan), 1);
  scan = {};
  scan.kind = ScanKind::raster;
  scan.width_deg = 40;
  scan.rate_deg_s = 20;
  scan.bars = 3;
  EXPECT_DOUBLE_EQ(*hitsPerScan(scan, 2, 1000), 100);
  EXPECT_DOUBLE_EQ(*scanPeriod_s(scan), 6);
  EXPECT_EQ(scannedPlanes(scan), 2);
  scan = {};
  scan.kind = ScanKind::dwell_list;
  scan.dwells = {{0, 0, 0.02}, {10, 0, 0.01}};
  EXPECT_DOUBLE_EQ(*hitsPerScan(scan, 2, 1000), 10);
  EXPECT_DOUBLE_EQ(*scanPeriod_s(scan), 0.03);
}

/// A radar with a beam of 1.5 deg at 5 rpm.
ParseResult parsed(const std::string& receiver_keys, const std::string& waveform) {
  const test::TemporaryFolder folder;
  return parseScenario(folder.write("radar.yaml", R"(schema_version: 1
name: radar
region: {origin: {latitude_deg: 50, longitude_deg: 8}, size_m: [1e4, 1e4, 1e3], dims: [4, 4, 4]}
platforms: [{name: site, position: {latitude_deg: 50, longitude_deg: 8, height_agl_m: 10}}]
emitters:
  - name: search
    platform: site
    kind: radar
    frequency_hz: 3.0e9
    power_w: 1.0e5
    antenna: {pattern: cosecant2, gain_dbi: 30, beamwidth_az_deg: 1.5, beamwidth_el_deg: 4}
    scan: {kind: rotate, rate_rpm: 5}
    receiver: {noise_figure_db: 4, bandwidth_hz: 1.0e6)" +
                                                      receiver_keys +
                                                      R"(}
    waveform: )" + waveform + "\noutput: {interval: {kind: max_hold, turns: 1}}\n"));
}

TEST(Waveform, GivesTheIntegratedPulses) {
  const ParseResult result = parsed("", "{prf_hz: 300, pulse_width_s: 2.0e-6, instrumented_range_m: 2.0e5}");
  ASSERT_TRUE(result.scenario);
  const Emitter& radar = result.scenario->emitters.front();
  EXPECT_EQ(radar.receiver.pulses, 15);
  EXPECT_DOUBLE_EQ(radar.dutyCycle(), 6e-4);
  EXPECT_EQ(radar.waveform->instrumented_range_m, 2e5);
}

TEST(RadarReceiver, TakesTheSkysNoiseAtItsOwnFrequency) {
  const std::string waveform = "{prf_hz: 300, pulse_width_s: 2.0e-6}";
  const ParseResult fixed = parsed("", waveform), sky = parsed(", antenna_noise: sky", waveform);
  ASSERT_TRUE(fixed.scenario && sky.scenario);
  const Emitter& radar = sky.scenario->emitters.front();
  EXPECT_EQ(fixed.scenario->emitters.front().receiver.antenna_temperature_k, 290);
  EXPECT_DOUBLE_EQ(radar.receiver.antenna_temperature_k,
                   propagation::antennaTemperature_k(radar.frequency_hz, degToRad(radar.scan.elevation_deg),
                                                     degToRad(radar.antenna->beamwidth_el_deg), {}));
  EXPECT_LT(radar.receiver.antenna_temperature_k, 200);
}

TEST(Waveform, PulsesThatAreGivenStayAndMoreThanTheHitsAreAWarning) {
  const std::string waveform = "{prf_hz: 300, pulse_width_s: 2.0e-6}";
  const auto problems = [](const ParseResult& result) {
    std::string all;
    for (const Problem& problem : result.problems) {
      if (problem.message.find("sweeps") == std::string::npos) all += problem.message + "\n";
    }
    return all;
  };
  const ParseResult fewer = parsed(", pulses: 10", waveform);
  ASSERT_TRUE(fewer.scenario);
  EXPECT_EQ(fewer.scenario->emitters.front().receiver.pulses, 10);
  EXPECT_EQ(problems(fewer), "");
  const ParseResult more = parsed(", pulses: 20", waveform);
  ASSERT_TRUE(more.scenario);
  EXPECT_EQ(more.scenario->emitters.front().receiver.pulses, 20);
  EXPECT_THAT(problems(more),
              HasSubstr("'pulses' is 20, but one pass of the beam of 'search' gives 15 hits"));
}

/// The warnings about the echoes and pulses of a radar with a Doppler filter, and its integrated pulses.
std::pair<int, std::string> filtered(const std::string& receiver_keys, const std::string& mti) {
  const ParseResult result =
      parsed(receiver_keys, "{prf_hz: 1280, pulse_width_s: 1.0e-6}\n    clutter: {land: woods, mti: " +
                                mti.substr(0, mti.size() - 1) + ", surface_spread_m_s: 0.2}}");
  std::string warnings;
  for (const Problem& problem : result.problems) {
    if (problem.message.find("sweeps") == std::string::npos) warnings += problem.message + "\n";
  }
  EXPECT_TRUE(result.scenario) << warnings;
  return {result.scenario ? result.scenario->emitters.front().receiver.pulses : -1, warnings};
}

TEST(Waveform, PulsesOfADopplerFilterAreNotIntegratedAgain) {
  // 64 hits: one coherent sum of 64 pulses, four of 16, or 62 outputs of a canceller of three.
  const std::string coherent_64 = ", processing_gain_db: 18";
  EXPECT_EQ(filtered(coherent_64, "{kind: pulse_doppler, pulses: 64}"), std::make_pair(1, std::string()));
  EXPECT_EQ(filtered(", processing_gain_db: 9", "{kind: pulse_doppler, pulses: 16}"),
            std::make_pair(4, std::string()));
  EXPECT_EQ(filtered("", "{kind: canceller, pulses: 3}"), std::make_pair(62, std::string()));
  EXPECT_EQ(filtered(", pulses: 4, processing_gain_db: 9", "{kind: pulse_doppler, pulses: 16}").second, "");
  EXPECT_THAT(filtered(", pulses: 64, processing_gain_db: 9", "{kind: pulse_doppler, pulses: 16}").second,
              HasSubstr("gives 64 hits, 4 after its filter of 16 pulses; 64 are integrated all the same"));
  EXPECT_THAT(filtered(", processing_gain_db: 9", "{kind: pulse_doppler, pulses: 100}").second,
              HasSubstr("filter of 'search' has 100 pulses, but one pass of its beam gives 64 hits"));
}

TEST(Waveform, EchoesAboveAMatchedFilterAreAWarning) {
  const auto warned = [](const std::string& keys, const std::string& mti) {
    return filtered(keys, mti).second;
  };
  // 1 MHz and 1 us are matched; 16 pulses summed coherently allow 12.04 dB.
  EXPECT_EQ(warned(", processing_gain_db: 12", "{kind: pulse_doppler, pulses: 16}"), "");
  EXPECT_THAT(warned(", processing_gain_db: 15", "{kind: pulse_doppler, pulses: 16}"),
              HasSubstr("3.0 dB above those of a matched filter"));
  EXPECT_THAT(warned(", processing_gain_db: 15", "{kind: pulse_doppler, pulses: 16}"),
              HasSubstr("a 'processing_gain_db' of at most 12.0"));
  EXPECT_THAT(warned(", processing_gain_db: 12", "{kind: canceller, pulses: 3}"),
              HasSubstr("12.0 dB above those of a matched filter"));
  EXPECT_THAT(warned("", "{kind: pulse_doppler, pulses: 16}"),
              HasSubstr("sums 16 pulses coherently, but 'processing_gain_db' is not given"));
  EXPECT_THAT(warned(", processing_gain_db: 0", "{kind: pulse_doppler, pulses: 16}"),
              HasSubstr("sums 16 pulses coherently, but 'processing_gain_db' is 0"));
}

TEST(Waveform, IsRefusedWherePulsesOverlapOrMissTheirCount) {
  const auto refusal = [](const ParseResult& result) {
    EXPECT_FALSE(result.scenario);
    return result.problems.empty() ? "" : result.problems.front().message;
  };
  EXPECT_THAT(refusal(parsed("", "{prf_hz: 1000, pulse_width_s: 0.001}")),
              HasSubstr("pulses that are repeated at 1000 Hz are shorter than 0.001 s"));
  EXPECT_THAT(refusal(parsed(", binary_threshold: 16", "{prf_hz: 300, pulse_width_s: 1.0e-6}")),
              HasSubstr("'binary_threshold' is 16, more than the 15 pulses integrated"));
}

TEST(VictimScan, NamesAPlatformOtherThanItsOwn) {
  const auto problems = [](const std::string& kind, const std::string& victim) {
    const test::TemporaryFolder folder;
    const ParseResult result = parseScenario(folder.write("s.yaml", R"(schema_version: 1
name: victim
region: {origin: {latitude_deg: 50, longitude_deg: 8}, size_m: [1e4, 1e4, 1e3], dims: [4, 4, 4]}
platforms:
  - {name: radar site, position: {latitude_deg: 50, longitude_deg: 8, height_agl_m: 10}}
  - {name: aircraft, position: {latitude_deg: 50.01, longitude_deg: 8, height_msl_m: 900}}
emitters:
  - name: jammer
    platform: aircraft
    kind: )" + kind + R"(
    frequency_hz: 3.0e9
    power_w: 100
    antenna: {pattern: gaussian, gain_dbi: 15, beamwidth_az_deg: 30, beamwidth_el_deg: 30}
    scan: {kind: victim, victim: )" + victim + "}\n"));
    if (result.scenario) {
      EXPECT_EQ(result.scenario->emitters[0].scan.victim, 0);
    }
    return test::messagesOf(result);
  };
  EXPECT_EQ(problems("jammer\n    bandwidth_hz: 1.0e6", "radar site").find("victim"), std::string::npos);
  EXPECT_THAT(problems("transmitter", "aircraft"), HasSubstr("the platform of 'jammer' itself"));
  EXPECT_THAT(problems("transmitter", "radar sight"),
              HasSubstr("there is no platform 'radar sight'; did you mean"));
  EXPECT_THAT(problems("radar", "radar site"),
              HasSubstr("'jammer' is a radar: track turns it onto its targets"));
}

}  // namespace
}  // namespace emscape::scenario
