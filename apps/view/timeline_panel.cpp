/// The time line: ticks, steps that are computed, when emitters are active, the playing range and bookmarks.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/view/panels.h"
#include "apps/view/theme.h"

namespace emscape::view {
namespace {

constexpr int kMostRows = 5;  // of emitters; more are scrolled
// In pixels at scale 1
constexpr float kRow = 17, kMarks = 16, kCached = 5, kGap = 6, kTransport = 34, kPadding = 10, kReach = 6;

ImU32 colorOf(const ImVec4& color, float alpha = 1) {
  return ImGui::ColorConvertFloat4ToU32({color.x, color.y, color.z, alpha});
}

int rowsOf(const Session& session) {
  return std::min(kMostRows, static_cast<int>(session.timeline().bars().size()));
}

/// Where times lie on the screen.
struct TimeAxis {
  double begin_s, end_s;
  float left, width;

  float right() const { return left + width; }
  double perPixel_s() const { return (end_s - begin_s) / static_cast<double>(width); }
  float x(double time_s) const { return left + static_cast<float>((time_s - begin_s) / perPixel_s()); }
  /// Held within the axis.
  float clampedX(double time_s) const { return x(std::clamp(time_s, begin_s, end_s)); }
  double time_s(float at) const { return begin_s + static_cast<double>(at - left) * perPixel_s(); }
  bool shows(double time_s) const { return time_s >= begin_s && time_s <= end_s; }
};

// --- hands ---

/// What the mouse holds.
enum class Grip : int { nothing, hand, begin, end, pan };

/// The bookmark whose mark is at a place of the row of marks, as its number; 0: none.
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
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) ImGui::SetTooltip("%g s", step_s);
  int* grip = ImGui::GetStateStorage()->GetIntRef(ImGui::GetID("grip"));
  if (ImGui::IsItemActivated()) *grip = static_cast<int>(gripAt(context, axis, on_marks));
  if (!ImGui::IsItemActive()) return;
  const scenario::TimeInterval range = timeline.playRange();
  switch (static_cast<Grip>(*grip)) {
    case Grip::nothing:
      break;
    case Grip::hand:
      if (step_s != timeline.step_s()) session.perform({"seek", {{"time_s", step_s}}});
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

// --- drawing ---

void drawTicks(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float bottom,
               float scale) {
  const ImU32 ink = colorOf(mutedColor(session.theme()));
  const int count = std::max(2, static_cast<int>(axis.width / (95 * scale)));
  const float line = ImGui::GetTextLineHeight();
  float free_from = axis.left - 1e6F;
  for (const playback::TimelineTick& tick : session.timeline().ticks(axis.begin_s, axis.end_s, count)) {
    const float x = axis.x(tick.time_s);
    list.AddLine({x, top}, {x, bottom}, colorOf(mutedColor(session.theme()), 0.25F));
    const std::string seconds = tick.seconds_text + " s";
    const float width =
        std::max(ImGui::CalcTextSize(seconds.c_str()).x, ImGui::CalcTextSize(tick.utc_text.c_str()).x);
    const float at = std::clamp(x - width / 2, axis.left, std::max(axis.left, axis.right() - width));
    if (at < free_from) continue;
    free_from = at + width + 6 * scale;
    list.AddText({at, bottom + 2 * scale}, ImGui::GetColorU32(ImGuiCol_Text), seconds.c_str());
    if (!tick.utc_text.empty()) list.AddText({at, bottom + 2 * scale + line}, ink, tick.utc_text.c_str());
  }
}

/// Bookmarks and the ends of the playing range.
void drawMarks(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float scale) {
  const float height = kMarks * scale;
  const ImU32 accent = colorOf(accentColor(session.theme()));
  const scenario::TimeInterval range = session.timeline().playRange();
  list.AddRectFilled({axis.left, top}, {axis.right(), top + height}, ImGui::GetColorU32(ImGuiCol_FrameBg),
                     3 * scale);
  list.AddRectFilled({axis.clampedX(range.begin_s), top + height - 4 * scale},
                     {axis.clampedX(range.end_s), top + height - 2 * scale},
                     colorOf(accentColor(session.theme()), 0.5F));
  const auto bracket = [&](double time_s, float direction) {
    if (!axis.shows(time_s)) return;
    const float x = axis.x(time_s);
    list.AddLine({x, top + scale}, {x, top + height - scale}, accent, 2 * scale);
    list.AddLine({x, top + scale}, {x + direction * 4 * scale, top + scale}, accent, 2 * scale);
    list.AddLine({x, top + height - scale}, {x + direction * 4 * scale, top + height - scale}, accent,
                 2 * scale);
  };
  bracket(range.begin_s, 1);
  bracket(range.end_s, -1);
  for (std::size_t i = 0; i < session.bookmarks().size(); ++i) {
    const auto& bookmark = session.bookmarks()[i];
    if (!bookmark || !bookmark->time_s || !axis.shows(*bookmark->time_s)) continue;
    const std::string number = std::to_string(i + 1);
    const ImVec2 size = ImGui::CalcTextSize(number.c_str());
    const float x = axis.x(*bookmark->time_s), half = size.x / 2 + 3 * scale;
    list.AddRectFilled({x - half, top + scale}, {x + half, top + height - scale},
                       colorOf(stateColor(render::ControllerState::busy)), 3 * scale);
    list.AddText({x - size.x / 2, top + (height - size.y) / 2}, IM_COL32(16, 20, 27, 255), number.c_str());
  }
}

/// Steps whose field is known.
void drawCached(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float scale) {
  const float bottom = top + kCached * scale;
  list.AddRectFilled({axis.left, top}, {axis.right(), bottom}, ImGui::GetColorU32(ImGuiCol_FrameBg));
  const ImU32 known = colorOf(accentColor(session.theme()), 0.75F);
  for (const scenario::TimeInterval& span : session.timeline().cachedSpans(session.status().cached_steps)) {
    const float from = axis.clampedX(span.begin_s), to = axis.clampedX(span.end_s);
    if (to > axis.left && from < axis.right()) {
      list.AddRectFilled({from, top}, {std::max(to, from + 1), bottom}, known);
    }
  }
}

/// Names and bars of the emitters, in a child of the window that scrolls.
void drawRows(ImDrawList& list, const TimeAxis& axis, const Session& session, float names_left, float scale) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const auto scenario = session.scenario();
  const std::vector<playback::ActivityBar>& bars = session.timeline().bars();
  const float row = kRow * scale;
  const auto visible_from = static_cast<std::size_t>(std::max(0.0F, ImGui::GetScrollY() / row));
  const std::size_t visible_to = std::min(bars.size(), visible_from + kMostRows + 1);
  for (std::size_t i = visible_from; i < visible_to; ++i) {
    const float y = at.y + row * static_cast<float>(i);
    list.PushClipRect({names_left, y}, {axis.left - 6 * scale, y + row}, true);
    list.AddText({names_left, y + (row - ImGui::GetTextLineHeight()) / 2}, ImGui::GetColorU32(ImGuiCol_Text),
                 bars[i].emitter.c_str());
    list.PopClipRect();
    list.AddRectFilled({axis.left, y + scale}, {axis.right(), y + row - scale},
                       ImGui::GetColorU32(ImGuiCol_FrameBg), 2 * scale);
    const bool is_known = scenario && i < scenario->emitters.size();
    const ImU32 ink =
        colorOf(emitterColor(is_known ? scenario->emitters[i].kind : scenario::EmitterKind::transmitter,
                             session.theme()),
                0.8F);
    for (const scenario::TimeInterval& interval : bars[i].intervals) {
      const float from = axis.clampedX(interval.begin_s), to = axis.clampedX(interval.end_s);
      if (to > axis.left && from < axis.right()) {
        list.AddRectFilled({from, y + 4 * scale}, {std::max(to, from + 1), y + row - 4 * scale}, ink);
      }
    }
  }
}

/// Where the hand is: while it plays between the steps.
double handTime_s(const Session& session) {
  return session.timeline().playing() ? session.timeline().time_s() : session.timeline().step_s();
}

void drawHandGrip(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float scale) {
  const double hand_s = handTime_s(session);
  if (!axis.shows(hand_s)) return;
  const float x = axis.x(hand_s);
  list.AddTriangleFilled({x - 6 * scale, top - 4 * scale}, {x + 6 * scale, top - 4 * scale},
                         {x, top + 5 * scale}, colorOf(accentColor(session.theme())));
}

/// What playing leaves out.
void drawShade(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float bottom) {
  const scenario::TimeInterval range = session.timeline().playRange();
  const ImU32 shade = colorOf(ImGui::GetStyleColorVec4(ImGuiCol_WindowBg), 0.6F);
  list.AddRectFilled({axis.left, top}, {axis.clampedX(range.begin_s), bottom}, shade);
  list.AddRectFilled({axis.clampedX(range.end_s), top}, {axis.right(), bottom}, shade);
}

/// The picture's time, and the one that is asked for.
void drawHands(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float bottom,
               float scale) {
  const playback::Timeline& timeline = session.timeline();
  const auto line = [&](double time_s, const ImVec4& color) {
    if (axis.shows(time_s)) {
      list.AddLine({axis.x(time_s), top}, {axis.x(time_s), bottom}, colorOf(color), 2 * scale);
    }
  };
  if (session.picture() && session.status().shown_s != timeline.step_s()) {
    line(session.status().shown_s, stateColor(render::ControllerState::busy));
  }
  line(handTime_s(session), accentColor(session.theme()));
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

void drawTracks(PanelContext& context) {
  constexpr ImGuiButtonFlags kButtons = ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle;
  Session& session = context.session;
  const float s = context.scale;
  const int rows = rowsOf(session);
  const bool scrolls = static_cast<int>(session.timeline().bars().size()) > rows;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float names = namesWidth(session, s);
  const float room =
      ImGui::GetContentRegionAvail().x - names - (scrolls ? ImGui::GetStyle().ScrollbarSize : 0);
  const scenario::TimeInterval seen = session.timeline().visible();
  const TimeAxis axis{seen.begin_s, seen.end_s, at.x + names, std::max(1.0F, room)};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float marks_bottom = at.y + kMarks * s;
  const float rows_top = marks_bottom + (kCached + 3) * s;
  const float rows_bottom = rows_top + static_cast<float>(rows) * kRow * s;

  ImGui::SetCursorScreenPos({axis.left, at.y});
  ImGui::InvisibleButton("marks", {axis.width, rows_top - at.y}, kButtons);
  handleMouse(context, axis, ImGui::GetIO().MousePos.y < marks_bottom);
  drawMarks(list, axis, session, at.y, s);
  drawCached(list, axis, session, marks_bottom + s, s);
  if (rows > 0) {
    ImGui::SetCursorScreenPos({at.x, rows_top});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::BeginChild("rows", {0, rows_bottom - rows_top}, false, ImGuiWindowFlags_NoScrollWithMouse);
    drawRows(*ImGui::GetWindowDrawList(), axis, session, at.x, s);
    const float all = kRow * s * static_cast<float>(session.timeline().bars().size());
    ImGui::SetCursorPosX(names);
    ImGui::InvisibleButton("axis", {axis.width, all}, kButtons);
    handleMouse(context, axis, false);
    drawShade(*ImGui::GetWindowDrawList(), axis, session, rows_top, rows_bottom);
    drawHands(*ImGui::GetWindowDrawList(), axis, session, rows_top, rows_bottom, s);
    ImGui::EndChild();
    ImGui::PopStyleVar();
  }
  drawTicks(list, axis, session, marks_bottom, rows_bottom, s);
  drawHands(list, axis, session, at.y, rows_top, s);
  drawHandGrip(list, axis, session, at.y, s);
  // Below the axis it can be held as well.
  ImGui::SetCursorScreenPos({axis.left, rows_bottom});
  ImGui::InvisibleButton("ticks", {axis.width, 2 * ImGui::GetTextLineHeight() + 2 * s}, kButtons);
  handleMouse(context, axis, false);
}

}  // namespace

float timelineHeight(const Session& session, float scale) {
  const float axis = kMarks + kCached + 3 + kRow * static_cast<float>(rowsOf(session));
  return (kPadding + kTransport + kGap + axis + kGap) * scale + 2 * ImGui::GetTextLineHeight();
}

void drawTimeline(PanelContext& context, const Area& area) {
  if (area.height < 1) return;
  ImGui::SetNextWindowPos({area.x, area.y});
  ImGui::SetNextWindowSize({area.width, area.height});
  ImGui::Begin("timeline", nullptr,
               kFixedPanel | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  drawTransport(context);
  if (context.session.timeline().hasSpan()) {
    ImGui::Dummy({0, 0});
    drawTracks(context);
  } else {
    ImGui::TextDisabled("one step");
  }
  ImGui::End();
}

}  // namespace emscape::view
