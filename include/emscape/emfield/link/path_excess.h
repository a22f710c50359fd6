/// A propagation model's excess loss on one path, and its parts.
#pragma once

#include <string>
#include <vector>

#include "emscape/emfield/link/path_profile.h"
#include "emscape/propagation/explanation.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::emfield {

struct PathExcess : propagation::Explanation {
  std::vector<std::string> warnings;
  double clutter_db = 0;  ///< part of the loss that trees and buildings cause, along the path and at its ends
};

/// Uses the functions that compute the field's voxels, except for p528, which computes its curve instead of
/// reading the field's table.
/// @param emitter     with the model to use, at the beginning of the profile
/// @param beam        of the emitter
/// @param terrain     null: none
/// @throws Error (bad_input) if the model refuses an input
PathExcess pathExcess(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                      const scenario::BeamPose& beam, const PathProfile& profile,
                      const scenario::Terrain* terrain);

}  // namespace emscape::emfield
