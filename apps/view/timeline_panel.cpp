/// Playing, and the time line: steps, those that are computed, and when emitters are active.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/view/panels.h"
#include "apps/view/theme.h"
#include "emscape/render/legend.h"
#include "emscape/scenario/clock.h"

namespace emscape::view {
namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoScrollbar |
                                    ImGuiWindowFlags_NoBringToFrontOnFocus;

ImU32 colorOf(const ImVec4& color, float alpha = 1) {
  return ImGui::ColorConvertFloat4ToU32({color.x, color.y, color.z, alpha});
}

enum class Symbol { first, back, play, pause, forward, last };

/// A button with a drawn symbol: fonts differ in which of them they have.
bool symbolButton(const char* id, Symbol symbol, const char* tip, float scale) {
  const float side = ImGui::GetFrameHeight();
  const bool pressed = ImGui::Button(id, {1.35F * side, side});
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tip);
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const ImVec2 c{(low.x + high.x) / 2, (low.y + high.y) / 2};
  const float r = 5.5F * scale;
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto triangle = [&](float x, float direction) {
    list.AddTriangleFilled({x - direction * r * 0.8F, c.y - r}, {x + direction * r * 0.9F, c.y},
                           {x - direction * r * 0.8F, c.y + r}, ink);
  };
  const auto bar = [&](float x) { list.AddRectFilled({x - scale, c.y - r}, {x + scale, c.y + r}, ink); };
  switch (symbol) {
    case Symbol::first:
      bar(c.x - r);
      triangle(c.x + 1.5F * scale, -1);
      break;
    case Symbol::back:
      triangle(c.x, -1);
      break;
    case Symbol::play:
      triangle(c.x, 1);
      break;
    case Symbol::pause:
      bar(c.x - 3 * scale);
      bar(c.x + 3 * scale);
      break;
    case Symbol::forward:
      triangle(c.x, 1);
      bar(c.x - r);
      break;
    case Symbol::last:
      triangle(c.x - 1.5F * scale, 1);
      bar(c.x + r);
      break;
  }
  return pressed;
}

void drawTransport(PanelContext& context) {
  Session& session = context.session;
  const float s = context.scale;
  const Playhead& playhead = session.playhead();
  const bool playing = playhead.playing();
  if (symbolButton("##first", Symbol::first, "First step (Home)", s)) perform(context, R"({"do":"first"})");
  ImGui::SameLine(0, 4 * s);
  if (symbolButton("##back", Symbol::back, "Step back (Left)", s))
    perform(context, R"({"do":"step","steps":-1})");
  ImGui::SameLine(0, 4 * s);
  if (symbolButton("##play", playing ? Symbol::pause : Symbol::play, "Play or pause (Space)", s)) {
    perform(context, R"({"do":"play"})");
  }
  ImGui::SameLine(0, 4 * s);
  if (symbolButton("##forward", Symbol::forward, "Step forward (Right)", s)) {
    perform(context, R"({"do":"step","steps":1})");
  }
  ImGui::SameLine(0, 4 * s);
  if (symbolButton("##last", Symbol::last, "Last step (End)", s)) perform(context, R"({"do":"last"})");
  ImGui::SameLine(0, 14 * s);
  ImGui::SetNextItemWidth(84 * s);
  if (ImGui::BeginCombo("##rate", fmt::format("× {:g}", playhead.rate()).c_str())) {
    for (const double rate : Playhead::rates()) {
      if (ImGui::Selectable(fmt::format("× {:g}", rate).c_str(), rate == playhead.rate())) {
        session.perform({"rate", {{"value", rate}}});
      }
    }
    ImGui::EndCombo();
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Scenario seconds in a second (J slower, L faster)");
  ImGui::SameLine(0, 14 * s);
  bool loop = playhead.loop();
  if (ImGui::Checkbox("loop", &loop)) session.perform({"loop", {{"on", loop}}});
  ImGui::SameLine(0, 18 * s);
  std::string now = fmt::format("t = {:g} s", playhead.step_s());
  if (!playhead.times_s().empty()) {
    now += fmt::format("   step {} of {}", playhead.step() + 1, playhead.times_s().size());
  }
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(now.c_str());
  if (const auto scenario = session.scenario(); scenario && !scenario->clock.epoch_utc.empty()) {
    ImGui::SameLine(0, 18 * s);
    ImGui::PushStyleColor(ImGuiCol_Text, mutedColor(session.theme()));
    ImGui::TextUnformatted(scenario::utcAt(scenario->clock, playhead.step_s()).c_str());
    ImGui::PopStyleColor();
  }
}

/// Where times lie on the screen.
struct TimeAxis {
  double begin_s, end_s;
  float left, width;

  float x(double time_s) const {
    return left + static_cast<float>((time_s - begin_s) / (end_s - begin_s)) * width;
  }
  double time_s(float at) const {
    return begin_s + static_cast<double>((at - left) / width) * (end_s - begin_s);
  }
};

void drawActivity(ImDrawList& list, const TimeAxis& axis, const Session& session, float top, float height) {
  const auto scenario = session.scenario();
  if (!scenario || scenario->emitters.empty()) return;
  const float row = height / static_cast<float>(scenario->emitters.size());
  float y = top;
  for (const scenario::Emitter& emitter : scenario->emitters) {
    const ImU32 ink = colorOf(emitterColor(emitter.kind, session.theme()), 0.8F);
    const auto bar = [&](double begin_s, double end_s) {
      begin_s = std::clamp(begin_s, axis.begin_s, axis.end_s);
      end_s = std::clamp(end_s, axis.begin_s, axis.end_s);
      if (begin_s < end_s) {
        list.AddRectFilled({axis.x(begin_s), y + 0.2F * row}, {axis.x(end_s), y + 0.75F * row}, ink);
      }
    };
    if (emitter.active_s.empty()) bar(axis.begin_s, axis.end_s);
    for (const scenario::TimeInterval& interval : emitter.active_s) bar(interval.begin_s, interval.end_s);
    y += row;
  }
}

}  // namespace

