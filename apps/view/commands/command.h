/// The window's commands: verbs with arguments, used by scripts, keys and menus.
#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace emscape::view {

using Json = nlohmann::ordered_json;

enum class ArgumentType { number, text, boolean, texts, any };

/// Allowed values of a number; all finite ones by default.
struct NumberLimits {
  double min = std::numeric_limits<double>::lowest(), max = std::numeric_limits<double>::max();
  bool is_whole = false;
  bool is_not_zero = false;
};

struct Argument {
  const char* name;
  ArgumentType type = ArgumentType::number;
  bool required = true;
  NumberLimits limits = {};
  std::vector<const char*> choices = {};  ///< allowed texts; empty: any
  /// Throws Error for texts that cannot be used, whatever the input; null: none.
  void (*check)(const std::string& text) = nullptr;
};
/// The names of rows of a table, as choices.
template <class Rows>
std::vector<const char*> namesOf(const Rows& rows) {
  std::vector<const char*> names;
  for (const auto& row : rows) names.push_back(row.name);
  return names;
}

inline constexpr ArgumentType kNumber = ArgumentType::number;
inline constexpr ArgumentType kText = ArgumentType::text;
inline constexpr ArgumentType kBoolean = ArgumentType::boolean;

class Session;
struct Command;

/// A verb: syntax and function.
struct Verb {
  const char* name;
  std::vector<Argument> arguments;
  const char* help;
  /// Throws Error if it fails; null for verbs of scripts only, such as waiting.
  void (*run)(Session& session, const Command& command) = nullptr;
};

/// All verbs, in the order of the manual.
const std::vector<Verb>& verbs();
/// @throws Error (bad_input) that lists the verbs
const Verb& verbNamed(const std::string& name);

/// A verb with its arguments: {"do": "seek", "time_s": 49.5}.
struct Command {
  std::string verb;
  Json arguments = Json::object();  ///< without "do"

  bool has(const char* name) const { return arguments.contains(name); }
  double number(const char* name, double otherwise = 0) const { return arguments.value(name, otherwise); }
  bool boolean(const char* name, bool otherwise) const { return arguments.value(name, otherwise); }
  std::string text(const char* name) const { return arguments.value(name, std::string()); }
};

/// Reads a command from the object of a script line; "at_s" is ignored.
/// @throws Error (bad_input) that names the verb or argument that is unknown, missing or of a wrong type
Command parseCommand(const Json& object);
/// Parses a text.
Command parseCommand(const std::string& text);
/// Checks a value against the type, limits, choices and check of its argument.
/// @throws Error that names verb, argument, value and what is allowed; that of `check`
void requireAllowed(const std::string& verb, const Argument& argument, const Json& value);
/// The same for all arguments of a command, which must be those of the verb.
void requireAllowed(const Command& command);
/// Text that parseCommand() reads.
std::string toString(const Command& command);

}  // namespace emscape::view
