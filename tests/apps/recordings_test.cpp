// emscape export and import: files, JSON keys on which other programs rely, and errors. What becomes of
// objects and beams is tested in tests/interop.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/apps/program.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(Recordings, ScenarioGoesThereAndBackWithoutFaults) {
  const TemporaryFolder folder;
  const json told = json::parse(
      runWell({"export", shippedScenario("jamming.yaml"), "-o", folder / "a.pcap", "--step", "5", "--json"})
          .out);
  for (const char* key : {"file", "format", "emitter_database", "records", "platforms", "emitters"})
    EXPECT_TRUE(told.contains(key)) << key;
  const json result = json::parse(runWell({"import", folder / "a.pcap", "-o", folder / "b.yaml", "--emitters",
                                           told["emitter_database"].get<std::string>(), "--json"})
                                      .out);
  for (const char* key :
       {"scenario", "tracks", "track_files", "format", "epoch", "begin_s", "end_s", "duration_s", "types",
        "emitters", "left_out", "records", "bad", "first_bad", "torn", "ignored", "notes"}) {
    EXPECT_TRUE(result.contains(key)) << key;
  }
  EXPECT_EQ(result["bad"], 0);
  runWell({"validate", folder / "b.yaml"});
}

TEST(Recordings, TableTellsWhatWasLeftOut) {
  const TemporaryFolder folder;
  const std::string file = folder.write(
      "a.acmi",
      "FileType=text/acmi/tacview\nFileVersion=2.2\n1,T=5|52|0,Type=Sea+Watercraft,Name=Boat,Fuel=3\n"
      "2,T=5|52|0,Type=Navaid+Static+Bullseye\n#10\n1,T=5.01|52|0\nzzz\n#20\n1,T=5.02");
  const ProgramResult result = runWell({"import", file, "-o", folder / "b.yaml"});
  EXPECT_THAT(result.out, HasSubstr("left out: scenery"));
  EXPECT_THAT(result.out, HasSubstr("navigation radar"));
  EXPECT_THAT(result.out,
              HasSubstr("1 record could not be read, the first: line 7: 'zzz' is no hexadecimal id"));
  EXPECT_THAT(result.out, HasSubstr("the recording ends too early: line 9 has no end"));
  EXPECT_THAT(result.out, HasSubstr("not used: property Fuel (1)"));
}

