#include "emscape/playback/series/series_writer.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "emscape/base/log.h"
#include "emscape/base/work.h"
#include "emscape/volume/format/file.h"
#include "tests/playback/playback_samples.h"
#include "volume/vtk/vti.h"

namespace emscape::playback::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using Existing = SeriesOptions::Existing;

const std::vector<std::string>& allFormats() {
  static const std::vector<std::string> kFormats{"vdb", "nvdb", "vti", "raw"};
  return kFormats;
}

/// A series of the quick scenario, small.
class SeriesWriter : public testing::Test {
 protected:
  SeriesWriter() {
    setLogSink([this](LogLevel, const std::string& message) { messages_.push_back(message); });
  }
  ~SeriesWriter() override { setLogSink({}); }

  FieldSeries series(int steps, const std::vector<std::pair<std::string, std::string>>& replaced = {},
                     const StopFlag* stop = nullptr, std::vector<std::string> quantities = {}) const {
    // The strong transmitter is switched on late, so the range over the series is known late.
    std::vector<std::pair<std::string, std::string>> all{
        {"[40, 40, 20]", "[8, 9, 6]"}, {"power_w: 1000\n", "power_w: 1.0e9\n    active_s: [[3.5, 100]]\n"}};
    all.insert(all.end(), replaced.begin(), replaced.end());
    emfield::FieldOptions options;
    options.quantities = std::move(quantities);
    return {loadScenarioWithTerrain(quickScenario(input_, all)), seconds(steps), options, stop};
  }
  SeriesOptions into(const std::string& folder, std::vector<std::string> formats = allFormats(),
                     Existing existing = Existing::refuse) const {
    SeriesOptions options;
    options.folder = folder_ / folder;
    options.formats = std::move(formats);
    options.existing = existing;
    return options;
  }
  SeriesResult write(int steps, const SeriesOptions& options) const {
    FieldSeries field = series(steps);
    return writeSeries(field, options);
  }
  /// Stops as soon as a number of steps have been computed and the writer has finished one of them.
  void writeAndStopAfter(int stop_after, int steps, const SeriesOptions& options) const {
    StopFlag stop{false};
    FieldSeries field = series(steps, {}, &stop);
    int told = 0;
    EXPECT_THROW(writeSeries(field, options,
                             [&](const std::string&, double) {
                               if (++told == stop_after) stop = true;
                             }),
                 Stopped);
  }

  std::string operator/(const std::string& name) const { return folder_ / name; }
  /// Contents of all files of a folder by name.
  std::map<std::string, std::string> contents(const std::string& folder) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder_ / folder)) {
      files[entry.path().filename().string()] = readFile(entry.path());
    }
    return files;
  }
  /// The same without what depends on how often the work was interrupted.
  std::map<std::string, std::string> volumes(const std::string& folder) const {
    std::map<std::string, std::string> files = contents(folder);
    files.erase("series.steps");
    return files;
  }
  json stateOf(const std::string& folder) const {
    return json::parse(readFile(folder_ / folder + "/series.json"));
  }
  std::vector<json> journalOf(const std::string& folder) const {
    std::istringstream lines(readFile(folder_ / folder + "/series.steps"));
    std::vector<json> records;
    for (std::string line; std::getline(lines, line);) records.push_back(json::parse(line));
    return records;
  }

  TemporaryFolder input_, folder_;
  std::vector<std::string> messages_;
};

TEST_F(SeriesWriter, ComputesEachStepOnceInEveryFormat) {
  for (const std::string& format : allFormats()) {
    FieldSeries field = series(5);
    const SeriesResult result = writeSeries(field, into(format, {format}));
    EXPECT_EQ(result.steps_computed, 5) << format;
  }
}

TEST_F(SeriesWriter, EveryFileStatesTheRangeOfTheWholeSeries) {
  const SeriesResult found = write(5, into("found"));
  ASSERT_EQ(found.ranges.size(), 1U);
  SeriesOptions known = into("known");
  known.range = found.ranges[0];
  write(5, known);
  std::map<std::string, std::string> a = volumes("found"), b = volumes("known");
  a.erase("series.json");  // it records whether the range was given
  b.erase("series.json");
  EXPECT_EQ(a.size(), 5U * 6 + 1);
  EXPECT_TRUE(a == b);
  for (const std::string& format : allFormats()) {
    const volume::VolumeInfo first = volume::readVolume(*this / ("found/quick_0001." + format)).info;
    EXPECT_EQ(first.range_min, found.ranges[0].min) << format;
    EXPECT_EQ(first.range_max, found.ranges[0].max) << format;
  }
}

