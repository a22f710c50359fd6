// To be preloaded into a program: loses its GPU as soon as a file is there.
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/base/lose_device.h"

namespace emscape::test {
namespace {

/// The program's work is in the same context: CUDA has one of each device and process.
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
  unsetenv(kSign);  // programs that this one starts are left alone
  return true;
}

[[maybe_unused]] const bool kWatches = watch();

}  // namespace
}  // namespace emscape::test
