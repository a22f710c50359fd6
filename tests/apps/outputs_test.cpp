// Files that subcommands write: never an input or another output, and whole or not at all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <thread>
#include <tuple>

#include "tests/apps/program.h"
#include "tests/support/sanitizers.h"

namespace emscape::test {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr int kOther = 1, kUsage = 2, kBadInput = 3;

/// Copies of two scenarios with their files.
class Outputs : public testing::Test {
 protected:
  Outputs() {
    fs::create_directory(folder_ / "data");
    for (const char* name : {"links.yaml", "quick.yaml", "data/drone.csv", "data/jammer_helicopter.csv",
                             "data/jacksboro.tif", "data/helicopter_rcs.csv", "data/helicopter.csv"}) {
      fs::copy_file(shippedScenario(name), folder_ / name);
    }
    links_ = folder_ / "links.yaml";
    quick_ = folder_ / "quick.yaml";
  }

  /// Expects that arguments are refused with a message, and change no file.
  void expectRefused(const Arguments& arguments, const std::string& message) {
    const std::vector<std::string> files = folder_.files();
    const std::string links = readFile(links_), quick = readFile(quick_),
                      drone = readFile(folder_ / "data/drone.csv");
    EXPECT_THAT(errorOfRun(arguments, kUsage), HasSubstr("emscape: error: " + message));
    EXPECT_EQ(folder_.files(), files);
    EXPECT_EQ(readFile(links_), links);
    EXPECT_EQ(readFile(quick_), quick);
    EXPECT_EQ(readFile(folder_ / "data/drone.csv"), drone);
  }

