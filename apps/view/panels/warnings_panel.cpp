/// The list of warnings, and their number in the status bar.
#include <fmt/format.h>

#include "apps/view/panels/panels.h"
#include "apps/view/widgets/dialog.h"
#include "apps/view/widgets/glyphs.h"
#include "apps/view/widgets/theme.h"
#include "apps/view/widgets/wrapped_text.h"

namespace emscape::view {

std::string warningsText(const Session& session) {
  const std::size_t count = session.warnings().size();
  return count == 0 ? "" : fmt::format("{} warning{}", count, count == 1 ? "" : "s");
}

void drawWarningsButton(PanelContext& context) {
  const std::string text = warningsText(context.session);
  if (text.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, warningColor(context.session.theme()));
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(6 * context.scale, 0));
  if (ImGui::Button(text.c_str())) perform(context, R"({"do":"panel","name":"warnings"})");
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Lists them (Ctrl+Shift+W)");
}

void drawWarnings(PanelContext& context) {
  Session& session = context.session;
  if (!beginDialog(context, "Warnings", session.panels.warnings, {620, 360})) return;
  const float below = ImGui::GetFrameHeightWithSpacing();
  ImGui::BeginChild("list", {0, -below});
  if (session.warnings().empty()) ImGui::TextDisabled("There are none.");
  for (const std::string& warning : session.warnings()) {
    ImGui::Bullet();
    textWrapped(warning);
  }
  ImGui::EndChild();
  if (defaultButton("Close")) session.panels.warnings = false;
  ImGui::TextDisabled("of files, models and scans, for the scenario and the time on screen");
  endDialog();
}

}  // namespace emscape::view
