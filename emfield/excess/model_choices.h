/// Settings that the emitters' models choose automatically, for reports before the computation.
#pragma once

#include <string>
#include <vector>

#include "emscape/scenario/model/snapshot.h"
#include "emscape/scenario/terrain/terrain.h"

namespace emscape::emfield {

struct EmitterChoice {
  std::string emitter;
  std::string model;
  std::string name;   ///< of the setting: "range step"
  std::string text;   ///< value with unit, and the reason: "200 m: ..."
  double time_s = 0;  ///< of a cost: processor time on one core, estimated
};

/// The choices for the region's voxels at one time. Models without automatic settings have none.
/// @param terrain  null: a smooth earth
/// @throws Error (bad_input) naming the emitter, if it cannot be computed
std::vector<EmitterChoice> modelChoices(const scenario::Snapshot& snapshot, const scenario::Terrain* terrain);

}  // namespace emscape::emfield
