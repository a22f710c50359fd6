/// The state of the program: badge, progress, what is computed, and the button that cancels it.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "apps/view/panels/panels.h"
#include "apps/view/widgets/glyphs.h"
#include "apps/view/widgets/names.h"
#include "apps/view/widgets/theme.h"
#include "volume/difference.h"

namespace emscape::view {
namespace {

constexpr double kMebibyte = 1 << 20;

constexpr char kBetween[] = "   ·   ";

float badgeWidth(const PanelContext& context, const ProgramState& state) {
  return std::max(ImGui::CalcTextSize(state.badge.c_str()).x, ImGui::CalcTextSize("COMPUTING 00 %").x) +
         16 * context.scale;
}

bool hasCancel(const ProgramState& state) {
  return state.can_cancel && state.activity != Activity::playing;
}

void drawBadge(const PanelContext& context, const ProgramState& state) {
  const float s = context.scale;
  const ImVec4 color = activityColor(state.activity, context.session.theme());
  const ImVec2 at = ImGui::GetCursorScreenPos(), text = ImGui::CalcTextSize(state.badge.c_str());
  const float width = badgeWidth(context, state);
  const ImVec2 low{at.x, at.y - s}, high{at.x + width, at.y + text.y + 2 * s};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto fill = [&](float to, float alpha) {
    list.AddRectFilled(low, {to, high.y}, ImGui::ColorConvertFloat4ToU32({color.x, color.y, color.z, alpha}),
                       4 * s);
  };
  const bool has_progress = state.fraction >= 0;
  fill(high.x, has_progress ? 0.7F : 1);
  if (has_progress) fill(low.x + width * static_cast<float>(std::clamp(state.fraction, 0.0, 1.0)), 1);
  list.AddText({at.x + (width - text.x) / 2, at.y}, IM_COL32(16, 20, 27, 255), state.badge.c_str());
  ImGui::Dummy({width, text.y});
}

/// The state in words, and the costs of the picture.
std::vector<std::string> partsOf(const Session& session, const ProgramState& state) {
  const playback::LiveStatus& status = session.status();
  std::vector<std::string> parts;
  const auto add = [&](const std::string& text) {
    if (!text.empty()) parts.push_back(text);
  };
  if (session.picture() && volume::isDifference(session.picture()->info())) add("DIFFERENCE");
  add(state.what);
  add(state.picture);
  add(state.stream);
  if (!session.picture()) return parts;
  add(fmt::format("cast {:.0f} ms", status.cast_ms));
  if (status.field_ms > 0) add(fmt::format("field {:.0f} ms", status.field_ms));
  add(status.device);
  return parts;
}

}  // namespace

float stateBadgeWidth(const PanelContext& context) {
  const ProgramState state = context.session.programState();
  std::string text = "Cancel";  // whether it is there or not: the rest keeps its place
  for (const std::string& part : {state.what, state.picture, state.stream})
    text += (part.empty() ? "" : kBetween) + part;
  return badgeWidth(context, state) + 24 * context.scale + ImGui::CalcTextSize(drawable(text).c_str()).x;
}

void drawStateBadge(PanelContext& context, float right_x) {
  const Session& session = context.session;
  const ProgramState state = session.programState();
  const float s = context.scale;
  const std::vector<std::string> parts = partsOf(session, state);
  bool is_on_button = false;
  ImGui::BeginGroup();
  drawBadge(context, state);
  if (hasCancel(state)) {
    ImGui::SameLine(0, 8 * s);
    if (ImGui::SmallButton("Cancel")) perform(context, R"({"do":"cancel"})");
    is_on_button = ImGui::IsItemHovered();
    if (is_on_button) ImGui::SetTooltip("Shift+Esc");
  }
  const float room = right_x - (ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x + 12 * s);
  std::string text, all;
  bool fits = true;
  for (const std::string& part : parts) {
    all += (all.empty() ? "" : "\n") + drawable(part);
    const std::string longer = text + (text.empty() ? "" : kBetween) + part;
    // The first part and the stream's are shortened, not left out.
    const bool is_needed = fits && (text.empty() || part == state.stream);
    fits = fits && ImGui::CalcTextSize(longer.c_str()).x <= room;
    if (fits || is_needed) text = longer;
  }
  ImGui::SameLine(0, 12 * s);
  if (!fits && room > 0) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    drawName(*ImGui::GetWindowDrawList(), text, at, at.x + room);
    ImGui::Dummy({room, ImGui::GetTextLineHeight()});
  } else {
    ImGui::TextUnformatted(drawable(text).c_str());
  }
  ImGui::EndGroup();
  if (is_on_button || !ImGui::IsItemHovered() || !session.picture()) return;
  // Above the line: Cancel stays free.
  ImGui::SetNextWindowPos({ImGui::GetItemRectMin().x, ImGui::GetItemRectMin().y - 8 * s}, ImGuiCond_Always,
                          {0, 1});
  ImGui::SetTooltip("%s", fmt::format("{}\ncache {:.0f} of {:.0f} MiB", all,
                                      static_cast<double>(session.status().cached_bytes) / kMebibyte,
                                      static_cast<double>(session.cacheLimit_bytes()) / kMebibyte)
                              .c_str());
}

}  // namespace emscape::view
