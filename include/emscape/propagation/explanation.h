/// What a propagation model says of one path: the parts of its loss, and how it came to them.
#pragma once

#include <string>
#include <vector>

namespace emscape::propagation {

/// A share of a path's excess over free space.
struct ExcessPart {
  std::string key;    ///< stable, for programs: "terrain_edge"
  std::string label;  ///< for people: "terrain as one edge (Bullington)"
  double loss_db = 0;
};

struct Explanation {
  double loss_db = 0;             ///< sum of the parts; infinite where the model knows no field
  std::vector<ExcessPart> parts;  ///< none: free space
  std::string why;                ///< how the model came to it, one clause

  void add(const std::string& key, const std::string& label, double part_db) {
    parts.push_back({key, label, part_db});
    loss_db += part_db;
  }
};

}  // namespace emscape::propagation