TEST_F(SeriesWriter, WhileItRunsFilesAreWholeAndStateTheRangeSoFar) {
  writeAndStopAfter(3, 6, into("s", {"vdb", "vti"}));
  ValueRange so_far;
  int finished = 0;
  for (const json& record : journalOf("s")) {
    ++finished;
    so_far.add({record.at("range")[0].at(0).get<float>(), record.at("range")[0].at(1).get<float>()});
    for (const json& file : record.at("files")) {
      const volume::DenseVolume volume =
          volume::readVolume(*this / ("s/" + file.at("name").get<std::string>()));
      EXPECT_EQ(volume.info.range_min, so_far.min);
      EXPECT_EQ(volume.info.range_max, so_far.max);
    }
  }
  EXPECT_GT(finished, 0);
  EXPECT_EQ(volume::readPvd(*this / "s/quick.pvd").size(), static_cast<std::size_t>(finished));
  EXPECT_FALSE(stateOf("s").at("complete").get<bool>());
}

TEST_F(SeriesWriter, AnInterruptedSeriesResumesToTheSameBytes) {
  write(6, into("whole"));
  writeAndStopAfter(2, 6, into("s"));
  writeAndStopAfter(2, 6, into("s", allFormats(), Existing::resume));
  const SeriesResult resumed = write(6, into("s", allFormats(), Existing::resume));
  EXPECT_LT(resumed.steps_computed, 6);
  EXPECT_TRUE(volumes("s") == volumes("whole"));
}

TEST_F(SeriesWriter, FogIsTheOpacityOfTheFirstStepsLookAndResumesToTheSameBytes) {
  SeriesOptions options = into("fog", {"vdb", "raw"});
  options.with_fog = true;
  write(3, options);
  for (const char* step : {"fog/quick_0001.vdb", "fog/quick_0003.vdb"}) {
    const volume::DenseVolume fog = volume::readVolume(*this / step, "density"),
                              field = volume::readVolume(*this / step, "power_density_dbwm2");
    EXPECT_EQ(fog.grid, field.grid);
    EXPECT_EQ(fog.info.extra.at("density_of"), "power_density_dbwm2");
    const auto [least, greatest] = std::minmax_element(fog.values.begin(), fog.values.end());
    EXPECT_EQ(*least, 0);
    EXPECT_EQ(*greatest, 1);
    // Stronger fields are at least as dense.
    const auto strongest = std::max_element(field.values.begin(), field.values.end()) - field.values.begin();
    EXPECT_EQ(fog.values[static_cast<std::size_t>(strongest)], 1);
  }
  EXPECT_EQ(volume::listVolume(*this / "fog/quick_0001.raw").volumes.size(), 1u);
  SeriesOptions stopped = into("again", {"vdb", "raw"});
  stopped.with_fog = true;
  writeAndStopAfter(1, 3, stopped);
  stopped.existing = Existing::resume;
  write(3, stopped);
  EXPECT_EQ(contents("again"), contents("fog"));
}

TEST_F(SeriesWriter, AnInterruptedPassOverTheRangesIsCompleted) {
  write(6, into("whole"));
  // The 6 steps, then the third of those that get another range.
  writeAndStopAfter(6 + 3, 6, into("s"));
  const std::size_t lines = journalOf("s").size();
  EXPECT_GE(lines, 6U);
  FieldSeries field = series(6);
  const SeriesResult resumed = writeSeries(field, into("s", allFormats(), Existing::resume));
  EXPECT_EQ(resumed.steps_computed, 0);
  EXPECT_TRUE(volumes("s") == volumes("whole"));
  EXPECT_TRUE(stateOf("s").at("complete").get<bool>());
}

