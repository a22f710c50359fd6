// Scenarios of recordings, and recordings of scenarios.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "emscape/scenario/model/snapshot.h"
#include "interop/export_scenario.h"
#include "interop/import_scenario.h"
#include "interop/importing/beam_pieces.h"
#include "interop/importing/scenario_text.h"
#include "recording/read_recording.h"
#include "tests/interop/there_and_back.h"
#include "tests/support/errors.h"
#include "tests/support/files.h"
#include "tests/support/reference_data.h"
#include "tests/support/temporary_folder.h"

namespace emscape::interop {
namespace {

using test::ScenarioPtr;
using testing::HasSubstr;

RecordedObject objectAt(const std::string& name, const std::string& type, double latitude_deg,
                        double height_m, double moves_deg = 0) {
  RecordedObject object;
  object.name = object.keys.acmi_name = name;
  object.type = object.keys.acmi_type = type;
  for (int i = 0; i <= 10; ++i)
    object.poses.push_back({10.0 * i, latitude_deg + moves_deg * i, 5, height_m, 90, 0, 0});
  return object;
}

BeamState stateAt(double t_s, bool is_on) {
  BeamState state;
  state.t_s = t_s;
  state.is_on = is_on;
  state.frequency_hz = 3e9;
  state.erp_dbm = 93;
  state.azimuth_deg = state.elevation_deg = 0;
  state.azimuth_half_sweep_deg = 180;
  return state;
}

Recording smallRecording() {
  Recording recording;
  recording.file = "test.acmi";
  recording.format = "ACMI 2.2";
  recording.objects.push_back(objectAt("ship", "Sea+Watercraft", 52, -1));
  recording.objects.push_back(objectAt("MiG-29", "Air+FixedWing", 52.1, 3000, 0.01));
  recording.objects.push_back(objectAt("bullseye", "Navaid+Static+Bullseye", 40, 0));
  recording.objects.back().domain = Domain::scenery;
  return recording;
}

class Import : public testing::Test {
 protected:
  ImportResult import(const Recording& recording, const ImportOptions& options = {}) {
    imported_.import(recording, options);
    return result_;
  }
  test::Imported imported_;
  const emscape::test::TemporaryFolder& folder_ = imported_.folder;
  const ImportResult& result_ = imported_.result;
  const ScenarioPtr& scenario_ = imported_.scenario;
};

TEST_F(Import, ObjectsHaveThePlatformsAndEmittersOfTheirTypes) {
  import(smallRecording());
  ASSERT_EQ(scenario_->platforms.size(), 2u);
  ASSERT_EQ(scenario_->emitters.size(), 2u);
  EXPECT_EQ(scenario_->emitters[0].name, "ship navigation radar");
  EXPECT_EQ(scenario_->emitters[1].name, "MiG-29 fire-control radar");
  EXPECT_EQ(scenario_->platforms[0].track.size(), 1u) << "it does not move";
  EXPECT_EQ(scenario_->platforms[1].track.size(), 11u);
  EXPECT_EQ(scenario_->clock.duration_s, 100);
  EXPECT_EQ(result_.left_out.at("scenery"), 1);
  EXPECT_NEAR(scenario_->platforms[0].track[0].position.height_msl_m.value(), 19, 1e-9)
      << "the antenna's height";
}

TEST_F(Import, PositionsBelowTheGroundAreRaisedAndTold) {
  Recording recording = smallRecording();
  recording.objects[1] = objectAt("F-14", "Air+FixedWing", 52.1, -3);
  import(recording);
  EXPECT_THAT(result_.notes, testing::Contains(HasSubstr("up to 3.0 m below mean sea level")));
}

TEST_F(Import, PositionsOutsideTheTerrainAreTold) {
  ImportOptions options;
  options.terrain = {emscape::test::shippedScenario("data/jacksboro.tif")};
  import(smallRecording(), options);
  EXPECT_THAT(result_.notes,
              testing::Contains(HasSubstr("positions are where the elevation files have no height")));
}

TEST_F(Import, BeamIsAnEmitterWithThePowerOfTheRecordingAndTheAntennaOfTheDatabase) {
  Recording recording = smallRecording();
  RecordedBeam beam;
  beam.object = 0;
  beam.name = "emitter 4711, beam 1";
  beam.kind = BeamKind::radar;
  beam.keys = {4711, 2, 1, 0, {}};
  beam.states = {stateAt(10, true), stateAt(20, false), stateAt(30, true)};
  recording.beams.push_back(beam);
  import(recording);
  const scenario::Emitter& emitter = scenario_->emitters[0];
  EXPECT_EQ(emitter.name, "ship search radar");
  EXPECT_EQ(emitter.frequency_hz, 3e9);
  EXPECT_NEAR(10 * std::log10(emitter.power_w) + 30 + emitter.antenna->gain_dbi, 93, 1e-3);
  ASSERT_EQ(emitter.active_s.size(), 2u);
  EXPECT_EQ(emitter.active_s[0].begin_s, 10);
  EXPECT_EQ(emitter.active_s[0].end_s, 20);
  EXPECT_EQ(emitter.active_s[1].begin_s, 30);
  EXPECT_EQ(emitter.scan.kind, scenario::ScanKind::rotate);
}

TEST_F(Import, UnmatchedBeamsAreNamedOrHaveTheDefault) {
  Recording recording = smallRecording();
  RecordedBeam beam;
  beam.object = 0;
  beam.name = "emitter 4711, beam 1";
  beam.kind = BeamKind::radar;
  beam.keys = {4711, 2, 99, 0, {}};
  beam.states = {stateAt(0, true)};
  recording.beams.push_back(beam);
  recording.objects[0].keys = {};
  import(recording);
  EXPECT_EQ(scenario_->emitters.size(), 1u);
  EXPECT_EQ(result_.emitters.at(0).name, "emitter 4711, beam 1");
  EXPECT_EQ(result_.emitters.at(0).fault, "not in the database");

  ImportOptions options;
  options.emitters =
      folder_.write("db.yaml", "schema_version: 1\nunmatched: default\ndefault: {kind: transmitter}\n");
  import(recording, options);
  ASSERT_EQ(scenario_->emitters.size(), 2u);
  EXPECT_EQ(scenario_->emitters[0].kind, scenario::EmitterKind::transmitter);
  EXPECT_NEAR(10 * std::log10(scenario_->emitters[0].power_w) + 30 + scenario_->emitters[0].antenna->gain_dbi,
              93, 1e-3);
}

TEST_F(Import, DatabaseThatMatchesDescribesTheWholeRecording) {
  const auto databaseOf = [this](const std::string& name, const std::string& more) {
    ImportOptions options;
    options.emitters = folder_.write(
        "db.yaml",
        "schema_version: 1\nemitters:\n  - name: MiG-29 radar\n    match: {acmi_name: \"" + name +
            "\"}\n    emitter: {kind: transmitter, frequency_hz: 1.0e9, power_w: 1, antenna: {pattern: "
            "isotropic}}\n" +
            more);
    return options;
  };
  import(smallRecording(), databaseOf("MiG*", ""));
  ASSERT_EQ(scenario_->emitters.size(), 1u) << "the ship tells no emission";
  EXPECT_EQ(scenario_->emitters[0].name, "MiG-29 radar") << "the platform's name is not doubled";
  EXPECT_THAT(result_.notes, testing::Contains(HasSubstr("no row of db.yaml matches: 1;")));
  import(smallRecording(), databaseOf("MiG*", "unmatched: default\ndefault: {kind: transmitter}\n"));
  EXPECT_EQ(scenario_->emitters.size(), 2u);
  import(smallRecording(), databaseOf("nothing here", ""));
  EXPECT_EQ(scenario_->emitters.size(), 2u);
}

TEST_F(Import, TellsWhatRecordingsDoNotHave) {
  import(smallRecording());
  EXPECT_THAT(
      result_.notes,
      testing::Contains("recordings have no terrain, ground, atmosphere, targets or receivers: flat "
                        "land at mean sea level, average ground and the standard atmosphere are "
                        "assumed; elevation files are given by --terrain, a scenario that has them is "
                        "given by --base"));
}

TEST(JoinedName, HasEachPartOnce) {
  EXPECT_EQ(joinedName("helicopter", "jammer"), "helicopter jammer");
  EXPECT_EQ(joinedName("helicopter", "helicopter jammer"), "helicopter jammer");
  EXPECT_EQ(joinedName("helicopter jammer", "jammer"), "helicopter jammer");
  EXPECT_EQ(joinedName("helicopter jammer 2", "helicopter jammer"), "helicopter jammer 2");
  EXPECT_EQ(joinedName("radar", "radar"), "radar");
  EXPECT_EQ(joinedName("F", "Furuno"), "F Furuno");
}

TEST_F(Import, BeamThatFollowsATargetPointsWhereItPointed) {
  Recording recording = smallRecording();
  RecordedBeam beam;
  beam.object = 1;
  beam.kind = BeamKind::radar;
  for (int i = 0; i < 10; ++i) {
    BeamState state = stateAt(10 * i, true);
    state.frequency_hz = state.erp_dbm = kUnknown;
    state.azimuth_half_sweep_deg = kUnknown;
    state.beamwidth_az_deg = 3;
    state.azimuth_deg = 5 * i;
    state.elevation_deg = -i;
    beam.states.push_back(state);
  }
  recording.beams.push_back(beam);
  import(recording);
  const scenario::Emitter& emitter = scenario_->emitters[1];
  ASSERT_EQ(emitter.scan.kind, scenario::ScanKind::dwell_list);
  for (int i = 0; i < 10; ++i) {
    const scenario::BeamDirection direction = scenario::beamAt(emitter.scan, 10 * i + 5);
    EXPECT_NEAR(direction.azimuth_deg, 5 * i, 0.01);
    EXPECT_NEAR(direction.elevation_deg, -i, 0.01);
  }
}

TEST_F(Import, BeamHeldOnATargetPointsAtIt) {
  Recording recording = smallRecording();
  recording.objects[0] = objectAt("site", "Ground+AntiAircraft", 52, 10);
  recording.objects[1].poses.clear();
  for (int i = 0; i <= 10; ++i)  // from north to east of the site, whose heading is east
    recording.objects[1].poses.push_back({10.0 * i, 52.2 - 0.02 * i, 5 + 0.03 * i, 3000, 90, 0, 0});
  RecordedBeam beam;
  beam.object = 0;
  beam.kind = BeamKind::radar;
  beam.keys.dis_beam_function = 4;
  BeamState state = stateAt(0, true);
  state.target = 1;
  beam.states = {state};
  recording.beams.push_back(beam);
  import(recording);
  for (const double t_s : {5.0, 50.0, 95.0}) {
    const scenario::Snapshot snapshot = scenario::instantAt(scenario_, nullptr, t_s);
    const scenario::EmitterState& emitter = snapshot.emitters[0];
    const GeodesicInverse way = geodesicInverse(emitter.position.latitude_deg, emitter.position.longitude_deg,
                                                snapshot.platforms[1].position.latitude_deg,
                                                snapshot.platforms[1].position.longitude_deg);
    const Vec3d forward = emitter.beam.forward;
    EXPECT_NEAR(std::atan2(forward.x, forward.y), way.azimuth_rad, 0.02) << t_s;
    EXPECT_NEAR(forward.z, 3000 / way.distance_m, 0.02) << t_s;
  }
}

TEST_F(Import, WideBeamIsTheSearchedSector) {
  Recording recording = smallRecording();
  RecordedBeam beam;
  beam.object = 1;
  beam.kind = BeamKind::radar;
  BeamState state = stateAt(0, true);
  state.frequency_hz = state.erp_dbm = state.azimuth_half_sweep_deg = kUnknown;
  state.beamwidth_az_deg = 120;
  beam.states = {state};
  recording.beams.push_back(beam);
  import(recording);
  EXPECT_EQ(scenario_->emitters[1].scan.kind, scenario::ScanKind::raster);
  EXPECT_EQ(scenario_->emitters[1].scan.width_deg, 120);
  EXPECT_THAT(result_.notes, testing::Contains(HasSubstr("taken as the sector that the beam searches")));
}

TEST_F(Import, PartOfTheTimesBeginsAtZero) {
  ImportOptions options;
  options.times = TimeSpan{20, 50};
  import(smallRecording(), options);
  EXPECT_EQ(scenario_->clock.duration_s, 30);
  const scenario::TrackPoint point = scenario::pointAt(scenario_->platforms[1], 0);
  EXPECT_NEAR(point.position.latitude_deg, 52.12, 1e-9);
}

TEST_F(Import, EpochYearsFromThatOfTheBaseIsToldWithItsLikelyCause) {
  scenario::Scenario base;
  base.clock.epoch_utc = "2026-06-01T06:00:00Z";
  EXPECT_EQ(farEpochText(1780293600000 + 86400000, base), "");
  EXPECT_EQ(farEpochText(std::nullopt, base), "");
  EXPECT_THAT(farEpochText(1464328818000, base),
              testing::AllOf(HasSubstr("begins 2016-05-27T06:00:18"), HasSubstr("10.0 years before"),
                             HasSubstr("GPS time")));
}

TEST_F(Import, RecordingIsAddedToABase) {
  ImportOptions options;
  options.base = folder_.write("base/base.yaml", R"(# my site
schema_version: 1
name: site
duration_s: 10
region:
  origin: {latitude_deg: 52, longitude_deg: 5}
  size_m: [20000, 20000, 5000]
  dims: [10, 10, 5]
platforms:
  - {name: mast, position: {latitude_deg: 52, longitude_deg: 5, height_agl_m: 40}}
emitters:
  - name: beacon  # of the mast
    platform: mast
    kind: transmitter
    frequency_hz: 100.0e6
    power_w: 1000
    antenna: {pattern: isotropic}
output: {quantities: [field_strength_dbuvm]}
)");
  import(smallRecording(), options);
  ASSERT_EQ(scenario_->platforms.size(), 3u);
  ASSERT_EQ(scenario_->emitters.size(), 3u);
  EXPECT_EQ(scenario_->emitters[0].name, "beacon");
  EXPECT_EQ(scenario_->output.quantities, std::vector<std::string>{"field_strength_dbuvm"});
  EXPECT_EQ(scenario_->clock.duration_s, 100);
  EXPECT_THAT(emscape::test::readFile(folder_ / "out.yaml"), HasSubstr("# of the mast"));
}

TEST_F(Import, ObjectsWithTheNamesOfPlatformsOfTheBaseMoveThoseAndDoubleNoEmitter) {
  const std::string head = R"(schema_version: 1
name: site
duration_s: 10
region: {origin: {latitude_deg: 52, longitude_deg: 5}, size_m: [20000, 20000, 5000], dims: [10, 10, 5]}
)";
  const std::string tail = R"(emitters:
  - {name: N019, platform: MiG-29, kind: radar, frequency_hz: 9.0e9, power_w: 1000, antenna: {pattern: gaussian, beamwidth_az_deg: 3, beamwidth_el_deg: 3}, receiver: {noise_figure_db: 5, bandwidth_hz: 1.0e6}}
targets:
  - {name: bandit, platform: MiG-29, rcs_m2: 3}
)";
  Recording recording = smallRecording();
  recording.objects.push_back(recording.objects[1]);
  recording.objects.back().id = "second";
  for (const std::string platforms :
       {"platforms:\n"
        "  - name: MiG-29  # ours\n"
        "    position:\n"
        "      {latitude_deg: 52, longitude_deg: 5, height_agl_m: 40}\n"
        "    attitude: {heading_deg: 3}\n"
        "    side: hostile\n"
        "  - name: ship\n"
        "    track: {points: [{t_s: 0, latitude_deg: 52, longitude_deg: 5, height_msl_m: 9}, {t_s: 9, "
        "latitude_deg: 52, longitude_deg: 5.1, height_msl_m: 9}], outside: hold}\n",
        "platforms: [{name: MiG-29, attitude: {heading_deg: 3}, position: {latitude_deg: 52, longitude_deg: "
        "5, "
        "height_agl_m: 40}, side: hostile}, {name: ship, position: {latitude_deg: 52, longitude_deg: 5, "
        "height_agl_m: 40}}]\n"}) {
    ImportOptions options;
    options.base = folder_.write("base/base.yaml", head + platforms + tail);
    import(recording, options);
    ASSERT_EQ(scenario_->platforms.size(), 3u) << platforms;
    EXPECT_EQ(scenario_->name, "out") << "as the file, not as the base";
    EXPECT_EQ(scenario_->platforms[0].track.size(), 11u);
    EXPECT_EQ(scenario_->platforms[0].side, Side::hostile);
    EXPECT_EQ(scenario_->platforms[1].track.size(), 1u) << "the ship of the recording rests";
    EXPECT_EQ(scenario_->platforms[1].attitude.heading_deg, 90);
    EXPECT_EQ(scenario_->platforms[2].name, "MiG-29 2") << "a platform is moved by one object";
    ASSERT_EQ(scenario_->emitters.size(), 3u) << "the ship of the base has none";
    EXPECT_EQ(scenario_->emitters[0].name, "N019");
    EXPECT_EQ(scenario_->emitters[1].name, "ship navigation radar");
    EXPECT_EQ(scenario_->targets.at(0).platform, 0);
    EXPECT_THAT(result_.moved, testing::ElementsAre("ship", "MiG-29"));
    EXPECT_THAT(
        result_.notes,
        testing::IsSupersetOf(
            {"the recording moves 2 platforms of the base, whose emitters, receivers and targets stay: "
             "'ship', 'MiG-29'; added to the base: 1 platform, 2 emitters",
             "1 object has a name that is in use, and a number after it: 'MiG-29 2'"}));
    EXPECT_EQ(result_.emitters.back().fault, "");
    EXPECT_THAT(result_.emitters, testing::Contains(testing::Field(&ImportedEmitters::fault,
                                                                   "its platform has 'N019' in the base")));
  }
}

