#include "apps/view/commands/input_queue.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "emscape/base/error.h"

namespace emscape::view {
namespace {

InputEvent key(int code, int action, int modifiers = 0) {
  return {InputEvent::Kind::key, code, 0, action, modifiers, 0, 0};
}
InputEvent button(int action, int modifiers = 0) {
  return {InputEvent::Kind::button, GLFW_MOUSE_BUTTON_LEFT, 0, action, modifiers, 0, 0};
}
InputEvent cursor(double x, double y) {
  return {InputEvent::Kind::cursor, 0, 0, 0, 0, x, y};
}

TEST(InputQueue, PressAndReleaseOfAKeyComeInTwoFrames) {
  InputQueue queue;
  queue.push(key(GLFW_KEY_SPACE, GLFW_PRESS));
  queue.push(key(GLFW_KEY_SPACE, GLFW_RELEASE));
  EXPECT_EQ(queue.takeFrame(false).size(), 1U);
  EXPECT_FALSE(queue.empty());
  EXPECT_EQ(queue.takeFrame(false).size(), 1U);
  EXPECT_TRUE(queue.empty());
}

TEST(InputQueue, KeyAndMovementsShareAFrameInOrder) {
  InputQueue queue;
  queue.push(cursor(1, 2));
  queue.push(key(GLFW_KEY_A, GLFW_PRESS));
  queue.push(cursor(3, 4));
  const std::vector<InputEvent> frame = queue.takeFrame(false);
  ASSERT_EQ(frame.size(), 3U);
  EXPECT_EQ(frame[1].code, GLFW_KEY_A);
  EXPECT_DOUBLE_EQ(frame[2].x, 3);
}

/// Frames until the queue is empty.
int framesOf(InputQueue& queue, bool is_typing) {
  int frames = 0;
  for (; !queue.empty(); ++frames) queue.takeFrame(is_typing);
  return frames;
}

TEST(InputQueue, KeyAfterAClickOrACommandWaitsForTheFocus) {
  InputQueue queue;
  for (const int code : {GLFW_KEY_G, GLFW_KEY_3}) queue.push(key(code, GLFW_PRESS));
  EXPECT_EQ(framesOf(queue, false), 5);
  EXPECT_TRUE(queue.takeFrame(false).empty());
  queue = {};
  queue.push(button(GLFW_RELEASE));
  queue.push(key(GLFW_KEY_3, GLFW_PRESS));
  EXPECT_EQ(framesOf(queue, false), 5);
}

TEST(InputQueue, KeysTypedIntoAFieldAndControlClicksDoNotWaitForTheFocus) {
  InputQueue queue;
  for (const int code : {GLFW_KEY_G, GLFW_KEY_3, GLFW_KEY_ENTER, GLFW_KEY_G})
    queue.push(key(code, GLFW_PRESS));
  EXPECT_EQ(framesOf(queue, true), 1 + 4);
  queue = {};
  queue.push(button(GLFW_PRESS));
  queue.push(key(GLFW_KEY_3, GLFW_PRESS));
  EXPECT_EQ(framesOf(queue, false), 2);
}

TEST(InputQueue, AFieldTakesAllCharactersThatWaitInAFrame) {
  const auto character = [](int code) {
    InputEvent event;
    event.kind = InputEvent::Kind::text;
    event.code = code;
    return event;
  };
  InputQueue queue;
  for (int n = 0; n < 3; ++n) {
    queue.push(key(GLFW_KEY_A, GLFW_PRESS));
    queue.push(character('a'));
    queue.push(key(GLFW_KEY_A, GLFW_RELEASE));
  }
  queue.push(key(GLFW_KEY_LEFT, GLFW_PRESS));
  queue.push(key(GLFW_KEY_B, GLFW_PRESS));
  queue.push(character('b'));
  const std::vector<InputEvent> frame = queue.takeFrame(true);
  EXPECT_EQ(std::count_if(frame.begin(), frame.end(),
                          [](const InputEvent& event) { return event.kind == InputEvent::Kind::text; }),
            3);
  EXPECT_EQ(queue.takeFrame(true).front().code, GLFW_KEY_LEFT)
      << "after the characters, in a frame of its own";
  EXPECT_EQ(queue.takeFrame(true).front().code, 'b');
  EXPECT_TRUE(queue.empty());
}

TEST(InputQueue, KeyOfAModifierCarriesTheStateAfterIt) {
  InputQueue queue;
  queue.push(key(GLFW_KEY_LEFT_CONTROL, GLFW_PRESS));
  queue.push(key(GLFW_KEY_RIGHT_CONTROL, GLFW_PRESS, GLFW_MOD_CONTROL));
  queue.push(key(GLFW_KEY_LEFT_CONTROL, GLFW_RELEASE, GLFW_MOD_CONTROL));
  queue.push(key(GLFW_KEY_RIGHT_CONTROL, GLFW_RELEASE, GLFW_MOD_CONTROL));
  queue.push(key(GLFW_KEY_RIGHT_SHIFT, GLFW_PRESS));
  std::vector<int> modifiers;
  while (!queue.empty()) {
    for (const InputEvent& event : queue.takeFrame(false)) modifiers.push_back(event.modifiers);
  }
  EXPECT_EQ(modifiers,
            (std::vector<int>{GLFW_MOD_CONTROL, GLFW_MOD_CONTROL, GLFW_MOD_CONTROL, 0, GLFW_MOD_SHIFT}));
}

TEST(InputQueue, FrameHasOneStateOfTheModifiers) {
  InputQueue queue;
  queue.push(key(GLFW_KEY_LEFT_CONTROL, GLFW_PRESS));
  queue.push(button(GLFW_PRESS, GLFW_MOD_CONTROL));
  queue.push(key(GLFW_KEY_LEFT_CONTROL, GLFW_RELEASE, GLFW_MOD_CONTROL));
  queue.push(button(GLFW_RELEASE));
  for (const std::size_t expected : {2U, 2U}) EXPECT_EQ(queue.takeFrame(false).size(), expected);
  EXPECT_TRUE(queue.empty());
}

TEST(InputQueue, ButtonsChangeWhereTheCursorIs) {
  InputQueue queue;
  queue.push(cursor(5, 0));
  queue.push(button(GLFW_PRESS));
  queue.push(cursor(10, 0));
  queue.push(cursor(20, 0));
  queue.push(button(GLFW_RELEASE));
  queue.push(cursor(30, 0));
  for (const std::size_t expected : {1U, 1U, 2U, 1U, 1U}) EXPECT_EQ(queue.takeFrame(false).size(), expected);
  EXPECT_TRUE(queue.empty());
}

TEST(InputQueue, HeldKeysRepeatWithinAFrame) {
  InputQueue queue;
  queue.push(key(GLFW_KEY_RIGHT, GLFW_PRESS));
  queue.push(key(GLFW_KEY_RIGHT, GLFW_REPEAT));
  EXPECT_EQ(queue.takeFrame(false).size(), 2U);
}

TEST(InputQueue, PlusAndQuestionMarkNeedNoShift) {
  InputEvent event = key(GLFW_KEY_SLASH, GLFW_PRESS);
  event.modifiers = GLFW_MOD_SHIFT;
  EXPECT_EQ(toString(chordOf(event)), "?");
  EXPECT_EQ(toString(chordOf(key(GLFW_KEY_KP_ADD, GLFW_PRESS))), "+");
  EXPECT_TRUE(chordOf(key(GLFW_KEY_F25, GLFW_PRESS)).key.empty());
  EXPECT_THROW(eventsOf(parseChord("Ctrl+Hyper")), Error);
}

}  // namespace
}  // namespace emscape::view
