/// Texts that cannot be read as numbers: they stay in their field, with the reason beside it.
#pragma once

#include <imgui.h>

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

}  // namespace emscape::view
