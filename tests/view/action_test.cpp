#include "apps/view/commands/action.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "apps/view/commands/input_queue.h"
#include "emscape/base/error.h"
#include "tests/support/files.h"

namespace emscape::view {
namespace {

TEST(Action, EveryActionHasKeyCommandAndCommandLine) {
  for (const Action& action : actions()) {
    EXPECT_STRNE(action.menu, "") << action.name;
    EXPECT_NE(action.command_line, "") << action.name;
    EXPECT_FALSE(chordsOf(action).empty()) << action.name;
    EXPECT_NO_THROW(parseCommand(action.command)) << action.name;
  }
}

TEST(Action, NoKeyAndNoNameIsUsedTwice) {
  std::set<std::string> keys, names;
  for (const Action& action : actions()) {
    EXPECT_TRUE(names.insert(std::string(action.menu) + "/" + action.name).second) << action.name;
    for (const KeyChord& chord : chordsOf(action)) {
      EXPECT_TRUE(keys.insert(toString(chord)).second) << action.name << ": " << toString(chord);
    }
  }
}

TEST(Action, EveryKeyCanBePressedAndFindsItsAction) {
  for (const Action& action : actions()) {
    for (const KeyChord& chord : chordsOf(action)) {
      const auto events = eventsOf(chord);
      EXPECT_EQ(actionOf(chordOf(events[0])), &action) << toString(chord);
    }
  }
}

TEST(Action, AKeyThatIsHeldRepeatsStepsAndNoSwitches) {
  for (const char* key : {"Right", "Ctrl+Z", "Y", "+", "Shift+Up", "Up"})
    EXPECT_TRUE(repeats(*actionOf(parseChord(key)))) << key;
  for (const char* key : {"Space", "C", "T", "Ctrl+S", "F12", "Shift+J", "H"})
    EXPECT_FALSE(repeats(*actionOf(parseChord(key)))) << key;
}

TEST(Action, KeysWithoutAnActionHaveNone) {
  EXPECT_EQ(actionOf(parseChord("Ctrl+Shift+X")), nullptr);
}

TEST(Action, MenusAreListedOnce) {
  EXPECT_THAT(menuNames(), testing::ElementsAre("File", "Edit", "Time", "Camera", "View", "Panels"));
}

TEST(Action, ChordsAreReadAndWritten) {
  const KeyChord chord = parseChord("Ctrl+Shift+Z");
  EXPECT_TRUE(chord.control);
  EXPECT_TRUE(chord.shift);
  EXPECT_EQ(chord.key, "Z");
  EXPECT_EQ(toString(chord), "Ctrl+Shift+Z");
  EXPECT_EQ(parseChord("Ctrl++").key, "+");
  EXPECT_THROW(parseChord(""), Error);
}

TEST(Action, ManualContainsTables) {
  const std::string manual = test::readFile(test::sourceFile("docs/viewer.md"));
  EXPECT_NE(manual.find(manualTables()), std::string::npos)
      << "docs/viewer.md: put the output of `emscape-view --manual-tables` there";
}

}  // namespace
}  // namespace emscape::view
