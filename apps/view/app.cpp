#include "apps/view/app.h"

#include <epoxy/gl.h>
// epoxy first
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/view/theme.h"
#include "base/stopwatch.h"
#include "emscape/base/error.h"
#include "emscape/render/overlay.h"

namespace emscape::view {
namespace {

constexpr int kFramesAfterEvent = 3;
constexpr double kIdleWait_s = 1;  // signals set no event
constexpr double kCursorBlink_s = 0.4;

std::string newScreenshotName() {
  for (int number = 1;; ++number) {
    const std::string name = fmt::format("emscape-{:04d}.png", number);
    std::error_code ignored;
    if (!std::filesystem::exists(name, ignored)) return name;
  }
}

}  // namespace

App::App(const ViewOptions& options, const playback::ComputeTarget& target)
    : log_(options.log.empty() ? EventLog() : EventLog(options.log)),
      script_(options.script.empty() ? Script() : Script(options.script)),
      window_(std::filesystem::path(options.input).filename().string() + " — emscape", options.window_size,
              options.scale),
      session_(options, target, *this, log_, [] { Window::wake(); }) {
  log_.write("start",
             {{"gl_renderer", window_.renderer()}, {"scale", window_.scale()}, {"input", options.input}});
}

// --- what commands ask for ---

void App::resize(int width, int height) {
  window_.resize(width, height);
}

double App::scale() const {
  return window_.scale();
}

void App::setScale(double factor) {
  window_.setScale(factor);
}

void App::screenshot(const std::string& file) {
  screenshot_ = file.empty() ? newScreenshotName() : file;
  frames_left_ = std::max(frames_left_, 2);
}

void App::setClipboard(const std::string& text) {
  window_.setClipboard(text);
}

void App::quit() {
  quits_ = true;
}

void App::press(const KeyChord& chord) {
  for (const InputEvent& event : eventsOf(chord)) inject(event);
}

void App::inject(const InputEvent& event) {
  window_.input().push(event);
}

// --- the loop ---

double App::waitTime_s() const {
  if (frames_left_ > 0 || flies_) return 0;
  double wait_s = kIdleWait_s;
  if (const auto next_s = session_.nextUpdate_s()) wait_s = std::min(wait_s, *next_s);
  if (const auto next_s = script_.nextRun_s()) wait_s = std::min(wait_s, *next_s);
  if (ImGui::GetIO().WantTextInput) wait_s = std::min(wait_s, kCursorBlink_s);
  return std::max(wait_s, 1e-3);
}

void App::failIfNothingOpens() const {
  if (session_.picture() || session_.status().error.empty()) return;
  throw Error(ErrorCode::bad_input, session_.status().error);
}

void App::run() {
  while (!quits_ && !window_.closeRequested()) {
    window_.waitEvents(waitTime_s());
    if (window_.takeDirty()) frames_left_ = kFramesAfterEvent;
    if (session_.update()) frames_left_ = std::max(frames_left_, 1);
    failIfNothingOpens();
    if (ImGui::GetIO().WantTextInput) frames_left_ = std::max(frames_left_, 1);
    if (!script_.finished()) script_.run(session_, *this, log_.now_s());
    const bool script_waits_for_frames = script_.nextRun_s() == 0.0;
    if (!window_.input().empty() || screenshot_ || script_waits_for_frames || flies_) {
      frames_left_ = std::max(frames_left_, 1);
    }
    if (frames_left_ <= 0) continue;
    --frames_left_;
    frame();
  }
  log_.write("end", session_.report());
}

void App::frame() {
  const render::ImageSize size = window_.framebufferSize();
  if (size.width < 1 || size.height < 1) return;
  Stopwatch watch;
  window_.setTheme(session_.theme());
  const std::vector<InputEvent> events = window_.beginFrame();
  const ImGuiIO& io = ImGui::GetIO();
  const auto scale = static_cast<float>(window_.scale());
  const Layout layout =
      layoutOf(session_, static_cast<float>(size.width), static_cast<float>(size.height), scale);
  handleKeys(events);
  mouse_.handle(events, layout.picture, io.WantCaptureMouse, session_);
  const double now_s = log_.now_s();
  flies_ = mouse_.fly(window_, std::min(0.1, now_s - last_frame_s_), session_);
  last_frame_s_ = now_s;
  session_.setPictureSize({static_cast<int>(layout.picture.width), static_cast<int>(layout.picture.height)});
  drawPanels(layout);
  updateLayers();

  const bool dark = session_.theme() == render::Theme::dark;
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glDisable(GL_SCISSOR_TEST);
  glViewport(0, 0, size.width, size.height);
  glClearColor(dark ? 0.063F : 0.95F, dark ? 0.078F : 0.96F, dark ? 0.106F : 0.97F, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  if (shown_picture_ > 0) {
    layers_.draw(static_cast<int>(layout.picture.x),
                 size.height - static_cast<int>(layout.picture.y) - static_cast<int>(layout.picture.height),
                 static_cast<int>(layout.picture.width), static_cast<int>(layout.picture.height));
  }
  window_.endFrame();
  if (screenshot_) takeScreenshot();
  const double ui_ms = watch.lap_ms();
  window_.swap();
  ++frame_;
  if (!log_.open()) return;
  Json line{{"ui_frame", frame_},
            {"ui_ms", std::round(ui_ms * 100) / 100},
            {"overlay_ms", std::round(overlay_ms_ * 100) / 100},
            {"upload_ms", std::round(upload_ms_ * 100) / 100},
            {"swap_ms", std::round(watch.lap_ms() * 100) / 100}};
  line.update(session_.report());
  log_.write("frame", line);
}

void App::handleKeys(const std::vector<InputEvent>& events) {
  const bool typing = ImGui::GetIO().WantTextInput;
  for (const InputEvent& event : events) {
    if (event.kind != InputEvent::Kind::key || event.action == GLFW_RELEASE) continue;
    const KeyChord chord = chordOf(event);
    if (chord.key.empty() || (typing && chord.key != "Esc" && chord.key != "F1" && chord.key != "F12"))
      continue;
    const bool flying = window_.buttonDown(GLFW_MOUSE_BUTTON_RIGHT) && !chord.control;
    if (flying && chord.key.size() == 1 && std::string("WASDQE").find(chord.key) != std::string::npos)
      continue;
    log_.write("key", {{"key", toString(chord)}});
    if (chord.key.size() == 1 && chord.key[0] >= '1' && chord.key[0] <= '9') {
      session_.perform({chord.control ? "bookmark" : "recall", {{"number", chord.key[0] - '0'}}});
    } else if (const Action* action = actionOf(chord)) {
      session_.perform(parseCommand(std::string(action->command)));
    }
  }
}

void App::drawPanels(const Layout& layout) {
  PanelContext context{session_, *this, static_cast<float>(window_.scale())};
  if (!session_.panels.hidden) {
    drawMenuBar(context);
    drawSidePanel(context, layout.side);
    drawTimeline(context, layout.timeline);
    drawStatusBar(context, layout.status);
  }
  drawNotice(context, layout.picture);
  drawHelp(context);
  drawGoToTime(context);
}

void App::updateLayers() {
  const playback::LivePicture* picture = session_.picture();
  if (!picture) return;
  if (picture->status.frame == shown_picture_ && shown_theme_ == session_.theme()) return;
  Stopwatch watch;
  render::Annotations annotations = picture->annotations;
  annotations.theme = session_.theme();
  const render::OverlayLayers overlay =
      render::overlayLayers(picture->image.size, picture->camera, picture->box, annotations, picture->hidden);
  overlay_ms_ = watch.lap_ms();
  layers_.set(0, overlay.behind);
  layers_.set(1, picture->image);
  layers_.set(2, overlay.in_front);
  upload_ms_ = watch.lap_ms();
  shown_picture_ = picture->status.frame;
  shown_theme_ = session_.theme();
}

void App::takeScreenshot() {
  const std::string file = *screenshot_;
  screenshot_.reset();
  try {
    render::writePng(file, window_.readPixels());
    session_.tell("written: " + file);
  } catch (const Error& error) {
    session_.tell(error.what(), true);
  }
}

}  // namespace emscape::view
