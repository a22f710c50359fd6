#include "emscape/scenario/model/edit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <tuple>

#include "document/document.h"
#include "document/text_edit.h"
#include "emscape/scenario/file/scenario_file.h"
#include "scenario/file/save_scenario.h"
#include "scenario/file/schema.h"
#include "scenario/file/source.h"
#include "tests/scenario/random_edits.h"
#include "tests/scenario/scenario_files.h"

namespace emscape::scenario {
namespace {

using document::DocumentNode;
using document::DocumentNodePtr;
using test::TemporaryFolder;
using ::testing::HasSubstr;

const std::string kSmall = R"(# a comment at the top
schema_version: 1   # of the format
name: small
duration_s: 10
region:
  origin: {latitude_deg: 36, longitude_deg: -84}
  size_m: [1000, 1000, 1000]
  dims: [4, 4, 4]
platforms:
  - name: site   # the only one
    position:
      latitude_deg: 36
      longitude_deg: -84
      height_msl_m: 100
  # between two
  - {name: "a.b", position: {latitude_deg: 36.001, longitude_deg: -84, height_msl_m: 100}}
  - name: 'a'
    position: {latitude_deg: 36.002, longitude_deg: -84, height_msl_m: 100}
emitters:
  - name: search radar
    platform: site
    kind: transmitter
    frequency_hz: 3.0e9
    # how strong
    power_w: 20000   # peak
    antenna: {pattern: gaussian, beamwidth_az_deg: 3, beamwidth_el_deg: 4}
  - name: x=1 "q"
    platform: a.b
    kind: transmitter
    frequency_hz: 1.0e9
    power_w: 10
    antenna: {pattern: isotropic}
)";

class EditScenario : public ::testing::Test {
 protected:
  Scenario load(const std::string& text, const std::string& name = "s.yaml") {
    return *loadScenario(folder_.write(name, text));
  }
  std::string saved(const Scenario& scenario) {
    const std::string file = (folder_.path() / "saved.yaml").string();
    saveScenario(scenario, file);
    return test::readFile(file);
  }
  TemporaryFolder folder_;
};

std::string faultOf(Scenario& scenario, const std::string& path, const std::string& value) {
  const std::string hash = scenario.hash;
  const auto source = scenario.source;
  const std::string fault = test::errorOf([&] { scenario.set(path, value); }, ErrorCode::bad_input);
  if (!fault.empty()) {
    EXPECT_EQ(scenario.hash, hash) << "unchanged";
    EXPECT_EQ(scenario.source, source) << "unchanged";
  }
  return fault;
}

TEST_F(EditScenario, ChangesOnlyTheValueInTheText) {
  Scenario scenario = load(kSmall);
  const std::string hash = scenario.hash;
  scenario.set("emitters.search radar.power_w", "500");
  EXPECT_EQ(scenario.emitters[0].power_w, 500);
  EXPECT_NE(scenario.hash, hash);
  EXPECT_EQ(saved(scenario), test::replaced(kSmall, "power_w: 20000", "power_w: 500"));
  scenario.set("emitters.search radar.power_w", "20000");
  EXPECT_EQ(scenario.hash, hash);
}

TEST_F(EditScenario, AnUneditedScenarioIsSavedAsItWasRead) {
  EXPECT_EQ(saved(load(kSmall)), kSmall);
}

TEST_F(EditScenario, AddsKeysInTheStyleOfTheirMap) {
  Scenario scenario = load(kSmall);
  scenario.set("emitters.search radar.antenna.gain_dbi", "30");
  scenario.set("emitters.search radar.losses_db", "2");
  scenario.set("platforms.site.position.height_msl_m", "120");
  scenario.set("atmosphere.k_factor", "1.5");
  std::string text =
      test::replaced(kSmall, "beamwidth_el_deg: 4}", "beamwidth_el_deg: 4, gain_dbi: 30}\n    losses_db: 2");
  text = test::replaced(text, "height_msl_m: 100\n", "height_msl_m: 120\n");
  EXPECT_EQ(saved(scenario), text + "atmosphere: {k_factor: 1.5}\n");
  EXPECT_EQ(scenario.atmosphere.k_factor, 1.5);
  EXPECT_EQ(scenario.emitters[0].antenna->gain_dbi, 30);
}

TEST_F(EditScenario, NullReturnsToTheDefault) {
  Scenario scenario = load(kSmall);
  scenario.set("emitters.search radar.losses_db", "2");
  scenario.set("emitters.search radar.losses_db", "null");
  EXPECT_EQ(scenario.emitters[0].losses_db, 0);
  EXPECT_EQ(saved(scenario), kSmall);
  scenario.set("duration_s", "null");
  EXPECT_EQ(scenario.clock.duration_s, 0);
  EXPECT_EQ(saved(scenario), test::replaced(kSmall, "duration_s: 10\n", ""));
  scenario.set("atmosphere.rain_mm_h", "null");
  EXPECT_EQ(saved(scenario), test::replaced(kSmall, "duration_s: 10\n", ""))
      << "removing nothing changes nothing";
}

TEST_F(EditScenario, RemovesAnItemOfAList) {
  Scenario scenario = load(kSmall);
  scenario.set("emitters.search radar", "null");
  ASSERT_EQ(scenario.emitters.size(), 1u);
  EXPECT_EQ(scenario.emitters[0].name, "x=1 \"q\"");
  scenario.set("platforms.site", "null");
  EXPECT_THAT(saved(scenario), HasSubstr("platforms:\n  # between two\n  - {name: \"a.b\""));
}

TEST_F(EditScenario, NamesMayHoldBlanksPointsAndEqualsSigns) {
  Scenario scenario = load(kSmall);
  scenario.set("platforms.a.b.position.height_msl_m", "150");
  scenario.set("platforms.a.position.height_msl_m", "160");
  scenario.set("emitters.x=1 \"q\".power_w", "20");
  EXPECT_EQ(scenario.platforms[1].track[0].position.height_msl_m, 150);
  EXPECT_EQ(scenario.platforms[2].track[0].position.height_msl_m, 160);
  EXPECT_EQ(scenario.emitters[1].power_w, 20);
  const std::string written = toString(scenario.edits().back());
  EXPECT_EQ(written, R"(emitters."x=1 \"q\"".power_w=20)");
  EXPECT_EQ(parseEdit(written), scenario.edits().back());
  scenario.set(parseEdit(written).path, "30");
  EXPECT_EQ(scenario.emitters[1].power_w, 30);
}

TEST_F(EditScenario, EditsOfOnePathAreOneEdit) {
  Scenario scenario = load(kSmall);
  for (int i = 1; i <= 100; ++i) scenario.set("emitters.search radar.power_w", std::to_string(i));
  scenario.set("region.dims.2", "8");
  ASSERT_EQ(scenario.edits().size(), 2u);
  EXPECT_EQ(toString(scenario.edits()[0]), "emitters.search radar.power_w=100");
  EXPECT_EQ(toString(scenario.edits()[1]), "region.dims.2=8");
  EXPECT_EQ(loadScenario(scenario.file, scenario.edits())->hash, scenario.hash);
}

TEST_F(EditScenario, EditsStayInAnOrderThatWorksWhereNamesChange) {
  Scenario scenario = load(kSmall);
  scenario.set("emitters.search radar.power_w", "1");
  scenario.set("emitters.search radar.name", "other");
  scenario.set("emitters.other.power_w", "2");
  scenario.set("emitters.other.name", "search radar");
  scenario.set("emitters.search radar.power_w", "3");
  EXPECT_EQ(loadScenario(scenario.file, scenario.edits())->hash, scenario.hash);
}

TEST_F(EditScenario, ValuesThatDependOnEachOtherAreSetTogether) {
  Scenario scenario = load(kSmall);
  EXPECT_THAT(faultOf(scenario, "emitters.search radar.antenna.pattern", "phased_array"),
              HasSubstr("'columns'"));
  scenario.set({{"emitters.search radar.antenna", "{pattern: phased_array, columns: 8, rows: 4}"}});
  EXPECT_EQ(scenario.emitters[0].antenna->beamwidth_az_deg < 60, true);
  scenario.set({{"emitters.search radar.antenna.pattern", "isotropic"},
                {"emitters.search radar.antenna.columns", "null"},
                {"emitters.search radar.antenna.rows", "null"}});
  EXPECT_EQ(scenario.emitters[0].antenna->gain_dbi, 0);
}

TEST_F(EditScenario, InvalidEditIsNamedAndChangesNothing) {
  Scenario scenario = load(kSmall);
  EXPECT_EQ(faultOf(scenario, "emitters.search radar.power_w", "abc"),
            "emitters.search radar.power_w=abc: 'power_w' must be a number (W), not 'abc'");
  EXPECT_EQ(faultOf(scenario, "emitters.search radar.power_w", "5kW"),
            "emitters.search radar.power_w=5kW: 'power_w' must be a number (W), not '5kW'; write 5000");
  EXPECT_EQ(
      faultOf(scenario, "emitters.search radar.frequency_hz", "3 GHz"),
      "emitters.search radar.frequency_hz=3 GHz: 'frequency_hz' must be a number (Hz), not '3 GHz'; write "
      "3000000000");
  EXPECT_THAT(faultOf(scenario, "region.origin.longitude_deg", "288.6967"),
              testing::EndsWith("outside the allowed range -180 to 180 deg; write -71.3033"));
  EXPECT_EQ(faultOf(scenario, "atmosphere.k_factor", "99"),
            "atmosphere.k_factor=99: 'k_factor' is 99, outside the allowed range 0.5 to 10");
  EXPECT_EQ(faultOf(scenario, "emitters.serch radar.power_w", "5"),
            "emitters.serch radar.power_w=5: there is no emitter 'serch radar'; allowed are 'search radar', "
            "'x=1 \"q\"'; did you mean 'search radar'?");
  EXPECT_EQ(faultOf(scenario, "emitters.search radar.power", "5"),
            "emitters.search radar.power=5: unknown key 'power'; write 'power_w' (W)");
  EXPECT_THAT(faultOf(scenario, "atmosfere.k_factor", "1"), HasSubstr("did you mean 'atmosphere'?"));
  EXPECT_EQ(faultOf(scenario, "emitters.search radar.power_w", "null"),
            "emitters.search radar.power_w=null: 'power_w' must be given; it cannot be removed");
  EXPECT_EQ(faultOf(scenario, "region.dims.3", "4"),
            "region.dims.3=4: '3' is not an item of 'dims'; allowed are 0 to 2");
  EXPECT_EQ(faultOf(scenario, "name.first", "4"), "name.first=4: 'name' has no parts; the path ends there");
  EXPECT_THAT(faultOf(scenario, "name", ""), HasSubstr("the value is empty"));
  EXPECT_THAT(faultOf(scenario, "name", "[1"), HasSubstr("the value is not valid YAML"));
  EXPECT_THAT(faultOf(scenario, "", "1"), HasSubstr("the path is empty"));
  EXPECT_THAT(faultOf(scenario, "name.", "1"), HasSubstr("name.=1: "));
  EXPECT_THAT(faultOf(scenario, "receivers.r.gain_dbi", "1"), HasSubstr("there is no receiver 'r'"));
}

TEST_F(EditScenario, ErrorsNameAllowedValues) {
  Scenario scenario = load(kSmall);
  EXPECT_EQ(faultOf(scenario, "epoch", "2016-12-31T23:59:60Z"),
            "epoch=2016-12-31T23:59:60Z: 'epoch' must be a UTC time such as 2026-06-01T06:00:00Z, not "
            "'2016-12-31T23:59:60Z': second 60 is outside 0 to 59; there are no leap seconds");
  const std::string receivers = "[{name: q, platform: site, bandwidth_hz: 1e6}]";
  EXPECT_EQ(
      faultOf(scenario, "receivers", receivers),
      "receivers=" + receivers + ": 'platform' needs 'noise_figure_db', which the receiver does not have");
  const std::string layer = "{kind: trilinear, base_m: 500, top_m: 400, deficit_m_units: 30}";
  EXPECT_EQ(faultOf(scenario, "atmosphere.refractivity", layer),
            "atmosphere.refractivity=" + layer + ": top of the layer: 400 m is not above its base of 500 m");
  scenario.set("emitters.search radar.propagation", "parabolic_equation");
  EXPECT_THAT(faultOf(scenario, "emitters.search radar.parabolic_equation.azimuths", "100.7"),
              HasSubstr("'azimuths' must be a whole number, not 100.7"));
  EXPECT_THAT(faultOf(scenario, "emitters.search radar.parabolic_equation.azimuths", "many"),
              HasSubstr("'azimuths' must be a whole number or auto, not 'many'"));
  scenario.set("emitters.search radar.propagation", "p528");
  EXPECT_THAT(faultOf(scenario, "emitters.search radar.p528.time_percent", "0.5"),
              HasSubstr("'time_percent' is 0.5, outside the allowed range 1 to 99 percent"));
}

TEST_F(EditScenario, ErrorsElsewhereHaveLocationsInTheFile) {
  Scenario scenario = load(kSmall);
  scenario.set("platforms.site.attitude", "{roll_deg: 1}");  // a line more
  EXPECT_THAT(faultOf(scenario, "platforms.site.name", "other"),
              HasSubstr("s.yaml:21:15: there is no platform 'site'"));
  EXPECT_EQ(scenario.emitters[0].location.line, 20);
}

TEST_F(EditScenario, ReportsAllErrorsOfSeveralEdits) {
  const std::string file = folder_.write("s.yaml", kSmall);
  const ParseResult result = parseScenario(
      file, {{"nothing", "1"}, {"atmosphere.k_factor", "0"}, {"emitters.search radar.power_w", "5"}});
  EXPECT_EQ(result.scenario, nullptr);
  ASSERT_EQ(result.problems.size(), 2u);
  EXPECT_EQ(result.problems[0].location.file, "nothing=1");
  EXPECT_EQ(result.problems[1].location.file, "atmosphere.k_factor=0");
}

TEST_F(EditScenario, UnchangedAntennasAndTerrainStay) {
  Scenario scenario = *loadScenario(test::shippedScenario("jacksboro.yaml"));
  const Scenario before = scenario;
  scenario.set("emitters." + scenario.emitters[0].name + ".power_w", "7");
  scenario.set("emitters." + scenario.emitters[1].name + ".antenna.gain_dbi", "7");
  ASSERT_EQ(scenario.emitters.size(), before.emitters.size());
  for (std::size_t i = 0; i < scenario.emitters.size(); ++i) {
    EXPECT_EQ(scenario.emitters[i].antenna == before.emitters[i].antenna, i != 1) << i;
  }
  EXPECT_EQ(*scenario.terrain, *before.terrain);
}

TEST_F(EditScenario, FilesThatAreNotTouchedAreNotReadAgain) {
  const std::string track = "t_s,latitude_deg,longitude_deg,height_msl_m\n0,36,-84,100\n5,36.001,-84,100\n";
  folder_.write("track.csv", track);
  const std::string text =
      test::replaced(kSmall, "    position: {latitude_deg: 36.002, longitude_deg: -84, height_msl_m: 100}",
                     "    track: {file: track.csv}");
  Scenario scenario = load(text);
  std::filesystem::remove(folder_.path() / "track.csv");
  scenario.set("duration_s", "5");
  EXPECT_EQ(scenario.platforms[2].track.size(), 2u);
  EXPECT_THAT(faultOf(scenario, "platforms.a.track.file", "other.csv"), HasSubstr("there is no such file"));
}

TEST_F(EditScenario, SavingToAnotherFolderKeepsFileReferencesValid) {
  folder_.write("track.csv", "t_s,latitude_deg,longitude_deg,height_msl_m\n0,36,-84,100\n5,36.001,-84,100\n");
  const Scenario scenario = load(
      test::replaced(kSmall, "    position: {latitude_deg: 36.002, longitude_deg: -84, height_msl_m: 100}",
                     "    track: {file: track.csv} # where"));
  std::filesystem::create_directories(folder_.path() / "deep/er");
  const std::string file = (folder_.path() / "deep/er/t.yaml").string();
  saveScenario(scenario, file);
  EXPECT_THAT(test::readFile(file), HasSubstr("track: {file: ../../track.csv} # where"));
  EXPECT_EQ(loadScenario(file)->platforms[2].track.size(), 2u);
}

TEST_F(EditScenario, SavingWithFilesCopiesThoseOfItsOwnFolderAndReplacesNone) {
  const std::string track = "t_s,latitude_deg,longitude_deg,height_msl_m\n0,36,-84,100\n5,36.001,-84,100\n";
  std::filesystem::create_directories(folder_.path() / "made/tracks");
  folder_.write("made/tracks/track.csv", track);
  const Scenario scenario = load(
      test::replaced(kSmall, "    position: {latitude_deg: 36.002, longitude_deg: -84, height_msl_m: 100}",
                     "    track: {file: tracks/track.csv}"),
      "made/s.yaml");
  const std::string file = (folder_.path() / "t.yaml").string();
  saveWithFiles(scenario, file);
  saveWithFiles(scenario, file);  // with the same copies
  folder_.write("made/tracks/track.csv", "another recording");
  EXPECT_THAT(test::readFile(file), HasSubstr("track: {file: t_files/track.csv}"));
  EXPECT_EQ(loadScenario(file)->platforms[2].track.size(), 2u);
  folder_.write("t_files/track.csv", "the user's");
  folder_.write("made/tracks/track.csv", track);
  saveWithFiles(scenario, file);
  EXPECT_EQ(test::readFile(folder_.path() / "t_files/track.csv"), "the user's");
  EXPECT_THAT(test::readFile(file), HasSubstr("track: {file: t_files_2/track.csv}"));
  EXPECT_EQ(loadScenario(file)->platforms[2].track.size(), 2u);
  std::filesystem::create_directories(folder_.path() / "elsewhere");
  std::filesystem::create_directory_symlink("elsewhere", folder_.path() / "u_files");
  EXPECT_THROW(saveWithFiles(scenario, (folder_.path() / "u.yaml").string()), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path() / "elsewhere")) << "a link leads nothing away";
}

