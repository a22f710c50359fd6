/// Verbs of the items of a scenario: emitters, platforms, receivers and targets.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>

#include "apps/view/session/session.h"
#include "emscape/base/error.h"
#include "scenario/file/new_items.h"
#include "scenario/model/named_items.h"

namespace emscape::view {
namespace {

/// Of "LAT,LON" or "LAT,LON,HEIGHT".
scenario::DrawnPoint drawnPointOf(const std::string& text) {
  std::vector<double> numbers;
  const char* at = text.c_str();
  for (char* rest = nullptr; numbers.size() < 3; at = rest + 1) {
    numbers.push_back(std::strtod(at, &rest));
    const bool is_number = rest != at;
    at = rest;
    if (!is_number || *rest != ',') break;
  }
  if (numbers.size() < 2 || *at != '\0') {
    throw Error(ErrorCode::bad_input,
                fmt::format("point '{}': expected LAT,LON or LAT,LON,HEIGHT_AGL (degrees, m)", text));
  }
  scenario::DrawnPoint point{{numbers[0], numbers[1]}, std::nullopt};
  if (numbers.size() == 3) point.height_agl_m = numbers[2];
  return point;
}

std::optional<double> optionalNumber(const Command& command, const char* name) {
  return command.has(name) ? std::optional(command.number(name)) : std::nullopt;
}

scenario::NewItem newItemOf(const Command& command) {
  scenario::NewItem item{command.text("what"), command.text("name"), command.text("platform"), {}};
  if (command.has("latitude_deg") != command.has("longitude_deg"))
    throw Error(ErrorCode::bad_input, "add: latitude_deg and longitude_deg belong together");
  if (command.has("latitude_deg"))
    item.position = {command.number("latitude_deg"), command.number("longitude_deg")};
  return item;
}

/// The paths of the items on a platform.
std::vector<std::string> pathsOn(const scenario::Scenario& scenario, std::size_t platform) {
  std::vector<std::string> paths;
  const auto add = [&](const char* list, const auto& items) {
    for (const auto& item : items) {
      if (static_cast<std::size_t>(item.platform) == platform)
        paths.push_back(std::string(list) + scenario::pathStep(item.name));
    }
  };
  add("emitters.", scenario.emitters);
  add("receivers.", scenario.placed_receivers);
  add("targets.", scenario.targets);
  return paths;
}

/// The path that an item had before edits renamed it.
std::string formerPath(const std::vector<scenario::Edit>& edits, std::string path) {
  for (auto edit = edits.rbegin(); edit != edits.rend(); ++edit) {
    const std::optional<playback::RenamedItem> renamed = playback::renamedBy(*edit);
    if (renamed && renamed->path_now == path) path = renamed->path_before;
  }
  return path;
}

/// The path of what is taken back together with a path: a platform that was added takes along what was put on
/// it, and an item the platform that was added for it.
/// @param path  with the name that the item had at first, as those that are returned
std::vector<std::string> pathsRevertedWith(const scenario::Scenario& scenario,
                                           const std::vector<scenario::Edit>& edits,
                                           const std::string& path) {
  const auto additionOf = [&](const std::string& item) {
    return std::find_if(edits.begin(), edits.end(), [&](const scenario::Edit& edit) {
      return edit.path == item && edit.value != "null";
    });
  };
  const auto addition = additionOf(path);
  if (addition == edits.end()) return {};
  for (std::size_t p = 0; p < scenario.platforms.size(); ++p) {
    const std::string platform =
        formerPath(edits, "platforms." + scenario::pathStep(scenario.platforms[p].name));
    std::vector<std::string> carried = pathsOn(scenario, p);
    for (std::string& item : carried) item = formerPath(edits, item);
    if (platform == path) {
      for (std::string& item : carried) {
        if (additionOf(item) == edits.end()) item += ".platform";  // it was elsewhere before
      }
      return carried;
    }
    const bool came_along = addition != edits.begin() && std::prev(addition) == additionOf(platform);
    if (came_along && carried == std::vector<std::string>{path}) return {platform};
  }
  return {};
}

}  // namespace

const scenario::Scenario& Session::requireScenario() const {
  if (!edits_) throw Error(ErrorCode::bad_input, "there is no scenario to change");
  return *edits_->scenario();
}

void Session::enableEmitter(const std::string& name, std::optional<bool> on) {
  const scenario::Scenario& now = requireScenario();
  const scenario::Emitter& emitter = now.emitters[scenario::indexOfNamed(now.emitters, name, "emitter")];
  const bool is_on = on.value_or(!emitter.enabled);
  changeScenario({{"emitters." + scenario::pathStep(name) + ".enabled", is_on ? "null" : "false"}});
}

void Session::revertEdits(const std::string& path) {
  const scenario::Scenario& now = requireScenario();
  std::vector<scenario::Edit> edits;
  if (!path.empty()) {
    const std::vector<scenario::Edit> before = edits_->edits();
    edits = playback::editsWithout(before, path);
    for (const std::string& with : pathsRevertedWith(now, before, path))
      edits = playback::editsWithout(edits, with);
  }
  edit_queue_.replace(edits);
}

std::vector<Verb> Session::itemVerbs() {
  return {
      {"enable",
       {{"emitter", kText}, {"on", kBoolean, false}},
       "Switches an emitter on or off; without `on` the other of the two",
       [](Session& session, const Command& command) {
         session.enableEmitter(command.text("emitter"),
                               command.has("on") ? std::optional(command.boolean("on", true)) : std::nullopt);
       }},
      {"add",
       {{"what", kText, true, {}, {"radar", "transmitter", "jammer", "platform", "receiver", "target"}},
        {"name", kText, false},
        {"platform", kText, false},
        {"latitude_deg", kNumber, false, {-90, 90}},
        {"longitude_deg", kNumber, false, {-180, 180}}},
       "Adds an item with common values, on a platform (default: the first one) or on a new one at a "
       "position",
       [](Session& session, const Command& command) {
         session.changeScenario(editsToAdd(session.requireScenario(), newItemOf(command)));
       }},
      {"duplicate",
       {{"path", kText}, {"name", kText, false}},
       "Adds a copy of an emitter, platform, receiver or target: `emitters.NAME`",
       [](Session& session, const Command& command) {
         session.changeScenario(
             {editToDuplicate(session.requireScenario(), command.text("path"), command.text("name"))});
       }},
      {"remove",
       {{"path", kText}},
       "Removes an emitter, platform, receiver or target that nothing else names: `emitters.NAME`",
       [](Session& session, const Command& command) {
         session.changeScenario({editToRemove(session.requireScenario(), command.text("path"))});
       }},
      {"track",
       {{"platform", kText},
        {"points", ArgumentType::texts},
        {"speed_m_s", kNumber, false, {1e-6, 1e5}},
        {"begin_s", kNumber, false}},
       "Moves a platform along points, LAT,LON or LAT,LON,HEIGHT_AGL, at a constant speed; default: it "
       "arrives "
       "at the end of the scenario",
       [](Session& session, const Command& command) {
         const std::string path = "platforms." + scenario::pathStep(command.text("platform"));
         const std::vector<SceneObject>& objects = session.objects();
         const auto moved = std::find_if(objects.begin(), objects.end(),
                                         [&](const SceneObject& object) { return object.path == path; });
         std::vector<scenario::DrawnPoint> points;
         for (const Json& text : command.arguments["points"]) {
           points.push_back(drawnPointOf(text.get<std::string>()));
           if (!points.back().height_agl_m && moved != objects.end())
             points.back().height_agl_m = moved->height_agl_m;
         }
         session.changeScenario(editsForTrack(session.requireScenario(), command.text("platform"), points,
                                              command.number("begin_s"),
                                              optionalNumber(command, "speed_m_s")));
       }},
      {"revert",
       {{"path", kText, false}},
       "Takes back the edits of a value or an item, in one step; without `path` all edits",
       [](Session& session, const Command& command) { session.revertEdits(command.text("path")); }},
  };
}

}  // namespace emscape::view