TEST(Recordings, FaultsNameFileValueAndRemedy) {
  const TemporaryFolder folder;
  const std::string other = folder.write("a.txt", "hello\n");
  const std::string out = folder / "b.yaml";
  EXPECT_THAT(errorOfRun({"import", other, "-o", out}, 3),
              HasSubstr("a.txt: no recording of a known format"));
  EXPECT_THAT(errorOfRun({"import", folder / "none", "-o", out}, 3),
              HasSubstr("none: cannot read: no such file"));
  EXPECT_THAT(errorOfRun({"import", other, "-o", out, "--times", "5"}, 2),
              HasSubstr("--times '5' is not BEGIN:END"));
  EXPECT_THAT(errorOfRun({"import", other, "-o", out, "--region", "95,0,10"}, 2),
              HasSubstr("--region '95,0,10' is not auto"));
  for (const Arguments& without_folder :
       {Arguments{"import", other, "-o", folder / "none/a.yaml"},
        Arguments{"export", shippedScenario("quick.yaml"), "-o", folder / "none/a.acmi"}}) {
    EXPECT_THAT(errorOfRun(without_folder, 1), HasSubstr("none"));
    EXPECT_FALSE(std::filesystem::exists(folder / "none"));
  }
  EXPECT_THAT(errorOfRun({"export", shippedScenario("quick.yaml"), "-o", folder / "a.hla"}, 2),
              HasSubstr("it ends in .zip.acmi, .acmi, .pcap, .asi"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(Recordings, FilesThatExistAreReplacedOnlyWithForce) {
  const TemporaryFolder folder;
  const std::string flight = folder.write(
      "a.acmi",
      "FileType=text/acmi/tacview\nFileVersion=2.2\n1,T=5|52|3000,Type=Air+FixedWing,Name=F-14\n#10\n"
      "1,T=5.01|52\n");
  const std::string scenario = folder / "b.yaml", track = folder / "b_tracks/f-14.csv";
  const std::string recording = folder / "c.acmi", database = folder / "c.acmi.emitters.yaml";
  const Arguments import{"import", flight, "-o", scenario};
  const Arguments write{"export", shippedScenario("quick.yaml"), "-o", recording};
  const auto expectKept = [&](Arguments arguments, const std::string& file) {
    const std::vector<std::string> files = folder.files();
    std::filesystem::create_directories(std::filesystem::path(file).parent_path());
    writeFile(file, "mine\n");
    EXPECT_THAT(errorOfRun(arguments, 2),
                HasSubstr(file + " exists; --force replaces it, another name keeps it"));
    EXPECT_EQ(readFile(file), "mine\n");
    arguments.emplace_back("--force");
    EXPECT_EQ(run(arguments).status, 0);
    EXPECT_NE(readFile(file), "mine\n");
  };
  expectKept(import, scenario);
  std::filesystem::remove(scenario);
  expectKept(import, track);
  expectKept(write, recording);
  std::filesystem::remove(recording);
  expectKept(write, database);
}

TEST(Recordings, CoverageIsAddedToCzml) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.czml";
  runWell({"export", shippedScenario("jamming.yaml"), "-o", file, "--coverage", "agl:150", "--set",
           "region.dims=[24,24,8]"});
  int outlines = 0, beams = 0, documents = 0;
  for (const json& packet : json::parse(readFile(file))) {
    const std::string id = packet["id"];
    documents += id == "document" ? 1 : 0;
    beams += id.rfind("beam/", 0) == 0 ? 1 : 0;
    outlines += packet.contains("polygon") && packet.contains("parent") &&
                        packet["parent"].get<std::string>().rfind("group/", 0) == 0
                    ? 1
                    : 0;
  }
  EXPECT_EQ(documents, 1);
  EXPECT_EQ(beams, 2);
  EXPECT_GE(outlines, 11) << "one for each time at least";
  EXPECT_EQ(folder.files().size(), 2u) << "the document and its emitter database";
  EXPECT_THAT(
      errorOfRun({"export", shippedScenario("jamming.yaml"), "-o", folder / "a.kml", "--coverage", "agl:150"},
                 2),
      HasSubstr("--coverage is written into .czml alone"));
  EXPECT_EQ(
      run({"export", shippedScenario("jamming.yaml"), "-o", folder / "b.czml", "--coverage", "x"}).status, 2);
  EXPECT_EQ(folder.files().size(), 2u) << "nothing is written";
}

/// The lines of a file after one that begins with a text.
std::vector<std::string> linesAfter(const std::string& text, const std::string& begin) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  bool is_after = false;
  for (std::string line; std::getline(stream, line);) {
    if (is_after && !line.empty()) lines.push_back(line);
    is_after = is_after || line.compare(0, begin.size(), begin) == 0;
  }
  return lines;
}

std::vector<double> numbersIn(const std::string& line) {
  std::istringstream stream(line);
  std::vector<double> numbers;
  for (double number = 0; stream >> number;) numbers.push_back(number);
  return numbers;
}

TEST(Areps, LossesGiveTheProbabilitiesOfTheDiagram) {
  const TemporaryFolder folder;
  runWell({"vertical", shippedScenario("jamming.yaml"), "--set", "emitters.stand-off jammer.enabled=false",
           "--emitter", "search radar", "--azimuth", "30", "--grid", "12,8", "--quantity",
           "detection_probability", "--areps", folder / "areps", "-o", folder / "v.json"});
  const std::string text = readFile(folder / "areps/search_radar_APM_30.txt");
  EXPECT_THAT(text, HasSubstr("Nrout = 12"));
  EXPECT_THAT(text, HasSubstr("Nzout = 7")) << "one less than the rows";
  EXPECT_THAT(text, HasSubstr("TransPower = 2.0"));
  const std::vector<std::string> detection = linesAfter(text, "[Probability of detection]");
  std::vector<double> thresholds;  // of 1 to 100 %
  for (int i = 1; i <= 10; ++i) {
    for (const double number : numbersIn(detection.at(static_cast<std::size_t>(i))))
      thresholds.push_back(number);
  }
  ASSERT_EQ(thresholds.size(), 100u);
  const std::vector<std::string> losses = linesAfter(text, "[Apm Loss Data]");
  const json values = json::parse(readFile(folder / "v.json"))["azimuths"][0]["values"];
  int compared = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    const std::vector<double> row = numbersIn(losses.at(k + 3));
    ASSERT_EQ(row.size(), 12u);
    for (std::size_t i = 0; i < 12; ++i) {
      const json& probability = values[k * 12 + i];
      if (probability.is_null()) {
        EXPECT_LT(row[i], -32000);
        continue;
      }
      const auto reached = std::count_if(thresholds.begin(), thresholds.end(),
                                         [&](double loss_db) { return row[i] / 10 <= loss_db; });
      EXPECT_NEAR(static_cast<double>(reached) / 100, probability.get<double>(), 0.025) << i << ", " << k;
      ++compared;
    }
  }
  EXPECT_GT(compared, 50);
  const json comparison = json::parse(
      runWell({"vertical", shippedScenario("jamming.yaml"), "--set",
               "emitters.stand-off jammer.enabled=false", "--emitter", "search radar", "--azimuth", "30",
               "--compare", folder / "areps/search_radar_APM_30.txt", "--json"})
          .out)["comparison"];
  EXPECT_EQ(comparison["points"], compared) << "its own points";
  EXPECT_LT(std::abs(comparison["mean_db"].get<double>()), 0.02);
  EXPECT_LE(std::abs(comparison["largest_db"].get<double>()), 0.051) << "it has tenths of a decibel";
}

