// Common behaviour of all subcommands: usage, exit status, standard output.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

constexpr int kUsage = 2, kBadInput = 3, kDevice = 4;

int lines(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

TEST(CommandLine, HelpAndVersionAreNoErrors) {
  for (const char* subcommand : {"validate", "info", "simulate", "render", "check", "bench"}) {
    const ProgramResult help = run({subcommand, "--help"});
    EXPECT_EQ(help.status, 0) << subcommand;
    EXPECT_THAT(help.out, HasSubstr("Usage: emscape")) << subcommand;
  }
  EXPECT_THAT(run({"--help"}).out, HasSubstr("Exit status"));
  EXPECT_THAT(run({"--version"}).out, StartsWith("emscape "));
}

TEST(CommandLine, NumbersAreFinite) {
  for (const std::string number : {"nan", "inf", "-inf"}) {
    EXPECT_THAT(errorOfRun({"vertical", shippedScenario("jacksboro.yaml"), "--emitter", "search radar",
                            "--azimuth", "30", "-o", "out.png", "--threshold", number},
                           kUsage),
                HasSubstr("--threshold: '" + number + "' is not a number"));
  }
}

TEST(CommandLine, LeadingZerosOfWholeNumbersAreIgnored) {
  for (const std::string frames : {"010", "008"}) {
    const ProgramResult result = runWell({"bench", "render", shippedScenario("quick.yaml"), "--size", "16x16",
                                          "--frames", frames, "--json", "--quiet"});
    EXPECT_EQ(json::parse(result.out)["frames"], std::stoi(frames));
  }
}

TEST(CommandLine, WholeNumbersAreDecimal) {
  for (const std::string frames : {"0x10", "-0X1"}) {
    EXPECT_THAT(errorOfRun({"bench", "render", shippedScenario("quick.yaml"), "--frames", frames}, kUsage),
                HasSubstr("--frames: '" + frames + "' is not a decimal number\n"));
  }
}

TEST(CommandLine, UnexpectedWordsAreNamedInTheirOrder) {
  EXPECT_THAT(run({"render", "--", "a", "b"}).err, StartsWith("emscape: error: unexpected argument 'b'\n"));
  EXPECT_THAT(run({"validate", "x.yaml", "a", "b c"}).err,
              StartsWith("emscape: error: unexpected arguments 'a', 'b c'\n"));
  EXPECT_THAT(run({"info", "x.yaml", "--set", "a=1"}).err,
              StartsWith("emscape: error: unexpected arguments '--set', 'a=1'\n"));
}

TEST(CommandLine, RefusedValuesAreReportedWithAllowedOnes) {
  const auto errorOf = [](const Arguments& more) {
    return errorOfRun(joined({"render", shippedScenario("quick.yaml"), "-o", "out.png"}, more), kUsage);
  };
  EXPECT_THAT(errorOf({"--step", "0"}),
              StartsWith("emscape: error: --step: '0' must be a number from 0.05 to 10\n"));
  EXPECT_THAT(errorOf({"--step", "one"}), HasSubstr("--step: 'one' must be a number from 0.05 to 10\n"));
  EXPECT_THAT(errorOf({"--terrain", "maybe"}), HasSubstr("--terrain: 'maybe' must be on or off\n"));
  EXPECT_THAT(errorOf({"--emitters", "3"}), HasSubstr("--emitters: '3' must be on or off\n"));
  EXPECT_THAT(errorOf({"--exact=no"}), HasSubstr("--exact: takes no value, not 'no'\n"));
  EXPECT_THAT(errorOf({"--scenario", "x.yaml"}), HasSubstr("--scenario has an effect on volumes only\n"));
  EXPECT_THAT(errorOf({"--iso-value", "one"}), HasSubstr("--iso-value: 'one' is not a number\n"));
  EXPECT_THAT(errorOf({"--mode", "xray"}), HasSubstr("--mode: 'xray' must be one of dvr, mida, mip, iso\n"));
  EXPECT_THAT(errorOf({"--mode", std::string(100000, 'x')}),
              HasSubstr("' must be one of dvr, mida, mip, iso\n"));
  EXPECT_THAT(errorOf({"--step", std::string(100000, 'x')}),
              HasSubstr("' must be a number from 0.05 to 10\n"));
  EXPECT_THAT(errorOf({"--threads", "-3"}),
              HasSubstr("--threads: '-3' must be a whole number from 0 to 4096\n"));
}

/// Exit status of `emscape ARGUMENTS` with its streams redirected by the shell.
int statusOf(const std::string& arguments_and_redirections) {
  const std::string command = besideThisProgram("emscape") + " " + arguments_and_redirections;
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(CommandLine, AVeryLongFileNameGivesAReadableError) {
  const ProgramResult result = run({"info", std::string(5000, 'a') + "_2x2x2_uint8.raw"});
  EXPECT_EQ(result.status, kBadInput);
  EXPECT_THAT(result.err, HasSubstr(": cannot read: File name too long"));
  EXPECT_THAT(result.err, ::testing::Not(HasSubstr("filesystem error")));
  EXPECT_LT(result.err.size(), 1000u);
}

TEST(CommandLine, AnInputThatCannotBeReachedIsBadInputOfEverySubcommand) {
  const TemporaryFolder folder;
  const std::string loop = folder / "loop.yaml", too_long = std::string(300, 'a') + ".yaml",
                    out = folder / "x";
  std::filesystem::create_symlink("loop.yaml", loop);
  for (const auto& [input, cause] :
       {std::pair(loop, "Too many levels of symbolic links"), std::pair(too_long, "File name too long")}) {
    for (const Arguments& arguments :
         {Arguments{"info", input}, Arguments{"simulate", input, "-o", out},
          Arguments{"study", input, "--plan"}, Arguments{"render", input, "-o", out + ".png"},
          Arguments{"coverage", input, "-o", out}, Arguments{"compare", input, quick(), "-o", out},
          Arguments{"check", input}, Arguments{"terrain", input},
          Arguments{"import", input, "-o", out + ".yaml"}, Arguments{"bench", "field", input},
          Arguments{"render", quick(), "--compare", input, "-o", out + ".png"},
          Arguments{"render", quick(), "--state", input, "-o", out + ".png"}}) {
      EXPECT_THAT(errorOfRun(arguments, kBadInput), HasSubstr(cause)) << arguments[0];
    }
    EXPECT_THAT(run({"validate", input}).out, HasSubstr(cause));
  }
  for (const char* ending : {"", ".png", ".yaml"}) EXPECT_FALSE(std::filesystem::exists(out + ending));
}

TEST(CommandLine, AFolderThatMayNotBeReadIsBadInput) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may read every folder";
  const TemporaryFolder folder;
  const std::string closed = folder / "closed", inside = closed + "/a.yaml", out = folder / "x.png";
  std::filesystem::create_directory(closed);
  std::filesystem::permissions(closed, std::filesystem::perms::none);
  for (const Arguments& arguments :
       {Arguments{"info", closed}, Arguments{"info", inside}, Arguments{"render", closed, "-o", out},
        Arguments{"render", inside, "-o", out}, Arguments{"compare", closed, closed, "-o", folder / "x"},
        Arguments{"check", closed}, Arguments{"terrain", closed}, Arguments{"study", inside, "--plan"}}) {
    EXPECT_THAT(errorOfRun(arguments, kBadInput), HasSubstr("Permission denied")) << arguments[0];
  }
  std::filesystem::permissions(closed, std::filesystem::perms::owner_all);
}

TEST(CommandLine, ControlCharactersOfAFilesNameDoNotReachTheTerminal) {
  const TemporaryFolder folder;
  const std::string file = folder / "\033[31mred.yaml";
  std::filesystem::copy(quick(), file);
  EXPECT_THAT(runWell({"validate", file}).out, HasSubstr("?[31mred.yaml: ok"));
  folder.write("\033[31mred.yaml", "schema_version: 1\n");
  EXPECT_THAT(run({"validate", file}).out, HasSubstr("?[31mred.yaml:1:1: error"));
}

TEST(CommandLine, AnOptionWithoutItsValueIsNamed) {
  const auto errorOf = [](const Arguments& more) {
    return errorOfRun(joined({"simulate", shippedScenario("quick.yaml"), "-o", "out"}, more), kUsage);
  };
  EXPECT_THAT(errorOf({"--mesh", "--times", "0"}),
              HasSubstr("--mesh needs a value, but '--times' follows\n"));
  EXPECT_THAT(errorOf({"--times", "--json"}), HasSubstr("--times needs a value, but '--json' follows\n"));
  EXPECT_THAT(errorOf({"--times"}), HasSubstr("--times needs a value\n"));
  EXPECT_THAT(errorOf({"--resume", "0"}), HasSubstr("unexpected argument '0'\n"));
}

TEST(CommandLine, EmptyValueIsRefused) {
  const TemporaryFolder folder;
  const std::string scenario = shippedScenario("quick.yaml"), out = folder / "out";
  const std::vector<std::pair<Arguments, std::string>> refused{
      {{"simulate", scenario, "-o", out, "--compare", ""}, "--compare"},
      {{"simulate", scenario, "-o", out, "--times", ""}, "--times"},
      {{"simulate", scenario, "-o", out, "--range", ""}, "--range"},
      {{"simulate", scenario, "-o", out, "--mesh", ""}, "--mesh"},
      {{"simulate", scenario, "-o", ""}, "--output"},
      {{"render", scenario, "-o", out, "--state", ""}, "--state"},
      {{"render", scenario, "-o", out, "--iso-value", ""}, "--iso-value"},
      {{"coverage", scenario, "-o", out, "--area", ""}, "--area"},
      {{"coverage", scenario, "-o", out, "--cell", ""}, "--cell"},
      {{"exposure", scenario, "--platform", "mast", "-o", out + ".csv", "--rcs-target", ""}, "--rcs-target"},
      {{"profile", scenario, "--emitter", "radar", "--to", "52,5,100", "--time", ""}, "--time"},
      {{"link", scenario, "--emitter", ""}, "--emitter"},
      {{"info", ""}, "FILE"}};
  for (const auto& [arguments, name] : refused) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, kUsage) << name;
    EXPECT_THAT(result.err, StartsWith("emscape: error: " + name + ": the value is empty\n"));
  }
  EXPECT_TRUE(folder.files().empty());
}

