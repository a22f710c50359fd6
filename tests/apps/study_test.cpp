// emscape study: processes, parts, interruption, and errors. The figures are tested in tests/study.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"
#include "tests/support/sanitizers.h"
#include "tests/support/without_proc.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const char* const kResults[] = {"results.csv", "results.nc", "report.html"};

/// A study of 40 variants with small maps.
std::string study(const TemporaryFolder& folder, double cell_m = 1000, const std::string& more = "") {
  return folder.write("study.yaml", "schema_version: 1\nscenario: " + shippedScenario("jamming.yaml") +
                                        "\ntimes: 40\ncell_m: " + std::to_string(cell_m) + R"(
sweep:
  emitters.stand-off jammer.power_w: {log: {from: 1, to: 1000, count: 10}}
  platforms.ridge site.position.height_agl_m: {values: [5, 15, 25, 35]}
measures:
  - {name: covered, height: "agl:300"}
  - {name: lost, product: jam_loss, height: "agl:300", unit: percent}
)" + more);
}

/// Runs to the end, and expects success.
void compute(const Arguments& arguments) {
  runWell(arguments);
}

void expectSameResults(const TemporaryFolder& folder, const std::string& a, const std::string& b) {
  for (const std::string file : kResults) {
    EXPECT_TRUE(readFile(folder / (a + "/" + file)) == readFile(folder / (b + "/" + file)))
        << b << "/" << file;
    EXPECT_FALSE(readFile(folder / (a + "/" + file)).empty()) << file;
  }
}

TEST(Study, SLOW_ProcessesAndPartsGiveTheBytesOfOneProcess) {
  const TemporaryFolder folder;
  const std::string file = study(folder);
  compute({"study", file, "-o", folder / "one"});
  compute({"study", file, "-o", folder / "two", "--jobs", "2"});
  for (const char* part : {"3/5", "1/5", "5/5", "2/5"}) {
    compute({"study", file, "-o", folder / "parts", "--part", part, "--quiet"});
  }
  EXPECT_THAT(errorOfRun({"study", file, "-o", folder / "parts", "--merge"}, 3),
              AllOf(HasSubstr("1 of 5 parts are missing: 4"), HasSubstr("--resume")));
  compute({"study", file, "-o", folder / "parts", "--merge", "--partial"});
  EXPECT_NE(readFile(folder / "parts/results.csv"), readFile(folder / "one/results.csv"));
  compute({"study", file, "-o", folder / "parts", "--part", "4/5"});
  compute({"study", file, "-o", folder / "parts", "--part", "4/5"});
  compute({"study", file, "-o", folder / "parts", "--merge"});
  expectSameResults(folder, "one", "two");
  expectSameResults(folder, "one", "parts");
}

TEST(Study, SLOW_ResumedStudyComputesMissingVariants) {
  const TemporaryFolder folder;
  const std::string file = study(folder);
  compute({"study", file, "-o", folder / "whole"});
  compute({"study", file, "-o", folder / "out"});
  EXPECT_THAT(errorOfRun({"study", file, "-o", folder / "out"}, 2),
              HasSubstr("holds 8 of 8 parts of this study; --merge writes"));
  const auto kept = std::filesystem::last_write_time(folder / "out/parts/part_00001.csv");
  std::filesystem::remove(folder / "out/parts/part_00004.json");
  std::filesystem::remove(folder / "out/parts/part_00007.csv");
  std::filesystem::remove(folder / "out/parts/part_00007.json");
  compute({"study", file, "-o", folder / "out", "--resume", "--jobs", "2"});
  EXPECT_EQ(std::filesystem::last_write_time(folder / "out/parts/part_00001.csv"), kept);
  expectSameResults(folder, "whole", "out");

  EXPECT_THAT(
      errorOfRun(
          {"study", file, "-o", folder / "out", "--resume", "--set", "emitters.search radar.power_w=3"}, 3),
      HasSubstr("belongs to another study"));
}

