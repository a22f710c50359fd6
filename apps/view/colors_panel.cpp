/// Colours, opacity and how samples become a pixel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/view/panels.h"
#include "apps/view/theme.h"

namespace emscape::view {
namespace {

ImU32 inkOf(const render::Rgb& color) {
  return ImGui::ColorConvertFloat4ToU32({color.r, color.g, color.b, 1});
}

/// The function as it is: colours from left to right, opacity on a logarithmic axis above them.
void drawFunction(const render::TransferFunction& function, float scale) {
  constexpr double kLowestOpacity = 1e-4;
  constexpr int kParts = 96;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  const float height = 74 * scale;
  const float bar = 14 * scale;
  ImGui::Dummy({width, height});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + width, at.y + height}, ImGui::GetColorU32(ImGuiCol_FrameBg), 4 * scale);
  const double lowest = function.lowest(), highest = function.highest();
  const auto valueAt = [&](int part) { return lowest + (highest - lowest) * part / kParts; };
  const auto x = [&](int part) { return at.x + width * static_cast<float>(part) / kParts; };
  const auto y = [&](int part) {
    const double opacity = std::max(kLowestOpacity, function.opacity(valueAt(part)));
    const double share = 1 - std::log10(opacity) / std::log10(kLowestOpacity);
    return at.y + (height - bar) * (1 - static_cast<float>(std::clamp(share, 0.0, 1.0)));
  };
  for (int part = 0; part < kParts; ++part) {
    const ImU32 color = inkOf(function.color(valueAt(part)));
    list.AddRectFilled({x(part), at.y + height - bar}, {x(part + 1), at.y + height}, color);
    const ImVec2 below[4] = {{x(part), at.y + height - bar},
                             {x(part), y(part)},
                             {x(part + 1), y(part + 1)},
                             {x(part + 1), at.y + height - bar}};
    list.AddConvexPolyFilled(below, 4, (color & 0x00FFFFFFU) | 0x66000000U);
    list.AddLine({x(part), y(part)}, {x(part + 1), y(part + 1)}, ImGui::GetColorU32(ImGuiCol_Text),
                 1.4F * scale);
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("opacity from 10^-4 to 1, logarithmic, over the colours");
}

void drawRange(PanelContext& context, const render::TransferFunction& shown) {
  Session& session = context.session;
  float range[2] = {static_cast<float>(shown.lowest()), static_cast<float>(shown.highest())};
  const float speed = std::max(1e-6F, (range[1] - range[0]) / 400);
  ImGui::SetNextItemWidth(-1);
  if (ImGui::DragFloatRange2("##range", &range[0], &range[1], speed, 0, 0, "from %.4g", "to %.4g") &&
      range[0] < range[1]) {
    ColorAdjustment colors = session.colors();
    colors.range = volume::ValueRange{range[0], range[1]};
    session.setColors(colors);
  }
  if (ImGui::Button("Fit this step")) perform(context, R"({"do":"fit_step"})");
  ImGui::SameLine();
  if (ImGui::Button("Fit the series")) perform(context, R"({"do":"fit_series"})");
}

void drawMode(PanelContext& context) {
  Session& session = context.session;
  render::RenderSettings settings = session.settings();
  for (const auto mode : {render::CompositingMode::dvr, render::CompositingMode::mida,
                          render::CompositingMode::mip, render::CompositingMode::iso}) {
    if (mode != render::CompositingMode::dvr) ImGui::SameLine(0, 14 * context.scale);
    if (ImGui::RadioButton(render::toString(mode), settings.mode == mode)) {
      session.perform({"mode", {{"mode", render::toString(mode)}}});
    }
  }
  settings = session.settings();
  if (settings.mode == render::CompositingMode::iso && session.picture()) {
    const render::TransferFunction& function = session.picture()->transfer;
    float value = static_cast<float>(
        std::isnan(settings.iso_value) ? (function.lowest() + function.highest()) / 2 : settings.iso_value);
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderFloat("##iso", &value, static_cast<float>(function.lowest()),
                           static_cast<float>(function.highest()), "surface at %.4g")) {
      settings.iso_value = static_cast<double>(value);
      session.setSettings(settings);
    }
  } else {
    bool shading = settings.shading;
    if (ImGui::Checkbox("light on the fog", &shading)) session.perform({"shading", {{"on", shading}}});
  }
}

}  // namespace

void drawColorsPanel(PanelContext& context) {
  Session& session = context.session;
  ImGui::TextColored(accentColor(session.theme()), "Colours and opacity");
  if (!session.picture() || !session.fittedColors()) {
    ImGui::TextDisabled("no picture yet");
    return;
  }
  const render::TransferFunction& shown = session.picture()->transfer;
  if (shown.categorical) {
    ImGui::TextDisabled("categories have colours of their own");
    drawMode(context);
    return;
  }
  drawFunction(shown, context.scale);
  drawRange(context, shown);
  const std::string& map = session.colors().color_map;
  ImGui::SetNextItemWidth(0.5F * ImGui::GetContentRegionAvail().x);
  if (ImGui::BeginCombo("colour map", map.empty() ? "fitted" : map.c_str())) {
    if (ImGui::Selectable("fitted", map.empty())) session.perform({"transfer", {{"colors", ""}}});
    for (const std::string& name : render::colorMapNames()) {
      if (ImGui::Selectable(name.c_str(), name == map)) session.perform({"transfer", {{"colors", name}}});
    }
    ImGui::EndCombo();
  }
  float factor = static_cast<float>(session.colors().opacity_factor);
  ImGui::SetNextItemWidth(0.5F * ImGui::GetContentRegionAvail().x);
  if (ImGui::SliderFloat("opacity", &factor, 0.01F, 100, "× %.3g", ImGuiSliderFlags_Logarithmic)) {
    ColorAdjustment colors = session.colors();
    colors.opacity_factor = static_cast<double>(factor);
    session.setColors(colors);
  }
  ImGui::Spacing();
  drawMode(context);
}

}  // namespace emscape::view