TEST_F(SeriesWriter, KillBetweenNewRangeOfFileAndItsRecordIsRepaired) {
  write(4, into("whole"));
  write(4, into("s"));
  // As if the process had died after changing the range in a file.
  volume::setStoredRange(*this / "s/quick_0002.vdb", {{"power_density_dbwm2", -100, 1}});
  const SeriesResult resumed = write(4, into("s", allFormats(), Existing::resume));
  EXPECT_EQ(resumed.steps_computed, 1);
  EXPECT_TRUE(volumes("s") == volumes("whole"));
}

TEST_F(SeriesWriter, MissingOrEmptyFilesAreComputedAgainAndReplacedOnesStay) {
  write(5, into("whole"));
  write(5, into("s"));
  fs::remove(*this / "s/quick_0001.vdb");
  writeFile(*this / "s/quick_0002.raw", "");
  fs::copy_file(*this / "s/quick_0005.vti", *this / "s/quick_0003.vti", fs::copy_options::overwrite_existing);
  fs::remove(*this / "s/quick_0004.nvdb.json");
  const auto before = volumes("s");
  EXPECT_THAT(
      errorOf([&] { write(5, into("s", allFormats(), Existing::resume)); }),
      HasSubstr("quick_0003.vti: is a file that emscape did not write, or has no record of having written"));
  EXPECT_TRUE(volumes("s") == before) << "nothing is lost";
  fs::remove(*this / "s/quick_0003.vti");
  FieldSeries field = series(5);
  const SeriesResult resumed = writeSeries(field, into("s", allFormats(), Existing::resume));
  EXPECT_EQ(resumed.steps_computed, 4);
  EXPECT_TRUE(volumes("s") == volumes("whole"));
  EXPECT_THAT(messages_, Contains(AllOf(HasSubstr("4 of the finished steps are computed again"),
                                        HasSubstr("quick_0001.vdb"))));
}

TEST_F(SeriesWriter, FinishedSeriesWithMissingFilesIsIncomplete) {
  write(4, into("s", {"raw"}));
  fs::remove(*this / "s/quick_0002.raw");
  fs::remove(*this / "s/quick_0004.raw");
  writeAndStopAfter(1, 4, into("s", {"raw"}, Existing::resume));
  EXPECT_FALSE(findSeries(*this / "s")->complete);
  write(4, into("s", {"raw"}, Existing::resume));
  EXPECT_TRUE(findSeries(*this / "s")->complete);
}

TEST_F(SeriesWriter, FinishedSeriesIsUnchanged) {
  write(3, into("s"));
  const auto before = contents("s");
  FieldSeries field = series(3);
  const SeriesResult resumed = writeSeries(field, into("s", allFormats(), Existing::resume));
  EXPECT_EQ(resumed.steps_computed, 0);
  EXPECT_TRUE(contents("s") == before);
  EXPECT_THAT(messages_, Contains("3 of 3 steps are there already"));
}

TEST_F(SeriesWriter, TheJournalGrowsByALineAStepAndTheListOfFilesIsWrittenAtGrowingIntervals) {
  SeriesOptions options = into("s", {"raw"});
  options.range = ValueRange{-120, 20};
  write(40, options);
  const std::vector<json> records = journalOf("s");
  EXPECT_EQ(records.size(), 40U);
  for (std::size_t i = 0; i < records.size(); ++i) EXPECT_EQ(records[i].at("step"), i + 1);
}

TEST_F(SeriesWriter, TruncatedRecordIsIgnored) {
  write(4, into("s", {"raw"}));
  const std::string journal = readFile(*this / "s/series.steps");
  writeFile(*this / "s/series.steps", journal + "{\"step\": 2, \"ran");
  EXPECT_EQ(findSeries(*this / "s")->finished_steps, 4);
  fs::remove(*this / "s/quick_0003.raw");
  write(4, into("s", {"raw"}, Existing::resume));
  EXPECT_EQ(findSeries(*this / "s")->finished_steps, 4);
  EXPECT_NO_THROW(journalOf("s"));
}