TEST_F(EditScenario, AScenarioThatWasMadeByHandHasNoText) {
  Scenario scenario;
  EXPECT_THAT(faultOf(scenario, "name", "x"), HasSubstr("was not read from a file"));
  EXPECT_THROW(saveScenario(scenario, (folder_.path() / "x.yaml").string()), Error);
  EXPECT_TRUE(scenario.edits().empty());
}

TEST_F(EditScenario, KeepsCarriageReturns) {
  std::string text;
  for (const char c : kSmall) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  Scenario scenario = load(text);
  scenario.set("emitters.search radar.losses_db", "2");
  scenario.set("emitters.search radar.power_w", "5");
  scenario.set("output", "{floor: -100}");
  std::string expected =
      test::replaced(text, "beamwidth_el_deg: 4}", "beamwidth_el_deg: 4}\r\n    losses_db: 2");
  expected = test::replaced(expected, "power_w: 20000", "power_w: 5");
  EXPECT_EQ(saved(scenario), expected + "output: {floor: -100}\r\n");
}

TEST_F(EditScenario, EditsJson) {
  const std::string text = R"({
  "schema_version": 1, "name": "j",
  "region": {"origin": {"latitude_deg": 36, "longitude_deg": -84}, "size_m": [1000, 1000, 1000], "dims": [4, 4, 4]},
  "platforms": [{"name": "p", "position": {"latitude_deg": 36, "longitude_deg": -84, "height_msl_m": 100}}],
  "emitters": [
    {
	"name": "e", "platform": "p", "kind": "transmitter",
	"frequency_hz": 1e9,
	"power_w": 10, "antenna": {"pattern": "isotropic"}
    }
  ]
})";
  Scenario scenario = load(text, "s.json");
  scenario.set("emitters.e.power_w", "+5");
  scenario.set("name", "new");
  scenario.set("emitters.e.propagation", "two_ray");
  scenario.set("emitters.e.two_ray.sum", "envelope");
  scenario.set("output.quantities", "[power_density_dbwm2, emitter_count]");
  std::string expected = test::replaced(text, "\"power_w\": 10", "\"power_w\": 5");
  expected = test::replaced(expected, "\"j\"", "\"new\"");
  expected = test::replaced(
      expected, "\"isotropic\"}",
      "\"isotropic\"},\n\t\"propagation\": \"two_ray\",\n\t\"two_ray\": {\"sum\": \"envelope\"}");
  expected =
      test::replaced(expected, "  ]\n}",
                     "  ],\n  \"output\": {\"quantities\": [\"power_density_dbwm2\", \"emitter_count\"]}\n}");
  EXPECT_EQ(saved(scenario), expected);
  scenario.set("emitters.e.two_ray", "null");
  scenario.set({{"emitters.e.propagation", "parabolic_equation"},
                {"emitters.e.parabolic_equation", "{top_m: 500, azimuths: auto}"}});
  EXPECT_EQ(scenario.emitters[0].propagation.parabolic_equation.top_m, 500);
  scenario.set("emitters.e.parabolic_equation.top_m", "auto");
  EXPECT_EQ(scenario.emitters[0].propagation.parabolic_equation.top_m, 0);
  EXPECT_THAT(saved(scenario), HasSubstr(R"("parabolic_equation": {"top_m": "auto", "azimuths": "auto"})"));
  scenario.set("emitters.e.parabolic_equation", "null");
  scenario.set("emitters.e.propagation", "null");
  scenario.set("output", "null");
  expected = test::replaced(text, "\"power_w\": 10", "\"power_w\": 5");
  EXPECT_EQ(saved(scenario), test::replaced(expected, "\"j\"", "\"new\""));
}

