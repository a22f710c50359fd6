/// Controls that show names of the user. Dear ImGui hides the part of a label from "##" on and leaves all
/// before "###" out of its identifier, so that these names are drawn as texts and identified by their hashes.
#pragma once

#include <imgui.h>
// imgui.h first
#include <imgui_internal.h>

#include <functional>
#include <string>

#include "apps/view/widgets/dialog.h"
#include "apps/view/widgets/glyphs.h"

namespace emscape::view {

/// The scope of identifiers of a name; ends with ImGui::PopID().
inline void pushNameId(const std::string& name) {
  ImGui::PushID(static_cast<int>(std::hash<std::string>()(name)));
}

/// Text of one line that ends with an ellipsis where it is too long.
/// @param at     upper left corner of the text
/// @param right  end of the control
/// @return true if it is too long
inline bool drawName(ImDrawList& list, const std::string& name, const ImVec2& at, float right) {
  const std::string text = drawable(name);
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  ImGui::RenderTextEllipsis(&list, at, {right, at.y + size.y}, right, right, text.c_str(),
                            text.c_str() + text.size(), &size);
  return at.x + size.x > right;
}

/// Shows the whole of a text that is too long while the mouse is over the item drawn last.
inline void tooltipOfLongName(const std::string& name, bool is_long) {
  if (is_long && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", drawable(name).c_str());
}

/// An entry of a list. The identifiers of the scope must differ by entry.
/// @param has_tab_stop  in a dialog
inline bool selectableName(const std::string& name, bool is_selected, ImGuiSelectableFlags flags = 0,
                           bool has_tab_stop = false) {
  const bool is_chosen = ImGui::Selectable("##name", is_selected, flags);
  if (has_tab_stop) tabStop();
  ImGui::SameLine(0, 0);
  ImGui::TextUnformatted(drawable(name).c_str());
  return is_chosen;
}

/// A collapsible heading as wide as the panel.
/// @param reserved  width at its end that the name leaves free
/// @return true if it is open
inline bool headingOfName(const char* id, const std::string& name, ImGuiTreeNodeFlags flags = 0,
                          float reserved = 0) {
  const ImVec2 at = ImGui::GetCursorScreenPos(), padding = ImGui::GetStyle().FramePadding;
  const bool is_open =
      ImGui::TreeNodeEx(id,
                        flags | ImGuiTreeNodeFlags_Framed | ImGuiTreeNodeFlags_SpanAvailWidth |
                            ImGuiTreeNodeFlags_NoTreePushOnOpen,
                        "%s", "");
  const bool is_long = drawName(*ImGui::GetWindowDrawList(), name,
                                {at.x + ImGui::GetFontSize() + 3 * padding.x, at.y + padding.y},
                                ImGui::GetItemRectMax().x - padding.x - reserved);
  tooltipOfLongName(name, is_long);
  return is_open;
}

/// A list that unfolds. @return true if it is open; ImGui::EndCombo() ends it
inline bool beginComboOfName(const char* id, const std::string& shown) {
  const ImVec2 at = ImGui::GetCursorScreenPos(), padding = ImGui::GetStyle().FramePadding;
  const float right = at.x + ImGui::CalcItemWidth() - ImGui::GetFrameHeight();
  ImDrawList& list = *ImGui::GetWindowDrawList();  // of the control, not of the unfolded list
  const bool is_open = ImGui::BeginCombo(id, "");
  const bool is_long = drawName(list, shown, {at.x + padding.x, at.y + padding.y}, right);
  if (!is_open) tooltipOfLongName(shown, is_long);
  return is_open;
}

}  // namespace emscape::view
