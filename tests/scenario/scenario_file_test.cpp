#include "emscape/scenario/file/scenario_file.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "emscape/base/units.h"
#include "propagation/air/rain.h"
#include "scenario/file/schema.h"
#include "tests/scenario/scenario_files.h"
#include "tests/support/errors.h"

namespace emscape::scenario {
namespace {

using namespace propagation;

using test::replaced;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class ScenarioYaml : public ::testing::Test {
 protected:
  ScenarioYaml() {
    for (const char* name : {"track.csv", "sector.msi"}) {
      std::filesystem::copy_file(test::testData() / name, folder_.path() / name);
    }
  }
  std::shared_ptr<const Scenario> load(const std::string& text, const std::string& name = "scenario.yaml") {
    return loadScenario(folder_.write(name, text));
  }
  const std::string valid_ = test::readFile(test::testData() / "valid.yaml");
  test::TemporaryFolder folder_;
};

TEST_F(ScenarioYaml, ReadsEverySection) {
  const auto scenario = load(valid_);
  EXPECT_EQ(scenario->name, "valid");
  EXPECT_EQ(scenario->clock.epoch_utc, "2026-06-01T06:00:00Z");
  EXPECT_EQ(scenario->clock.duration_s, 120);
  EXPECT_EQ(scenario->clock.step_s, 0.5);
  EXPECT_EQ(scenario->region.origin.kind, FrameKind::altitude);
  EXPECT_EQ(scenario->region.origin.longitude_deg, -84.25);
  EXPECT_EQ(scenario->region.origin.height_msl_m, 100);
  EXPECT_EQ(scenario->region.size_m, (Vec3d{30000, 20000, 6000}));
  EXPECT_EQ(scenario->region.dims, (Dims{30, 20, 10}));
  EXPECT_FALSE(scenario->terrain);
  EXPECT_EQ(scenario->atmosphere.k_factor, 1.3333);
  EXPECT_EQ(scenario->atmosphere.rain_mm_h, 2);
  EXPECT_EQ(scenario->atmosphere.pressure_hpa, 1013.25);

  ASSERT_EQ(scenario->platforms.size(), 2u);
  EXPECT_EQ(scenario->platforms[0].attitude.roll_deg, -2);
  EXPECT_EQ(scenario->platforms[0].track.at(0).position.height_agl_m, 12);
  ASSERT_EQ(scenario->platforms[1].track.size(), 3u);
  EXPECT_EQ(scenario->platforms[1].track[1].t_s, 60);
  EXPECT_EQ(scenario->platforms[1].track[1].position.height_msl_m, 950);
  EXPECT_FALSE(scenario->platforms[1].track[1].heading_deg);

  ASSERT_EQ(scenario->emitters.size(), 4u);
  const Emitter& radar = scenario->emitters[0];
  EXPECT_EQ(radar.kind, EmitterKind::radar);
  EXPECT_EQ(radar.frequency_hz, 3e9);
  EXPECT_EQ(radar.power_w, 2e5);
  EXPECT_EQ(radar.polarization, Polarization::horizontal);
  EXPECT_EQ(radar.propagation.model, PropagationModel::diffraction);
  EXPECT_EQ(radar.antenna->gain_dbi, 34);
  EXPECT_EQ(radar.scan.kind, ScanKind::rotate);
  EXPECT_EQ(radar.scan.rate_rpm, 11.95);
  EXPECT_EQ(radar.losses_db, 3);
  EXPECT_EQ(radar.receiver.losses_db, 0) << "those of transmission do not count again";
  EXPECT_EQ(radar.receiver.target_rcs_m2, 5);
  ASSERT_EQ(radar.active_s.size(), 2u);
  EXPECT_EQ(radar.active_s[1].begin_s, 90);
  EXPECT_EQ(radar.location.line, 20);
  ASSERT_EQ(scenario->emitters[1].scan.dwells.size(), 2u);
  EXPECT_EQ(scenario->emitters[1].scan.dwells[1].duration_s, 0.2);
  EXPECT_EQ(scenario->emitters[3].platform, 1);
  EXPECT_EQ(scenario->emitters[3].scan.bars, 3);
  EXPECT_EQ(scenario->emitters[3].polarization, Polarization::circular_right);

  EXPECT_EQ(scenario->receivers.at(0).polarization, Polarization::vertical);
  EXPECT_EQ(scenario->bands.at(1).end_hz, 4e9);
  EXPECT_EQ(scenario->output.combine, CombineMode::per_band);
  EXPECT_EQ(scenario->output.quantities.at(2), "snr_db");
}

TEST_F(ScenarioYaml, BeamwidthsWithoutAGainAreNotTooNarrow) {
  EXPECT_THAT(test::errorOf([&] {
                load(replaced(valid_, "beamwidth_az_deg: 60, beamwidth_el_deg: 30",
                              "beamwidth_az_deg: 0.001, beamwidth_el_deg: 0.001"));
              }),
              HasSubstr("beamwidths of 0.001 deg by 0.001 deg are those of a gain of 104.1 dBi, above 100 "
                        "dBi; give wider ones, or 'gain_dbi'"));
}

TEST_F(ScenarioYaml, ElevationFilesAreRegularFiles) {
  EXPECT_THAT(test::errorOf([&] { load(valid_ + "terrain: {files: [/dev/zero]}\n"); }),
              HasSubstr("elevation file /dev/zero: is not a regular file"));
}

TEST_F(ScenarioYaml, NamesHaveNoControlCharactersAndNoncharacters) {
  const auto faultOf = [this](const std::string& from, const std::string& to) {
    return test::errorOf([&] { load(replaced(valid_, from, to)); }, ErrorCode::bad_input);
  };
  EXPECT_THAT(faultOf("name: valid", R"(name: "a\u0085b")"),
              HasSubstr(":3:7: 'name' contains U+0085, a control character"));
  EXPECT_THAT(faultOf("name: mast", R"(name: "\u001b[31mred")"),
              HasSubstr("'name' contains U+001B, a control character"));
  EXPECT_THAT(faultOf("name: valid", R"(name: "two\nlines")"),
              HasSubstr(":3:7: 'name' contains U+000A, a control character"));
  EXPECT_THAT(faultOf("name: mast", R"(name: "a\tb")"),
              HasSubstr("'name' contains U+0009, a control character"));
  EXPECT_THAT(faultOf("{name: intercept", R"({name: "a\uFFFE")"),
              HasSubstr("'name' contains U+FFFE, which is no character"));
}

TEST_F(ScenarioYaml, RainRateLimitsEqualModelLimits) {
  EXPECT_EQ(load(replaced(valid_, "rain_mm_h: 2", "rain_mm_h: 200"))->atmosphere.rain_mm_h, kRainRate.max);
  EXPECT_EQ(kRainRate.beyond, Beyond::refused);
  EXPECT_THAT(test::errorOf([&] { load(replaced(valid_, "rain_mm_h: 2", "rain_mm_h: 200.5")); }),
              HasSubstr("'rain_mm_h' is 200.5, outside the allowed range 0 to 200 mm/h"));
}

TEST_F(ScenarioYaml, ReadsSettingsOfModels) {
  const std::string model = "    propagation: free_space\n";
  ASSERT_NE(valid_.find(model), std::string::npos);
  auto scenario = load(valid_);
  EXPECT_EQ(scenario->emitters[1].propagation.model, PropagationModel::diffraction) << "by default";
  EXPECT_EQ(scenario->emitters[1].propagation.diffraction.method, DiffractionMethod::delta_bullington);
  EXPECT_EQ(scenario->atmosphere.gases, GasLosses::automatic);
  EXPECT_EQ(scenario->ground.kind, GroundKind::average_ground);
  EXPECT_FALSE(scenario->ground.surface_msl_m);

  const std::string text = replaced(valid_, "atmosphere: {k_factor: 1.3333, rain_mm_h: 2}",
                                    "atmosphere: {rain_mm_h: 2, rain_height_m: 3100, gases: never, "
                                    "climate: desert, sea_level_refractivity: 280}\n"
                                    "ground: {kind: sea, roughness_m: 0.3, surface_msl_m: 2}");
  scenario = load(replaced(text, model,
                           "    propagation: itm\n"
                           "    itm: {form: area, time_percent: 95, service: broadcast, irregularity_m: 30}\n"
                           "    diffraction: {method: deygout}\n"));
  EXPECT_EQ(scenario->atmosphere.rain_height_m, 3100);
  EXPECT_EQ(scenario->atmosphere.gases, GasLosses::never);
  EXPECT_EQ(scenario->atmosphere.climate, RadioClimate::desert);
  EXPECT_EQ(scenario->atmosphere.sea_level_refractivity, 280);
  EXPECT_EQ(scenario->ground.kind, GroundKind::sea);
  EXPECT_EQ(scenario->ground.roughness_m, 0.3);
  EXPECT_EQ(scenario->ground.surface_msl_m, 2);
  const Emitter& jammer = scenario->emitters[3];
  EXPECT_EQ(jammer.propagation.model, PropagationModel::itm);
  EXPECT_EQ(jammer.propagation.itm.form, ItmForm::area);
  EXPECT_EQ(jammer.propagation.itm.time_percent, 95);
  EXPECT_EQ(jammer.propagation.itm.service, ItmService::broadcast);
  EXPECT_EQ(jammer.propagation.itm.irregularity_m, 30);
  EXPECT_EQ(jammer.propagation.diffraction.method, DiffractionMethod::deygout);
  EXPECT_GT(jammer.propagation.location.line, jammer.location.line);

  scenario = load(replaced(valid_, model,
                           "    propagation: two_ray\n"
                           "    two_ray: {sum: envelope, roughness_model: ament}\n"));
  EXPECT_EQ(scenario->emitters[3].propagation.two_ray.sum, TwoRaySum::envelope);
  EXPECT_EQ(scenario->emitters[3].propagation.two_ray.roughness_model, RoughnessModel::ament);
}

TEST(ShippedScenarios, HaveNeitherFaultsNorWarnings) {
  const std::filesystem::path folder =
      std::filesystem::path(test::shippedScenario("quick.yaml")).parent_path();
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string kind = entry.path().parent_path().filename();
    const bool is_other = kind == "study" || kind == "data" || kind == "recordings";  // read by other tests
    if (entry.path().extension() != ".yaml" || is_other) continue;
    const ParseResult result = parseScenario(entry.path().string());
    EXPECT_TRUE(result.problems.empty()) << entry.path() << ": " << result.problems.front().message;
    ++count;
  }
  EXPECT_GT(count, 10);
}

TEST_F(ScenarioYaml, GivesNoProblemForAValidScenario) {
  EXPECT_TRUE(parseScenario(folder_.write("scenario.yaml", valid_)).problems.empty());
}

TEST_F(ScenarioYaml, DerivesGainFromBeamwidthsAndAperture) {
  const auto scenario = load(valid_);
  EXPECT_NEAR(scenario->emitters[3].antenna->gain_dbi, 10 * std::log10(26000.0 / (60 * 30)), 1e-9);
  // 4 pi A / lambda^2 of 32 x 16 elements half a wavelength apart is pi times their number; the floor of -40
  // dB all round takes 0.6 dB of it.
  const Antenna& array = *scenario->emitters[1].antenna;
  EXPECT_DOUBLE_EQ(array.gain_dbi, array.directivity_dbi());
  EXPECT_NEAR(array.gain_dbi, 10 * std::log10(1 / (1 / (kPi * 32 * 16) + 1e-4)), 0.1);
  const std::string deep = replaced(valid_, "rows: 16}", "rows: 16, side_lobe_db: -90}");
  EXPECT_NEAR(load(deep)->emitters[1].antenna->gain_dbi, 10 * std::log10(kPi * 32 * 16), 0.03);
  EXPECT_NEAR(scenario->emitters[2].antenna->gain_dbi, 12 + kDipoleGain_dbi, 1e-9) << "dBd of the file";
}

const char* const kMinimal = R"(schema_version: 1
name: smallest
region: {origin: {latitude_deg: 0, longitude_deg: 180}, size_m: [1, 1, 1], dims: [2, 2, 2]}
platforms: [{name: p, position: {latitude_deg: 0, longitude_deg: 0, height_msl_m: 0}}]
emitters: [{name: e, platform: p, kind: radar, frequency_hz: 1e9, power_w: 1, antenna: {pattern: isotropic},
            receiver: {noise_figure_db: 0, bandwidth_hz: 1e6}}]
)";

TEST_F(ScenarioYaml, DefaultsOfTableEqualDefaultsOfTypes) {
  const auto scenario = load(kMinimal);
  EXPECT_EQ(scenario->clock.epoch_utc, "");
  EXPECT_EQ(scenario->clock.duration_s, Clock{}.duration_s);
  EXPECT_EQ(scenario->clock.step_s, Clock{}.step_s);
  EXPECT_EQ(scenario->atmosphere.k_factor, Atmosphere{}.k_factor);
  EXPECT_EQ(scenario->atmosphere.vapour_g_m3, Atmosphere{}.vapour_g_m3);
  EXPECT_EQ(scenario->region.origin.height_msl_m, FrameOrigin{}.height_msl_m);
  EXPECT_EQ(scenario->region.origin.kind, FrameOrigin{}.kind);
  const Emitter& emitter = scenario->emitters[0];
  EXPECT_EQ(emitter.polarization, Emitter{}.polarization);
  EXPECT_EQ(emitter.propagation.model, Emitter{}.propagation.model);
  EXPECT_EQ(emitter.scan.kind, ScanKind::fixed);
  EXPECT_EQ(emitter.scan.bars, 1);
  EXPECT_TRUE(emitter.active_s.empty());
  EXPECT_EQ(emitter.receiver.pulses, RadarReceiver{}.pulses);
  EXPECT_EQ(emitter.receiver.pfa, RadarReceiver{}.pfa);
  EXPECT_EQ(emitter.receiver.swerling, RadarReceiver{}.swerling);
  EXPECT_EQ(emitter.receiver.target_rcs_m2, RadarReceiver{}.target_rcs_m2);
  EXPECT_EQ(emitter.receiver.antenna_temperature_k, RadarReceiver{}.antenna_temperature_k);
  EXPECT_EQ(emitter.receiver.losses_db, RadarReceiver{}.losses_db);
  EXPECT_EQ(emitter.receiver.processing_gain_db, RadarReceiver{}.processing_gain_db);
  EXPECT_EQ(emitter.receiver.polarization, RadarReceiver{}.polarization);
  EXPECT_EQ(emitter.receiver.cross_polar_isolation_db, RadarReceiver{}.cross_polar_isolation_db);
  EXPECT_EQ(emitter.receiver.detection, RadarReceiver{}.detection);
  EXPECT_EQ(emitter.receiver.required_signal_to_jammer_db, RadarReceiver{}.required_signal_to_jammer_db);
  EXPECT_EQ(scenario->output.radar_look, OutputSpec{}.radar_look);
  EXPECT_EQ(scenario->output.quantities, OutputSpec{}.quantities);
  EXPECT_EQ(scenario->output.combine, OutputSpec{}.combine);
  EXPECT_EQ(scenario->output.floor, OutputSpec{}.floor);
  EXPECT_EQ(scenario->output.count_threshold_dbwm2, OutputSpec{}.count_threshold_dbwm2);
}

TEST_F(ScenarioYaml, ReadsJsonIndentedWithTabs) {
  const auto scenario = load(R"({
	"schema_version": 1, "name": "json \u00e9",
	"region": {"origin": {"latitude_deg": 0, "longitude_deg": -1.5e1}, "size_m": [1, 1, 1], "dims": [2, 2, 2]},
	"platforms": [
		{"name": "p", "position": {"latitude_deg": 0, "longitude_deg": 0, "height_msl_m": 0}}
	],
	"emitters": [{"name": "e", "platform": "p", "kind": "jammer", "frequency_hz": 1E+9, "power_w": 1,
		"antenna": {"pattern": "isotropic"}}]
}
)",
                             "scenario.json");
  EXPECT_EQ(scenario->name, "json \xC3\xA9");
  EXPECT_EQ(scenario->region.origin.longitude_deg, -15);
  EXPECT_EQ(scenario->emitters[0].frequency_hz, 1e9);
}