TEST_F(Import, MovedPlatformsOfMarkingsThatAreCutAreThoseThatBeginSo) {
  scenario::Scenario base;
  for (const char* name : {"ridge site north", "ridge site east", "mast", "ridge site "})
    base.platforms.emplace_back().name = name;
  using testing::ElementsAre;
  using testing::Optional;
  EXPECT_THAT(movedPlatforms({"mast", "ridge site ", "ridge site ", "ridge site", "mast"}, base),
              ElementsAre(Optional(2), Optional(3), Optional(0), std::nullopt, std::nullopt));
}

TEST_F(Import, ScenarioBeginsAtTheFirstPositionAndEndsAtTheLast) {
  Recording recording = smallRecording();
  for (RecordedObject& object : recording.objects) {
    for (PoseSample& pose : object.poses) pose.t_s += 0.0139999;  // a tick before the millisecond
  }
  recording.epoch_ms = 0;
  import(recording);
  EXPECT_EQ(scenario_->clock.epoch_utc, "1970-01-01T00:00:00.014Z");
  EXPECT_EQ(scenario_->clock.duration_s, 100);
  EXPECT_TRUE(scenario_->platforms[1].isPresentAt(0));
  EXPECT_TRUE(scenario_->platforms[1].isPresentAt(100));
}

