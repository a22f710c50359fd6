/// A small chart of the probe's value over time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/view/panels/panels.h"
#include "apps/view/widgets/theme.h"
#include "apps/view/widgets/wrapped_text.h"
#include "emscape/render/annotate/legend.h"

namespace emscape::view {
namespace {

bool isField(const ValueHistory& history, std::size_t i) {
  return std::isfinite(history.values[i]) && history.values[i] > history.floor;
}

/// The values in the unit in which fields are shown; NaN without a field.
ValueHistory shownOf(ValueHistory history, FieldUnit unit) {
  const render::FieldScale scale = render::fieldScale(history.unit, unit);
  for (std::size_t i = 0; i < history.computed; ++i) {
    history.values[i] =
        isField(history, i) ? static_cast<float>(scale.shown(double{history.values[i]})) : NAN;
  }
  history.unit = scale.unit;
  history.floor = -HUGE_VALF;
  return history;
}

/// Maps times and values to the screen.
struct Chart {
  ImVec2 low, high;  // lower left and upper right corner
  double begin_s, end_s, min, max;

  ImVec2 at(double time_s, double value) const {
    return {x(time_s), low.y + static_cast<float>((value - min) / (max - min)) * (high.y - low.y)};
  }
  float x(double time_s) const {
    return low.x + static_cast<float>((time_s - begin_s) / (end_s - begin_s)) * (high.x - low.x);
  }
};

void drawCurve(ImDrawList& list, const Chart& chart, const ValueHistory& history, ImU32 ink, float scale) {
  for (std::size_t i = 0; i < history.computed; ++i) {
    if (!isField(history, i)) continue;
    const ImVec2 at = chart.at(history.times_s[i], history.values[i]);
    if (i + 1 < history.computed && isField(history, i + 1)) {
      list.AddLine(at, chart.at(history.times_s[i + 1], history.values[i + 1]), ink, 1.6F * scale);
    } else {
      list.AddCircleFilled(at, 1.6F * scale, ink);
    }
  }
}

std::string stateOf(const ValueHistory& history) {
  if (!history.error.empty()) return drawable(history.error);
  return history.computed < history.times_s.size() ? "being computed …" : "no field at any step";
}

/// Draws a text in the place of the chart.
void drawInPlace(const ImVec2& corner, const ImVec2& size, const std::string& text) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(corner, {corner.x + size.x, corner.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg));
  const ImVec2 padding = ImGui::GetStyle().FramePadding;
  list.PushClipRect(corner, {corner.x + size.x, corner.y + size.y}, true);
  list.AddText({corner.x + padding.x, corner.y + padding.y}, ImGui::GetColorU32(ImGuiCol_TextDisabled),
               wrapped(text, size.x - 2 * padding.x).c_str());
  list.PopClipRect();
}

}  // namespace

void drawHistory(PanelContext& context) {
  Session& session = context.session;
  const ValueHistory history = shownOf(session.history(), session.view().field_unit);
  if (history.times_s.size() < 2) return;
  const float s = context.scale, line = ImGui::GetTextLineHeight();
  float min = HUGE_VALF, max = -HUGE_VALF;
  for (std::size_t i = 0; i < history.computed; ++i) {
    if (!isField(history, i)) continue;
    min = std::min(min, history.values[i]);
    max = std::max(max, history.values[i]);
  }
  const bool has_values = min <= max;
  // The place of the button and the chart is there from the first step on: the rows below stay where they
  // are.
  ImGui::TextDisabled("at the point itself, over time");
  sameLineIfRoom(ImGui::CalcTextSize("copy as CSV").x + 2 * ImGui::GetStyle().FramePadding.x,
                 ImGui::GetStyle().ItemSpacing.x);
  ImGui::BeginDisabled(!has_values);
  if (ImGui::SmallButton("copy as CSV")) perform(context, R"({"do":"copy_history"})");
  ImGui::EndDisabled();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 size{ImGui::GetContentRegionAvail().x, 92 * s};
  ImGui::InvisibleButton("history", size);
  if (!has_values) return drawInPlace(corner, size, stateOf(history));
  const double pad = std::max(0.5, 0.05 * static_cast<double>(max - min));
  const Chart chart{{corner.x + ImGui::CalcTextSize("-000.0").x + 4 * s, corner.y + size.y - line - 2 * s},
                    {corner.x + size.x - 2 * s, corner.y + 2 * s},
                    history.times_s.front(),
                    history.times_s.back(),
                    static_cast<double>(min) - pad,
                    static_cast<double>(max) + pad};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 muted = ImGui::ColorConvertFloat4ToU32(mutedColor(session.theme()));
  const ImU32 accent = ImGui::ColorConvertFloat4ToU32(accentColor(session.theme()));
  list.AddRectFilled({chart.low.x, chart.high.y}, {chart.high.x, chart.low.y},
                     ImGui::GetColorU32(ImGuiCol_FrameBg));
  for (const double value : render::roundTicks(chart.min, chart.max, 3)) {
    const std::string text = fmt::format("{:g}", value);
    const float y = chart.at(chart.begin_s, value).y;
    list.AddLine({chart.low.x, y}, {chart.high.x, y}, ImGui::GetColorU32(ImGuiCol_Separator));
    list.AddText({chart.low.x - 4 * s - ImGui::CalcTextSize(text.c_str()).x, y - line / 2}, muted,
                 text.c_str());
  }
  for (const double time_s : render::roundTicks(chart.begin_s, chart.end_s, 4)) {
    const std::string text = fmt::format("{:g} s", time_s);
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    const float x = std::clamp(chart.x(time_s) - width / 2, chart.low.x, chart.high.x - width);
    list.AddText({x, chart.low.y + 2 * s}, muted, text.c_str());
  }
  drawCurve(list, chart, history, accent, s);
  if (history.computed < history.times_s.size()) {
    const std::string state = stateOf(history);
    list.AddText({chart.high.x - ImGui::CalcTextSize(state.c_str()).x - 4 * s, chart.high.y}, muted,
                 state.c_str());
  }
  const double now_s = session.picture()->info().time_s;
  if (now_s >= chart.begin_s && now_s <= chart.end_s) {
    list.AddLine({chart.x(now_s), chart.high.y}, {chart.x(now_s), chart.low.y}, muted, 1.5F * s);
  }
  if (!ImGui::IsItemHovered()) return;
  const double part = (ImGui::GetIO().MousePos.x - chart.low.x) / (chart.high.x - chart.low.x);
  const double under_s = chart.begin_s + std::clamp(part, 0.0, 1.0) * (chart.end_s - chart.begin_s);
  const auto next = std::lower_bound(history.times_s.begin(), history.times_s.end(), under_s);
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(next - history.times_s.begin()),
                                       history.times_s.size() - 1);
  ImGui::SetTooltip("t = %g s: %s", history.times_s[i],
                    i >= history.computed ? "not computed yet"
                    : isField(history, i)
                        ? fmt::format("{:.1f} {}", history.values[i], render::unitText(history.unit)).c_str()
                        : "no field");
  if (ImGui::IsItemClicked()) session.perform({"seek", {{"time_s", history.times_s[i]}}});
}

}  // namespace emscape::view
