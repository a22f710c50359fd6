/// Which processor does the work: what was requested, and what that resolves to on this machine.
#pragma once

#include <string>

#include "emscape/base/device.h"
#include "emscape/base/error.h"

namespace emscape {

enum class Backend {
  automatic,  ///< the GPU if there is one that can, else the CPU
  cpu,
  cuda
};

/// "auto", "cpu" or "cuda".
const char* toString(Backend backend);
/// @throws Error (usage) for any other name
Backend parseBackend(const std::string& name);

/// The backend that a request resolves to on this machine.
struct ResolvedBackend {
  Backend backend = Backend::cpu;  ///< cpu or cuda
  std::string device = "cpu";      ///< for reports: "cpu", or the name of the GPU
  std::string note;                ///< automatic was requested: one line, what was taken and why
};

/// @param device  what findDevice() found
/// @throws Error (device) if cuda is requested and the device cannot be used
ResolvedBackend resolveBackend(Backend requested, const Device& device);

/// Calls findDevice(), unless the CPU is requested.
ResolvedBackend resolveBackend(Backend requested);

/// Constructs something on the requested backend. With Backend::automatic, where the GPU fails for lack of
/// memory or otherwise, constructs the same on the CPU.
/// @param open  (ResolvedBackend) -> the result
/// @param tell  (std::string): receives one line for the user; called for Backend::automatic only
/// @throws as resolveBackend() and `open`
template <class Open, class Tell>
auto withBackendFallback(Backend requested, const Open& open, const Tell& tell) {
  const ResolvedBackend resolved = resolveBackend(requested);
  if (!resolved.note.empty()) tell(resolved.note);
  if (requested != Backend::automatic || resolved.backend == Backend::cpu) return open(resolved);
  try {
    return open(resolved);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::device) throw;
    tell(std::string("running on the CPU: ") + error.what());
  }
  return open(ResolvedBackend{});
}

}  // namespace emscape