/// Processes whose parent is one of ours.
std::vector<pid_t> childrenOf(pid_t parent) {
  std::vector<pid_t> children;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream stat(entry.path() / "stat");
    std::string text;
    std::getline(stat, text);
    const std::size_t end = text.rfind(')');
    if (end == std::string::npos) continue;
    if (std::atoi(text.c_str() + end + 4) == parent) children.push_back(std::atoi(name.c_str()));
  }
  return children;
}

TEST(Study, SLOW_KilledProcessIsReplacedWithoutLoss) {
  const TemporaryFolder folder;
  const std::string file = study(folder, 150);
  compute({"study", file, "-o", folder / "whole"});
  RunningProgram running({"study", file, "-o", folder / "out", "--jobs", "2"});
  int killed = 0;
  for (int wait = 0; wait < 600 && killed < 2; ++wait) {
    usleep(10000);
    for (const pid_t program : childrenOf(getpid())) {
      const std::vector<pid_t> workers = childrenOf(program);
      if (workers.size() != 2) continue;
      usleep(50000);
      kill(workers[static_cast<std::size_t>(killed) % 2], SIGKILL);
      ++killed;
      break;
    }
  }
  const ProgramResult result = running.wait();
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_GE(killed, 1);
  EXPECT_THAT(result.err, HasSubstr("was ended by signal 9; another one goes on with it"));
  expectSameResults(folder, "whole", "out");
}

TEST(Study, ASignalIsReportedOnceForAllProcesses) {
  const TemporaryFolder folder;
  RunningProgram running({"study", study(folder, 50), "-o", folder / "out", "--jobs", "2"});
  pid_t program = 0;
  for (int wait = 0; wait < 600 && program == 0; ++wait) {
    usleep(10000);
    for (const pid_t child : childrenOf(getpid())) {
      if (childrenOf(child).size() == 2) program = child;
    }
  }
  ASSERT_NE(program, 0);
  usleep(300000);
  running.signal(SIGINT);
  const ProgramResult result = running.wait();
  EXPECT_EQ(result.status, 128 + SIGINT);
  EXPECT_EQ(result.err.find("stopped by signal"), result.err.find("stopped by signal 2; finished files"))
      << result.err;
  EXPECT_EQ(result.err.find("stopped by signal"), result.err.rfind("stopped by signal")) << result.err;
}

/// As schedulers and terminals do: the parent then ends its processes, which have had the signal, too.
TEST(Study, SLOW_ASignalToTheWholeGroupLeavesNothingUnfinished) {
  const TemporaryFolder folder;
  const std::string file = study(folder, 60);
  for (int trial = 0; trial < 20; ++trial) {
    const std::string out = folder / ("out" + std::to_string(trial));
    RunningProgram running({"study", file, "-o", out, "--jobs", "2", "--keep", "maps"});
    pid_t program = 0;
    for (int wait = 0; wait < 600 && program == 0; ++wait) {
      usleep(10000);
      for (const pid_t child : childrenOf(getpid())) {
        if (childrenOf(child).size() == 2) program = child;
      }
    }
    ASSERT_NE(program, 0);
    while (!std::filesystem::exists(out + "/variants")) usleep(1000);
    usleep(static_cast<useconds_t>(50000 + 17000 * trial));
    const int signal = trial % 2 == 0 ? SIGTERM : SIGINT;
    for (const pid_t worker : childrenOf(program)) kill(worker, signal);
    running.signal(signal);
    EXPECT_EQ(running.wait().status, 128 + signal) << trial;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(out))
      EXPECT_EQ(entry.path().string().find(".part-"), std::string::npos) << entry.path();
  }
}

/// Number of times that each variant is in the journals of a folder.
std::map<int, int> variantsInJournals(const std::filesystem::path& parts) {
  std::map<int, int> counts;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(parts, ignored)) {
    if (entry.path().extension() != ".rows") continue;
    const std::string text = readFile(entry.path());
    static const std::string kRow = "{\"row\":\"";
    for (std::size_t at = text.find(kRow); at != std::string::npos; at = text.find(kRow, at + 1)) {
      ++counts[std::atoi(text.c_str() + at + kRow.size())];
    }
  }
  return counts;
}

