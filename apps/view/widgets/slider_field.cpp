#include "apps/view/widgets/slider_field.h"

#include <imgui_internal.h>

#include <algorithm>
#include <utility>

#include "apps/view/widgets/names.h"
#include "apps/view/widgets/refusal.h"

namespace emscape::view {
namespace {

constexpr float kMargin = 5;  // of the scale in the frame, pixels at scale 1

}  // namespace

bool drawValueFrame(const char* id, const ValueFrame& frame, float width, float scale) {
  const ImVec2 at = ImGui::GetCursorScreenPos(), padding = ImGui::GetStyle().FramePadding;
  const ImVec2 size{std::max(1.0F, width), ImGui::GetFrameHeight()}, end{at.x + size.x, at.y + size.y};
  ImGui::InvisibleButton(id, size);
  const bool is_hovered = ImGui::IsItemHovered(), is_active = ImGui::IsItemActive();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float rounding = ImGui::GetStyle().FrameRounding;
  list.AddRectFilled(at, end,
                     ImGui::GetColorU32(is_active    ? ImGuiCol_FrameBgActive
                                        : is_hovered ? ImGuiCol_FrameBgHovered
                                                     : ImGuiCol_FrameBg),
                     rounding);
  ImGui::RenderFrameBorder(at, end, rounding);
  if (frame.position) {
    const auto position = static_cast<float>(std::clamp(*frame.position, 0.0, 1.0));
    const float left = at.x + kMargin * scale, right = end.x - kMargin * scale, y = end.y - 3.5F * scale;
    const float grip = left + position * (right - left);
    list.AddLine({left, y}, {right, y}, ImGui::GetColorU32(ImGuiCol_Border), 1.5F * scale);
    const ImU32 color =
        ImGui::GetColorU32(is_hovered || is_active ? ImGuiCol_SliderGrabActive : ImGuiCol_SliderGrab);
    list.AddLine({left, y}, {grip, y}, color, 2.5F * scale);
    list.AddCircleFilled({grip, y}, 3 * scale, color);
  }
  ImGui::PushStyleColor(ImGuiCol_Text, frame.ink);
  const bool is_long =
      drawName(list, frame.text, {at.x + padding.x, at.y + padding.y - (frame.position ? scale : 0)},
               end.x - padding.x);
  ImGui::PopStyleColor();
  return is_long;
}

bool dragPosition(double& position, bool& is_moved, float scale, double rate) {
  constexpr double kFine = 0.1;
  const ImGuiIO& io = ImGui::GetIO();
  const bool drags =
      ImGui::IsItemActive() && ImGui::IsMouseDragging(ImGuiMouseButton_Left, is_moved ? 0.0F : -1.0F);
  if (!drags) return false;
  const float moved_px =
      std::exchange(is_moved, true) ? io.MouseDelta.x : ImGui::GetMouseDragDelta(ImGuiMouseButton_Left).x;
  const float width = std::max(1.0F, ImGui::GetItemRectSize().x - 2 * kMargin * scale);
  const double before = position;
  position = std::clamp(position + (io.KeyShift ? kFine : 1) * rate * static_cast<double>(moved_px / width),
                        0.0, 1.0);
  return position != before;
}

bool wantsTyping() {
  const bool is_double = ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
  return is_double || (ImGui::IsItemClicked() && ImGui::GetIO().KeyCtrl);
}

bool sliderField(const PanelContext& context, const char* id, double& value, const NumberForm& form) {
  static struct {
    ImGuiID typing = 0, next = 0;
    int next_frame = 0;  ///< in which `next` was clicked: the field before gives its text in that frame
    bool is_open = false, is_moved = false;
    double position = 0;
  } state;
  const ImGuiID item = ImGui::GetID(id);
  const float width = ImGui::CalcItemWidth();
  const bool was_refused = isRefused(item);
  if (state.next == item && ImGui::GetFrameCount() > state.next_frame) {
    state.typing = std::exchange(state.next, 0);
    state.is_open = false;
  }
  if (state.typing == item || was_refused) {
    if (state.typing == item && !state.is_open) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(width);
    const bool is_entered = numberField(context, id, value, form);
    if (state.typing != item) return is_entered;
    if (state.is_open && !ImGui::IsItemActive()) state.typing = 0;
    state.is_open = state.is_open || ImGui::IsItemActive();
    return is_entered;
  }
  const double low = form.min, span = form.max > low ? form.max - low : 1;
  drawValueFrame(id, {form.textOf(value), ImGui::GetStyleColorVec4(ImGuiCol_Text), (value - low) / span},
                 width, context.scale);
  if (wantsTyping()) {
    state.next = item;
    state.next_frame = ImGui::GetFrameCount();
    ImGui::ClearActiveID();
    return false;
  }
  if (ImGui::IsItemActivated()) {
    state.position = (value - low) / span;
    state.is_moved = false;
  }
  if (!dragPosition(state.position, state.is_moved, context.scale)) return false;
  value = low + state.position * span;
  return true;
}

}  // namespace emscape::view
