#include "base/memory.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "base/control_group.h"
#include "base/limits/address_limit.h"

namespace emscape {
namespace {

std::optional<std::size_t> numberIn(const char* file) {
  std::ifstream in(file);
  std::size_t number = 0;
  if (in >> number) return number;
  return std::nullopt;  // no such file, or "max"
}

/// MemAvailable of Linux.
std::optional<std::size_t> systemBytes() {
  std::ifstream in("/proc/meminfo");
  std::string key, unit;
  for (std::size_t kibibytes = 0; in >> key >> kibibytes; std::getline(in, unit)) {
    if (key == "MemAvailable:") return kibibytes << 10;
  }
  return std::nullopt;
}

/// Remainder of the limit on the address space.
std::optional<std::size_t> addressBytes() {
  const auto limit = addressLimit_bytes(), pages = numberIn("/proc/self/statm");
  if (!limit || !pages) return std::nullopt;
  const std::size_t taken = *pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return *limit > taken ? *limit - taken : 0;
}

}  // namespace

std::optional<std::size_t> availableMemory_bytes() {
  std::optional<std::size_t> least;
  for (const auto& bytes : {systemBytes(), ControlGroups().memoryLeft_bytes(), addressBytes()}) {
    if (bytes) least = std::min(least.value_or(*bytes), *bytes);
  }
  return least;
}

std::string memoryShortage(const MemoryNeed& need, const char* whose, std::size_t free_bytes) {
  constexpr double kMebibyte = 1 << 20;
  return fmt::format("{} needs up to {:.0f} MiB of the {} memory, of which {:.0f} MiB are free; {}",
                     need.what, static_cast<double>(need.needed_bytes) / kMebibyte, whose,
                     static_cast<double>(free_bytes) / kMebibyte, need.remedy);
}

void requireMemory(const MemoryNeed& need, const SourceLocation& location) {
  const std::optional<std::size_t> free_bytes = availableMemory_bytes();
  if (!free_bytes || need.needed_bytes <= *free_bytes) return;
  throw Error(ErrorCode::other, location, memoryShortage(need, "host's", *free_bytes));
}

}  // namespace emscape
