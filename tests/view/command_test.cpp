#include "apps/view/session/command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/errors.h"

namespace emscape::view {
namespace {

std::string faultOf(const std::string& text) {
  return test::errorOf([&] { parseCommand(text); });
}

TEST(Command, IsReadAndWritten) {
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

TEST(Command, EveryVerbHasHelp) {
  for (const Verb& verb : verbs()) EXPECT_STRNE(verb.help, "") << verb.name;
}

}  // namespace
}  // namespace emscape::view