TEST(CommandLine, ExcessValuesAreReportedWithTheirNumber) {
  const std::string scenario = shippedScenario("quick.yaml");
  EXPECT_THAT(run({"simulate", scenario, "-o", "a", "-o", "b"}).err,
              StartsWith("emscape: error: --output takes 1 value, not 2\n"));
  EXPECT_THAT(
      run({"vertical", scenario, "--emitter", "radar", "--azimuth", "0", "-o", "x.csv", "--grid", "5"}).err,
      StartsWith("emscape: error: --grid takes 2 values, not 1\n"));
  const ProgramResult twice =
      run({"simulate", scenario, "-o", "a", "--quantity", "power_density_dbwm2,power_density_dbwm2"});
  EXPECT_EQ(twice.status, kUsage);
  EXPECT_THAT(twice.err, HasSubstr("--quantity: 'power_density_dbwm2' is given twice"));
}

TEST(CommandLine, NumbersOfAnyMagnitudeAreShort) {
  const std::string scenario = shippedScenario("quick.yaml");
  EXPECT_THAT(run({"simulate", scenario, "-o", "a", "--times", "0:4:1e-300"}).err,
              HasSubstr("error: 4e+300 times are more than the allowed 10000000\n"));
  EXPECT_LT(run({"coverage", scenario, "-o", "a", "--cell", "1e-300"}).err.size(), 200U);
  EXPECT_THAT(run({"coverage", scenario, "-o", "a", "--cell", "1e9"}).err,
              HasSubstr("does not reach over all pixels of 1000000000 m"));
}

