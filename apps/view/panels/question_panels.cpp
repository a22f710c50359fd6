/// Dialogs: restore edits of an earlier run, unsaved edits, changed files.
#include <fmt/format.h>

#include <filesystem>

#include "apps/view/panels/glyphs.h"
#include "apps/view/panels/panels.h"
#include "apps/view/panels/theme.h"

namespace emscape::view {
namespace {

/// Opens a dialog in the middle of the window. Always followed by endQuestion().
bool beginQuestion(PanelContext& context, const char* title, bool& open) {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Appearing, {0.5F, 0.5F});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * context.scale);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(16 * context.scale, 14 * context.scale));
  return ImGui::Begin(
      title, &open,
      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
}

void endQuestion() {
  ImGui::End();
  ImGui::PopStyleVar(2);
}

void drawEdits(const std::vector<scenario::Edit>& edits, render::Theme theme) {
  constexpr std::size_t kMaxLines = 6;
  ImGui::PushStyleColor(ImGuiCol_Text, mutedColor(theme));
  for (std::size_t i = 0; i < edits.size() && i < kMaxLines; ++i) {
    ImGui::BulletText("%s", scenario::toString(edits[i]).c_str());
  }
  if (edits.size() > kMaxLines) ImGui::Text("and %zu more", edits.size() - kMaxLines);
  ImGui::PopStyleColor();
}

/// The default button, also pressed by Enter unless another dialog has the focus.
bool firstButton(const char* text) {
  const bool pressed = ImGui::Button((std::string(text) + " (Enter)").c_str());
  ImGui::SameLine();
  const bool takes_keys = !ImGui::IsWindowAppearing() &&
                          (ImGui::IsWindowFocused() || !ImGui::IsWindowFocused(ImGuiFocusedFlags_AnyWindow));
  return pressed || (takes_keys && isEnterPressed());
}

}  // namespace

void drawRestoreQuestion(PanelContext& context) {
  Session& session = context.session;
  if (!session.panels.restore || !session.keptView()) return;
  const playback::AutosavedView kept = *session.keptView();
  beginQuestion(context, "Edits that were not saved", session.panels.restore);
  ImGui::TextUnformatted(
      fmt::format("Edits of this input were not saved. A view with {} edit{} was kept at {}.",
                  kept.state.edits.size(), kept.state.edits.size() == 1 ? "" : "s", kept.written_utc)
          .c_str());
  drawEdits(kept.state.edits, session.theme());
  if (kept.input_changed) {
    ImGui::TextUnformatted("The file was written since: edits that do not apply any more are left out.");
  }
  ImGui::Spacing();
  if (firstButton("Restore")) perform(context, R"({"do":"restore"})");
  if (ImGui::Button("Discard")) perform(context, R"({"do":"discard"})");
  ImGui::SameLine();
  if (ImGui::Button("Later (Esc)")) session.panels.restore = false;
  ImGui::TextDisabled("Later: it is kept until the next edit.");
  endQuestion();
}

void drawChangedFiles(PanelContext& context, const Area& picture) {
  Session& session = context.session;
  const std::vector<std::string>& files = session.changedFiles();
  if (!session.panels.changed || files.empty()) return;
  const float s = context.scale;
  const std::string name = std::filesystem::path(files.front()).filename().string();
  const std::string text = files.size() == 1
                               ? name + " has changed on the disk."
                               : fmt::format("{} and {} other file{} have changed on the disk.", name,
                                             files.size() - 1, files.size() == 2 ? "" : "s");
  ImGui::SetNextWindowPos({picture.x + picture.width / 2, picture.y + 80 * s}, ImGuiCond_Always, {0.5F, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(16 * s, 10 * s));
  ImGui::Begin("changed", nullptr,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoDecoration |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(drawable(text).c_str());
  ImGui::SameLine(0, 16 * s);
  if (ImGui::Button("Reload (F5)")) perform(context, R"({"do":"reload"})");
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Edits that still apply are kept");
  ImGui::SameLine();
  if (ImGui::Button("Not now")) session.panels.changed = false;
  ImGui::End();
  ImGui::PopStyleVar(2);
}

void drawUnsavedQuestion(PanelContext& context) {
  Session& session = context.session;
  if (!session.panels.unsaved) return;
  beginQuestion(context, "Quit", session.panels.unsaved);
  ImGui::TextUnformatted("The scenario has edits that are not saved.");
  drawEdits(session.viewState().edits, session.theme());
  ImGui::Spacing();
  if (firstButton("Save and quit")) perform(context, R"({"do":"quit","edits":"save"})");
  if (ImGui::Button("Discard and quit")) perform(context, R"({"do":"quit","edits":"discard"})");
  ImGui::SameLine();
  if (ImGui::Button("Back (Esc)")) session.panels.unsaved = false;
  endQuestion();
}

}  // namespace emscape::view