TEST_F(ScenarioYaml, AliasesEqualTheirAnchors) {
  std::string text = replaced(valid_, "antenna: {pattern: gaussian", "antenna: &horn {pattern: gaussian");
  text = replaced(text, "receivers:", R"(  - name: second
    platform: helicopter
    kind: transmitter
    frequency_hz: 3.1e9
    power_w: 1
    antenna: *horn
receivers:)");
  EXPECT_EQ(load(text)->emitters.back().antenna->beamwidth_az_deg, 60);
}

TEST_F(ScenarioYaml, IgnoresWindowsLineEndsAndByteOrderMark) {
  std::string text = "\xEF\xBB\xBF";
  for (const char c : valid_) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(load(text)->emitters[0].location.column, 5);
}

TEST_F(ScenarioYaml, HashFollowsTheScenarioAndEveryNamedFile) {
  const std::string before = load(valid_)->hash;
  EXPECT_THAT(before, ::testing::MatchesRegex("[0-9a-f]{16}"));
  EXPECT_EQ(load(valid_)->hash, before);
  EXPECT_NE(load(valid_ + "# remark\n")->hash, before);
  folder_.write("track.csv", replaced(test::readFile(test::testData() / "track.csv"), "950", "951"));
  const std::string other_track = load(valid_)->hash;
  EXPECT_NE(other_track, before);
  folder_.write("sector.msi", replaced(test::readFile(test::testData() / "sector.msi"), "12.00", "13.00"));
  EXPECT_NE(load(valid_)->hash, other_track);
}

