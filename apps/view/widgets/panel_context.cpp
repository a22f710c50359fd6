#include "apps/view/widgets/panel_context.h"

#include <imgui_internal.h>

#include "apps/view/commands/command.h"

namespace emscape::view {

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

}  // namespace emscape::view
