/// The panel shown while nothing is open.
#include <algorithm>
#include <filesystem>

#include "apps/view/panels/names.h"
#include "apps/view/panels/panels.h"
#include "apps/view/panels/theme.h"

namespace emscape::view {

void drawRecentFiles(PanelContext& context, std::size_t max_count) {
  Session& session = context.session;
  const std::vector<std::string> recent = session.files().recent;
  for (std::size_t i = 0; i < std::min(max_count, recent.size()); ++i) {
    const std::filesystem::path file(recent[i]);
    ImGui::PushID(static_cast<int>(i));
    if (selectableName(file.filename().string(), false)) {
      session.perform({"open_recent", {{"number", i + 1}}});
    }
    ImGui::SameLine(0, 12 * context.scale);
    ImGui::TextDisabled("%s", drawable(file.parent_path()).c_str());
    ImGui::PopID();
  }
}

void drawStart(PanelContext& context, const Area& picture) {
  Session& session = context.session;
  if (session.hasInput() || session.files().is_opening || session.panels.open) return;
  const float s = context.scale;
  const float width = std::min(620 * s, 0.94F * picture.width);
  ImGui::SetNextWindowPos({picture.x + picture.width / 2, picture.y + picture.height / 2}, ImGuiCond_Always,
                          {0.5F, 0.5F});
  ImGui::SetNextWindowSize({width, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8 * s, 10 * s));
  ImGui::Begin("start", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoBackground |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::TextColored(accentColor(session.theme()), "Nothing is open");
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(
      "Open a scenario (.yaml, .json), whose field is computed, or volumes from an earlier computation: a "
      "file "
      "(.vdb .nvdb .vti .raw .dat), a series (.pvd) or a folder.");
  ImGui::PopTextWrapPos();
  if (ImGui::Button("Open (Ctrl+O)")) perform(context, R"({"do":"open"})");
  ImGui::SameLine(0, 16 * s);
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("or drop a file on the window. F1: keys and mouse");
  if (!session.files().recent.empty()) {
    ImGui::Spacing();
    ImGui::TextColored(accentColor(session.theme()), "Opened last");
    ImGui::SameLine();
    ImGui::TextDisabled("(the first: Ctrl+Shift+O)");
    drawRecentFiles(context, session.files().recent.size());
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace emscape::view