TEST(CommandLine, MessagesThatCannotBeWrittenDoNotStopTheWork) {
  const TemporaryFolder folder;
  for (const std::string redirection : {"2>&-", "2>/dev/full", "<&- 2>&-"}) {
    const std::string output = folder / ("s" + std::to_string(folder.files().size()));
    EXPECT_EQ(statusOf("simulate " + quick() + " --times 0 -o " + output + " " + redirection), 0)
        << redirection;
    EXPECT_EQ(statusOf("validate /nonexistent.yaml >/dev/null " + redirection), kBadInput) << redirection;
    EXPECT_EQ(statusOf("simulate /nonexistent.yaml -o " + output + "x " + redirection), kBadInput)
        << redirection;
    EXPECT_EQ(statusOf("explode " + redirection), kUsage) << redirection;
  }
  EXPECT_EQ(folder.files().size(), 9U);  // a volume, series.json and series.steps, three times
}

TEST(CommandLine, AResultThatCannotBeWrittenIsAnError) {
  for (const std::string arguments : {"--json info ", "info ", "--json validate ", "validate "}) {
    EXPECT_EQ(statusOf(arguments + quick() + " >/dev/full 2>/dev/null"), 1) << arguments;
    EXPECT_EQ(statusOf(arguments + quick() + " >&- 2>/dev/null"), 1) << arguments;
  }
  EXPECT_EQ(statusOf("--help >/dev/full 2>/dev/null"), 1);
  const TemporaryFolder folder;
  EXPECT_EQ(statusOf("--version >/dev/full 2>" + (folder / "err")), 1);
  EXPECT_THAT(readFile(folder / "err"), HasSubstr("cannot write the result: No space left on device"));
}

