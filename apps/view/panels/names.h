/// Controls that show names of the user. Dear ImGui hides the part of a label from "##" on and leaves all
/// before "###" out of its identifier, so that these names are drawn as texts and identified by their hashes.
#pragma once

#include <imgui.h>

#include <algorithm>
#include <functional>
#include <string>

#include "apps/view/panels/glyphs.h"

namespace emscape::view {

/// The scope of identifiers of a name; ends with ImGui::PopID().
inline void pushNameId(const std::string& name) {
  ImGui::PushID(static_cast<int>(std::hash<std::string>()(name)));
}

/// As much of a text as fits into a width, with an ellipsis if that is not all.
inline std::string shortened(const std::string& text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  const float room = width - ImGui::CalcTextSize("…").x;
  const char* end = nullptr;
  ImGui::GetFont()->CalcTextSizeA(ImGui::GetFontSize(), std::max(room, 0.0F), 0, text.c_str(), nullptr, &end);
  return text.substr(0, static_cast<std::size_t>(end - text.c_str())) + "…";
}

/// Text in a control of one line, shortened where the control ends.
/// @param at     upper left corner of the text
/// @param right  end of the control
inline void drawName(ImDrawList& list, const std::string& name, const ImVec2& at, float right) {
  list.PushClipRect(at, {right, at.y + ImGui::GetTextLineHeight()}, true);
  list.AddText(at, ImGui::GetColorU32(ImGuiCol_Text), shortened(drawable(name), right - at.x).c_str());
  list.PopClipRect();
}

/// An entry of a list. The identifiers of the scope must differ by entry.
inline bool selectableName(const std::string& name, bool is_selected, ImGuiSelectableFlags flags = 0) {
  const bool is_chosen = ImGui::Selectable("##name", is_selected, flags);
  ImGui::SameLine(0, 0);
  ImGui::TextUnformatted(drawable(name).c_str());
  return is_chosen;
}

/// A collapsible heading as wide as the panel. @return true if it is open
inline bool headingOfName(const char* id, const std::string& name) {
  const ImVec2 at = ImGui::GetCursorScreenPos(), padding = ImGui::GetStyle().FramePadding;
  const bool is_open = ImGui::TreeNodeEx(
      id, ImGuiTreeNodeFlags_Framed | ImGuiTreeNodeFlags_SpanAvailWidth | ImGuiTreeNodeFlags_NoTreePushOnOpen,
      "%s", "");
  drawName(*ImGui::GetWindowDrawList(), name, {at.x + ImGui::GetFontSize() + 3 * padding.x, at.y + padding.y},
           ImGui::GetItemRectMax().x);
  return is_open;
}

/// A list that unfolds. @return true if it is open; ImGui::EndCombo() ends it
inline bool beginComboOfName(const char* id, const std::string& shown) {
  const ImVec2 at = ImGui::GetCursorScreenPos(), padding = ImGui::GetStyle().FramePadding;
  const float right = at.x + ImGui::CalcItemWidth() - ImGui::GetFrameHeight();
  ImDrawList& list = *ImGui::GetWindowDrawList();  // of the control, not of the unfolded list
  const bool is_open = ImGui::BeginCombo(id, "");
  drawName(list, shown, {at.x + padding.x, at.y + padding.y}, right);
  return is_open;
}

}  // namespace emscape::view
