#include "apps/view/panels/transfer_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/view/widgets/theme.h"
#include "emscape/render/annotate/legend.h"

namespace emscape::view {
namespace {

// In pixels at scale 1
constexpr float kHeight = 132, kBar = 14, kGrip = 9, kPointReach = 9, kPoint = 4, kSelectedPoint = 6.5F;
/// The plot extends beyond the interval by this fraction, so that its ends can be dragged outwards.
constexpr double kBeyond = 0.1;

/// The item that the mouse drags.
enum class PlotGrip : int { nothing, point, lowest, highest };

/// Mapping of values and opacities to the screen.
struct Plot {
  double lowest, highest;  // at the left and right edge
  playback::OpacityAxis axis;
  float left, top, width, height;

  float right() const { return left + width; }
  float bottom() const { return top + height; }
  float x(double value) const {
    return left + static_cast<float>((value - lowest) / (highest - lowest)) * width;
  }
  float y(double opacity) const { return bottom() - static_cast<float>(axis.position(opacity)) * height; }
  double value(float at) const {
    return lowest + static_cast<double>((at - left) / width) * (highest - lowest);
  }
  double position(float at) const { return static_cast<double>((bottom() - at) / height); }
};

/// The interval with its margins. While an end is dragged, the interval at the start of the drag is used.
Plot plotOf(const playback::TransferEditor& editor, bool held, ImVec2 at, float width, float scale) {
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ImGuiID from = ImGui::GetID("from"), to = ImGui::GetID("to");
  const double low = editor.function().lowest(), high = editor.function().highest();
  if (!held) {
    storage.SetFloat(from, static_cast<float>(low - kBeyond * (high - low)));
    storage.SetFloat(to, static_cast<float>(high + kBeyond * (high - low)));
  }
  double lowest = static_cast<double>(storage.GetFloat(from)),
         highest = static_cast<double>(storage.GetFloat(to));
  if (!(lowest < highest)) {
    lowest = low;
    highest = high;
  }
  return {lowest, highest, editor.axis, at.x, at.y, width, kHeight * scale};
}

// --- drawing ---

/// Counts on a logarithmic axis, since most values of a field are weak.
void drawHistogram(ImDrawList& list, const Plot& plot, const volume::Histogram& histogram, ImU32 ink) {
  if (histogram.counts.empty()) return;
  const auto bins = static_cast<double>(histogram.counts.size());
  const double lower = static_cast<double>(histogram.lower), upper = static_cast<double>(histogram.upper);
  const auto binAt = [&](double value) { return (value - lower) / (upper - lower) * bins; };
  const double most =
      std::log1p(static_cast<double>(*std::max_element(histogram.counts.begin(), histogram.counts.end())));
  for (float x = plot.left; x < plot.right(); ++x) {
    const double from = binAt(plot.value(x)), to = binAt(plot.value(x + 1));
    if (to < 0 || from >= bins || most <= 0) continue;
    const auto first = static_cast<std::size_t>(std::clamp(from, 0.0, bins - 1));
    const auto last = static_cast<std::size_t>(std::clamp(to, 0.0, bins - 1));
    long long count = 0;
    for (std::size_t bin = first; bin <= last; ++bin) count = std::max(count, histogram.counts[bin]);
    const auto share = static_cast<float>(std::log1p(static_cast<double>(count)) / most);
    list.AddRectFilled({x, plot.bottom() - share * plot.height * 0.92F}, {x + 1, plot.bottom()}, ink);
  }
}

/// Points of the drawn curve: evenly spaced values, and the function's points, so that jumps are drawn as
/// jumps.
std::vector<render::TransferFunction::OpacityPoint> curveOf(const render::TransferFunction& function,
                                                            const Plot& plot) {
  constexpr int kParts = 120;
  std::vector<render::TransferFunction::OpacityPoint> curve = function.opacities;
  for (int part = 0; part <= kParts; ++part) {
    const double value = plot.lowest + (plot.highest - plot.lowest) * part / kParts;
    curve.push_back({value, function.opacity(value)});
  }
  std::stable_sort(curve.begin(), curve.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
  return curve;
}

void drawCurve(ImDrawList& list, const Plot& plot, const render::TransferFunction& function, float scale) {
  const auto curve = curveOf(function, plot);
  const ImDrawListFlags flags = list.Flags;
  std::vector<ImVec2> line{{plot.x(curve.front().at), plot.y(curve.front().opacity)}};
  list.Flags &= ~ImDrawListFlags_AntiAliasedFill;  // antialiased edges would show between the parts
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const ImVec2 a{plot.x(curve[i - 1].at), plot.y(curve[i - 1].opacity)};
    const ImVec2 b{plot.x(curve[i].at), plot.y(curve[i].opacity)};
    const ImVec2 below[4] = {{a.x, plot.bottom()}, a, b, {b.x, plot.bottom()}};
    if (b.x > a.x) list.AddConvexPolyFilled(below, 4, inkOf(function.color(curve[i].at), 0.4F));
    line.push_back(b);
  }
  list.Flags = flags;
  list.AddPolyline(line.data(), static_cast<int>(line.size()), ImGui::GetColorU32(ImGuiCol_Text), 0,
                   1.5F * scale);
}

void drawPoints(ImDrawList& list, const Plot& plot, const playback::TransferEditor& editor,
                render::Theme theme, float scale) {
  const auto& points = editor.function().opacities;
  const ImU32 rim = ImGui::GetColorU32(ImGuiCol_Text), accent = inkOf(accentColor(theme));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool selected = editor.selected() == static_cast<int>(i);
    const ImVec2 at{plot.x(points[i].at), plot.y(points[i].opacity)};
    list.AddCircleFilled(at, (selected ? kSelectedPoint : kPoint) * scale,
                         selected ? accent : ImGui::GetColorU32(ImGuiCol_WindowBg));
    list.AddCircle(at, (selected ? kSelectedPoint : kPoint) * scale, rim, 0, 1.5F * scale);
  }
}

/// The ends of the interval, with a grip at the top of each.
void drawEnds(ImDrawList& list, const Plot& plot, const render::TransferFunction& function,
              render::Theme theme, float scale) {
  const float grip = kGrip * scale;
  for (const double value : {function.lowest(), function.highest()}) {
    const float x = plot.x(value);
    list.AddLine({x, plot.top}, {x, plot.bottom() + kBar * scale}, inkOf(mutedColor(theme)), scale);
    list.AddTriangleFilled({x - grip, plot.top}, {x + grip, plot.top}, {x, plot.top + 1.3F * grip},
                           inkOf(mutedColor(theme)));
  }
}

void drawColorBar(ImDrawList& list, const Plot& plot, const render::TransferFunction& function, float scale) {
  constexpr int kParts = 160;
  const float top = plot.bottom(), bottom = top + kBar * scale;
  for (int part = 0; part < kParts; ++part) {
    const double value = plot.lowest + (plot.highest - plot.lowest) * (part + 0.5) / kParts;
    const bool inside = value >= function.lowest() && value <= function.highest();
    list.AddRectFilled({plot.left + plot.width * static_cast<float>(part) / kParts, top},
                       {plot.left + plot.width * static_cast<float>(part + 1) / kParts, bottom},
                       inkOf(function.color(value), inside ? 1 : 0.45F));
  }
}

void drawTicks(ImDrawList& list, const Plot& plot, const render::FieldScale& of, render::Theme theme,
               float scale) {
  const std::string unit = render::unitText(of.unit);
  const ImU32 ink = inkOf(mutedColor(theme));
  const float top = plot.bottom() + kBar * scale;
  // Amplitudes have no even steps on an axis of decibels.
  const auto shown = [&](double value) { return of.is_amplitude ? value : of.shown(value); };
  const std::vector<double> values = render::roundTicks(shown(plot.lowest), shown(plot.highest), 6);
  const double step = values.size() > 1 ? values[1] - values[0] : 1;
  float free_from = plot.left - 1;
  const float unit_width = ImGui::CalcTextSize(unit.c_str()).x;
  for (const double shown_value : values) {
    const double value = of.is_amplitude ? shown_value : of.stored(shown_value);
    const std::string text =
        of.is_amplitude ? fmt::format("{:.2g}", of.shown(value)) : render::tickText(shown_value, step);
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    const float at = std::max(plot.left, plot.x(value) - width / 2);
    if (at < free_from || at + width > plot.right() - unit_width - 6 * scale) continue;
    free_from = at + width + 4 * scale;
    list.AddLine({plot.x(value), top}, {plot.x(value), top + 3 * scale}, ink);
    list.AddText({at, top + 3 * scale}, ink, text.c_str());
  }
  list.AddText({plot.right() - unit_width, top + 3 * scale}, ink, unit.c_str());
}

/// Labels of the opacity axis, at the left edge.
void drawOpacityAxis(ImDrawList& list, const Plot& plot, render::Theme theme, float scale) {
  const ImU32 line = inkOf(mutedColor(theme), 0.25F), ink = inkOf(mutedColor(theme));
  const std::vector<double> opacities =
      plot.axis.logarithmic ? std::vector<double>{1e-3, 1e-2, 1e-1} : std::vector<double>{0.25, 0.5, 0.75};
  for (const double opacity : opacities) {
    const float y = plot.y(opacity);
    list.AddLine({plot.left, y}, {plot.right(), y}, line);
    list.AddText({plot.left + 3 * scale, y - ImGui::GetTextLineHeight()}, ink,
                 fmt::format("{:g}", opacity).c_str());
  }
}

// --- mouse ---

std::optional<int> pointUnder(const playback::TransferEditor& editor, const Plot& plot, ImVec2 mouse,
                              float scale) {
  const double height = static_cast<double>(plot.height);
  const double value_scale = static_cast<double>(plot.width) / (plot.highest - plot.lowest) / height;
  return editor.pointNear(plot.value(mouse.x), plot.position(mouse.y), value_scale,
                          static_cast<double>(kPointReach * scale) / height);
}

/// Starts the drag of a left press: an end, a point, or a new point.
PlotGrip press(Session& session, const Plot& plot, ImVec2 mouse, float scale) {
  const playback::TransferEditor& editor = *session.transfer();
  const auto point = pointUnder(editor, plot, mouse, scale);
  if (point) {
    session.dragTransfer([&](playback::TransferEditor& changed) { changed.select(point); });
    return PlotGrip::point;
  }
  const double lowest = editor.function().lowest(), highest = editor.function().highest();
  const auto isNear = [&](double value) { return std::abs(plot.x(value) - mouse.x) <= kGrip * scale; };
  const bool on_grips = mouse.y < plot.top + 1.5F * kGrip * scale || mouse.y > plot.bottom();
  if (on_grips && isNear(lowest)) return PlotGrip::lowest;
  if (on_grips && isNear(highest)) return PlotGrip::highest;
  if (mouse.y > plot.bottom()) return PlotGrip::nothing;
  session.dragTransfer([&](playback::TransferEditor& changed) {
    changed.add(plot.value(mouse.x), plot.axis.opacity(plot.position(mouse.y)));
  });
  return PlotGrip::point;
}

void drag(Session& session, const Plot& plot, PlotGrip grip, ImVec2 mouse) {
  session.dragTransfer([&](playback::TransferEditor& editor) {
    const double value = plot.value(mouse.x);
    if (grip == PlotGrip::lowest) editor.setLowest(value);
    if (grip == PlotGrip::highest) editor.setHighest(value);
    if (grip == PlotGrip::point) editor.moveSelected(value, plot.axis.opacity(plot.position(mouse.y)));
  });
}

void handleMouse(PanelContext& context, const Plot& plot) {
  Session& session = context.session;
  const ImGuiIO& io = ImGui::GetIO();
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ImGuiID grip = ImGui::GetID("grip");
  if (ImGui::IsItemActivated()) {
    storage.SetInt(grip, static_cast<int>(press(session, plot, io.MousePos, context.scale)));
  } else if ((ImGui::IsItemActive() || ImGui::IsItemDeactivated()) &&
             (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
    drag(session, plot, static_cast<PlotGrip>(storage.GetInt(grip)), io.MousePos);
  }
  if (ImGui::IsItemDeactivated()) session.endDrag();
  if (!ImGui::IsItemHovered()) return;
  const auto under = pointUnder(*session.transfer(), plot, io.MousePos, context.scale);
  if (under && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
    session.perform({"remove_point", {{"index", *under}}});
  }
  if (!ImGui::IsItemActive() && io.MousePos.y < plot.bottom()) {
    const render::FieldScale of =
        render::fieldScale(session.transfer()->function().unit, session.view().field_unit);
    const std::string hint = under ? "drag moves, right click removes" : "click adds a point";
    ImGui::SetTooltip("%s", fmt::format("{:.4g} {}\n{}", of.shown(plot.value(io.MousePos.x)),
                                        render::unitText(of.unit), hint)
                                .c_str());
  }
}

}  // namespace

void drawTransferPlot(PanelContext& context) {
  Session& session = context.session;
  const float s = context.scale;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = std::max(1.0F, ImGui::GetContentRegionAvail().x);
  const ImGuiID held_id = ImGui::GetID("held");
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const Plot plot = plotOf(*session.transfer(), storage.GetBool(held_id), at, width, s);
  ImGui::InvisibleButton("plot", {width, (kHeight + kBar) * s});
  storage.SetBool(held_id, ImGui::IsItemActive());
  handleMouse(context, plot);

  const playback::TransferEditor& editor = *session.transfer();
  const render::TransferFunction& function = editor.function();
  const render::Theme theme = session.theme();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(at, {at.x + width, at.y + (kHeight + kBar) * s + 2 * ImGui::GetTextLineHeight()}, true);
  list.AddRectFilled(at, {plot.right(), plot.bottom()}, ImGui::GetColorU32(ImGuiCol_FrameBg), 4 * s);
  if (const ValueSummary* values = session.values()) {
    drawHistogram(list, plot, values->histogram, inkOf(mutedColor(theme), 0.35F));
  }
  drawOpacityAxis(list, plot, theme, s);
  drawCurve(list, plot, function, s);
  drawColorBar(list, plot, function, s);
  drawEnds(list, plot, function, theme, s);
  drawPoints(list, plot, editor, theme, s);
  drawTicks(list, plot, render::fieldScale(function.unit, session.view().field_unit), theme, s);
  list.PopClipRect();
  ImGui::Dummy({width, ImGui::GetTextLineHeight() - 2 * s});
}

}  // namespace emscape::view
