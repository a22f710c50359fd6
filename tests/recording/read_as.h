/// Recordings for tests, read by their content.
#pragma once

#include <cstdint>
#include <string>

#include "recording/read_recording.h"
#include "tests/support/temporary_folder.h"

namespace emscape::interop {

inline constexpr std::int64_t kSix_ms = 1780293600000;  ///< 2026-06-01T06:00:00Z

/// Reads a file by its content, as import does.
inline Recording readAs(const std::string& name, const std::string& text, const ReadOptions& options = {}) {
  const test::TemporaryFolder folder;
  return readRecording(folder.write(name, text), options);
}

}  // namespace emscape::interop
