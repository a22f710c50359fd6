/// Warnings of ground that is too steep for the marches of emitters by `parabolic_equation`.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "emscape/propagation/steep_ground.h"

namespace emscape::emfield {

/// The marches of each emitter, by its name.
using SteepGrounds = std::map<std::string, std::vector<propagation::SteepGround>>;

/// propagation::steepGroundWarning() of each emitter, with its name.
std::vector<std::string> steepGroundWarnings(const SteepGrounds& grounds);

}  // namespace emscape::emfield
