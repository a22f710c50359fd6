#include "apps/view/command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "emscape/base/error.h"

namespace emscape::view {
namespace {

constexpr ArgumentType kNumber = ArgumentType::number;
constexpr ArgumentType kText = ArgumentType::text;
constexpr ArgumentType kBoolean = ArgumentType::boolean;

std::string allVerbs() {
  std::vector<std::string> names;
  for (const Verb& verb : verbs()) names.emplace_back(verb.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

const Verb& verbNamed(const std::string& name) {
  for (const Verb& verb : verbs()) {
    if (name == verb.name) return verb;
  }
  throw Error(ErrorCode::bad_input, fmt::format("unknown verb '{}': expected {}", name, allVerbs()));
}

bool fits(const Json& value, ArgumentType type) {
  switch (type) {
    case ArgumentType::number:
      return value.is_number();
    case ArgumentType::text:
      return value.is_string();
    case ArgumentType::boolean:
      return value.is_boolean();
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
    case ArgumentType::any:
      return "a number, a text, true or false";
  }
  return "";
}

}  // namespace

const std::vector<Verb>& verbs() {
  static const std::vector<Verb> all{
      {"play", {{"on", kBoolean, false}}, "Plays or pauses; without `on` the other of the two"},
      {"pause", {}, "Pauses"},
      {"step", {{"steps"}}, "Moves by so many steps of the series, backwards if negative; pauses"},
      {"seek", {{"time_s"}}, "Shows the step nearest to a time"},
      {"first", {}, "Shows the first step"},
      {"last", {}, "Shows the last step"},
      {"rate",
       {{"value", kNumber, false}, {"change", kNumber, false}},
       "Scenario seconds in a second; or `change`, 1 or -1: the next usual rate above or below"},
      {"loop", {{"on", kBoolean, false}}, "Playing starts again at the end"},
      {"orbit",
       {{"azimuth_deg", kNumber, false}, {"elevation_deg", kNumber, false}},
       "Turns the camera about its target by these angles"},
      {"pan", {{"right_px"}, {"down_px"}}, "Moves the scene with the cursor"},
      {"dolly", {{"factor"}}, "Multiplies the distance to the target"},
      {"camera", {{"spec", kText}}, "Sets the camera, as `emscape render --camera` does"},
      {"reset_view", {}, "Back to the camera of the start"},
      {"focus", {{"emitter", kText, false}}, "Looks at an emitter; without a name at the next one"},
      {"bookmark", {{"number"}}, "Stores camera and time under a number, 1..9"},
      {"recall", {{"number"}}, "Shows a bookmark"},
      {"set",
       {{"path", kText}, {"value", kText}},
       "Changes a value of the scenario, as `--set PATH=VALUE` does"},
      {"undo", {}, "Takes the last change of the scenario back"},
      {"redo", {}, "Makes the change that was taken back again"},
      {"copy_command", {}, "Puts the command that draws this picture on the clipboard"},
      {"save",
       {{"file", kText, false}},
       "Writes the changed scenario; default: NAME.edited.yaml beside the input"},
      {"mode", {{"mode", kText, false}}, "dvr, mida, mip or iso; without a name the next one"},
      {"iso",
       {{"value", kNumber, false}},
       "Value of the isosurface; without one: shows it, or the fog again"},
      {"shading", {{"on", kBoolean, false}}, "Light on the fog"},
      {"exaggeration", {{"factor"}}, "Vertical exaggeration; 0: chosen from the box"},
      {"step_voxels", {{"value"}}, "Distance of samples in voxels, 0.05..10"},
      {"quantity", {{"name", kText}}, "Shows another quantity"},
      {"transfer",
       {{"colors", kText, false}, {"file", kText, false}},
       "Colour map by name, or a transfer function from a file"},
      {"opacity", {{"factor"}}, "Multiplies the opacity of the fitted transfer function, 0.001..1000"},
      {"range",
       {{"min", kNumber, false}, {"max", kNumber, false}},
       "Range of the colours; without numbers the fitted one"},
      {"fit_step", {}, "Fits the colours to the step on screen"},
      {"fit_series", {}, "Fits the colours to the range of the whole series"},
      {"pattern", {{"pattern", kText, false}}, "auto or a pattern of rays; without a name the next one"},
      {"terrain", {{"on", kBoolean, false}}, "Draws the ground"},
      {"emitters", {{"on", kBoolean, false}}, "Draws the emitters"},
      {"theme", {{"theme", kText, false}}, "dark or light; without a name the other one"},
      {"panel",
       {{"name", kText}, {"open", kBoolean, false}},
       "Opens or closes a panel: scenario, colors, timeline, help, time, all"},
      {"scale",
       {{"factor", kNumber, false}, {"change", kNumber, false}},
       "Size of texts and controls, 0.5..4"},
      {"resize", {{"width"}, {"height"}}, "Size of the window in pixels"},
      {"screenshot", {{"file", kText, false}}, "Writes the window as PNG; default: a new emscape-NNNN.png"},
      {"back", {}, "Closes what is open"},
      {"quit", {}, "Ends the program"},
      {"wait_s", {{"seconds"}}, "The script waits"},
      {"wait_state",
       {{"state", kText}, {"timeout_s", kNumber, false}},
       "The script waits until the picture is BUSY, RESTORE, IDLE or exact; default: at most 60 s"},
      {"wait_frame", {{"timeout_s", kNumber, false}}, "The script waits for the first picture"},
      {"key", {{"key", kText}}, "Presses and releases a key"},
      {"mouse",
       {{"x"},
        {"y"},
        {"button", kText, false},
        {"to_x", kNumber, false},
        {"to_y", kNumber, false},
        {"wheel", kNumber, false}},
       "Moves the cursor; with `button` (left, middle, right) clicks, or drags to `to_x`, `to_y`"},
      {"expect",
       {{"key", kText}, {"op", kText}, {"value", ArgumentType::any}},
       "Compares a value of the log (== != < <= > >=); the program ends with status 5 if it is another"}};
  return all;
}

Command parseCommand(const Json& object) {
  if (!object.is_object() || !object.contains("do") || !object["do"].is_string()) {
    throw Error(ErrorCode::bad_input, "expected an object with \"do\": \"VERB\"");
  }
  const Verb& verb = verbNamed(object["do"].get<std::string>());
  Command command{verb.name, Json::object()};
  for (const auto& [name, value] : object.items()) {
    if (name == "do" || name == "at_s") continue;
    const auto argument = std::find_if(verb.arguments.begin(), verb.arguments.end(),
                                       [&n = name](const Argument& known) { return n == known.name; });
    if (argument == verb.arguments.end()) {
      throw Error(ErrorCode::bad_input, fmt::format("{}: unknown argument '{}'", verb.name, name));
    }
    if (!fits(value, argument->type)) {
      throw Error(ErrorCode::bad_input, fmt::format("{}: {} is {}: expected {}", verb.name, name,
                                                    value.dump(), nameOf(argument->type)));
    }
    command.arguments[name] = value;
  }
  for (const Argument& argument : verb.arguments) {
    if (argument.required && !command.has(argument.name)) {
      throw Error(ErrorCode::bad_input, fmt::format("{}: {} is missing", verb.name, argument.name));
    }
  }
  return command;
}

Command parseCommand(const std::string& text) {
  const Json object = Json::parse(text, nullptr, false);
  if (object.is_discarded()) throw Error(ErrorCode::bad_input, fmt::format("'{}' is not JSON", text));
  return parseCommand(object);
}

std::string toString(const Command& command) {
  Json object{{"do", command.verb}};
  object.update(command.arguments);
  return object.dump();
}

}  // namespace emscape::view
