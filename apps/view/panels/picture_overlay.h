/// What the window draws over the picture: the selection, handles of planes, points of tools, and menus.
#pragma once

#include <string>
#include <vector>

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

/// What is under the cursor: position, ground, height and value; then shorter texts, the last one of height
/// and value alone. Empty if there is nothing.
std::vector<std::string> cursorTexts(const Session& session);

}  // namespace emscape::view