TEST_F(EditScenario, TextsOfEveryKindSurvive) {
  for (const std::string& name :
       {std::string("\xC3\xA9\xE4\xB8\xAD"), std::string("a, b"), std::string("12"), std::string("true"),
        std::string("a: b"), std::string("# no comment"), std::string("it's \"quoted\" \\"),
        std::string(" blanks "), std::string("-"), std::string("null")}) {
    Scenario scenario = load(kSmall);
    std::string json = "\"";
    for (const char c : name) json += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    scenario.set("emitters.search radar.name", json + "\"");
    EXPECT_EQ(scenario.emitters[0].name, name);
    scenario.set({{"platforms.site.name", json + "\""}, {"emitters." + name + ".platform", json + "\""}});
    EXPECT_EQ(scenario.platforms[0].name, name);
    EXPECT_EQ(load(saved(scenario)).emitters[0].name, name);
  }
}

TEST_F(EditScenario, BlockAndMultiLineTextsAreReplaced) {
  for (const std::string written : {"|-\n  a line\n", ">-\n  folded\n  text\n", "plain\n  over lines\n",
                                    "\"quoted\n  over \\\"lines\"\n", "'it''s\n  one'   # remark\n"}) {
    Scenario scenario = load(test::replaced(kSmall, "name: small\n", "name: " + written));
    scenario.set("step_s", "2");
    scenario.set("name", "new");
    EXPECT_EQ(scenario.name, "new") << written;
    EXPECT_EQ(scenario.clock.step_s, 2);
    scenario.set("epoch", "2026-06-01T06:00:00Z");
    EXPECT_EQ(scenario.clock.epoch_utc, "2026-06-01T06:00:00Z");
  }
}

