#include "emscape/base/backend.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/errors.h"

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

TEST(Backend, NamesAreReadAsTheyAreWritten) {
  for (const Backend backend : {Backend::automatic, Backend::cpu, Backend::cuda}) {
    EXPECT_EQ(parseBackend(toString(backend)), backend);
  }
}

TEST(Backend, UnknownNameIsAUsageError) {
  EXPECT_EQ(test::errorOf([] { parseBackend("gpu"); }, ErrorCode::usage),
            "backend 'gpu' must be auto, cpu or cuda");
}

TEST(Backend, AutoTakesAvailableGpuAndReportsIt) {
  const ResolvedBackend choice = resolveBackend(Backend::automatic, someGpu());
  EXPECT_EQ(choice.backend, Backend::cuda);
  EXPECT_EQ(choice.device, "GPU of the test");
  EXPECT_EQ(choice.note, "running on the GPU: GPU of the test");
}

TEST(Backend, AutoWithoutGpuTakesCpuAndReportsWhy) {
  const ResolvedBackend choice = resolveBackend(Backend::automatic, noGpu());
  EXPECT_EQ(choice.backend, Backend::cpu);
  EXPECT_EQ(choice.device, "cpu");
  EXPECT_EQ(choice.note, "running on the CPU: no GPU answers");
}

TEST(Backend, RequestedBackendIsTakenSilently) {
  EXPECT_EQ(resolveBackend(Backend::cpu, someGpu()).backend, Backend::cpu);
  EXPECT_EQ(resolveBackend(Backend::cpu, someGpu()).note, "");
  EXPECT_EQ(resolveBackend(Backend::cuda, someGpu()).backend, Backend::cuda);
  EXPECT_EQ(resolveBackend(Backend::cuda, someGpu()).note, "");
}

TEST(Backend, RequestedCudaWithoutGpuIsADeviceError) {
  EXPECT_EQ(test::errorOf([] { resolveBackend(Backend::cuda, noGpu()); }, ErrorCode::device),
            "backend cuda: no GPU answers");
}

TEST(Backend, BackendOfThisMachineIsCpuOrCuda) {
  const ResolvedBackend choice = resolveBackend(Backend::automatic);
  EXPECT_NE(choice.backend, Backend::automatic);
  EXPECT_THAT(choice.note, HasSubstr("running on the "));
}

TEST(Backend, BackendIsReportedOnce) {
  std::vector<std::string> told;
  const auto tell = [&told](const std::string& line) { told.push_back(line); };
  const auto backendOf = [](const ResolvedBackend& choice) { return choice.backend; };
  EXPECT_EQ(withBackendFallback(Backend::cpu, backendOf, tell), Backend::cpu);
  EXPECT_TRUE(told.empty());
  EXPECT_EQ(withBackendFallback(Backend::automatic, backendOf, tell),
            resolveBackend(Backend::automatic).backend);
  EXPECT_EQ(told.size(), 1U);
}

TEST(Backend, AutoWithTooLittleGpuMemoryTakesCpuAndReportsBytes) {
  if (!findDevice().usable) GTEST_SKIP() << findDevice().why_not;
  const auto open = [](const ResolvedBackend& choice) {
    if (choice.backend == Backend::cuda) throw Error(ErrorCode::device, "GPU: 2 MiB needed, 1 MiB free");
    return choice.device;
  };
  std::vector<std::string> told;
  const auto tell = [&told](const std::string& line) { told.push_back(line); };
  EXPECT_EQ(withBackendFallback(Backend::automatic, open, tell), "cpu");
  EXPECT_EQ(told.back(), "running on the CPU: GPU: 2 MiB needed, 1 MiB free");
  EXPECT_THROW(withBackendFallback(Backend::cuda, open, tell), Error);
}

}  // namespace
}  // namespace emscape
