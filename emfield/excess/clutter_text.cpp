#include "emfield/excess/clutter_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "emfield/excess/emitter_excess.h"
#include "propagation/registry/model_info.h"

namespace emscape::emfield {
namespace {

using propagation::PropagationModel;

/// Height of clutter along all of a path (m), of p1812 and p452; 0 of others.
double constantClutter_m(const propagation::ModelSettings& settings) {
  switch (settings.model) {
    case PropagationModel::p1812:
      return settings.p1812.clutter_height_m;
    case PropagationModel::p452:
      return settings.p452.clutter_height_m;
    default:
      return 0;
  }
}

}  // namespace

bool usesClutterMap(const propagation::ModelSettings& settings) {
  return propagation::isRaisedByClutter(settings) || settings.model == PropagationModel::p1812 ||
         settings.model == PropagationModel::p452;
}

bool hasClutter(const propagation::ModelSettings& settings, const scenario::Terrain* terrain) {
  if (constantClutter_m(settings) > 0) return true;
  if (terrain == nullptr || !usesClutterMap(settings)) return false;
  const scenario::TerrainView view = terrain->view();
  const auto isHigh = [](const scenario::CoverValues& of_class) { return of_class.clutter_height_m > 0; };
  return view.surface_count > 0 ||
         (view.cover.isSet() &&
          std::any_of(view.cover.classes, view.cover.classes + view.cover.class_count, isHigh));
}

std::string clutterText(const scenario::Scenario& scenario, const scenario::Emitter& emitter) {
  const propagation::ModelSettings& settings = emitter.propagation;
  const propagation::Ground& ground = scenario.ground;
  if (scenario::hasClutterMap(scenario)) {
    if (!usesClutterMap(settings))
      return fmt::format("none ('{}' does not use the map of clutter)", toString(settings.model));
    return scenario.terrain->surface_files.empty() ? "heights of the land cover along the path"
                                                   : "heights of the surface model along the path";
  }
  std::string text;
  if (const double height_m = constantClutter_m(settings); height_m > 0)
    text = fmt::format("{:g} m high along the path", height_m);
  if (propagation::hasTerminalClutter(emitterInputs(scenario, emitter)))
    text += fmt::format("{}ITU-R P.2108-1 (3.2) at ends up to {:g} m above the ground, {:g} % of locations{}",
                        text.empty() ? "" : "; ", ground.terminal_clutter_below_m,
                        ground.terminal_clutter_percent,
                        ground.terminal_clutter_combine == propagation::ClutterCombination::larger
                            ? ", or the loss by terrain if that is larger"
                            : "");
  return text.empty() ? "none" : text;
}

std::string clutterText(const scenario::Scenario& scenario) {
  std::string text, first;
  bool is_same = true;
  for (const scenario::Emitter& emitter : scenario.emitters) {
    const std::string of_emitter = clutterText(scenario, emitter);
    if (text.empty()) first = of_emitter;
    is_same = is_same && of_emitter == first;
    text += fmt::format("{}'{}': {}", text.empty() ? "" : "; ", emitter.name, of_emitter);
  }
  if (text.empty()) return "none";
  if (is_same) text = first;
  std::string radars;
  for (const scenario::Emitter& emitter : scenario.emitters) {
    if (emitter.enabled && emitter.clutter)
      radars += fmt::format("{}'{}'", radars.empty() ? "" : ", ", emitter.name);
  }
  if (radars.empty()) return text;
  return text + (text == "none" ? " along the paths" : "") + "; radars with echoes of clutter: " + radars;
}

std::vector<std::string> clutterWarnings(const scenario::Scenario& scenario,
                                         const scenario::Emitter& emitter) {
  std::vector<std::string> warnings;
  const PropagationModel model = emitter.propagation.model;
  const auto warn = [&](const std::string& message) {
    warnings.push_back(fmt::format("emitter '{}': {}", emitter.name, message));
  };
  if (model == PropagationModel::two_ray && scenario.terrain)
    warn("'two_ray' is for water and other smooth ground: the terrain has no part in its losses");
  if (model == PropagationModel::p528 && scenario.terrain)
    warn("'p528' is for a smooth earth: the terrain has no part in its losses");
  if (scenario.ground.terminal_clutter == propagation::TerminalClutterModel::none) return warnings;
  if (scenario::hasClutterMap(scenario)) {
    warn("'terminal_clutter' of 'ground' is not used: the terrain has a map of clutter");
  } else if (model == PropagationModel::p528 || model == PropagationModel::parabolic_equation) {
    warn(fmt::format("'terminal_clutter' of 'ground' is not used by '{}'", toString(model)));
  } else if (!propagation::kP2108Frequency.holds(emitter.frequency_hz)) {
    warn(fmt::format(
        "'terminal_clutter' of 'ground' is not used: the frequency {:g} GHz is outside {:g}..{:g} GHz",
        emitter.frequency_hz / 1e9, propagation::kP2108Frequency.min, propagation::kP2108Frequency.max));
  } else if (scenario.ground.kind == propagation::GroundKind::sea ||
             scenario.ground.kind == propagation::GroundKind::fresh_water) {
    warn(fmt::format(
        "P.2108-1 is for towns and suburbs, but the 'kind' of 'ground' is {}: its loss at ends up "
        "to {:g} m above the water sets what is covered there",
        toString(scenario.ground.kind), scenario.ground.terminal_clutter_below_m));
  }
  return warnings;
}

}  // namespace emscape::emfield
