#include "apps/view/widgets/row_focus.h"

#include <GLFW/glfw3.h>
#include <imgui.h>
// imgui.h first
#include <imgui_internal.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "apps/view/widgets/glyphs.h"
#include "apps/view/widgets/panel_context.h"

namespace emscape::view {
namespace {

constexpr const char* kNumberBegins = "0123456789+-.,";

/// Keys are those of GLFW: ImGuiIO::KeyMap has no Tab while the panel handles it.
bool isPressed(int key) {
  return ImGui::IsKeyPressed(key, true);
}

/// The printable characters of this frame, as UTF-8.
std::string typedCharacters() {
  std::string text;
  for (const ImWchar c : ImGui::GetIO().InputQueueCharacters) {
    char bytes[5] = "";
    ImTextCharToUtf8(bytes, c);
    if (c > ' ' && c != 0x7F) text += bytes;
  }
  return text;
}

/// Puts the cursor behind the characters with which the field was opened, instead of selecting them.
int leaveSelection(ImGuiInputTextCallbackData* data) {
  bool& is_pending = *static_cast<bool*>(data->UserData);
  if (!std::exchange(is_pending, false)) return 0;
  data->CursorPos = data->SelectionStart = data->SelectionEnd = data->BufTextLen;
  return 0;
}

}  // namespace

RowFocus& scenarioFocus() {
  static RowFocus focus;
  return focus;
}

bool RowFocus::isShown() const {
  return ImGui::GetFrameCount() - drawn_frame_ <= 1;
}

bool RowFocus::hasKeyboard() const {
  return isShown() && (!focused_.empty() || !typing_.empty());
}

bool RowFocus::takes(const KeyChord& chord) const {
  if (!hasKeyboard()) return false;
  const bool is_space = chord.key == "Space", is_character = is_space || chord.key.size() == 1;
  if (!is_character || !typing_.empty() || text_of_focused_ == RowText::all) return true;
  if (text_of_focused_ == RowText::none) return is_space;
  return std::strchr(kNumberBegins, chord.key[0]) != nullptr;
}

std::string RowFocus::typed(const std::string& row) const {
  const bool opens =
      text_of_focused_ == RowText::all || (text_of_focused_ == RowText::number && !characters_.empty() &&
                                           std::strchr(kNumberBegins, characters_[0]) != nullptr);
  return has(row) && opens ? characters_ : std::string();
}

int RowFocus::steps(const std::string& row) const {
  if (!has(row)) return 0;
  return key_ == Key::left ? -1 : key_ == Key::right ? 1 : 0;
}

void RowFocus::move(int by) {
  if (rows_before_.empty()) return;
  const std::string& from = focused_.empty() ? last_ : focused_;
  const auto at = std::find(rows_before_.begin(), rows_before_.end(), from);
  const auto count = static_cast<int>(rows_before_.size());
  const auto index = static_cast<int>(at - rows_before_.begin());
  int next = at == rows_before_.end() ? (by > 0 ? 0 : count - 1) : (index + by + count) % count;
  if (focused_.empty() && at != rows_before_.end()) next = index;  // back to where it was
  focused_ = rows_before_[static_cast<std::size_t>(next)];
  moved_ = true;
}

void RowFocus::beginFrame(bool is_behind_dialog) {
  rows_before_ = std::exchange(rows_, {});
  const bool was_shown = isShown();
  drawn_frame_ = ImGui::GetFrameCount();
  key_ = Key::none;
  characters_.clear();
  escaped_.clear();
  moved_ = leaves_ = false;
  if (!was_shown || (!typing_.empty() && drawn_frame_ - drawn_field_frame_ > 1)) typing_.clear();
  if (!was_shown) focused_.clear();
  if (!next_typing_.empty()) {
    typing_ = std::exchange(next_typing_, {});
    opened_text_ = next_text_;
    selects_ = next_selects_;
    std::strncpy(text_.data(), next_text_.c_str(), text_.size() - 1);
    is_open_ = false;
    drawn_field_frame_ = drawn_frame_;
    return;
  }
  const ImGuiIO& io = ImGui::GetIO();
  if (is_behind_dialog && typing_.empty()) {
    focused_.clear();
    return;
  }
  if (isPopupOpen() || io.KeyCtrl || io.KeyAlt || io.KeySuper) return;
  const bool has_tab = io.KeyMap[ImGuiKey_Tab] < 0 && isPressed(GLFW_KEY_TAB);
  if (!typing_.empty()) {
    leaves_ = has_tab;
    if (leaves_) will_move_ = io.KeyShift ? -1 : 1;
    return;
  }
  if (const int by = std::exchange(will_move_, 0)) return move(by);
  if (io.WantTextInput) return;  // another field
  if (has_tab) return move(io.KeyShift ? -1 : 1);
  if (focused_.empty()) return;
  if (isPressed(GLFW_KEY_DOWN)) move(1);
  if (isPressed(GLFW_KEY_UP)) move(-1);
  if (isPressed(GLFW_KEY_LEFT)) key_ = Key::left;
  if (isPressed(GLFW_KEY_RIGHT)) key_ = Key::right;
  if (isPressed(GLFW_KEY_SPACE)) key_ = Key::space;
  if (isPressed(GLFW_KEY_ENTER) || isPressed(GLFW_KEY_KP_ENTER)) key_ = Key::enter;
  if (isPressed(GLFW_KEY_ESCAPE) && !io.KeyShift) escaped_ = std::exchange(focused_, {});
  characters_ = typedCharacters();
}

void RowFocus::endFrame(bool is_clicked_elsewhere) {
  if (is_clicked_elsewhere) focused_.clear();
  if (!focused_.empty()) last_ = focused_;
}

void RowFocus::type(const std::string& row, const std::string& text, bool selects) {
  ImGui::ClearActiveID();  // the field has the identifier of the control that it replaces
  focused_ = next_typing_ = row;
  next_text_ = text;
  next_selects_ = selects;  // the field that is open gives its text in this frame
}

std::optional<std::string> RowFocus::drawField() {
  drawn_field_frame_ = ImGui::GetFrameCount();
  if (!is_open_) ImGui::SetKeyboardFocusHere();
  const ImGuiInputTextFlags selection =
      selects_ ? ImGuiInputTextFlags_AutoSelectAll : ImGuiInputTextFlags_CallbackAlways;
  static bool is_selection_pending = false;
  if (!is_open_) is_selection_pending = true;
  Glyphs::ofWindow().need(text_.data());
  ImGui::InputText("##value", text_.data(), text_.size(), selection, leaveSelection, &is_selection_pending);
  const bool was_open = is_open_;
  is_open_ = is_open_ || ImGui::IsItemActive();
  if (leaves_ && was_open) ImGui::ClearActiveID();
  const bool ends = was_open && (leaves_ || !ImGui::IsItemActive());
  if (!ends) return std::nullopt;
  typing_.clear();
  if (isKeyPressed(ImGuiKey_Escape)) return std::nullopt;
  const std::string text = text_.data();
  // Characters that opened the field are a change.
  return selects_ && text == opened_text_ ? std::nullopt : std::optional(text);
}

}  // namespace emscape::view
