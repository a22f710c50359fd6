/// What a propagation model says of one path, and what its loss is made of.
#pragma once

#include <string>
#include <vector>

#include "emscape/emfield/path_profile.h"
#include "emscape/scenario/snapshot.h"

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

  void add(const std::string& key, const std::string& label, double part_db) {
    parts.push_back({key, label, part_db});
    loss_db += part_db;
  }
};

/// By the functions that fill the field's voxels; p528 by its curve itself instead of the field's table.
/// @param emitter     with the model to take; `state` is where it stands
/// @param terrain     null: none
/// @param resolution  of profiles
/// @throws Error (bad_input) for what the model refuses
PathExcess pathExcess(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                      const scenario::EmitterState& state, const PathProfile& profile,
                      const scenario::Terrain* terrain, const FanResolution& resolution);

}  // namespace emscape::emfield
