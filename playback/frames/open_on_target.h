/// The choice of the processor by the name of a backend.
#pragma once

#include <string>

#include "emscape/base/backend.h"
#include "emscape/base/log.h"
#include "emscape/playback/frames/compute_target.h"

namespace emscape::playback {

/// Calls open() for a backend, and logs the choice; see withBackendFallback().
/// @param backend  auto, cpu or cuda  @param open  (ComputeTarget) -> the result
template <class Open>
auto openOnTarget(const std::string& backend, const Open& open,
                  volume::VoxelPrecision precision = volume::VoxelPrecision::float32) {
  return withBackendFallback(
      parseBackend(backend),
      [&](const ResolvedBackend& choice) {
        return open(ComputeTarget{choice, precision});
      },
      [](const std::string& line) { logInfo(line); });
}

}  // namespace emscape::playback