TEST_F(EditScenario, AnchorsAreRefusedButTheirSiblingsAreEdited) {
  const std::string text =
      test::replaced(test::replaced(kSmall, "antenna: {pattern: isotropic}", "antenna: *beam"),
                     "antenna: {pattern: gaussian", "antenna: &beam {pattern: gaussian");
  Scenario scenario = load(text);
  scenario.set("emitters.search radar.power_w", "5");
  EXPECT_THAT(faultOf(scenario, "emitters.search radar.antenna.gain_dbi", "3"),
              HasSubstr("an anchor (&) or an alias (*)"));
  EXPECT_THAT(faultOf(scenario, "emitters.x=1 \"q\".antenna", "{pattern: isotropic}"),
              HasSubstr("an anchor (&) or an alias (*)"));
  EXPECT_EQ(saved(scenario), test::replaced(text, "power_w: 20000", "power_w: 5"));
}

TEST_F(EditScenario, EmptySectionsAreFilled) {
  Scenario scenario = load(kSmall + "atmosphere: {}\n");
  scenario.set("atmosphere.k_factor", "2");
  scenario.set("atmosphere.rain_mm_h", "3");
  EXPECT_EQ(saved(scenario), kSmall + "atmosphere: {k_factor: 2, rain_mm_h: 3}\n");
  scenario.set("atmosphere.k_factor", "null");
  scenario.set("atmosphere.rain_mm_h", "null");
  EXPECT_EQ(saved(scenario), kSmall + "atmosphere: {}\n");
}

