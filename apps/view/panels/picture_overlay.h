/// What the window draws over the picture: the selection, handles of planes, points of tools, and menus.
#pragma once

#include <string>

#include "apps/view/panels/panels.h"

namespace emscape::view {

/// The menu of an object or of the ground in the picture.
struct ContextMenu {
  bool opens = false;   ///< with the next frame
  double x = 0, y = 0;  ///< where, in pixels of the picture
  std::string path;     ///< of the object; empty: the ground
};

/// Name, kind, position, height, frequency and power.
std::string tooltipOf(const SceneObject& object, const playback::ViewState& view);

/// The selection, the handles of cutting planes, and the points of the tool that is on.
void drawPictureOverlay(const PanelContext& context, const Area& picture);
/// What the clicks of the tool do, at the top of the picture.
void drawToolHint(PanelContext& context, const Area& picture);
void drawContextMenu(PanelContext& context, const Area& picture, ContextMenu& menu);

/// Position, ground, height and value under the cursor; empty if there is none.
std::string cursorText(const Session& session);

}  // namespace emscape::view
