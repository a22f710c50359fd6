/// Error messages for a status line. Internal to the module.
#pragma once

#include <exception>
#include <string>

#include "base/text/failure_text.h"
#include "emscape/base/error.h"

namespace emscape::playback {

inline ErrorCode codeOf(const std::exception& failure) {
  const auto* error = dynamic_cast<const Error*>(&failure);
  return error != nullptr ? error->code() : ErrorCode::other;
}

/// The first line of a failure; for a device, with a remedy.
inline std::string failureLine(const std::exception& failure) {
  const std::string what = failureText(failure);
  const char* help = codeOf(failure) == ErrorCode::device ? "; --backend cpu computes without the GPU" : "";
  return what.substr(0, what.find('\n')) + help;
}

}  // namespace emscape::playback
