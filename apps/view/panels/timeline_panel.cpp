/// The timeline: layout and mouse handling.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/view/panels/timeline_drawing.h"
#include "apps/view/widgets/glyphs.h"
#include "base/text/time_text.h"
#include "emscape/scenario/model/clock.h"
#include "emscape/scenario/model/edit.h"

namespace emscape::view {
namespace {

// In pixels at scale 1
constexpr float kGap = 6, kTransport = 34, kPadding = 10, kReach = 6;

float transportHeight(float scale) {
  return (kPadding + kTransport + kGap) * scale;
}

/// Height of the axis with so many rows of emitters.
float axisHeight(float scale, int rows) {
  return (kTimelineMarks + kTimelineCached + 3 + kTimelineRow * static_cast<float>(rows)) * scale +
         2 * ImGui::GetTextLineHeight();
}

/// Rows of emitters that fit; -1: not even the axis does.
int rowsOf(const Session& session, float scale, float room) {
  int rows = std::min(kMaxTimelineRows, static_cast<int>(session.mostEmitters()));
  while (rows >= 0 && transportHeight(scale) + axisHeight(scale, rows) > room) --rows;
  return rows;
}

/// The item that the mouse drags.
enum class Grip : int { nothing, hand, begin, end, pan };

/// Number of the bookmark at a position in the row of marks; 0: none.
int bookmarkAt(const Session& session, const TimeAxis& axis, float x, float reach) {
  const auto& bookmarks = session.bookmarks();
  for (std::size_t i = 0; i < bookmarks.size(); ++i) {
    if (bookmarks[i] && bookmarks[i]->time_s && std::abs(axis.x(*bookmarks[i]->time_s) - x) <= reach)
      return static_cast<int>(i) + 1;
  }
  return 0;
}

/// @param on_marks  the mouse is over the row of marks: bookmarks, and the ends of the playing range
Grip gripAt(PanelContext& context, const TimeAxis& axis, bool on_marks) {
  const ImGuiIO& io = ImGui::GetIO();
  Session& session = context.session;
  const float reach = kReach * context.scale;
  if (io.KeyShift || ImGui::IsMouseClicked(ImGuiMouseButton_Middle)) return Grip::pan;
  if (!on_marks) return Grip::hand;
  const scenario::TimeInterval range = session.timeline().playRange();
  const float to_begin = std::abs(axis.x(range.begin_s) - io.MousePos.x);
  const float to_end = std::abs(axis.x(range.end_s) - io.MousePos.x);
  if (std::min(to_begin, to_end) <= reach) return to_begin < to_end ? Grip::begin : Grip::end;
  if (const int number = bookmarkAt(session, axis, io.MousePos.x, reach)) {
    session.perform({"recall", {{"number", number}}});
    return Grip::nothing;
  }
  return Grip::hand;
}

/// The time under the mouse: that of the nearest step if it is near, or if there is nothing between the
/// steps; else rounded to a decimal of a pixel.
double pointedTime_s(const PanelContext& context, const TimeAxis& axis, double step_s) {
  constexpr float kNear = 3;
  const playback::Timeline& timeline = context.session.timeline();
  const float x = ImGui::GetIO().MousePos.x;
  if (!timeline.isContinuous() || std::abs(axis.x(step_s) - x) <= kNear * context.scale) return step_s;
  const double per_s = std::pow(10.0, std::ceil(-std::log10(axis.perPixel_s())));
  return std::clamp(std::round(axis.time_s(x) * per_s) / per_s, timeline.begin_s(), timeline.end_s());
}

void showTooltip(const PanelContext& context, const std::string& text) {
  // The child window of the rows has no padding of its own.
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(10 * context.scale, 7 * context.scale));
  ImGui::SetTooltip("%s", drawable(text).c_str());
  ImGui::PopStyleVar();
}

void showTime(const PanelContext& context, double time_s) {
  const Session& session = context.session;
  std::string text = timeText(time_s, session.timeline().end_s());
  if (const auto scenario = session.scenario(); scenario && !scenario->clock.epoch_utc.empty())
    text += "\n" + scenario::utcAt(scenario->clock, time_s);
  showTooltip(context, text);
}

/// Handles the mouse over the item drawn last.
void handleMouse(PanelContext& context, const TimeAxis& axis, bool on_marks) {
  Session& session = context.session;
  const ImGuiIO& io = ImGui::GetIO();
  const double mouse_s = axis.time_s(io.MousePos.x);
  if (ImGui::IsItemHovered()) {
    if (io.MouseWheel != 0) {
      session.perform({"timeline", {{"zoom", std::pow(0.8, io.MouseWheel)}, {"about_s", mouse_s}}});
    }
    if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) perform(context, R"({"do":"timeline"})");
  }
  const playback::Timeline& timeline = session.timeline();
  const double step_s = timeline.times_s()[static_cast<std::size_t>(timeline.nearestStep(mouse_s))];
  const double pointed_s = pointedTime_s(context, axis, step_s);
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) showTime(context, pointed_s);
  ImGuiStorage& storage = *ImGui::GetStateStorage();
  const ImGuiID grip = ImGui::GetID("grip");
  if (ImGui::IsItemActivated()) storage.SetInt(grip, static_cast<int>(gripAt(context, axis, on_marks)));
  if (!ImGui::IsItemActive()) return;
  const scenario::TimeInterval range = timeline.playRange();
  switch (static_cast<Grip>(storage.GetInt(grip))) {
    case Grip::nothing:
      break;
    case Grip::hand:
      if (pointed_s != timeline.asked_s()) session.perform({"seek", {{"time_s", pointed_s}}});
      break;
    case Grip::begin:
      if (step_s != range.begin_s && step_s < range.end_s)
        session.perform({"play_from", {{"time_s", step_s}}});
      break;
    case Grip::end:
      if (step_s != range.end_s && step_s > range.begin_s) session.perform({"play_to", {{"time_s", step_s}}});
      break;
    case Grip::pan:
      if (io.MouseDelta.x != 0) {
        const double by_s = -static_cast<double>(io.MouseDelta.x) * axis.perPixel_s();
        session.perform({"timeline", {{"pan_s", by_s}}});
      }
      break;
  }
}

