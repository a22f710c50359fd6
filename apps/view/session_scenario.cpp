/// Verbs of the scenario: edits, undo.
#include <fmt/format.h>

#include "apps/view/session.h"
#include "emscape/base/error.h"
#include "emscape/scenario/parameters.h"

namespace emscape::view {
namespace {

const scenario::Platform& platformNamed(const scenario::Scenario& scenario, const std::string& name) {
  std::string known;
  for (const scenario::Platform& platform : scenario.platforms) {
    if (platform.name == name) return platform;
    known += (known.empty() ? "'" : ", '") + platform.name + "'";
  }
  throw Error(ErrorCode::bad_input,
              fmt::format("there is no platform '{}'; the scenario has {}", name, known));
}

/// {"edits": ["PATH=VALUE", ..]}
std::vector<scenario::Edit> editsOf(const Json& list) {
  std::vector<scenario::Edit> edits;
  for (const Json& edit : list) edits.push_back(scenario::parseEdit(edit.get<std::string>()));
  return edits;
}

}  // namespace

std::vector<scenario::Edit> movesOf(const scenario::Scenario& scenario, const std::string& platform,
                                    double latitude_deg, double longitude_deg) {
  const scenario::Platform& moved = platformNamed(scenario, platform);
  if (!moved.track_file.empty()) {
    throw Error(ErrorCode::bad_input,
                fmt::format("'{}' cannot be put elsewhere: it moves along {}", platform, moved.track_file));
  }
  const std::string path = "platforms." + scenario::pathStep(platform) + ".position.";
  return {{path + "latitude_deg", fmt::format("{:.7f}", latitude_deg)},
          {path + "longitude_deg", fmt::format("{:.7f}", longitude_deg)}};
}

std::vector<Verb> Session::scenarioVerbs() {
  return {
      {"set",
       {{"path", kText}, {"value", kText}},
       "Changes a value of the scenario, as `--set PATH=VALUE` does",
       [](Session& session, const Command& command) {
         session.changeScenario({{command.text("path"), command.text("value")}});
       }},
      {"set_together",
       {{"edits", ArgumentType::texts}},
       "Changes several values, a list of PATH=VALUE, in one step and checked together",
       [](Session& session, const Command& command) {
         session.changeScenario(editsOf(command.arguments["edits"]));
       }},
      {"choose",
       {{"path", kText}, {"value", kText}},
       "Chooses another antenna pattern, scan or propagation model, with common values for what it needs",
       [](Session& session, const Command& command) {
         if (!session.edits_) throw Error(ErrorCode::bad_input, "there is no scenario to change");
         session.changeScenario(
             scenario::editsForChoice(*session.scenario(), command.text("path"), command.text("value")));
       }},
      {"move",
       {{"platform", kText}, {"latitude_deg"}, {"longitude_deg"}},
       "Puts a platform elsewhere; its height stays as it is given",
       [](Session& session, const Command& command) {
         if (!session.edits_) throw Error(ErrorCode::bad_input, "there is no scenario to change");
         session.changeScenario(movesOf(*session.scenario(), command.text("platform"),
                                        command.number("latitude_deg"), command.number("longitude_deg")));
       }},
      {"undo",
       {},
       "Takes the last change of the scenario or of the colours back",
       [](Session& session, const Command&) { session.askUndo(true); }},
      {"redo",
       {},
       "Makes the change that was taken back again",
       [](Session& session, const Command&) { session.askUndo(false); }},
  };
}

}  // namespace emscape::view
