/// Every kind of event becomes a busy picture, a restored one and an exact one.
#include <gmock/gmock.h>

#include "tests/support/sanitizers.h"
#include "tests/view/window_fixture.h"

namespace emscape::test {
namespace {

struct Event {
  const char* name;
  const char* command;  ///< lines of a script
};

const Event kEvents[] = {
    {"Orbit", R"({"do":"orbit","azimuth_deg":15})"},
    {"Pan", R"({"do":"pan","right_px":20,"down_px":5})"},
    {"Dolly", R"({"do":"dolly","factor":0.8})"},
    {"Camera", R"({"do":"camera","spec":"orbit:azimuth_deg=10,elevation_deg=60"})"},
    {"Focus", R"({"do":"focus","emitter":"radar"})"},
    {"Edit", R"({"do":"set","path":"emitters.radar.power_w","value":"5"})"},
    {"Undo",
     "{\"do\":\"set\",\"path\":\"emitters.radar.power_w\",\"value\":\"5\"}\n"
     "{\"do\":\"wait_state\",\"state\":\"exact\"}\n{\"do\":\"mark\",\"text\":\"event\"}\n{\"do\":\"undo\"}"},
    {"StepWithADifferentField", R"({"do":"seek","time_s":2})"},
    {"Mode", R"({"do":"mode","mode":"mip"})"},
    {"Isosurface", R"({"do":"iso"})"},
    {"Shading", R"({"do":"shading","on":true})"},
    {"Exaggeration", R"({"do":"exaggeration","factor":3})"},
    {"Opacity", R"({"do":"opacity","factor":2})"},
    {"ColorMap", R"({"do":"transfer","colors":"inferno"})"},
    {"Range", R"({"do":"range","min":-60,"max":-20})"},
    {"Ground", R"({"do":"terrain","on":false})"},
    {"Resize", R"({"do":"resize","width":700,"height":500})"},
    {"Panel", R"({"do":"panel","name":"timeline","open":false})"},
    {"Mouse", R"({"do":"mouse","x":150,"y":200,"button":"left","to_x":220,"to_y":230})"},
    {"Wheel", R"({"do":"mouse","x":150,"y":200,"wheel":2})"},
    {"Key", R"({"do":"key","key":"Ctrl+Left"})"},
};

class Events : public Window, public testing::WithParamInterface<Event> {
 protected:
  /// The states after the mark "event", in the order in which they came.
  std::vector<std::string> statesAfterTheEvent() const {
    std::vector<std::string> states;
    for (const Json& line : log()) {
      if (line["event"] == "mark" && line["text"] == "event") states.clear();
      if (line["event"] == "state") states.push_back(line["to"]);
    }
    return states;
  }
};

std::string scriptOf(const char* command) {
  return std::string(R"({"do":"pattern","pattern":"quarter"}
{"do":"wait_state","state":"exact"}
{"do":"mark","text":"event"}
)") + command +
         R"(
{"do":"wait_state","state":"exact"}
{"do":"expect","key":"error","op":"==","value":""}
{"do":"quit"}
)";
}

void expectBusyRestoreIdle(const std::vector<std::string>& states) {
  ASSERT_GE(states.size(), 3U);
  EXPECT_EQ(states.front(), "BUSY");
  EXPECT_EQ(states[states.size() - 2], "RESTORE");
  EXPECT_EQ(states.back(), "IDLE");
}

TEST_P(Events, SettleThroughBusyAndRestore) {
  const ProgramResult result = runScript(scriptOf(GetParam().command));
  ASSERT_EQ(result.status, 0) << result.err;
  expectBusyRestoreIdle(statesAfterTheEvent());
}

INSTANTIATE_TEST_SUITE_P(Window, Events, testing::ValuesIn(kEvents),
                         [](const auto& event) { return std::string(event.param.name); });

// From the event to the begin of the next frame.
TEST_F(Window, AnEventInRestoreIsAnsweredWithinTwentyMilliseconds) {
  std::string script = R"({"do":"pattern","pattern":"quarter"}
{"do":"resize","width":1200,"height":900}
{"do":"wait_s","seconds":0.5}
)";
  for (int n = 0; n < 5; ++n) {
    script += R"({"do":"wait_state","state":"exact"}
{"do":"orbit","azimuth_deg":5}
{"do":"wait_state","state":"RESTORE"}
{"do":"mark","text":"event"}
{"do":"orbit","azimuth_deg":5}
)";
  }
  script += R"({"do":"wait_state","state":"exact"}
{"do":"quit"}
)";
  Arguments arguments = viewOf(shippedScenario("jacksboro.yaml"), script);
  runWell(arguments, environment());
  std::vector<double> times_ms;
  long long marked = -1;
  for (const Json& line : log()) {
    if (line["event"] == "mark") marked = line["frame"];
    if (line["event"] != "frame" || marked < 0 || line["frame"] == marked) continue;
    times_ms.push_back(line["input_to_frame_ms"]);
    marked = -1;
  }
  ASSERT_EQ(times_ms.size(), 5U);
  // The machine of the tests may be busy with others: one of the five in time proves that nothing is waited
  // for.
  if (!kIsSanitized) {
    EXPECT_LT(*std::min_element(times_ms.begin(), times_ms.end()), 20);
  }
}

}  // namespace
}  // namespace emscape::test
