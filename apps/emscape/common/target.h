/// The processor on which a subcommand computes and draws.
#pragma once

#include <string>

#include "apps/emscape/common/command.h"
#include "emscape/base/backend.h"
#include "emscape/base/log.h"
#include "emscape/playback/frames/compute_target.h"

namespace emscape::app {

using playback::ComputeTarget;

/// Adds --device-volume float|half|sparse.
void addDeviceVolumeOption(CLI::App& command, std::string& device_volume);
/// The value of that option.
volume::VoxelPrecision precisionOf(const std::string& device_volume);

/// Calls open() for the backend of --backend, and logs the choice; see withBackendFallback().
/// @param open  (ComputeTarget) -> the result
template <class Open>
auto openOnTarget(const GlobalOptions& global, const std::string& device_volume, const Open& open) {
  return withBackendFallback(
      parseBackend(global.backend),
      [&](const ResolvedBackend& choice) {
        return open(ComputeTarget{choice, precisionOf(device_volume)});
      },
      [](const std::string& line) { logInfo(line); });
}

}  // namespace emscape::app
