// Recordings of streams.
#include "playback/stream/stream_recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <thread>
#include <vector>

#include "emscape/base/error.h"
#include "tests/support/errors.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/files.h"
#include "tests/support/temporary_folder.h"

namespace emscape::playback {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

void record(StreamRecorder& recorder, int datagrams) {
  const std::vector<std::uint8_t> bytes(1000, 7);
  for (int n = 0; n < datagrams; ++n) recorder.write(bytes.data(), bytes.size(), 1e9 + n);
}

TEST(StreamRecorder, ADiskThatBecomesFullLeavesWholeRecordsAndItsCause) {
  const test::TemporaryFolder folder;
  StreamRecorder recorder(folder / "r.pcap", ".pcap", false);
  {
    const test::FileSizeLimit limit(100000);
    record(recorder, 200);
  }
  EXPECT_THAT(recorder.failure(), AllOf(HasSubstr(folder / "r.pcap"), HasSubstr("the recording ends here"),
                                        HasSubstr("File too large")));
  EXPECT_EQ(test::errorOf([&] { recorder.finish(); }, ErrorCode::other), recorder.failure());
  constexpr std::size_t kHead = 24, kRecord = 16 + 28 + 1000;
  const std::size_t size = test::readFile(folder / "r.pcap").size();
  EXPECT_GT(size, kHead + 50 * kRecord);
  EXPECT_EQ((size - kHead) % kRecord, 0u);
}

TEST(StreamRecorder, WithoutASingleRecordLeavesNoFile) {
  const test::TemporaryFolder folder;
  StreamRecorder recorder(folder / "r.pcap", ".pcap", false);
  {
    const test::FileSizeLimit limit(100);
    record(recorder, 200);
  }
  EXPECT_THAT(test::errorOf([&] { recorder.finish(); }, ErrorCode::other), HasSubstr("File too large"));
  EXPECT_FALSE(std::filesystem::exists(folder / "r.pcap"));
}

// An exercise cannot be repeated: nothing of it waits for the end.
TEST(StreamRecorder, HasItsNameFromTheBeginningAndGrowsEachSecond) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "r.pcap";
  StreamRecorder recorder(file, ".pcap", false);
  EXPECT_THAT(test::errorOf([&] { StreamRecorder second(file, ".pcap", false); }, ErrorCode::usage),
              HasSubstr("r.pcap exists"));
  record(recorder, 1);
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  recorder.keepUp();
  EXPECT_EQ(test::readFile(file).size(), 24u + 16 + 28 + 1000) << "as a killed process leaves it";
  test::writeFile(folder / "mine", "of the user");
  std::filesystem::rename(folder / "mine", file);
  record(recorder, 1);
  recorder.finish();
  EXPECT_EQ(test::readFile(file), "of the user");
}

TEST(StreamRecorder, ReplacesAFileByTheFirstRecordAndLeavesNoneWithoutAny) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "r.pcap";
  { StreamRecorder unused(file, ".pcap", false); }
  EXPECT_FALSE(std::filesystem::exists(file));
  test::writeFile(file, "of the user");
  { StreamRecorder unused(file, ".pcap", true); }
  StreamRecorder(file, ".pcap", true).finish();
  EXPECT_EQ(test::readFile(file), "of the user");
  StreamRecorder recorder(file, ".pcap", true);
  record(recorder, 100);
  EXPECT_GT(test::readFile(file).size(), 60000u);
}

TEST(StreamRecorder, WritesAllOfItsRecords) {
  const test::TemporaryFolder folder;
  StreamRecorder recorder(folder / "r.pcap", ".pcap", false);
  record(recorder, 200);
  recorder.finish();
  EXPECT_EQ(test::readFile(folder / "r.pcap").size(), 24u + 200 * (16 + 28 + 1000));
}

}  // namespace
}  // namespace emscape::playback