/// Width of the names before the axis.
float namesWidth(const Session& session, float scale) {
  float widest = 0;
  const auto& bars = session.timeline().bars();
  for (std::size_t i = 0; i < std::min<std::size_t>(bars.size(), 50); ++i) {
    widest = std::max(widest, ImGui::CalcTextSize(bars[i].emitter.c_str()).x);
  }
  return bars.empty() ? 0 : std::min(widest + 10 * scale, 150 * scale);
}

/// The names before the rows: the wheel scrolls, a click selects the emitter.
/// @param width, height  of all names
void handleNames(PanelContext& context, float width, float height) {
  if (width <= 0) return;
  ImGui::SetCursorPos({0, 0});
  ImGui::InvisibleButton("names", {width, height});
  if (!ImGui::IsItemHovered()) return;
  const ImGuiIO& io = ImGui::GetIO();
  const float row = kTimelineRow * context.scale;
  if (io.MouseWheel != 0) ImGui::SetScrollY(ImGui::GetScrollY() - 3 * row * io.MouseWheel);
  const std::vector<playback::ActivityBar>& bars = context.session.timeline().bars();
  const auto i = static_cast<std::size_t>(std::max(0.0F, (io.MousePos.y - ImGui::GetItemRectMin().y) / row));
  if (i >= bars.size()) return;
  showTooltip(context, bars[i].emitter);
  if (ImGui::IsItemClicked())
    context.session.perform({"select", {{"path", "emitters." + scenario::pathStep(bars[i].emitter)}}});
}

/// Scrolls to the row of an emitter when it is selected. @param height  of the rows in sight
void followSelection(const Session& session, float height, float scale) {
  static std::string followed;
  if (session.selected() == followed) return;
  followed = session.selected();
  const std::vector<playback::ActivityBar>& bars = session.timeline().bars();
  const auto found = std::find_if(bars.begin(), bars.end(), [](const playback::ActivityBar& bar) {
    return followed == "emitters." + scenario::pathStep(bar.emitter);
  });
  const float row = kTimelineRow * scale, top = row * static_cast<float>(found - bars.begin());
  const float seen = ImGui::GetScrollY();
  if (found != bars.end() && (top < seen || top + row > seen + height))
    ImGui::SetScrollY(top - (height - row) / 2);
}

