#include "apps/view/panels/panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "apps/view/panels/names.h"
#include "apps/view/panels/theme.h"
#include "emscape/render/annotate/legend.h"
#include "playback/view/view_settings.h"
#include "volume/difference.h"

namespace emscape::view {
namespace {

void place(const Area& area) {
  ImGui::SetNextWindowPos({area.x, area.y});
  ImGui::SetNextWindowSize({area.width, area.height});
}

bool isChecked(const Session& session, const std::string& name) {
  const Panels& panels = session.panels;
  if (name == "Loop") return session.timeline().loop();
  if (name == "Play or pause") return session.timeline().playing();
  for (const playback::ViewSetting& setting : playback::viewSettings()) {
    if (setting.isSwitch() && setting.action == name) return std::get<bool>(setting.get(session.view()));
  }
  if (name == "Isosurface") return session.settings().mode == render::CompositingMode::iso;
  if (name == "Scenario: what if") return panels.scenario && !panels.hidden;
  if (name == "Colours and opacity") return panels.colors && !panels.hidden;
  if (name == "Cutting planes") return panels.planes && !panels.hidden;
  if (name == "Compare with the original") return session.compares();
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
  if (name == "Save the changed scenario") return session.scenario() != nullptr;
  if (name == "Restore kept edits" || name == "Discard kept edits") return session.keptView().has_value();
  if (name == "Cancel the recording") return session.files().recorder.running();
  if (name == "Open the input before this")
    return session.files().recent.size() > (session.hasInput() ? 1 : 0);
  return true;
}

/// Description of the picture, its pattern and its times; the last parts are omitted if the width (pixels) is
/// too small.
std::string statusText(const Session& session, float room) {
  const playback::LiveStatus& status = session.status();
  std::vector<std::string> parts;
  if (volume::isDifference(session.picture()->info())) parts.emplace_back("DIFFERENCE");
  parts.emplace_back(session.exact() ? "exact" : "approximate");
  if (status.cells.empty()) {
    parts.push_back(fmt::format("{}{}, {:.0f} % of rays", session.view().pattern ? "" : "auto: ",
                                render::toString(status.pattern), 100 * status.rays_fraction));
  } else {
    parts.push_back(status.cells);
  }
  parts.push_back(fmt::format("cast {:.0f} ms", status.cast_ms));
  if (status.field_ms > 0) parts.push_back(fmt::format("field {:.0f} ms", status.field_ms));
  parts.push_back(status.device);
  std::string text;
  for (const std::string& part : parts) {
    const std::string longer = text + (text.empty() ? "" : "   ·   ") + part;
    if (!text.empty() && ImGui::CalcTextSize(longer.c_str()).x > room) break;
    text = longer;
  }
  return text;
}

}  // namespace

Layout layoutOf(const Session& session, float width, float height, float scale) {
  const Panels& panels = session.panels;
  Layout layout;
  if (panels.hidden) {
    layout.picture = {0, 0, width, height};
    return layout;
  }
  const float status_height = 30 * scale;
  const bool has_side = session.hasInput() && (panels.scenario || panels.colors || panels.planes);
  const float side_width = has_side ? std::min(340 * scale, 0.45F * width) : 0;
  const bool has_timeline = session.hasInput() && panels.timeline;
  const float timeline_height = has_timeline ? std::min(timelineHeight(session, scale), 0.4F * height) : 0;
  layout.menu_height = ImGui::GetFrameHeight();
  layout.status = {0, height - status_height, width, status_height};
  layout.timeline = {0, layout.status.y - timeline_height, width, timeline_height};
  const float middle = std::max(1.0F, layout.timeline.y - layout.menu_height);
  layout.side = {width - side_width, layout.menu_height, side_width, middle};
  layout.picture = {0, layout.menu_height, std::max(1.0F, width - side_width), middle};
  return layout;
}

float roomInLine(float spacing) {
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  return right - ImGui::GetItemRectMax().x - spacing;
}

void sameLineIfRoom(float width, float spacing) {
  if (roomInLine(spacing) >= width) ImGui::SameLine(0, spacing);
}

void perform(PanelContext& context, const char* command) {
  context.session.perform(parseCommand(std::string(command)));
}

bool isPopupOpen() {
  return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
}

bool isKeyPressed(ImGuiKey key, bool repeats) {
  return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key), repeats);
}

bool isEnterPressed() {
  return isKeyPressed(ImGuiKey_Enter) || isKeyPressed(ImGuiKey_KeyPadEnter);
}

