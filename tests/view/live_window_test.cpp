// The window with a live stream.
#include <filesystem>

#include "tests/support/ports.h"
#include "tests/view/window_fixture.h"

namespace emscape::test {
namespace {

TEST_F(Window, AnotherInputClosesTheSocketOfAStreamAndCompletesItsRecording) {
  const std::string other = folder_ / "other.yaml", recording = folder_ / "seen.pcap";
  writeFile(other, readFile(quick()));
  const std::uint16_t port = freePort();
  Arguments arguments = viewOf(quick(), R"({"do":"wait_state","state":"exact"}
{"do":"mark","text":"live"}
{"do":"open","file":")" + other + R"("}
{"do":"wait_state","state":"exact"}
{"do":"wait_s","seconds":60}
)");
  for (const std::string& more :
       {std::string("--dis"), std::to_string(port), std::string("--record"), recording})
    arguments.push_back(more);
  RunningProgram program(arguments, environment());
  ASSERT_TRUE(comesToLog("mark"));
  EXPECT_TRUE(comes([&] { return boundPort(port) == port; }));
  EXPECT_TRUE(std::filesystem::exists(recording));
  program.signal(SIGINT);
  EXPECT_EQ(program.wait().status, 130);
}

}  // namespace
}  // namespace emscape::test
