/// The panel shown while nothing is open.
#include <algorithm>
#include <filesystem>
#include <string>

#include "apps/view/panels/panels.h"
#include "apps/view/widgets/names.h"
#include "apps/view/widgets/theme.h"
#include "apps/view/widgets/wrapped_text.h"
#include "recording/read_recording.h"

namespace emscape::view {

void drawRecentFiles(PanelContext& context, std::size_t max_count) {
  Session& session = context.session;
  const std::vector<std::string> recent = session.files().recent;
  for (std::size_t i = 0; i < std::min(max_count, recent.size()); ++i) {
    const std::filesystem::path file(recent[i]);
    ImGui::PushID(static_cast<int>(i));
    if (selectableName(file.filename().string(), false, 0, /*has_tab_stop=*/true))
      session.perform({"open_recent", {{"number", i + 1}}});
    ImGui::SameLine(0, 12 * context.scale);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float room = std::max(1.0F, ImGui::GetContentRegionAvail().x);
    ImGui::PushStyleColor(ImGuiCol_Text, mutedColor(session.theme()));
    const bool is_long = drawName(*ImGui::GetWindowDrawList(), file.parent_path().string(), at, at.x + room);
    ImGui::PopStyleColor();
    ImGui::Dummy({room, ImGui::GetTextLineHeight()});
    tooltipOfLongName(file.parent_path().string(), is_long);
    ImGui::PopID();
  }
}

namespace {

/// Examples beside their first sentences.
void drawExamples(PanelContext& context) {
  Session& session = context.session;
  ImGui::TextColored(accentColor(session.theme()), "Examples");
  const float most = 0.4F * ImGui::GetIO().DisplaySize.y;
  static float wanted = most;  // height of the table in the frame before
  ImGui::BeginChild("examples", {0, std::clamp(wanted, 1.0F, most)});
  if (ImGui::BeginTable("examples", 2)) {
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed);
    ImGui::TableSetupColumn("text", ImGuiTableColumnFlags_WidthStretch);
    for (const Example& example : session.files().examples) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      pushNameId(example.file);
      if (selectableName(std::filesystem::path(example.file).stem().string(), false)) {
        session.perform({"open", {{"file", example.file}}});
      }
      ImGui::PopID();
      ImGui::TableNextColumn();
      ImGui::PushStyleColor(ImGuiCol_Text, mutedColor(session.theme()));
      textWrapped(example.text);
      ImGui::PopStyleColor();
    }
    ImGui::EndTable();
  }
  wanted = ImGui::GetCursorPosY();
  ImGui::EndChild();
}

}  // namespace

void drawStart(PanelContext& context, const Area& picture) {
  Session& session = context.session;
  if (session.hasInput() || session.files().is_opening || session.panels.open) return;
  const float s = context.scale;
  const float width = std::min(720 * s, 0.94F * picture.width);
  ImGui::SetNextWindowPos({picture.x + picture.width / 2, picture.y + picture.height / 2}, ImGuiCond_Always,
                          {0.5F, 0.5F});
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, picture.height});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8 * s, 8 * s));
  ImGui::Begin("start", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoBringToFrontOnFocus |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  static const std::string text =
      "Open a scenario (.yaml, .json), whose field is computed, or volumes of any program: a file "
      "(.vdb .nvdb .vti .raw .dat), a series (.pvd) or a folder; or a recording of a battlefield (" +
      interop::recordingEndingsText() + ").";
  textWrapped(text);
  if (ImGui::Button("Open (Ctrl+O)")) perform(context, R"({"do":"open"})");
  ImGui::SameLine(0, 16 * s);
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("or drop a file on the window. F1: first steps, keys and mouse");
  if (!session.files().recent.empty()) {
    ImGui::Spacing();
    ImGui::TextColored(accentColor(session.theme()), "Opened last");
    ImGui::SameLine();
    ImGui::TextDisabled("(the first: Ctrl+Shift+O)");
    drawRecentFiles(context, 5);
  }
  if (!session.files().examples.empty()) {
    ImGui::Spacing();
    drawExamples(context);
  }
  ImGui::Spacing();
  ImGui::TextDisabled("Appearance");
  ImGui::SameLine();
  if (ImGui::SmallButton("dark or light (D)")) perform(context, R"({"do":"theme"})");
  ImGui::SameLine();
  if (ImGui::SmallButton("larger texts (Ctrl++)")) perform(context, R"({"do":"scale","change":1})");
  ImGui::SameLine();
  if (ImGui::SmallButton("smaller texts (Ctrl+-)")) perform(context, R"({"do":"scale","change":-1})");
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace emscape::view