TEST_F(Import, TypesAreToldInWords) {
  Recording recording = smallRecording();
  recording.objects[0].keys.cot_type = recording.objects[0].type = "a-u-S";
  recording.objects[0].domain = Domain::sea;
  recording.objects[1].keys.dis_entity_type = {1, 2, 225, 1, 0, 0, 0};
  recording.objects[1].type = "1.2.225.1.0.0.0";
  import(recording);
  ASSERT_EQ(result_.types.size(), 2u);
  EXPECT_EQ(result_.types[0].text, "air platform (1.2.225.1.0.0.0)");
  EXPECT_EQ(result_.types[1].text, "sea, unknown side (a-u-S)");
}

TEST_F(Import, OnlyTheNamedObjectsAreTaken) {
  ImportOptions options;
  options.only = {"mig*"};
  import(smallRecording(), options);
  ASSERT_EQ(scenario_->platforms.size(), 1u);
  options.only = {"nothing"};
  EXPECT_THAT(emscape::test::errorOf([&] { import(smallRecording(), options); }, ErrorCode::bad_input),
              HasSubstr("no object is left"));
}

TEST_F(Import, WithoutAnyEmitterTheErrorNamesTheRemedy) {
  Recording recording = smallRecording();
  recording.objects.erase(recording.objects.begin(), recording.objects.begin() + 2);
  recording.objects[0].domain = Domain::land;
  recording.objects[0].keys = {};
  EXPECT_THAT(emscape::test::errorOf([&] { import(recording); }, ErrorCode::bad_input),
              HasSubstr("no emitter is left of 1 object. Add the objects to a scenario with emitters (--base "
                        "FILE), give "));
}

