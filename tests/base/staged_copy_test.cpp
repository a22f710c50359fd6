#include "base/cuda/staged_copy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <thread>
#include <vector>

#include "emscape/base/parallel.h"
#include "tests/support/gpu.h"

namespace emscape::cuda {
namespace {

/// True if an array is the same after it was copied to the GPU and back.
bool survives(std::size_t count, int first) {
  std::vector<int> numbers(count), back(count);
  std::iota(numbers.begin(), numbers.end(), first);
  const Stream stream;
  Buffer<int> buffer;
  uploadStaged(buffer, numbers.data(), count, stream);
  downloadStaged(back.data(), buffer.data(), count * sizeof(int), stream);
  return back == numbers;
}

TEST(StagedCopy, KeepsArraysOfAllSizes) {
  EMSCAPE_NEEDS_GPU();
  for (const std::size_t count : {0, 1, 1000, 524288, 524289, 3000001, 9999999}) {
    EXPECT_TRUE(survives(count, -7)) << count;
  }
}

TEST(StagedCopy, SeveralThreadsCopyAtATime) {
  EMSCAPE_NEEDS_GPU();
  std::vector<char> survived(6);
  std::vector<std::thread> threads;
  for (int n = 0; n < 3; ++n) {
    threads.emplace_back([&survived, n] { survived[n] = survives(2000000, 1000 * n) ? 1 : 0; });
  }
  parallelFor(3, 1, [&](int begin, int end) {
    for (int n = begin; n < end; ++n) survived[3 + n] = survives(2000000, -1000 * n) ? 1 : 0;
  });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(std::count(survived.begin(), survived.end(), 1), 6);
}

TEST(StagedCopy, UploadsDataWrittenByTheCaller) {
  EMSCAPE_NEEDS_GPU();
  constexpr std::size_t kCount = 1500000;
  const Stream stream;
  Buffer<int> buffer(kCount);
  const auto fill = [](char* to, std::size_t begin, std::size_t end) {
    int* const numbers = reinterpret_cast<int*>(to);
    for (std::size_t n = begin / sizeof(int); n < end / sizeof(int); ++n)
      numbers[n - begin / sizeof(int)] = static_cast<int>(3 * n);
  };
  uploadStaged(buffer.data(), kCount * sizeof(int), fill, stream);
  std::vector<int> back(kCount);
  buffer.download(back.data(), stream);
  for (std::size_t n = 0; n < kCount; ++n) ASSERT_EQ(back[n], static_cast<int>(3 * n));
}

}  // namespace
}  // namespace emscape::cuda
