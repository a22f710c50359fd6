#include "apps/view/commands/action.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "emscape/base/error.h"
#include "playback/view/view_settings.h"

namespace emscape::view {
namespace {

/// The submenu of View of a setting; empty: none.
const char* submenuOf(const std::string& key) {
  static const std::map<std::string, const char*> kSubmenus{{"coast", "Map"},
                                                            {"graticule", "Map"},
                                                            {"show_scale_bar", "Map"},
                                                            {"show_compass", "Map"},
                                                            {"units", "Units"},
                                                            {"field_unit", "Units"},
                                                            {"positions", "Units"},
                                                            {"sides", "Emitters and labels"},
                                                            {"show_emitters", "Emitters and labels"},
                                                            {"labels", "Emitters and labels"}};
  const auto found = kSubmenus.find(key);
  return found == kSubmenus.end() ? "" : found->second;
}

}  // namespace

const std::vector<Action>& actions() {
  static const std::vector<Action> all = [] {
    std::vector<Action> list{
        {"File", "Open", "Ctrl+O", R"({"do":"open"})", "emscape view INPUT", "open"},
        {"File", "Open the input before this", "Ctrl+Shift+O", R"({"do":"open_recent"})",
         "emscape view INPUT", "open"},
        {"File", "Reload", "F5 Ctrl+R", R"({"do":"reload"})", "each command reads its input again", "open"},
        {"File", "Add the scenario", "Ctrl+Shift+A", R"({"do":"add_scenario"})",
         "emscape view INPUT --scenario FILE", "open"},
        {"File", "Save the changed scenario", "Ctrl+S", R"({"do":"save"})",
         "--set PATH=VALUE with any subcommand", "save"},
        {"File", "Save the scenario as", "Ctrl+Shift+S", R"({"do":"save_as"})",
         "--set PATH=VALUE with any subcommand", "save"},
        {"File", "Save the view", "Ctrl+Shift+V", R"({"do":"save_state"})",
         "emscape render INPUT --save-state FILE", "save"},
        {"File", "Load a view", "Ctrl+Shift+L", R"({"do":"load_state"})", "emscape view INPUT --state FILE",
         "save"},
        {"File", "Restore kept edits", "Ctrl+Shift+E", R"({"do":"restore"})",
         "emscape view INPUT --state AUTOSAVE", "save"},
        {"File", "Discard kept edits", "Ctrl+Shift+D", R"({"do":"discard"})", "removing the autosave",
         "save"},
        {"File", "Copy as command", "Ctrl+Shift+C", R"({"do":"copy_command"})", "the copied command itself",
         "pictures"},
        {"File", "Record", "Ctrl+M", R"({"do":"record"})",
         "emscape render INPUT --state FILE --times BEGIN:END:STEP -o FOLDER|NAME.mp4", "pictures"},
        {"File", "Cancel the recording", "Ctrl+Shift+M", R"({"do":"record_cancel"})",
         "Ctrl-C in the terminal", "pictures"},
        {"File", "Screenshot", "F12", R"({"do":"screenshot"})", "emscape render INPUT -o NAME.png",
         "pictures"},
        {"File", "Save the picture", "Shift+F12", R"({"do":"picture"})",
         "emscape render INPUT --state FILE -o NAME.png", "pictures"},
        {"File", "Quit", "Ctrl+Q", R"({"do":"quit"})", "Ctrl-C in the terminal", "end"},

        {"Edit", "Undo", "Ctrl+Z", R"({"do":"undo"})", "without the last --set, another --transfer FILE"},
        {"Edit", "Redo", "Ctrl+Shift+Z Ctrl+Y", R"({"do":"redo"})",
         "with the last --set, another --transfer FILE"},
        {"Edit", "Undo all changes of the scenario", "Ctrl+Backspace", R"({"do":"revert"})", "without --set"},

        {"Edit", "Cancel the computation", "Shift+Esc", R"({"do":"cancel"})", "Ctrl-C in the terminal"},
        {"Edit", "Select the next", "Y", R"({"do":"select","change":1})", "the names of --set"},
        {"Edit", "Select the previous", "Shift+Y", R"({"do":"select","change":-1})", "the names of --set"},
        {"Edit", "Select nothing", "Ctrl+Shift+Y", R"({"do":"select"})", "the names of --set"},
        {"Edit", "Menu of the selection", "Shift+F10", R"({"do":"panel","name":"menu"})",
         "--set and the other options"},

        {"Time", "Play or pause", "Space", R"({"do":"play"})", "emscape render INPUT --realtime", "play"},
        {"Time", "Pause", "K", R"({"do":"pause"})", "emscape render INPUT --times T", "play"},
        {"Time", "Step forward", "Right .", R"({"do":"step","steps":1})", "--times T", "step"},
        {"Time", "Step back", "Left ,", R"({"do":"step","steps":-1})", "--times T", "step"},
        {"Time", "First step", "Home Shift+Left", R"({"do":"first"})", "--times 0", "step"},
        {"Time", "Last step", "End Shift+Right", R"({"do":"last"})", "--times DURATION", "step"},
        {"Time", "Slower, then backwards", "J", R"({"do":"rate","change":-1})", "--realtime --speed", "rate"},
        {"Time", "Faster", "L", R"({"do":"rate","change":1})", "--realtime --speed", "rate"},
        {"Time", "Other direction", "Shift+J", R"({"do":"reverse"})", "a video player's reverse", "rate"},
        {"Time", "Loop", "Ctrl+L", R"({"do":"loop"})", "a video player's loop", "rate"},
        {"Time", "Play from here", "[", R"({"do":"play_from"})", "--times BEGIN:END", "range"},
        {"Time", "Play up to here", "]", R"({"do":"play_to"})", "--times BEGIN:END", "range"},
        {"Time", "Play the whole series", "Backspace", R"({"do":"play_all"})", "--times 0:DURATION", "range"},
        {"Time", "Show the whole time line", "Ctrl+Home", R"({"do":"timeline"})", "--times 0:DURATION",
         "range"},
        {"Time", "Go to time", "G", R"({"do":"panel","name":"time"})", "--times T", "go"},

        {"Camera", "Reset", "R", R"({"do":"reset_view"})", "--camera orbit", "go"},
        {"Camera", "Focus the next emitter", "F", R"({"do":"focus"})",
         "--camera orbit:target_x_m=..,..,distance=..", "go"},
        {"Camera", "Go to position", "Ctrl+G", R"({"do":"panel","name":"position"})",
         "--camera orbit:target_x_m=..,..,distance=..", "go"},
        {"Camera", "Turn left", "Ctrl+Left", R"({"do":"orbit","azimuth_deg":10})",
         "--camera orbit:azimuth_deg=..", "turn"},
        {"Camera", "Turn right", "Ctrl+Right", R"({"do":"orbit","azimuth_deg":-10})",
         "--camera orbit:azimuth_deg=..", "turn"},
        {"Camera", "Higher", "Ctrl+Up Up", R"({"do":"orbit","elevation_deg":5})",
         "--camera orbit:elevation_deg=..", "turn"},
        {"Camera", "Lower", "Ctrl+Down Down", R"({"do":"orbit","elevation_deg":-5})",
         "--camera orbit:elevation_deg=..", "turn"},
        {"Camera", "Closer", "+", R"({"do":"dolly","factor":0.8})", "--camera orbit:distance=..", "near"},
        {"Camera", "Further", "-", R"({"do":"dolly","factor":1.25})", "--camera orbit:distance=..", "near"},
        {"Camera", "Follow a platform", "Ctrl+F", R"({"do":"follow"})", "--follow PLATFORM", "go"},
        {"Camera", "From above", "V",
         R"({"do":"camera","spec":"orbit:azimuth_deg=180,elevation_deg=90,projection=orthographic"})",
         "--camera orbit:azimuth_deg=180,elevation_deg=90,projection=orthographic", "go"},
        {"Camera", "Orthographic", "O", R"({"do":"projection"})", "--camera orbit:projection=orthographic",
         "go"},
    };
    for (const playback::ViewSetting& setting : playback::viewSettings()) {
      if (setting.action.empty()) continue;
      list.push_back({"View", setting.action.c_str(), setting.keys.c_str(),
                      fmt::format(R"({{"do":"{}"}})", setting.verb), setting.optionText(),
                      submenuOf(setting.key)});
    }
    const std::vector<Action> others{
        {"View", "Isosurface", "I", R"({"do":"iso"})", "--mode iso"},
        {"View", "Next pattern of rays", "X", R"({"do":"pattern"})", "--rays auto|full|columns|.."},
        {"View", "Fit colours to this step", "Shift+F", R"({"do":"fit_step"})", "--range MIN:MAX",
         "Colours and opacity"},
        {"View", "Fit colours to the series", "Shift+R", R"({"do":"fit_series"})", "--range MIN:MAX",
         "Colours and opacity"},
        {"View", "Default colours of this step", "Ctrl+Shift+F", R"({"do":"reset_transfer"})",
         "the default of --transfer", "Colours and opacity"},
        {"View", "Save colours", "Ctrl+Shift+T", R"({"do":"save_transfer"})", "--transfer FILE reads it",
         "Colours and opacity"},
        {"View", "Remove the selected opacity point", "Delete", R"({"do":"remove_point"})", "--transfer FILE",
         "Colours and opacity"},
        {"View", "More opaque", "Shift+Up", R"({"do":"opacity","factor":1.25})", "--transfer FILE",
         "Colours and opacity"},
        {"View", "Less opaque", "Shift+Down", R"({"do":"opacity","factor":0.8})", "--transfer FILE",
         "Colours and opacity"},
        {"View", "Cut horizontally", "H", R"({"do":"plane","kind":"horizontal"})",
         "--plane horizontal:altitude_m=..", "Cutting planes"},
        {"View", "Cut vertically", "Shift+H", R"({"do":"plane","kind":"vertical"})",
         "--plane vertical:bearing_deg=..,offset_m=..", "Cutting planes"},
        {"View", "Map layer", "Shift+L", R"({"do":"map_layer"})", "--map-layer HEIGHT_M|off", "Map"},
        {"View", "Compare with the original", "C", R"({"do":"compare"})", "--compare original|FILE"},
        {"View", "Split: original and changed", "Shift+C", R"({"do":"split"})",
         "--split 0..1 --compare original|FILE"},
        {"View", "Measure", "Shift+M", R"({"do":"measure"})",
         "emscape profile INPUT --emitter NAME --to LAT,LON,HEIGHT"},
        {"View", "Reset all switches", "Ctrl+Shift+R", R"({"do":"reset_switches"})",
         "without the options of the view"},
        {"View", "Lock or unlock the probe", "P", R"({"do":"lock_probe"})",
         "emscape profile INPUT --emitter NAME --to LAT,LON,HEIGHT"},

        {"Panels", "Scenario: what if", "W", R"({"do":"panel","name":"scenario"})", "--set PATH=VALUE",
         "sides"},
        {"Panels", "Colours and opacity", "T", R"({"do":"panel","name":"colors"})",
         "--transfer FILE, --range MIN:MAX", "sides"},
        {"Panels", "Cutting planes", "Shift+X", R"({"do":"panel","name":"planes"})", "--plane SPEC", "sides"},
        {"Panels", "Map: places, picture, range rings", "Ctrl+Shift+G", R"({"do":"panel","name":"map"})",
         "--places FILE, --drape FILE, --range-rings RINGS", "sides"},
        {"Panels", "Probe", "Shift+P", R"({"do":"panel","name":"probe"})",
         "emscape profile INPUT --emitter NAME --to LAT,LON,HEIGHT", "sides"},
        {"Panels", "Timeline", "Shift+T", R"({"do":"panel","name":"timeline"})", "--times BEGIN:END:STEP",
         "sides"},
        {"Panels", "Warnings", "Ctrl+Shift+W", R"({"do":"panel","name":"warnings"})",
         "each subcommand prints them", "all"},
        {"Panels", "Hide or show all", "F10", R"({"do":"panel","name":"all"})",
         "emscape render draws no panels", "all"},
        {"Panels", "Larger texts", "Ctrl++", R"({"do":"scale","change":1})", "emscape view --scale F",
         "texts"},
        {"Panels", "Smaller texts", "Ctrl+-", R"({"do":"scale","change":-1})", "emscape view --scale F",
         "texts"},
        {"Panels", "Help", "F1 ?", R"({"do":"panel","name":"help"})", "emscape view --help", "help"},
        {"Panels", "Back", "Esc", R"({"do":"back"})", "the command line has no panels", "help"},
    };
    list.insert(list.end(), others.begin(), others.end());
    return list;
  }();
  return all;
}

std::vector<std::string> menuNames() {
  std::vector<std::string> names;
  for (const Action& action : actions()) {
    if (names.empty() || names.back() != action.menu) names.emplace_back(action.menu);
  }
  return names;
}

KeyChord parseChord(const std::string& text) {
  KeyChord chord;
  std::string rest = text;
  const auto take = [&rest](const std::string& prefix) {
    if (rest.size() <= prefix.size() || rest.compare(0, prefix.size(), prefix) != 0) return false;
    rest.erase(0, prefix.size());
    return true;
  };
  for (bool more = true; more;) {
    const bool control = take("Ctrl+");
    const bool shift = take("Shift+");
    chord.control |= control;
    chord.shift |= shift;
    more = control || shift;
  }
  if (rest.empty())
    throw Error(ErrorCode::bad_input, fmt::format("key '{}': expected [Ctrl+][Shift+]KEY", text));
  chord.key = rest;
  return chord;
}

std::string toString(const KeyChord& chord) {
  return std::string(chord.control ? "Ctrl+" : "") + (chord.shift ? "Shift+" : "") + chord.key;
}

bool operator==(const KeyChord& a, const KeyChord& b) {
  return a.key == b.key && a.control == b.control && a.shift == b.shift;
}

std::vector<KeyChord> chordsOf(const Action& action) {
  std::vector<KeyChord> chords;
  std::istringstream words(action.keys);
  for (std::string word; words >> word;) chords.push_back(parseChord(word));
  return chords;
}

bool repeats(const Action& action) {
  static const std::set<std::string> kVerbs{"step",  "rate", "orbit", "dolly", "opacity",
                                            "scale", "undo", "redo",  "select"};
  return kVerbs.count(parseCommand(action.command).verb) != 0;
}

const Action* actionOf(const KeyChord& chord) {
  for (const Action& action : actions()) {
    const std::vector<KeyChord> chords = chordsOf(action);
    if (std::find(chords.begin(), chords.end(), chord) != chords.end()) return &action;
  }
  return nullptr;
}

const std::vector<Gesture>& gestures() {
  static const std::vector<Gesture> all{
      {"left drag, Alt + left drag", "orbit about the target"},
      {"left drag on an emitter", "move its platform over the ground; Esc takes it back"},
      {"left drag on the handle of a plane", "move the plane"},
      {"left drag on the line of a split view", "move the line"},
      {"click", "select the emitter, platform, receiver or target there; on the ground nothing"},
      {"right click", "the menu of the thing or the ground there"},
      {"double click", "look at the thing or the ground there"},
      {"Ctrl + left click", "lock the probe there"},
      {"middle drag, Shift + left drag", "pan"},
      {"wheel", "towards the cursor and back"},
      {"right drag", "look around; with W A S D, Q, E fly, with Shift faster"},
      {"1-9, Ctrl + 1-9", "show, store a bookmark of camera and time"},
      {"double click, Ctrl + click on a value", "type it, also in other units: 5 kW, 2 km, -3 dBW"},
      {"drag of a value, with Shift", "change it, in fine steps"},
      {"Tab, Shift + Tab, Up, Down", "next and previous value; Enter types it, Left and Right change it"},
      {"Esc on a value, click in the picture", "the keys are for the picture again"},
  };
  return all;
}

std::string manualTables() {
  std::string text = "| menu | action | keys | script | command line |\n|---|---|---|---|---|\n";
  for (const Action& action : actions()) {
    std::string keys;
    for (const KeyChord& chord : chordsOf(action)) {
      keys += (keys.empty() ? "`" : ", `") + toString(chord) + "`";
    }
    std::string command_line = action.command_line;
    for (std::size_t at = 0; (at = command_line.find('|', at)) != std::string::npos; at += 2) {
      command_line.insert(at, "\\");
    }
    text += fmt::format("| {} | {} | {} | `{}` | {} |\n", action.menu, action.name, keys, action.command,
                        command_line);
  }
  text += "\n| mouse and digits | |\n|---|---|\n";
  for (const Gesture& gesture : gestures())
    text += fmt::format("| {} | {} |\n", gesture.gesture, gesture.does);
  text += "\n| verb | arguments | does |\n|---|---|---|\n";
  for (const Verb& verb : verbs()) {
    std::string arguments;
    for (const Argument& argument : verb.arguments) {
      const std::string name = fmt::format("`{}`", argument.name);
      arguments += (arguments.empty() ? "" : ", ") + (argument.required ? name : "[" + name + "]");
    }
    text += fmt::format("| `{}` | {} | {} |\n", verb.name, arguments, verb.help);
  }
  return text;
}

}  // namespace emscape::view