TEST(ImportRegion, TextIsALatitudeALongitudeAndASize) {
  EXPECT_EQ(parseRegion("36.3,-84,80").longitude_deg, -84);
  for (const char* text : {"", "1,2", "1,2,3,4", "91,0,10", "1,2,x", "1,2,0"})
    EXPECT_THAT(emscape::test::errorOf([&] { parseRegion(text); }, ErrorCode::usage),
                HasSubstr("is not auto or LAT,LON,SIZE_KM"));
}

TEST(BeamPieces, EqualSettingsAreOnePieceDifferentOnesSeveral) {
  RecordedBeam beam;
  for (int i = 0; i < 6; ++i) {
    BeamState state = stateAt(i, true);
    state.frequency_hz = i % 2 == 0 ? 3e9 : 3.1e9;
    beam.states.push_back(state);
  }
  bool cut = false;
  const auto pieces = piecesOf(beam, {{0, 10}}, cut);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(pieces[0].active.size(), 3u);
  EXPECT_EQ(pieces[1].active.back().end_s, 10);
  EXPECT_FALSE(cut);
}

TEST(BeamPieces, SettingsAboveTheirLargestNumberAreLeftOut) {
  RecordedBeam beam;
  for (int i = 0; i <= static_cast<int>(kMaxPieces); ++i) {
    BeamState state = stateAt(i, true);
    state.frequency_hz = 1e9 + i * 1e8;
    beam.states.push_back(state);
  }
  bool cut = false;
  const auto pieces = piecesOf(beam, {{0, 100}}, cut);
  ASSERT_EQ(pieces.size(), kMaxPieces);
  EXPECT_TRUE(cut);
  EXPECT_EQ(pieces.back().active.back().end_s, static_cast<double>(kMaxPieces)) << "not beyond its own time";
}