TEST_F(SeriesWriter, ADamagedJournalIsAnErrorThatNamesTheLine) {
  write(3, into("s", {"raw"}));
  const std::string whole = readFile(*this / "s/series.steps");
  const std::size_t second = whole.find('\n') + 1;
  std::string changed = whole.substr(second, whole.find('\n', second) - second);
  const std::vector<std::pair<std::string, std::string>> damages{
      {"{\"step\": 2", "no JSON"},
      {"{\"step\":99,\"range\":[null],\"stored_range\":[null],\"files\":[]}", "step 99 is outside 1..3"},
      {"{\"step\":-2e9,\"range\":[null],\"stored_range\":[null],\"files\":[]}", "outside 1..3"},
      {"{\"step\":2,\"range\":[],\"stored_range\":[null],\"files\":[]}", "one range per quantity"},
      {"{\"step\":2,\"range\":[[3,1]],\"stored_range\":[null],\"files\":[]}", "minimum exceeds"},
      {"[]", ""},
      {"", "no JSON"},
      {changed.insert(changed.find("\"bytes\":") + 8, "1"), "it was changed since it was written"},
  };
  for (const auto& [line, cause] : damages) {
    std::string damaged = whole;
    damaged.replace(second, whole.find('\n', second) - second, line);
    writeFile(*this / "s/series.steps", damaged);
    const std::string error = errorOf([&] { write(3, into("s", {"raw"}, Existing::resume)); });
    EXPECT_THAT(error, HasSubstr("series.steps:2: not a step of the series")) << line;
    EXPECT_THAT(error, HasSubstr(cause));
  }
}

TEST_F(SeriesWriter, ADamagedStateIsAnErrorThatNamesTheFile) {
  write(2, into("s", {"raw"}));
  const std::string whole = readFile(*this / "s/series.json");
  writeFile(*this / "s/series.json", whole.substr(0, whole.find("\"recipe\"")));
  EXPECT_THAT(errorOf([&] { write(2, into("s", {"raw"}, Existing::resume)); }),
              AllOf(HasSubstr("series.json:"), HasSubstr("not valid JSON")));
  writeFile(*this / "s/series.json", "");
  EXPECT_THAT(errorOf([&] { write(2, into("s", {"raw"}, Existing::resume)); }),
              HasSubstr("not the state of a series; use another folder"));
  fs::remove(*this / "s/series.json");
  fs::create_directories(*this / "s/series.json");
  EXPECT_THAT(
      errorOf([&] { write(2, into("s", {"raw"}, Existing::resume)); }),
      HasSubstr("series.json: cannot read: it is a folder: not the state of a series; use another folder"));
  fs::remove(*this / "s/series.json");
  writeFile(*this / "s/series.json", whole);
  for (const char* key : {"format_version", "complete", "ranges", "recipe"}) {
    json damaged = json::parse(whole);
    damaged.erase(key);
    writeFile(*this / "s/series.json", damaged.dump());
    EXPECT_THAT(errorOf([&] { write(2, into("s", {"raw"}, Existing::resume)); }),
                AllOf(HasSubstr("series.json"), HasSubstr(key)));
  }
  writeFile(*this / "s/series.json", "mine\n");
  EXPECT_THAT(errorOf([&] { write(2, into("s", {"raw"}, Existing::replace)); }),
              HasSubstr("a file that emscape did not write"));
  EXPECT_EQ(readFile(*this / "s/series.json"), "mine\n");
}

TEST_F(SeriesWriter, AFolderThatHoldsASeriesIsRefusedResumedOrReplaced) {
  write(3, into("s", {"raw"}));
  EXPECT_THAT(errorOf([&] { write(3, into("s", {"raw"})); }), HasSubstr("holds a series"));
  EXPECT_THAT(errorOf([&] { write(4, into("s", {"raw"}, Existing::resume)); }), HasSubstr("another times"));
  write(1, into("s", {"vdb"}, Existing::replace));
  std::vector<std::string> names;
  for (const auto& [name, content] : contents("s")) names.push_back(name);
  EXPECT_THAT(names, ElementsAre("quick_0001.vdb", "series.json", "series.steps"));
}