TEST_F(ScenarioYaml, MistypedPlacesAndLengthsAreWarningsOfOneLine) {
  const auto warningsWith = [&](const std::string& path, const std::string& value) {
    return test::messagesOf(parseScenario(folder_.write("scenario.yaml", valid_), {{path, value}}));
  };
  EXPECT_THAT(warningsWith("region.origin.latitude_deg", "45"),
              AllOf(HasSubstr("is outside the region, "), HasSubstr("; likewise '")));
  EXPECT_THAT(warningsWith("region.size_m", "[29, 29, 6000]"),
              HasSubstr("the region is 29 m by 29 m: 'size_m' is in metres, not in kilometres"));
}

TEST_F(ScenarioYaml, EmitterOutsideAllBandsIsAWarning) {
  const std::string text = replaced(valid_, "begin_hz: 8.0e9", "begin_hz: 9.5e9");
  const ParseResult result = parseScenario(folder_.write("scenario.yaml", text));
  ASSERT_TRUE(result.scenario);
  ASSERT_EQ(result.problems.size(), 1u);
  EXPECT_EQ(result.problems[0].severity, Severity::warning);
  EXPECT_EQ(result.problems[0].message, "emitter 'array radar' (9000000000 Hz) is in none of the bands");
  EXPECT_EQ(result.problems[0].location.line, 39);
}

