#include "base/backend.h"

#include "base/error.h"

namespace emscape {
namespace {

std::string inMiB(std::size_t bytes) {
  constexpr std::size_t kMiB = std::size_t{1} << 20;
  return std::to_string((bytes + kMiB - 1) / kMiB) + " MiB";
}

/// Why the device cannot be used, as half a sentence; empty if it can.
std::string obstacle(const Device& device, std::size_t needed_bytes) {
  if (!device.usable) return device.why_not;
  if (needed_bytes <= device.free_bytes) return {};
  return "this needs " + inMiB(needed_bytes) + " of memory on the GPU, " + device.name + " has " +
         inMiB(device.free_bytes) + " free";
}

}  // namespace

const char* toString(Backend backend) {
  switch (backend) {
    case Backend::automatic:
      return "auto";
    case Backend::cpu:
      return "cpu";
    case Backend::cuda:
      return "cuda";
  }
  return "";
}

Backend parseBackend(const std::string& name) {
  for (const Backend backend : {Backend::automatic, Backend::cpu, Backend::cuda}) {
    if (name == toString(backend)) return backend;
  }
  throw Error(ErrorCode::usage, "backend '" + name + "' must be auto, cpu or cuda");
}

BackendChoice resolveBackend(Backend wish, const Device& device, std::size_t needed_bytes) {
  if (wish == Backend::cpu) return {};
  const std::string why_not = obstacle(device, needed_bytes);
  const bool open = wish == Backend::automatic;
  if (why_not.empty()) return {Backend::cuda, device.name, open ? "running on the GPU: " + device.name : ""};
  if (open) return {Backend::cpu, "cpu", "running on the CPU: " + why_not};
  throw Error(ErrorCode::device, "backend cuda: " + why_not);
}

BackendChoice resolveBackend(Backend wish, std::size_t needed_bytes) {
  return resolveBackend(wish, wish == Backend::cpu ? Device{} : findDevice(), needed_bytes);
}

}  // namespace emscape
