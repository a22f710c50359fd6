// emscape simulate and render, end to end on a small scenario.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/apps/program.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;

json infoOf(const std::string& file) {
  return json::parse(runWell({"info", file, "--json"}).out);
}

TEST(Simulate, WritesExactlyEveryFormatOfEveryStep) {
  const TemporaryFolder folder;
  const ProgramResult result =
      runWell({"simulate", quick(), "-o", folder / "s", "--format", "vdb,nvdb,vti,raw", "--times", "0:2:1",
               "--quantity", "power_density_dbwm2,emitter_count", "--json"});
  const std::vector<std::string> files = folder.files();
  for (const char* step : {"0001", "0002", "0003"}) {
    for (const char* ending : {".vdb", ".nvdb", ".vti"}) {
      EXPECT_THAT(files, Contains("s/quick_" + std::string(step) + ending));
    }
  }
  EXPECT_THAT(files, IsSupersetOf({"s/quick.pvd", "s/series.json", "s/series.steps"}));
  EXPECT_THAT(files, Not(Contains(HasSubstr(".part-"))));
  EXPECT_EQ(json::parse(result.out).at("steps"), 3);
}

TEST(Simulate, TakesItsScenarioAfterAListToo) {
  const TemporaryFolder folder;
  runWell({"simulate", "--format", "vdb,raw", "--quantity", "emitter_count", quick(), "-o", folder / "s",
           "--times", "0:1:1"});
  EXPECT_THAT(folder.files(), Contains("s/quick_0001.vdb"));
}

TEST(Simulate, EveryVolumeStatesRangeOfWholeSeries) {
  const TemporaryFolder folder;
  ASSERT_EQ(run({"simulate", quick(), "-o", folder / "s", "--times", "0:4:2"}).status, 0);
  const json first = infoOf(folder / "s/quick_0001.vdb").at("volumes").at(0);
  const json last = infoOf(folder / "s/quick_0003.vdb").at("volumes").at(0);
  EXPECT_EQ(first.at("range"), last.at("range"));
  EXPECT_EQ(last.at("time_s"), 4.0);
  EXPECT_EQ(last.at("quantity"), "power_density_dbwm2");
  EXPECT_LT(first.at("range").at(0), first.at("range").at(1));
}

TEST(Simulate, RefusesAFolderThatHoldsASeries) {
  const TemporaryFolder folder;
  const Arguments arguments{"simulate", quick(), "-o", folder / "s", "--times", "0:1:1"};
  ASSERT_EQ(run(arguments).status, 0);
  EXPECT_THAT(errorOfRun(arguments, 2), HasSubstr("--resume"));
  Arguments force = arguments;
  force.emplace_back("--force");
  EXPECT_EQ(run(force).status, 0);
}

TEST(Simulate, ForceRemovesPreviousSeries) {
  const TemporaryFolder folder;
  ASSERT_EQ(run({"simulate", quick(), "-o", folder / "s", "--times", "0:3:1"}).status, 0);
  writeFile(folder / "s/notes.txt", "mine");
  ASSERT_EQ(run({"simulate", quick(), "-o", folder / "s", "--times", "0", "--force"}).status, 0);
  EXPECT_THAT(folder.files(),
              ElementsAre("s/notes.txt", "s/quick_0001.vdb", "s/series.json", "s/series.steps"));
}

TEST(Simulate, ResumeRefusesOtherOptionsByName) {
  const TemporaryFolder folder;
  ASSERT_EQ(run({"simulate", quick(), "-o", folder / "s", "--times", "0:1:1"}).status, 0);
  EXPECT_THAT(errorOfRun({"simulate", quick(), "-o", folder / "s", "--times", "0:2:1", "--resume"}, 3),
              HasSubstr("another times"));
}

TEST(Simulate, SLOW_ASeriesThatWasKilledResumesToTheSameFiles) {
  const TemporaryFolder folder;
  const std::string scenario = longScenario(folder, 80);
  const Arguments arguments{"simulate", scenario, "-o",      folder / "s",
                            "--format", "raw",    "--range", "-120:20"};
  RunningProgram first(arguments);
  while (!std::filesystem::exists(folder / "s/quick_0003.raw"))
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  first.signal(SIGKILL);
  ASSERT_EQ(first.wait().status, 128 + SIGKILL);

  Arguments resume = arguments;
  resume.insert(resume.end(), {"--resume", "--json"});
  const json report = json::parse(runWell(resume).out);
  EXPECT_LT(report.at("steps_computed"), report.at("steps"));

  Arguments whole = arguments;
  whole[3] = folder / "w";
  ASSERT_EQ(run(whole).status, 0);
  for (const char* file : {"quick_0001.raw", "quick_0004.raw", "quick_0081.raw", "quick_0081.raw.json"}) {
    EXPECT_TRUE(readFile(folder.path() / "s" / file) == readFile(folder.path() / "w" / file)) << file;
  }
  EXPECT_THAT(folder.files(), Not(Contains(HasSubstr(".part-"))));
}