TEST(ShippedRecordings, BecomeTheScenarioThatTheyWereMadeOf) {
  for (const char* name : {"jamming.zip.acmi", "jamming.pcap"}) {
    const std::string file = emscape::test::shippedScenario(std::string("recordings/") + name);
    ImportOptions options;
    options.emitters = file + ".emitters.yaml";
    const test::Imported imported(readRecording(file), options);
    const ScenarioPtr scenario = imported.scenario;
    const ImportResult& result = imported.result;
    ASSERT_EQ(scenario->emitters.size(), 2u) << name;
    EXPECT_EQ(scenario->emitters[0].name, "ridge site search radar") << name;
    EXPECT_EQ(scenario->emitters[1].name, "helicopter stand-off jammer") << name;
    EXPECT_NEAR(result.duration_s, 60, 1e-3) << name;
    EXPECT_EQ(scenario->clock.epoch_utc.substr(0, 19), "2026-06-01T06:00:00") << name;
  }
}

TEST(PublicRecordings, BecomeScenarios) {
  const auto file = emscape::test::referenceFile("interop/acmi/kavinsky_simple.zip.acmi");
  if (!file) GTEST_SKIP() << emscape::test::notInRepository("interop/acmi/kavinsky_simple.zip.acmi");
  const test::Imported imported(readRecording(*file));
  const ScenarioPtr scenario = imported.scenario;
  const ImportResult& result = imported.result;
  EXPECT_EQ(scenario->platforms.size(), 11u) << "without the three reference points";
  EXPECT_EQ(scenario->emitters.size(), 7u) << "six ships and the F-14";
  EXPECT_NEAR(result.duration_s, 221, 1);
}

}  // namespace
}  // namespace emscape::interop
