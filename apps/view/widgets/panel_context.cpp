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

namespace {
int popup_frame = -2;  // the last one with an open popup
}

bool isPopupOpen() {
  const bool is_open = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
  if (is_open) popup_frame = ImGui::GetFrameCount();
  return is_open;
}

bool wasPopupOpen() {
  return isPopupOpen() || ImGui::GetFrameCount() - popup_frame <= 1;
}

bool isKeyPressed(ImGuiKey key, bool repeats) {
  return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key), repeats);
}

bool isEnterPressed() {
  return isKeyPressed(ImGuiKey_Enter) || isKeyPressed(ImGuiKey_KeyPadEnter);
}

}  // namespace emscape::view
