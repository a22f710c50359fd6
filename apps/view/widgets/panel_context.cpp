#include "apps/view/widgets/panel_context.h"

#include <imgui_internal.h>

#include <array>
#include <cstring>

#include "apps/view/commands/command.h"
#include "emscape/base/error.h"

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

bool numberField(const PanelContext& context, const char* id, double& value, const NumberForm& form) {
  static std::string typed;  // a field without the focus no longer returns it
  std::array<char, 96> text{};
  std::strncpy(text.data(), form.textOf(value).c_str(), text.size() - 1);
  const std::string before = text.data();
  ImGui::InputText(id, text.data(), text.size(), ImGuiInputTextFlags_AutoSelectAll);
  // In the frame of its activation another field may still return its text.
  if (ImGui::IsItemActive() && !ImGui::IsItemActivated()) typed = text.data();
  if (!ImGui::IsItemDeactivatedAfterEdit() || isKeyPressed(ImGuiKey_Escape) || typed == before) return false;
  try {
    value = form.valueOf(typed);
    return true;
  } catch (const Error& error) {
    context.session.tell(error.message(), true);
    return false;
  }
}

}  // namespace emscape::view
