// Recordings of scenarios, and scenarios of those.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "emscape/scenario/file/scenario_file.h"
#include "emscape/scenario/model/snapshot.h"
#include "interop/export_scenario.h"
#include "interop/import_scenario.h"
#include "recording/read_recording.h"
#include "tests/interop/there_and_back.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::interop {
namespace {

using test::ScenarioPtr;
using testing::HasSubstr;

class RoundTrip : public testing::TestWithParam<const char*> {};

TEST_P(RoundTrip, PositionsAnglesAndEmittersStay) {
  const ScenarioPtr before = scenario::loadScenario(emscape::test::shippedScenario("jacksboro.yaml"));
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*before);
  const test::ThereAndBack way(before, terrain.get(), GetParam());
  EXPECT_GT(way.exported.records, 100);
  EXPECT_EQ(way.back.result.tally.bad, 0) << way.back.result.tally.first_bad;
  const ScenarioPtr after = way.back.scenario;
  EXPECT_EQ(after->clock.epoch_utc.substr(0, 19), before->clock.epoch_utc.substr(0, 19));
  EXPECT_NEAR(after->clock.duration_s, before->clock.duration_s, 0.01);
  EXPECT_EQ(after->platforms.size(), before->platforms.size());
  const bool is_dis = std::string(GetParam()) == ".pcap";
  const double position_m = is_dis ? 0.01 : 0.02, height_m = is_dis ? 0.01 : 0.006;
  for (const double t_s : {0.0, 37.0, 81.0, 119.0}) {
    const scenario::Snapshot a = scenario::instantAt(before, terrain.get(), t_s);
    const scenario::Snapshot b = scenario::instantAt(after, nullptr, t_s);
    for (std::size_t i = 0; i < before->emitters.size(); ++i) {
      const scenario::Emitter& emitter = before->emitters[i];
      std::size_t match = after->emitters.size();
      for (std::size_t j = 0; j < after->emitters.size(); ++j) {
        const std::string& name = after->emitters[j].name;
        if (name.size() >= emitter.name.size() &&
            name.compare(name.size() - emitter.name.size(), std::string::npos, emitter.name) == 0 &&
            after->emitters[j].frequency_hz > 0.999 * emitter.frequency_hz)
          match = j;
      }
      ASSERT_LT(match, after->emitters.size()) << emitter.name;
      const scenario::Emitter& found = after->emitters[match];
      const scenario::EmitterState &x = a.emitters[i], &y = b.emitters[match];
      const double apart_m = geodesicInverse(x.position.latitude_deg, x.position.longitude_deg,
                                             y.position.latitude_deg, y.position.longitude_deg)
                                 .distance_m;
      EXPECT_LT(apart_m, position_m) << emitter.name << " at " << t_s;
      EXPECT_NEAR(x.height_msl_m, y.height_msl_m, height_m) << emitter.name << " at " << t_s;
      EXPECT_NEAR(dot(x.beam.forward, y.beam.forward), 1, 1e-7) << emitter.name << " at " << t_s;
      EXPECT_EQ(x.active, y.active);
      EXPECT_NEAR(10 * std::log10(found.power_w / emitter.power_w), 0, 0.01) << emitter.name;
      EXPECT_NEAR(found.frequency_hz / emitter.frequency_hz, 1, 1e-6);
      EXPECT_EQ(found.antenna->gain_dbi, emitter.antenna->gain_dbi);
      EXPECT_EQ(found.polarization, emitter.polarization);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, RoundTrip, testing::Values(".acmi", ".zip.acmi", ".pcap", ".asi", ".cot"),
                         [](const auto& format) {
                           std::string name;
                           for (const char c : std::string(format.param)) {
                             if (c != '.') name += c;
                           }
                           return name;
                         });

constexpr const char* kFixedSites = R"(schema_version: 1
name: sites
duration_s: 30
region:
  origin: {latitude_deg: 52, longitude_deg: 5}
  size_m: [20000, 20000, 5000]
  dims: [10, 10, 5]
platforms:
  - {name: ours, side: friend, position: {latitude_deg: 52, longitude_deg: 5, height_agl_m: 40}}
  - {name: theirs, side: hostile, position: {latitude_deg: 52.01, longitude_deg: 5, height_agl_m: 40}}
  - {name: Łódź, side: neutral, position: {latitude_deg: 52.02, longitude_deg: 5, height_agl_m: 40}}
  - {name: a name of many letters, position: {latitude_deg: 52.03, longitude_deg: 5, height_agl_m: 40}}
emitters:
  - {name: beacon, platform: ours, kind: transmitter, frequency_hz: 1.0e8, power_w: 9, antenna: {pattern: isotropic}}
targets:
  - {name: drone, platform: theirs, rcs_m2: 1}
output: {quantities: [field_strength_dbuvm]}
)";

TEST_P(RoundTrip, SidesAndDurationOfFixedSitesStayAndTheRestIsTold) {
  const emscape::test::TemporaryFolder folder;
  const ScenarioPtr before = scenario::loadScenario(folder.write("sites.yaml", kFixedSites));
  const test::ThereAndBack way(before, nullptr, GetParam());
  const ExportResult& exported = way.exported;
  const bool is_dis = std::string(GetParam()) == ".pcap";
  const bool needs_epoch = std::string(GetParam()) == ".cot";
  ASSERT_EQ(exported.notes.size(), is_dis || needs_epoch ? 2u : 1u);
  EXPECT_EQ(exported.notes[0], "not in the recording: region, targets, output; emscape import --base " +
                                   before->file + " takes them from the scenario");
  if (is_dis) {
    EXPECT_THAT(exported.notes[1], HasSubstr("not ASCII: 2"));
  }
  const ScenarioPtr after = way.back.scenario;
  EXPECT_NEAR(after->clock.duration_s, 30, 1e-3);
  std::vector<std::optional<scenario::Side>> sides;
  for (const scenario::Platform& platform : after->platforms) {
    sides.push_back(platform.side);
    EXPECT_FALSE(platform.moves());
  }
  using scenario::Side;
  EXPECT_THAT(sides, testing::ElementsAre(Side::friendly, Side::hostile, Side::neutral, std::nullopt));
  if (is_dis) {
    EXPECT_EQ(after->platforms[2].name, "??d?");
  }
}

class TracksThereAndBack : public testing::TestWithParam<const char*> {};

TEST_P(TracksThereAndBack, PositionsStayAndTheRestIsTold) {
  const ScenarioPtr before = scenario::loadScenario(emscape::test::shippedScenario("jamming.yaml"));
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*before);
  const test::ThereAndBack way(before, terrain.get(), GetParam());
  ASSERT_EQ(way.exported.notes.size(), 1u);
  EXPECT_THAT(way.exported.notes[0], HasSubstr("not in the recording: times and directions of emitters"));
  EXPECT_EQ(way.back.result.tally.bad, 0) << way.back.result.tally.first_bad;
  const ScenarioPtr after = way.back.scenario;
  ASSERT_EQ(after->platforms.size(), before->platforms.size());
  ASSERT_EQ(after->emitters.size(), before->emitters.size());
  EXPECT_EQ(after->clock.epoch_utc.substr(0, 19), before->clock.epoch_utc.substr(0, 19));
  EXPECT_NEAR(after->clock.duration_s, before->clock.duration_s, 0.01);
  const double tolerance_m = std::string(GetParam()) == ".czml" ? 1 : 0.02;
  for (double t_s = 0; t_s < 60; t_s += 0.7) {
    const scenario::Snapshot a = scenario::instantAt(before, terrain.get(), t_s);
    const scenario::Snapshot b = scenario::instantAt(after, nullptr, t_s);
    for (std::size_t i = 0; i < before->platforms.size(); ++i) {
      const GeodeticPosition &x = a.platforms[i].position, &y = b.platforms[i].position;
      EXPECT_LT(length(toEcef(x) - toEcef(y)), tolerance_m) << before->platforms[i].name << " at " << t_s;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, TracksThereAndBack, testing::Values(".kml", ".czml"),
                         [](const auto& format) { return std::string(format.param).substr(1); });

/// 20 aircraft over a day are to have less than 5 MB.
TEST(Export, CzmlOfATurnHasFewDigitsAndIsWithinAMetre) {
  const emscape::test::TemporaryFolder folder;
  std::string track = "t_s,latitude_deg,longitude_deg,height_msl_m\n";
  for (int t_s = 0; t_s <= 1000; t_s += 10) {
    track += std::to_string(t_s) + "," + std::to_string(52 + 0.2 * std::cos(0.01 * t_s)) + "," +
             std::to_string(5 + 0.3 * std::sin(0.01 * t_s)) + "," + std::to_string(6000 + 0.3 * t_s) + "\n";
  }
  folder.write("turn.csv", track);
  std::string text = kFixedSites;
  text.replace(text.find("duration_s: 30"), 14, "duration_s: 1000");
  const std::string site = "position: {latitude_deg: 52.03, longitude_deg: 5, height_agl_m: 40}";
  text.replace(text.find(site), site.size(), "track: {file: turn.csv}");
  const ScenarioPtr before = scenario::loadScenario(folder.write("turn.yaml", text));
  const test::ThereAndBack way(before, nullptr, ".czml");
  const std::string czml = emscape::test::readFile(way.exported.file);
  const std::size_t packet = czml.find("\"platform/4\""), begin = czml.find('[', packet),
                    end = czml.find(']', begin);
  const auto numbers = std::count(czml.begin() + static_cast<std::ptrdiff_t>(begin),
                                  czml.begin() + static_cast<std::ptrdiff_t>(end), ',') +
                       1;
  EXPECT_EQ(numbers, 4 * 101) << "each point of the track is a corner";
  EXPECT_LT(static_cast<double>(end - begin) / 101, 5e6 / (20 * 8641));
  for (double t_s = 0; t_s <= 1000; t_s += 3.7) {
    const scenario::Snapshot a = scenario::instantAt(before, nullptr, t_s),
                             b = scenario::instantAt(way.back.scenario, nullptr, t_s);
    EXPECT_LT(length(toEcef(a.platforms[3].position) - toEcef(b.platforms[3].position)), 1) << t_s;
  }
}

TEST(Export, PlatformIsInTheRecordingOnlyDuringItsTrack) {
  scenario::Scenario late = *scenario::loadScenario(emscape::test::shippedScenario("jamming.yaml"));
  const std::string platform = "helicopter";
  late.set("platforms." + platform + ".track",
           "{points: [{t_s: 20, latitude_deg: 36.3, longitude_deg: -84.2, height_msl_m: 2000}, {t_s: 40, "
           "latitude_deg: 36.31, longitude_deg: -84.2, height_msl_m: 2000}]}");
  const auto before = std::make_shared<const scenario::Scenario>(late);
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*before);
  for (const char* ending : {".acmi", ".pcap", ".asi", ".cot", ".kml", ".czml"}) {
    const emscape::test::TemporaryFolder folder;
    const ExportResult exported = exportScenario(before, terrain.get(), folder / (std::string("a") + ending));
    const Recording recording = readRecording(exported.file);
    bool is_found = false;
    for (const RecordedObject& object : recording.objects) {
      if (object.name != platform || object.poses.empty()) continue;
      is_found = true;
      double begin_s = object.poses.front().t_s, end_s = object.poses.back().t_s;
      EXPECT_NEAR(end_s - begin_s, 20, 0.1) << ending;
    }
    EXPECT_TRUE(is_found) << ending;
  }
}

TEST(Export, OfAnEmitterThatIsSwitchedOffIsSilent) {
  const emscape::test::TemporaryFolder folder;
  scenario::Scenario off = *scenario::loadScenario(emscape::test::shippedScenario("quick.yaml"));
  for (const char* name : {"radar", "transmitter"})
    off.set(std::string("emitters.") + name + ".enabled", "false");
  const ExportResult exported =
      exportScenario(std::make_shared<scenario::Scenario>(off), nullptr, folder / "off.pcap");
  const Recording recording = readRecording(exported.file);
  for (const RecordedBeam& beam : recording.beams) {
    for (const BeamState& state : beam.states) EXPECT_FALSE(state.is_on) << beam.name;
  }
}

TEST(Export, TimesThatACaptureCannotHoldAreRefused) {
  const emscape::test::TemporaryFolder folder;
  scenario::Scenario early = *scenario::loadScenario(emscape::test::shippedScenario("quick.yaml"));
  early.set("epoch", "1944-06-06T05:00:00Z");
  const auto scenario = std::make_shared<scenario::Scenario>(early);
  EXPECT_THAT(emscape::test::errorOf([&] { exportScenario(scenario, nullptr, folder / "a.pcap"); },
                                     ErrorCode::bad_input),
              HasSubstr("epoch: 1944-06-06T05:00:00Z: captures hold times from 1970 to 2106"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.pcap"));
}

TEST(Export, UnknownEndingIsRefused) {
  const ScenarioPtr scenario = scenario::loadScenario(emscape::test::shippedScenario("quick.yaml"));
  EXPECT_THAT(emscape::test::errorOf([&] { exportScenario(scenario, nullptr, "a.hla"); }, ErrorCode::usage),
              HasSubstr("'a.hla' is no name of a recording; it ends in .zip.acmi, .acmi, .pcap, .asi, .cot"));
}

TEST(Export, EmittersOfOneNameWithTheirPlatformStayApart) {
  const emscape::test::TemporaryFolder folder;
  const ScenarioPtr before = scenario::loadScenario(folder.write("twins.yaml", R"(schema_version: 1
name: twins
duration_s: 30
region:
  origin: {latitude_deg: 52, longitude_deg: 5}
  size_m: [20000, 20000, 5000]
  dims: [10, 10, 5]
platforms:
  - {name: jammer, position: {latitude_deg: 52, longitude_deg: 5, height_agl_m: 40}}
  - {name: silent, position: {latitude_deg: 52.1, longitude_deg: 5, height_agl_m: 40}}
emitters:
  - {name: jammer, platform: jammer, kind: jammer, frequency_hz: 2.0e9, bandwidth_hz: 1.0e6, power_w: 20, antenna: {pattern: isotropic}}
  - name: radar
    platform: jammer
    kind: radar
    frequency_hz: 3.0e9
    power_w: 30
    antenna: {pattern: gaussian, beamwidth_az_deg: 3, beamwidth_el_deg: 3}
    receiver: {noise_figure_db: 4, bandwidth_hz: 1.0e6}
  - {name: silent, platform: jammer, kind: jammer, frequency_hz: 4.0e9, bandwidth_hz: 1.0e6, power_w: 40, antenna: {pattern: isotropic}}
output: {quantities: [power_density_dbwm2]}
)"));
  for (const char* ending : {".acmi", ".pcap", ".asi", ".cot"}) {
    const test::ThereAndBack way(before, nullptr, ending);
    const ScenarioPtr after = way.back.scenario;
    std::vector<double> frequencies;
    for (const scenario::Emitter& emitter : after->emitters) {
      EXPECT_EQ(after->platforms[static_cast<std::size_t>(emitter.platform)].name, "jammer") << ending;
      EXPECT_NEAR(emitter.power_w, emitter.frequency_hz / 1e8, 1e-3) << ending << " " << emitter.name;
      frequencies.push_back(emitter.frequency_hz);
    }
    EXPECT_THAT(frequencies, testing::UnorderedElementsAre(2e9, 3e9, 4e9)) << ending;
  }
}

TEST(Export, ShippedRecordingAndItsDatabaseAreWhatItWrites) {
  const emscape::test::TemporaryFolder folder;
  const ScenarioPtr scenario = scenario::loadScenario(emscape::test::shippedScenario("jamming.yaml"));
  const scenario::TerrainPtr terrain = scenario::loadTerrain(*scenario);
  const ExportResult exported = exportScenario(scenario, terrain.get(), folder / "jamming.zip.acmi");
  const std::string shipped = emscape::test::shippedScenario("recordings/jamming.zip.acmi");
  EXPECT_EQ(emscape::test::readFile(exported.emitters), emscape::test::readFile(shipped + ".emitters.yaml"));
  const Recording a = readRecording(exported.file), b = readRecording(shipped);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (std::size_t i = 0; i < a.objects.size(); ++i)
    EXPECT_EQ(a.objects[i].poses.size(), b.objects[i].poses.size());
}

TEST(Export, MoreEmittersThanDisCanNumberAreRefused) {
  const emscape::test::TemporaryFolder folder;
  std::string text = kFixedSites;
  const std::size_t at = text.find("targets:");
  std::string emitters;
  for (int i = 0; i < 256; ++i) {
    emitters +=
        "  - {name: j" + std::to_string(i) +
        ", platform: ours, kind: jammer, frequency_hz: 1.0e9, bandwidth_hz: 1.0e6, power_w: 1, antenna: "
        "{pattern: isotropic}}\n";
  }
  const ScenarioPtr many = scenario::loadScenario(folder.write("many.yaml", text.insert(at, emitters)));
  EXPECT_THAT(
      emscape::test::errorOf([&] { exportScenario(many, nullptr, folder / "a.pcap"); }, ErrorCode::bad_input),
      HasSubstr("the platform 'ours' has 256 radars and jammers, more than the 255 that DIS can number"));
}

}  // namespace
}  // namespace emscape::interop
