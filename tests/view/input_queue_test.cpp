#include "apps/view/session/input_queue.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "emscape/base/error.h"

namespace emscape::view {
namespace {

InputEvent key(int code, int action) {
  return {InputEvent::Kind::key, code, 0, action, 0, 0, 0};
}
InputEvent cursor(double x, double y) {
  return {InputEvent::Kind::cursor, 0, 0, 0, 0, x, y};
}

TEST(InputQueue, PressAndReleaseOfAKeyComeInTwoFrames) {
  InputQueue queue;
  queue.push(key(GLFW_KEY_SPACE, GLFW_PRESS));
  queue.push(key(GLFW_KEY_SPACE, GLFW_RELEASE));
  EXPECT_EQ(queue.takeFrame().size(), 1U);
  EXPECT_FALSE(queue.empty());
  EXPECT_EQ(queue.takeFrame().size(), 1U);
  EXPECT_TRUE(queue.empty());
}

TEST(InputQueue, DifferentKeysAndMovementsShareAFrameInOrder) {
  InputQueue queue;
  queue.push(key(GLFW_KEY_A, GLFW_PRESS));
  queue.push(cursor(1, 2));
  queue.push(key(GLFW_KEY_B, GLFW_PRESS));
  queue.push(cursor(3, 4));
  const std::vector<InputEvent> frame = queue.takeFrame();
  ASSERT_EQ(frame.size(), 4U);
  EXPECT_EQ(frame[2].code, GLFW_KEY_B);
  EXPECT_DOUBLE_EQ(frame[3].x, 3);
}

TEST(InputQueue, ButtonsChangeWhereTheCursorIs) {
  InputQueue queue;
  queue.push(cursor(5, 0));
  queue.push({InputEvent::Kind::button, 0, 0, GLFW_PRESS, 0, 0, 0});
  queue.push(cursor(10, 0));
  queue.push(cursor(20, 0));
  queue.push({InputEvent::Kind::button, 0, 0, GLFW_RELEASE, 0, 0, 0});
  queue.push(cursor(30, 0));
  for (const std::size_t expected : {1U, 1U, 2U, 1U, 1U}) EXPECT_EQ(queue.takeFrame().size(), expected);
  EXPECT_TRUE(queue.empty());
}

TEST(InputQueue, HeldKeysRepeatWithinAFrame) {
  InputQueue queue;
  queue.push(key(GLFW_KEY_RIGHT, GLFW_PRESS));
  queue.push(key(GLFW_KEY_RIGHT, GLFW_REPEAT));
  EXPECT_EQ(queue.takeFrame().size(), 2U);
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