TEST(Simulate, CtrlCLeavesWholeFilesAndStatus130) {
  const TemporaryFolder folder;
  RunningProgram program(
      {"simulate", longScenario(folder, 80), "-o", folder / "s", "--format", "vti", "--range", "-120:20"});
  while (!std::filesystem::exists(folder / "s/quick_0002.vti"))
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  program.signal(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.status, 130) << result.err;
  EXPECT_THAT(folder.files(), Not(Contains(HasSubstr(".part-"))));
  EXPECT_EQ(infoOf(folder / "s/quick.pvd").at("steps"), infoOf(folder / "s/quick.pvd").at("times_s").size());
}

TEST(Simulate, FullDiskIsOneErrorAndKeepsFinishedFiles) {
  const TemporaryFolder folder;
  // Files may grow to 64 KiB: series.json fits, a volume does not.
  EXPECT_THAT(errorOfRun({"simulate", quick(), "-o", folder / "s", "--format", "raw"}, 1,
                         "trap '' XFSZ; ulimit -f 128;"),
              HasSubstr("emscape: error: "));
  EXPECT_THAT(folder.files(), ElementsAre("s/series.json"));
}

TEST(Simulate, ADamagedStateOrJournalIsOneErrorThatNamesFileAndLine) {
  const TemporaryFolder folder;
  const Arguments arguments{"simulate", quick(), "-o", folder / "s", "--times", "0:1:1"};
  ASSERT_EQ(run(arguments).status, 0);
  Arguments resume = arguments;
  resume.emplace_back("--resume");
  const std::string state = readFile(folder / "s/series.json");
  for (const char* key : {"ranges", "recipe"}) {
    json damaged = json::parse(state);
    damaged[key] = key == std::string("ranges") ? json::object() : json::array();
    writeFile(folder / "s/series.json", damaged.dump());
    const ProgramResult result = run(resume);
    EXPECT_EQ(result.status, 3) << key;
    EXPECT_THAT(result.err, HasSubstr("series.json: "));
  }
  writeFile(folder / "s/series.json", state);
  const std::string journal = readFile(folder / "s/series.steps");
  for (const char* number : {"-3", "-2000000000", "99", "1e300", "null"}) {
    std::string damaged = journal;
    damaged.replace(damaged.find("\"step\":2"), 8, std::string("\"step\":") + number);
    writeFile(folder / "s/series.steps", damaged);
    const ProgramResult result = run(resume);
    EXPECT_EQ(result.status, 3) << number << ": " << result.err;
    EXPECT_THAT(result.err, HasSubstr("series.steps:2: ")) << number;
  }
  EXPECT_EQ(folder.files().size(), 4U);
}

TEST(Simulate, ResumeRestoresAFileThatWasDeleted) {
  const TemporaryFolder folder;
  Arguments arguments{"simulate", quick(), "-o", folder / "s"};
  ASSERT_EQ(run(arguments).status, 0);
  const std::string before = readFile(folder / "s/quick_0003.vdb");
  std::filesystem::remove(folder / "s/quick_0003.vdb");
  arguments.insert(arguments.end(), {"--resume", "--json"});
  const ProgramResult result = runWell(arguments);
  EXPECT_EQ(json::parse(result.out).at("steps_computed"), 1);
  EXPECT_THAT(result.err, HasSubstr("computed again"));
  EXPECT_TRUE(readFile(folder / "s/quick_0003.vdb") == before);
}

TEST(Simulate, WithoutTerminalItPrintsWorkAndBackendOnce) {
  const TemporaryFolder folder;
  const ProgramResult result = runWell({"simulate", quick(), "-o", folder / "s"});
  const auto occurrences = [&](const std::string& text) {
    int count = 0;
    for (std::size_t at = result.err.find(text); at != std::string::npos; at = result.err.find(text, at + 1))
      ++count;
    return count;
  };
  EXPECT_EQ(occurrences("computing 5 steps of quick into "), 1) << result.err;
  EXPECT_EQ(occurrences("running on the "), 1) << result.err;
  EXPECT_EQ(occurrences("\r"), 0);
}

TEST(Simulate, EqualWarningsOfSeveralEmittersAreOneLine) {
  const TemporaryFolder folder;
  const ProgramResult result = runWell(
      {"simulate", shippedScenario("jacksboro.yaml"), "-o", folder / "s", "--times", "0", "--format", "raw"});
  const std::size_t first = result.err.find("closer than the far-field distance");
  ASSERT_NE(first, std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("closer than the far-field distance", first + 1), std::string::npos)
      << result.err;
}

