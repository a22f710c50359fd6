#include "apps/view/session/script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/errors.h"
#include "tests/support/temporary_folder.h"

namespace emscape::view {
namespace {

std::string faultOf(const std::string& text) {
  const test::TemporaryFolder folder;
  const std::string file = folder.write("script.jsonl", text);
  const std::string fault =
      test::errorOf([&] { EXPECT_FALSE(Script(file).finished()); }, ErrorCode::bad_input);
  return fault.empty() ? "" : fault.substr(file.size());
}

TEST(Script, CommentsAndEmptyLinesAreSkipped) {
  EXPECT_EQ(faultOf("# a tour\n\n  {\"do\":\"play\"}\n"), "");
}

TEST(Script, FaultsNameTheLine) {
  EXPECT_EQ(faultOf("{\"do\":\"play\"}\n{\"do\":\"step\"}\n"), ":2: step: steps is missing");
  EXPECT_EQ(faultOf("play\n"), ":1: not JSON");
  EXPECT_EQ(faultOf("\n{\"do\":\"key\",\"key\":\"Ctrl+Nokey\"}\n"), ":2: unknown key 'Nokey'");
  EXPECT_EQ(faultOf("{\"do\":\"play\",\"at_s\":\"soon\"}\n"),
            ":1: play: at_s is \"soon\": expected a number");
}

TEST(Script, ArgumentsThatAreNotAllowedNameTheLine) {
  EXPECT_EQ(faultOf("\n{\"do\":\"wait_state\",\"state\":\"idle\"}\n"),
            ":2: wait_state: state 'idle': expected BUSY, RESTORE, IDLE, exact, recorded");
  EXPECT_EQ(faultOf("{\"do\":\"expect\",\"key\":\"rate\",\"op\":\"=\",\"value\":1}\n"),
            ":1: expect: op '=': expected ==, !=, <, <=, >, >=");
  EXPECT_EQ(faultOf("{\"do\":\"mouse\",\"x\":1,\"y\":1,\"button\":\"x\"}\n"),
            ":1: mouse: button 'x': expected left, middle, right");
  EXPECT_EQ(faultOf("{\"do\":\"wait_s\",\"seconds\":-1}\n"),
            ":1: wait_s: seconds -1: expected a number of at least 0");
  EXPECT_EQ(faultOf("{\"do\":\"play\",\"at_s\":-5}\n"), ":1: play: at_s -5: expected a number of at least 0");
  EXPECT_EQ(faultOf("{\"do\":\"bookmark\",\"number\":1.5}\n"),
            ":1: bookmark: number 1.5: expected a whole number 1..9");
}

TEST(Script, TextsThatCannotBeReadNameTheLine) {
  EXPECT_EQ(faultOf("\n{\"do\":\"mode\",\"mode\":\"nothing\"}\n"),
            ":2: mode: mode 'nothing': expected dvr, mida, mip, iso");
  EXPECT_EQ(faultOf("{\"do\":\"picture\",\"file\":\"x.txt\"}\n"), ":1: x.txt: must end in .png");
}

TEST(Script, APartOfADragNamesTheLine) {
  const std::string fault = ":1: mouse: expected to_x and to_y together, and a button to drag with";
  EXPECT_EQ(faultOf("{\"do\":\"mouse\",\"x\":1,\"y\":1,\"button\":\"left\",\"to_x\":9}\n"), fault);
  EXPECT_EQ(faultOf("{\"do\":\"mouse\",\"x\":1,\"y\":1,\"to_x\":9,\"to_y\":9}\n"), fault);
  EXPECT_EQ(faultOf("{\"do\":\"mouse\",\"x\":1,\"y\":1,\"button\":\"left\",\"to_x\":9,\"to_y\":9}\n"), "");
}

TEST(Script, KeysAreGivenOnce) {
  EXPECT_EQ(faultOf("{\"do\":\"seek\",\"time_s\":1,\"time_s\":2}\n"), ":1: time_s is given twice");
}

TEST(Script, NoFileIsBadInput) {
  EXPECT_THROW(Script("no/such/script.jsonl"), Error);
}

}  // namespace
}  // namespace emscape::view
