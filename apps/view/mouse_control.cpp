#include "apps/view/mouse_control.h"

#include <GLFW/glfw3.h>

#include <cmath>

namespace emscape::view {
namespace {

constexpr double kOrbit_deg_px = 0.3;
constexpr double kLook_deg_px = 0.15;
constexpr double kDollyPerNotch = 0.85;
constexpr double kFly_diagonals_s = 0.15;
constexpr double kFast = 4;
constexpr double kDoubleClick_s = 0.35;
constexpr double kDoubleClick_px = 5;

/// The emitter whose marker is under the cursor; none if no marker is near.
const render::Marker* markerAt(const playback::LivePicture& picture, double x, double y) {
  constexpr double kReach_px = 18;
  const render::Marker* nearest = nullptr;
  double nearest_px = kReach_px;
  for (const render::Marker& marker : picture.annotations.markers) {
    const render::Projected at =
        render::project(picture.camera, picture.image.size, picture.box.toDrawn(marker.position_m));
    const double away_px = std::hypot(at.x - x, at.y - y);
    if (!at.in_front || away_px > nearest_px) continue;
    nearest = &marker;
    nearest_px = away_px;
  }
  return nearest;
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
      CameraControl& camera = session.camera();
      if (drag_ == Drag::orbit) camera.orbit(kOrbit_deg_px * right_px, kOrbit_deg_px * down_px, *viewport);
      if (drag_ == Drag::pan) camera.pan(right_px, down_px, *viewport);
      if (drag_ == Drag::look) camera.look(kLook_deg_px * right_px, kLook_deg_px * down_px, *viewport);
      moved = moved || right_px != 0 || down_px != 0;
    } else if (event.kind == InputEvent::Kind::button && event.action == GLFW_RELEASE) {
      if (event.code == button_) drag_ = Drag::none;
    } else if (panels_want_mouse || !viewport) {
      continue;
    } else if (event.kind == InputEvent::Kind::button) {
      const bool inside = x_ >= picture.x && y_ >= picture.y && x_ < picture.x + picture.width &&
                          y_ < picture.y + picture.height;
      if (!inside || drag_ != Drag::none) continue;
      button_ = event.code;
      const bool shift = (event.modifiers & GLFW_MOD_SHIFT) != 0;
      if (event.code == GLFW_MOUSE_BUTTON_LEFT) drag_ = shift ? Drag::pan : Drag::orbit;
      if (event.code == GLFW_MOUSE_BUTTON_MIDDLE) drag_ = Drag::pan;
      if (event.code == GLFW_MOUSE_BUTTON_RIGHT) drag_ = Drag::look;
      if (event.code != GLFW_MOUSE_BUTTON_LEFT) continue;
      const double now_s = session.log().now_s();
      const bool twice = now_s - clicked_at_s_ < kDoubleClick_s &&
                         std::hypot(x_ - clicked_x_, y_ - clicked_y_) < kDoubleClick_px;
      clicked_at_s_ = twice ? -1 : now_s;
      clicked_x_ = x_;
      clicked_y_ = y_;
      const render::Marker* marker =
          twice ? markerAt(*session.picture(), x_ - picture.x, y_ - picture.y) : nullptr;
      if (marker) session.perform({"focus", {{"emitter", marker->label}}});
    } else if (event.kind == InputEvent::Kind::wheel && event.y != 0) {
      session.camera().dolly(std::pow(kDollyPerNotch, event.y), x_ - picture.x, y_ - picture.y, *viewport);
      moved = true;
    }
  }
  if (moved) session.cameraMoved();
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
