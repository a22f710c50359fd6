#include "apps/view/mouse_control.h"

#include <GLFW/glfw3.h>

#include <cmath>
#include <utility>

#include "apps/view/widgets/theme.h"
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

/// True if a pixel of the picture is on the line of a split view.
bool isOnSplit(const Session& session, double x) {
  constexpr double kReach_px = 5;
  return session.picture() && session.picture()->split_column > 0 &&
         std::abs(x - session.picture()->split_column) <= kReach_px;
}

/// The object under a pixel of the picture; null if there is none, or if emitters are not drawn.
const SceneObject* objectUnder(const Session& session, double x, double y) {
  if (!session.picture() || !session.view().show_emitters) return nullptr;
  return objectAt(session.objects(), x, y);
}

}  // namespace

void MouseControl::handle(const std::vector<InputEvent>& events, const Area& picture, bool panels_want_mouse,
                          Session& session) {
  for (const InputEvent& event : events) {
    const std::optional<Viewport> viewport = session.viewport();
    if (event.kind == InputEvent::Kind::cursor) {
      const double right_px = event.x - x_, down_px = event.y - y_;
      x_ = event.x;
      y_ = event.y;
      if (drag_ != Drag::none && viewport) move(picture, *viewport, right_px, down_px, session);
    } else if (event.kind == InputEvent::Kind::button && event.action == GLFW_RELEASE) {
      if (event.code == button_ && drag_ != Drag::none) release(picture, session);
    } else if (panels_want_mouse || !viewport) {
      continue;
    } else if (event.kind == InputEvent::Kind::button) {
      if (isInside(picture, x_, y_) && drag_ == Drag::none) press(event, picture, session);
    } else if (event.kind == InputEvent::Kind::wheel && event.y != 0) {
      session.camera().dolly(std::pow(kDollyPerNotch, event.y), x_ - picture.x, y_ - picture.y, *viewport);
      session.cameraMoved();
    }
  }
  const bool is_over = !panels_want_mouse && isInside(picture, x_, y_);
  const auto under =
      is_over ? std::optional(render::Projected{x_ - picture.x, y_ - picture.y}) : std::nullopt;
  session.prober().hover(under);
  session.cursor().hover(under);
  showCursor(picture, panels_want_mouse, session);
}

/// Moves what is dragged. @param right_px, down_px  since the last event
void MouseControl::move(const Area& picture, const Viewport& viewport, double right_px, double down_px,
                        Session& session) {
  if (!is_moved_ && std::hypot(x_ - pressed_x_, y_ - pressed_y_) < kClick_px) return;
  if (drag_ == Drag::platform) return movePlatform(picture, session);
  const bool is_first = !std::exchange(is_moved_, true);
  if (drag_ == Drag::split) return session.moveSplit(x_ - picture.x);
  if (drag_ == Drag::plane) {
    plane_->moveTo(x_ - picture.x, y_ - picture.y, session, is_first);
    if (!session.isDraggingPlane()) drag_ = Drag::none;  // it was cancelled or undone
    return;
  }
  if (drag_ == Drag::pan || drag_ == Drag::look) session.stopFollowing();
  CameraControl& camera = session.camera();
  if (drag_ == Drag::orbit) camera.orbit(kOrbit_deg_px * right_px, kOrbit_deg_px * down_px, viewport);
  if (drag_ == Drag::pan) camera.pan(right_px, down_px, viewport);
  if (drag_ == Drag::look) camera.look(kLook_deg_px * right_px, kLook_deg_px * down_px, viewport);
  session.cameraMoved();
}

void MouseControl::release(const Area& picture, Session& session) {
  const Drag drag = std::exchange(drag_, Drag::none);
  if (drag == Drag::platform && is_moved_) session.endDrag();
  if (drag == Drag::plane && is_moved_) plane_->finish(session);
  if (drag == Drag::split && is_moved_) session.perform({"split", {{"position", session.view().split}}});
  if (is_moved_) return;
  const double x = pressed_x_ - picture.x, y = pressed_y_ - picture.y;
  const SceneObject* const object = objectUnder(session, x, y);
  if (drag == Drag::look) {
    menu_ = {true, x, y, object != nullptr ? object->path : std::string()};
    if (object != nullptr && object->path != session.selected())
      session.perform({"select", {{"path", object->path}}});
  } else if (drag == Drag::orbit || drag == Drag::platform) {
    click(x, y, object, session);
  }
}