TEST(CommandLine, ErrorsWithoutAFieldPrecedeComputation) {
  EXPECT_THAT(run({"explode"}).err, StartsWith("emscape: error: there is no subcommand 'explode'"));
  EXPECT_THAT(run({"simulte"}).err, HasSubstr("'simulte'; did you mean 'simulate'?"));
  EXPECT_THAT(run({"bench", "explode"}).err, StartsWith("emscape: error: there is no subcommand 'explode'"));
  EXPECT_THAT(run({}).err, StartsWith("emscape: error: A subcommand is required"));
  EXPECT_THAT(run({"render", shippedScenario("quick.yaml"), "-o", "x.gif"}).err,
              StartsWith("emscape: error: x.gif: must end in .png or .mp4"));
}

TEST(CommandLine, UsageErrorIsOnStandardErrorWithStatus2) {
  const std::string quick = shippedScenario("quick.yaml");
  const TemporaryFolder folder;
  const std::vector<Arguments> wrong{
      {},
      {"explode"},
      {"validate"},
      {"check"},
      {"simulate", quick},
      {"simulate", quick, "-o", folder / "x", "--format", "docx"},
      {"simulate", quick, "-o", folder / "x", "--times", "5:1:1"},
      {"simulate", quick, "-o", folder / "x", "--times", "now"},
      {"simulate", quick, "-o", folder / "x", "--range", "5:1"},
      {"simulate", quick, "-o", folder / "x", "--resume", "--force"},
      {"render", quick, "-o", folder / "x.png", "--size", "0x10"},
      {"render", quick, "-o", folder / "x.png", "--camera", "orbit:azimuth=3"},
      {"simulate", quick, "-o", folder / "x", "--quantity", "loudness"},
      {"render", quick, "-o", folder / "x.png", "--quantity", "loudness"},
      {"render", quick, "-o", folder / "x.gif"},
      {"render", quick, "-o", folder / "x.png", "--times", "0:4:1"},
      {"validate", quick, "--threads", "-1"},
      {"validate", quick, "--backend", "abacus"},
      {"bench", "render", quick, "--device-volume", "double"},
      {"bench", "field", quick, "--repeats", "0"},
  };
  for (const Arguments& arguments : wrong) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, kUsage) << testing::PrintToString(arguments) << result.err;
    EXPECT_THAT(result.err, HasSubstr("emscape: error: ")) << testing::PrintToString(arguments);
    EXPECT_EQ(result.out, "") << testing::PrintToString(arguments);
  }
  EXPECT_TRUE(folder.files().empty()) << testing::PrintToString(folder.files());
}

/// The program's reason for not using a GPU; empty if it can use one.
std::string whyNoGpu() {
  const std::string version = run({"--version"}).out;
  const std::size_t none = version.find("GPU: none");
  const std::size_t line = none != std::string::npos ? none : version.find("GPU: this build");
  return line == std::string::npos ? "" : version.substr(line);
}

TEST(CommandLine, UnavailableDeviceIsOneLineWithStatus4) {
  if (whyNoGpu().empty()) GTEST_SKIP() << "there is a GPU";
  const TemporaryFolder folder;
  const std::string quick = shippedScenario("quick.yaml");
  for (const Arguments& arguments :
       {Arguments{"simulate", quick, "-o", folder / "x"}, Arguments{"bench", "field", quick},
        Arguments{"render", quick, "-o", folder / "x.png"}, Arguments{"bench", "render", quick},
        Arguments{"bench", "reconstruction", quick}, Arguments{"render", quick, "--realtime"}}) {
    Arguments with_backend = arguments;
    with_backend.insert(with_backend.end(), {"--backend", "cuda"});
    const ProgramResult result = run(with_backend);
    EXPECT_EQ(result.status, kDevice);
    EXPECT_EQ(lines(result.err), 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr("backend cuda: "));
    EXPECT_EQ(result.out, "");
  }
  EXPECT_TRUE(folder.files().empty());
}

TEST(CommandLine, VersionNamesGpuOrReasonWithoutOne) {
  EXPECT_THAT(run({"--version"}).out, HasSubstr("\nGPU: "));
}

