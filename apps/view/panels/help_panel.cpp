/// Help: first steps, keys and mouse.
#include <array>

#include "apps/view/panels/panels.h"
#include "apps/view/values/search_text.h"
#include "apps/view/widgets/dialog.h"
#include "apps/view/widgets/glyphs.h"
#include "apps/view/widgets/theme.h"
#include "apps/view/widgets/wrapped_text.h"

namespace emscape::view {
namespace {

constexpr const char* kFirstMinutes[]{
    "Drag in the picture: left turns, middle moves, the wheel goes nearer. R brings the first view back.",
    "Space plays the time; Left and Right step; drag the hand of the time line.",
    "What if (W): change a power, a height, a pattern; the field follows. Ctrl+Z takes it back.",
    "P locks the probe at the cursor: the value there, the path to each emitter, and why it is blocked.",
    "T: colours and opacity. C: the difference to the scenario as it was opened. H: a cut.",
    "Ctrl+S saves the changed scenario, Ctrl+M records a film, Ctrl+Shift+C copies the command for this "
    "picture.",
};

void drawFirstMinutes(PanelContext& context) {
  ImGui::TextColored(accentColor(context.session.theme()), "The first five minutes");
  for (const char* line : kFirstMinutes) {
    ImGui::Bullet();
    textWrapped(line);
  }
  ImGui::Spacing();
}

/// A row of keys, effect and command, if the search finds it. @return true if it does
bool drawRow(PanelContext& context, const std::string& searched, const std::string& keys,
             const std::string& does, const std::string& command_line) {
  if (!isFound(searched, keys + " " + does + " " + command_line)) return false;
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  textWrapped(keys);
  ImGui::TableNextColumn();
  textWrapped(does);
  if (command_line.empty()) return true;
  ImGui::TableNextColumn();
  ImGui::PushStyleColor(ImGuiCol_Text, mutedColor(context.session.theme()));
  textWrapped(command_line);
  ImGui::PopStyleColor();
  return true;
}

void drawKeys(PanelContext& context, const std::string& searched) {
  bool found = false;
  if (ImGui::BeginTable("gestures", 2, ImGuiTableFlags_RowBg)) {
    ImGui::TableSetupColumn("gesture", ImGuiTableColumnFlags_WidthStretch, 0.4F);
    ImGui::TableSetupColumn("does", ImGuiTableColumnFlags_WidthStretch, 0.6F);
    for (const Gesture& gesture : gestures())
      found |= drawRow(context, searched, gesture.gesture, gesture.does, "");
    ImGui::EndTable();
  }
  if (!ImGui::BeginTable("help", 3, ImGuiTableFlags_RowBg)) return;
  ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthStretch, 0.3F);
  ImGui::TableSetupColumn("does", ImGuiTableColumnFlags_WidthStretch, 0.34F);
  ImGui::TableSetupColumn("command line", ImGuiTableColumnFlags_WidthStretch, 0.36F);
  for (const std::string& menu : menuNames()) {
    if (searched.empty()) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextColored(accentColor(context.session.theme()), "%s", drawable(menu).c_str());
    }
    for (const Action& action : actions()) {
      if (menu != action.menu) continue;
      std::string keys;
      for (const KeyChord& chord : chordsOf(action)) keys += (keys.empty() ? "" : ", ") + toString(chord);
      found |= drawRow(context, searched, keys, action.name, action.command_line);
    }
  }
  ImGui::EndTable();
  if (!found) ImGui::TextDisabled("no key, action or option has these words");
}

}  // namespace

void drawHelp(PanelContext& context) {
  static std::array<char, 256> searched;
  if (!beginDialog(context, "Help", context.session.panels.help, {780, 640}, Waits::no)) return;
  if (ImGui::IsWindowAppearing()) {
    searched[0] = '\0';
    ImGui::SetKeyboardFocusHere();
  }
  ImGui::SetNextItemWidth(-1);
  ImGui::InputTextWithHint("##search", "search keys, actions and options", searched.data(), searched.size());
  ImGui::BeginChild("contents");
  if (searched[0] == '\0') drawFirstMinutes(context);
  drawKeys(context, searched.data());
  ImGui::EndChild();
  endDialog();
}

}  // namespace emscape::view
