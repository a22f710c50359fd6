#include "apps/view/app.h"

#include <epoxy/gl.h>
// epoxy first
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include "apps/common/interrupt.h"
#include "base/stopwatch.h"
#include "emscape/base/backend.h"
#include "emscape/base/error.h"
#include "emscape/base/log.h"

namespace emscape::view {
namespace {

constexpr int kFramesAfterEvent = 3;
/// While fields and pictures are computed, the window is drawn at new pictures and at this interval: a
/// software renderer competes for the processor.
constexpr double kBusyInterval_s = 1.0 / 25;
constexpr double kIdleWait_s = 1;  // signals set no event
constexpr double kCursorBlink_s = 0.4;
constexpr double kOpeningPoll_s = 0.03;

constexpr int kWindowFits = 8;
/// Time (s) from the start after which a window that has not taken the requested size keeps its own.
constexpr double kFitLimit_s = 5;
constexpr render::ImageSize kUsualSize{1200, 900};

/// With an asterisk for edits or colours that are not saved. @param stream  its state; empty: none
std::string titleOf(const std::string& document, bool is_unsaved, const std::string& stream) {
  const std::filesystem::path path = std::filesystem::path(document).lexically_normal();
  if (path.empty()) return "emscape";
  const std::filesystem::path named = path.has_filename() ? path : path.parent_path();
  return (is_unsaved ? "* " : "") + named.filename().string() + (stream.empty() ? "" : " (" + stream + ")") +
         " — emscape";
}

bool isFunctionKey(const KeyChord& chord) {
  return chord.key.size() > 1 && chord.key[0] == 'F' && chord.key[1] >= '0' && chord.key[1] <= '9';
}

/// True if a text field may take the chord: all without Ctrl but function keys, and those of editing.
bool editsText(const KeyChord& chord) {
  static const std::set<std::string> kEditing{"A",    "C",     "V",    "X",   "Y",         "Z",
                                              "Left", "Right", "Home", "End", "Backspace", "Delete"};
  return chord.control ? kEditing.count(chord.key) != 0 : !isFunctionKey(chord);
}

/// The largest rectangle of a picture's proportions in the middle of an area: until the picture of a new size
/// is there, the previous one is not distorted.
Area fittedInto(const Area& area, render::ImageSize size) {
  const int width = static_cast<int>(area.width), height = static_cast<int>(area.height);
  if (size.count() == 0 || (size.width == width && size.height == height)) return area;
  const float scale =
      std::min(area.width / static_cast<float>(size.width), area.height / static_cast<float>(size.height));
  const float shown_width = std::floor(scale * static_cast<float>(size.width));
  const float shown_height = std::floor(scale * static_cast<float>(size.height));
  return {std::floor(area.x + (area.width - shown_width) / 2),
          std::floor(area.y + (area.height - shown_height) / 2), shown_width, shown_height};
}

}  // namespace

App::App(ViewOptions options, std::shared_ptr<MessageLog> messages)
    : log_(options.log.empty() ? EventLog() : EventLog(options.log)),
      script_(options.script.empty() ? Script() : Script(options.script)),
      window_(titleOf(options.namesake(), false, ""), options.window_size.value_or(kUsualSize),
              options.scales_window, options.scale),
      shares_gpu_(options.share_gpu && render::openGlSharesGpu()),
      files_(std::make_shared<Files>()),
      session_((files_->messages = std::move(messages), makeFirstSession(options))),
      opener_(files_, [this](const ViewOptions& next) { return makeSession(next); }),
      window_fits_(options.window_size ? 0 : kWindowFits) {
  log_.write("start", {{"gl_renderer", window_.renderer()},
                       {"shares_gpu", shares_gpu_},
                       {"scale", window_.scale()},
                       {"input", options.view.input}});
}

std::unique_ptr<Session> App::makeFirstSession(const ViewOptions& options) {
  return withBackendFallback(
      parseBackend(options.backend),
      [&](const ResolvedBackend& choice) {
        target_ = {choice, volume::VoxelPrecision::float32};
        return makeSession(options);
      },
      logInfo);
}

std::unique_ptr<Session> App::makeSession(const ViewOptions& options) {
  WindowControl& window = *this;
  auto session = std::make_unique<Session>(
      options, target_, window, log_, [] { Window::wake(); }, files_);
  session->keepOnDevice(shares_gpu_);
  return session;
}

// --- requests of commands ---

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
  screenshot_ = file;
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

double App::untilDrawing_s() const {
  const playback::LiveStatus& status = session_->status();
  const bool is_idle = status.state == render::ControllerState::idle && !status.computing;
  const bool has_new_picture = session_->picture() && session_->picture()->status.frame != shown_picture_;
  if (is_idle || has_new_picture || screenshot_) return 0;
  return std::max(0.0, drawn_at_s_ + kBusyInterval_s - log_.now_s());
}

double App::waitTime_s() const {
  if (frames_left_ > 0) return untilDrawing_s();
  if (flies_) return 0;
  double wait_s = kIdleWait_s;
  if (const auto next_s = session_->nextUpdate_s()) wait_s = std::min(wait_s, *next_s);
  if (opener_.active()) wait_s = std::min(wait_s, kOpeningPoll_s);
  if (const auto next_s = script_.nextRun_s(log_.now_s())) wait_s = std::min(wait_s, *next_s);
  if (ImGui::GetIO().WantTextInput) wait_s = std::min(wait_s, kCursorBlink_s);
  return std::max(wait_s, 1e-3);
}

void App::failIfNothingOpens() {
  has_opened_ = has_opened_ || session_->isOpened();
  const bool is_live = session_->options().stream != nullptr;  // nothing of a stream ends the program
  if (has_opened_ || is_live || session_->status().error.empty()) return;
  throw Error(session_->status().error_code, session_->status().error);
}

void App::showTitle() {
  const std::string title = titleOf(session_->document(), session_->isUnsaved(), session_->streamTitle());
  if (std::exchange(title_, title) != title) window_.setTitle(title);
}

/// Gives the window the size at which the picture has the size of the first view. The panels' size depends on
/// the window's, so the size is found by search; the panels change until the input is open.
void App::fitWindowToPicture() {
  constexpr int kIterations = 60;  // each at least halves the difference
  const render::ImageSize wanted = session_->options().view.size;
  const render::ImageSize size = window_.framebufferSize();
  auto width = static_cast<float>(size.width), height = static_cast<float>(size.height);
  for (int n = 0; n < kIterations; ++n) {
    const Layout layout = layoutOf(*session_, width, height, static_cast<float>(window_.scale()));
    width += static_cast<float>(wanted.width) - layout.picture.width;
    height += static_cast<float>(wanted.height) - layout.picture.height;
  }
  constexpr float kRounding = 0.01F;  // of the search
  const render::ImageSize fitting{static_cast<int>(std::ceil(width - kRounding)),
                                  static_cast<int>(std::ceil(height - kRounding))};
  if (fitting != size && fitting != fitting_) {  // skipped if the window has not yet taken this size
    --window_fits_;
    fitting_ = fitting;
    window_.resize(fitting.width, fitting.height);
  }
  if (session_->picture() && (fitting == size || log_.now_s() > kFitLimit_s)) window_fits_ = 0;
}

/// True until the window fits the first picture, or cannot; scripts wait for that.
bool App::isFitting() const {
  return window_fits_ > 0 && session_->picture();
}

void App::handleRequests() {
  if (const std::vector<std::string> files = window_.takeDropped(); !files.empty()) {
    session_->perform({"open", {{"file", files.front()}}});
    if (files.size() > 1) {
      session_->tell(fmt::format("the first of {} files is opened; the window shows one input", files.size()),
                     true);
    }
  }
  if (window_.takeCloseRequest()) session_->perform({"quit"});
  files_->is_typing = ImGui::GetIO().WantTextInput;
  if (!opener_.update(session_)) return;
  has_opened_ = true;
  files_->browser.forgetFolder();
  shown_picture_ = 0;
  window_fits_ = 0;
  frames_left_ = kFramesAfterEvent;
}

bool App::panelsChanged() {
  std::string open;
  for (const PanelName& panel : panelNames()) open += session_->panels.*panel.open ? '1' : '0';
  open += session_->scenario() ? 's' : '-';  // the rows of What if appear
  return std::exchange(open_panels_, open) != open;
}

void App::run() {
  session_->shown({});
  // Files that are being written are finished, and their errors reported, before the window closes.
  const auto ends = [this] { return quits_ || app::stopFlag(); };
  while (!ends() || session_->writing()) {
    window_.waitEvents(waitTime_s());
    if (window_.takeDirty()) frames_left_ = kFramesAfterEvent;
    handleRequests();
    if (session_->update()) frames_left_ = std::max(frames_left_, 1);
    // New rows take their widths in a second frame.
    const void* const scenario = session_->scenario().get();
    if (std::exchange(drawn_scenario_, scenario) != scenario) frames_left_ = kFramesAfterEvent;
    showTitle();
    failIfNothingOpens();
    if (ImGui::GetIO().WantTextInput) frames_left_ = std::max(frames_left_, 1);
    if (!ends() && !script_.finished() && !isFitting()) script_.run(*session_, *this, log_.now_s());
    if (panelsChanged()) frames_left_ = kFramesAfterEvent;  // the layout takes more than one frame
    const bool script_waits_for_frames = script_.nextRun_s(log_.now_s()) == 0.0;
    if (!window_.input().empty() || screenshot_ || script_waits_for_frames || flies_) {
      frames_left_ = std::max(frames_left_, 1);
    }
    if (frames_left_ > 0 && (untilDrawing_s() == 0 || !window_.input().empty())) frame();
  }
  session_->leave(!quits_);
  log_.write("end", session_->report());
  if (session_->options().stream) session_->options().stream->finishRecording();
}

void App::frame() {
  const render::ImageSize size = window_.framebufferSize();
  if (size.width < 1 || size.height < 1) return;
  Stopwatch watch;
  window_.setTheme(session_->theme());
  ImGuiIO& io = ImGui::GetIO();
  const bool moves_focus = isDialogOpen(session_->panels) || scenarioPanelTakesTab(*session_);
  io.KeyMap[ImGuiKey_Tab] = moves_focus ? -1 : GLFW_KEY_TAB;
  // The keys walk through menus and lists while one is open, else they are for the picture or the panel.
  was_popup_open_ = isPopupOpen();  // Esc closes it when the frame begins
  io.ConfigFlags = was_popup_open_ ? io.ConfigFlags | ImGuiConfigFlags_NavEnableKeyboard
                                   : io.ConfigFlags & ~ImGuiConfigFlags_NavEnableKeyboard;
  const std::vector<InputEvent> events = window_.beginFrame();
  const auto scale = static_cast<float>(window_.scale());
  const Layout layout =
      layoutOf(*session_, static_cast<float>(size.width), static_cast<float>(size.height), scale);
  handleKeys(events);
  mouse_.handle(events, layout.picture, io.WantCaptureMouse, *session_);
  const double now_s = log_.now_s();
  flies_ = mouse_.fly(window_, std::min(0.1, now_s - last_frame_s_), *session_);
  last_frame_s_ = now_s;
  if (window_fits_ > 0) fitWindowToPicture();
  session_->setPictureSize({static_cast<int>(layout.picture.width), static_cast<int>(layout.picture.height)});
  drawPanels(layout);
  if (untilDrawing_s() > 0) {
    window_.dropFrame();
    return;
  }
  --frames_left_;
  updateTexture();
  draw(layout);
  if (screenshot_) takeScreenshot();
  const double ui_ms = watch.lap_ms();
  window_.swap();
  drawn_at_s_ = log_.now_s();
  ++frame_;
  if (!log_.open()) return;
  Json line{{"ui_frame", frame_},
            {"ui_ms", std::round(ui_ms * 100) / 100},
            {"upload_ms", std::round(upload_ms_ * 100) / 100},
            {"swap_ms", std::round(watch.lap_ms() * 100) / 100}};
  line.update(session_->report());
  log_.write("frame", line);
}

void App::draw(const Layout& layout) {
  const render::ImageSize size = window_.framebufferSize();
  const ImVec4 panel = ImGui::GetStyleColorVec4(ImGuiCol_WindowBg);
  const ImVec4 bar = ImGui::GetStyleColorVec4(ImGuiCol_MenuBarBg);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, size.width, size.height);
  // Cleared instead of drawn by Dear ImGui, which is much slower with a software renderer.
  glEnable(GL_SCISSOR_TEST);
  const auto fill = [&](const Area& area, const ImVec4& color) {
    const int left = static_cast<int>(area.x), top = static_cast<int>(area.y);
    const int right = static_cast<int>(area.x + area.width), bottom = static_cast<int>(area.y + area.height);
    glScissor(left, size.height - bottom, std::max(0, right - left), std::max(0, bottom - top));
    glClearColor(color.x, color.y, color.z, 1);
    glClear(GL_COLOR_BUFFER_BIT);
  };
  const Area shown = fittedInto(layout.picture, texture_.size());
  const bool fills = shown.width == layout.picture.width && shown.height == layout.picture.height;
  if (!texture_.isSet() || !fills) fill(layout.picture, panel);
  if (!layout.side_is_over) fill(layout.side, panel);
  fill(layout.timeline, panel);
  fill(layout.status, bar);
  glDisable(GL_SCISSOR_TEST);
  if (texture_.isSet()) {
    const int height = static_cast<int>(shown.height);
    texture_.draw(static_cast<int>(shown.x), size.height - static_cast<int>(shown.y) - height,
                  static_cast<int>(shown.width), height);
  }
  window_.endFrame();
}

