#include "playback/live/mailbox.h"

#include <gtest/gtest.h>

#include <thread>

namespace emscape::playback {
namespace {

TEST(Mailbox, TheLatestValueWinsAndIsTakenOnce) {
  Event event;
  Mailbox<int> box(event);
  EXPECT_TRUE(box.isEmpty());
  box.put(1);
  box.put(2);
  EXPECT_FALSE(box.isEmpty());
  EXPECT_EQ(box.take()->value, 2);
  EXPECT_FALSE(box.take());
}

TEST(Mailbox, ValueHasWaitingTimeOfOldestReplacedOne) {
  Event event;
  Mailbox<int> box(event);
  const Mailbox<int>::Time first{std::chrono::seconds(5)};
  box.put(1, first + std::chrono::seconds(1));
  box.put(2, first);
  box.put(3, first + std::chrono::seconds(2));
  const auto letter = box.take();
  EXPECT_EQ(letter->value, 3);
  EXPECT_EQ(letter->since, first);
  box.put(4, first + std::chrono::seconds(3));
  EXPECT_EQ(box.take()->since, first + std::chrono::seconds(3)) << "what was taken waits no more";
}

TEST(Mailbox, AValueWakesTheThreadThatWaits) {
  Event event;
  Mailbox<int> box(event);
  int taken = 0;
  std::thread reader([&] {
    while (taken != 100) {
      event.wait();
      if (const auto letter = box.take()) taken = letter->value;
    }
  });
  for (int value = 1; value <= 100; ++value) box.put(value);
  reader.join();
  EXPECT_EQ(taken, 100);
}

}  // namespace
}  // namespace emscape::playback
