/// Mouse and flying keys over the picture.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/view/panels/panels.h"
#include "apps/view/session/platform_drag.h"
#include "apps/view/window.h"

namespace emscape::view {

/// Converts events over the picture to movements of the session's camera, platforms and probe.
class MouseControl {
 public:
  /// @param panels_want_mouse  the cursor is over a panel or drags an item of one
  void handle(const std::vector<InputEvent>& events, const Area& picture, bool panels_want_mouse,
              Session& session);
  /// Flies while the right button and keys are held. @param elapsed_s  since the last frame
  /// @return whether it flies
  bool fly(const Window& window, double elapsed_s, Session& session);

 private:
  enum class Drag { none, orbit, pan, look, platform };
  void press(const InputEvent& event, const Area& picture, Session& session);
  bool isDoubleClick(double now_s);
  void takePlatform(std::size_t emitter, const Area& picture, Session& session);
  void movePlatform(const Area& picture, Session& session);
  void showCursor(const Area& picture, bool panels_want_mouse, Session& session) const;

  Drag drag_ = Drag::none;
  int button_ = 0;
  double x_ = 0, y_ = 0;
  double clicked_at_s_ = -1;
  double clicked_x_ = 0, clicked_y_ = 0;
  std::optional<PlatformDrag> platform_;
  double pressed_x_ = 0, pressed_y_ = 0;
  bool is_platform_moved_ = false;
  std::string platform_text_;  // name and position
};

}  // namespace emscape::view