void App::handleKeys(const std::vector<InputEvent>& events) {
  if (const auto key = std::exchange(waiting_key_, std::nullopt)) act(*key);
  const Panels& panels = session_->panels;
  const bool asks = isOpen(panels, PanelKind::question), dialog = isDialogOpen(panels);
  const bool typing = ImGui::GetIO().WantTextInput;
  for (const InputEvent& event : events) {
    if (event.kind != InputEvent::Kind::key || event.action == GLFW_RELEASE) continue;
    const KeyChord chord = chordOf(event);
    if (chord.key.empty()) continue;
    if (chord.key == "Esc" && ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) {
      ImGui::ClosePopupToLevel(0, /*restore_focus_to_window_under_popup=*/true);  // menus and lists
      continue;
    }
    if (typing && !asks && !editsText(chord)) {  // as a click elsewhere the field gives its text first
      ImGui::ClearActiveID();
      waiting_key_ = event;
      continue;
    }
    const bool in_panel = was_popup_open_ || scenarioPanelTakes(chord);
    const bool is_for_panel = asks || typing || (dialog && editsText(chord)) ||
                              (in_panel && !chord.control && !isFunctionKey(chord));
    const bool is_global = chord.key == "F1" || chord.key == "F10" || chord.key == "F12" ||
                           (panels.warnings && toString(chord) == "Ctrl+Shift+W") ||
                           (chord.key == "Esc" && (chord.shift || dialog || (!typing && !in_panel)));
    if (is_for_panel && !is_global) continue;
    const bool flying = window_.buttonDown(GLFW_MOUSE_BUTTON_RIGHT) && !chord.control;
    if (flying && chord.key.size() == 1 && std::string("WASDQE").find(chord.key) != std::string::npos)
      continue;
    act(event);
  }
}

