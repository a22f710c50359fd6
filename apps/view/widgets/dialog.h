/// Dialogs: over a dimmed window, with a border and a shadow, inside of the window whatever its size.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "apps/view/widgets/panel_context.h"

namespace emscape::view {

/// Whether the rest of the window waits for the dialog.
enum class Waits { no, yes };

/// Begins a dialog in the middle of the window. @param size  at scale 1; 0: as large as its contents
/// @return true if it is open; endDialog() must follow then
bool beginDialog(PanelContext& context, const char* title, bool& open, const ImVec2& size = {0, 0},
                 Waits waits = Waits::yes, ImGuiWindowFlags flags = 0);
/// The place of a message: at `at` if the dialog on top leaves room there, else below, above or beside it.
/// @param low, high  corners of the area in which it must be
ImVec2 besideDialogs(const ImVec2& at, const ImVec2& size, const ImVec2& low, const ImVec2& high, float gap);
void endDialog();

/// Lets Tab go to the item drawn last, in the order of the calls: a text field gets the cursor, any other
/// item a mark, with which Enter and Space press it. Without effect outside of dialogs.
void tabStop();
/// True if an item other than a text field has the mark: Enter is for it.
bool isButtonFocused();

/// The default button of a dialog, also pressed by Enter if no other dialog was opened after it.
bool defaultButton(const char* text);

/// The answers to the question of a dialog, in a row: Tab and the arrow keys go from one to the next, Enter
/// gives the one that is marked, at first the one that loses nothing.
/// @param question  names the question; with another one the mark is at its first place
/// @return the index of the answer that is given; -1: none yet
int drawAnswers(const std::string& question, const std::vector<const char*>& answers, int first);

}  // namespace emscape::view
