/// A propagation model's explanation of one path: the parts of its loss and their reasons.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/propagation/reflected_ray.h"
#include "emscape/propagation/steep_ground.h"

namespace emscape::propagation {

/// One part of a path's excess over free space.
struct ExcessPart {
  std::string key;    ///< stable, for programs: "terrain_edge"
  std::string label;  ///< for people: "terrain as one edge (Bullington)"
  double loss_db = 0;
};

/// A path's reflected ray, with its direction at both ends.
struct PathReflection : ReflectedRay {
  /// Sine of the angle below the horizontal from which the ray arrives at the path's end, 0..1.
  float arrival_sine = 0;
};

struct Explanation {
  double loss_db = 0;             ///< sum of the parts; infinite if the model gives no field
  std::vector<ExcessPart> parts;  ///< empty: free space
  std::string why;                ///< reason, one clause
  /// Only for models with a reflected ray, where the emitter is in sight. The parts are the loss between
  /// isotropic antennas.
  std::optional<PathReflection> reflection;
  std::optional<SteepGround> steep;  ///< only of `parabolic_equation` over terrain, where it marches

  void add(const std::string& key, const std::string& label, double part_db) {
    parts.push_back({key, label, part_db});
    loss_db += part_db;
  }
};

}  // namespace emscape::propagation