/// A click with the left button.
void MouseControl::click(double x, double y, const SceneObject* object, Session& session) {
  static constexpr const char* kVerbs[] = {"", "measure", "draw_track", "place"};
  const char* const verb = kVerbs[static_cast<std::size_t>(session.tool().kind)];
  if (session.tool().isOn()) {
    session.perform({verb, {{"x", x}, {"y", y}}});
    return;
  }
  const std::string path = object != nullptr ? object->path : std::string();
  if (path == session.selected()) return;
  session.perform({"select", path.empty() ? Json::object() : Json{{"path", path}}});
}

void MouseControl::press(const InputEvent& event, const Area& picture, Session& session) {
  button_ = event.code;
  pressed_x_ = x_;
  pressed_y_ = y_;
  is_moved_ = false;
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
  if (isDoubleClick(session.log().now_s())) {
    drag_ = Drag::none;
    doubleClick(x, y, session);
    return;
  }
  if (shift || (event.modifiers & GLFW_MOD_ALT) != 0 || session.tool().isOn()) return;
  if (const SceneObject* object = objectUnder(session, x, y)) {
    takePlatform(*object, picture, session);
  } else if (const auto plane = planeHandleAt(session, x, y)) {
    plane_.emplace(session, *plane, x, y);
    drag_ = Drag::plane;
  } else if (isOnSplit(session, x)) {
    drag_ = Drag::split;
  }
}

void MouseControl::doubleClick(double x, double y, Session& session) {
  if (session.tool().kind == PickTool::Kind::track) {
    session.perform({"draw_track"});
  } else if (session.tool().isOn()) {
    return;
  } else if (const SceneObject* object = objectUnder(session, x, y)) {
    session.perform({"focus", {{"path", object->path}}});
  } else {
    session.perform({"focus", {{"x", x}, {"y", y}}});
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

void MouseControl::takePlatform(const SceneObject& object, const Area& picture, const Session& session) {
  drag_ = Drag::platform;
  platform_.reset();
  try {
    const auto& scenario = session.picture()->scenario;
    if (const auto index = static_cast<std::size_t>(object.platform);
        scenario && index < scenario->platforms.size())
      session.requireMovable(scenario->platforms[index].name);
    platform_.emplace(*session.picture(), object, x_ - picture.x, y_ - picture.y);
  } catch (const Error& error) {
    refusal_ = error.message();
  }
}

void MouseControl::movePlatform(const Area& picture, Session& session) {
  const bool is_first = !std::exchange(is_moved_, true);
  if (!platform_) {
    if (is_first) session.tell(refusal_, true);
    return;
  }
  if (!is_first && !session.isDragging()) {  // it was undone
    drag_ = Drag::none;
    return;
  }
  const auto edits = platform_->moveTo(*session.picture(), x_ - picture.x, y_ - picture.y);
  if (!edits) return;
  session.drag(*edits);
}

void MouseControl::showCursor(const Area& picture, bool panels_want_mouse, const Session& session) const {
  if (drag_ == Drag::platform) {
    ImGui::SetMouseCursor(platform_ ? ImGuiMouseCursor_ResizeAll : ImGuiMouseCursor_NotAllowed);
    if (!is_moved_ || !platform_) return;
    // The picture follows as soon as possible.
    const ImVec2 cursor(static_cast<float>(x_), static_cast<float>(y_));
    ImGui::GetBackgroundDrawList()->AddCircle(cursor, 0.7F * ImGui::GetFontSize(),
                                              ImGui::ColorConvertFloat4ToU32(accentColor(session.theme())), 0,
                                              2);
    ImGui::SetTooltip("%s", tooltipOf(platform_->object(), session.view()).c_str());
    return;
  }
  if (drag_ == Drag::split) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  if (drag_ == Drag::plane) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeAll);
  if (drag_ != Drag::none || panels_want_mouse || !session.picture() || !isInside(picture, x_, y_)) return;
  const double x = x_ - picture.x, y = y_ - picture.y;
  if (const SceneObject* object = objectUnder(session, x, y)) {
    ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    ImGui::SetTooltip("%s", tooltipOf(*object, session.view()).c_str());
  } else if (!session.tool().isOn() && planeHandleAt(session, x, y)) {
    ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeAll);
  } else if (!session.tool().isOn() && isOnSplit(session, x)) {
    ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
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