void App::act(const InputEvent& key) {
  const KeyChord chord = chordOf(key);
  log_.write("key", {{"key", toString(chord)}});
  if (chord.key.size() == 1 && chord.key[0] >= '1' && chord.key[0] <= '9') {
    session_->perform({chord.control ? "bookmark" : "recall", {{"number", chord.key[0] - '0'}}});
  } else if (const Action* action = actionOf(chord);
             action && (key.action != GLFW_REPEAT || repeats(*action))) {
    session_->perform(parseCommand(std::string(action->command)));
  }
}

void App::drawPanels(const Layout& layout) {
  PanelContext context{*session_, *this, static_cast<float>(window_.scale())};
  if (!session_->panels.hidden) {
    drawMenuBar(context);
    drawSidePanel(context, layout);
    drawTimeline(context, layout.timeline);
    drawStatusBar(context, layout.status);
  }
  if (!session_->panels.hidden) drawLegendMenu(context, layout.picture);
  drawStart(context, layout.picture);
  drawProbeMarker(context, layout.picture);
  drawPictureOverlay(context, layout.picture);
  drawToolHint(context, layout.picture);
  drawContextMenu(context, layout.picture, mouse_.menu());
  if (!screenshot_) drawNotice(context, layout.picture);
  drawHelp(context);
  drawGoToTime(context);
  drawGoToPosition(context);
  drawMapDialog(context);
  drawFileBrowser(context);
  drawRecording(context, layout.picture);
  drawChangedFiles(context, layout.picture);
  drawRestoreQuestion(context);
  drawWarnings(context);
  drawUnsavedQuestion(context);
  drawReplaceQuestion(context);
}

void App::updateTexture() {
  upload_ms_ = 0;
  const playback::LivePicture* picture = session_->picture();
  if (!picture || picture->status.frame == shown_picture_) return;
  Stopwatch watch;
  if (picture->on_device) {
    showFromDevice(*picture->on_device);
  } else {
    texture_.set(picture->finished);
  }
  upload_ms_ = watch.lap_ms();
  shown_picture_ = picture->status.frame;
}

/// If the driver cannot do it, as in a remote session, pictures are transferred through host memory.
void App::showFromDevice(const render::DevicePicture& picture) {
  try {
    texture_.set(picture);
  } catch (const Error& error) {
    log_.write("no_shared_gpu", {{"reason", error.what()}});
    shares_gpu_ = false;
    session_->keepOnDevice(false);
  }
}

void App::takeScreenshot() {
  const std::string file = *screenshot_;
  screenshot_.reset();
  try {
    render::writePng(file, window_.readPixels());
    session_->tellWritten(file);
  } catch (const Error& error) {
    session_->tell(error.what(), true);
  }
}

}  // namespace emscape::view
