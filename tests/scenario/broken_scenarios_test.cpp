// Broken scenarios: the first lines of each list exactly the errors that must be found, with their locations.
#include <gmock/gmock.h>

#include <algorithm>
#include <random>
#include <vector>

#include "emscape/scenario/file/scenario_file.h"
#include "tests/scenario/scenario_files.h"

namespace emscape::scenario {
namespace {

std::filesystem::path brokenFolder() {
  return test::sourceFile("tests/scenario/broken");
}

std::vector<std::string> brokenScenarios() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(brokenFolder())) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// "[file:]line:column fragment", from the first lines of a broken scenario, after "# expect: ".
struct Expectation {
  std::string location, fragment;
};

std::vector<Expectation> expectationsOf(const std::string& text, const std::string& own_name) {
  static const std::string kMark = "# expect: ";
  std::vector<Expectation> all;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line) && line.compare(0, kMark.size(), kMark) == 0;) {
    const std::size_t end = line.find(' ', kMark.size());
    std::string location = line.substr(kMark.size(), end - kMark.size());
    if (location[0] >= '0' && location[0] <= '9') location = own_name + ":" + location;
    all.push_back({location, line.substr(end + 1)});
  }
  return all;
}

std::string told(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) text += toString(problem.location) + ": " + problem.message + "\n";
  return text;
}

class BrokenScenario : public ::testing::TestWithParam<std::string> {};

TEST_P(BrokenScenario, ReportsEveryProblemWithLocation) {
  const std::filesystem::path file = brokenFolder() / (GetParam() + ".yaml");
  const ParseResult result = parseScenario(file.string());
  EXPECT_EQ(result.scenario, nullptr);
  const auto expectations = expectationsOf(test::readFile(file), file.filename().string());
  ASSERT_FALSE(expectations.empty());
  ASSERT_EQ(result.problems.size(), expectations.size()) << told(result.problems);
  for (std::size_t i = 0; i < expectations.size(); ++i) {
    SourceLocation location = result.problems[i].location;
    location.file = std::filesystem::path(location.file).filename().string();
    EXPECT_EQ(toString(location), expectations[i].location) << told(result.problems);
    EXPECT_NE(result.problems[i].message.find(expectations[i].fragment), std::string::npos)
        << "expected: " << expectations[i].fragment << "\n"
        << told(result.problems);
  }
}

INSTANTIATE_TEST_SUITE_P(Files, BrokenScenario, ::testing::ValuesIn(brokenScenarios()), [](const auto& file) {
  std::string name = file.param;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
});

TEST(BrokenScenarios, AreAtLeastThirty) {
  EXPECT_GE(brokenScenarios().size(), 30u);
}

TEST(BrokenScenarios, LoadingListsAllProblemsOneALine) {
  const std::string file = (brokenFolder() / "73_many_faults.yaml").string();
  const std::string message = test::errorOf([&] { loadScenario(file); }, ErrorCode::bad_input);
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 5);
  EXPECT_EQ(message.compare(0, file.size(), file), 0) << message;
  EXPECT_NE(message.find(file + ":29:5: unknown key 'power'; write 'power_w' (W)"), std::string::npos)
      << message;
}

class DamagedScenario : public ::testing::Test {
 protected:
  DamagedScenario() {
    std::filesystem::copy_file(test::testData() / "track.csv", folder_.path() / "track.csv");
  }
  /// Valid, short, and written with many features of YAML.
  const std::string text_ = R"(---
schema_version: 1
name: "d\u00e4mag\x65d"   # remark
"duration_s": 10
region:
  {origin: {latitude_deg: 1.5, longitude_deg: -179.9},
   size_m: &size [3e4, 2.0E+4, 6000], dims: [30, 20, 10]}
platforms:
- name: 'it''s a site'
  position: {latitude_deg: 1, longitude_deg: 2, height_agl_m: 12}
- name: >-
    ship on
    its way
  track:
    file: track.csv
emitters:
  - name: r\u00e4dar
    platform: it's a site
    kind: radar
    frequency_hz: 3.0e9
    power_w: 2.0e5
    antenna: &horn {pattern: gaussian, beamwidth_az_deg: 10, beamwidth_el_deg: 12}
    scan:
      kind: dwell_list
      dwells: [{azimuth_deg: -3, elevation_deg: 0, duration_s: 0.1}]
    receiver: {noise_figure_db: 4, bandwidth_hz: 1.0e6}
    active_s: [[0, 6], [9, 12]]
  - {name: j, platform: ship on its way, kind: jammer, frequency_hz: 1e9, power_w: 4, antenna: *horn}
output: {quantities: [snr_db], combine: per_emitter}
)";
  test::TemporaryFolder folder_;

  /// Any damage must give either a scenario or an error with a location.
  void parse(const std::string& text) {
    const ParseResult result = parseScenario(folder_.write("damaged.yaml", text));
    if (result.scenario) return;
    ASSERT_FALSE(result.problems.empty());
    for (const Problem& problem : result.problems) {
      EXPECT_FALSE(problem.message.empty());
      EXPECT_GE(problem.location.line, 1) << problem.message;
    }
  }
};

