#include "apps/view/widgets/theme.h"

#include "render/annotate/side_color.h"

namespace emscape::view {
namespace {

ImVec4 rgb(unsigned hex, float alpha = 1) {
  return {static_cast<float>(hex >> 16 & 0xFF) / 255, static_cast<float>(hex >> 8 & 0xFF) / 255,
          static_cast<float>(hex & 0xFF) / 255, alpha};
}

ImVec4 sideColor(scenario::Side side, bool is_dark) {
  using render::Affiliation;
  constexpr Affiliation kAffiliations[]{Affiliation::friendly, Affiliation::hostile, Affiliation::neutral,
                                        Affiliation::unknown};
  const render::Rgb color = render::colorOf(kAffiliations[static_cast<std::size_t>(side)]);
  const float part = is_dark ? 1 : 0.6F;  // on a light background
  return {part * color.r, part * color.g, part * color.b, 1};
}

}  // namespace

ImVec4 accentColor(render::Theme theme) {
  return theme == render::Theme::dark ? rgb(0x4FA3E3) : rgb(0x1F6FB2);
}

ImVec4 mutedColor(render::Theme theme) {
  return theme == render::Theme::dark ? rgb(0x8F9BAA) : rgb(0x5A6573);
}

ImVec4 errorColor(render::Theme theme) {
  return theme == render::Theme::dark ? rgb(0xFF8C7A) : rgb(0xB3261E);
}

ImVec4 warningColor(render::Theme theme) {
  return theme == render::Theme::dark ? rgb(0xF0B95A) : rgb(0x8A5A00);
}

ImVec4 stateColor(render::ControllerState state) {
  switch (state) {
    case render::ControllerState::busy:
      return rgb(0xF0A830);
    case render::ControllerState::restore:
      return rgb(0x5AB4F0);
    case render::ControllerState::idle:
      break;
  }
  return rgb(0x9BE07A);
}

ImVec4 activityColor(Activity activity, render::Theme theme) {
  switch (activity) {
    case Activity::empty:
      return mutedColor(theme);
    case Activity::opening:
    case Activity::computing:
      return rgb(0xC79BF2);
    case Activity::playing:
      return rgb(0x6FD3C7);
    case Activity::busy:
      return stateColor(render::ControllerState::busy);
    case Activity::restore:
      return stateColor(render::ControllerState::restore);
    case Activity::idle:
      break;
  }
  return stateColor(render::ControllerState::idle);
}

ImVec4 emitterColor(scenario::EmitterKind kind, const std::optional<scenario::Side>& side,
                    render::Theme theme) {
  const bool dark = theme == render::Theme::dark;
  if (side) return sideColor(*side, dark);
  switch (kind) {
    case scenario::EmitterKind::radar:
      return dark ? rgb(0xE6EBF1) : rgb(0x4A5563);
    case scenario::EmitterKind::transmitter:
      return dark ? rgb(0x9FE0FF) : rgb(0x2F8FC4);
    case scenario::EmitterKind::jammer:
      break;
  }
  return dark ? rgb(0xFF6B6B) : rgb(0xD64545);
}

ImGuiStyle styleOf(render::Theme theme, float scale) {
  ImGuiStyle style;
  const bool dark = theme == render::Theme::dark;
  if (dark) {
    ImGui::StyleColorsDark(&style);
  } else {
    ImGui::StyleColorsLight(&style);
  }
  style.WindowPadding = {12, 10};
  style.FramePadding = {8, 4};
  style.ItemSpacing = {8, 7};
  style.ItemInnerSpacing = {6, 5};
  style.IndentSpacing = 16;
  style.ScrollbarSize = 12;
  style.GrabMinSize = 11;
  style.WindowRounding = 0;
  style.ChildRounding = 4;
  style.FrameRounding = 4;
  style.PopupRounding = 5;
  style.GrabRounding = 4;
  style.ScrollbarRounding = 6;
  style.WindowBorderSize = 0;
  style.PopupBorderSize = 1;
  style.FrameBorderSize = 1;
  style.CircleTessellationMaxError = 0.5F;  // fewer triangles for corners that look the same
  const ImVec4 accent = accentColor(theme);
  const auto faded = [&accent](float alpha) { return ImVec4(accent.x, accent.y, accent.z, alpha); };
  ImVec4* c = style.Colors;
  c[ImGuiCol_Text] = dark ? rgb(0xE8ECF1) : rgb(0x1A2028);
  c[ImGuiCol_TextDisabled] = mutedColor(theme);
  c[ImGuiCol_WindowBg] = dark ? rgb(0x181D25) : rgb(0xF3F5F8);
  c[ImGuiCol_ChildBg] = rgb(0, 0);
  c[ImGuiCol_PopupBg] = dark ? rgb(0x202732) : rgb(0xFFFFFF);
  c[ImGuiCol_MenuBarBg] = dark ? rgb(0x12161C) : rgb(0xE6EAEF);
  c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgActive] = c[ImGuiCol_MenuBarBg];
  c[ImGuiCol_TableRowBgAlt] = dark ? rgb(0xFFFFFF, 0.03F) : rgb(0x000000, 0.035F);
  c[ImGuiCol_Border] = dark ? rgb(0x364050) : rgb(0xC3CBD5);
  c[ImGuiCol_FrameBg] = dark ? rgb(0x262E3A) : rgb(0xFFFFFF);
  c[ImGuiCol_FrameBgHovered] = dark ? rgb(0x303A49) : rgb(0xEDF2F8);
  c[ImGuiCol_FrameBgActive] = dark ? rgb(0x374355) : rgb(0xE2EAF3);
  c[ImGuiCol_Button] = dark ? rgb(0x2B3543) : rgb(0xE1E7EE);
  c[ImGuiCol_ButtonHovered] = dark ? rgb(0x38455A) : rgb(0xD0DAE5);
  c[ImGuiCol_ButtonActive] = faded(0.75F);
  c[ImGuiCol_Header] = dark ? rgb(0x252D39) : rgb(0xE1E7EE);
  c[ImGuiCol_HeaderHovered] = dark ? rgb(0x323D4D) : rgb(0xD3DCE6);
  c[ImGuiCol_HeaderActive] = faded(0.6F);
  c[ImGuiCol_CheckMark] = c[ImGuiCol_NavHighlight] = accent;
  c[ImGuiCol_SliderGrab] = faded(0.55F);
  c[ImGuiCol_SliderGrabActive] = accent;
  c[ImGuiCol_Separator] = dark ? rgb(0x2E3743) : rgb(0xCDD4DC);
  c[ImGuiCol_ScrollbarBg] = rgb(0, 0);
  c[ImGuiCol_PlotHistogram] = accent;
  c[ImGuiCol_ModalWindowDimBg] = rgb(0x000000, 0.4F);
  style.ScaleAllSizes(scale);
  return style;
}

ImU32 inkOf(const ImVec4& color, float alpha) {
  return ImGui::ColorConvertFloat4ToU32({color.x, color.y, color.z, alpha});
}

ImU32 inkOf(const render::Rgb& color, float alpha) {
  return ImGui::ColorConvertFloat4ToU32({color.r, color.g, color.b, alpha});
}

}  // namespace emscape::view