TEST(Simulate, SLOW_AWarningOfEachStepNamesItsEmitterOnceWithTheRangeOfItsNumbers) {
  const TemporaryFolder folder;
  std::string scenario = readFile(quick());
  const std::string site = "position: {latitude_deg: 52.05, longitude_deg: 5.06, height_agl_m: 50}";
  scenario.replace(scenario.find(site), site.size(), "track: {file: track.csv}");
  folder.write("track.csv",
               "t_s,latitude_deg,longitude_deg,height_agl_m\n0,44.45,-71.6,300\n10,44.56,-71.4,300\n");
  const ProgramResult result = runWell({"simulate", folder.write("moving.yaml", scenario), "-o", folder / "s",
                                        "--times", "0:4", "--format", "raw"});
  EXPECT_THAT(result.err,
              testing::ContainsRegex("warning: emitter 'transmitter': 'diffraction': distance [0-9.]+ to "
                                     "[0-9.]+ km is outside 0.1..1000 km"));
}

TEST(Simulate, AWarningOfManyEmittersNamesFiveAndCountsTheOthers) {
  const TemporaryFolder folder;
  std::string scenario = readFile(quick());
  const std::string mast = "  - {name: mast, position: {latitude_deg: 52.05, ";
  scenario.replace(scenario.find(mast), mast.size(), "  - {name: mast, position: {latitude_deg: 20, ");
  for (int n = 2; n <= 8; ++n) {
    scenario += "  - {name: t" + std::to_string(n) +
                ", platform: mast, kind: transmitter, frequency_hz: 1e8, " +
                "power_w: 1000, antenna: {pattern: isotropic}, propagation: diffraction}\n";
  }
  const ProgramResult result = runWell({"simulate", folder.write("many.yaml", scenario), "-o", folder / "s",
                                        "--times", "0", "--format", "raw", "--set", "region.dims=[8, 8, 2]"});
  EXPECT_THAT(result.err,
              testing::ContainsRegex(
                  "warning: emitters ('[a-z0-9]+', ){4}'[a-z0-9]+' and 3 others: 'diffraction': "));
}

TEST(Simulate, AnnouncesItsStepsBeforeTheFirstOneIsComputed) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run({"simulate", shippedScenario("jacksboro.yaml"), "-o", folder / "s", "--times", "0", "--format",
           "raw", "--set", "region.dims=[8, 8, 4]", "--set",
           "platforms.mast.position={latitude_deg: 36.9, longitude_deg: -84.19, height_msl_m: 900}"});
  EXPECT_EQ(result.status, 3);
  const std::size_t line = result.err.find("computing 1 step of "),
                    refusal = result.err.find("missing terrain");
  EXPECT_LT(line, refusal) << result.err;
}

TEST(Simulate, AHangUpStopsItLikeCtrlC) {
  const TemporaryFolder folder;
  RunningProgram program({"simulate", longScenario(folder, 80), "-o", folder / "s", "--format", "raw"});
  while (!std::filesystem::exists(folder / "s/quick_0002.raw"))
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  program.signal(SIGHUP);
  EXPECT_EQ(program.wait().status, 128 + SIGHUP);
  EXPECT_THAT(folder.files(), Not(Contains(HasSubstr(".part-"))));
}

TEST(Simulate, ASecondProcessIsRefusedWhileOneWritesTheFolder) {
  const TemporaryFolder folder;
  const std::string scenario = longScenario(folder, 5000);
  const Arguments arguments{"simulate", scenario, "-o",      folder / "s",
                            "--format", "raw",    "--range", "-120:20"};
  RunningProgram first(arguments);
  while (!std::filesystem::exists(folder / "s/quick_0002.raw"))
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  Arguments second = arguments;
  second.emplace_back("--force");
  EXPECT_THAT(errorOfRun(second, 1), HasSubstr("another process writes this folder: process "));
  first.signal(SIGINT);
  EXPECT_EQ(first.wait().status, 130);
  EXPECT_THAT(folder.files(), Not(Contains(HasSubstr("lock"))));
}

TEST(Simulate, AFolderThatIsAFileIsAnError) {
  const TemporaryFolder folder;
  writeFile(folder / "file", "");
  EXPECT_EQ(run({"simulate", quick(), "-o", folder / "file"}).status, 2);
}

TEST(Render, DrawsAScenarioAsOnePicture) {
  const TemporaryFolder folder;
  runWell({"render", quick(), "-o", folder / "p.png", "--size", "160x120", "--times", "2"});
  const std::string png = readFile(folder / "p.png");
  ASSERT_GT(png.size(), 24U);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(static_cast<unsigned char>(png[19]), 160);
  EXPECT_EQ(static_cast<unsigned char>(png[23]), 120);
}

