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

/// @param original  without the edits
void drawEdits(const std::vector<scenario::Edit>& edits, const playback::ScenarioPtr& original,
               render::Theme theme) {
  constexpr std::size_t kMaxLines = 6;
  if (!original) return;
  const std::size_t lines = std::min(edits.size(), kMaxLines);
  const auto end = edits.begin() + static_cast<std::ptrdiff_t>(lines);
  ImGui::PushStyleColor(ImGuiCol_Text, mutedColor(theme));
  for (const std::string& text : editTexts(*original, {edits.begin(), end}))
    ImGui::BulletText("%s", drawable(text).c_str());
  if (edits.size() > lines) ImGui::Text("and %zu more", edits.size() - lines);
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
  drawEdits(kept.state.edits, session.original(), session.theme());
  if (kept.input_changed) {
    ImGui::TextUnformatted("The file was written since: edits that do not apply any more are left out.");
  }
  ImGui::Spacing();
  const int answer = drawAnswers(kept.written_utc, {"Restore", "Discard", "Later (Esc)"}, 0);
  ImGui::TextDisabled("Later: it is kept until it is restored or discarded (menu File).");
  if (kept.others > 0) {
    ImGui::TextDisabled("%s",
                        fmt::format("{} older view{} kept, too: offered after Discard, or at the next start.",
                                    kept.others, kept.others == 1 ? " is" : "s are")
                            .c_str());
  }
  endDialog();
  if (answer == 0) perform(context, R"({"do":"restore"})");
  if (answer == 1) perform(context, R"({"do":"discard"})");
  if (answer == 2) session.panels.restore = false;
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

/// Quits with a further answer.
void quitWith(Session& session, const char* question, const char* answer) {
  Json answers = session.quitAnswers();
  answers[question] = answer;
  session.perform({"quit", answers});
}

/// Asks about a recording that runs, or has ended while it was asked.
void drawRecordingQuestion(PanelContext& context, bool is_running) {
  Session& session = context.session;
  const Recorder::Progress progress = session.files().recorder.progress();
  ImGui::TextUnformatted(
      !is_running ? "The recording has ended:"
      : progress.total > 0
          ? fmt::format("A recording is {} of {}:", progress.pictures, progress.total).c_str()
          : "A recording is being opened:");
  ImGui::TextDisabled("%s", drawable(progress.output).c_str());
  ImGui::Spacing();
  const int answer =
      is_running ? drawAnswers("recording", {"Wait, then quit", "Cancel it and quit", "Back (Esc)"}, 0)
                 : drawAnswers("recorded", {"Quit", "Back (Esc)"}, 0);
  const bool goes_back = answer == (is_running ? 2 : 1);
  if (goes_back) {
    session.panels.unsaved = false;
  } else if (answer >= 0) {
    quitWith(session, "recording", answer == 0 ? "wait" : "cancel");
  }
}

/// Asks about edits and colours.
void drawLossQuestion(PanelContext& context) {
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
    drawEdits(session.scenario()->edits(), session.original(), session.theme());
    tellFile(session.usualScenarioFile());
  }
  if (session.hasUnsavedColors()) {
    ImGui::TextUnformatted("The colours were changed and are not saved.");
    tellFile(session.usualColorsFile());
  }
  ImGui::Spacing();
  const int answer =
      drawAnswers("loss", {replaces ? "Replace and quit" : "Save and quit", "Discard and quit", "Back (Esc)"},
                  replaces ? 2 : 0);
  if (answer == 2) {
    session.panels.unsaved = false;
  } else if (answer >= 0) {
    quitWith(session, "edits", answer == 0 ? "save" : "discard");
  }
}

}  // namespace

void drawUnsavedQuestion(PanelContext& context) {
  Session& session = context.session;
  if (!beginDialog(context, "Quit", session.panels.unsaved)) return;
  const bool is_running = session.files().recorder.running();
  const bool asks_recording = is_running && session.quitAnswers().value("recording", "ask") == "ask";
  if (asks_recording || !session.isUnsaved()) {
    drawRecordingQuestion(context, is_running);
  } else {
    drawLossQuestion(context);
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
  const int answer = drawAnswers(file, {"Replace", "Back (Esc)"}, 1);
  endDialog();
  if (answer == 0) perform(context, R"({"do":"replace"})");
  if (answer == 1) session.panels.replace = false;
}

}  // namespace emscape::view
