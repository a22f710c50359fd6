/// Texts that cannot be read as numbers: they stay in their field, with the reason beside it.
#pragma once

#include <imgui.h>

#include <array>
#include <functional>
#include <string>

#include "apps/view/widgets/panel_context.h"

namespace emscape::view {

/// Where the legend of the picture begins. @param picture_end  the right end of the picture
float legendBegin(const PanelContext& context, float picture_end);

/// Draws the reason for which the item drawn last refuses its text: beside the window of the item and the
/// legend, so that neither is covered; where there is no room, above or below the item.
void drawRefusal(const PanelContext& context, const std::string& why);

/// True if the text of a field of numberField() is refused; it is drawn instead of the value.
bool isRefused(ImGuiID field);
/// True if a field of this window has a refused text.
bool hasRefusedField();

/// Text of an actionField().
using FieldText = std::array<char, 4096>;
/// A text field as wide as the next item, and a button: Enter in the field and the button give the text to
/// `act`. A text that it refuses stays, with the reason beside it, until it is changed or taken.
/// @param act  returns false if it refuses the text; the session's notice then has the reason
void actionField(const PanelContext& context, const char* id, const char* hint, FieldText& typed,
                 const char* button, const std::function<bool(const std::string& text)>& act);
/// True if a reason stands beside a field of this kind: it need not be told in the picture, too.
bool isBesideField(const std::string& reason);

}  // namespace emscape::view