TEST_F(SeriesWriter, ReplacingRemovesASeriesOfAnotherName) {
  FieldSeries other = series(3, {{"name: quick", "name: other one"}});
  writeSeries(other, into("s", {"vti", "raw"}));
  writeFile(*this / "s/notes.txt", "mine");
  writeFile(*this / "s/other_one_plan.json", "{}");
  write(1, into("s", {"vdb"}, Existing::replace));
  std::vector<std::string> names;
  for (const auto& [name, content] : contents("s")) names.push_back(name);
  EXPECT_THAT(names, ElementsAre("notes.txt", "other_one_plan.json", "quick_0001.vdb", "series.json",
                                 "series.steps"));
}

TEST_F(SeriesWriter, ReplacingKeepsFilesThatTheSeriesDidNotWrite) {
  write(2, into("s", {"raw"}));
  for (const char* name : {"quick_0003_notes.raw.json", "quick.pvd", "quick_0001_notes.nvdb.json"})
    writeFile(*this / "s/" + name, "mine");
  write(1, into("s", {"raw"}, Existing::replace));
  const std::map<std::string, std::string> after = contents("s");
  for (const char* name : {"quick_0003_notes.raw.json", "quick.pvd", "quick_0001_notes.nvdb.json"})
    EXPECT_THAT(after, testing::Contains(testing::Pair(name, "mine")));
  EXPECT_EQ(after.count("quick_0002.raw"), 0u);
  writeFile(*this / "s/quick_0001_before.raw", "mine");
  EXPECT_THAT(errorOf([&] { write(1, into("s", {"raw"}, Existing::replace)); }),
              HasSubstr("quick_0001_before.raw"));
  EXPECT_THAT(contents("s"), testing::Contains(testing::Pair("quick_0001_before.raw", "mine")));
}

TEST_F(SeriesWriter, ReplacingKeepsFilesThatAForeignRecordNames) {
  write(1, into("s", {"raw"}));
  std::string record = readFile(*this / "s/series.steps"), listed;
  const std::string names[] = {"thesis.txt", "photo_0001.png", "../outside_0001.raw"};
  for (const std::string& name : names) {
    writeFile(*this / "s/" + name, "mine");
    listed += R"({"name":")" + name + R"(","bytes":4,"crc32":1772671891},)";  // of "mine"
  }
  const std::string list = R"("files":[)";
  record.insert(record.find(list) + list.size(), listed);
  writeFile(*this / "s/series.steps", record);
  EXPECT_THAT(errorOf([&] { write(1, into("s", {"raw"}, Existing::replace)); }),
              HasSubstr("series.steps:1: is no line that emscape wrote"));
  record.replace(record.rfind(R"(,"crc32":)"), std::string::npos, "}\n");  // as of earlier versions
  writeFile(*this / "s/series.steps", record);
  write(1, into("s", {"raw"}, Existing::replace));
  for (const std::string& name : names) EXPECT_EQ(readFile(*this / "s/" + name), "mine") << name;
}

TEST_F(SeriesWriter, WhatIsInTheWayIsToldBeforeAnyFileIsReplaced) {
  for (const char* name : {"series.steps", "quick_0003.vti", "quick.pvd"}) {
    for (const Existing existing : {Existing::resume, Existing::replace}) {
      fs::remove_all(*this / "s");
      write(3, into("s", {"vti"}));
      fs::remove(*this / "s/" + name);
      fs::create_directory(*this / "s/" + name);
      const std::map<std::string, std::string> before = contents("s");
      EXPECT_THAT(errorOf([&] { write(3, into("s", {"vti"}, existing)); }),
                  AllOf(HasSubstr(name), HasSubstr("is no file")));
      EXPECT_EQ(contents("s"), before) << name;
    }
  }
  fs::remove_all(*this / "s");
  write(3, into("s", {"vti"}));
  fs::remove(*this / "s/series.steps");
  writeFile(*this / "s/quick_0003.vti", "mine");
  const std::map<std::string, std::string> before = contents("s");
  EXPECT_THAT(errorOf([&] { write(3, into("s", {"vti"}, Existing::resume)); }), HasSubstr("quick_0003.vti"));
  EXPECT_EQ(contents("s"), before);
}