TEST_F(EditScenario, AnEditCanMendAFile) {
  const std::string file =
      folder_.write("s.yaml", test::replaced(kSmall, "power_w: 20000", "power_w: strong"));
  EXPECT_EQ(loadScenario(file, {{"emitters.search radar.power_w", "5"}})->emitters[0].power_w, 5);
}

TEST(ParseEdit, EndsThePathAtTheFirstEqualsSignOutsideQuotes) {
  EXPECT_EQ(parseEdit("a.b=c=d"), (Edit{"a.b", "c=d"}));
  EXPECT_EQ(parseEdit("a.\"x=y\".b=1"), (Edit{"a.\"x=y\".b", "1"}));
  EXPECT_EQ(parseEdit("a="), (Edit{"a", ""}));
  for (const char* text : {"", "a", "=1", "a.\"b=1"}) {
    EXPECT_THAT(test::errorOf([&] { parseEdit(text); }, ErrorCode::usage), HasSubstr("write PATH=VALUE"))
        << text;
  }
}

std::vector<std::string> messagesOf(const std::vector<Problem>& problems) {
  std::vector<std::string> messages;
  for (const Problem& problem : problems) messages.push_back(problem.message);
  std::sort(messages.begin(), messages.end());
  return messages;
}

/// Expects that two documents have their values at the same locations of a text.
void expectSamePlaces(const DocumentNode& a, const DocumentNode& b) {
  const auto numbersOf = [](const document::TextPosition& at) {
    return std::make_tuple(at.line, at.column, at.offset);
  };
  ASSERT_TRUE(document::sameValue(a, b));
  EXPECT_EQ(numbersOf(a.position), numbersOf(b.position)) << a.text;
  EXPECT_EQ(a.quoted, b.quoted) << a.text;
  for (std::size_t i = 0; i < a.items.size(); ++i) expectSamePlaces(*a.items[i], *b.items[i]);
  for (std::size_t i = 0; i < a.entries.size(); ++i) {
    EXPECT_EQ(numbersOf(a.entries[i].position), numbersOf(b.entries[i].position)) << a.entries[i].key;
    expectSamePlaces(*a.entries[i].value, *b.entries[i].value);
  }
}

