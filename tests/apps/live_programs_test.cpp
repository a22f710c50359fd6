// emscape live and play: two programs over the loopback interface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "tests/apps/program.h"
#include "tests/support/ports.h"

namespace emscape::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

std::string freePort() {
  return std::to_string(test::freePort());
}

/// The objects of lines of JSON.
std::vector<json> linesOf(const std::string& text) {
  std::vector<json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(json::parse(line));
  return lines;
}

void pause(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

TEST(LivePrograms, AnExerciseOfOneProgramIsTheFieldOfTheOther) {
  const TemporaryFolder folder;
  const std::string port = freePort(), record = folder / "seen.pcap";
  RunningProgram live({"live", "--dis", port, "--base", quick(), "--json", "--duration", "8", "-o",
                       folder / "now", "--record", record});
  live.waitForALine();
  const ProgramResult played = runWell(
      {"play", shippedScenario("jamming.yaml"), "--dis-out", port, "--set", "duration_s=2", "--json"});
  const ProgramResult result = live.wait();
  ASSERT_EQ(result.status, 0) << result.err;
  const std::vector<json> lines = linesOf(result.out);
  ASSERT_GE(lines.size(), 2u);
  const json& last = lines.back();
  for (const char* key :
       {"t_s", "pdus", "per_s", "bytes", "lost", "bad", "late", "duplicates", "outside", "forgotten",
        "entities", "emitters", "unmatched", "fields", "field_ms", "latency_ms", "age_s", "trouble"})
    EXPECT_TRUE(last.contains(key)) << key;
  EXPECT_EQ(last["pdus"], json::parse(played.out)["sent"]);
  int entities = 0;  // at the end of a slow run the entities may be forgotten again
  for (const json& line : lines) entities = std::max(entities, line["entities"].get<int>());
  EXPECT_GT(entities, 1);
  EXPECT_GT(last["fields"], 1);
  EXPECT_EQ(last["bad"], 0);
  EXPECT_EQ(last["lost"], 0);
  EXPECT_EQ(run({"validate", folder / "now/live.yaml"}).status, 0);
  EXPECT_EQ(run({"info", folder / "now/live.vdb"}).status, 0);
  EXPECT_EQ(run({"import", record, "-o", folder / "again.yaml"}).status, 0);
}

TEST(LivePrograms, SLOW_GoOnRecordingWhileTheFieldCannotBeWritten) {
  const TemporaryFolder folder;
  const std::string port = freePort(), record = folder / "seen.pcap";
  std::filesystem::create_directories(folder / "now/live.vdb");
  RunningProgram live({"live", "--dis", port, "--base", quick(), "--json", "--duration", "7", "-o",
                       folder / "now", "--record", record});
  live.waitForALine();
  EXPECT_EQ(run({"play", shippedScenario("jamming.yaml"), "--dis-out", port, "--set", "duration_s=2"}).status,
            0);
  const ProgramResult result = live.wait();
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.err, testing::HasSubstr("live.vdb"));
  EXPECT_THAT(linesOf(result.out).back()["trouble"].get<std::string>(), testing::HasSubstr("live.vdb"));
  EXPECT_EQ(run({"import", record, "-o", folder / "again.yaml"}).status, 0);
}

TEST(LivePrograms, SLOW_ForceReplacesAScenarioAndAFieldOfTheUser) {
  const TemporaryFolder folder;
  for (const char* const name : {"now/live.yaml", "now/live.vdb"}) folder.write(name, "mine");
  Arguments live{"live", "--dis", freePort(), "--base", quick(), "--duration", "0.2", "-o", folder / "now"};
  EXPECT_THAT(errorOfRun(live, 2), HasSubstr("exists; --force replaces it"));
  live.emplace_back("--force");
  EXPECT_EQ(run(live).status, 0);
  EXPECT_EQ(run({"info", folder / "now/live.vdb"}).status, 0);
}

TEST(LivePrograms, CtrlCEndsThem) {
  const std::string port = freePort();
  const auto statusAtEnd = [](const Arguments& arguments) {
    RunningProgram program(arguments);
    pause(1500);
    program.signal(SIGINT);
    return program.wait().status;
  };
  EXPECT_EQ(statusAtEnd({"live", "--dis", port, "--base", quick(), "--quiet"}), 0);
  EXPECT_EQ(statusAtEnd({"play", quick(), "--dis-out", port, "--rate", "0.01"}), 130);
  EXPECT_EQ(statusAtEnd({"play", quick(), "--acmi-server", port}), 130);
}

TEST(LivePrograms, FaultsNameOptionValueAndRemedy) {
  EXPECT_THAT(errorOfRun({"live", "--base", quick()}, 2), HasSubstr("--dis 127.0.0.1:3000"));
  EXPECT_THAT(errorOfRun({"live", "--dis", "3000"}, 2), HasSubstr("--base is needed"));
  EXPECT_THAT(errorOfRun({"live", "--dis", "99999", "--base", quick()}, 2), HasSubstr("the port 1..65535"));
  const TemporaryFolder folder;
  EXPECT_THAT(errorOfRun({"live", "--dis", "203.0.113.1:3000", "--base", quick(), "-o", folder / "out"}, 1),
              HasSubstr("this computer has no such address"));
  const std::string recording = folder.write("out/mine.pcap", "mine");
  EXPECT_THAT(
      errorOfRun(
          {"live", "--dis", freePort(), "--base", quick(), "-o", folder / "out", "--record", recording}, 2),
      HasSubstr("mine.pcap exists"));
  EXPECT_THAT(folder.files(), ElementsAre("out/mine.pcap"));
  EXPECT_THAT(errorOfRun({"live", "--acmi", freePort(), "--base", quick()}, 1),
              HasSubstr("no program listens there"));
  EXPECT_THAT(errorOfRun({"play", quick()}, 2), HasSubstr("--dis-out"));
  const std::string interface = "--interface goes with a multicast group (224.0.0.0 to 239.255.255.255)";
  EXPECT_THAT(errorOfRun({"live", "--dis", freePort(), "--base", quick(), "--interface", "127.0.0.1"}, 2),
              HasSubstr(interface));
  EXPECT_THAT(errorOfRun({"play", quick(), "--dis-out", freePort(), "--interface", "203.0.113.1"}, 2),
              HasSubstr(interface));
  EXPECT_THAT(errorOfRun({"play", quick(), "--acmi-server", freePort(), "--ttl", "3"}, 2),
              HasSubstr("--ttl goes with a multicast group"));
  for (const char* const way :
       {"--dis-out", "--cot-out", "--acmi-server"}) {  // before a client is waited for
    EXPECT_THAT(errorOfRun({"play", shippedScenario("jamming.yaml"), way, freePort(), "--set",
                            "duration_s=1e6", "--step", "0.01"},
                           2),
                HasSubstr("more than the allowed"));
  }
  EXPECT_THAT(errorOfRun({"play", "missing.acmi", "--acmi-server", freePort()}, 3),
              HasSubstr("missing.acmi"));
  EXPECT_THAT(errorOfRun({"play", "a.pcap", "--acmi-server", "3000"}, 2),
              HasSubstr("`emscape import` makes a scenario"));
}

}  // namespace
}  // namespace emscape::test
