#include "apps/view/panels/panels.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "apps/view/panels/picture_overlay.h"
#include "apps/view/widgets/dialog.h"
#include "apps/view/widgets/glyphs.h"
#include "apps/view/widgets/names.h"
#include "apps/view/widgets/refusal.h"
#include "apps/view/widgets/theme.h"
#include "apps/view/widgets/wrapped_text.h"
#include "base/text/time_text.h"
#include "emscape/render/annotate/legend.h"

namespace emscape::view {
namespace {

void place(const Area& area) {
  ImGui::SetNextWindowPos({area.x, area.y});
  ImGui::SetNextWindowSize({area.width, area.height});
}

/// Scrolls by as much as the panels above the scenario's rows have grown: the rows stay under the cursor.
/// @param has_same_panels  as in the frame before
void keepRowsInPlace(bool has_rows, bool has_same_panels) {
  static float top_before = -1;
  const float top = has_rows ? ImGui::GetCursorPosY() : -1;
  const float scroll = ImGui::GetScrollY();
  const bool are_rows_in_sight = top_before >= 0 && scroll > top_before - ImGui::GetWindowHeight() / 2;
  if (has_rows && has_same_panels && are_rows_in_sight && scroll > 0 && top != top_before)
    ImGui::SetScrollY(scroll + top - top_before);
  top_before = top;
}

/// True from the locking of the probe until the user scrolls, clicks or types: its head stays in sight
/// while its readings come.
bool showsProbe(const Session& session) {
  static bool is_shown = false, was_locked = false;
  const ImGuiIO& io = ImGui::GetIO();
  const bool is_locked = session.panels.probe && session.prober().isLocked();
  const bool is_new = is_locked && !std::exchange(was_locked, is_locked);
  if (!is_locked) was_locked = false;
  const bool is_other_input = io.MouseWheel != 0 || ImGui::IsAnyMouseDown() || ImGui::IsAnyItemActive();
  is_shown = is_new || (is_shown && is_locked && !is_other_input);
  return is_shown;
}

bool isMeasuring(const Session& session) {
  return session.tool().kind == PickTool::Kind::measure;
}

}  // namespace

Layout layoutOf(const Session& session, float width, float height, float scale) {
  const Panels& panels = session.panels;
  Layout layout;
  if (panels.hidden) {
    layout.picture = {0, 0, width, height};
    return layout;
  }
  // The picture keeps the largest part of the window. Where that leaves too little for the side panel, it
  // lies over the picture while it is used, and the time line is reduced to its buttons.
  const bool is_narrow = width < 720 * scale, is_low = height < 420 * scale;
  const float status_height = 30 * scale;
  layout.has_side = session.hasInput() && (panels.scenario || panels.colors || panels.planes ||
                                           panels.probe || isMeasuring(session));
  layout.side_is_over = layout.has_side && is_narrow;
  const float side_width = !layout.has_side ? 0
                           : is_narrow      ? panels.side ? std::min(340 * scale, 0.85F * width) : 0
                                       : std::max(std::min(340 * scale, std::max(310 * scale, 0.36F * width)),
                                                  std::min(420 * scale, 0.3F * width));
  layout.menu_height = ImGui::GetFrameHeight();
  const float room = std::max(1.0F, height - status_height - layout.menu_height);
  const float timeline_height = timelineHeight(session, scale, is_low ? 0 : 0.3F * room);
  layout.status = {0, height - status_height, width, status_height};
  layout.timeline = {0, layout.status.y - timeline_height, width, timeline_height};
  const float middle = std::max(1.0F, layout.timeline.y - layout.menu_height);
  layout.side = {width - side_width, layout.menu_height, side_width, middle};
  const float beside = layout.side_is_over ? 0 : side_width;
  layout.picture = {0, layout.menu_height, std::max(1.0F, width - beside), middle};
  return layout;
}

void drawSideButton(PanelContext& context) {
  const Layout layout =
      layoutOf(context.session, ImGui::GetIO().DisplaySize.x, ImGui::GetIO().DisplaySize.y, context.scale);
  if (!layout.side_is_over) return;
  const char* const text = context.session.panels.side ? "Picture##side" : "Side##side";
  const float width = ImGui::CalcTextSize(text, nullptr, /*hide_text_after_double_hash=*/true).x;
  const float padding = 2 * ImGui::GetStyle().FramePadding.x + 8 * context.scale;
  ImGui::SameLine(std::max(ImGui::GetCursorPosX(), ImGui::GetIO().DisplaySize.x - width - padding));
  if (ImGui::SmallButton(text)) perform(context, R"({"do":"panel","name":"side"})");
}

void drawSidePanel(PanelContext& context, const Layout& layout) {
  const Area& area = layout.side;
  if (area.width < 1) return;
  place(area);
  ImGuiWindowFlags flags = kFixedPanel;
  if (layout.side_is_over) {  // App does not fill the background below it
    flags &= ~(ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoBringToFrontOnFocus);
  }
  ImGui::Begin(layout.side_is_over ? "side over" : "side", nullptr, flags);
  const Panels& panels = context.session.panels;
  // All panels share the scroll bar of the side; only that of the scenario, if it is alone, has its own.
  struct Section {
    bool is_open;
    void (*draw)(PanelContext& context);
  };
  const std::array<Section, 4> sections{{{panels.colors, drawColorsPanel},
                                         {panels.planes, drawPlanesPanel},
                                         {isMeasuring(context.session), drawMeasurePanel},
                                         {panels.probe, drawProbePanel}}};
  static std::array<bool, 4> was_open{};
  bool has_same_panels = true;
  const bool shows_probe = showsProbe(context.session);
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const bool is_open = sections[i].is_open, is_other = std::exchange(was_open[i], is_open) != is_open;
    has_same_panels = has_same_panels && !is_other;
    if (!is_open) continue;
    const bool is_probe = sections[i].draw == drawProbePanel;
    if (is_other || (is_probe && shows_probe))
      ImGui::SetScrollY(ImGui::GetCursorPosY() - ImGui::GetStyle().WindowPadding.y);
    sections[i].draw(context);
    const bool has_more =
        panels.scenario || std::any_of(sections.begin() + static_cast<std::ptrdiff_t>(i) + 1, sections.end(),
                                       [](const Section& s) { return s.is_open; });
    if (!has_more) continue;
    ImGui::Spacing();
    ImGui::Separator();
    ImGui::Spacing();
  }
  keepRowsInPlace(panels.scenario, has_same_panels && !shows_probe);
  if (panels.scenario) drawScenarioPanel(context);
  ImGui::End();
}

