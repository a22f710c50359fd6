/// What a propagation model says of one path, and what its loss is made of.
#pragma once

#include <string>
#include <vector>

#include "emfield/path_profile.h"
#include "scenario/emitter.h"

namespace emscape::emfield {

/// A share of a path's excess over free space.
struct ExcessPart {
  std::string key;    ///< stable, for programs: "terrain_edge"
  std::string label;  ///< for people: "terrain as one edge (Bullington)"
  double loss_db = 0;
};

struct PathExcess {
  double loss_db = 0;             ///< sum of the parts; infinite where the model knows no field
  std::vector<ExcessPart> parts;  ///< none: free space
  std::string why;                ///< how the model came to it, one clause
  std::vector<std::string> warnings;
};

/// @throws Error (bad_input) for a model that is not built
PathExcess pathExcess(scenario::PropagationModel model, const PathProfile& profile,
                      const scenario::Emitter& emitter);

}  // namespace emscape::emfield
