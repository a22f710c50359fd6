// emscape link: JSON keys on which other programs rely, files, and errors. The figures are tested in
// tests/emfield.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/apps/program.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

Arguments links(const Arguments& more) {
  return joined({"link", shippedScenario("links.yaml"), "--times", "0:60:20"}, more);
}

TEST(Link, JsonHasContractKeys) {
  const json report = json::parse(runWell(links({"--json"})).out);
  ASSERT_EQ(report["links"].size(), 3u) << "those in a receiver's band and on another platform";
  for (const json& link : report["links"]) {
    for (const char* key :
         {"emitter", "receiver", "first_received_s", "last_received_s", "received_share", "rows"})
      EXPECT_TRUE(link.contains(key)) << key;
    ASSERT_EQ(link["rows"].size(), 4u);
    for (const char* key : {"time_s", "active", "range_m", "power_density_dbwm2", "pattern_db", "blocked",
                            "verdict", "received_power_dbm", "interference_dbm", "noise_dbm", "sinr_db",
                            "jammer_to_signal_db", "received"})
      EXPECT_TRUE(link["rows"][0].contains(key)) << key;
  }
  ASSERT_EQ(report["detections"].size(), 2u);
  for (const json& detection : report["detections"]) {
    for (const char* key : {"radar", "target", "first_detection_s", "cumulative_probability", "rows"})
      EXPECT_TRUE(detection.contains(key)) << key;
    for (const char* key : {"rcs_dbsm", "snr_db", "detection_probability", "looks", "cumulative_probability"})
      EXPECT_TRUE(detection["rows"][0].contains(key)) << key;
  }
}

TEST(Link, ANameMayContainACommaAndIsTakenOnce) {
  const TemporaryFolder folder;
  std::string text = readFile(quick());
  text.replace(text.find("name: transmitter"), 17, "name: \"a,b\"");
  text +=
      "receivers:\n  - {name: set, platform: radar site, gain_dbi: 0, noise_figure_db: 5, "
      "center_frequency_hz: 100.0e6, bandwidth_hz: 1.0e5}\n";
  const std::string file = folder.write("comma.yaml", text);
  const auto linksOf = [&](const Arguments& more) {
    return json::parse(
               runWell(joined({"link", file, "--times", "0", "--receiver", "set", "--json"}, more)).out)
        .at("links")
        .size();
  };
  EXPECT_EQ(linksOf({"--emitter", "a,b"}), 1u);
  EXPECT_EQ(linksOf({"--emitter", "radar", "--emitter", "a,b"}), linksOf({}));
  EXPECT_EQ(linksOf({"--emitter", "a,b", "--emitter", "a,b"}), 1u);
  EXPECT_THAT(errorOfRun({"link", file, "--emitter", "radar,b"}, 2),
              HasSubstr("--emitter: no emitter 'b' in"));
}

TEST(Link, RowEqualsProfileOfThePath) {
  const json report =
      json::parse(runWell(links({"--json", "--emitter", "jammer", "--receiver", "handset"})).out);
  EXPECT_EQ(report["detections"].size(), 0u) << "a choice of receivers leaves the targets out";
  const json row = report["links"][0]["rows"][2];
  EXPECT_EQ(row["time_s"], 40);
  const json path = json::parse(runWell({"profile", shippedScenario("links.yaml"), "--emitter", "jammer",
                                         "--to", "36.24925,-84.14697,3", "--agl", "--time", "40", "--json"})
                                    .out);
  EXPECT_EQ(row["power_density_dbwm2"], path["budget"]["power_density_dbwm2"]);
  EXPECT_EQ(row["range_m"], path["geometry"]["slant_range_m"]);
  EXPECT_EQ(row["verdict"], path["verdict"]);
}

TEST(Link, PrintsASummaryAndATableOfEachPair) {
  const ProgramResult result = runWell(links({"--target", "drone"}));
  for (const char* part : {"Targets\n", "Radar 'search radar' and target 'drone'", "cumulative"})
    EXPECT_THAT(result.out, HasSubstr(part));
}

TEST(Link, WritesRowsOfOneWidthAndAPicture) {
  const TemporaryFolder folder;
  runWell(links({"--csv", folder / "links.csv", "--plot", folder / "links.png", "--size", "700x400"}));
  EXPECT_EQ(readFile(folder / "links.png").substr(1, 3), "PNG");
  std::istringstream lines(readFile(folder / "links.csv"));
  int rows = 0;
  for (std::string line; std::getline(lines, line); ++rows) {
    bool is_quoted = false;
    int cells = 1;
    for (const char c : line) {
      if (c == '"') is_quoted = !is_quoted;
      if (c == ',' && !is_quoted) ++cells;
    }
    EXPECT_EQ(cells, 25) << line;
  }
  EXPECT_EQ(rows, 1 + 5 * 4);
}

TEST(Link, RefusesNamesAndScenariosWithoutLinksWithOneClearError) {
  const ProgramResult nobody = run(links({"--receiver", "nobody"}));
  EXPECT_EQ(nobody.status, 2);
  EXPECT_THAT(nobody.err, HasSubstr("--receiver: no receiver with a platform 'nobody' in "));
  EXPECT_THAT(nobody.err, HasSubstr("it has 'warning receiver', 'handset'"));
  EXPECT_THAT(errorOfRun({"link", shippedScenario("quick.yaml")}, 3), HasSubstr("there is no link: "));
  EXPECT_EQ(run(links({"--plot", "links.gif"})).status, 2);
}

TEST(Info, ShowsWaveformsReceiversAndTargets) {
  const json report = json::parse(runWell({"info", shippedScenario("links.yaml"), "--json"}).out);
  const json waveform = report["emitters"][0]["waveform"];
  EXPECT_EQ(waveform["pulses"], 62);
  EXPECT_NEAR(waveform["mean_power_w"].get<double>(), 6, 1e-9);
  EXPECT_NEAR(waveform["unambiguous_range_m"].get<double>(), 99930.8, 0.1);
  EXPECT_EQ(report["receivers"][1]["platform"], "valley post");
  EXPECT_EQ(report["targets"][0]["rcs_m2"], "by aspect");
}

}  // namespace
}  // namespace emscape::test