void drawTimeline(PanelContext& context, const Area& area) {
  if (area.height < 1) return;
  Session& session = context.session;
  const float s = context.scale;
  ImGui::SetNextWindowPos({area.x, area.y});
  ImGui::SetNextWindowSize({area.width, area.height});
  ImGui::Begin("timeline", nullptr, kFixed);
  drawTransport(context);
  const std::vector<double>& times_s = session.playhead().times_s();
  if (times_s.size() > 1) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const float bar_height = std::max(8 * s, room.y - 20 * s);
    const TimeAxis axis{times_s.front(), times_s.back(), at.x + 6 * s, std::max(1.0F, room.x - 12 * s)};
    ImGui::InvisibleButton("axis", {std::max(1.0F, room.x), bar_height});
    if (ImGui::IsItemActive()) {
      const double asked_s = std::clamp(axis.time_s(ImGui::GetIO().MousePos.x), axis.begin_s, axis.end_s);
      Playhead target = session.playhead();
      target.seek(asked_s);
      if (target.step_s() != session.playhead().step_s()) session.perform({"seek", {{"time_s", asked_s}}});
    }
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({axis.left, at.y}, {axis.left + axis.width, at.y + bar_height},
                       ImGui::GetColorU32(ImGuiCol_FrameBg), 3 * s);
    // Steps whose field is known.
    const ImU32 known = colorOf(accentColor(session.theme()), 0.45F);
    const float half = std::max(0.75F, 0.5F * axis.width / static_cast<float>(times_s.size() - 1));
    for (const int step : session.status().cached_steps) {
      if (step < 0 || step >= static_cast<int>(times_s.size())) continue;
      const float x = axis.x(times_s[static_cast<std::size_t>(step)]);
      list.AddRectFilled({std::max(axis.left, x - half), at.y + bar_height - 4 * s},
                         {std::min(axis.left + axis.width, x + half), at.y + bar_height}, known);
    }
    drawActivity(list, axis, session, at.y + 2 * s, bar_height - 7 * s);
    const int ticks = std::max(2, static_cast<int>(axis.width / (90 * s)));
    const std::vector<double> round = render::roundTicks(axis.begin_s, axis.end_s, ticks);
    const double tick_step = round.size() > 1 ? round[1] - round[0] : 1;
    for (const double time_s : round) {
      const float x = axis.x(time_s);
      list.AddLine({x, at.y + bar_height}, {x, at.y + bar_height + 4 * s},
                   colorOf(mutedColor(session.theme())));
      const std::string text = render::tickText(time_s, tick_step) + " s";
      const float width = ImGui::CalcTextSize(text.c_str()).x;
      list.AddText({std::clamp(x - width / 2, at.x, at.x + room.x - width), at.y + bar_height + 4 * s},
                   colorOf(mutedColor(session.theme())), text.c_str());
    }
    // The picture's time, and the one that is asked for.
    const auto line = [&](double time_s, const ImVec4& color, float width) {
      list.AddLine({axis.x(time_s), at.y - 3 * s}, {axis.x(time_s), at.y + bar_height}, colorOf(color),
                   width);
    };
    if (session.picture()) line(session.status().shown_s, mutedColor(session.theme()), 2 * s);
    const double asked_s = session.playhead().step_s();
    const ImVec4 hand = accentColor(session.theme());
    line(asked_s, hand, 2 * s);
    list.AddTriangleFilled({axis.x(asked_s) - 5 * s, at.y - 5 * s}, {axis.x(asked_s) + 5 * s, at.y - 5 * s},
                           {axis.x(asked_s), at.y + 3 * s}, colorOf(hand));
  } else {
    ImGui::TextDisabled("one step");
  }
  ImGui::End();
}

}  // namespace emscape::view
