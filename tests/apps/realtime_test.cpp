// emscape render --realtime, end to end. The timing is tested with a simulated clock in
// tests/playback/real_time_loop_test.cpp; no test asserts speed, since the machine may be busy.
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
using testing::Each;
using testing::HasSubstr;
using testing::IsSupersetOf;

/// Plays the quick scenario in a small window, with every settled picture verified; returns the report.
json play(const Arguments& more, const std::string& input = quick(), const std::string& size = "97x75") {
  const ProgramResult result =
      runWell(joined({"render", input, "--realtime", "--size", size, "--verify", "--json"}, more));
  return result.status == 0 ? json::parse(result.out) : json();
}

std::vector<std::string> all(const json& report, const char* key) {
  std::vector<std::string> values;
  for (const json& frame : report.at("frames")) values.push_back(frame.at(key));
  return values;
}

void expectSettledPicturesAreExact(const json& report) {
  if (report.at("settled") > 0) {
    EXPECT_EQ(report.at("settled"), report.at("settled_equal_full"));
  }
  for (const json& frame : report.at("frames")) {
    EXPECT_EQ(frame.at("equals_full"), frame.at("state") == "IDLE" ? json(true) : json(nullptr)) << frame;
  }
}

TEST(Realtime, SLOW_GoesFromBusyToRestoreToIdleAtEveryStepAndSettlesExactly) {
  for (const char* pattern : {"columns", "checkerboard", "quarter", "adaptive"}) {
    const json report = play({"--rays", pattern, "--speed", "8", "--epsilon", "20"});
    EXPECT_THAT(all(report, "state"), IsSupersetOf({"BUSY", "RESTORE", "IDLE"})) << pattern;
    EXPECT_EQ(all(report, "state").front(), "BUSY");
    EXPECT_THAT(all(report, "pattern"), Each(pattern));
    EXPECT_GT(report.at("restores").at("done"), 0);
    EXPECT_GT(report.at("settled"), 0);
    expectSettledPicturesAreExact(report);
  }
}

TEST(Realtime, ConstantScenarioIsDrawnOnce) {
  const TemporaryFolder folder;
  std::string text = readFile(quick());
  const std::size_t scan = text.find("    scan:");
  text.erase(scan, text.find('\n', scan) - scan + 1);
  writeFile(folder / "still.yaml", text);
  const json report = play({"--speed", "4", "--rays", "quarter"}, folder / "still.yaml");
  EXPECT_EQ(report.at("busy_frames"), 1);
  EXPECT_EQ(report.at("due"), 1);
  EXPECT_EQ(report.at("settled"), 1);
}

TEST(Realtime, PlaysVolumesFromFiles) {
  const TemporaryFolder folder;
  ASSERT_EQ(run({"simulate", quick(), "-o", folder / "s", "--format", "vdb", "--times", "0:2:1"}).status, 0);
  const json report = play({"--speed", "4", "--rays", "quarter"}, folder / "s");
  EXPECT_EQ(report.at("due"), 3);
  expectSettledPicturesAreExact(report);
}

TEST(Realtime, PrintsEachFrameWithReasonOfItsPattern) {
  const ProgramResult result =
      runWell({"render", quick(), "--realtime", "--size", "64x48", "--rays", "columns", "--duration", "0.5"});
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("BUSY    columns"));
  EXPECT_THAT(result.err, HasSubstr("(columns was requested)"));
  EXPECT_THAT(result.err, HasSubstr("per second requested"));
  const ProgramResult quiet =
      runWell({"render", quick(), "--realtime", "--size", "64x48", "--duration", "0.2", "--quiet"});
  EXPECT_EQ(quiet.err, "");
}

TEST(Realtime, WritesThePicturesThatWereShown) {
  const TemporaryFolder folder;
  const json report = play({"-o", folder / "f", "--rays", "quarter", "--duration", "1", "--speed", "2"});
  int pictures = 0;
  for (const json& frame : report.at("frames")) {
    if (frame.at("state") == "BUSY" || (frame.at("state") == "RESTORE" && frame.at("restored"))) ++pictures;
  }
  EXPECT_EQ(folder.files().size(), static_cast<std::size_t>(pictures));
  EXPECT_THAT(folder.files(), Contains("f/quick_0001.png"));
}

TEST(Realtime, AVideoLastsAsLongAsThePlaying) {
  if (std::system("command -v ffprobe >/dev/null") != 0) GTEST_SKIP() << "ffprobe is not installed";
  const TemporaryFolder folder;
  play({"-o", folder / "v.mp4", "--duration", "1", "--fps", "10"});
  const std::string command =
      "ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 " + (folder / "v.mp4") +
      " >" + (folder / "count");
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(readFile(folder / "count").substr(0, 2), "10");
}

TEST(Realtime, CtrlCEndsIt) {
  RunningProgram program({"render", quick(), "--realtime", "--size", "64x48", "--duration", "60"});
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  program.signal(SIGINT);
  EXPECT_EQ(program.wait().status, 130);
}

TEST(Realtime, UsageErrorsAreReported) {
  const std::vector<std::pair<Arguments, std::string>> wrong{
      {{"render", quick(), "--realtime", "--orbit-rate", "5", "--camera",
        "lookat:eye_x_m=0,eye_y_m=-9000,eye_z_m=5000,target_x_m=0,target_y_m=0,target_z_m=0"},
       "--orbit-rate"},
      {{"render", quick(), "--realtime", "-o", "picture.png"}, "picture.png"},
      {{"render", quick(), "--realtime", "--budget", "0"}, "--budget"},
      {{"render", quick(), "-o", "x.png", "--orbit-rate", "5"}, "--realtime"},
      {{"render", quick()}, "--output"},
  };
  for (const auto& [arguments, named] : wrong) {
    EXPECT_THAT(errorOfRun(arguments, 2), HasSubstr(named));
  }
}

}  // namespace
}  // namespace emscape::test
