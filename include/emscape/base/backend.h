/// Which processor does the work: what was asked for, and what that comes to on this machine.
#pragma once

#include <string>

#include "emscape/base/device.h"
#include "emscape/base/error.h"

namespace emscape {

enum class Backend {
  automatic,  ///< a wish: the GPU if there is one that can, else the CPU
  cpu,
  cuda
};

/// "auto", "cpu" or "cuda".
const char* toString(Backend backend);
/// @throws Error (usage) for any other name
Backend parseBackend(const std::string& name);

/// A wish come true.
struct BackendChoice {
  Backend backend = Backend::cpu;  ///< cpu or cuda
  std::string device = "cpu";      ///< for reports: "cpu", or the name of the GPU
  std::string note;                ///< where the wish left it open: in a line, what was taken and why
};

/// @param device  what findDevice() found
/// @throws Error (device) if cuda is asked for and the device cannot be used
BackendChoice resolveBackend(Backend wish, const Device& device);

/// Asks findDevice(), unless the CPU is asked for.
BackendChoice resolveBackend(Backend wish);

/// Opens what is to compute where a wish says. Where that is left open and the GPU fails, for want of memory
/// or otherwise, the same is opened on the CPU.
/// @param open  (BackendChoice) -> what is to be returned
/// @param tell  (std::string): is given a line for the user; not called where the choice was the user's
/// @throws as resolveBackend() and `open`
template <class Open, class Tell>
auto openOnBackend(Backend wish, const Open& open, const Tell& tell) {
  const BackendChoice choice = resolveBackend(wish);
  if (!choice.note.empty()) tell(choice.note);
  if (wish != Backend::automatic || choice.backend == Backend::cpu) return open(choice);
  try {
    return open(choice);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::device) throw;
    tell(std::string("running on the CPU: ") + error.what());
  }
  return open(BackendChoice{});
}

}  // namespace emscape