TEST_F(SeriesWriter, ReplacingRemovesAVolumeWhoseNewRangeIsNotInTheJournal) {
  write(2, into("s", {"vdb"}));
  volume::setStoredRange(*this / "s/quick_0002.vdb", {{"power_density_dbwm2", -100, 1}});
  write(1, into("s", {"vdb"}, Existing::replace));
  EXPECT_FALSE(fs::exists(*this / "s/quick_0002.vdb"));
}

TEST_F(SeriesWriter, ReplacingRefusesVolumesThatWouldBeReadWithTheSeries) {
  write(2, into("s", {"vti"}));
  const std::map<std::string, std::string> before = contents("s");
  for (const char* name : {"mine.vti", "mine.vdb"}) {
    writeFile(*this / "s/" + name, "");
    EXPECT_THAT(errorOf([&] { write(1, into("s", {"vti"}, Existing::replace)); }),
                AllOf(HasSubstr(name), HasSubstr("is not a file of the present series")));
    fs::remove(*this / "s/" + name);
    EXPECT_EQ(contents("s"), before) << "nothing is removed";
  }
  writeFile(*this / "s/mine.raw", "");  // readers of the folder take only .vti
  write(1, into("s", {"vti"}, Existing::replace));
  EXPECT_THAT(contents("s"), testing::Contains(testing::Key("mine.raw")));
}

TEST_F(SeriesWriter, AnotherElevationFileOfTheSameSizeIsNotTheSameSeries) {
  std::string heights(std::size_t{2} * 1201 * 1201,
                      '\0');  // a tile of SRTM: 16 bits a post, the high byte first
  for (std::size_t post = 0; post < heights.size(); post += 2) heights[post + 1] = 100;
  writeFile(input_ / "N52E005.hgt", heights);
  const std::vector<std::pair<std::string, std::string>> over_ground{
      {"latitude_deg: 52, longitude_deg: 5, height_msl_m: 0",
       "latitude_deg: 52.5, longitude_deg: 5.5, height_msl_m: 0"},
      {"latitude_deg: 52, longitude_deg: 5, height_agl",
       "latitude_deg: 52.5, longitude_deg: 5.5, height_agl"},
      {"latitude_deg: 52.05, longitude_deg: 5.06", "latitude_deg: 52.51, longitude_deg: 5.51"},
      {"platforms:", "terrain: {files: [N52E005.hgt], vertical_datum: egm96}\nplatforms:"}};
  FieldSeries first = series(1, over_ground);
  writeSeries(first, into("s", {"raw"}));
  heights[heights.size() / 2 + 1] = 101;
  writeFile(input_ / "N52E005.hgt", heights);
  EXPECT_THAT(errorOf([&] {
                FieldSeries changed = series(1, over_ground);
                writeSeries(changed, into("s", {"raw"}, Existing::resume));
              }),
              HasSubstr("another content of terrain files"));
}

TEST_F(SeriesWriter, ChannelsWhoseNamesCollideInFileNamesGetFilesOfTheirOwn) {
  FieldSeries field = series(1, {{"- name: radar\n", "- name: a/b\n"},
                                 {"- name: transmitter\n", "- name: a_b\n"},
                                 {"platforms:", "output: {combine: per_emitter}\nplatforms:"}});
  const SeriesResult result = writeSeries(field, into("s", {"raw"}));
  ASSERT_EQ(result.channels.size(), 2U);
  EXPECT_EQ(volume::readVolume(*this / "s/quick_0001_power_density_dbwm2_a_b.raw").info.quantity,
            result.channels[0]);
  EXPECT_EQ(volume::readVolume(*this / "s/quick_0001_power_density_dbwm2_a_b-2.raw").info.quantity,
            result.channels[1]);
}

TEST_F(SeriesWriter, SeveralQuantitiesHaveARangeEachAndNoneIsGivenForAll) {
  FieldSeries field = series(3, {}, nullptr, {"power_density_dbwm2", "emitter_count"});
  const SeriesResult result = writeSeries(field, into("s"));
  EXPECT_THAT(result.channels, ElementsAre("power_density_dbwm2", "emitter_count"));
  const volume::VolumeInfo count = volume::readVolume(*this / "s/quick_0001.vdb", "emitter_count").info;
  EXPECT_EQ(count.range_max, result.ranges[1].empty() ? count.floor : result.ranges[1].max);
  SeriesOptions given = into("t");
  given.range = ValueRange{0, 1};
  FieldSeries again = series(3, {}, nullptr, {"power_density_dbwm2", "emitter_count"});
  EXPECT_THAT(errorOf([&] { writeSeries(again, given); }),
              HasSubstr("a range is for one quantity, these are 2"));
}