void drawStatusBar(PanelContext& context, const Area& area) {
  const Session& session = context.session;
  const playback::LiveStatus& status = session.status();
  const float s = context.scale;
  place(area);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(12 * s, 5 * s));
  ImGui::Begin("status", nullptr, kFixedPanel | ImGuiWindowFlags_NoScrollbar);
  // The picture and the buttons of the time line state the time; here only what differs, without that line.
  const bool has_times = session.panels.timeline && !session.panels.hidden;
  std::string right;
  if (!has_times && session.picture() && status.shown_s != status.asked_s && !session.timeline().playing()) {
    const double span_s = session.timeline().end_s();
    right = fmt::format("requested {}, shown {}", timeText(status.asked_s, span_s),
                        timeText(status.shown_s, span_s));
  }
  if (!warningsText(session).empty()) {
    drawWarningsButton(context);
    ImGui::SameLine(0, 8 * s);
  }
  const float right_x = area.width - ImGui::CalcTextSize(right.c_str()).x - 12 * s;
  // The state has priority over where the cursor is, the value there over how the picture was made.
  std::string under;
  const float essential_x = stateBadgeWidth(context) + ImGui::GetCursorPosX() + 24 * s;
  for (const std::string& text : cursorTexts(session)) {
    under = text;
    if (right_x - ImGui::CalcTextSize(under.c_str()).x - 24 * s >= essential_x) break;
  }
  const float under_x = right_x - (under.empty() ? 0 : ImGui::CalcTextSize(under.c_str()).x + 24 * s);
  drawStateBadge(context, under_x - 12 * s);
  if (!under.empty()) {
    const std::string all = cursorTexts(session).front();
    ImGui::SameLine(0, 12 * s);
    const float from_x = std::max(under_x, ImGui::GetCursorPosX());
    ImGui::SetCursorPosX(from_x);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float room = std::max(0.0F, right_x - from_x);
    const bool is_long = drawName(*ImGui::GetWindowDrawList(), under, at, at.x + room);
    ImGui::Dummy({room, ImGui::GetTextLineHeight()});
    tooltipOfLongName(all, is_long || under != all);
  }
  if (!right.empty()) {
    ImGui::SameLine();
    ImGui::SetCursorPosX(std::max(ImGui::GetCursorPosX(), right_x));
    ImGui::TextUnformatted(drawable(right).c_str());
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

void drawNotice(PanelContext& context, const Area& picture) {
  const Session& session = context.session;
  const float s = context.scale;
  std::string text = session.notice().text;
  ImVec4 color =
      session.notice().is_error ? errorColor(session.theme()) : ImGui::GetStyleColorVec4(ImGuiCol_Text);
  if (text.empty() && !session.picture() && (session.hasInput() || session.files().is_opening)) {
    const std::string what = session.programState().what;
    text = what.empty() ? "opening …" : what + " …";
    color = mutedColor(session.theme());
  }
  const std::optional<Rejection>& rejection = session.rejection();
  if (context.shows_rejection && rejection && text == rejection->message) return;
  if (text.empty() || isBesideField(text)) return;
  const float free_width = legendBegin(context, picture.x + picture.width) - picture.x;
  const float wrap = std::max(120 * s, std::min(free_width - 60 * s, 760 * s));
  text = wrapped(text, wrap);
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  // Beside the legend, below the picture's title and what else lies at its top; the labels of the axes are at
  // the bottom, and below them the values and the state.
  const float top =
      std::max(0.0F, std::min({120 * s, 0.3F * picture.height, picture.height - size.y - 20 * s}));
  const ImVec2 box{size.x + 32 * s, size.y + 20 * s};
  ImGui::SetNextWindowPos(besideDialogs({picture.x + (free_width - box.x) / 2, picture.y + top}, box,
                                        {picture.x, picture.y},
                                        {picture.x + picture.width, picture.y + picture.height}, 8 * s));
  ImGui::SetNextWindowSize(box);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(16 * s, 10 * s));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, std::max(1.0F, s));
  ImGui::SetNextWindowBgAlpha(0.94F);
  ImGui::Begin("notice", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
  ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());  // also over dialogs, which told it
  ImGui::End();
  ImGui::PopStyleVar(3);
}

void drawGoToTime(PanelContext& context) {
  Session& session = context.session;
  static FieldText typed{};
  if (!beginDialog(context, "Go to time", session.panels.time)) return;
  ImGui::TextUnformatted("seconds, M:SS or UTC");
  if (ImGui::IsWindowAppearing()) {
    *fmt::format_to_n(typed.data(), typed.size() - 1, "{:.9g}", session.timeline().asked_s()).out = '\0';
    ImGui::SetKeyboardFocusHere();
  }
  ImGui::SetNextItemWidth(200 * context.scale);
  actionField(context, "##time", "", typed, "Go", [&session](const std::string& time) {
    const bool is_taken = session.perform({"seek", {{"time", time}}});
    session.panels.time = !is_taken;
    return is_taken;
  });
  endDialog();
}

}  // namespace emscape::view
