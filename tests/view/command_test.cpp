#include "apps/view/commands/command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/errors.h"

namespace emscape::view {
namespace {

std::string faultOf(const std::string& text) {
  return test::errorOf([&] { parseCommand(text); });
}

TEST(Command, RoundTripIsExact) {
  const Command command = parseCommand(std::string(R"({"do":"seek","time_s":49.5,"at_s":2})"));
  EXPECT_EQ(command.verb, "seek");
  EXPECT_DOUBLE_EQ(command.number("time_s"), 49.5);
  EXPECT_EQ(toString(command), R"({"do":"seek","time_s":49.5})");
}

TEST(Command, FaultsNameVerbAndArgument) {
  EXPECT_THAT(faultOf(R"({"do":"jump"})"), testing::StartsWith("unknown verb 'jump': expected play, pause"));
  EXPECT_EQ(faultOf(R"({"do":"step"})"), "step: steps is missing");
  EXPECT_EQ(faultOf(R"({"do":"seek","time_s":"now"})"), "seek: time_s is \"now\": expected a number");
  EXPECT_EQ(faultOf(R"({"do":"loop","on":1})"), "loop: on is 1: expected true or false");
  EXPECT_EQ(faultOf(R"({"do":"pause","fast":true})"), "pause: unknown argument 'fast'");
  EXPECT_EQ(faultOf(R"([1])"), "expected an object with \"do\": \"VERB\"");
  EXPECT_EQ(faultOf("seek"), "'seek' is not JSON");
}

TEST(Command, NumbersHaveLimits) {
  const auto fault = [](const std::string& text) {
    return test::errorOf([&] { requireAllowed(parseCommand(text)); }, ErrorCode::bad_input);
  };
  EXPECT_EQ(fault(R"({"do":"recall","number":1.5})"), "recall: number 1.5: expected a whole number 1..9");
  EXPECT_EQ(fault(R"({"do":"open_recent","number":-1})"),
            "open_recent: number -1: expected a whole number 1..10");
  EXPECT_EQ(fault(R"({"do":"scale","factor":9})"), "scale: factor 9: expected a number 0.5..4");
  EXPECT_EQ(fault(R"({"do":"rate","change":2})"), "rate: change 2: expected -1 or 1");
  EXPECT_EQ(fault(R"({"do":"pan","right_px":1e300,"down_px":0})"),
            "pan: right_px 1e+300: expected a number -100000..100000");
  EXPECT_EQ(fault(R"({"do":"dolly","factor":0})"), "dolly: factor 0: expected a number 0.001..1000");
  EXPECT_EQ(fault(R"({"do":"resize","width":0,"height":9})"), "resize: width 0: expected a number 1..16384");
  EXPECT_EQ(fault(R"({"do":"step","steps":1.5})"),
            "step: steps 1.5: expected a whole number -1000000000..1000000000");
  EXPECT_EQ(fault(R"({"do":"exaggeration","factor":1e9})"),
            "exaggeration: factor 1e+09: expected a number 0..100");
  EXPECT_EQ(fault(R"({"do":"step_voxels","value":0})"), "step_voxels: value 0: expected a number 0.05..10");
  EXPECT_EQ(fault(R"({"do":"timeline","zoom":-1})"), "timeline: zoom -1: expected a number 1e-06..1000000");
  EXPECT_EQ(fault(R"({"do":"opacity_point","index":-1})"),
            "opacity_point: index -1: expected a whole number of at least 0");
  EXPECT_EQ(fault(R"({"do":"remove_point","index":0.5})"),
            "remove_point: index 0.5: expected a whole number of at least 0");
  EXPECT_EQ(fault(R"({"do":"plane","index":4,"on":true})"), "plane: index 4: expected a whole number 1..3");
  const Command endless{"range", {{"min", INFINITY}}};
  EXPECT_EQ(test::errorOf([&] { requireAllowed(endless); }), "range: min inf: expected a finite number");
  EXPECT_EQ(fault(R"({"do":"pan","right_px":-40,"down_px":3})"), "");
}

TEST(Command, TextsHaveChoicesOrASyntax) {
  const auto fault = [](const std::string& text) {
    return test::errorOf([&] { requireAllowed(parseCommand(text)); });
  };
  EXPECT_EQ(fault(R"({"do":"panel","name":"nothing"})"),
            "panel: name 'nothing': expected scenario, colors, planes, probe, timeline, help, time, open, "
            "position, map, record, restore, unsaved, changed, menu, replace, warnings, side, all");
  EXPECT_EQ(fault(R"({"do":"quit","edits":"xx"})"), "quit: edits 'xx': expected save, discard, ask");
  EXPECT_EQ(fault(R"({"do":"opacity_preset","name":"xx"})"),
            "opacity_preset: name 'xx': expected ramp, late ramp, threshold, shell, bands, opaque");
  EXPECT_EQ(fault(R"({"do":"plane","kind":"slanted"})"),
            "plane: kind 'slanted': expected horizontal, vertical");
  for (const char* text : {R"({"do":"mode","mode":"xx"})", R"({"do":"theme","theme":"xx"})",
                           R"({"do":"pattern","pattern":"xx"})", R"({"do":"camera","spec":"xx"})",
                           R"({"do":"plane","spec":"xx"})", R"({"do":"transfer","colors":"xx"})"}) {
    EXPECT_THAT(fault(text), testing::ContainsRegex("'xx'.*expected")) << text;
  }
  EXPECT_EQ(fault(R"({"do":"picture","file":"x.txt"})"), "x.txt: must end in .png");
  EXPECT_EQ(fault(R"({"do":"picture","file":""})"), "");
  EXPECT_EQ(fault(R"({"do":"pattern","pattern":"auto"})"), "");
  EXPECT_EQ(fault(R"({"do":"panel","name":"all"})"), "");
}

TEST(Command, EveryVerbHasHelp) {
  for (const Verb& verb : verbs()) EXPECT_STRNE(verb.help, "") << verb.name;
}

}  // namespace
}  // namespace emscape::view
