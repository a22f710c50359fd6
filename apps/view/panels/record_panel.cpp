/// The recording dialog, and the progress of a recording.
#include <fmt/format.h>

#include <cstring>

#include "apps/view/panels/glyphs.h"
#include "apps/view/panels/panels.h"
#include "apps/view/panels/theme.h"

namespace emscape::view {
namespace {

void drawProgress(PanelContext& context, const Area& picture) {
  const Recorder& recorder = context.session.files().recorder;
  if (!recorder.running()) return;
  const float s = context.scale;
  const Recorder::Progress progress = recorder.progress();
  const float width = std::min(420 * s, 0.9F * picture.width);
  ImGui::SetNextWindowPos({picture.x + picture.width / 2, picture.y + 12 * s}, ImGuiCond_Always, {0.5F, 0});
  ImGui::SetNextWindowSize({width, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::Begin("recording", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::TextUnformatted(drawable(("recording " + progress.output)).c_str());
  const float part =
      progress.total > 0 ? static_cast<float>(progress.pictures) / static_cast<float>(progress.total) : 0;
  const std::string text =
      progress.total > 0 ? fmt::format("{} of {}", progress.pictures, progress.total) : "opening";
  ImGui::ProgressBar(part, {width - 110 * s, 0}, text.c_str());
  ImGui::SameLine();
  if (ImGui::Button("Cancel")) perform(context, R"({"do":"record_cancel"})");
  ImGui::End();
  ImGui::PopStyleVar();
}

/// Text of the dialog's fields.
struct Typed {
  char file[1024] = "";
  double begin_s = 0, end_s = 0, step_s = 0, frames_per_s = 10;
};

/// Default: the whole series as a video in the input's folder.
void fillIn(Typed& typed, const Session& session) {
  const std::vector<double>& times_s = session.timeline().times_s();
  if (times_s.empty()) return;
  typed.begin_s = times_s.front();
  typed.end_s = times_s.back();
  typed.step_s = times_s.size() > 1 ? times_s[1] - times_s[0] : 1;
  if (typed.file[0] != '\0') return;
  std::string name = session.view().input;
  while (!name.empty() && name.back() == '/') name.pop_back();
  name = name.substr(name.rfind('/') + 1);
  name = name.substr(0, name.find('.')) + ".mp4";
  std::strncpy(typed.file, name.c_str(), sizeof typed.file - 1);
}

}  // namespace

void drawRecording(PanelContext& context, const Area& picture) {
  drawProgress(context, picture);
  Session& session = context.session;
  if (!session.panels.record) return;
  static Typed typed;
  const float s = context.scale;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Appearing, {0.5F, 0.5F});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::Begin(
      "Record", &session.panels.record,
      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  if (ImGui::IsWindowAppearing()) {
    fillIn(typed, session);
    ImGui::SetKeyboardFocusHere();
  }
  ImGui::SetNextItemWidth(360 * s);
  bool begins = ImGui::InputText("file", typed.file, sizeof typed.file, ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::TextDisabled("NAME.mp4, or a folder for pictures");
  const auto number = [s](const char* name, double& value) {
    ImGui::SetNextItemWidth(120 * s);
    ImGui::InputDouble(name, &value, 0, 0, "%.6g");
  };
  number("begin (s)", typed.begin_s);
  number("end (s)", typed.end_s);
  number("step (s)", typed.step_s);
  number("pictures a second of a video", typed.frames_per_s);
  const render::ImageSize size = session.pictureSize();
  ImGui::TextDisabled("%d x %d pixels, each of them cast", size.width, size.height);
  begins |= ImGui::Button("Record");
  if (begins) {
    session.perform({"record",
                     {{"file", typed.file},
                      {"begin_s", typed.begin_s},
                      {"end_s", typed.end_s},
                      {"step_s", typed.step_s},
                      {"frames_per_s", typed.frames_per_s}}});
    session.panels.record = !session.files().recorder.running();
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace emscape::view
