#include "base/backend.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"

namespace emscape {
namespace {

using testing::HasSubstr;

Device someGpu() {
  Device device;
  device.usable = true;
  device.name = "GPU of the test";
  device.total_bytes = std::size_t{2} << 30;
  device.free_bytes = std::size_t{1} << 30;
  return device;
}

Device noGpu() {
  Device device;
  device.why_not = "no GPU answers";
  return device;
}

std::string messageOf(Backend wish, const Device& device, std::size_t needed_bytes) {
  try {
    resolveBackend(wish, device, needed_bytes);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::device);
    return error.what();
  }
  return "";
}

TEST(Backend, NamesAreReadAsTheyAreWritten) {
  for (const Backend backend : {Backend::automatic, Backend::cpu, Backend::cuda}) {
    EXPECT_EQ(parseBackend(toString(backend)), backend);
  }
}

TEST(Backend, UnknownNameIsAUsageError) {
  try {
    parseBackend("gpu");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_STREQ(error.what(), "backend 'gpu' must be auto, cpu or cuda");
  }
}

TEST(Backend, AutoTakesTheGpuThatAnswersAndSaysSo) {
  const BackendChoice choice = resolveBackend(Backend::automatic, someGpu());
  EXPECT_EQ(choice.backend, Backend::cuda);
  EXPECT_EQ(choice.device, "GPU of the test");
  EXPECT_EQ(choice.note, "running on the GPU: GPU of the test");
}

TEST(Backend, AutoFallsToTheCpuWithoutAGpuAndSaysWhy) {
  const BackendChoice choice = resolveBackend(Backend::automatic, noGpu());
  EXPECT_EQ(choice.backend, Backend::cpu);
  EXPECT_EQ(choice.device, "cpu");
  EXPECT_EQ(choice.note, "running on the CPU: no GPU answers");
}

TEST(Backend, AutoFallsToTheCpuWithTooLittleMemoryAndTellsBothFigures) {
  const BackendChoice choice = resolveBackend(Backend::automatic, someGpu(), std::size_t{3} << 30);
  EXPECT_EQ(choice.backend, Backend::cpu);
  EXPECT_EQ(
      choice.note,
      "running on the CPU: this needs 3072 MiB of memory on the GPU, GPU of the test has 1024 MiB free");
}

TEST(Backend, WhatIsAskedForIsTakenWithoutAWord) {
  EXPECT_EQ(resolveBackend(Backend::cpu, someGpu()).backend, Backend::cpu);
  EXPECT_EQ(resolveBackend(Backend::cpu, someGpu()).note, "");
  EXPECT_EQ(resolveBackend(Backend::cuda, someGpu(), 1 << 20).backend, Backend::cuda);
  EXPECT_EQ(resolveBackend(Backend::cuda, someGpu(), 1 << 20).note, "");
}

TEST(Backend, DemandedCudaThatCannotBeHadIsADeviceError) {
  EXPECT_EQ(messageOf(Backend::cuda, noGpu(), 0), "backend cuda: no GPU answers");
  EXPECT_THAT(messageOf(Backend::cuda, someGpu(), std::size_t{3} << 30), HasSubstr("needs 3072 MiB"));
}

TEST(Backend, TheMachinesOwnAnswerIsOneOfTheTwo) {
  const BackendChoice choice = resolveBackend(Backend::automatic);
  EXPECT_NE(choice.backend, Backend::automatic);
  EXPECT_THAT(choice.note, HasSubstr("running on the "));
}

}  // namespace
}  // namespace emscape
