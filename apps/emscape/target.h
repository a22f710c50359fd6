/// Where a subcommand computes and draws.
#pragma once

#include <string>

#include "apps/emscape/command.h"
#include "emscape/base/backend.h"
#include "emscape/base/log.h"
#include "emscape/emfield/field_solver.h"
#include "emscape/render/renderer.h"

namespace emscape::app {

/// A processor, and how volumes are kept there.
struct Place {
  BackendChoice choice;
  std::string device_volume = "float";  ///< see addDeviceVolumeOption()

  bool onGpu() const { return choice.backend == Backend::cuda; }
  const std::string& device() const { return choice.device; }
  /// Options with this place in them.
  emfield::FieldOptions fieldOptions() const;
  render::RendererOptions rendererOptions() const;
};

/// --device-volume float|half|sparse
void addDeviceVolumeOption(CLI::App& command, std::string& device_volume);

/// Opens what works where --backend says, and tells where that is; see openOnBackend().
/// @param open  (Place) -> what is to be returned
template <class Open>
auto openAtPlace(const GlobalOptions& global, const std::string& device_volume, const Open& open) {
  return openOnBackend(
      parseBackend(global.backend),
      [&](const BackendChoice& choice) {
        return open(Place{choice, device_volume});
      },
      [](const std::string& line) { logInfo(line); });
}

}  // namespace emscape::app