TEST(Render, DrawsASeriesOfVolumesLikeTheScenarioThatItCameFrom) {
  const TemporaryFolder folder;
  const Arguments look{"--size", "96x72", "--range", "-120:0", "--times", "0:2:1"};
  const auto render = [&](Arguments arguments) {
    arguments.insert(arguments.end(), look.begin(), look.end());
    runWell(arguments);
  };
  ASSERT_EQ(run({"simulate", quick(), "-o", folder / "s", "--format", "vdb,vti"}).status, 0);
  render({"render", quick(), "-o", folder / "direct"});
  render({"render", folder / "s", "-o", folder / "vdb", "--scenario", quick()});
  render({"render", folder / "s/quick.pvd", "-o", folder / "vti", "--scenario", quick()});
  for (const char* frame : {"quick_0001.png", "quick_0003.png"}) {
    const std::string direct = readFile(folder.path() / "direct" / frame);
    EXPECT_FALSE(direct.empty());
    EXPECT_TRUE(direct == readFile(folder.path() / "vdb" / frame)) << frame;
    EXPECT_TRUE(direct == readFile(folder.path() / "vti" / frame)) << frame;
  }
}

TEST(Render, WritesFramesAndVideoInOneGo) {
  if (std::system("command -v ffmpeg >/dev/null") != 0) GTEST_SKIP() << "ffmpeg is not installed";
  const TemporaryFolder folder;
  runWell(
      {"render", quick(), "-o", folder / "v.mp4", "-o", folder / "f", "--size", "65x49", "--times", "0:2:1"});
  EXPECT_THAT(folder.files(),
              ElementsAre("f/quick_0001.png", "f/quick_0002.png", "f/quick_0003.png", "v.mp4"));
  EXPECT_EQ(readFile(folder / "v.mp4").substr(4, 4), "ftyp");
}

TEST(Render, AVideoThatDoesNotFitOnTheDiskIsAnErrorAndNoFile) {
  if (std::system("command -v ffmpeg >/dev/null") != 0) GTEST_SKIP() << "ffmpeg is not installed";
  const TemporaryFolder folder;
  // Files may grow to 4 KiB.
  EXPECT_THAT(errorOfRun({"render", quick(), "-o", folder / "v.mp4", "--size", "320x240", "--times", "0:4:1"},
                         1, "trap '' XFSZ; ulimit -f 8;"),
              HasSubstr("v.mp4: ffmpeg"));
  EXPECT_TRUE(folder.files().empty());
}

TEST(Render, RemovesTemporariesOfKilledProcess) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "out");
  RunningProgram first({"render", longScenario(folder, 5000), "-o", folder / "out/v.mp4", "--size", "64x48"});
  const auto hasParts = [&] {
    for (const auto& entry : std::filesystem::directory_iterator(folder / "out")) {
      if (entry.path().filename().string().rfind("emscape.part-", 0) == 0) return true;
    }
    return false;
  };
  // With its record and something of the video; killed before, it leaves an empty folder.
  const auto isBegun = [&] {
    int files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "out"))
      files += entry.is_regular_file() ? 1 : 0;
    return files >= 2;
  };
  while (!isBegun()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  first.signal(SIGKILL);
  ASSERT_EQ(first.wait().status, 128 + SIGKILL);
  ASSERT_TRUE(hasParts());
  const ProgramResult result = runWell({"render", quick(), "-o", folder / "out/p.png", "--size", "64x48"});
  EXPECT_FALSE(hasParts());
  EXPECT_THAT(result.err, HasSubstr("drawing 1 picture of 64x48 into "));
}

TEST(Render, WithoutFfmpegAVideoIsAClearErrorAndNoFile) {
  const TemporaryFolder folder;
  EXPECT_THAT(errorOfRun({"render", quick(), "-o", folder / "v.mp4", "--size", "64x48"}, 1, "PATH=/nowhere;"),
              HasSubstr("needs the program ffmpeg"));
  EXPECT_TRUE(folder.files().empty());
}

TEST(Info, DescribesEveryKindOfInput) {
  const json scenario = infoOf(quick());
  EXPECT_EQ(scenario.at("kind"), "scenario");
  EXPECT_EQ(scenario.at("emitters").size(), 2U);
  const json dem = infoOf(shippedScenario("data/jacksboro.tif"));
  EXPECT_EQ(dem.at("kind"), "elevation");
  EXPECT_EQ(dem.at("columns"), 403);
  EXPECT_EQ(dem.at("highest_m"), 1076);
  const json antenna = infoOf(shippedScenario("data/sector_450mhz.msi"));
  EXPECT_EQ(antenna.at("kind"), "antenna");
  EXPECT_NEAR(antenna.at("gain_dbi"), 13.15, 1e-3);
}

}  // namespace
}  // namespace emscape::test
