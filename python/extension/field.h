/// The Python object of the field at one instant.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "emscape/playback/frames/inputs.h"
#include "emscape/volume/volume.h"

namespace emscape::python {

/// Volumes of one instant, in the order of their names. Shares their values, which later updates do not
/// change. Thread-safe.
struct Field {
  std::vector<std::string> names;
  std::vector<volume::Volume> volumes;
  double time_s = 0;
  std::optional<playback::LoadedScenario> scene;           ///< empty: read from a file
  std::shared_ptr<const std::vector<float>> ground_msl_m;  ///< one per column; may be null
  mutable std::vector<std::shared_ptr<const volume::DenseVolume>>
      on_host;  ///< one per volume; null: not yet requested
  mutable std::vector<std::shared_ptr<const float>>
      on_device;             ///< in linear memory; one per volume; null: not yet requested
  mutable std::mutex mutex;  ///< protects on_host and on_device

  /// @param name  empty: the first. @throws Error (usage) that lists the names
  std::size_t indexOf(const std::string& name) const;
  /// The values in host memory; copied from a GPU at most once.
  const std::shared_ptr<const volume::DenseVolume>& host(std::size_t index) const;
  /// The values of a volume on a GPU in its linear memory, in the order of host(); copied there at most once.
  const std::shared_ptr<const float>& device(std::size_t index) const;
};

}  // namespace emscape::python
