/// The menus.
#include <fmt/format.h>

#include <cctype>
#include <set>

#include "apps/view/panels/panels.h"
#include "apps/view/values/shown_quantity.h"
#include "apps/view/widgets/names.h"
#include "emscape/render/annotate/legend.h"
#include "playback/view/view_settings.h"

namespace emscape::view {
namespace {

bool isChecked(const Session& session, const std::string& name) {
  const Panels& panels = session.panels;
  if (name == "Loop") return session.timeline().loop();
  if (name == "Play or pause") return session.timeline().playing();
  for (const playback::ViewSetting& setting : playback::viewSettings()) {
    if (setting.isSwitch() && setting.action == name) return std::get<bool>(setting.get(session.view()));
  }
  if (name == "Map layer") return session.settings().map_height_agl_m.has_value();
  if (name == "Isosurface") return session.settings().mode == render::CompositingMode::iso;
  if (name == "Scenario: what if") return panels.scenario && !panels.hidden;
  if (name == "Colours and opacity") return panels.colors && !panels.hidden;
  if (name == "Cutting planes") return panels.planes && !panels.hidden;
  if (name == "Compare with the original") return session.compares();
  if (name == "Split: original and changed") return session.isSplit();
  if (name == "Probe") return panels.probe && !panels.hidden;
  if (name == "Lock or unlock the probe") return session.prober().isLocked();
  if (name == "Timeline") return panels.timeline && !panels.hidden;
  return name == "Help" && panels.help;
}

void drawRecentMenu(PanelContext& context) {
  const std::vector<std::string> recent = context.session.files().recent;
  if (!ImGui::BeginMenu("Open recent", !recent.empty())) return;
  for (std::size_t i = 0; i < recent.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (selectableName(recent[i], false)) context.session.perform({"open_recent", {{"number", i + 1}}});
    ImGui::PopID();
  }
  ImGui::EndMenu();
}

bool isEnabled(const Session& session, const std::string& name) {
  static const std::set<std::string> kNeedInput{"Reload",          "Save the view", "Load a view",
                                                "Copy as command", "Record",        "Save the picture"};
  if (!session.hasInput() && kNeedInput.count(name) != 0) return false;
  if (name == "Undo") return session.canUndo();
  if (name == "Redo") return session.canRedo();
  if (name == "Save the changed scenario" || name == "Save the scenario as")
    return session.scenario() != nullptr;
  if (name == "Add the scenario") return session.showsFiles();
  if (name == "Restore kept edits" || name == "Discard kept edits") return session.keptView().has_value();
  if (name == "Cancel the recording") return session.files().recorder.running();
  if (name == "Open the input before this")
    return session.files().recent.size() > (session.hasInput() ? 1 : 0);
  return true;
}

std::string keyOf(const Action& action) {
  const std::vector<KeyChord> chords = chordsOf(action);
  return chords.empty() ? "" : toString(chords.front());
}

void drawAction(PanelContext& context, const Action& action) {
  if (ImGui::MenuItem(action.name, keyOf(action).c_str(), isChecked(context.session, action.name),
                      isEnabled(context.session, action.name))) {
    perform(context, action.command.c_str());
  }
}

/// A submenu of values to choose from. @param key  changes to the next one
void drawChoices(const std::string& title, const std::string& key, const std::vector<std::string>& values,
                 const std::string& present, const std::function<void(const std::string&)>& choose) {
  if (!ImGui::BeginMenu(title.c_str(), !values.empty())) return;
  for (const std::string& value : values) {
    if (ImGui::MenuItem((drawable(value) + "###" + value).c_str(), nullptr, value == present)) choose(value);
  }
  if (!key.empty()) ImGui::TextDisabled("%s: the next one", key.c_str());
  ImGui::EndMenu();
}

/// "Side" of "Next side": the menu lists them.
std::string titleOf(const std::string& action) {
  const std::string next = "Next ";
  if (action.compare(0, next.size(), next) != 0) return action;
  std::string title = action.substr(next.size());
  title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  return title;
}

/// The choices of an action that changes a value to its next one. @return false if it is no such action
bool drawChoicesOf(PanelContext& context, const Action& action) {
  Session& session = context.session;
  if (action.name == std::string("Next pattern of rays")) {
    std::vector<std::string> patterns{"auto"};
    for (const render::Pattern pattern : render::allPatterns())
      patterns.emplace_back(render::toString(pattern));
    const auto& pattern = session.view().pattern;
    drawChoices("Rays", keyOf(action), patterns, pattern ? render::toString(*pattern) : "auto",
                [&](const std::string& name) {
                  session.perform({"pattern", {{"pattern", name}}});
                });
    return true;
  }
  for (const playback::ViewSetting& setting : playback::viewSettings()) {
    if (setting.action != action.name || !setting.isChoice()) continue;
    drawChoices(titleOf(setting.action), keyOf(action), setting.spec.choices, setting.text(session.view()),
                [&](const std::string& name) {
                  session.perform({setting.verb, {{setting.argument, name}}});
                });
    return true;
  }
  return false;
}

void drawQuantities(PanelContext& context) {
  Session& session = context.session;
  const std::vector<ShownQuantity> quantities =
      session.picture() ? session.quantities() : std::vector<ShownQuantity>();
  if (!ImGui::BeginMenu("Quantity", quantities.size() > 1)) return;
  drawQuantityList(context, quantities);
  ImGui::EndMenu();
}

void drawViewMenu(PanelContext& context) {
  Session& session = context.session;
  drawQuantities(context);
  const playback::TransferEditor* const transfer = session.transfer();
  drawChoices("Colour map", "", transfer ? playback::TransferEditor::presets() : std::vector<std::string>(),
              transfer ? transfer->colorMap() : "", [&](const std::string& name) {
                session.perform({"transfer", {{"colors", name}}});
              });
  std::set<std::string> drawn;
  bool was_item = false;
  for (const Action& action : actions()) {
    if (action.menu != std::string("View")) continue;
    const std::string section = action.section;
    if (section.empty()) {
      if (drawChoicesOf(context, action)) continue;
      if (!was_item) ImGui::Separator();
      was_item = true;
      drawAction(context, action);
    } else if (drawn.insert(section).second) {
      if (was_item) ImGui::Separator();
      was_item = false;
      if (!ImGui::BeginMenu(action.section)) continue;
      for (const Action& other : actions()) {
        if (other.menu != std::string("View") || other.section != section) continue;
        if (!drawChoicesOf(context, other)) drawAction(context, other);
      }
      if (section == "Map") {
        ImGui::Separator();
        const Action& places = *actionOf(parseChord("Ctrl+Shift+G"));
        if (ImGui::MenuItem("Places, picture, range rings", keyOf(places).c_str(), session.panels.map))
          perform(context, places.command.c_str());
      }
      ImGui::EndMenu();
    }
  }
}

void drawMenu(PanelContext& context, const std::string& menu) {
  std::string section;
  for (const Action& action : actions()) {
    if (menu != action.menu) continue;
    if (!section.empty() && section != action.section) ImGui::Separator();
    section = action.section;
    drawAction(context, action);
    if (action.name == std::string("Open the input before this")) drawRecentMenu(context);
  }
}

}  // namespace

void drawQuantityList(PanelContext& context, const std::vector<ShownQuantity>& quantities) {
  Session& session = context.session;
  const std::string shown = session.chosenQuantity();
  for (const ShownQuantity& quantity : quantities) {
    pushNameId(quantity.name);
    if (selectableName(quantity.title, quantity.name == shown)) {
      session.perform({"quantity", {{"name", quantity.name}}});
    }
    if (quantity.name == shown && ImGui::IsWindowAppearing()) ImGui::SetItemDefaultFocus();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("--quantity %s", quantity.name.c_str());
    ImGui::PopID();
  }
}

void drawMenuBar(PanelContext& context) {
  if (!ImGui::BeginMainMenuBar()) return;
  for (const std::string& menu : menuNames()) {
    if (!ImGui::BeginMenu(menu.c_str())) continue;
    if (menu == "View") {
      drawViewMenu(context);
    } else {
      drawMenu(context, menu);
    }
    ImGui::EndMenu();
  }
  drawSideButton(context);
  ImGui::EndMainMenuBar();
}

}  // namespace emscape::view
