#include "apps/view/parts/undo_order.h"

#include <gtest/gtest.h>

namespace emscape::view {
namespace {

TEST(UndoOrder, UndoesLatestStepFirst) {
  UndoOrder order;
  EXPECT_FALSE(order.undo());
  order.note(History::scenario, 1, 1);
  order.note(History::transfer, 2, 2);
  order.note(History::scenario, 1, 1);  // nothing new
  order.note(History::scenario, 2, 2);
  EXPECT_EQ(order.undo(), History::scenario);
  EXPECT_EQ(order.undo(), History::transfer);
  EXPECT_EQ(order.redo(), History::transfer);
  EXPECT_TRUE(order.canRedo());
  order.note(History::transfer, 3, 3);
  EXPECT_FALSE(order.canRedo()) << "what was undone is gone";
  EXPECT_EQ(order.undo(), History::transfer);
}

TEST(UndoOrder, ForgetsStepsThatTheirHistoryDoesNotKeep) {
  UndoOrder order;
  order.note(History::scenario, 1, 1);
  order.note(History::planes, 1, 1);
  order.note(History::scenario, 3, 2);
  EXPECT_EQ(order.undo(), History::scenario);
  EXPECT_EQ(order.undo(), History::scenario);
  EXPECT_EQ(order.undo(), History::planes);
  EXPECT_FALSE(order.canUndo());
  EXPECT_EQ(order.redo(), History::planes);
}

TEST(UndoOrder, ForgetsAHistoryThatRestarts) {
  UndoOrder order;
  order.note(History::transfer, 3, 3);
  order.note(History::scenario, 1, 1);
  order.forget(History::transfer);
  order.note(History::transfer, 0, 0);
  EXPECT_EQ(order.undo(), History::scenario);
  EXPECT_FALSE(order.canUndo());
}

}  // namespace
}  // namespace emscape::view