TEST_F(ScenarioYaml, WarnsOfAGainAboveThePatternsDirectivity) {
  const std::string text =
      replaced(valid_, "{pattern: gaussian, beamwidth_az_deg: 60, beamwidth_el_deg: 30}",
               "{pattern: gaussian, gain_dbi: 20, beamwidth_az_deg: 60, beamwidth_el_deg: 30}");
  const ParseResult result = parseScenario(folder_.write("scenario.yaml", text));
  ASSERT_NE(result.scenario, nullptr);
  ASSERT_EQ(result.problems.size(), 1u);
  EXPECT_EQ(result.problems[0].severity, Severity::warning);
  EXPECT_THAT(result.problems[0].message,
              AllOf(HasSubstr("the gain of 20.00 dBi is 6.8"), HasSubstr("directivity, 13.1")));
  EXPECT_EQ(result.problems[0].location.line, 62);
  // Without it the gain is the formula's, at most the directivity.
  EXPECT_NEAR(load(valid_)->emitters[3].antenna->gain_dbi, 10 * std::log10(26000 / 1800.0), 1.6);
  const std::string flat =
      replaced(valid_, "beamwidth_el_deg: 30}", "beamwidth_el_deg: 30, side_lobe_db: -6}");
  const AntennaPtr antenna = load(flat)->emitters[3].antenna;
  EXPECT_DOUBLE_EQ(antenna->gain_dbi, antenna->directivity_dbi());
}