TEST_F(DamagedScenario, IsValidBeforeItIsDamaged) {
  const std::string remarks = told(parseScenario(folder_.write("whole.yaml", text_)).problems);
  EXPECT_THAT(remarks, testing::HasSubstr("outside the region"));
  EXPECT_THAT(remarks, testing::HasSubstr("has no 'bandwidth_hz'"));
  EXPECT_EQ(std::count(remarks.begin(), remarks.end(), '\n'), 2) << remarks;
}

TEST_F(DamagedScenario, CutAtAnyByteIsReadOrRefused) {
  for (std::size_t length = 0; length < text_.size(); ++length) parse(text_.substr(0, length));
}

TEST_F(DamagedScenario, WithChangedBytesIsReadOrRefused) {
  std::mt19937 random(20260601);
  const auto below = [&](std::size_t bound) { return static_cast<std::size_t>(random() % bound); };
  static const std::string kTelling = "{}[],:&*!|>%@`'\"#-?\n\t .0e";
  for (int round = 0; round < 1500; ++round) {
    std::string text = text_;
    for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
      char& byte = text[below(text.size())];
      byte = round % 2 == 0 ? static_cast<char>(below(256)) : kTelling[below(kTelling.size())];
    }
    parse(text);
  }
}

TEST_F(DamagedScenario, RepeatedCharacterIsRefusedQuickly) {
  for (const char c : {'[', '{', '-', '?', '*', '&', '!', '"', '\'', '|', ':', ' ', '\n', '#', 'a', '\\'}) {
    parse(std::string(50000, c));
  }
  parse("a: [" + std::string(1000000, ','));
  std::string nested;
  for (int i = 0; i < 2000; ++i) nested += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
  parse(nested);
}

TEST_F(DamagedScenario, UnboundedAliasExpansionIsRefused) {
  std::string text = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 20; ++i) {
    const std::string before = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + before;
    for (int k = 0; k < 9; ++k) text += ", " + before;
    text += "]\n";
  }
  const ParseResult result = parseScenario(folder_.write("unfolds.yaml", text));
  ASSERT_FALSE(result.problems.empty());
  EXPECT_NE(told(result.problems).find("more than the allowed 1000000 values"), std::string::npos)
      << told(result.problems);
}

TEST_F(DamagedScenario, EmptyFileIsAnErrorAtItsBeginning) {
  for (const char* text : {"", "\n\n", "# nothing\n", "---\n", "null\n", "\xEF\xBB\xBF"}) {
    const std::string file = folder_.write("empty.yaml", text);
    EXPECT_EQ(told(parseScenario(file).problems), file + ":1:1: the file is empty\n") << text;
  }
}

TEST_F(DamagedScenario, OversizedFileIsRefused) {
  const std::string file = folder_.write("large.yaml", std::string(std::size_t{5} << 20, '#'));
  EXPECT_EQ(told(parseScenario(file).problems),
            file + ": is 5242880 bytes large, more than the allowed 4194304\n");
}

TEST_F(DamagedScenario, MissingFileIsAnError) {
  EXPECT_EQ(told(parseScenario("nowhere/none.yaml").problems), "nowhere/none.yaml: there is no such file\n");
  EXPECT_EQ(told(parseScenario(folder_.path().string()).problems),
            folder_.path().string() + ": cannot read: it is a folder\n");
}

TEST_F(DamagedScenario, ReportsAtMostFiftyErrorsOfATrack) {
  std::string track = "t_s,latitude_deg,longitude_deg,height_msl_m\n";
  for (int i = 0; i < 1000; ++i) track += "x,y,z\n";
  folder_.write("track.csv", track);
  EXPECT_EQ(parseScenario(folder_.write("scenario.yaml", text_)).problems.size(), 50u);
}

}  // namespace
}  // namespace emscape::scenario
