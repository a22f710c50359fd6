#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "apps/view/commands/action.h"
#include "apps/view/commands/command.h"
#include "apps/view/commands/input_queue.h"
#include "apps/view/session/session.h"
#include "base/files/json_writing.h"
#include "emscape/base/error.h"

namespace emscape::view {
namespace {

std::string allVerbs() {
  std::vector<std::string> names;
  for (const Verb& verb : verbs()) names.emplace_back(verb.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

bool fits(const Json& value, ArgumentType type) {
  switch (type) {
    case ArgumentType::number:
      return value.is_number();
    case ArgumentType::text:
      return value.is_string();
    case ArgumentType::boolean:
      return value.is_boolean();
    case ArgumentType::texts:
      return value.is_array() &&
             std::all_of(value.begin(), value.end(), [](const Json& text) { return text.is_string(); });
    case ArgumentType::any:
      return value.is_primitive();
  }
  return false;
}

const char* nameOf(ArgumentType type) {
  switch (type) {
    case ArgumentType::number:
      return "a number";
    case ArgumentType::text:
      return "a text";
    case ArgumentType::boolean:
      return "true or false";
    case ArgumentType::texts:
      return "a list of texts";
    case ArgumentType::any:
      return "a number, a text, true or false";
  }
  return "";
}

bool isWithin(double value, const NumberLimits& limits) {
  return value >= limits.min && value <= limits.max && !(limits.is_whole && value != std::trunc(value)) &&
         !(limits.is_not_zero && value == 0);
}

/// "a whole number 1..9", "a finite number", "-1 or 1".
std::string textOf(const NumberLimits& limits) {
  const NumberLimits none;
  if (limits.is_whole && limits.is_not_zero && limits.min == -1 && limits.max == 1) return "-1 or 1";
  const bool has_min = limits.min != none.min, has_max = limits.max != none.max;
  std::string text = limits.is_whole ? "a whole number" : has_min || has_max ? "a number" : "a finite number";
  if (has_min && has_max) {
    text += fmt::format(" {}..{}", limits.min, limits.max);
  } else if (has_min) {
    text += fmt::format(" of at least {}", limits.min);
  }
  return text + (limits.is_not_zero ? " other than 0" : "");
}

void requireType(const std::string& verb, const Argument& argument, const Json& value) {
  if (fits(value, argument.type)) return;
  throw Error(ErrorCode::bad_input, fmt::format("{}: {} is {}: expected {}", verb, argument.name,
                                                dumpJson(value), nameOf(argument.type)));
}

/// Requires that all arguments exist and fulfil a check, and that none is missing.
template <class Check>
void requireSignature(const Command& command, const Check& check) {
  const std::vector<Argument>& arguments = verbNamed(command.verb).arguments;
  for (const auto& [name, value] : command.arguments.items()) {
    const auto argument = std::find_if(arguments.begin(), arguments.end(),
                                       [&n = name](const Argument& known) { return n == known.name; });
    if (argument == arguments.end()) {
      throw Error(ErrorCode::bad_input, fmt::format("{}: unknown argument '{}'", command.verb, name));
    }
    check(command.verb, *argument, value);
  }
  for (const Argument& argument : arguments) {
    if (argument.required && !command.has(argument.name)) {
      throw Error(ErrorCode::bad_input, fmt::format("{}: {} is missing", command.verb, argument.name));
    }
  }
}

}  // namespace

void requireAllowed(const std::string& verb, const Argument& argument, const Json& value) {
  requireType(verb, argument, value);
  if (value.is_number() && !isWithin(value.get<double>(), argument.limits)) {
    throw Error(ErrorCode::bad_input, fmt::format("{}: {} {:g}: expected {}", verb, argument.name,
                                                  value.get<double>(), textOf(argument.limits)));
  }
  const std::vector<const char*>& choices = argument.choices;
  if (!choices.empty() &&
      std::find(choices.begin(), choices.end(), value.get<std::string>()) == choices.end()) {
    throw Error(ErrorCode::bad_input, fmt::format("{}: {} '{}': expected {}", verb, argument.name,
                                                  value.get<std::string>(), fmt::join(choices, ", ")));
  }
  if (argument.check) argument.check(value.get<std::string>());
}

const std::vector<Verb>& verbs() {
  static const std::vector<Verb> all = [] {
    std::vector<Verb> list = Session::verbs();
    const NumberLimits duration_s{0};
    const std::vector<Verb> of_scripts{
        {"wait_s", {{"seconds", kNumber, true, duration_s}}, "The script waits"},
        {"wait_state",
         {{"state", kText, true, {}, {"BUSY", "RESTORE", "IDLE", "exact", "recorded"}},
          {"timeout_s", kNumber, false, duration_s},
          {"must", kBoolean, false}},
         "The script waits until the picture is BUSY, RESTORE, IDLE or exact, or a recording is `recorded`; "
         "default: at most 60 s. `must` false: continues if that takes longer"},
        {"wait_frame", {{"timeout_s", kNumber, false, duration_s}}, "The script waits for the first picture"},
        {"mark",
         {{"text", kText}},
         "Writes a line with this text into the log, with the values of a `frame`"},
        {"key",
         {{"key", kText, true, {}, {}, [](const std::string& text) { eventsOf(parseChord(text)); }}},
         "Presses and releases a key"},
        {"mouse",
         {{"x"},
          {"y"},
          {"button", kText, false, {}, namesOf(mouseButtons())},
          {"to_x", kNumber, false},
          {"to_y", kNumber, false},
          {"wheel", kNumber, false}},
         "Moves the cursor; with `button` (left, middle, right) clicks, or drags to `to_x`, `to_y`"},
        {"expect",
         {{"key", kText},
          {"op", kText, true, {}, {"==", "!=", "<", "<=", ">", ">="}},
          {"value", ArgumentType::any}},
         "Compares a value of the log (== != < <= > >=); the program ends with status 5 if it is another"}};
    list.insert(list.end(), of_scripts.begin(), of_scripts.end());
    return list;
  }();
  return all;
}

const Verb& verbNamed(const std::string& name) {
  for (const Verb& verb : verbs()) {
    if (name == verb.name) return verb;
  }
  throw Error(ErrorCode::bad_input, fmt::format("unknown verb '{}': expected {}", name, allVerbs()));
}

Command parseCommand(const Json& object) {
  if (!object.is_object() || !object.contains("do") || !object["do"].is_string()) {
    throw Error(ErrorCode::bad_input, "expected an object with \"do\": \"VERB\"");
  }
  Command command{object["do"].get<std::string>(), object};
  command.arguments.erase("do");
  command.arguments.erase("at_s");
  requireSignature(command, requireType);
  return command;
}

Command parseCommand(const std::string& text) {
  const Json object = Json::parse(text, nullptr, false);
  if (object.is_discarded()) throw Error(ErrorCode::bad_input, fmt::format("'{}' is not JSON", text));
  return parseCommand(object);
}

void requireAllowed(const Command& command) {
  requireSignature(command, [](const std::string& verb, const Argument& argument, const Json& value) {
    requireAllowed(verb, argument, value);
  });
}

std::string toString(const Command& command) {
  Json object{{"do", command.verb}};
  object.update(command.arguments);
  return dumpJson(object);
}

}  // namespace emscape::view
