/// Playback buttons, rate, and requested time.
#include <fmt/format.h>

#include <cmath>

#include "apps/view/panels/panels.h"
#include "apps/view/widgets/glyphs.h"
#include "apps/view/widgets/theme.h"
#include "base/text/time_text.h"

namespace emscape::view {
namespace {

/// Lag of a playing picture that is stated (seconds of the clock on the wall).
constexpr double kNoticed_s = 0.5;

enum class Symbol { first, back, play, pause, forward, last };

/// A button with a drawn symbol, since not all fonts have these symbols.
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

void drawButtons(PanelContext& context) {
  const float s = context.scale;
  const bool playing = context.session.timeline().playing();
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
}

/// Any rate can be typed; the arrow next to it lists common rates.
void drawRate(PanelContext& context) {
  Session& session = context.session;
  const float s = context.scale;
  const double rate = session.timeline().rate();
  double typed = rate;
  ImGui::SetNextItemWidth(64 * s);
  if (numberField(context, "##rate", typed, {"× "})) session.perform({"rate", {{"value", typed}}});
  if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip(
        "%s", fmt::format("Scenario seconds per second, negative: backwards (J lower, L higher)\n{:.3g} "
                          "steps per second",
                          session.timeline().stepsPerSecond(rate))
                  .c_str());
  }
  ImGui::SameLine(0, 2 * s);
  if (ImGui::BeginCombo("##rates", "", ImGuiComboFlags_NoPreview | ImGuiComboFlags_HeightLargest)) {
    const playback::Timeline& timeline = session.timeline();
    for (const double usual : timeline.usualRates()) {
      std::string text = fmt::format("× {:g}", usual);
      if (timeline.hasLongSteps()) text += fmt::format("   {:.2g} steps/s", timeline.stepsPerSecond(usual));
      if (ImGui::Selectable(text.c_str(), usual == std::abs(rate))) {
        session.perform({"rate", {{"value", std::copysign(usual, rate)}}});
      }
    }
    ImGui::EndCombo();
  }
  // What does not fit is left out: both have a key and a menu entry.
  const auto begins = [&](const char* name) {
    const float spacing = 10 * s, box = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x;
    const bool fits = roomInLine(spacing) >= box + ImGui::CalcTextSize(name).x;
    if (fits) ImGui::SameLine(0, spacing);
    return fits;
  };
  bool backwards = rate < 0, loop = session.timeline().loop();
  if (begins("backwards") && ImGui::Checkbox("backwards", &backwards))
    perform(context, R"({"do":"reverse"})");
  if (begins("loop") && ImGui::Checkbox("loop", &loop)) session.perform({"loop", {{"on", loop}}});
}

/// The requested time, and the time on screen while it differs, if there is room. The picture has the UTC.
void drawTimes(const PanelContext& context) {
  const Session& session = context.session;
  const playback::Timeline& timeline = session.timeline();
  const float spacing = 18 * context.scale;
  const double asked_s = timeline.asked_s(), span_s = timeline.end_s();
  const auto draw = [&](const std::string& text, const ImVec4& color) {
    if (roomInLine(spacing) < ImGui::CalcTextSize(text.c_str()).x) return;
    ImGui::SameLine(0, spacing);
    ImGui::TextColored(color, "%s", drawable(text).c_str());
  };
  const ImVec4 ink = ImGui::GetStyleColorVec4(ImGuiCol_Text);
  draw("t = " + timeText(asked_s, span_s), ink);
  // A playing picture is always a little behind.
  const double behind_s = std::abs(asked_s - session.status().shown_s);
  const bool differs = timeline.playing() ? behind_s > kNoticed_s * std::abs(timeline.rate()) : behind_s > 0;
  if (session.picture() && differs) {
    draw("shown " + timeText(session.status().shown_s, span_s), stateColor(render::ControllerState::busy));
  }
  if (!timeline.playing() && !timeline.times_s().empty() && timeline.step_s() == asked_s) {
    draw(fmt::format("step {} of {}", timeline.step() + 1, timeline.times_s().size()), ink);
  }
}

}  // namespace

void drawTransport(PanelContext& context) {
  drawButtons(context);
  ImGui::SameLine(0, 14 * context.scale);
  drawRate(context);
  drawTimes(context);
}

}  // namespace emscape::view
