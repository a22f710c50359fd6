/// The editable values of a scenario, as rows of a form.
#pragma once

#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"

namespace emscape::scenario {

/// One value: name, type, limits and current text, from the table of the format.
struct Parameter {
  enum class Type { number, integer, boolean, choice, text, list };
  std::string path;  ///< as an Edit takes it
  std::string key;   ///< the last part of the path
  std::string name;  ///< for people: "height above ground"
  std::string unit;  ///< of a number; may be empty
  std::string description;
  Type type = Type::text;
  double minimum = 0, maximum = 0;   ///< number, integer
  bool minimum_excluded = false;     ///< values are above the minimum
  std::vector<std::string> choices;  ///< choice; list: the allowed items, empty: any
  std::vector<std::string> titles;   ///< of the choices, for people
  bool required = false;             ///< else null removes it
  bool is_expert = false;            ///< rarely changed
  bool is_given = false;             ///< in the text of the scenario
  /// The given text on one line; else the default; empty if there is none.
  std::string value;
  std::string default_value;  ///< empty if there is none
};

/// The values of an object and of its nested objects.
struct ParameterGroup {
  std::string name;   ///< key, or name of the list's item
  std::string title;  ///< for people
  std::string path;
  std::vector<Parameter> parameters;
  std::vector<ParameterGroup> groups;
};

/// The editable values of an object, without keys of antenna patterns, scans and propagation models that are
/// not chosen, and without keys that a given key excludes.
/// @param path  of an object, such as "emitters.jammer" or "atmosphere"; it need not be in the file
/// @throws Error (bad_input) if the path does not lead to an object, or the scenario was not read from a file
ParameterGroup parametersOf(const Scenario& scenario, const std::string& path);

/// The edits that choose another antenna pattern, scan or propagation model: keys that the new choice does
/// not have are removed, and keys that it requires get a common value. Other choices need a single edit.
/// @param path    of a choice
/// @throws Error (bad_input) for a choice that needs files
std::vector<Edit> editsForChoice(const Scenario& scenario, const std::string& path,
                                 const std::string& choice);

}  // namespace emscape::scenario
