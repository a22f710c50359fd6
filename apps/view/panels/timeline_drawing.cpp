#include "apps/view/panels/timeline_drawing.h"

#include "apps/view/widgets/names.h"
#include "apps/view/widgets/theme.h"

namespace emscape::view {
namespace {

/// Time of the hand; between the steps while playing.
double handTime_s(const Session& session) {
  return session.timeline().playing() ? session.timeline().time_s() : session.timeline().asked_s();
}

}  // namespace

void drawTicks(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float bottom,
               float scale) {
  const ImU32 ink = inkOf(mutedColor(session.theme()));
  const int count = std::max(2, static_cast<int>(axis.width / (95 * scale)));
  const float line = ImGui::GetTextLineHeight();
  float free_from = axis.left - 1e6F;
  for (const playback::TimelineTick& tick : session.timeline().ticks(axis.begin_s, axis.end_s, count)) {
    const float x = axis.x(tick.time_s);
    list.AddLine({x, top}, {x, bottom}, inkOf(mutedColor(session.theme()), 0.25F));
    const float width =
        std::max(ImGui::CalcTextSize(tick.text.c_str()).x, ImGui::CalcTextSize(tick.utc_text.c_str()).x);
    const float at = std::clamp(x - width / 2, axis.left, std::max(axis.left, axis.right() - width));
    if (at < free_from) continue;
    free_from = at + width + 6 * scale;
    list.AddText({at, bottom + 2 * scale}, ImGui::GetColorU32(ImGuiCol_Text), tick.text.c_str());
    if (!tick.utc_text.empty()) list.AddText({at, bottom + 2 * scale + line}, ink, tick.utc_text.c_str());
  }
}

void drawMarks(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float scale) {
  const float height = kTimelineMarks * scale;
  const ImU32 accent = inkOf(accentColor(session.theme()));
  const scenario::TimeInterval range = session.timeline().playRange();
  list.AddRectFilled({axis.left, top}, {axis.right(), top + height}, ImGui::GetColorU32(ImGuiCol_FrameBg),
                     3 * scale);
  list.AddRectFilled({axis.clampedX(range.begin_s), top + height - 4 * scale},
                     {axis.clampedX(range.end_s), top + height - 2 * scale},
                     inkOf(accentColor(session.theme()), 0.5F));
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
                       inkOf(stateColor(render::ControllerState::busy)), 3 * scale);
    list.AddText({x - size.x / 2, top + (height - size.y) / 2}, IM_COL32(16, 20, 27, 255), number.c_str());
  }
}

void drawCached(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float scale) {
  const float bottom = top + kTimelineCached * scale;
  list.AddRectFilled({axis.left, top}, {axis.right(), bottom}, ImGui::GetColorU32(ImGuiCol_FrameBg));
  const ImU32 known = inkOf(accentColor(session.theme()), 0.75F);
  for (const scenario::TimeInterval& span : session.timeline().cachedSpans(session.status().cached_steps)) {
    const float from = axis.clampedX(span.begin_s), to = axis.clampedX(span.end_s);
    if (to > axis.left && from < axis.right()) {
      list.AddRectFilled({from, top}, {std::max(to, from + 1), bottom}, known);
    }
  }
}

void drawRows(ImDrawList& list, const TimeAxis& axis, const Session& session, float names_left, float scale) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const auto scenario = session.scenario();
  const std::vector<playback::ActivityBar>& bars = session.timeline().bars();
  const float row = kTimelineRow * scale;
  const auto visible_from = static_cast<std::size_t>(std::max(0.0F, ImGui::GetScrollY() / row));
  const std::size_t visible_to = std::min(bars.size(), visible_from + kMaxTimelineRows + 1);
  for (std::size_t i = visible_from; i < visible_to; ++i) {
    const float y = at.y + row * static_cast<float>(i);
    const bool is_selected = session.selected() == "emitters." + scenario::pathStep(bars[i].emitter);
    if (is_selected) {
      list.AddRectFilled({names_left, y}, {axis.right(), y + row}, inkOf(accentColor(session.theme()), 0.3F),
                         2 * scale);
    }
    ImGui::PushStyleColor(
        ImGuiCol_Text, is_selected ? accentColor(session.theme()) : ImGui::GetStyleColorVec4(ImGuiCol_Text));
    drawName(list, bars[i].emitter, {names_left, y + (row - ImGui::GetTextLineHeight()) / 2},
             axis.left - 6 * scale);
    ImGui::PopStyleColor();
    list.AddRectFilled({axis.left, y + scale}, {axis.right(), y + row - scale},
                       ImGui::GetColorU32(ImGuiCol_FrameBg), 2 * scale);
    scenario::EmitterKind kind = scenario::EmitterKind::transmitter;
    std::optional<scenario::Side> side;
    if (scenario && i < scenario->emitters.size()) {
      kind = scenario->emitters[i].kind;
      side = scenario->platforms[static_cast<std::size_t>(scenario->emitters[i].platform)].side;
    }
    const ImU32 ink = inkOf(emitterColor(kind, side, session.theme()), 0.8F);
    for (const scenario::TimeInterval& interval : bars[i].intervals) {
      const float from = axis.clampedX(interval.begin_s), to = axis.clampedX(interval.end_s);
      if (to > axis.left && from < axis.right()) {
        list.AddRectFilled({from, y + 4 * scale}, {std::max(to, from + 1), y + row - 4 * scale}, ink);
      }
    }
  }
}

void drawHandGrip(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float scale) {
  const double hand_s = handTime_s(session);
  if (!axis.shows(hand_s)) return;
  const float x = axis.x(hand_s);
  list.AddTriangleFilled({x - 6 * scale, top - 4 * scale}, {x + 6 * scale, top - 4 * scale},
                         {x, top + 5 * scale}, inkOf(accentColor(session.theme())));
}

void drawShade(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float bottom) {
  const scenario::TimeInterval range = session.timeline().playRange();
  const ImU32 shade = inkOf(ImGui::GetStyleColorVec4(ImGuiCol_WindowBg), 0.6F);
  list.AddRectFilled({axis.left, top}, {axis.clampedX(range.begin_s), bottom}, shade);
  list.AddRectFilled({axis.clampedX(range.end_s), top}, {axis.right(), bottom}, shade);
}

void drawHands(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float bottom,
               float scale) {
  const playback::Timeline& timeline = session.timeline();
  const auto line = [&](double time_s, const ImVec4& color) {
    if (axis.shows(time_s)) {
      list.AddLine({axis.x(time_s), top}, {axis.x(time_s), bottom}, inkOf(color), 2 * scale);
    }
  };
  if (session.picture() && session.status().shown_s != timeline.asked_s()) {
    line(session.status().shown_s, stateColor(render::ControllerState::busy));
  }
  line(handTime_s(session), accentColor(session.theme()));
}

}  // namespace emscape::view
