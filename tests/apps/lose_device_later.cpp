// To be preloaded into a program: makes it lose its GPU as soon as a file exists.
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/base/lose_device.h"

namespace emscape::test {
namespace {

/// The program uses the same context, as CUDA has one per device and process.
void loseDeviceAt(const std::string& sign) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  std::error_code ignored;
  while (!std::filesystem::exists(sign, ignored)) {
    if (std::chrono::steady_clock::now() > end) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  loseDevice();
}

bool watch() {
  constexpr const char* kSign = "EMSCAPE_LOSE_DEVICE_AT";
  const char* const sign = std::getenv(kSign);
  if (sign == nullptr) return false;
  std::thread(loseDeviceAt, std::string(sign)).detach();
  unsetenv(kSign);  // not for programs that this one starts
  return true;
}

[[maybe_unused]] const bool kWatches = watch();

}  // namespace
}  // namespace emscape::test
