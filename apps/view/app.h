/// The window's loop: events, session, picture and panels.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/mouse_control.h"
#include "apps/view/picture_texture.h"
#include "apps/view/session/script.h"
#include "apps/view/session/session_opener.h"
#include "apps/view/window.h"

namespace emscape::view {

class App : private WindowControl {
 public:
  /// @throws Error (device) without a display or OpenGL, or without the GPU that the options ask for;
  /// (bad_input) for a faulty script; (other) if the log cannot be written
  /// @param messages  receives the warnings of the libraries
  App(ViewOptions options, std::shared_ptr<MessageLog> messages);

  /// Runs until the user, the script or a signal ends it.
  /// @throws Error if the input cannot be opened, (check_failed) by the script
  void run();

 private:
  void resize(int width, int height) override;
  double scale() const override;
  void setScale(double factor) override;
  void screenshot(const std::string& file) override;
  void setClipboard(const std::string& text) override;
  void quit() override;
  void press(const KeyChord& chord) override;
  void inject(const InputEvent& event) override;

  /// Handles input and lays out the panels; draws them if drawing is due.
  void frame();
  void draw(const Layout& layout);
  /// Seconds until the window must be drawn again; 0: now.
  double untilDrawing_s() const;
  void handleKeys(const std::vector<InputEvent>& events);
  /// Performs the action of a key.
  void act(const InputEvent& key);
  void drawPanels(const Layout& layout);
  void updateTexture();
  void showFromDevice(const render::DevicePicture& picture);
  void takeScreenshot();
  double waitTime_s() const;
  void failIfNothingOpens();
  /// Creates the session on the GPU or, if that fails and the backend is automatic, on the CPU.
  std::unique_ptr<Session> makeFirstSession(const ViewOptions& options);
  std::unique_ptr<Session> makeSession(const ViewOptions& options);
  void handleRequests();
  bool panelsChanged();
  void showTitle();
  void fitWindowToPicture();
  bool isFitting() const;

  EventLog log_;
  Script script_;
  Window window_;
  PictureTexture texture_;
  bool shares_gpu_;  // pictures are passed from CUDA to OpenGL on the GPU
  playback::ComputeTarget target_;
  std::shared_ptr<Files> files_;
  std::unique_ptr<Session> session_;
  SessionOpener opener_;
  MouseControl mouse_;

  bool has_opened_ = false;  // an input, or one was replaced: its errors do not end the program
  bool quits_ = false;
  bool flies_ = false;
  int frames_left_ = 3;  // after an event, since ImGui needs two frames for a layout
  long long frame_ = 0;
  double last_frame_s_ = 0;
  double drawn_at_s_ = 0;
  double upload_ms_ = 0;
  long long shown_picture_ = 0;  // number of the picture in texture_; 0: none
  std::optional<std::string> screenshot_;
  std::string open_panels_;
  std::optional<InputEvent> waiting_key_;  // until the field that was open has given its text
  bool was_popup_open_ = false;            // before this frame
  const void* drawn_scenario_ = nullptr;   // only compared
  std::string title_;
  int window_fits_;            // remaining attempts to give the picture the size of the first view
  render::ImageSize fitting_;  // the size requested last
};

}  // namespace emscape::view