bool numberField(const char* id, double& value, const char* format) {
  static double typed = 0;  // a field without the focus no longer returns it
  ImGui::InputDouble(id, &value, 0, 0, format, ImGuiInputTextFlags_AutoSelectAll);
  // In the frame of its activation another field may still return its number.
  if (ImGui::IsItemActive() && !ImGui::IsItemActivated()) typed = value;
  if (!ImGui::IsItemDeactivatedAfterEdit() || isKeyPressed(ImGuiKey_Escape)) return false;
  value = typed;
  return true;
}

void drawMenuBar(PanelContext& context) {
  if (!ImGui::BeginMainMenuBar()) return;
  for (const std::string& menu : menuNames()) {
    if (!ImGui::BeginMenu(menu.c_str())) continue;
    for (const Action& action : actions()) {
      if (menu != action.menu) continue;
      const std::string key = toString(chordsOf(action).front());
      if (ImGui::MenuItem(action.name, key.c_str(), isChecked(context.session, action.name),
                          isEnabled(context.session, action.name))) {
        perform(context, action.command.c_str());
      }
      if (action.name == std::string("Open the input before this")) drawRecentMenu(context);
    }
    ImGui::EndMenu();
  }
  ImGui::EndMainMenuBar();
}

void drawSidePanel(PanelContext& context, const Area& area) {
  if (area.width < 1) return;
  place(area);
  ImGui::Begin("side", nullptr, kFixedPanel);
  const Panels& panels = context.session.panels;
  const float height = ImGui::GetContentRegionAvail().y;
  if (panels.colors) {
    const bool more = panels.scenario || panels.planes;
    ImGui::BeginChild("colors", {0, more ? std::min(0.7F * height, 470 * context.scale) : 0});
    drawColorsPanel(context);
    ImGui::EndChild();
    if (more) ImGui::Separator();
  }
  if (panels.planes) {
    const auto rows = static_cast<float>(2 + 3 * context.session.settings().planes.size());
    const float wanted = rows * ImGui::GetFrameHeightWithSpacing();
    ImGui::BeginChild("planes", {0, panels.scenario ? std::min(height / 2, wanted) : 0});
    drawPlanesPanel(context);
    ImGui::EndChild();
    if (panels.scenario) ImGui::Separator();
  }
  if (panels.scenario) {
    // The panel scrolls if the others leave too little room.
    ImGui::BeginChild("scenario", {0, std::max(ImGui::GetContentRegionAvail().y, 200 * context.scale)});
    drawScenarioPanel(context);
    ImGui::EndChild();
  }
  ImGui::End();
}