  TemporaryFolder folder_;
  std::string links_, quick_;
};

TEST_F(Outputs, AreNotTheScenarioOrAFileThatItNames) {
  const std::string drone = folder_ / "data/drone.csv";
  expectRefused({"link", links_, "--csv", links_}, "--csv: " + links_ + " is the scenario");
  expectRefused({"link", links_, "--csv", drone}, "--csv: " + drone + " is a file that the scenario names");
  expectRefused({"exposure", links_, "--platform", "drone", "-o", folder_ / "data/../data/drone.csv"},
                "--output: " + (folder_ / "data/../data/drone.csv") + " is a file that the scenario names");
  expectRefused({"render", quick_, "--times", "0", "--save-state", quick_},
                "--save-state: " + quick_ + " is the input");
  expectRefused({"render", links_, "--times", "0", "--save-state", drone},
                "--save-state: " + drone + " is a file that the scenario names");
  fs::create_symlink(links_, folder_ / "same.json");
  expectRefused(
      {"vertical", links_, "--emitter", "search radar", "--azimuth", "30", "-o", folder_ / "same.json"},
      "--output: " + (folder_ / "same.json") + " is the scenario");
  fs::create_symlink(links_, folder_ / "same.png");
  expectRefused({"info", links_, "--plot", folder_ / "same.png"},
                "--plot: " + (folder_ / "same.png") + " is the input");
  const std::string study =
      folder_.write("study.yaml",
                    "schema_version: 1\nscenario: quick.yaml\ntimes: 0\nsweep:\n  emitters.radar.power_w: "
                    "{values: [1, 2]}\nmeasures:\n  - {name: covered, height: \"agl:300\"}\n");
  expectRefused({"study", study, "-o", folder_ / "st", "--slurm", quick_},
                "--slurm: " + quick_ + " is the scenario");
  expectRefused({"study", study, "-o", folder_ / "st", "--slurm", study},
                "--slurm: " + study + " is the study");
}

TEST_F(Outputs, OfStudiesReplaceThoseOfEmscapeAndNoOthers) {
  writeFile(folder_ / "sites.csv", "name,latitude_deg,longitude_deg\na,52,5\nb,52.02,5.02\n");
  const std::string study = folder_.write(
      "study.yaml",
      "schema_version: 1\nscenario: quick.yaml\ntimes: 0\ncell_m: 5000\nsites: {platform: radar site, "
      "candidates: sites.csv, choose: 1}\nmeasures:\n  - {name: covered, height: \"agl:300\"}\n");
  const Arguments command{"study", study, "-o", folder_ / "st", "--jobs", "1"};
  const Arguments scripts{"study", study, "-o", folder_ / "st", "--slurm", folder_ / "job.sh"};
  for (int time = 0; time < 2; ++time) {
    ASSERT_EQ(run(command).status, 0);
    ASSERT_EQ(run(scripts).status, 0);
    fs::remove_all(folder_ / "st/parts");
  }
  const std::string users = "#!/bin/sh\nexec emscape study s.yaml\nx,y\n";
  for (const char* const name : {"st/results.csv", "st/results.nc", "st/sites.geojson", "job.sh"}) {
    const std::string own = readFile(folder_ / name);
    writeFile(folder_ / name, users);
    EXPECT_THAT(errorOfRun(scripts, kUsage),
                AllOf(HasSubstr(folder_ / name), HasSubstr("is a file that emscape did not write")));
    EXPECT_EQ(readFile(folder_ / name), users);
    writeFile(folder_ / name, own);
  }
}

TEST_F(Outputs, AreNotAStepOfASeries) {
  ASSERT_EQ(run({"simulate", quick_, "-o", folder_ / "s", "--format", "vti", "--times", "0:1", "-q"}).status,
            0);
  const std::string step = folder_ / "s/quick_0002.vti";
  for (const char* input : {"s", "s/quick.pvd"}) {
    expectRefused({"render", folder_ / input, "--save-state", step},
                  "--save-state: " + step + " is a file of the input");
  }
  expectRefused({"bench", "render", quick_, "--picture", quick_}, "--picture: " + quick_ + " is the input");
}

TEST_F(Outputs, AreDifferentFiles) {
  const std::string picture = folder_ / "x.png";
  expectRefused({"link", links_, "--csv", picture, "--plot", folder_ / "data/../x.png"},
                "--plot: " + (folder_ / "data/../x.png") + " is also the output of --csv");
  expectRefused({"render", quick_, "-o", picture, "--save-state", picture},
                "--save-state: " + picture + " is also the output of --output");
}

TEST_F(Outputs, SLOW_ReplaceFilesOfEmscapeAndNoOthers) {
  const Arguments commands[] = {
      {"link", links_, "--times", "0", "--csv", folder_ / "x.csv", "--plot", folder_ / "x.svg"},
      {"vertical", links_, "--emitter", "search radar", "--azimuth", "30", "--grid", "20,20", "-o",
       folder_ / "x.csv", "-o", folder_ / "x.json"},
      {"terrain", folder_ / "data/jacksboro.tif", "-o", folder_ / "x.png"}};
  const auto kinds = {"x.csv", "x.png", "x.svg", "x.json"};
  for (const Arguments& command : commands) {
    for (const char* const kind : kinds) fs::remove(folder_ / kind);
    ASSERT_EQ(run(command).status, 0) << command[0];
    EXPECT_EQ(run(command).status, 0) << command[0] << " replaces its own";
    for (const char* const kind : kinds) {
      if (!fs::exists(folder_ / kind)) continue;
      const std::string own = readFile(folder_ / kind);
      writeFile(folder_ / kind, "name,latitude_deg,longitude_deg\nsite 1,36.5,-84.2\n");
      EXPECT_THAT(
          errorOfRun(command, kUsage),
          AllOf(HasSubstr(folder_ / kind),
                HasSubstr("is a file that emscape did not write, or has no record of having written")));
      EXPECT_EQ(readFile(folder_ / kind), "name,latitude_deg,longitude_deg\nsite 1,36.5,-84.2\n");
      writeFile(folder_ / kind, own);
    }
  }
  writeFile(folder_ / "x.png", "");
  EXPECT_EQ(run(commands[2]).status, 0) << "an empty file, as of mktemp";
}

TEST_F(Outputs, ThatOnlyNameEmscapeAreNotItsOwn) {
  const std::string png = "\x89PNG\r\n\x1a\n\0\0\0\x1btEXtTitle\0computed with Emscape"s;
  const Arguments study{"study",
                        folder_.write("study.yaml",
                                      "schema_version: 1\nscenario: quick.yaml\ntimes: "
                                      "0\nsweep:\n  emitters.radar.power_w: {values: "
                                      "[1, 2]}\nmeasures:\n  - {name: covered, "
                                      "height: \"agl:300\"}\n"),
                        "-o", folder_ / "st"};
  const auto withScript = [&](const std::string& name) {
    Arguments arguments = study;
    arguments.insert(arguments.end(), {"--slurm", folder_ / name});
    return arguments;
  };
  const auto exposure = [&](const std::string& name) {
    return Arguments{"exposure", links_, "--platform", "drone", "--times", "0", "-o", folder_ / name};
  };
  const std::tuple<std::string, std::string, Arguments> cases[] = {
      {"x.png", png, {"terrain", folder_ / "data/jacksboro.tif", "-o", folder_ / "x.png"}},
      {"mine.yaml",
       readFile(quick_) + "# emscape\n",
       {"render", quick_, "--times", "0", "--save-state", folder_ / "mine.yaml"}},
      {"job.sh", "#!/bin/bash\n#SBATCH --job-name=emscape-thesis\nemscape study s.yaml\n",
       withScript("job.sh")},
      {"notes.md", "How I ran emscape\n", withScript("notes.md")},
      {"x.csv", "variant,name,conversion\nA,red button,3\n", exposure("x.csv")},
      {"x.json", R"({"emscape":"settings of another tool"})", exposure("x.json")},
      {"x.svg", "<svg><title>values of Emscape</title></svg>", exposure("x.svg")}};
  for (const auto& [name, content, arguments] : cases) {
    writeFile(folder_ / name, content);
    EXPECT_THAT(errorOfRun(arguments, kUsage), HasSubstr("is a file that emscape did not write")) << name;
    EXPECT_EQ(readFile(folder_ / name), content) << name;
  }
  for (const char* const own : {"own.csv", "own.json", "own"}) {
    EXPECT_EQ(run(withScript(own)).status, 0) << own;
    EXPECT_EQ(run(withScript(own)).status, 0) << own << " again";
  }
}

TEST_F(Outputs, OfImportAndExportAreNotTheirInputs) {
  ASSERT_EQ(run({"export", links_, "-o", folder_ / "r.acmi", "-q"}).status, 0);
  const std::string recording = readFile(folder_ / "r.acmi");
  const Arguments import{"import", folder_ / "r.acmi", "--base", quick_, "--force", "-o"};
  const auto into = [&](const std::string& file) {
    Arguments arguments = import;
    arguments.push_back(file);
    return arguments;
  };
  expectRefused(into(folder_ / "r.acmi"), "--output: " + (folder_ / "r.acmi") + " is the recording");
  expectRefused(into(quick_), "--output: " + quick_ + " is the base");
  EXPECT_EQ(readFile(folder_ / "r.acmi"), recording);
  fs::create_symlink(folder_ / "data/drone.csv", folder_ / "o.czml");
  expectRefused({"export", links_, "-o", folder_ / "o.czml", "--force"},
                "--output: " + (folder_ / "o.czml") + " is a file that the scenario names");
}

TEST_F(Outputs, WithoutAFolderAreToldBeforeTheWork) {
  for (const Arguments& arguments :
       {Arguments{"exposure", links_, "--platform", "drone", "-o", folder_ / "none/x.csv"},
        Arguments{"vertical", links_, "--emitter", "search radar", "--azimuth", "30", "-o",
                  folder_ / "none/x.csv"},
        Arguments{"link", links_, "--csv", folder_ / "none/x.csv"}}) {
    EXPECT_THAT(errorOfRun(arguments, kOther),
                AllOf(HasSubstr("cannot write: the folder " + (folder_ / "none") + " does not exist"),
                      Not(HasSubstr("running on"))))
        << "before the work";
  }
}

TEST_F(Outputs, SLOW_ReplaceVolumesAndStatesOfEmscape) {
  for (const char* const volume : {"d.vdb", "d.nvdb", "d.vti", "d.raw"}) {
    const Arguments command{"compare",  quick_,          "--set-b",  "emitters.transmitter.power_w=5",
                            "-o",       folder_ / "out", "--cell",   "4000",
                            "--format", "png",           "--volume", folder_ / volume,
                            "-q"};
    EXPECT_EQ(run(command).status, 0) << volume;
    EXPECT_EQ(run(command).status, 0) << volume << " replaces its own";
  }
  const std::string study = folder_.write("spec.json", R"({"schema_version": 1, "scenario": "x.yaml"})");
  errorOfRun({"vertical", links_, "--emitter", "search radar", "--azimuth", "30", "-o", study}, kUsage);
  const std::string state = folder_ / "a.view.json";
  const Arguments command{"render", quick_, "--save-state", state, "-o", folder_ / "x.png", "-q"};
  EXPECT_EQ(run(command).status, 0);
  EXPECT_EQ(run(command).status, 0) << "replaces its own";
}

TEST_F(Outputs, OfCoverageDoNotReplaceAUsersFile) {
  folder_.write("study.json", "{\"schema_version\": 1}");
  expectRefused({"coverage", quick_, "-o", folder_.path().string()},
                "--output: " + (folder_ / "study.json") + " is a file that emscape did not write");
  const Arguments again{"coverage", quick_, "-o", folder_ / "maps", "--cell", "2000",
                        "--format", "png",  "-q"};
  EXPECT_EQ(run(again).status, 0);
  runWell(again);
}

TEST_F(Outputs, OfCoverageAndCompareDoNotReplaceAnElevationFile) {
  fs::create_directory(folder_ / "maps");
  const auto withElevations = [&](const std::string& name) {
    std::string text = readFile(shippedScenario("links.yaml"));
    const std::string shipped = "data/jacksboro.tif";
    text.replace(text.find(shipped), shipped.size(), name);
    writeFile(links_, text);
  };
  const Arguments coverage{"coverage", links_, "-o", folder_.path().string(), "--cell", "2000", "-q"};
  Arguments compare = coverage;
  compare[0] = "compare";
  compare.insert(compare.end(), {"--set-b", "step_s=1"});
  const std::string map = "maps/value_agl150m_t0s.tif";
  fs::copy_file(folder_ / "data/jacksboro.tif", folder_ / map);
  fs::create_symlink(folder_ / map, folder_ / "data/same.tif");
  for (const std::string& name : {map, std::string("data/same.tif")}) {
    withElevations(name);
    EXPECT_THAT(errorOfRun(coverage, kUsage), HasSubstr(map + ": is a file that emscape did not write"));
    runWell(compare);  // has maps of other names
  }
  EXPECT_TRUE(readFile(folder_ / map) == readFile(folder_ / "data/jacksboro.tif"));
  fs::rename(folder_ / map, folder_ / "maps/country.tif");  // a product is named "count"
  withElevations("maps/country.tif");
  runWell(coverage);
  EXPECT_TRUE(readFile(folder_ / "maps/country.tif") == readFile(folder_ / "data/jacksboro.tif"));
}

TEST_F(Outputs, OfASeriesDoNotReplaceAFileOfTheScenario) {
  const std::string scenario = readFile(quick_);
  const std::string site = "position: {latitude_deg: 52.05, longitude_deg: 5.06, height_agl_m: 50}";
  for (const char* name : {"quick.pvd", "quick_0001.nvdb.json"}) {
    std::string moving = scenario;
    moving.replace(moving.find(site), site.size(), "track: {file: " + std::string(name) + "}");
    const std::string file = folder_.write("o/moving.yaml", moving);
    const std::string track =
        folder_.write(std::string("o/") + name,
                      "t_s,latitude_deg,longitude_deg,height_agl_m\n0,52.05,5.06,50\n4,52.06,5.06,50\n");
    const std::string points = readFile(track);
    for (const char* option : {"--force", "-q"}) {
      expectRefused({"simulate", file, "-o", folder_ / "o", "--format", "vti,nvdb", "--times", "0", option},
                    track + ": is a file of the scenario, and has the name of a file of the series");
      EXPECT_EQ(readFile(track), points);
    }
  }
  runWell({"simulate", quick_, "-o", folder_.path().string(), "--times", "0", "-q"});
}

TEST_F(Outputs, BeyondTheLimitOfAFilesSizeAreAnErrorWithoutRemains) {
  const std::vector<std::string> files = folder_.files();
  EXPECT_THAT(
      errorOfRun({"render", quick_, "--times", "0", "-o", folder_ / "x.png", "-q"}, kOther, "ulimit -f 20;"),
      HasSubstr("x.png: cannot write: File too large"));
  EXPECT_EQ(folder_.files(), files);
}

TEST_F(Outputs, OfMorePixelsThanTheMemoryHoldsAreRefusedAtOnce) {
  if (kIsSanitized) GTEST_SKIP() << "the sanitizers reserve more address space than the limit";
  const ProgramResult result =
      run({"render", quick_, "--times", "0", "-o", folder_ / "x.png", "--size", "20000x20000"},
          "ulimit -v 3000000;");
  EXPECT_EQ(result.status, kOther);
  EXPECT_THAT(result.err,
              HasSubstr("a picture of 20000x20000 pixels needs up to 17166 MiB of the host's memory"));
  EXPECT_THAT(result.err, HasSubstr("a smaller --size takes less"));
}

TEST_F(Outputs, AreCompleteAtProcessorTimeLimit) {
  const ProgramResult result =
      run({"simulate", longScenario(folder_, 100000), "-o", folder_ / "s"}, "ulimit -S -t 1;");
  EXPECT_EQ(result.status, 128 + SIGXCPU);
  EXPECT_THAT(result.err, HasSubstr("stopped by signal 24; finished files are kept"));
  EXPECT_THAT(folder_.files(), Not(Contains(HasSubstr(".part-"))));
}

TEST_F(Outputs, ReplaceAForeignSeriesAsAWhole) {
  const auto simulate = [&](const std::string& scenario, const std::string& times) {
    runWell({"simulate", scenario, "-o", folder_ / "s", "--times", times, "--set", "region.dims=[8, 8, 2]",
             "--force", "-q"});
  };
  simulate(links_, "0:1");
  simulate(quick_, "0:2");
  EXPECT_THAT(run({"info", folder_ / "s"}).out, HasSubstr("steps: 3\n"));
  EXPECT_THAT(folder_.files(), Not(Contains(HasSubstr("s/links"))));
}

TEST(Inputs, ThatArePipesAreRefused) {
  const TemporaryFolder folder;
  for (const char* name : {"f", "f.dat", "f.vti", "f.tif", "f.yaml", "f.csv"}) {
    const std::string pipe = folder / name;
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const ProgramResult info = run({"info", pipe});
    EXPECT_EQ(info.status, kBadInput);
    EXPECT_EQ(info.err, "emscape: error: " + pipe + ": cannot read: it is not a regular file\n");
  }
  for (const char* name : {"f.dat", "f.vti", "f.yaml"}) {
    EXPECT_THAT(errorOfRun({"render", folder / name, "-o", folder / "x.png", "-q"}, kBadInput),
                HasSubstr("cannot read: it is not a regular file\n"));
  }
}

TEST(Results, SLOW_OfAFieldWithoutAnyValueAreToldWithTheirLikelyCause) {
  const TemporaryFolder folder;
  const auto warningsOf = [&](const std::string& edit, const Arguments& more) {
    Arguments arguments{"simulate", quick(),      "--times", "0:2:1", "--force",
                        "-o",       folder / "s", "--set",   edit};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult simulated = runWell(arguments);
    arguments = {"render", quick(), "--times", "0", "--size", "64x48", "-o", folder / "a.png", "--set", edit};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult drawn = run(arguments);
    EXPECT_THAT(drawn.err, HasSubstr("power_density_dbwm2: no voxel is above the floor at 0 s: "));
    return simulated.err;
  };
  EXPECT_THAT(
      warningsOf("region.origin={latitude_deg: 5, longitude_deg: 52}", {}),
      HasSubstr("power_density_dbwm2: no voxel is above the floor at any of the times: the nearest emitter, "
                "'transmitter', is "));
  EXPECT_THAT(warningsOf("region.origin={latitude_deg: 5, longitude_deg: 52}", {}),
              HasSubstr("with the origin's latitude and longitude exchanged it would be inside"));
  EXPECT_THAT(
      warningsOf("emitters.transmitter.active_s=[[100, 200]]", {"--set", "emitters.radar.active_s=[[3, 4]]"}),
      HasSubstr("no emitter transmits then (active_s, enabled)"));
}

TEST(Results, PicturesOfAnEarlierRunAreNamedAndKept) {
  const TemporaryFolder folder;
  const Arguments draw{"render", quick(), "--size", "64x48", "-o", folder / "f", "--times"};
  const auto with = [&](const std::string& times) {
    Arguments arguments = draw;
    arguments.push_back(times);
    return run(arguments);
  };
  EXPECT_THAT(with("0:3:1").err, Not(HasSubstr("earlier run")));
  std::filesystem::rename(folder / "f/quick_0004.png", folder / "f/quick_0007.png");
  folder.write("f/quick_0009.png.bak", "of the user");
  const ProgramResult again = with("0:1:1");
  EXPECT_EQ(again.status, 0);
  EXPECT_THAT(again.err,
              HasSubstr("quick_0003.png and 1 more are of an earlier run: this one wrote 2 pictures"));
  EXPECT_EQ(folder.files().size(), 5u);
}

TEST(Results, OfTallMapsHaveAPictureThatCanBeDrawn) {
  const TemporaryFolder folder;
  const ProgramResult result =
      runWell({"coverage", quick(), "-o", folder / "o", "--area", "bbox:3,-85,7,85", "--cell", "100000",
               "--products", "value", "--times", "0", "--format", "cog"});
}

TEST(Results, OfPlotsBeyondTheMemoryAreRefusedBeforeTheWork) {
  if (kIsSanitized) GTEST_SKIP() << "the sanitizers reserve more address space than the limit";
  const TemporaryFolder folder;
  EXPECT_THAT(errorOfRun({"profile", quick(), "--emitter", "radar", "--to", "52.05,5.05,100", "--plot",
                          folder / "a.png", "--size", "32767x32767"},
                         1, "ulimit -v 4000000;"),
              HasSubstr("a picture of 32767x32767 pixels needs up to"));
}

// Pango and OpenVDB's log end a program of which they cannot start a thread, oneTBB one of its processes.
TEST(Limits, SLOW_FiveThreadsAreEnoughAndFewerAreAnErrorThatNamesTheLimit) {
  const TemporaryFolder folder;
  fs::permissions(folder.path(), fs::perms::all);
  const std::string program = besideThisProgram("emscape"),
                    as_another = "setpriv --reuid 65534 --regid 65534 --clear-groups prlimit --nproc=";
  if (std::system((as_another + "3 test -x " + program + " -a -r " + quick() + " 2>/dev/null").c_str()) != 0)
    GTEST_SKIP() << "needs setpriv, prlimit, the rights of root, and a program that each user may run";
  int number = 0;
  for (const std::string words : {"coverage --cell 4000 --format png", "simulate --times 0"}) {
    for (const int processes : {3, 4, 5, 6, 8}) {
      const std::string out = folder / std::to_string(++number);
      const std::string command = as_another + std::to_string(processes) + " " + program + " " + words + " " +
                                  quick() + " -o " + out + " >/dev/null 2>" + (folder / "err");
      const int status = std::system(command.c_str());
      ASSERT_TRUE(WIFEXITED(status)) << command;
      EXPECT_EQ(WEXITSTATUS(status), processes < 5 ? kOther : 0) << command << readFile(folder / "err");
      if (status == 0) continue;
      EXPECT_THAT(readFile(folder / "err"), HasSubstr("ulimit -u"));
      EXPECT_THAT(folder.files(), Not(Contains(HasSubstr(std::to_string(number) + "/")))) << command;
    }
  }
}

TEST(Limits, ALibraryThatTheMemoryDoesNotHoldIsAnErrorThatNamesTheLimit) {
  if (kIsSanitized) GTEST_SKIP() << "the sanitizers reserve more address space than the limit";
  const TemporaryFolder folder;
  EXPECT_THAT(
      errorOfRun({"coverage", quick(), "-o", folder / "o", "--cell", "1000"}, kOther, "ulimit -v 110000;"),
      testing::AllOf(HasSubstr("the library GDAL needs up to"), HasSubstr("ulimit -v"),
                     Not(HasSubstr("install"))));
}

TEST(Limits, AWindowWithinTooLittleMemoryIsAnErrorThatNamesTheLimit) {
  if (kIsSanitized) GTEST_SKIP() << "the sanitizers reserve more address space than the limit";
  if (!fs::exists(besideThisProgram("emscape-view"))) GTEST_SKIP() << "built without the window";
  EXPECT_THAT(errorOfRun({"view", quick()}, kOther, "ulimit -v 450000;"),
              testing::AllOf(HasSubstr("a window"), HasSubstr("ulimit -v")));
}

// Each thread had address space of its own for malloc(): between 330 and 470 MB libraries ended the program,
// as did those below GDAL at 200 MB.
TEST(Limits, SLOW_EachLimitOnMemoryGivesTheResultOrOneMessageThatNamesIt) {
  if (kIsSanitized) GTEST_SKIP() << "the sanitizers reserve more address space than the limit";
  const TemporaryFolder folder;
  for (const Arguments& command : {Arguments{"simulate", quick(), "--times", "0", "-q", "-o", folder / "s"},
                                   Arguments{"profile", quick(), "--emitter", "radar", "--to",
                                             "52.05,5.05,100", "-q", "--plot", folder / "p.png"}}) {
    for (int limit = 180000; limit < 480000; limit += 20000) {
      const ProgramResult result = run(command, "ulimit -v " + std::to_string(limit) + ";");
      fs::remove_all(folder / "s");
      if (result.status == 0) continue;
      EXPECT_EQ(result.status, kOther) << command[0] << " within " << limit << " KiB: " << result.err;
      EXPECT_THAT(result.err, HasSubstr("memory")) << command[0] << " within " << limit << " KiB";
    }
  }
}

TEST_F(Outputs, ThatReplaceAPrivateSeriesArePrivate) {
  const std::string out = folder_ / "s";
  runWell({"simulate", quick_, "-o", out, "--times", "0:1:1", "-q"}, "umask 077;");
  runWell({"simulate", quick_, "-o", out, "--times", "0:1:1", "-q", "--force"}, "umask 022;");
  for (const fs::directory_entry& entry : fs::directory_iterator(out))
    EXPECT_EQ(entry.status().permissions(), fs::perms::owner_read | fs::perms::owner_write) << entry;
  fs::remove_all(out);
  runWell({"simulate", quick_, "-o", out, "--times", "0", "-q", "--force"}, "umask 022;");
  EXPECT_EQ(fs::status(out + "/series.json").permissions() & fs::perms::others_read, fs::perms::others_read);
}

TEST(Texts, ThatNoFontHasAreToldOnce) {
  const TemporaryFolder folder;
  const std::string none = folder.write("fonts.conf", "<fontconfig><dir>/none</dir></fontconfig>");
  const ProgramResult result =
      runWell({"render", quick(), "--times", "0", "-o", folder / "a.png", "--size", "320x240"},
              "export FONTCONFIG_FILE=" + none + ";");
  const std::string warning = "are drawn as empty boxes";
  EXPECT_THAT(result.err, HasSubstr("fonts-dejavu-core"));
  EXPECT_NE(result.err.find(warning), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find(warning), result.err.rfind(warning));
  EXPECT_THAT(runWell({"render", quick(), "--times", "0", "-o", folder / "b.png", "--size", "320x240"}).err,
              Not(HasSubstr(warning)));
}

// fontconfig waits for its configuration without end.
TEST(Signals, SLOW_EndAProgramThatWaitsWithinALibrary) {
  const TemporaryFolder folder;
  const std::string pipe = folder / "fonts.conf";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  RunningProgram program({"render", quick(), "--times", "0", "-o", folder / "a.png"},
                         "export FONTCONFIG_FILE=" + pipe + ";");
  std::this_thread::sleep_for(std::chrono::seconds(3));
  program.signal(SIGTERM);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.status, 128 + SIGTERM);
  EXPECT_THAT(result.err, HasSubstr("stopped by signal 15"));
  EXPECT_FALSE(fs::exists(folder / "a.png"));
}

TEST(Signals, SLOW_LeaveNoUnfinishedFile) {
  const TemporaryFolder folder;
  RunningProgram program({"blockage", shippedScenario("links.yaml"), "--emitter", "mast", "--beamwidth", "2",
                          "--elevation", "0", "--range", "9000", "--step", "2", "-o", folder / "b.nc"});
  const auto hasBegun = [&] {
    for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
      if (entry.path().filename() == "b.nc") return true;
    return false;
  };
  for (int i = 0; i < 3000 && !hasBegun(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait().status, 128 + SIGTERM);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace emscape::test
