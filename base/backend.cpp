#include "emscape/base/backend.h"

namespace emscape {
Backend parseBackend(const std::string& name) {
  for (const Backend backend : {Backend::automatic, Backend::cpu, Backend::cuda}) {
    if (name == toString(backend)) return backend;
  }
  throw Error(ErrorCode::usage, "backend '" + name + "' must be auto, cpu or cuda");
}

ResolvedBackend resolveBackend(Backend requested, const Device& device) {
  if (requested == Backend::cpu) return {};
  const bool open = requested == Backend::automatic;
  if (device.usable) return {Backend::cuda, device.name, open ? "running on the GPU: " + device.name : ""};
  if (open) return {Backend::cpu, "cpu", "running on the CPU: " + device.why_not};
  throw Error(ErrorCode::device, "backend cuda: " + device.why_not);
}

ResolvedBackend resolveBackend(Backend requested) {
  return resolveBackend(requested, requested == Backend::cpu ? Device{} : findDevice());
}

}  // namespace emscape
