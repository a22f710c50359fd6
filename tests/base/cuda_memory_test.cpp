#include "base/cuda/cuda_memory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <numeric>

#include "tests/base/lose_device.h"
#include "tests/support/errors.h"
#include "tests/support/gpu.h"

namespace emscape::cuda {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(CudaMemory, RoundTripIsExact) {
  EMSCAPE_NEEDS_GPU();
  std::vector<int> numbers(1000);
  std::iota(numbers.begin(), numbers.end(), -7);
  Buffer<int> buffer;
  buffer.upload(numbers);
  const Buffer<int> moved = std::move(buffer);
  std::vector<int> back(moved.size());
  moved.download(back.data());
  EXPECT_EQ(back, numbers);
}

TEST(CudaMemory, AValueIsReadBackWithoutWaiting) {
  EMSCAPE_NEEDS_GPU();
  const Stream stream;
  Buffer<int> value;
  Readback<int> readback;
  EXPECT_EQ(readback.arrived(), nullptr) << "nothing was asked for";
  for (const int number : {17, -4}) {
    value.upload({number}, stream);
    readback.request(value.data(), stream);
    stream.wait();
    ASSERT_NE(readback.arrived(), nullptr);
    EXPECT_EQ(*readback.arrived(), number);
  }
}

TEST(CudaMemory, ExcessiveSizeIsNamed) {
  EMSCAPE_NEEDS_GPU();
  const std::size_t bytes = std::size_t{1} << 50;
  EXPECT_THAT(test::errorOf([=] { Buffer<char> buffer(bytes); }, ErrorCode::device),
              AllOf(HasSubstr("GPU: cudaMalloc of " + std::to_string(bytes) + " bytes"),
                    HasSubstr("cudaErrorMemoryAllocation")));
}

TEST(CudaLostDevice, IsAnErrorThatNamesCallAndKernel) {
  EMSCAPE_NEEDS_GPU();
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // a process of its own: this one's device is to live on
  const auto lose = [] {
    Buffer<int> buffer(10);
    test::loseDevice();
    std::vector<int> numbers(10);
    const std::string message = test::errorOf([&] { buffer.download(numbers.data()); }, ErrorCode::device);
    std::fprintf(stderr, "%s\n", message.c_str());
    std::_Exit(message.empty() ? 1 : 0);
  };
  EXPECT_EXIT(lose(), testing::ExitedWithCode(0),
              "GPU: cuda[A-Za-z ]*: .*cudaError(LaunchFailure|IllegalInstruction).*; the last kernel "
              "launched was fault");
}

}  // namespace
}  // namespace emscape::cuda
