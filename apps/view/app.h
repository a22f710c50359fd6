/// The window's loop: events, session, picture and panels.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/mouse_control.h"
#include "apps/view/picture_layers.h"
#include "apps/view/script.h"
#include "apps/view/session.h"
#include "apps/view/window.h"

namespace emscape::view {

class App : private WindowControl {
 public:
  /// @throws Error (device) without a display or OpenGL; (bad_input) for the script; (other) for the log
  App(const ViewOptions& options, const playback::ComputeTarget& target);

  /// Until the user, the script or a signal ends it.
  /// @throws Error (bad_input) if the input cannot be opened, (check_failed) by the script
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

  void frame();
  void handleKeys(const std::vector<InputEvent>& events);
  void drawPanels(const Layout& layout);
  void updateLayers();
  void takeScreenshot();
  double waitTime_s() const;
  void failIfNothingOpens() const;

  EventLog log_;
  Script script_;
  Window window_;
  PictureLayers layers_;
  Session session_;
  MouseControl mouse_;

  bool quits_ = false;
  bool flies_ = false;
  int frames_left_ = 3;  // after an event, so that what ImGui lays out in two frames is right
  long long frame_ = 0;
  double last_frame_s_ = 0;
  double overlay_ms_ = 0, upload_ms_ = 0;
  long long shown_picture_ = 0;  // number of the picture in layers_; 0: none
  render::Theme shown_theme_ = render::Theme::dark;
  std::optional<std::string> screenshot_;
};

}  // namespace emscape::view
