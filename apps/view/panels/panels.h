/// The panels around the picture, drawn with Dear ImGui. They act only through commands of the session.
#pragma once

#include <imgui.h>

#include "apps/view/session/session.h"

namespace emscape::view {

/// A rectangle of the window, in pixels.
struct Area {
  float x = 0, y = 0, width = 0, height = 0;
};

/// Layout of the window.
struct Layout {
  float menu_height = 0;  ///< the menu bar, at the top
  Area picture, side, timeline, status;
};
Layout layoutOf(const Session& session, float width, float height, float scale);

/// Flags of docked panels; App fills their background.
inline constexpr ImGuiWindowFlags kFixedPanel =
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
    ImGuiWindowFlags_NoBackground;

/// Context of all panels.
struct PanelContext {
  Session& session;
  WindowControl& window;
  float scale = 1;
  bool shows_rejection = false;  ///< beside the value that was refused
};

/// Remaining width of the line after the last item (pixels).
float roomInLine(float spacing);
/// Continues on the line of the last item if the width (pixels) fits, otherwise on the next line.
void sameLineIfRoom(float width, float spacing = 0);

/// Runs the command of an action, like its key.
void perform(PanelContext& context, const char* command);
/// True while a menu or a list is unfolded.
bool isPopupOpen();
/// True in the frame in which the key was pressed. @param repeats  also while it is held, at intervals
bool isKeyPressed(ImGuiKey key, bool repeats = false);
/// The same for Enter of the main block or the keypad.
bool isEnterPressed();
/// A number field as wide as the next item. @return true if a number was entered: with Enter, or because the
/// focus is lost
bool numberField(const char* id, double& value, const char* format);

void drawMenuBar(PanelContext& context);
void drawScenarioPanel(PanelContext& context);
/// True if the panel of the scenario has the keyboard: its keys are not for the picture.
bool scenarioPanelHasKeyboard();
/// True if Tab moves the focus between the rows of that panel.
bool scenarioPanelTakesTab(const Session& session);
/// Colours and opacities: transfer_panel.cpp.
void drawColorsPanel(PanelContext& context);
void drawPlanesPanel(PanelContext& context);
/// Panels of colours, planes and scenario, stacked.
void drawSidePanel(PanelContext& context, const Area& area);
void drawTimeline(PanelContext& context, const Area& area);
/// Height that the timeline's rows need (pixels).
float timelineHeight(const Session& session, float scale);
/// The timeline's buttons: transport_panel.cpp.
void drawTransport(PanelContext& context);
void drawStatusBar(PanelContext& context, const Area& area);
/// Shown in place of the picture while nothing is open.
void drawStart(PanelContext& context, const Area& picture);
/// A list of recently opened inputs to choose from. @param max_count  largest number of entries
void drawRecentFiles(PanelContext& context, std::size_t max_count);
/// The notice, and the message before the first picture.
void drawNotice(PanelContext& context, const Area& picture);
void drawProbe(PanelContext& context, const Area& picture);
/// The probe's locked point, over the picture.
void drawProbeMarker(const PanelContext& context, const Area& picture);
void drawHelp(PanelContext& context);
void drawGoToTime(PanelContext& context);
void drawFileBrowser(PanelContext& context);
/// The running recording, at the top of the picture, and the dialog of a new one.
void drawRecording(PanelContext& context, const Area& picture);
void drawRestoreQuestion(PanelContext& context);
void drawUnsavedQuestion(PanelContext& context);
/// Message about files that have changed on the disk, at the top of the picture.
void drawChangedFiles(PanelContext& context, const Area& picture);

}  // namespace emscape::view