TEST(Study, SLOW_AStudyWhoseProcessesAreKilledComputesNoFinishedVariantAgain) {
  const TemporaryFolder folder;
  const std::string file = study(folder, 150);
  compute({"study", file, "-o", folder / "whole"});
  RunningProgram running({"study", file, "-o", folder / "out", "--jobs", "2"});
  std::map<int, int> seen;
  std::size_t seen_at_kill = 0;
  // A part that ends its process five times before it finishes a variant would end the study.
  constexpr int kKills = 4;
  int killed = 0;
  for (int wait = 0; wait < 6000 && !std::filesystem::exists(folder / "out/results.csv"); ++wait) {
    usleep(5000);
    for (const auto& [variant, count] : variantsInJournals(folder / "out/parts")) {
      seen[variant] = std::max(seen[variant], count);
    }
    if (killed == kKills || seen.size() == seen_at_kill) continue;
    for (const pid_t program : childrenOf(getpid())) {
      const std::vector<pid_t> workers = childrenOf(program);
      if (workers.size() != 2) continue;
      kill(workers[static_cast<std::size_t>(killed) % 2], SIGKILL);
      ++killed;
      seen_at_kill = seen.size();
    }
  }
  const ProgramResult result = running.wait();
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_GE(killed, 2);
  for (const auto& [variant, count] : seen) EXPECT_EQ(count, 1) << "variant " << variant;
  expectSameResults(folder, "whole", "out");
}

TEST(Study, KeepsVolumesOfEachVariant) {
  const TemporaryFolder folder;
  const std::string file = study(folder, 1000);
  const Arguments once{"study",   file,     "-o",   folder / "out", "--keep",
                       "volumes", "--part", "1/40", "--set",        "region.dims=[20, 20, 10]"};
  compute(once);
  const std::vector<std::string> files = folder.files();
  EXPECT_EQ(std::count_if(files.begin(), files.end(),
                          [](const std::string& name) {
                            return name.find("out/variants/") == 0 &&
                                   name.find("/field_t40s.vdb") != std::string::npos;
                          }),
            1);
  EXPECT_THAT(errorOfRun({"study", file, "-o", folder / "out", "--keep", "maps", "--part", "2/40", "--set",
                          "region.dims=[20, 20, 10]"},
                         3),
              HasSubstr("keeps volumes of each variant, not maps"));
}

TEST(Study, SLOW_AFullDiskEndsTheStudyAndItCanBeResumed) {
  const TemporaryFolder folder;
  const std::string file = study(folder);
  compute({"study", file, "-o", folder / "whole"});
  compute({"study", file, "-o", folder / "out", "--part", "1/2"});  // writes the manifest
  for (const char* jobs : {"1", "2"}) {
    EXPECT_THAT(errorOfRun({"study", file, "-o", folder / "out", "--resume", "--jobs", jobs}, 1,
                           "trap '' XFSZ; ulimit -f 1;"),
                HasSubstr("part_00002."));
  }
  for (const std::string& left : folder.files()) EXPECT_THAT(left, testing::Not(HasSubstr(".part-")));
  compute({"study", file, "-o", folder / "out", "--resume"});
  expectSameResults(folder, "whole", "out");
}

