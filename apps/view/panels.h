/// The panels around the picture, drawn with Dear ImGui. All they do they do by commands of the session.
#pragma once

#include <imgui.h>

#include "apps/view/session.h"

namespace emscape::view {

/// A part of the window in its pixels.
struct Area {
  float x = 0, y = 0, width = 0, height = 0;
};

/// Where everything lies.
struct Layout {
  float menu_height = 0;  ///< the menu bar, at the top
  Area picture, side, timeline, status;
};
Layout layoutOf(const Session& session, float width, float height, float scale);

/// What all panels need.
struct PanelContext {
  Session& session;
  WindowControl& window;
  float scale = 1;
};

/// Runs the command of an action, as its key would.
void perform(PanelContext& context, const char* command);

void drawMenuBar(PanelContext& context);
void drawScenarioPanel(PanelContext& context);
void drawColorsPanel(PanelContext& context);
/// Scenario and colours, one above the other.
void drawSidePanel(PanelContext& context, const Area& area);
void drawTimeline(PanelContext& context, const Area& area);
void drawStatusBar(PanelContext& context, const Area& area);
/// The notice, and what is shown before the first picture.
void drawNotice(PanelContext& context, const Area& picture);
void drawHelp(PanelContext& context);
void drawGoToTime(PanelContext& context);

}  // namespace emscape::view