TEST_F(ScenarioYaml, WarnsOfABeamThatStepsOverAzimuths) {
  const std::string text = replaced(valid_, "rate_rpm: 11.95", "rate_rpm: 12");
  const ParseResult result = parseScenario(folder_.write("scenario.yaml", text));
  ASSERT_NE(result.scenario, nullptr);
  ASSERT_EQ(result.problems.size(), 1u);
  EXPECT_EQ(result.problems[0].severity, Severity::warning);
  EXPECT_THAT(result.problems[0].message,
              AllOf(HasSubstr("'search radar', 1.6 deg wide, sweeps 36 deg in a step of 0.5 s"),
                    HasSubstr("4 % are ever lit")));
  EXPECT_EQ(result.problems[0].location.line, 32);
  const std::string whole_turns = replaced(valid_, "rate_rpm: 11.95", "rate_rpm: 120");
  EXPECT_THAT(parseScenario(folder_.write("scenario.yaml", whole_turns)).problems[0].message,
              HasSubstr("of its azimuths below 1 % are ever lit"));
  // Beams alike are named together.
  const std::string twin =
      "  - {name: twin, platform: ridge site, kind: transmitter, frequency_hz: 3.1e9, power_w: 10, "
      "antenna: {pattern: cosecant2, gain_dbi: 30, beamwidth_az_deg: 1.6, beamwidth_el_deg: 4.0}, "
      "scan: {kind: rotate, rate_rpm: 12}}\n";
  const ParseResult both =
      parseScenario(folder_.write("scenario.yaml", replaced(text, "receivers:\n", twin + "receivers:\n")));
  ASSERT_EQ(both.problems.size(), 1u);
  EXPECT_THAT(both.problems[0].message,
              AllOf(HasSubstr("the beams of 'search radar', 'twin', 1.6 deg wide, sweep 36 deg"),
                    HasSubstr("of their azimuths")));
  EXPECT_EQ(both.problems[0].location.line, 32);
  // One warning names all of them.
  const std::string slower = replaced(twin, "rate_rpm: 12", "rate_rpm: 6");
  const ParseResult unlike =
      parseScenario(folder_.write("scenario.yaml", replaced(text, "receivers:\n", slower + "receivers:\n")));
  ASSERT_EQ(unlike.problems.size(), 1u);
  EXPECT_THAT(unlike.problems[0].message,
              AllOf(HasSubstr("; the beam of 'twin', 1.6 deg wide, sweeps 18 deg"), Not(HasSubstr("\n"))));
  // Chosen times do not depend on the steps.
  const std::string file = folder_.write("scenario.yaml", text);
  EXPECT_TRUE(parseScenario(file, {}, ReadFor::chosen_times).problems.empty());
  // If radars look at every voxel, their scans have no effect.
  const std::string coverage =
      replaced(replaced(text, "[power_density_dbwm2, received_power_dbm, snr_db]", "[snr_db]"),
               "combine: per_band", "combine: per_band\n  radar_look: target");
  EXPECT_TRUE(parseScenario(folder_.write("scenario.yaml", coverage)).problems.empty());
}

