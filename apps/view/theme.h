/// How panels look, dark and light.
#pragma once

#include <imgui.h>

#include "emscape/render/annotate/overlay.h"
#include "emscape/render/camera.h"
#include "emscape/render/frame_controller.h"
#include "emscape/scenario/emitter.h"

namespace emscape::view {

/// @param scale  of all lengths
ImGuiStyle styleOf(render::Theme theme, float scale);
/// Amber while it changes, blue while it is being made exact, green when it stands: told apart by brightness
/// too.
ImVec4 stateColor(render::ControllerState state);
/// As the overlay of the picture has them; darker on light ground.
ImVec4 emitterColor(scenario::EmitterKind kind, render::Theme theme);
ImVec4 accentColor(render::Theme theme);
ImVec4 mutedColor(render::Theme theme);
ImVec4 errorColor(render::Theme theme);

}  // namespace emscape::view
