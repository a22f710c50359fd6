/// What is looked at and how: everything behind the window but drawing and input. No OpenGL, no ImGui.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/camera_control.h"
#include "apps/view/colors.h"
#include "apps/view/command.h"
#include "apps/view/event_log.h"
#include "apps/view/playhead.h"
#include "apps/view/view_options.h"
#include "apps/view/window_control.h"
#include "emscape/playback/edit_history.h"
#include "emscape/playback/live_view.h"

namespace emscape::view {

/// Which panels are open.
struct Panels {
  bool scenario = true, colors = false, timeline = true, help = false, time = false;
  bool hidden = false;  ///< all of them, for a moment
};

/// A line that tells the user what came of a command.
struct Notice {
  std::string text;
  bool is_error = false;
  double since_s = 0;
};

struct Bookmark {
  render::CameraSpec camera;
  double time_s = 0;
};

/// Runs commands on a LiveView and keeps what is asked for. The thread of the window uses it.
class Session {
 public:
  /// @param wake  called from any thread when there is something new to see
  Session(const ViewOptions& options, const playback::ComputeTarget& target, WindowControl& window,
          EventLog& log, std::function<void()> wake);

  /// Carries a command out. Faults become the notice. Waiting, keys, mouse and expect are the script's.
  void perform(const Command& command);
  /// The same with a new value at a path of the scenario while a control is dragged: one step to be undone.
  void dragValue(const std::string& path, const std::string& value);
  void endDrag();

  /// Lets time pass and takes what is new. @return whether the window is to be drawn
  bool update();
  /// Seconds until update() has something to do by itself; none: not before an event.
  std::optional<double> nextUpdate_s() const;
  /// The part of the window that the picture fills.
  void setPictureSize(render::ImageSize size);

  // --- what is shown ---
  const playback::LivePicture* picture() const { return picture_.get(); }
  const playback::LiveStatus& status() const { return status_; }
  bool exact() const;
  /// Exact, and nothing that was asked for is missing.
  bool settled() const;
  /// For mouse movements; none before the first picture.
  std::optional<Viewport> viewport() const;
  /// What the log says of a frame and what scripts compare.
  Json report() const;
  /// The command that draws this picture into a file.
  std::string renderCommand() const;

  CameraControl& camera() { return camera_; }
  void cameraMoved();
  const Playhead& playhead() const { return playhead_; }
  const render::RenderSettings& settings() const { return settings_; }
  void setSettings(const render::RenderSettings& settings);
  const ColorAdjustment& colors() const { return colors_; }
  void setColors(const ColorAdjustment& colors);
  /// Colours fitted anew, to the step on screen or to the whole series, without adjustments.
  void fitColors(bool to_series);
  /// The function that the adjustments start from; null before the first picture.
  const render::TransferFunction* fittedColors() const { return fitted_ ? &*fitted_ : nullptr; }
  render::Theme theme() const { return theme_; }
  const std::string& quantity() const { return quantity_; }
  std::optional<render::Pattern> pattern() const { return pattern_; }
  bool showsTerrain() const { return show_terrain_; }
  bool showsEmitters() const { return show_emitters_; }
  /// As edited; null for volumes alone, and before the input is open.
  playback::ScenarioPtr scenario() const { return edits_ ? edits_->scenario() : nullptr; }
  bool canUndo() const { return edits_ && edits_->canUndo(); }
  bool canRedo() const { return edits_ && edits_->canRedo(); }
  const std::vector<std::optional<Bookmark>>& bookmarks() const { return bookmarks_; }
  const Notice& notice() const { return notice_; }
  void tell(const std::string& text, bool is_error = false);
  Panels panels;
  EventLog& log() { return log_; }

 private:
  using Handler = void (Session::*)(const Command&);
  static Handler handlerOf(const std::string& verb);
  // One per verb; session_commands.cpp
  void play(const Command&);
  void pause(const Command&);
  void step(const Command&);
  void seek(const Command&);
  void first(const Command&);
  void last(const Command&);
  void rate(const Command&);
  void loop(const Command&);
  void orbit(const Command&);
  void pan(const Command&);
  void dolly(const Command&);
  void setCamera(const Command&);
  void resetView(const Command&);
  void focus(const Command&);
  void bookmark(const Command&);
  void recall(const Command&);
  void set(const Command&);
  void undo(const Command&);
  void redo(const Command&);
  void copyCommand(const Command&);
  void save(const Command&);
  void mode(const Command&);
  void iso(const Command&);
  void shading(const Command&);
  void exaggeration(const Command&);
  void stepVoxels(const Command&);
  void showQuantity(const Command&);
  void transfer(const Command&);
  void opacity(const Command&);
  void range(const Command&);
  void fitStep(const Command&);
  void fitSeries(const Command&);
  void showPattern(const Command&);
  void terrain(const Command&);
  void emitters(const Command&);
  void changeTheme(const Command&);
  void panel(const Command&);
  void scale(const Command&);
  void resize(const Command&);
  void screenshot(const Command&);
  void back(const Command&);
  void quit(const Command&);

  void askTime();
  void takeScenario();
  void takePicture();
  void showScenario();
  void changeScenario(const std::vector<scenario::Edit>& edits);

  const ViewOptions options_;
  WindowControl& window_;
  EventLog& log_;
  playback::LiveView live_;

  std::shared_ptr<const playback::LivePicture> picture_;
  playback::LiveStatus status_;
  std::string told_error_;
  CameraControl camera_;
  Playhead playhead_;
  std::optional<double> asked_s_;
  double advanced_at_s_ = 0;
  render::ImageSize picture_size_;
  render::RenderSettings settings_;
  render::CompositingMode fog_mode_ = render::CompositingMode::dvr;  // that I goes back to
  std::optional<render::TransferFunction> fitted_;
  bool fitting_ = true;  // the next pictures say what fitted_ is
  ColorAdjustment colors_;
  render::Theme theme_;
  std::string quantity_;
  std::optional<render::Pattern> pattern_;
  bool show_terrain_, show_emitters_;
  std::size_t focused_ = 0;
  std::vector<std::optional<Bookmark>> bookmarks_{9};

  std::optional<playback::EditHistory> edits_;
  bool dragging_ = false;
  bool touched_ = false;  // by a command since the last update()
  Notice notice_;
};

}  // namespace emscape::view
