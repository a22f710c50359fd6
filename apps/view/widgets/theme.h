/// Style of the panels, dark and light.
#pragma once

#include <imgui.h>

#include <optional>

#include "apps/view/parts/program_state.h"
#include "emscape/render/annotate/overlay.h"
#include "emscape/render/scene/camera.h"
#include "emscape/scenario/model/emitter.h"
#include "emscape/scenario/model/platform.h"
#include "render/patterns/frame_controller.h"

namespace emscape::view {

/// @param scale  of all lengths
ImGuiStyle styleOf(render::Theme theme, float scale);
/// Amber while the picture changes, blue while it is being restored, green when settled; the brightness
/// differs, too.
ImVec4 stateColor(render::ControllerState state);
/// The same, and for what else the program does.
ImVec4 activityColor(Activity activity, render::Theme theme);
/// The colour of an emitter's marker in the picture, that of its platform's side, else of its kind; darker on
/// a light background.
ImVec4 emitterColor(scenario::EmitterKind kind, const std::optional<scenario::Side>& side,
                    render::Theme theme);
ImVec4 accentColor(render::Theme theme);
ImVec4 mutedColor(render::Theme theme);
ImVec4 errorColor(render::Theme theme);
ImVec4 warningColor(render::Theme theme);

/// A colour for drawing lists. @param alpha  replaces the colour's own
ImU32 inkOf(const ImVec4& color, float alpha = 1);
ImU32 inkOf(const render::Rgb& color, float alpha = 1);

}  // namespace emscape::view
