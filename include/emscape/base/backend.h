/// The requested backend, and the backend that is used for the request on this machine.
#pragma once

#include <array>
#include <string>

#include "emscape/base/cuda/device.h"
#include "emscape/base/enum_names.h"
#include "emscape/base/error.h"

namespace emscape {

enum class Backend {
  automatic,  ///< the GPU if there is a usable one, else the CPU
  cpu,
  cuda
};
constexpr auto namesOf(Backend) {
  return std::array{"auto", "cpu", "cuda"};
}

/// @throws Error (usage) for any other name
Backend parseBackend(const std::string& name);

/// The backend that is used for a request on this machine.
struct ResolvedBackend {
  Backend backend = Backend::cpu;  ///< cpu or cuda
  std::string device = "cpu";      ///< "cpu", or the name of the GPU; for reports
  std::string note;  ///< with automatic: one line that names the chosen backend and the reason; else empty
};

/// @param device  what findDevice() found
/// @throws Error (device) if cuda is requested and the device cannot be used
ResolvedBackend resolveBackend(Backend requested, const Device& device);

/// Calls findDevice(), unless the CPU is requested.
ResolvedBackend resolveBackend(Backend requested);

/// Calls open() for the requested backend. With Backend::automatic, if the GPU fails, calls it again for the
/// CPU.
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