void drawTracks(PanelContext& context, int rows) {
  constexpr ImGuiButtonFlags kButtons = ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle;
  Session& session = context.session;
  const float s = context.scale;
  const bool scrolls = static_cast<int>(session.timeline().bars().size()) > rows;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float names = namesWidth(session, s);
  const float room =
      ImGui::GetContentRegionAvail().x - names - (scrolls ? ImGui::GetStyle().ScrollbarSize : 0);
  const scenario::TimeInterval seen = session.timeline().visible();
  const TimeAxis axis{seen.begin_s, seen.end_s, at.x + names, std::max(1.0F, room)};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float marks_bottom = at.y + kTimelineMarks * s;
  const float rows_top = marks_bottom + (kTimelineCached + 3) * s;
  const float rows_bottom = rows_top + static_cast<float>(rows) * kTimelineRow * s;

  ImGui::SetCursorScreenPos({axis.left, at.y});
  ImGui::InvisibleButton("marks", {axis.width, rows_top - at.y}, kButtons);
  handleMouse(context, axis, ImGui::GetIO().MousePos.y < marks_bottom);
  drawMarks(list, axis, session, at.y, s);
  drawCached(list, axis, session, marks_bottom + s, s);
  if (rows > 0) {
    ImGui::SetCursorScreenPos({at.x, rows_top});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::BeginChild("rows", {0, rows_bottom - rows_top}, false, ImGuiWindowFlags_NoScrollWithMouse);
    followSelection(session, rows_bottom - rows_top, s);
    drawRows(*ImGui::GetWindowDrawList(), axis, session, at.x, s);
    const float all = kTimelineRow * s * static_cast<float>(session.timeline().bars().size());
    ImGui::SetCursorPosX(names);
    ImGui::InvisibleButton("axis", {axis.width, all}, kButtons);
    handleMouse(context, axis, false);
    handleNames(context, names, all);
    drawShade(*ImGui::GetWindowDrawList(), axis, session, rows_top, rows_bottom);
    drawHands(*ImGui::GetWindowDrawList(), axis, session, rows_top, rows_bottom, s);
    ImGui::EndChild();
    ImGui::PopStyleVar();
  }
  drawTicks(list, axis, session, marks_bottom, rows_bottom, s);
  drawHands(list, axis, session, at.y, rows_top, s);
  drawHandGrip(list, axis, session, at.y, s);
  // It can also be grabbed below the axis.
  ImGui::SetCursorScreenPos({axis.left, rows_bottom});
  ImGui::InvisibleButton("ticks", {axis.width, 2 * ImGui::GetTextLineHeight() + 2 * s}, kButtons);
  handleMouse(context, axis, false);
}

}  // namespace

float timelineHeight(const Session& session, float scale, float room) {
  // Before the input is open, room is left for it.
  const bool has_span = session.timeline().times_s().empty() || session.timeline().hasSpan();
  if (!session.hasInput() || !session.panels.timeline || !has_span) return 0;
  const int rows = rowsOf(session, scale, room);
  return transportHeight(scale) + (rows < 0 ? 0 : axisHeight(scale, rows));
}

void drawTimeline(PanelContext& context, const Area& area) {
  if (area.height < 1) return;
  ImGui::SetNextWindowPos({area.x, area.y});
  ImGui::SetNextWindowSize({area.width, area.height});
  ImGui::Begin("timeline", nullptr,
               kFixedPanel | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  drawTransport(context);
  constexpr float kRounding = 0.5F;
  const int rows = rowsOf(context.session, context.scale, area.height + kRounding);
  if (rows >= 0 && context.session.timeline().hasSpan()) {
    ImGui::Dummy({0, 0});
    drawTracks(context, rows);
  }
  ImGui::End();
}

}  // namespace emscape::view