TEST(Study, AFileOfTheUserUnderTheNameOfAPartIsNamedBeforeAnyPartIsComputed) {
  const TemporaryFolder folder;
  const std::string mine = folder.write("out/parts/part_00002.csv", "mine\n");
  EXPECT_THAT(errorOfRun({"study", study(folder), "-o", folder / "out"}, 2),
              HasSubstr("part_00002.csv: is a file that emscape did not write"));
  EXPECT_EQ(readFile(mine), "mine\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "out/parts/part_00001.csv"));
}

TEST(Study, PlanListsWork) {
  const TemporaryFolder folder;
  const json plan = json::parse(runWell({"study", study(folder), "--plan", "--json", "--quiet"}).out);
  EXPECT_EQ(plan["variants"], 40);
  EXPECT_EQ(plan["parts"], 8);
  EXPECT_EQ(plan["parameters"][0]["class"], "power");
  EXPECT_EQ(plan["parameters"][1]["class"], "geometry");
  EXPECT_EQ(plan["changes"]["geometry"]["variants"], 4);
  EXPECT_EQ(plan["changes"]["power"]["variants"], 36);
  EXPECT_GT(plan["single_runs_s"], plan["expected_s"]);
  EXPECT_EQ(folder.files(), std::vector<std::string>{"study.yaml"});
}

TEST(Study, ReportsMeasureWithoutAnyValue) {
  const TemporaryFolder folder;
  const std::string file =
      folder.write("study.yaml", "schema_version: 1\nscenario: " + shippedScenario("jamming.yaml") + R"(
times: "40:42:2"
cell_m: 4000
sweep:
  emitters.stand-off jammer.power_w: {values: [1, 10]}
measures:
  - {name: seen again, product: revisit, height: "agl:300"}
)");
  const ProgramResult result = runWell({"study", file, "-o", folder / "out"});
  EXPECT_THAT(result.out, HasSubstr("seen again               no value in any variant\n"));
}

TEST(Study, SLOW_SlurmScriptsRunTheParts) {
  const TemporaryFolder folder;
  compute({"study", study(folder), "-o", folder / "out dir", "--slurm", folder / "job.sh", "--chunks", "5",
           "--time", "00:20:00", "--gpus", "1", "--set", "emitters.search radar.power_w=3000"});
  const std::string script = readFile(folder / "job.sh");
  EXPECT_THAT(script, AllOf(HasSubstr("#SBATCH --array=1-5%20\n"), HasSubstr("--time=00:20:00"),
                            HasSubstr("--gpus-per-task=1"), HasSubstr("'emitters.search radar.power_w=3000'"),
                            HasSubstr("--part \"$SLURM_ARRAY_TASK_ID/5\"")));
  // As Slurm would, without it.
  const std::string program = std::filesystem::path(besideThisProgram("emscape")).parent_path();
  for (int task = 1; task <= 5; ++task) {
    const std::string command = "EMSCAPE_DIR='" + program +
                                "' SLURM_CPUS_PER_TASK=1 SLURM_ARRAY_TASK_ID=" + std::to_string(task) +
                                " sh '" + folder / "job.sh" + "' 2> /dev/null";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
  }
  const std::string merge =
      "EMSCAPE_DIR='" + program + "' sh '" + folder / "job.sh.merge.sh" + "' > /dev/null 2>&1";
  EXPECT_EQ(std::system(merge.c_str()), 0);
  EXPECT_FALSE(readFile(folder / "out dir/results.csv").empty());
}

TEST(Study, RefusesInvalidOptions) {
  const TemporaryFolder folder;
  const std::string file = study(folder);
  const auto errorOf = [&](const Arguments& more, int status) {
    return errorOfRun(joined({"study", file}, more), status);
  };
  EXPECT_THAT(errorOf({}, 2), HasSubstr("--output is required"));
  const std::string out = folder / "out";
  EXPECT_THAT(errorOf({"-o", out, "--part", "0/4"}, 2), HasSubstr("'0/4'"));
  EXPECT_THAT(errorOf({"-o", out, "--part", "5/4"}, 2), HasSubstr("I from 1 to N"));
  EXPECT_THAT(errorOf({"-o", out, "--part", "1/41"}, 2), HasSubstr("41 parts of 40 variants"));
  EXPECT_THAT(errorOf({"-o", out, "--merge"}, 3), HasSubstr("no part was computed"));
  EXPECT_THAT(errorOf({"-o", out, "--partial"}, 2), HasSubstr("--merge"));
  EXPECT_THAT(errorOf({"-o", out, "--part", "some"}, 2), HasSubstr("I/N, with I from 1 to N"));
  EXPECT_THAT(errorOf({"-o", out, "--part", "any", "--jobs", "2"}, 2), HasSubstr("--jobs"));
  EXPECT_THAT(errorOf({"-o", out, "--keep", "pictures"}, 2), HasSubstr("volumes"));
  EXPECT_THAT(errorOf({"-o", out, "--set", "emitters.nobody.power_w=1"}, 3), HasSubstr("nobody"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(Study, SaysThatVariantsAreEqualInsteadOfNamingTheFirstAsTheLargest) {
  const TemporaryFolder folder;
  const auto textOf = [&](const std::string& sweep) {
    const std::string file =
        folder.write("s.yaml", "schema_version: 1\nscenario: " + shippedScenario("jamming.yaml") +
                                   "\ntimes: 40\ncell_m: 4000\nsweep: " + sweep +
                                   "\nmeasures: [{name: covered, height: \"agl:300\"}]\n");
    return run({"study", file, "-o", folder / ("out" + std::to_string(sweep.size()))}).out;
  };
  EXPECT_THAT(textOf("{output.floor: {values: [-120, -121, -122]}}"),
              AllOf(HasSubstr(" km2 in each of 3 variants\n"), Not(HasSubstr("the largest"))));
  EXPECT_THAT(
      textOf(
          "{emitters.stand-off jammer.power_w: {values: [1, 1000]}, output.floor: {values: [-120, -121]}}"),
      HasSubstr(
          "; the largest: emitters.stand-off jammer.power_w=1, output.floor=-120, and the same in 1 more\n"));
}

TEST(Study, DoesNotReplaceFilesOfTheStudy) {
  const TemporaryFolder folder;
  const std::string sites = "WKT,name\n\"POINT (-84.24 36.27)\",a\n\"POINT (-84.2 36.3)\",b\n";
  for (const std::string name : {"results.csv", "sites.csv"}) folder.write(name, sites);
  const auto studyOf = [&](const std::string& candidates) {
    return folder.write(
        "s.yaml", "schema_version: 1\nscenario: " + shippedScenario("jamming.yaml") +
                      "\ntimes: 40\ncell_m: 1000\nsites: {platform: ridge site, candidates: " + candidates +
                      "}\nmeasures: [{name: covered, height: \"agl:300\"}]\n");
  };
  const auto refused = [&](const Arguments& arguments) { return errorOfRun(arguments, 2); };
  EXPECT_THAT(refused({"study", studyOf("results.csv"), "-o", folder.path()}),
              HasSubstr("results.csv is a file that the study names"));
  const std::string file = studyOf("sites.csv");
  for (const std::string& script : {folder / "sites.csv", folder / "out/results.csv"}) {
    EXPECT_THAT(refused({"study", file, "-o", folder / "out", "--slurm", script}),
                AllOf(HasSubstr("--slurm: "), HasSubstr("is ")));
  }
  EXPECT_THAT(refused({"study", file, "-o", folder / "new", "--slurm", folder / "job.sh", "--time", "nan"}),
              HasSubstr("'nan' is not a time limit"));
  EXPECT_FALSE(std::filesystem::exists(folder / "new"));
  folder.write("out/report.html", "<html>another program's</html>");
  EXPECT_THAT(refused({"study", file, "-o", folder / "out"}),
              HasSubstr("report.html is a file that emscape did not write"));
  EXPECT_EQ(readFile(folder / "results.csv"), sites);
  EXPECT_EQ(readFile(folder / "sites.csv"), sites);
  EXPECT_EQ(readFile(folder / "out/report.html"), "<html>another program's</html>");
  EXPECT_FALSE(std::filesystem::exists(folder / "out/manifest.json"));
  std::filesystem::remove(folder / "out/report.html");
  compute({"study", file, "-o", folder / "out"});
  compute({"study", file, "-o", folder / "out", "--merge"});
}

TEST(StudyWithoutProc, NamesARemedy) {
  if (kIsSanitized) GTEST_SKIP() << "the sanitizers need /proc";
  const TemporaryFolder folder;
  const std::string program =
      besideThisProgram("emscape") + " study " + study(folder) + " -q -o " + (folder / "out");
  const std::string many = withoutProc(program + " --jobs 2");
  if (many.empty()) GTEST_SKIP() << "/proc cannot be hidden";
  EXPECT_EQ(WEXITSTATUS(std::system((many + " 2>" + (folder / "err")).c_str())), 1);
  EXPECT_THAT(readFile(folder / "err"), HasSubstr("--jobs 1 needs no /proc"));
  EXPECT_EQ(std::system((withoutProc(program + " --jobs 1 --resume") + " >/dev/null").c_str()), 0);
}

}  // namespace
}  // namespace emscape::test