/// The field of a scenario's power density in a region, in dBW/m2.
std::vector<float> fieldOf(const std::string& scenario, const std::string& folder) {
  runWell({"simulate", scenario, "--set",
           "region={origin: {latitude_deg: 52, longitude_deg: 5}, size_m: [20000, "
           "20000, 3000], dims: [24, 24, 6]}",
           "--set", "output.quantities=[power_density_dbwm2]", "--times", "10", "--format", "raw", "-o",
           folder});
  std::vector<float> field;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".raw") continue;
    const std::string bytes = readFile(entry.path());
    field.resize(bytes.size() / sizeof(float));
    std::memcpy(field.data(), bytes.data(), field.size() * sizeof(float));
  }
  return field;
}

TEST(Recordings, FieldStaysInEachFormatThatTellsBeams) {
  const TemporaryFolder folder;
  folder.write("track.csv",
               "t_s,latitude_deg,longitude_deg,height_msl_m,heading_deg,pitch_deg,roll_deg\n"
               "0,52.02,4.95,1500,80,2,5\n20,52.04,5.02,1600,100,2,5\n");
  const std::string before = folder.write("before.yaml", R"(schema_version: 1
name: before
epoch: 2026-06-01T06:00:00Z
duration_s: 20
region: {origin: {latitude_deg: 52, longitude_deg: 5}, size_m: [20000, 20000, 3000], dims: [24, 24, 6]}
platforms:
  - {name: site, side: friend, position: {latitude_deg: 51.97, longitude_deg: 5.03, height_msl_m: 30}, attitude: {heading_deg: 33}}
  - {name: jet, side: hostile, track: {file: track.csv}}
emitters:
  - name: site radar
    platform: site
    kind: radar
    frequency_hz: 3.0e9
    power_w: 5000
    antenna: {pattern: gaussian, gain_dbi: 30, beamwidth_az_deg: 4, beamwidth_el_deg: 6}
    scan: {kind: fixed, azimuth_deg: -40, elevation_deg: 3}
    receiver: {noise_figure_db: 4, bandwidth_hz: 1.0e6}
  - name: jet radar
    platform: jet
    kind: radar
    frequency_hz: 9.5e9
    power_w: 4000
    antenna: {pattern: gaussian, gain_dbi: 32, beamwidth_az_deg: 3.5, beamwidth_el_deg: 3.5}
    scan: {kind: dwell_list, dwells: [{azimuth_deg: 20, elevation_deg: -4, duration_s: 8}, {azimuth_deg: 35, elevation_deg: -6, duration_s: 12}]}
    receiver: {noise_figure_db: 4, bandwidth_hz: 1.0e6}
output: {quantities: [power_density_dbwm2]}
)");
  const std::vector<float> expected = fieldOf(before, folder / "f0");
  ASSERT_EQ(expected.size(), 24u * 24u * 6u);
  for (const char* ending : {".acmi", ".pcap", ".asi", ".cot"}) {
    const std::string file = folder / (std::string("a") + ending);
    ASSERT_EQ(run({"export", before, "-o", file}).status, 0);
    const std::string after = folder / (std::string("back") + ending + ".yaml");
    runWell({"import", file, "--emitters", file + ".emitters.yaml", "-o", after});
    const std::vector<float> field = fieldOf(after, folder / (std::string("f") + ending));
    ASSERT_EQ(field.size(), expected.size()) << ending;
    float largest = 0;
    for (std::size_t i = 0; i < field.size(); ++i)
      largest = std::max(largest, std::abs(field[i] - expected[i]));
    // Angles have two decimals of a degree in ACMI, three or more in the others.
    EXPECT_LT(largest, std::string(ending) == ".acmi" ? 0.3 : 0.05) << ending;
  }
}

}  // namespace
}  // namespace emscape::test
