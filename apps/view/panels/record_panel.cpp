/// The recording dialog, and the progress of a recording.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>

#include "apps/view/panels/panels.h"
#include "apps/view/widgets/dialog.h"
#include "apps/view/widgets/glyphs.h"
#include "apps/view/widgets/theme.h"
#include "apps/view/widgets/wrapped_text.h"
#include "base/text/shell_word.h"
#include "base/text/time_text.h"
#include "emscape/base/error.h"

namespace emscape::view {
namespace {

void drawProgress(PanelContext& context, const Area& picture) {
  const Session& session = context.session;
  const Recorder& recorder = session.files().recorder;
  if (!recorder.running()) return;
  const float s = context.scale;
  const Recorder::Progress progress = recorder.progress();
  const float width = std::min(420 * s, 0.9F * picture.width);
  ImGui::SetNextWindowPos({picture.x + picture.width / 2, picture.y + 84 * s}, ImGuiCond_Always, {0.5F, 0});
  ImGui::SetNextWindowSize({width, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, std::max(1.0F, s));
  ImGui::Begin("recording", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::TextUnformatted(drawable("recording " + progress.output).c_str());
  if (session.quitsWhenRecorded()) ImGui::TextDisabled("the program ends when it is complete");
  const float part =
      progress.total > 0 ? static_cast<float>(progress.pictures) / static_cast<float>(progress.total) : 0;
  std::string text =
      progress.total > 0 ? fmt::format("{} of {}", progress.pictures, progress.total) : "opening";
  if (progress.left_s > 0) text += ", " + timeText(std::ceil(progress.left_s)) + " left";
  ImGui::ProgressBar(part, {width - 110 * s, 0}, text.c_str());
  ImGui::SameLine();
  if (ImGui::Button("Cancel")) perform(context, R"({"do":"record_cancel"})");
  ImGui::End();
  ImGui::PopStyleVar(2);
}

struct SizePreset {
  const char* name;
  render::ImageSize size;  ///< 0x0: as on screen
};
constexpr SizePreset kSizes[]{
    {"as on screen", {0, 0}}, {"720p", {1280, 720}}, {"1080p", {1920, 1080}}, {"4K", {3840, 2160}}};

/// Contents of the dialog's fields.
struct Typed {
  std::string input;  ///< which the file was proposed for
  char file[1024] = "";
  double begin_s = 0, end_s = 0, step_s = 0, frames_per_s = 10;
  std::size_t preset = 0;
  bool wants_focus = false;  ///< the file, as it may have been refused

  void setFile(const std::string& name) { std::snprintf(file, sizeof file, "%s", name.c_str()); }
  bool isVideo() const { return std::filesystem::path(file).extension() == ".mp4"; }
  render::ImageSize size(const Session& session) const {
    const render::ImageSize size = preset == 0 ? session.pictureSize() : kSizes[preset].size;
    if (!isVideo()) return size;
    return {size.width + size.width % 2, size.height + size.height % 2};  // as the encoder needs them
  }
  Command command() const {
    Command record{"record",
                   {{"file", file},
                    {"begin_s", begin_s},
                    {"end_s", end_s},
                    {"step_s", step_s},
                    {"frames_per_s", frames_per_s}}};
    if (preset == 0) return record;
    record.arguments["width"] = kSizes[preset].size.width;
    record.arguments["height"] = kSizes[preset].size.height;
    return record;
  }
};

/// Default: the whole series as a video beside the input.
void fillIn(Typed& typed, const Session& session) {
  const std::vector<double>& times_s = session.timeline().times_s();
  if (times_s.empty()) return;
  typed.begin_s = times_s.front();
  typed.end_s = times_s.back();
  typed.step_s = times_s.size() > 1 ? times_s[1] - times_s[0] : 1;
  if (std::exchange(typed.input, session.view().input) != session.view().input || typed.file[0] == '\0') {
    typed.setFile(besideInput(session.options().namesake(), ".mp4"));
  }
}

void drawOutput(PanelContext& context, Typed& typed) {
  Session& session = context.session;
  if (!session.files().record_output.empty()) {
    typed.setFile(std::exchange(session.files().record_output, ""));
  }
  const bool is_back = typed.wants_focus && ImGui::IsWindowFocused() && !session.panels.replace;
  if (ImGui::IsWindowAppearing() || is_back) {
    typed.wants_focus = false;
    ImGui::SetKeyboardFocusHere();
  }
  ImGui::SetNextItemWidth(360 * context.scale);
  ImGui::InputText("##file", typed.file, sizeof typed.file, ImGuiInputTextFlags_AutoSelectAll);
  tabStop();
  ImGui::SameLine();
  if (ImGui::Button("Browse")) {
    session.browse(FileBrowser::Purpose::record, std::filesystem::path(typed.file).filename().string());
  }
  tabStop();
  ImGui::TextDisabled("NAME.mp4, or a folder for pictures");
}

void drawSize(const PanelContext& context, Typed& typed) {
  const auto nameOf = [&](std::size_t preset) {
    Typed of_preset = typed;
    of_preset.preset = preset;
    const render::ImageSize size = of_preset.size(context.session);
    return fmt::format("{}, {} x {}", kSizes[preset].name, size.width, size.height);
  };
  ImGui::SetNextItemWidth(260 * context.scale);
  const bool is_unfolded = ImGui::BeginCombo("size", nameOf(typed.preset).c_str());
  if (!is_unfolded) return tabStop();
  for (std::size_t preset = 0; preset < std::size(kSizes); ++preset) {
    if (ImGui::Selectable(nameOf(preset).c_str(), preset == typed.preset)) typed.preset = preset;
  }
  ImGui::EndCombo();
  if (typed.isVideo() && typed.size(context.session) != context.session.pictureSize() && typed.preset == 0) {
    ImGui::SameLine();
    ImGui::TextDisabled("(films have even sizes)");
  }
}

/// How the camera moves; with the bookmarks that it flies along.
void drawCameraPath(PanelContext& context) {
  Session& session = context.session;
  const auto& bookmarks = session.bookmarks();
  const auto count = std::count_if(bookmarks.begin(), bookmarks.end(),
                                   [](const auto& bookmark) { return bookmark.has_value(); });
  const bool flies = session.view().camera_path == playback::CameraPath::bookmarks;
  const std::string along = fmt::format("from bookmark to bookmark ({})", count);
  ImGui::SetNextItemWidth(260 * context.scale);
  if (ImGui::BeginCombo("camera", flies ? along.c_str() : "as on screen")) {
    if (ImGui::Selectable("as on screen", !flies)) perform(context, R"({"do":"camera_path","path":"fixed"})");
    if (ImGui::Selectable(along.c_str(), flies))
      perform(context, R"({"do":"camera_path","path":"bookmarks"})");
    ImGui::EndCombo();
  } else {
    tabStop();
  }
  if (flies && count < 2)
    ImGui::TextColored(errorColor(session.theme()), "two bookmarks are needed: Ctrl+1, Ctrl+2, ...");
}

/// Begin, end and step, typed as all times; pictures per second.
void drawTimes(const PanelContext& context, Typed& typed) {
  const auto number = [&](const char* name, double& value, const NumberForm& form) {
    ImGui::SetNextItemWidth(120 * context.scale);
    numberField(context, name, value, form);
    tabStop();
  };
  NumberForm instant{"", "s"}, step{"", "s"}, rate;
  instant.read = [&](const std::string& text) { return context.session.timeline().parseTime_s(text); };
  step.read = [](const std::string& text) {
    const std::optional<double> step_s = parseTime_s(text);
    if (step_s && *step_s > 0) return *step_s;
    throw Error(ErrorCode::bad_input,
                fmt::format("step '{}': expected seconds (0.5, 1.5 min) or M:SS, above 0", text));
  };
  rate.min = kMinFramesPerSecond;
  rate.max = kMaxFramesPerSecond;
  number("begin", typed.begin_s, instant);
  number("end", typed.end_s, instant);
  number("step", typed.step_s, step);
  number("pictures per second of a film", typed.frames_per_s, rate);
}

std::string bytesText(double bytes) {
  return bytes < 1e9 ? fmt::format("{:.2g} MB", std::max(0.1, bytes / 1e6))
                     : fmt::format("{:.2g} GB", bytes / 1e9);
}

/// Number, speed, time and size of what will be recorded.
void drawEstimate(const PanelContext& context, const Typed& typed) {
  const Session& session = context.session;
  const playback::LiveStatus& status = session.status();
  const render::ImageSize size = typed.size(session), shown = session.pictureSize();
  const double pixels =
      shown.count() > 0 ? static_cast<double>(size.count()) / static_cast<double>(shown.count()) : 1;
  const double full_cast_ms = status.rays_fraction > 0 ? status.cast_ms / status.rays_fraction : 0;
  const double usual_ms = session.fieldTimes().usual_ms();
  const RecordEstimate estimate =
      estimateOf({{}, {}, {}, typed.frames_per_s, {}}, typed.begin_s, typed.end_s, typed.step_s, size,
                 usual_ms > 0 ? usual_ms + pixels * full_cast_ms : 0, typed.isVideo());
  if (estimate.pictures == 0) {
    ImGui::TextColored(errorColor(session.theme()), "expected begin <= end and step > 0");
    return;
  }
  std::string text = fmt::format("{} picture{}", estimate.pictures, estimate.pictures == 1 ? "" : "s");
  if (typed.isVideo()) {
    text += fmt::format(", a film of {}; one second shows {} of the scenario", timeText(estimate.film_s),
                        timeText(estimate.speed));
  }
  ImGui::TextUnformatted(drawable(text).c_str());
  const std::string time =
      estimate.work_s > 0
          ? fmt::format("about {} to record", timeText(std::max(1.0, std::round(estimate.work_s))))
          : "time known after another step";
  ImGui::TextDisabled("about %s; %s", bytesText(estimate.bytes).c_str(), time.c_str());
}

/// The same on the command line.
std::string commandLine(const Session& session, const Typed& typed) {
  const render::ImageSize size = typed.size(session);
  return fmt::format("emscape render {} --state VIEW.json --times {}:{}:{} --size {}x{} --fps {:g} -o {}",
                     shellWord(session.view().input), typed.begin_s, typed.end_s, typed.step_s, size.width,
                     size.height, typed.frames_per_s, shellWord(typed.file));
}

}  // namespace

void drawRecording(PanelContext& context, const Area& picture) {
  drawProgress(context, picture);
  Session& session = context.session;
  if (!beginDialog(context, "Record", session.panels.record)) return;
  static Typed typed;
  if (ImGui::IsWindowAppearing()) fillIn(typed, session);
  drawOutput(context, typed);
  drawSize(context, typed);
  drawCameraPath(context);
  drawTimes(context, typed);
  drawEstimate(context, typed);
  ImGui::TextDisabled("%s", "the same on the command line, with the view saved as VIEW.json (Ctrl+Shift+V):");
  ImGui::TextDisabled("%s", wrapped(commandLine(session, typed), 520 * context.scale).c_str());
  ImGui::Spacing();
  if (defaultButton("Record")) {
    session.perform(typed.command());
    typed.wants_focus = true;
  }
  if (ImGui::Button("Back (Esc)")) session.panels.record = false;
  tabStop();
  endDialog();
}

}  // namespace emscape::view
