#include "apps/view/mouse_control.h"

#include <GLFW/glfw3.h>

#include <cmath>
#include <utility>

#include "apps/view/panels/theme.h"
#include "emscape/base/error.h"

namespace emscape::view {
namespace {

constexpr double kOrbit_deg_px = 0.3;
constexpr double kLook_deg_px = 0.15;
constexpr double kDollyPerNotch = 0.85;
constexpr double kFly_diagonals_s = 0.15;
constexpr double kFast = 4;
constexpr double kDoubleClick_s = 0.35;
constexpr double kDoubleClick_px = 5;
constexpr double kClick_px = 3;  // a shorter movement is not yet a drag

bool isInside(const Area& area, double x, double y) {
  return x >= area.x && y >= area.y && x < area.x + area.width && y < area.y + area.height;
}

}  // namespace

void MouseControl::handle(const std::vector<InputEvent>& events, const Area& picture, bool panels_want_mouse,
                          Session& session) {
  bool moved = false;
  for (const InputEvent& event : events) {
    const std::optional<Viewport> viewport = session.viewport();
    if (event.kind == InputEvent::Kind::cursor) {
      const double right_px = event.x - x_, down_px = event.y - y_;
      x_ = event.x;
      y_ = event.y;
      if (drag_ == Drag::none || !viewport) continue;
      if (drag_ == Drag::platform) {
        movePlatform(picture, session);
        continue;
      }
      CameraControl& camera = session.camera();
      if (drag_ == Drag::orbit) camera.orbit(kOrbit_deg_px * right_px, kOrbit_deg_px * down_px, *viewport);
      if (drag_ == Drag::pan) camera.pan(right_px, down_px, *viewport);
      if (drag_ == Drag::look) camera.look(kLook_deg_px * right_px, kLook_deg_px * down_px, *viewport);
      moved = moved || right_px != 0 || down_px != 0;
    } else if (event.kind == InputEvent::Kind::button && event.action == GLFW_RELEASE) {
      if (event.code != button_) continue;
      if (drag_ == Drag::platform) session.endDrag();
      drag_ = Drag::none;
    } else if (panels_want_mouse || !viewport) {
      continue;
    } else if (event.kind == InputEvent::Kind::button) {
      if (isInside(picture, x_, y_) && drag_ == Drag::none) press(event, picture, session);
    } else if (event.kind == InputEvent::Kind::wheel && event.y != 0) {
      session.camera().dolly(std::pow(kDollyPerNotch, event.y), x_ - picture.x, y_ - picture.y, *viewport);
      moved = true;
    }
  }
  if (moved) session.cameraMoved();
  if (drag_ == Drag::none) {
    const bool is_over = !panels_want_mouse && isInside(picture, x_, y_);
    session.prober().hover(is_over ? std::optional(render::Projected{x_ - picture.x, y_ - picture.y})
                                   : std::nullopt);
  }
  showCursor(picture, panels_want_mouse, session);
}

void MouseControl::press(const InputEvent& event, const Area& picture, Session& session) {
  button_ = event.code;
  const bool shift = (event.modifiers & GLFW_MOD_SHIFT) != 0;
  if (event.code == GLFW_MOUSE_BUTTON_MIDDLE) drag_ = Drag::pan;
  if (event.code == GLFW_MOUSE_BUTTON_RIGHT) drag_ = Drag::look;
  if (event.code != GLFW_MOUSE_BUTTON_LEFT) return;
  const double x = x_ - picture.x, y = y_ - picture.y;
  if ((event.modifiers & GLFW_MOD_CONTROL) != 0) {
    session.perform({"probe", {{"x", x}, {"y", y}}});
    return;
  }
  drag_ = shift ? Drag::pan : Drag::orbit;
  const std::optional<std::size_t> emitter = markerAt(*session.picture(), x, y);
  if (isDoubleClick(session.log().now_s())) {
    drag_ = Drag::none;
    if (emitter) {
      session.perform({"focus", {{"emitter", session.picture()->scenario->emitters[*emitter].name}}});
    } else {
      session.perform({"focus", {{"x", x}, {"y", y}}});
    }
  } else if (emitter && !shift && (event.modifiers & GLFW_MOD_ALT) == 0) {
    takePlatform(*emitter, picture, session);
  }
}

bool MouseControl::isDoubleClick(double now_s) {
  const bool is_second = now_s - clicked_at_s_ < kDoubleClick_s &&
                         std::hypot(x_ - clicked_x_, y_ - clicked_y_) < kDoubleClick_px;
  clicked_at_s_ = is_second ? -1 : now_s;
  clicked_x_ = x_;
  clicked_y_ = y_;
  return is_second;
}

void MouseControl::takePlatform(std::size_t emitter, const Area& picture, Session& session) {
  try {
    platform_.emplace(*session.picture(), emitter, x_ - picture.x, y_ - picture.y);
    drag_ = Drag::platform;
    pressed_x_ = x_;
    pressed_y_ = y_;
    is_platform_moved_ = false;
  } catch (const Error& error) {
    session.tell(error.message(), true);
    drag_ = Drag::none;
  }
}

void MouseControl::movePlatform(const Area& picture, Session& session) {
  if (!is_platform_moved_ && std::hypot(x_ - pressed_x_, y_ - pressed_y_) < kClick_px) return;
  if (std::exchange(is_platform_moved_, true) && !session.isDragging()) {  // it was undone
    drag_ = Drag::none;
    return;
  }
  const auto edits = platform_->moveTo(*session.picture(), x_ - picture.x, y_ - picture.y);
  if (!edits) return;
  platform_text_ = platform_->platform() + "\n" + (*edits)[0].value + "°, " + (*edits)[1].value + "°";
  session.drag(*edits);
}

void MouseControl::showCursor(const Area& picture, bool panels_want_mouse, Session& session) const {
  if (drag_ == Drag::platform) {
    ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeAll);
    if (!is_platform_moved_) return;
    // The picture follows as soon as possible.
    const ImVec2 cursor(static_cast<float>(x_), static_cast<float>(y_));
    ImGui::GetBackgroundDrawList()->AddCircle(cursor, 0.7F * ImGui::GetFontSize(),
                                              ImGui::ColorConvertFloat4ToU32(accentColor(session.theme())), 0,
                                              2);
    ImGui::SetTooltip("%s", platform_text_.c_str());
  } else if (drag_ == Drag::none && !panels_want_mouse && session.picture() && isInside(picture, x_, y_) &&
             markerAt(*session.picture(), x_ - picture.x, y_ - picture.y)) {
    ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
  }
}

bool MouseControl::fly(const Window& window, double elapsed_s, Session& session) {
  const std::optional<Viewport> viewport = session.viewport();
  if (drag_ != Drag::look || !viewport) return false;
  const auto axis = [&](int positive, int negative) {
    return static_cast<double>(window.keyDown(positive)) - static_cast<double>(window.keyDown(negative));
  };
  const double forward = axis(GLFW_KEY_W, GLFW_KEY_S);
  const double right = axis(GLFW_KEY_D, GLFW_KEY_A);
  const double up = axis(GLFW_KEY_E, GLFW_KEY_Q);
  if (forward == 0 && right == 0 && up == 0) return false;
  const bool fast = window.keyDown(GLFW_KEY_LEFT_SHIFT) || window.keyDown(GLFW_KEY_RIGHT_SHIFT);
  const double reach = kFly_diagonals_s * elapsed_s * (fast ? kFast : 1);
  session.camera().fly(forward * reach, right * reach, up * reach, *viewport);
  session.cameraMoved();
  return true;
}

}  // namespace emscape::view