/// An edit and a file written with the new value must be equivalent, for every key of the table.
TEST(EditEveryKey, SLOW_EqualsAFileWithThatValue) {
  TemporaryFolder folder;
  for (const char* data : {"track.csv", "sector.msi", "valid.yaml"})
    folder.write(data, test::readFile(test::testData() / data));
  RandomEdits random(7);
  int sound = 0, all = 0;
  for (const std::string& original :
       {(folder.path() / "valid.yaml").string(), folder.write("small.yaml", kSmall)}) {
    const auto scenario = loadScenario(original);
    const DocumentNodePtr root = scenario->source->root;
    forEachPath(root.get(), scenarioSpec(), "", [&](const std::string& path, const ValueSpec& spec) {
      const std::string value = random.valueFor(spec);
      SCOPED_TRACE(path + "=" + value);
      ++all;
      const ParseResult edited = editScenario(*scenario, {{path, value}});
      ScenarioSource source;
      source.text = scenario->source->text;
      source.root = root;
      ASSERT_NO_THROW(applyEdit(source, {path, value}));
      document::ProblemList problems;
      expectSamePlaces(*source.root, *document::readDocument("", source.text.text(), problems));
      const std::string anew = folder.write("anew.json", document::flowText(*source.root, true));
      const ParseResult read = parseScenario(anew);
      ASSERT_EQ(edited.scenario != nullptr, read.scenario != nullptr) << test::readFile(anew);
      if (!edited.scenario) return;
      ++sound;
      EXPECT_EQ(messagesOf(edited.problems), messagesOf(read.problems));
      EXPECT_TRUE(document::sameValue(*edited.scenario->source->root, *read.scenario->source->root));
      EXPECT_EQ(loadScenario(original, {{path, value}})->hash, edited.scenario->hash);
      const ParseResult back = editScenario(*edited.scenario, {{path, "null"}});
      if (back.scenario) {
        EXPECT_LE(back.scenario->source->text.text().size(), edited.scenario->source->text.text().size());
      }
    });
  }
  // Refused are settings of models that are not chosen, and refractivity together with k_factor.
  EXPECT_GT(sound, all / 3) << "of " << all;
}

