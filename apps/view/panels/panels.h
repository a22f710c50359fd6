/// The panels around the picture, drawn with Dear ImGui. They act only through commands of the session.
#pragma once

#include <imgui.h>

#include "apps/view/widgets/panel_context.h"

namespace emscape::view {

/// A rectangle of the window, in pixels.
struct Area {
  float x = 0, y = 0, width = 0, height = 0;
};

/// Layout of the window.
struct Layout {
  float menu_height = 0;  ///< the menu bar, at the top
  Area picture, side, timeline, status;
  bool has_side = false;      ///< one of the side's panels is open
  bool side_is_over = false;  ///< it lies over the picture, if it is shown
};
Layout layoutOf(const Session& session, float width, float height, float scale);

/// Flags of docked panels; App fills their background.
inline constexpr ImGuiWindowFlags kFixedPanel =
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
    ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoFocusOnAppearing;

void drawMenuBar(PanelContext& context);
/// The entries of a menu or list of quantities.
void drawQuantityList(PanelContext& context, const std::vector<ShownQuantity>& quantities);
/// The list of quantities at the heading of the picture's legend.
void drawLegendMenu(PanelContext& context, const Area& picture);
/// Shows or hides the side panel of a narrow window.
void drawSideButton(PanelContext& context);
void drawScenarioPanel(PanelContext& context);
/// True if a key without Ctrl is for the panel of the scenario, not for the picture.
bool scenarioPanelTakes(const KeyChord& chord);
/// True if Tab moves the focus between the rows of that panel.
bool scenarioPanelTakesTab(const Session& session);
/// Colours and opacities: transfer_panel.cpp.
void drawColorsPanel(PanelContext& context);
void drawPlanesPanel(PanelContext& context);
/// Shows places of one more file. @return false if it is refused, as one that is shown already
bool addPlaces(Session& session, const std::string& file);
void drawProbePanel(PanelContext& context);
/// The locked probe's value over time.
void drawHistory(PanelContext& context);
void drawMeasurePanel(PanelContext& context);
/// Panels of colours, planes, probe, measurement and scenario, stacked.
void drawSidePanel(PanelContext& context, const Layout& layout);
void drawTimeline(PanelContext& context, const Area& area);
/// Height of the time line (pixels): with as many rows of emitters as fit, without them and the axis if it
/// has no span or the room is too little. 0: it is not shown. @param room  for it (pixels)
float timelineHeight(const Session& session, float scale, float room);
/// The timeline's buttons: transport_panel.cpp.
void drawTransport(PanelContext& context);
void drawStatusBar(PanelContext& context, const Area& area);
/// The state of the program at the left of the status bar: state_badge.cpp. @param right_x  end of its room
void drawStateBadge(PanelContext& context, float right_x);
/// Its width with the state in words, without the costs of the picture.
float stateBadgeWidth(const PanelContext& context);
/// Shown in place of the picture while nothing is open.
void drawStart(PanelContext& context, const Area& picture);
/// A list of recently opened inputs to choose from. @param max_count  largest number of entries
void drawRecentFiles(PanelContext& context, std::size_t max_count);
/// The notice, and the message before the first picture.
void drawNotice(PanelContext& context, const Area& picture);
/// The probe's locked point, over the picture.
void drawProbeMarker(const PanelContext& context, const Area& picture);
void drawHelp(PanelContext& context);
void drawGoToTime(PanelContext& context);
/// map_panel.cpp.
void drawGoToPosition(PanelContext& context);
void drawMapDialog(PanelContext& context);
void drawFileBrowser(PanelContext& context);
/// The running recording, at the top of the picture, and the dialog of a new one.
void drawRecording(PanelContext& context, const Area& picture);
/// "3 warnings"; empty without any.
std::string warningsText(const Session& session);
void drawWarningsButton(PanelContext& context);
void drawWarnings(PanelContext& context);
void drawRestoreQuestion(PanelContext& context);
void drawUnsavedQuestion(PanelContext& context);
void drawReplaceQuestion(PanelContext& context);
/// Message about files that have changed on the disk, at the top of the picture.
void drawChangedFiles(PanelContext& context, const Area& picture);

}  // namespace emscape::view
