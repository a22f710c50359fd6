// Recordings of streams whose disk becomes full.
#include "playback/stream/stream_recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
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