TEST(EditAtRandom, SLOW_RandomEditsKeepTextAndScenarioConsistent) {
  TemporaryFolder folder;
  for (const char* data : {"track.csv", "sector.msi", "valid.yaml"})
    folder.write(data, test::readFile(test::testData() / data));
  for (const std::string& file :
       {(folder.path() / "valid.yaml").string(), folder.write("small.yaml", kSmall)}) {
    RandomEdits random(11);
    Scenario scenario = *loadScenario(file);
    int made = 0;
    for (int i = 0; i < 400; ++i) {
      std::vector<Edit> choices;
      forEachPath(scenario.source->root.get(), scenarioSpec(), "",
                  [&](const std::string& path, const ValueSpec& spec) {
                    if (random.below(20) == 0)
                      choices.push_back({path, random.below(4) == 0 ? "null" : random.valueFor(spec)});
                  });
      if (choices.empty()) continue;
      Edit edit = choices[random.below(choices.size())];
      if (random.below(4) == 0) edit.value = random.junk();
      if (random.below(8) == 0) edit.path = random.junk();
      const std::string hash = scenario.hash;
      try {
        scenario.set(edit.path, edit.value);
        ++made;
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_input) << toString(edit);
        EXPECT_EQ(scenario.hash, hash);
        continue;
      }
      const std::string again = folder.write("again.yaml", scenario.source->text.text());
      const ParseResult read = parseScenario(again);
      ASSERT_TRUE(read.scenario) << toString(edit) << "\n"
                                 << testing::PrintToString(messagesOf(read.problems)) << "\n"
                                 << scenario.source->text.text();
      EXPECT_EQ(read.scenario->hash, scenario.hash);
    }
    EXPECT_GT(made, 50);
    const ParseResult repeated = parseScenario(file, scenario.edits());
    ASSERT_TRUE(repeated.scenario);
    EXPECT_TRUE(document::sameValue(*repeated.scenario->source->root, *scenario.source->root));
  }
}

TEST(Edit, AValueThatIsAgainThatOfTheFileLeavesNoEditAndNoOtherText) {
  Scenario scenario = *loadScenario(test::shippedScenario("quick.yaml"));
  const std::string hash = scenario.hash;
  scenario.set("emitters.radar.frequency_hz", "2e9");
  scenario.set("emitters.radar.power_w", "5");
  scenario.set("emitters.radar.frequency_hz", "3000000000");
  ASSERT_EQ(scenario.edits().size(), 1U) << "3.0e9 in the file";
  EXPECT_EQ(toString(scenario.edits()[0]), "emitters.radar.power_w=5");
  scenario.set("emitters.radar.power_w", "7");
  scenario.set("emitters.radar.power_w", "1e4");
  EXPECT_TRUE(scenario.edits().empty());
  EXPECT_EQ(scenario.hash, hash);
  scenario.set("emitters.radar.power_w", "10000");
  EXPECT_EQ(scenario.edits().size(), 1U) << "an edit that never changed it is kept as typed";
  EXPECT_EQ(loadScenario(scenario.file, scenario.edits())->hash, scenario.hash);
}

}  // namespace
}  // namespace emscape::scenario
