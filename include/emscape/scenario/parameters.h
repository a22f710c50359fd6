/// The values of a scenario that can be changed, as rows of a form.
#pragma once

#include <string>
#include <vector>

#include "emscape/scenario/scenario.h"

namespace emscape::scenario {

/// One value: what it is called, what it may be, what it is. From the table of the format.
struct Parameter {
  enum class Type { number, integer, choice, text, list };
  std::string path;  ///< as an Edit takes it
  std::string key;   ///< the last part of the path
  std::string name;  ///< for people: the key without its unit's suffix
  std::string unit;  ///< of a number; may be empty
  std::string description;
  Type type = Type::text;
  double minimum = 0, maximum = 0;   ///< number, integer
  std::vector<std::string> choices;  ///< choice
  bool required = false;             ///< else null takes it away
  bool is_given = false;             ///< in the text of the scenario
  /// As it is given, on one line; else its default; empty where there is none.
  std::string value;
};

/// The values of an object and of the objects in it.
struct ParameterGroup {
  std::string name;  ///< key, or name of the list's item
  std::string path;
  std::vector<Parameter> parameters;
  std::vector<ParameterGroup> groups;
};

/// What of an object can be changed as it stands: keys of other antenna patterns, scans or propagation models
/// than those chosen are left out, and of keys that exclude each other those that are not given.
/// @param path  of an object, "emitters.jammer" or "atmosphere", that need not be given
/// @throws Error (bad_input) if the path leads to no object, or the scenario was not read from a file
ParameterGroup parametersOf(const Scenario& scenario, const std::string& path);

/// The edits that choose another antenna pattern, scan, propagation model or the like: what the new choice
/// does not know is removed, what it needs is given a common value. Of other choices the one edit.
/// @param path    of a choice
/// @throws Error (bad_input) for a choice that needs files
std::vector<Edit> editsForChoice(const Scenario& scenario, const std::string& path,
                                 const std::string& choice);

}  // namespace emscape::scenario