TEST_F(ScenarioYaml, TapersArraysAndApertures) {
  const auto antennaOf = [&](const std::string& keys) {
    return load(replaced(valid_, "{pattern: phased_array, columns: 32, rows: 16}",
                         "{pattern: phased_array, columns: 32, rows: 16" + keys + "}"))
        ->emitters[1]
        .antenna;
  };
  const AntennaPtr even = antennaOf(""),
                   taylor = antennaOf(", side_lobe_db: -70, taper: taylor, taper_side_lobe_db: -35"),
                   low = antennaOf(", side_lobe_db: -70");
  EXPECT_GT(taylor->beamwidth_az_deg, 1.3 * even->beamwidth_az_deg);
  EXPECT_NEAR(taylor->gain_dbi - low->gain_dbi, 20 * std::log10(0.8089), 0.1);
  EXPECT_NEAR(even->amplitudeTowards({-1, 0, 0}, 0, 0), 0.01, 1e-12) << "-40 dB unless it says otherwise";
  EXPECT_NEAR(antennaOf(", side_lobe_db: -30")->amplitudeTowards({-1, 0, 0}, 0, 0), std::pow(10, -1.5),
              1e-12);
  const std::string text =
      replaced(valid_, "columns: 32, rows: 16}", "columns: 32, rows: 16, taper_side_lobe_db: -35}");
  const ParseResult result = parseScenario(folder_.write("scenario.yaml", text));
  ASSERT_EQ(result.problems.size(), 1u);
  EXPECT_EQ(result.problems[0].message,
            "'taper_side_lobe_db' is the design level of taper: taylor; 'taper' is uniform");
}

