/// What panels are given, and the small questions that all of them ask of Dear ImGui.
#pragma once

#include <imgui.h>

#include "apps/view/session/session.h"
#include "apps/view/values/number_form.h"

namespace emscape::view {

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
/// The same, or it was in the frame before: the key that closed it is not for what is below.
bool wasPopupOpen();
/// True in the frame in which the key was pressed. @param repeats  also while it is held, at intervals
bool isKeyPressed(ImGuiKey key, bool repeats = false);
/// The same for Enter of the main block or the keypad.
bool isEnterPressed();
/// A number field as wide as the next item. A text that cannot be read stays in it, with the reason beside
/// it, until another one is entered, Esc is pressed or the value changes (widgets/refusal.cpp).
/// @return true if a number was entered: with Enter, or because the focus is lost
bool numberField(const PanelContext& context, const char* id, double& value, const NumberForm& form);

}  // namespace emscape::view
