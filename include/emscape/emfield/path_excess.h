/// What a propagation model says of one path, and what its loss is made of.
#pragma once

#include <string>
#include <vector>

#include "emscape/emfield/path_profile.h"
#include "emscape/propagation/explanation.h"
#include "emscape/scenario/snapshot.h"

namespace emscape::emfield {

struct PathExcess : propagation::Explanation {
  std::vector<std::string> warnings;
};

/// By the functions that fill the field's voxels; p528 by its curve itself instead of the field's table.
/// @param emitter     with the model to take; it stands where the profile begins
/// @param terrain     null: none
/// @param resolution  of profiles
/// @throws Error (bad_input) for what the model refuses
PathExcess pathExcess(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                      const PathProfile& profile, const scenario::Terrain* terrain,
                      const FanResolution& resolution);

}  // namespace emscape::emfield