TEST_F(ScenarioYaml, ARotationThatStandsStillIsAFixedBeam) {
  const std::string text = replaced(valid_, "rate_rpm: 11.95", "rate_rpm: 0, azimuth_deg: 20");
  const ScanSpec scan = load(text)->emitters[0].scan;
  EXPECT_EQ(scan.kind, ScanKind::fixed);
  EXPECT_EQ(scan.azimuth_deg, 20);
}

TEST_F(ScenarioYaml, TrackIsAScanOfRadars) {
  const std::string radar =
      replaced(valid_, "{kind: rotate, rate_rpm: 11.95}", "{kind: track, azimuth_deg: 20}");
  EXPECT_EQ(load(radar)->emitters[0].scan.kind, ScanKind::track);
  const std::string jammer =
      replaced(valid_, "{kind: raster, width_deg: 40, rate_deg_s: 20, elevation_step_deg: 5, bars: 3}",
               "{kind: track}");
  const ParseResult result = parseScenario(folder_.write("scenario.yaml", jammer));
  ASSERT_EQ(result.problems.size(), 1u);
  EXPECT_EQ(result.problems[0].message,
            "'kind' is track, which turns a radar onto its targets; 'jammer' is a jammer: its beam stays");
}

TEST_F(ScenarioYaml, WarnsOfAJammerOutsideEveryRadarsBand) {
  const std::string asking = replaced(valid_, "received_power_dbm, snr_db]", "jammer_to_signal_db]");
  EXPECT_TRUE(parseScenario(folder_.write("scenario.yaml", asking)).problems.empty());
  const std::string text = replaced(asking, "frequency_hz: 3.0e9\n    bandwidth_hz: 20.0e6",
                                    "frequency_hz: 3.1e9\n    bandwidth_hz: 20.0e6");
  const ParseResult result = parseScenario(folder_.write("scenario.yaml", text));
  ASSERT_NE(result.scenario, nullptr);
  ASSERT_EQ(result.problems.size(), 1u);
  EXPECT_EQ(result.problems[0].severity, Severity::warning);
  EXPECT_EQ(result.problems[0].message,
            "jammer 'jammer' (3100000000 Hz, 20000000 Hz wide) is outside the band of every radar: it jams "
            "none");
}

