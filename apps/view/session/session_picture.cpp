/// Verbs of the picture: mode, quantity, what is drawn.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "apps/view/session/session.h"
#include "apps/view/values/shown_quantity.h"
#include "emscape/base/error.h"
#include "playback/view/view_settings.h"

namespace emscape::view {
namespace {

/// @param name  "auto": empty. @throws Error (usage) that lists the names
std::optional<render::Pattern> patternNamed(const std::string& name) {
  if (name == "auto") return std::nullopt;
  return render::parsePattern(name);
}

Argument argumentOf(const playback::ViewSetting& setting) {
  Argument argument{setting.argument.c_str(), kText, false};
  if (setting.isSwitch()) {
    argument.type = kBoolean;
  } else if (setting.isNumber()) {
    argument = {setting.argument.c_str(), kNumber, true, {setting.spec.minimum, setting.spec.maximum}};
  } else if (setting.isListOfTexts()) {
    argument = {setting.argument.c_str(), ArgumentType::texts};
  } else {
    argument.required = !setting.isChoice();
  }
  for (const std::string& name : setting.spec.choices) argument.choices.push_back(name.c_str());
  return argument;
}

}  // namespace

/// Executes the verb of a setting: sets its value, or without one the next of its values.
void Session::changeSetting(const Command& command) {
  const playback::ViewSetting& setting = *playback::settingOfVerb(command.verb);
  const char* const name = setting.argument.c_str();
  change([&](playback::ViewState& view) {
    if (!command.has(name)) return setting.changeToNext(view);
    if (setting.isSwitch()) return setting.change(view, command.boolean(name, false));
    if (setting.isNumber()) return setting.change(view, command.number(name));
    if (setting.isListOfTexts()) {
      setting.change(view, command.arguments.at(name).get<std::vector<std::string>>());
    } else {
      setting.change(view, command.text(name));
    }
    playback::requireMapFiles(view, view_);
  });
}

/// @throws Error (bad_input) for a quantity that the scenario does not have
void Session::showQuantity(const std::string& name) {
  if (const playback::ScenarioPtr computed = computedScenario()) {
    const std::string missing = missingQuantity(*computed, name);
    if (!missing.empty()) throw Error(ErrorCode::bad_input, missing);
  }
  if (name == view_.quantity) return;
  leaveField();
  change([&](playback::ViewState& view) { playback::changeQuantity(view, name); });
}

const std::vector<ShownQuantity>& Session::quantities() {
  const playback::ScenarioPtr computed = showsFiles() ? nullptr : computedScenario();
  const bool is_known = !quantities_.empty() && computed == quantities_of_;
  if (is_known) return quantities_;
  quantities_of_ = computed;
  quantities_.clear();
  for (const std::string& name : computed ? quantitiesOf(*computed) : status_.quantities) {
    quantities_.push_back(titled(name));
  }
  return quantities_;
}

std::string Session::chosenQuantity() const {
  if (!view_.quantity.empty()) return view_.quantity;
  const playback::ScenarioPtr computed = showsFiles() ? nullptr : computedScenario();
  if (computed) return computed->output.quantities.front();
  return status_.quantities.empty() ? "" : status_.quantities.front();
}

/// Returns from a quantity or comparison that cannot be shown to those of the last field.
void Session::revertRejected() {
  if (!status_.failed) {
    if (picture_ && !status_.computing)
      last_shown_ = {view_.quantity, view_.compare, view_.split, view_.settings.iso_value};
    return;
  }
  if (showLastQuantity()) failure_.shown = fieldName(chosenQuantity());
  status_ = live_.status();
}

/// Returns to quantity and comparison of the last field.
bool Session::showLastQuantity() {
  if (last_shown_.quantity == view_.quantity && last_shown_.compare == view_.compare &&
      last_shown_.split == view_.split)
    return false;
  leaveField();
  change([this](playback::ViewState& view) {
    view.quantity = last_shown_.quantity;
    view.compare = last_shown_.compare;
    view.split = last_shown_.split;
    view.settings.iso_value = last_shown_.iso_value;
  });
  return true;
}

std::vector<Verb> Session::pictureVerbs() {
  std::vector<Verb> verbs;
  for (const playback::ViewSetting& setting : playback::viewSettings()) {
    if (setting.verb.empty()) continue;
    verbs.push_back({setting.verb.c_str(),
                     {argumentOf(setting)},
                     setting.verb_help.c_str(),
                     [](Session& session, const Command& command) { session.changeSetting(command); }});
  }
  const std::vector<Verb> others{
      {"iso",
       {{"value", kNumber, false}},
       "Value of the isosurface; without one: shows it, or returns to the mode before",
       [](Session& session, const Command& command) {
         session.change([&](playback::ViewState& view) {
           render::RenderSettings& settings = view.settings;
           const bool shown = settings.mode == render::CompositingMode::iso;
           settings.mode = shown && !command.has("value") ? session.fog_mode_ : render::CompositingMode::iso;
           if (command.has("value")) settings.iso_value = command.number("value");
         });
       }},
      {"reset_switches",
       {},
       "Sets all settings of the view that have a key or a verb as they were at the start, and removes "
       "planes "
       "and comparison; camera, quantity and colours stay",
       [](Session& session, const Command&) {
         const playback::ViewState& first = session.options_.view;
         session.change([&](playback::ViewState& view) {
           for (const playback::ViewSetting& setting : playback::viewSettings()) {
             const bool is_size_of_texts = setting.key == "label_scale";
             if (!setting.verb.empty() && !is_size_of_texts) setting.set(view, setting.get(first));
           }
           view.settings.map_height_agl_m = first.settings.map_height_agl_m;
           view.settings.map_opacity = first.settings.map_opacity;
           view.pattern = first.pattern;
         });
         session.setPlanes(first.settings.planes);
         if (session.view_.comparison() != first.comparison()) {
           session.leaveField();
           session.change([&](playback::ViewState& view) {
             playback::changeComparison(view, first.compare);
             playback::changeSplit(view, first.split);
           });
         }
         session.tell("all switches of the view are as they were at the start");
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
         std::optional<render::Pattern> pattern;
         if (command.has("pattern")) {
           pattern = patternNamed(command.text("pattern"));
         } else if (!session.view_.pattern) {
           pattern = all.front();
         } else {
           const auto next = std::next(std::find(all.begin(), all.end(), *session.view_.pattern));
           if (next != all.end()) pattern = *next;
         }
         session.change([&](playback::ViewState& view) { view.pattern = pattern; });
         session.tell(fmt::format("rays: {}", pattern ? render::toString(*pattern) : "auto"));
       }},
  };
  verbs.insert(verbs.end(), others.begin(), others.end());
  return verbs;
}

}  // namespace emscape::view
