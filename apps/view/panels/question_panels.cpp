/// Questions: edits of an earlier run, losses at the end, files to be replaced, changed files.
#include <fmt/format.h>

#include <filesystem>

#include "apps/view/panels/panels.h"
#include "apps/view/values/edit_text.h"
#include "apps/view/widgets/dialog.h"
#include "apps/view/widgets/glyphs.h"
#include "apps/view/widgets/theme.h"

namespace emscape::view {
namespace {

void drawEdits(const std::vector<scenario::Edit>& edits, const Session& session) {
  constexpr std::size_t kMaxLines = 6;
  const playback::ScenarioPtr scenario = session.scenario();
  ImGui::PushStyleColor(ImGuiCol_Text, mutedColor(session.theme()));
  for (std::size_t i = 0; i < edits.size() && i < kMaxLines; ++i) {
    ImGui::BulletText("%s", drawable(scenario ? editText(*scenario, edits[i]) : toString(edits[i])).c_str());
  }
  if (edits.size() > kMaxLines) ImGui::Text("and %zu more", edits.size() - kMaxLines);
  ImGui::PopStyleColor();
}

/// "2026-11-28 13:56 UTC" of "2026-11-28T13:56:30.328Z".
std::string minuteText(const std::string& utc) {
  return utc.size() < 16 ? utc : utc.substr(0, 10) + " " + utc.substr(11, 5) + " UTC";
}

}  // namespace

void drawRestoreQuestion(PanelContext& context) {
  Session& session = context.session;
  if (!session.keptView()) return;
  const playback::AutosavedView kept = *session.keptView();
  if (!beginDialog(context, "Edits that were not saved", session.panels.restore)) return;
  ImGui::TextUnformatted(
      fmt::format("Edits of this input were not saved. A view with {} edit{} was kept at {}.",
                  kept.state.edits.size(), kept.state.edits.size() == 1 ? "" : "s",
                  minuteText(kept.written_utc))
          .c_str());
  drawEdits(kept.state.edits, session);
  if (kept.input_changed) {
    ImGui::TextUnformatted("The file was written since: edits that do not apply any more are left out.");
  }
  ImGui::Spacing();
  if (defaultButton("Restore")) perform(context, R"({"do":"restore"})");
  if (ImGui::Button("Discard")) perform(context, R"({"do":"discard"})");
  ImGui::SameLine();
  if (ImGui::Button("Later (Esc)")) session.panels.restore = false;
  ImGui::TextDisabled("Later: it is kept until it is restored or discarded (menu File).");
  if (kept.others > 0) {
    ImGui::TextDisabled("%s",
                        fmt::format("{} older view{} kept, too: offered after Discard, or at the next start.",
                                    kept.others, kept.others == 1 ? " is" : "s are")
                            .c_str());
  }
  endDialog();
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
  ImGui::SetNextWindowPos(
      {picture.x + picture.width / 2, picture.y + (session.files().recorder.running() ? 184 : 84) * s},
      ImGuiCond_Always, {0.5F, 0});
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

namespace {

/// Asks about a running recording.
void drawRecordingQuestion(PanelContext& context, const Json& answers) {
  Session& session = context.session;
  const Recorder::Progress progress = session.files().recorder.progress();
  ImGui::TextUnformatted(
      progress.total > 0 ? fmt::format("A recording is {} of {}:", progress.pictures, progress.total).c_str()
                         : "A recording is being opened:");
  ImGui::TextDisabled("%s", drawable(progress.output).c_str());
  ImGui::Spacing();
  const auto answer = [&](const char* recording) {
    Json all = answers;
    all["recording"] = recording;
    session.perform({"quit", all});
  };
  if (defaultButton("Wait, then quit")) answer("wait");
  if (ImGui::Button("Cancel it and quit")) answer("cancel");
  ImGui::SameLine();
  if (ImGui::Button("Back (Esc)")) session.panels.unsaved = false;
}

/// Asks about edits and colours.
void drawLossQuestion(PanelContext& context, const Json& answers) {
  Session& session = context.session;
  bool replaces = false;
  const auto tellFile = [&](const std::string& file) {
    std::error_code ignored;
    const bool exists = std::filesystem::exists(file, ignored);
    replaces = replaces || exists;
    ImGui::TextDisabled("to %s%s", drawable(file).c_str(), exists ? ", which is replaced" : "");
  };
  if (session.hasUnsavedEdits()) {
    ImGui::TextUnformatted("The scenario has edits that are not saved.");
    drawEdits(session.viewState().edits, session);
    tellFile(session.usualScenarioFile());
  }
  if (session.hasUnsavedColors()) {
    ImGui::TextUnformatted("The colours were changed and are not saved.");
    tellFile(session.usualColorsFile());
  }
  ImGui::Spacing();
  const auto answer = [&](const char* edits) {
    Json all = answers;
    all["edits"] = edits;
    session.perform({"quit", all});
  };
  if (replaces) {
    if (ImGui::Button("Replace and quit")) answer("save");
    ImGui::SameLine();
  } else if (defaultButton("Save and quit")) {
    answer("save");
  }
  if (ImGui::Button("Discard and quit")) answer("discard");
  ImGui::SameLine();
  if (replaces && defaultButton("Back")) session.panels.unsaved = false;
  if (replaces) ImGui::NewLine();
  if (!replaces && ImGui::Button("Back (Esc)")) session.panels.unsaved = false;
}

}  // namespace

void drawUnsavedQuestion(PanelContext& context) {
  Session& session = context.session;
  if (!beginDialog(context, "Quit", session.panels.unsaved)) return;
  const Json answers = session.quitAnswers();
  const bool asks_recording =
      session.files().recorder.running() && answers.value("recording", "ask") == "ask";
  if (asks_recording) {
    drawRecordingQuestion(context, answers);
  } else {
    drawLossQuestion(context, answers);
  }
  endDialog();
}

void drawReplaceQuestion(PanelContext& context) {
  Session& session = context.session;
  if (!session.replacing()) return;
  if (!beginDialog(context, "Replace", session.panels.replace)) return;
  const std::string file = session.replacing()->file;
  std::error_code ignored;
  ImGui::TextUnformatted(std::filesystem::is_directory(file, ignored)
                             ? "This folder exists and has files in it:"
                             : "This file exists already:");
  ImGui::TextDisabled("%s", drawable(file).c_str());
  ImGui::Spacing();
  if (ImGui::Button("Replace")) perform(context, R"({"do":"replace"})");
  ImGui::SameLine();
  if (defaultButton("Back")) session.panels.replace = false;
  ImGui::NewLine();
  endDialog();
}

}  // namespace emscape::view