TEST_F(ScenarioYaml, TrackMayHaveBlankLinesRemarksAndAttitude) {
  folder_.write(
      "track.csv",
      "# remark\n\nheading_deg , t_s, latitude_deg,longitude_deg,height_agl_m,roll_deg,pitch_deg\r\n"
      "350,0,1,2,30,4,-5\r\n\n10,+1.5e0,1,2,30,4,-5");
  const auto scenario = load(valid_);
  const TrackPoint& point = scenario->platforms[1].track.at(1);
  EXPECT_EQ(point.t_s, 1.5);
  EXPECT_EQ(point.heading_deg, 10);
  EXPECT_EQ(point.roll_deg, 4);
  EXPECT_EQ(point.pitch_deg, -5);
  EXPECT_EQ(point.position.height_agl_m, 30);
  EXPECT_FALSE(point.position.height_msl_m);
}

TEST(ScenarioSchema, ShippedFileEqualsTable) {
  const std::string shipped = test::shippedScenario("schema/emscape-scenario.schema.json");
  if (std::getenv("EMSCAPE_WRITE_SCHEMA") != nullptr) emscape::test::writeFile(shipped, scenarioJsonSchema());
  EXPECT_TRUE(test::readFile(shipped) == scenarioJsonSchema()) << "EMSCAPE_WRITE_SCHEMA=1 writes " << shipped;
}

TEST(ScenarioSchema, EveryReferenceHasItsDefinition) {
  const auto schema = nlohmann::json::parse(scenarioJsonSchema());
  const std::function<void(const nlohmann::json&)> visit = [&](const nlohmann::json& node) {
    if (node.is_object() && node.contains("$ref")) {
      EXPECT_TRUE(schema.contains(nlohmann::json::json_pointer(node["$ref"].get<std::string>().substr(1))))
          << node;
    }
    for (const auto& child : node) {
      if (child.is_structured()) visit(child);
    }
  };
  visit(schema);
}

/// Visits every row of the table.
void forEachKey(const ObjectSpec& spec, const std::function<void(const KeySpec&)>& visit) {
  for (const KeySpec& key : spec.keys) {
    visit(key);
    const ValueSpec* value = &key.value;
    while (value->item) value = value->item.get();
    if (value->object != nullptr) forEachKey(*value->object, visit);
  }
}

TEST(ScenarioSchema, EveryQuantityWithAUnitEndsInIt) {
  for (const ObjectSpec* spec : {&scenarioSpec(), &trackRowSpec()}) {
    forEachKey(*spec, [](const KeySpec& key) {
      if (unitOf(key.value).empty() || key.name == std::string("seconds")) return;  // is its unit
      EXPECT_NE(stemOf(key), key.name) << key.name << " " << unitOf(key.value);
    });
  }
}

TEST(ScenarioSchema, EveryDefaultIsWithinItsRange) {
  forEachKey(scenarioSpec(), [](const KeySpec& key) {
    const double* value = std::get_if<double>(&key.default_value);
    if (value == nullptr) return;
    EXPECT_GE(*value, key.value.minimum) << key.name;
    EXPECT_LE(*value, key.value.maximum) << key.name;
  });
}

}  // namespace
}  // namespace emscape::scenario
