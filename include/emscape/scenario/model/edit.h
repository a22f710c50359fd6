/// Changes to a scenario, as text.
#pragma once

#include <string>

namespace emscape::scenario {

/// One change: the value at `path` becomes `value`.
///
/// path: keys of the scenario format (docs/scenario-format.md), separated by points. Items of a list have
/// their name, or their index from 0 if they have no name: `emitters.search radar.antenna.gain_dbi`,
/// `region.dims.2`, `terrain.files.0`. Names may contain blanks and points: the longest matching name in the
/// scenario is used. A name in double quotes is taken literally, with \" and \\ for a quote and a backslash:
/// `emitters."a=b".power_w`.
///
/// value: YAML or JSON: a number, a text, a list, a set of keys. `null` removes an optional key, which then
/// has its default, or an item of a list. Units are those of the key.
struct Edit {
  std::string path;
  std::string value;
};

/// Reads "PATH=VALUE": the path ends at the first '=' that is not in a quoted name.
/// @throws Error (usage) if there is no such '=' or no path before it
Edit parseEdit(const std::string& text);

/// A name as a part of a path, in double quotes if necessary.
std::string pathStep(const std::string& name);

/// "PATH=VALUE".
std::string toString(const Edit& edit);

bool operator==(const Edit& a, const Edit& b);
inline bool operator!=(const Edit& a, const Edit& b) {
  return !(a == b);
}

}  // namespace emscape::scenario
