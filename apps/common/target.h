/// The processor on which a subcommand computes and draws.
#pragma once

#include <string>

#include "apps/common/command.h"
#include "playback/frames/open_on_target.h"

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
  return playback::openOnTarget(global.backend, open, precisionOf(device_volume));
}

}  // namespace emscape::app
