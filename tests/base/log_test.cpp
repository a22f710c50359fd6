#include "emscape/base/log.h"

#include <gtest/gtest.h>

#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "emscape/base/parallel.h"

namespace emscape {
namespace {

/// Collects the messages logged during its lifetime.
class LogTest : public testing::Test {
 protected:
  LogTest() {
    setLogSink([this](LogLevel level, const std::string& message) {
      const std::lock_guard<std::mutex> lock(mutex_);
      lines_.emplace_back(level, message);
    });
  }
  ~LogTest() override { setLogSink({}); }

  std::mutex mutex_;
  std::vector<std::pair<LogLevel, std::string>> lines_;
};

TEST_F(LogTest, CarriesLevelAndMessage) {
  logDebug("fan of 3 emitters");
  logInfo("terrain read");
  logWarning("gain outside the table");
  const std::vector<std::pair<LogLevel, std::string>> expected = {
      {LogLevel::debug, "fan of 3 emitters"},
      {LogLevel::info, "terrain read"},
      {LogLevel::warning, "gain outside the table"}};
  EXPECT_EQ(lines_, expected);
}

TEST_F(LogTest, IsSilentWithoutASink) {
  setLogSink({});
  logWarning("nobody hears this");
  EXPECT_TRUE(lines_.empty());
}

TEST_F(LogTest, TakesMessagesFromManyThreads) {
  parallelFor(1000, 1, [](int begin, int end) {
    for (int i = begin; i < end; ++i) logInfo(std::to_string(i));
  });
  EXPECT_EQ(lines_.size(), 1000u);
}

TEST(LogSink, MayLogWaitForAThreadThatLogsAndReplaceItself) {
  std::vector<std::string> lines;
  setLogSink([&lines](LogLevel, const std::string& message) {
    lines.push_back(message);
    if (message != "first") return;
    logInfo("second");
    std::thread([] { logInfo("third"); }).join();
    setLogSink({});
    logInfo("nobody hears this");
  });
  logInfo("first");
  EXPECT_EQ(lines, (std::vector<std::string>{"first", "second", "third"}));
}

}  // namespace
}  // namespace emscape
