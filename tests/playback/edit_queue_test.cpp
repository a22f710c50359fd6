#include "playback/live/edit_queue.h"

#include <chrono>
#include <thread>

#include "emscape/scenario/file/scenario_file.h"
#include "tests/playback/playback_samples.h"

namespace emscape::playback::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A history whose edits are made by a queue.
struct Edited {
  TemporaryFolder folder;
  EditHistory history{scenario::loadScenario(quickScenario(folder))};
  EditQueue queue{{}};

  std::vector<EditQueue::Outcome> finish() {
    std::vector<EditQueue::Outcome> all;
    do {
      for (EditQueue::Outcome& outcome : queue.update(history)) all.push_back(std::move(outcome));
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } while (queue.isBusy());
    return all;
  }
  void undo() {
    queue.then([this] { history.undo(); });
  }
  double power_w() const { return history.scenario()->emitters.front().power_w; }
};

TEST(EditQueue, MakesEditsInOrderAndLosesNone) {
  Edited edited;
  for (int power_w = 1; power_w <= 5; ++power_w) {
    edited.queue.set({{"emitters.radar.power_w", std::to_string(power_w)}});
  }
  edited.undo();
  EXPECT_TRUE(edited.queue.isBusy());
  EXPECT_EQ(edited.power_w(), 10000);  // nothing is done before update()
  EXPECT_EQ(edited.finish().size(), 5U);
  EXPECT_EQ(edited.power_w(), 4);
  edited.undo();
  edited.undo();
  edited.queue.then([&] { edited.history.redo(); });
  edited.finish();
  EXPECT_EQ(edited.power_w(), 3);
}

TEST(EditQueue, ADragIsOneStepAndItsLastMoveIsMade) {
  Edited edited;
  for (int move = 1; move <= 200; ++move) {
    edited.queue.drag({{"emitters.radar.power_w", std::to_string(move)}});
    edited.queue.update(edited.history);
  }
  EXPECT_TRUE(edited.queue.isDragging());
  edited.queue.endDrag();
  edited.finish();
  EXPECT_EQ(edited.power_w(), 200);
  edited.undo();
  edited.finish();
  EXPECT_EQ(edited.power_w(), 10000);
  EXPECT_FALSE(edited.history.canUndo());
}

TEST(EditQueue, ADragThatIsCancelledLeavesNoStep) {
  Edited edited;
  edited.queue.drag({{"emitters.radar.power_w", "7"}});
  edited.finish();
  EXPECT_EQ(edited.power_w(), 7);
  edited.queue.drag({{"emitters.radar.power_w", "8"}});
  edited.queue.cancelDrag();
  edited.finish();
  EXPECT_EQ(edited.power_w(), 10000);
  EXPECT_FALSE(edited.history.canUndo());
}

TEST(EditQueue, ClearingWithinADragTakesItBack) {
  Edited edited;
  edited.queue.drag({{"emitters.radar.power_w", "7"}});
  edited.finish();
  edited.queue.clear(edited.history);
  EXPECT_EQ(edited.power_w(), 10000);
  edited.queue.endDrag();
  edited.queue.set({{"emitters.radar.power_w", "9"}});
  edited.finish();
  edited.undo();
  edited.finish();
  EXPECT_EQ(edited.power_w(), 10000);
  EXPECT_FALSE(edited.history.canUndo());
}

TEST(EditQueue, RefusedEditKeepsTheScenarioAndHasAReason) {
  Edited edited;
  edited.queue.set({{"emitters.radar.power_w", "-5"}});
  edited.queue.set({{"emitters.radar.losses_db", "4"}});
  const std::vector<EditQueue::Outcome> outcomes = edited.finish();
  ASSERT_EQ(outcomes.size(), 2U);
  EXPECT_THAT(outcomes[0].edits, ElementsAre(scenario::Edit{"emitters.radar.power_w", "-5"}));
  EXPECT_THAT(outcomes[0].error, HasSubstr("emitters.radar.power_w=-5: 'power_w' is -5"));
  EXPECT_EQ(outcomes[1].error, "");
  EXPECT_EQ(edited.power_w(), 10000);
  EXPECT_EQ(edited.history.scenario()->emitters.front().losses_db, 4);
}

TEST(EditQueue, EditsApplyToScenarioOfTheHistory) {
  Edited edited;
  edited.queue.set({{"emitters.radar.power_w", "5"}});
  edited.queue.update(edited.history);  // begins
  edited.history.set("emitters.radar.losses_db", "9");
  edited.finish();
  EXPECT_EQ(edited.power_w(), 5);
  EXPECT_EQ(edited.history.scenario()->emitters.front().losses_db, 9);
  edited.queue.set({{"emitters.radar.power_w", "6"}});
  edited.queue.update(edited.history);
  edited.queue.clear(edited.history);
  EXPECT_FALSE(edited.queue.isBusy());
  EXPECT_TRUE(edited.finish().empty());
  EXPECT_EQ(edited.power_w(), 5);
}

}  // namespace
}  // namespace emscape::playback::test
