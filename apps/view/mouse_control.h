/// Mouse and flying keys over the picture.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/view/panels/picture_overlay.h"
#include "apps/view/session/plane_drag.h"
#include "apps/view/session/platform_drag.h"
#include "apps/view/window.h"

namespace emscape::view {

/// Converts events over the picture to movements of the session's camera, platforms and probe.
class MouseControl {
 public:
  /// @param panels_want_mouse  the cursor is over a panel or drags an item of one
  void handle(const std::vector<InputEvent>& events, const Area& picture, bool panels_want_mouse,
              Session& session);
  /// The menu of the thing or the ground that was clicked with the right button.
  ContextMenu& menu() { return menu_; }
  /// Flies while the right button and keys are held. @param elapsed_s  since the last frame
  /// @return whether it flies
  bool fly(const Window& window, double elapsed_s, Session& session);

 private:
  enum class Drag { none, orbit, pan, look, platform, plane, split };
  void move(const Area& picture, const Viewport& viewport, double right_px, double down_px, Session& session);
  void release(const Area& picture, Session& session);
  void press(const InputEvent& event, const Area& picture, Session& session);
  void click(double x, double y, const SceneObject* object, Session& session);
  void doubleClick(double x, double y, Session& session);
  bool isDoubleClick(double now_s);
  void takePlatform(const SceneObject& object, const Area& picture, const Session& session);
  void movePlatform(const Area& picture, Session& session);
  void showCursor(const Area& picture, bool panels_want_mouse, const Session& session) const;

  Drag drag_ = Drag::none;
  int button_ = 0;
  double x_ = 0, y_ = 0;
  double clicked_at_s_ = -1;
  double clicked_x_ = 0, clicked_y_ = 0;
  double pressed_x_ = 0, pressed_y_ = 0;
  bool is_moved_ = false;  // since the press: it is no click
  ContextMenu menu_;
  std::optional<PlaneDrag> plane_;
  std::optional<PlatformDrag> platform_;
  std::string refusal_;  // reason for a missing platform_
};

}  // namespace emscape::view