TEST(CommandLine, AutoPrintsBackendOnceUnlessQuiet) {
  const TemporaryFolder folder;
  const Arguments arguments{"simulate", shippedScenario("quick.yaml"), "-o", folder / "a", "--times", "0"};
  const std::string said = run(arguments).err;
  const std::string expected = whyNoGpu().empty() ? "running on the GPU: " : "running on the CPU: ";
  EXPECT_THAT(said, HasSubstr(expected));
  EXPECT_EQ(said.find("running on"), said.rfind("running on"));
  Arguments quiet = arguments;
  quiet.insert(quiet.end(), {"--force", "--quiet"});
  EXPECT_EQ(run(quiet).err, "");
}

TEST(CommandLine, MissingInputIsNamed) {
  const TemporaryFolder folder;
  const std::string missing = folder / "missing.yaml";
  for (const Arguments& arguments :
       {Arguments{"simulate", missing, "-o", folder / "x"}, Arguments{"info", missing},
        Arguments{"render", missing, "-o", folder / "x.png"}, Arguments{"bench", "field", missing}}) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, kBadInput) << result.err;
    EXPECT_THAT(result.err, HasSubstr("emscape: error: "));
    EXPECT_THAT(result.err, HasSubstr("missing.yaml"));
  }
  EXPECT_EQ(run({"validate", missing}).status, kBadInput);
  EXPECT_TRUE(folder.files().empty());
}

TEST(CommandLine, UnreachedIsoValueIsReportedWithRange) {
  const TemporaryFolder folder;
  EXPECT_THAT(errorOfRun({"render", shippedScenario("quick.yaml"), "-o", folder / "x.png", "--size", "64x48",
                          "--mode", "iso", "--iso-value", "999"},
                         kBadInput),
              HasSubstr("iso value 999 dBW/m2: power_density_dbwm2 ranges from "));
  EXPECT_TRUE(folder.files().empty());
}

TEST(CommandLine, JsonIsTheOnlyStandardOutput) {
  const TemporaryFolder folder;
  const std::string quick = shippedScenario("quick.yaml");
  const std::vector<Arguments> commands{
      {"validate", quick},
      {"info", quick},
      {"simulate", quick, "-o", folder / "s", "--times", "0:1:1"},
      {"info", folder / "s/quick_0001.vdb"},
      {"render", quick, "-o", folder / "p.png", "--size", "64x48"},
      {"bench", "field", quick, "--repeats", "1"},
  };
  for (Arguments arguments : commands) {
    arguments.emplace_back("--json");
    const ProgramResult result = runWell(arguments);
    EXPECT_TRUE(json::accept(result.out)) << testing::PrintToString(arguments) << result.out;
  }
}

TEST(CommandLine, GlobalOptionsMayPrecedeTheSubcommand) {
  const ProgramResult result = runWell({"--json", "validate", shippedScenario("quick.yaml")});
  EXPECT_EQ(json::parse(result.out).at("ok"), true);
}

TEST(CommandLine, ErrorOfMissingTerrainNamesTheOption) {
  const TemporaryFolder folder;
  std::string text = readFile(shippedScenario("jacksboro.yaml"));
  for (const char* name : {"data/jacksboro.tif", "data/helicopter.csv", "data/sector_450mhz.msi"}) {
    text.replace(text.find(name), std::string(name).size(), shippedScenario(name));
  }
  const std::string dims = "dims: [200, 200, 100]", size = "size_m: [29000, 29000, 6000]";
  text.replace(text.find(dims), dims.size(), "dims: [8, 8, 2]");
  text.replace(text.find(size), size.size(), "size_m: [90000, 90000, 6000]");
  writeFile(folder / "wide.yaml", text);
  const ProgramResult result =
      run({"simulate", folder / "wide.yaml", "-o", folder / "out", "--times", "0", "--backend", "cpu"});
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.err, HasSubstr("terrain is missing below"));
  EXPECT_THAT(result.err, HasSubstr("(--allow-missing-terrain draws holes)\n"));
  const ProgramResult refused = run({"validate", folder / "wide.yaml"});
  EXPECT_EQ(refused.status, 3);
  EXPECT_THAT(refused.out, HasSubstr("accept only with --allow-missing-terrain"));
  const ProgramResult allowed = runWell({"validate", folder / "wide.yaml", "--allow-missing-terrain"});
  EXPECT_THAT(allowed.out, HasSubstr("warning: the elevation files leave"));
}

TEST(CommandLine, PictureInPlaceOfAScenarioIsNamed) {
  const TemporaryFolder folder;
  writeFile(folder / "map.png", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16));
  const ProgramResult result = run({"validate", folder / "map.png"});
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.out + result.err, HasSubstr("is a picture (PNG), not a scenario"));
}

}  // namespace
}  // namespace emscape::test
