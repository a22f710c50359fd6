// A GPU that is lost while a command runs: one error, and only complete files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/apps/program.h"
#include "tests/support/gpu.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::MatchesRegex;
using testing::Not;

/// A program's messages, without those of the label library on a machine without fonts.
std::string withoutFontconfig(const std::string& text) {
  return std::regex_replace(text, std::regex("Fontconfig [^\n]*\n"), "");
}

/// Runs a command on a GPU that is lost once the file `sign` is there.
void runAndLoseDevice(Arguments arguments, const std::string& sign) {
  arguments.insert(arguments.end(), {"--backend", "cuda", "--quiet", "--json"});
  const ProgramResult result = run(arguments, "export LD_PRELOAD='" + besideThisProgram("liblose_device.so") +
                                                  "' EMSCAPE_LOSE_DEVICE_AT='" + sign + "';");
  EXPECT_EQ(result.status, 4);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(withoutFontconfig(result.err),
              MatchesRegex("emscape: error: GPU: [^\n]+: [^\n]+ \\(cudaError[A-Za-z]+\\)"
                           "(; the last kernel launched was [^\n]+)?\n"));
}

/// Contents of the files of a folder, by name.
std::map<std::string, std::string> contentsOf(const TemporaryFolder& folder) {
  std::map<std::string, std::string> contents;
  for (const std::string& file : folder.files()) contents[file] = readFile(folder.path() / file);
  return contents;
}

void expectNoTemporaries(const TemporaryFolder& folder) {
  EXPECT_THAT(folder.files(), Not(Contains(HasSubstr(".part-"))));
}

/// Number of steps of a series that the CPU can draw; it reads every voxel of each.
int stepsThatCanBeRead(const std::string& series) {
  const TemporaryFolder pictures;
  const ProgramResult result = runWell(
      {"render", series, "-o", pictures / "p", "--size", "16x12", "--backend", "cpu", "--quiet", "--json"});
  return result.status == 0 ? json::parse(result.out).at("frames").get<int>() : 0;
}

TEST(CudaLostDevice, SimulateLeavesWholeStepsAndCpuContinues) {
  EMSCAPE_NEEDS_GPU();
  const TemporaryFolder folder;
  constexpr int kSteps = 301;
  const Arguments simulate{
      "simulate", longScenario(folder, kSteps - 1), "-o", folder / "s", "--format", "vdb,vti", "--range",
      "-120:20"};
  runAndLoseDevice(simulate, folder / "s/quick_0002.vti");
  expectNoTemporaries(folder);
  const std::string journal = readFile(folder / "s/series.steps");
  const auto finished = static_cast<int>(std::count(journal.begin(), journal.end(), '\n'));
  EXPECT_GE(finished, 1);
  EXPECT_LT(finished, kSteps);
  EXPECT_GE(stepsThatCanBeRead(folder / "s"), finished);
  EXPECT_GE(stepsThatCanBeRead(folder / "s/quick.pvd"), finished);

  const std::map<std::string, std::string> left = contentsOf(folder);
  Arguments resume = simulate;
  resume.insert(resume.end(), {"--resume", "--backend", "cpu", "--json"});
  const ProgramResult resumed = runWell(resume);
  EXPECT_EQ(json::parse(resumed.out).at("steps_computed"), kSteps - finished);
  expectNoTemporaries(folder);
  const std::map<std::string, std::string> whole = contentsOf(folder);
  // The scenario, the volumes, quick.pvd, series.json and series.steps.
  EXPECT_EQ(whole.size(), 1 + 2 * kSteps + 3U);
  for (const char* first : {"s/quick_0001.vdb", "s/quick_0001.vti"}) {
    EXPECT_TRUE(left.at(first) == whole.at(first)) << first;
  }
  EXPECT_EQ(stepsThatCanBeRead(folder / "s/quick.pvd"), kSteps);
}

TEST(CudaLostDevice, InRenderLeavesWholePicturesAndNoVideo) {
  EMSCAPE_NEEDS_GPU();
  const TemporaryFolder folder;
  constexpr int kFrames = 81;
  const std::string scenario = longScenario(folder, kFrames - 1);
  ASSERT_EQ(run({"simulate", scenario, "-o", folder / "s", "--range", "-120:20"}).status, 0);
  const bool has_ffmpeg = std::system("command -v ffmpeg >/dev/null") == 0;
  for (const bool stored : {false, true}) {
    const std::string pictures = folder / (stored ? "stored" : "computed");
    Arguments render{"render", stored ? folder / "s" : scenario, "-o", pictures, "--size", "640x480"};
    if (has_ffmpeg) render.insert(render.end(), {"-o", folder / "video.mp4"});
    runAndLoseDevice(render, pictures + (stored ? "/s_0002.png" : "/quick_0002.png"));
  }
  expectNoTemporaries(folder);
  const std::map<std::string, std::string> left = contentsOf(folder);
  EXPECT_EQ(left.count("video.mp4"), 0U);
  int count = 0;
  for (const auto& [file, content] : left) {
    if (std::filesystem::path(file).extension() != ".png") continue;
    EXPECT_EQ(content.substr(content.size() - 8, 4), "IEND") << file;
    ++count;
  }
  EXPECT_GE(count, 2 * 2);
  EXPECT_LT(count, 2 * kFrames);
}

TEST(CudaLostDevice, InPlaybackEndsIt) {
  EMSCAPE_NEEDS_GPU();
  const TemporaryFolder folder;
  const std::string scenario = longScenario(folder, 300);
  for (const char* rays : {"full", "quarter", "adaptive"}) {
    const std::string pictures = folder / rays;
    runAndLoseDevice({"render", scenario, "--realtime", "-o", pictures, "--size", "640x480", "--rays", rays,
                      "--speed", "10", "--orbit-rate", "10"},
                     pictures + "/quick_0002.png");
  }
  expectNoTemporaries(folder);
  EXPECT_THAT(folder.files(), IsSupersetOf({"full/quick_0002.png", "adaptive/quick_0002.png"}));
}

}  // namespace
}  // namespace emscape::test
