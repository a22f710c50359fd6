#include "apps/view/widgets/refusal.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <utility>

#include "apps/view/widgets/dialog.h"
#include "apps/view/widgets/theme.h"
#include "apps/view/widgets/wrapped_text.h"
#include "emscape/base/error.h"

namespace emscape::view {
namespace {

/// A text that a field refused.
struct Refused {
  std::string text, why;
  std::string value;  ///< that the field had, as text
  ImGuiID window = 0;
  int frame = 0;         ///< in which the field was drawn last
  bool is_told = false;  ///< the reason is also the session's notice

  bool isDrawn() const { return ImGui::GetFrameCount() - frame <= 1; }
};

/// The refused texts, by field.
std::map<ImGuiID, Refused>& refusedTexts() {
  static std::map<ImGuiID, Refused> texts;
  return texts;
}

ImGuiID latest_field = 0;  // that refused a text

void refuse(ImGuiID field, const std::string& text, const std::string& why, const std::string& value,
            bool is_told) {
  latest_field = field;
  refusedTexts()[field] = {
      text, why, value, ImGui::GetCurrentWindow()->RootWindow->ID, ImGui::GetFrameCount(), is_told};
}

/// The refused text of a field of the present window; the end: none. A dialog that opens again has none.
std::map<ImGuiID, Refused>::iterator refusedTextOf(ImGuiID field) {
  auto& texts = refusedTexts();
  if (ImGui::GetCurrentWindow()->RootWindow->Appearing) texts.erase(field);
  return texts.find(field);
}

/// The colours of a field with a refused text, while it lives.
class RefusedColors {
 public:
  RefusedColors(const PanelContext& context, bool is_refused) : is_refused_(is_refused) {
    if (!is_refused_) return;
    const ImVec4 ink = errorColor(context.session.theme());
    ImGui::PushStyleColor(ImGuiCol_Border, ink);
    ImGui::PushStyleColor(ImGuiCol_Text, ink);
  }
  ~RefusedColors() {
    if (is_refused_) ImGui::PopStyleColor(2);
  }
  RefusedColors(const RefusedColors&) = delete;
  RefusedColors& operator=(const RefusedColors&) = delete;

 private:
  const bool is_refused_;
};

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
  const std::string text = wrapped(why, wrap);
  const float width = ImGui::CalcTextSize(text.c_str()).x + 2 * padding;
  const MessagePlace place = placeBeside(context, width);
  if (place.line_from) {
    ImGui::GetForegroundDrawList()->AddLine(*place.line_from, place.at, ImGui::ColorConvertFloat4ToU32(ink),
                                            s);
  }
  ImGui::SetNextWindowPos(place.at, ImGuiCond_Always, place.pivot);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(padding, 6 * s));
  ImGui::PushStyleColor(ImGuiCol_Border, ink);
  ImGui::Begin(fmt::format("refusal##{}", ImGui::GetItemID()).c_str(), nullptr,
               ImGuiWindowFlags_Tooltip | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoDecoration |
                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::TextColored(ink, "%s", text.c_str());
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
}

bool isRefused(ImGuiID field) {
  return refusedTexts().count(field) > 0;
}

bool hasRefusedField() {
  const ImGuiID window = ImGui::GetCurrentWindow()->RootWindow->ID;
  const auto& texts = refusedTexts();
  return std::any_of(texts.begin(), texts.end(), [window](const auto& field) {
    return field.second.window == window && field.second.isDrawn();
  });
}

bool isBesideField(const std::string& reason) {
  const auto& texts = refusedTexts();
  return std::any_of(texts.begin(), texts.end(), [&reason](const auto& field) {
    return field.second.is_told && field.second.isDrawn() && field.second.why == reason;
  });
}

bool numberField(const PanelContext& context, const char* id, double& value, const NumberForm& form) {
  static std::string typed;  // a field without the focus no longer returns it
  const ImGuiID field = ImGui::GetID(id);
  const std::string shown = form.textOf(value);
  auto& texts = refusedTexts();
  auto refused = refusedTextOf(field);
  if (refused != texts.end() && refused->second.value != shown) {  // it was changed elsewhere
    texts.erase(refused);
    refused = texts.end();
  }
  const bool is_refused = refused != texts.end();
  if (is_refused) refused->second.frame = ImGui::GetFrameCount();
  std::array<char, 96> text{};
  std::strncpy(text.data(), (is_refused ? refused->second.text : shown).c_str(), text.size() - 1);
  const std::string before = text.data();
  {
    const RefusedColors colors(context, is_refused);
    ImGui::InputText(id, text.data(), text.size(), ImGuiInputTextFlags_AutoSelectAll);
  }
  const bool is_escaped = isKeyPressed(ImGuiKey_Escape);
  const bool is_latest = field == latest_field && !ImGui::IsAnyItemActive();
  if (is_refused && (ImGui::IsItemActive() || ImGui::IsItemHovered() || is_latest))
    drawRefusal(context, refused->second.why);
  // In the frame of its activation another field may still return its text.
  if (ImGui::IsItemActive() && !ImGui::IsItemActivated()) typed = text.data();
  if (is_refused && is_escaped) texts.erase(refused);
  if (!ImGui::IsItemDeactivatedAfterEdit() || is_escaped || typed == before) return false;
  try {
    value = form.valueOf(typed);
    texts.erase(field);
    return true;
  } catch (const Error& error) {
    refuse(field, typed, error.message(), shown, false);
    return false;
  }
}

void actionField(const PanelContext& context, const char* id, const char* hint, FieldText& typed,
                 const char* button, const std::function<bool(const std::string& text)>& act) {
  static ImGuiID next_focus = 0;  // the field whose text was refused in the frame before
  const ImGuiID field = ImGui::GetID(id);
  auto& texts = refusedTexts();
  const auto refused = refusedTextOf(field);
  const bool is_refused = refused != texts.end() && refused->second.text == typed.data();
  if (is_refused) refused->second.frame = ImGui::GetFrameCount();
  if (next_focus == field) {
    next_focus = 0;
    ImGui::SetKeyboardFocusHere();
  }
  bool is_entered = false;
  {
    const RefusedColors colors(context, is_refused);
    is_entered = ImGui::InputTextWithHint(
        id, hint, typed.data(), typed.size(),
        ImGuiInputTextFlags_EnterReturnsTrue | (is_refused ? 0 : ImGuiInputTextFlags_AutoSelectAll));
  }
  if (is_refused) drawRefusal(context, refused->second.why);
  tabStop();
  ImGui::SameLine();
  const bool is_pressed = ImGui::Button(button, {64 * context.scale, 0});
  tabStop();
  if (!is_entered && !is_pressed) return;
  const std::string text = typed.data();
  if (act(text)) {
    texts.erase(field);
  } else {
    refuse(field, text, context.session.notice().text, "", true);
    next_focus = field;
  }
}

}  // namespace emscape::view