void drawStatusBar(PanelContext& context, const Area& area) {
  const Session& session = context.session;
  const playback::LiveStatus& status = session.status();
  const float s = context.scale;
  place(area);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(12 * s, 5 * s));
  ImGui::Begin("status", nullptr, kFixedPanel | ImGuiWindowFlags_NoScrollbar);
  const bool is_opening = session.hasInput() || session.files().is_opening;
  const char* name = session.picture() ? render::toString(status.state) : is_opening ? "OPENING" : "EMPTY";
  const ImVec4 color = session.picture() ? stateColor(status.state) : mutedColor(session.theme());
  // The badge: the state's name on its colour.
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 text = ImGui::CalcTextSize(name);
  const float badge_width = ImGui::CalcTextSize("RESTORE").x + 16 * s;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({at.x, at.y - s}, {at.x + badge_width, at.y + text.y + 2 * s},
                     ImGui::ColorConvertFloat4ToU32(color), 4 * s);
  list.AddText({at.x + (badge_width - text.x) / 2, at.y}, IM_COL32(16, 20, 27, 255), name);
  ImGui::Dummy({badge_width, text.y});
  if (session.picture()) {
    ImGui::SameLine(0, 12 * s);
    const std::string right = status.shown_s == status.asked_s ? fmt::format("t = {:g} s", status.shown_s)
                                                               : fmt::format("requested {:g} s, shown {:g} s",
                                                                             status.asked_s, status.shown_s);
    const float right_x = area.width - ImGui::CalcTextSize(right.c_str()).x - 12 * s;
    const float room = right_x - ImGui::GetCursorPosX() - 12 * s;
    const std::string left = statusText(session, room);
    if (ImGui::CalcTextSize(left.c_str()).x <= room) {
      ImGui::TextUnformatted(left.c_str());
      ImGui::SameLine();
    }
    ImGui::SetCursorPosX(std::max(ImGui::GetCursorPosX(), right_x));
    if (status.shown_s == status.asked_s) {
      ImGui::TextUnformatted(right.c_str());
    } else {
      ImGui::TextColored(stateColor(render::ControllerState::busy), "%s", right.c_str());
    }
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

void drawNotice(PanelContext& context, const Area& picture) {
  const Session& session = context.session;
  const float s = context.scale;
  std::string text = session.notice().text;
  ImVec4 color =
      session.notice().is_error ? errorColor(session.theme()) : ImGui::GetStyleColorVec4(ImGuiCol_Text);
  if (text.empty() && !session.picture() && (session.hasInput() || session.files().is_opening)) {
    text = "opening …";
    color = mutedColor(session.theme());
  }
  const std::optional<Rejection>& rejection = session.rejection();
  if (context.shows_rejection && rejection && text == rejection->message) return;
  if (text.empty()) return;
  const float wrap = std::max(120 * s, std::min(picture.width - 60 * s, 760 * s));
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
  ImGui::SetNextWindowPos({picture.x + picture.width / 2, picture.y + picture.height - 24 * s},
                          ImGuiCond_Always, {0.5F, 1.0F});
  ImGui::SetNextWindowSize({size.x + 32 * s, size.y + 20 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(16 * s, 10 * s));
  ImGui::SetNextWindowBgAlpha(0.94F);
  ImGui::Begin("notice", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::PushTextWrapPos(wrap + 16 * s);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
  ImGui::End();
  ImGui::PopStyleVar(2);
}

void drawHelp(PanelContext& context) {
  if (!context.session.panels.help) return;
  const float s = context.scale;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const ImVec2 size{std::min(780 * s, 0.94F * screen.x), std::min(640 * s, 0.9F * screen.y)};
  ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Appearing, {0.5F, 0.5F});
  ImGui::SetNextWindowSize(size, ImGuiCond_Appearing);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  if (ImGui::Begin("Help", &context.session.panels.help,
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings)) {
    if (ImGui::BeginTable("help", 3, ImGuiTableFlags_RowBg)) {
      ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthStretch, 0.34F);
      ImGui::TableSetupColumn("does", ImGuiTableColumnFlags_WidthStretch, 0.33F);
      ImGui::TableSetupColumn("command line", ImGuiTableColumnFlags_WidthStretch, 0.33F);
      for (const Gesture& gesture : gestures()) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextWrapped("%s", gesture.gesture);
        ImGui::TableNextColumn();
        ImGui::TextWrapped("%s", gesture.does);
        ImGui::TableNextColumn();
      }
      for (const std::string& menu : menuNames()) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextColored(accentColor(context.session.theme()), "%s", menu.c_str());
        for (const Action& action : actions()) {
          if (menu != action.menu) continue;
          std::string keys;
          for (const KeyChord& chord : chordsOf(action)) keys += (keys.empty() ? "" : ", ") + toString(chord);
          ImGui::TableNextRow();
          ImGui::TableNextColumn();
          ImGui::TextWrapped("%s", keys.c_str());
          ImGui::TableNextColumn();
          ImGui::TextWrapped("%s", action.name);
          ImGui::TableNextColumn();
          ImGui::PushStyleColor(ImGuiCol_Text, mutedColor(context.session.theme()));
          ImGui::TextWrapped("%s", action.command_line.c_str());
          ImGui::PopStyleColor();
        }
      }
      ImGui::EndTable();
    }
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

void drawGoToTime(PanelContext& context) {
  Session& session = context.session;
  if (!session.panels.time) return;
  static char typed[64] = "";
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Appearing, {0.5F, 0.5F});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * context.scale);
  ImGui::Begin(
      "Go to time", &session.panels.time,
      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  if (ImGui::IsWindowAppearing()) {
    *fmt::format_to_n(typed, sizeof typed - 1, "{:g}", session.timeline().step_s()).out = '\0';
    ImGui::SetKeyboardFocusHere();
  }
  ImGui::SetNextItemWidth(160 * context.scale);
  const bool entered =
      ImGui::InputText("seconds, or UTC", typed, sizeof typed,
                       ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  ImGui::SameLine();
  if (ImGui::Button("Go") || entered) {
    const double told_s = session.notice().since_s;
    session.perform({"seek", {{"time", typed}}});
    session.panels.time = session.notice().is_error && session.notice().since_s != told_s;
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace emscape::view
