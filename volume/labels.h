/// Names of the indices of categorical volumes.
#pragma once

#include <string>
#include <vector>

#include "emscape/volume/dense_volume.h"

namespace emscape::volume {

/// Key of VolumeInfo::extra: the names of the indices 0, 1 ... of a categorical volume, one per line.
constexpr const char* kLabelsKey = "labels";

/// The names; empty if there are none.
std::vector<std::string> labelsOf(const VolumeInfo& info);

}  // namespace emscape::volume
