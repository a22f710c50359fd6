/// Verbs of the picture: mode, quantity, what is drawn.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "apps/view/session/session.h"
#include "apps/view/session/shown_quantity.h"
#include "emscape/base/error.h"

namespace emscape::view {
namespace {

constexpr NumberLimits limitsOf(const render::SettingLimits& limits) {
  return {limits.min, limits.max};
}

/// @param name  "auto": empty. @throws Error (usage) that lists the names
std::optional<render::Pattern> patternNamed(const std::string& name) {
  if (name == "auto") return std::nullopt;
  return render::parsePattern(name);
}

}  // namespace

/// @throws Error (bad_input) for a quantity that the scenario does not have
void Session::showQuantity(const std::string& name) {
  if (const playback::ScenarioPtr computed = computedScenario()) {
    const std::string missing = missingQuantity(*computed, name);
    if (!missing.empty()) throw Error(ErrorCode::bad_input, missing);
    shown_quantity_ = name.empty() ? computed->output.quantities.front() : name;
  }
  quantity_ = name;
  takes_colors_ = true;
  live_.setQuantity(name);
}

/// Returns from a quantity or comparison that cannot be shown to those of the last field.
void Session::revertRejected() {
  if (!status_.failed) {
    if (picture_ && !status_.computing) last_shown_ = {quantity_, compares_};
    return;
  }
  if (last_shown_.quantity == quantity_ && last_shown_.compares == compares_) return;
  if (quantity_ != last_shown_.quantity) live_.setQuantity(last_shown_.quantity);
  if (compares_ != last_shown_.compares) live_.setComparison(last_shown_.compares);
  quantity_ = last_shown_.quantity;
  compares_ = last_shown_.compares;
  if (const playback::ScenarioPtr computed = computedScenario()) {
    shown_quantity_ = quantity_.empty() ? computed->output.quantities.front() : quantity_;
  }
  takes_colors_ = true;
  status_ = live_.status();
}

std::vector<Verb> Session::pictureVerbs() {
  return {
      {"mode",
       {{"mode", kText, false, {}, {}, [](const std::string& text) { render::parseCompositingMode(text); }}},
       "dvr, mida, mip or iso; without a name the next one",
       [](Session& session, const Command& command) {
         constexpr render::CompositingMode kModes[] = {
             render::CompositingMode::dvr, render::CompositingMode::mida, render::CompositingMode::mip,
             render::CompositingMode::iso};
         render::RenderSettings settings = session.settings_;
         settings.mode = command.has("mode") ? render::parseCompositingMode(command.text("mode"))
                                             : kModes[(static_cast<int>(session.settings_.mode) + 1) % 4];
         session.setSettings(settings);
       }},
      {"iso",
       {{"value", kNumber, false}},
       "Value of the isosurface; without one: shows it, or returns to the mode before",
       [](Session& session, const Command& command) {
         render::RenderSettings settings = session.settings_;
         const bool shown = settings.mode == render::CompositingMode::iso;
         settings.mode = shown && !command.has("value") ? session.fog_mode_ : render::CompositingMode::iso;
         if (command.has("value")) settings.iso_value = command.number("value");
         session.setSettings(settings);
       }},
      {"shading",
       {{"on", kBoolean, false}},
       "Shading of dvr and mida; iso is always shaded",
       [](Session& session, const Command& command) {
         render::RenderSettings settings = session.settings_;
         settings.shading = command.boolean("on", !settings.shading);
         session.setSettings(settings);
       }},
      {"exaggeration",
       {{"factor", kNumber, true, limitsOf(render::kExaggerationLimits)}},
       "Vertical exaggeration; 0: chosen from the box",
       [](Session& session, const Command& command) {
         render::RenderSettings settings = session.settings_;
         settings.vertical_exaggeration = command.number("factor");
         session.setSettings(settings);
       }},
      {"step_voxels",
       {{"value", kNumber, true, limitsOf(render::kStepLimits)}},
       "Distance between samples, in voxels",
       [](Session& session, const Command& command) {
         render::RenderSettings settings = session.settings_;
         settings.step_voxels = command.number("value");
         session.setSettings(settings);
       }},
      {"quantity",
       {{"name", kText}},
       "Shows another quantity",
       [](Session& session, const Command& command) { session.showQuantity(command.text("name")); }},
      {"pattern",
       {{"pattern", kText, false, {}, {}, [](const std::string& text) { patternNamed(text); }}},
       "auto or a pattern of rays; without a name the next one",
       [](Session& session, const Command& command) {
         const std::vector<render::Pattern>& all = render::allPatterns();
         if (command.has("pattern")) {
           session.pattern_ = patternNamed(command.text("pattern"));
         } else if (!session.pattern_) {
           session.pattern_ = all.front();
         } else {
           const auto next = std::next(std::find(all.begin(), all.end(), *session.pattern_));
           session.pattern_ = next == all.end() ? std::optional<render::Pattern>() : *next;
         }
         session.live_.setPattern(session.pattern_);
         session.tell(
             fmt::format("rays: {}", session.pattern_ ? render::toString(*session.pattern_) : "auto"));
       }},
      {"terrain",
       {{"on", kBoolean, false}},
       "Draws the ground",
       [](Session& session, const Command& command) {
         session.show_terrain_ = command.boolean("on", !session.show_terrain_);
         session.live_.showTerrain(session.show_terrain_);
       }},
      {"emitters",
       {{"on", kBoolean, false}},
       "Draws the emitters",
       [](Session& session, const Command& command) {
         session.show_emitters_ = command.boolean("on", !session.show_emitters_);
         session.live_.showEmitters(session.show_emitters_);
       }},
      {"theme",
       {{"theme", kText, false, {}, {}, [](const std::string& text) { render::parseTheme(text); }}},
       "dark or light; without a name the other one",
       [](Session& session, const Command& command) {
         if (command.has("theme")) {
           session.theme_ = render::parseTheme(command.text("theme"));
         } else {
           session.theme_ =
               session.theme_ == render::Theme::dark ? render::Theme::light : render::Theme::dark;
         }
         session.live_.setTheme(session.theme_);
       }},
  };
}

}  // namespace emscape::view
