#include "apps/view/widgets/refusal.h"

#include <imgui_internal.h>

#include <array>
#include <cstring>
#include <optional>

#include "apps/view/widgets/glyphs.h"
#include "apps/view/widgets/theme.h"
#include "emscape/base/error.h"

namespace emscape::view {
namespace {

/// The text that was refused last.
struct Refused {
  ImGuiID field = 0;
  std::string text, why;
  std::string value;  ///< that the field had, as text
  ImGuiID window = 0;
  int frame = 0;  ///< in which the field was drawn last
};

Refused& lastRefused() {
  static Refused refused;
  return refused;
}

/// Where a message stands, and the end of a line that leads from it to the item; none: it is at the item.
struct MessagePlace {
  ImVec2 at, pivot;
  std::optional<ImVec2> line_from;
};

MessagePlace placeBeside(const PanelContext& context, float width) {
  const float gap = 8 * context.scale;
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const ImGuiWindow& window = *ImGui::GetCurrentWindow()->RootWindow;
  const float middle = (low.y + high.y) / 2, end = window.Pos.x + window.Size.x;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  if (end + gap + width < screen.x) return {{end + gap, middle}, {0, 0.5F}, ImVec2(end, middle)};
  const bool is_at_edge = end > screen.x - 1;  // the side panel, with the picture at its left
  const float before = is_at_edge ? legendBegin(context, window.Pos.x) - gap : window.Pos.x - gap;
  if (before - width > 0) return {{before, middle}, {1, 0.5F}, ImVec2(window.Pos.x, middle)};
  if (low.y > screen.y / 2) return {{low.x, low.y - gap / 2}, {0, 1}, {}};
  return {{low.x, high.y + gap / 2}, {0, 0}, {}};
}

}  // namespace

float legendBegin(const PanelContext& context, float picture_end) {
  const std::optional<Viewport> viewport = context.session.viewport();
  return viewport ? picture_end - static_cast<float>(viewport->margins.right * viewport->size.width)
                  : picture_end;
}

void drawRefusal(const PanelContext& context, const std::string& why) {
  const float s = context.scale, wrap = 280 * s, padding = 8 * s;
  const ImVec4 ink = errorColor(context.session.theme());
  const std::string text = drawable(why);
  const float width = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap).x + 2 * padding;
  const MessagePlace place = placeBeside(context, width);
  if (place.line_from) {
    ImGui::GetForegroundDrawList()->AddLine(*place.line_from, place.at, ImGui::ColorConvertFloat4ToU32(ink),
                                            s);
  }
  ImGui::SetNextWindowPos(place.at, ImGuiCond_Always, place.pivot);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(padding, 6 * s));
  ImGui::PushStyleColor(ImGuiCol_Border, ink);
  ImGui::Begin("refusal", nullptr,
               ImGuiWindowFlags_Tooltip | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoDecoration |
                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::PushTextWrapPos(wrap);
  ImGui::TextColored(ink, "%s", text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
}

bool isRefused(ImGuiID field) {
  return lastRefused().field == field;
}

bool hasRefusedField() {
  const Refused& refused = lastRefused();
  return refused.field != 0 && refused.window == ImGui::GetCurrentWindow()->RootWindow->ID &&
         ImGui::GetFrameCount() - refused.frame <= 1;
}

bool numberField(const PanelContext& context, const char* id, double& value, const NumberForm& form) {
  static std::string typed;  // a field without the focus no longer returns it
  const ImGuiID field = ImGui::GetID(id);
  const std::string shown = form.textOf(value);
  Refused& refused = lastRefused();
  if (refused.field == field && refused.value != shown) refused = {};  // it was changed elsewhere
  const bool is_refused = refused.field == field;
  if (is_refused) refused.frame = ImGui::GetFrameCount();
  std::array<char, 96> text{};
  std::strncpy(text.data(), (is_refused ? refused.text : shown).c_str(), text.size() - 1);
  const std::string before = text.data();
  const ImVec4 ink = errorColor(context.session.theme());
  if (is_refused) {
    ImGui::PushStyleColor(ImGuiCol_Border, ink);
    ImGui::PushStyleColor(ImGuiCol_Text, ink);
  }
  ImGui::InputText(id, text.data(), text.size(), ImGuiInputTextFlags_AutoSelectAll);
  if (is_refused) ImGui::PopStyleColor(2);
  const bool is_escaped = isKeyPressed(ImGuiKey_Escape);
  if (is_refused && (ImGui::IsItemActive() || ImGui::IsItemHovered() || !ImGui::IsAnyItemActive()))
    drawRefusal(context, refused.why);
  // In the frame of its activation another field may still return its text.
  if (ImGui::IsItemActive() && !ImGui::IsItemActivated()) typed = text.data();
  if (is_refused && is_escaped) refused = {};
  if (!ImGui::IsItemDeactivatedAfterEdit() || is_escaped || typed == before) return false;
  try {
    value = form.valueOf(typed);
    if (isRefused(field)) refused = {};
    return true;
  } catch (const Error& error) {
    refused = {field,
               typed,
               error.message(),
               shown,
               ImGui::GetCurrentWindow()->RootWindow->ID,
               ImGui::GetFrameCount()};
    return false;
  }
}

}  // namespace emscape::view
