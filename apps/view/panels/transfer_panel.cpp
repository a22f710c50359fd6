/// Colours, opacities and compositing.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/view/panels/panels.h"
#include "apps/view/panels/transfer_plot.h"
#include "apps/view/widgets/slider_field.h"
#include "apps/view/widgets/theme.h"
#include "emscape/render/annotate/legend.h"

namespace emscape::view {
namespace {

float half(float scale) {
  return 0.5F * (ImGui::GetContentRegionAvail().x - 8 * scale);
}

bool typed(const PanelContext& context, const char* id, double& value, const NumberForm& form, float width) {
  ImGui::SetNextItemWidth(width);
  return numberField(context, id, value, form);
}

/// Of a value of the field.
NumberForm formOf(const PanelContext& context, const char* before, const std::string& unit) {
  NumberForm form{before, unit};
  form.field_unit = context.session.view().field_unit;
  return form;
}

/// Value and opacity of the selected point.
void drawPoint(PanelContext& context) {
  Session& session = context.session;
  const playback::TransferEditor& editor = *session.transfer();
  const auto& points = editor.function().opacities;
  if (!editor.selected()) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("click: adds or selects a point");
    return;
  }
  const int index = *editor.selected();
  const auto& point = points[static_cast<std::size_t>(index)];
  double value = point.at, opacity = point.opacity;
  const float width = ImGui::GetContentRegionAvail().x - 86 * context.scale;
  if (typed(context, "##value", value, formOf(context, "", editor.function().unit), 0.54F * width)) {
    session.perform({"opacity_point", {{"index", index}, {"value", value}}});
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("value of point %d of %zu", index + 1, points.size());
  ImGui::SameLine();
  if (typed(context, "##opacity", opacity, {"opacity ", "", "", 3}, 0.46F * width)) {
    session.perform({"opacity_point", {{"index", index}, {"opacity", opacity}}});
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("opacity of one voxel's length, 0..1");
  ImGui::SameLine();
  ImGui::BeginDisabled(points.size() <= 2);
  if (ImGui::Button("remove")) perform(context, R"({"do":"remove_point"})");
  ImGui::EndDisabled();
}

void drawRange(PanelContext& context) {
  Session& session = context.session;
  const render::TransferFunction& function = session.transfer()->function();
  double lowest = function.lowest(), highest = function.highest();
  const float width = half(context.scale);
  if (typed(context, "##lowest", lowest, formOf(context, "from ", function.unit), width)) {
    session.perform({"range", {{"min", lowest}}});
  }
  ImGui::SameLine();
  if (typed(context, "##highest", highest, formOf(context, "to ", function.unit), width)) {
    session.perform({"range", {{"max", highest}}});
  }
  if (ImGui::Button("Fit this step", {width, 0})) perform(context, R"({"do":"fit_step"})");
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Shift+F");
  ImGui::SameLine();
  ImGui::BeginDisabled(session.status().searching);
  if (ImGui::Button(session.status().searching ? "searching …" : "Fit the series", {width, 0})) {
    perform(context, R"({"do":"fit_series"})");
  }
  ImGui::EndDisabled();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Shift+R");
}

void drawPresets(PanelContext& context) {
  Session& session = context.session;
  const playback::TransferEditor& editor = *session.transfer();
  const float width = half(context.scale);
  const std::string map = editor.colorMap();
  ImGui::SetNextItemWidth(width);
  if (ImGui::BeginCombo("##map", map.empty() ? "colours of a file" : map.c_str())) {
    for (const std::string& name : playback::TransferEditor::presets()) {
      if (ImGui::Selectable(name.c_str(), name == map)) session.perform({"transfer", {{"colors", name}}});
    }
    ImGui::EndCombo();
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("colour map");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(width);
  if (ImGui::BeginCombo("##preset", "opacity preset")) {
    if (ImGui::Selectable("default")) perform(context, R"({"do":"reset_transfer"})");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("by how frequent the values of this step are; colours too");
    for (const playback::OpacityPreset& preset : playback::opacityPresets()) {
      if (ImGui::Selectable(preset.name)) {
        Command command{"opacity_preset", {{"name", preset.name}}};
        if (const auto point = editor.selected()) {
          command.arguments["value"] = editor.function().opacities[static_cast<std::size_t>(*point)].at;
        }
        session.perform(command);
      }
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", preset.help);
    }
    ImGui::EndCombo();
  }
  bool logarithmic = editor.axis.logarithmic;
  if (ImGui::Checkbox("logarithmic", &logarithmic)) session.perform({"log_opacity", {{"on", logarithmic}}});
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("axis of the opacities: fine control near 0");
  ImGui::SameLine(0, 12 * context.scale);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("opacity");
  ImGui::SameLine();
  if (ImGui::Button("less")) perform(context, R"({"do":"opacity","factor":0.8})");
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("of all points (Shift+Down)");
  ImGui::SameLine();
  if (ImGui::Button("more")) perform(context, R"({"do":"opacity","factor":1.25})");
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("of all points (Shift+Up)");
}

void drawFiles(PanelContext& context) {
  Session& session = context.session;
  if (ImGui::Button("Load …")) session.browse(FileBrowser::Purpose::colors);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("a transfer function, as --transfer");
  ImGui::SameLine();
  if (ImGui::Button("Save as …")) {
    const std::filesystem::path usual = session.usualColorsFile();
    session.browse(FileBrowser::Purpose::save_colors, usual.filename().string());
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("for --transfer; Ctrl+Shift+T: as NAME.transfer.json");
}

void drawIso(PanelContext& context) {
  Session& session = context.session;
  const render::TransferFunction& function = session.picture()->transfer;
  const double lowest = function.lowest(), highest = function.highest();
  const double set = session.settings().iso_value;
  double value = std::isnan(set) ? (lowest + highest) / 2 : set;
  const float width = 0.38F * ImGui::GetContentRegionAvail().x;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - width - 8 * context.scale);
  NumberForm form = formOf(context, "surface at ", function.unit);
  form.min = std::min(lowest, value);
  form.max = std::max(highest, value);
  if (sliderField(context, "##iso", value, form)) {
    session.change([&](playback::ViewState& view) { view.settings.iso_value = value; });
  }
  ImGui::SameLine();
  if (typed(context, "##iso value", value, formOf(context, "", function.unit), width)) {
    session.perform({"iso", {{"value", value}}});
  }
}

void drawMode(PanelContext& context) {
  Session& session = context.session;
  for (const auto mode : {render::CompositingMode::dvr, render::CompositingMode::mida,
                          render::CompositingMode::mip, render::CompositingMode::iso}) {
    if (mode != render::CompositingMode::dvr) ImGui::SameLine(0, 14 * context.scale);
    if (ImGui::RadioButton(render::toString(mode), session.settings().mode == mode)) {
      session.perform({"mode", {{"mode", render::toString(mode)}}});
    }
  }
  if (session.settings().mode == render::CompositingMode::iso) {
    drawIso(context);
  } else {
    bool shading = session.settings().shading;
    if (ImGui::Checkbox("shading", &shading)) session.perform({"shading", {{"on", shading}}});
  }
}

}  // namespace

void drawColorsPanel(PanelContext& context) {
  Session& session = context.session;
  ImGui::TextColored(accentColor(session.theme()), "Colours and opacity");
  if (!session.picture()) {
    ImGui::TextDisabled("no picture yet");
    return;
  }
  if (session.transfer()) {
    drawTransferPlot(context);
    drawPoint(context);
    drawRange(context);
    drawPresets(context);
    drawFiles(context);
    ImGui::Separator();
  } else {
    ImGui::TextDisabled("categories have colours of their own");
  }
  drawMode(context);
}

}  // namespace emscape::view