TEST_F(SeriesWriter, WriteFailureIsReportedAndFinishedFilesStay) {
  FieldSeries field = series(4);
  fs::create_directories(folder_ / "s/quick_0003.raw");  // a folder is in the way
  EXPECT_THAT(errorOf([&] { writeSeries(field, into("s", {"vti", "raw"})); }), HasSubstr("quick_0003.raw"));
  EXPECT_EQ(findSeries(*this / "s")->finished_steps, 2);
  EXPECT_EQ(volume::readPvd(*this / "s/quick.pvd").size(), 2U);
}

TEST_F(SeriesWriter, AFolderWithoutASeriesHasNoStatus) {
  EXPECT_FALSE(findSeries(folder_ / "nowhere"));
}

TEST_F(SeriesWriter, NamesAForeignFileInTheWayAndLeavesIt) {
  fs::create_directories(folder_.path() / "own");
  for (const char* name : {"quick_0001.vdb", "quick_0007.vdb", "notes.vdb"}) {
    const std::string file = *this / ("own/" + std::string(name));
    ::emscape::test::writeFile(file, "of the user");
    for (const Existing existing : {Existing::refuse, Existing::replace, Existing::resume}) {
      const std::string error =
          ::emscape::test::errorOf([&] { write(2, into("own", {"vdb"}, existing)); }, ErrorCode::usage);
      EXPECT_THAT(error, AllOf(HasSubstr(name), HasSubstr("move it, or use another folder")));
      EXPECT_THAT(contents("own"), ElementsAre(testing::Pair(name, "of the user")));
    }
    fs::remove(file);
  }
  write(2, into("own", {"vdb"}));
}

TEST_F(SeriesWriter, ResumingAndReplacingRefuseAChangedOrLinkedDescriptionOrListOfFiles) {
  write(2, into("s", {"vti"}));
  // As the user would change them: the program reads them as before.
  const std::pair<std::string, std::string> added[] = {{"series.json", " \n"},
                                                       {"quick.pvd", "<!-- mine -->\n"}};
  for (const auto& [name, text] : added) {
    const std::string file = *this / "s/" + name, moved = *this / name;
    fs::rename(file, moved);
    for (const bool is_link : {false, true}) {
      if (is_link) {
        fs::create_symlink(moved, file);
      } else {
        writeFile(file, readFile(moved) + text);
      }
      const auto before = contents("s");
      for (const Existing existing : {Existing::resume, Existing::replace}) {
        EXPECT_THAT(
            errorOf([&] { write(2, into("s", {"vti"}, existing)); }, ErrorCode::usage),
            AllOf(HasSubstr(name + ": is a " + (is_link ? "link" : "file that emscape did not write")),
                  HasSubstr("give another output")));
        EXPECT_TRUE(contents("s") == before && fs::is_symlink(file) == is_link) << name;
      }
      fs::remove(file);
    }
    fs::rename(moved, file);
  }
  write(2, into("s", {"vti"}, Existing::resume));
  fs::create_directories(*this / "new");
  fs::create_symlink("nowhere", *this / "new/series.json");
  EXPECT_THAT(errorOf([&] { write(2, into("new", {"vti"})); }, ErrorCode::usage),
              AllOf(HasSubstr("series.json: is in the folder"), HasSubstr("move it, or use another folder")));
}

TEST_F(SeriesWriter, LinksToThemselvesAreOtherEntries) {
  write(2, into("own", {"vdb"}));
  fs::create_symlink("loop", *this / "own/loop");
  EXPECT_EQ(volume::seriesOf(*this / "own").size(), 2u);
  write(2, into("own", {"vdb"}, Existing::replace));
}

}  // namespace
}  // namespace emscape::playback::test
