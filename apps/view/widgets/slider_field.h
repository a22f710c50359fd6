/// Numbers that are dragged along a line, or typed.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>

#include "apps/view/widgets/panel_context.h"

namespace emscape::view {

/// The control of a value that is not being typed: a frame with the text and, below the text, the position on
/// a scale.
struct ValueFrame {
  std::string text;
  ImVec4 ink;
  std::optional<double> position;  ///< 0..1; none: without a scale
};
/// Draws it and its button "##value"-like `id`, which is the item drawn last. @return true if the text is too
/// long
bool drawValueFrame(const char* id, const ValueFrame& frame, float width, float scale);

/// The change of a position (0..1) by the mouse that drags the item drawn last: fine with Shift. Relative to
/// where the item was grabbed; a click changes nothing.
/// @param position  of the value; kept between frames by the caller
/// @param rate      as ValueSlider::dragRate()
/// @return true if it was changed
bool dragPosition(double& position, bool& is_moved, float scale, double rate = 1);

/// True if the item drawn last is to become a text field: a double click, or Ctrl + click.
bool wantsTyping();

/// A number between limits that is dragged, or typed after a double click or Ctrl + click. As wide as the
/// next item.
/// @param form  with the limits of the number; they are the ends of the scale
/// @return true if it was changed
bool sliderField(const PanelContext& context, const char* id, double& value, const NumberForm& form);

}  // namespace emscape::view
