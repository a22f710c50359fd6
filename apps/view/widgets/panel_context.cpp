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

}  // namespace emscape::view
