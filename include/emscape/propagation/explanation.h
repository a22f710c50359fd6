/// A propagation model's explanation of one path: the parts of its loss and their reason.
#pragma once

#include <string>
#include <vector>

namespace emscape::propagation {

/// One part of a path's excess over free space.
struct ExcessPart {
  std::string key;    ///< stable, for programs: "terrain_edge"
  std::string label;  ///< for people: "terrain as one edge (Bullington)"
  double loss_db = 0;
};

struct Explanation {
  double loss_db = 0;             ///< sum of the parts; infinite if the model gives no field
  std::vector<ExcessPart> parts;  ///< empty: free space
  std::string why;                ///< reason, one clause

  void add(const std::string& key, const std::string& label, double part_db) {
    parts.push_back({key, label, part_db});
    loss_db += part_db;
  }
};

}  // namespace emscape::propagation
