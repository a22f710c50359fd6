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

/// Of panels that have their place; App fills their ground.
inline constexpr ImGuiWindowFlags kFixedPanel =
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
    ImGuiWindowFlags_NoBackground;

/// What all panels need.
struct PanelContext {
  Session& session;
  WindowControl& window;
  float scale = 1;
};

/// Space that is left in the line behind the item drawn last (pixels).
float roomInLine(float spacing);
/// Goes on in the line of the item drawn last if there is room for so much (pixels), else in the next one.
void sameLineIfRoom(float width, float spacing = 0);

/// Runs the command of an action, as its key would.
void perform(PanelContext& context, const char* command);

void drawMenuBar(PanelContext& context);
void drawScenarioPanel(PanelContext& context);
/// Colours and opacities: transfer_panel.cpp.
void drawColorsPanel(PanelContext& context);
void drawPlanesPanel(PanelContext& context);
/// Colours, planes and scenario, one above the other.
void drawSidePanel(PanelContext& context, const Area& area);
void drawTimeline(PanelContext& context, const Area& area);
/// As much as its rows need (pixels).
float timelineHeight(const Session& session, float scale);
/// Its buttons: transport_panel.cpp.
void drawTransport(PanelContext& context);
void drawStatusBar(PanelContext& context, const Area& area);
/// In place of the picture as long as nothing is open: what can be done.
void drawStart(PanelContext& context, const Area& picture);
/// The inputs that were opened last, to be chosen. @param most  so many of them
void drawRecentFiles(PanelContext& context, std::size_t most);
/// The notice, and what is shown before the first picture.
void drawNotice(PanelContext& context, const Area& picture);
void drawProbe(PanelContext& context, const Area& picture);
/// The point that the probe holds, over the picture.
void drawProbeMarker(const PanelContext& context, const Area& picture);
void drawHelp(PanelContext& context);
void drawGoToTime(PanelContext& context);
void drawFileBrowser(PanelContext& context);
/// The recording that is under way, at the top of the picture, and what is to be recorded.
void drawRecording(PanelContext& context, const Area& picture);
void drawRestoreQuestion(PanelContext& context);
void drawUnsavedQuestion(PanelContext& context);
/// Files that have changed on the disk, at the top of the picture.
void drawChangedFiles(PanelContext& context, const Area& picture);

}  // namespace emscape::view
