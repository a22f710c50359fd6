/// What is looked at and how: everything behind the window but drawing and input. No OpenGL, no ImGui.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/background_jobs.h"
#include "apps/view/camera_control.h"
#include "apps/view/command.h"
#include "apps/view/event_log.h"
#include "apps/view/file_watch.h"
#include "apps/view/files.h"
#include "apps/view/open_panels.h"
#include "apps/view/prober.h"
#include "apps/view/undo_order.h"
#include "apps/view/value_summary.h"
#include "apps/view/view_options.h"
#include "apps/view/window_control.h"
#include "emscape/playback/autosave.h"
#include "emscape/playback/edit_history.h"
#include "emscape/playback/live_view.h"
#include "emscape/playback/timeline.h"
#include "emscape/playback/transfer_editor.h"
#include "playback/edit_queue.h"

namespace emscape::view {

/// A line that tells the user what came of a command.
struct Notice {
  std::string text;
  bool is_error = false;
  double since_s = 0;
};

/// Edits that were refused, for whoever asked for them.
struct Rejection {
  std::vector<scenario::Edit> edits;
  std::string message;
};

/// emscape-NNNN.png that does not exist.
std::string newPictureName();

/// Runs commands on a LiveView and keeps what is asked for. The thread of the window uses it.
class Session {
 public:
  /// @param wake   called from any thread when there is something new to see
  /// @param files  shared by the sessions of a window; null: of its own
  Session(const ViewOptions& options, const playback::ComputeTarget& target, WindowControl& window,
          EventLog& log, std::function<void()> wake, std::shared_ptr<Files> files = nullptr);
  /// Waits until the files are written.
  ~Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// What perform() can do: one table per topic, session_TOPIC.cpp.
  static std::vector<Verb> verbs();
  /// Carries a command out. Faults become the notice. Waiting, keys, mouse and expect are the script's.
  void perform(const Command& command);
  /// The same with new values in the scenario while a control or a platform is dragged: one step to be
  /// undone.
  void drag(const std::vector<scenario::Edit>& edits);
  void dragValue(const std::string& path, const std::string& value) { drag({{path, value}}); }
  /// Changes colours and opacities while a control is dragged: one step to be undone.
  void dragTransfer(const std::function<void(playback::TransferEditor&)>& change);
  /// The same as a step of its own.
  void changeTransfer(const std::function<void(playback::TransferEditor&)>& change);
  /// Of either kind.
  void endDrag();
  /// Back to the values before the drag.
  void cancelDrag();
  bool isDragging() const { return edit_queue_.isDragging(); }

  /// Lets time pass and takes what is new. @return whether the window is to be drawn
  bool update();
  /// Seconds until update() has something to do by itself; none: not before an event.
  std::optional<double> nextUpdate_s() const;
  /// The part of the window that the picture fills.
  void setPictureSize(render::ImageSize size);
  render::ImageSize pictureSize() const { return picture_size_; }
  /// Whether busy pictures that a GPU casts are left there; see LivePicture::on_device.
  void keepOnDevice(bool keep) { live_.keepOnDevice(keep); }

  // --- what is shown ---
  const playback::LivePicture* picture() const { return picture_.get(); }
  const playback::LiveStatus& status() const { return status_; }
  bool exact() const;
  /// Whether edits or readings that were asked for are still to come: scripts wait for them.
  bool isAnswering() const { return edit_queue_.isBusy() || prober_.isBusy(); }
  /// Exact, and nothing that was asked for is missing.
  bool settled() const;
  /// Files are being read or written for it, or wait until it is settled; or another one is being opened.
  bool working() const;
  /// Files are being read or written.
  bool writing() const { return jobs_.busy(); }
  /// For mouse movements; none before the first picture.
  std::optional<Viewport> viewport() const;
  /// What the log says of a frame and what scripts compare.
  Json report() const;

  // --- files: session_state.cpp, session_files.cpp ---
  const ViewOptions& options() const { return options_; }
  /// Something is open, or being opened first; else the window asks for it.
  bool hasInput() const { return !options_.input.empty(); }
  Files& files() { return *files_; }
  const Files& files() const { return *files_; }
  /// All that is asked for: the view that a file keeps.
  playback::ViewState viewState() const;
  bool hasUnsavedEdits() const;
  /// What an earlier run left when it ended before its time.
  const std::optional<playback::AutosavedView>& keptView() const { return kept_view_; }
  /// Files of the input that have changed on the disk since they were read.
  const std::vector<std::string>& changedFiles() const { return changed_files_; }
  /// The session gives way to another one. @param keeps_edits  unsaved edits are offered when the input is
  /// opened again
  void leave(bool keeps_edits);
  /// The session has come on screen. @param left_out  edits that did not apply; may be empty
  void shown(const std::string& left_out);
  void record(const RecordRange& range, const std::string& output);

  CameraControl& camera() { return camera_; }
  void cameraMoved();
  const playback::Timeline& timeline() const { return timeline_; }
  const render::RenderSettings& settings() const { return settings_; }
  void setSettings(const render::RenderSettings& settings);
  /// A plane through the middle of the box; a vertical one faces the viewer.
  render::CutPlane newPlane(render::CutPlane::Kind kind) const;
  /// @throws Error (bad_input) for too many, or values out of their range
  void setPlanes(const std::vector<render::CutPlane>& planes);
  /// The difference to the reference is asked for instead of the field.
  bool compares() const { return compares_; }
  /// Colours and opacities; null before the first picture, and of categories, which have their own.
  const playback::TransferEditor* transfer() const { return transfer_ ? &*transfer_ : nullptr; }
  /// The values of the picture's volume, or of the one before it while they are counted; null before the
  /// first are. They are counted while the panel of the colours is open.
  const ValueSummary* values() const { return values_.get(); }
  render::Theme theme() const { return theme_; }
  const std::string& quantity() const { return quantity_; }
  std::optional<render::Pattern> pattern() const { return pattern_; }
  bool showsTerrain() const { return show_terrain_; }
  bool showsEmitters() const { return show_emitters_; }
  /// As edited; null for volumes alone, and before the input is open.
  playback::ScenarioPtr scenario() const { return edits_ ? edits_->scenario() : nullptr; }
  /// The last edits, if they were refused.
  const std::optional<Rejection>& rejection() const { return rejection_; }
  Prober& prober() { return prober_; }
  const Prober& prober() const { return prober_; }
  /// A change of the scenario or of the colours.
  bool canUndo() const { return undo_order_.canUndo() || dragging_ || isDragging(); }
  bool canRedo() const { return undo_order_.canRedo() && !dragging_ && !isDragging(); }
  const std::vector<std::optional<playback::Bookmark>>& bookmarks() const { return bookmarks_; }
  const Notice& notice() const { return notice_; }
  void tell(const std::string& text, bool is_error = false);
  Panels panels;
  EventLog& log() { return log_; }

 private:
  static std::vector<Verb> timeVerbs();
  static std::vector<Verb> cameraVerbs();
  static std::vector<Verb> scenarioVerbs();
  static std::vector<Verb> probeVerbs();
  static std::vector<Verb> pictureVerbs();
  static std::vector<Verb> planeVerbs();
  static std::vector<Verb> transferVerbs();
  static std::vector<Verb> windowVerbs();
  static std::vector<Verb> stateVerbs();
  static std::vector<Verb> fileVerbs();
  static std::vector<Verb> recordVerbs();

  void switchPlanes(const Command& command);
  void changePlane(const Command& command);
  void browse(FileBrowser::Purpose purpose);
  void ask(OpenRequest request);
  /// @throws Error (bad_input) if nothing is open
  void requireInput() const;
  void showView(const playback::ViewState& view);
  void noteSavedView(const std::string& file);
  std::optional<render::TransferFunction> colorsInUse() const;
  void saveScenario(const std::string& file, bool then_quits);
  void saveView(const std::string& file);
  void copyCommand();
  void writePendingPicture();
  void lookForKeptView();
  void watchFiles();
  void takeChangedFiles();
  void keepEdits(double now_s);
  void keepView();
  void dropKeptView();
  bool isPictureSettled() const;
  std::string recordTimes(const RecordRange& range) const;
  void finishJobs();
  void askTime();
  void takeScenario();
  void takePicture();
  void showScenario();
  /// Takes effect with one of the next updates.
  void changeScenario(const std::vector<scenario::Edit>& edits);
  void takeEdits();
  void focusEmitter(const std::optional<std::string>& name);
  void focusGround(double x, double y);
  /// What the log says of the probe.
  Json probeReport() const;
  void tellRate();
  /// After the edits that were asked for before.
  void askUndo(bool undo);
  void undoOrRedo(bool undo);
  void noteSteps();

  // Colours: session_transfer.cpp
  enum class Fit { step, series, anew };
  void takeColors();
  void countValues();
  void fitColors();
  /// @throws Error (bad_input) where there are no colours to change
  playback::TransferEditor& requireTransfer();
  void readTransfer(const std::string& file);
  void saveTransfer(std::string file);
  Json transferReport() const;

  const ViewOptions options_;
  WindowControl& window_;
  EventLog& log_;
  const playback::ComputeTarget target_;
  const std::function<void()> wake_;
  playback::LiveView live_;

  std::shared_ptr<const playback::LivePicture> picture_;
  playback::LiveStatus status_;
  std::string told_error_;
  render::ControllerState logged_state_ = render::ControllerState::idle;
  CameraControl camera_;
  playback::Timeline timeline_;
  std::optional<double> asked_s_;
  double advanced_at_s_ = 0;
  render::ImageSize picture_size_;
  render::RenderSettings settings_;
  render::CompositingMode fog_mode_ = render::CompositingMode::dvr;  // that I goes back to
  std::optional<playback::TransferEditor> transfer_;
  bool takes_colors_ = true;  // from the next pictures, which are fitted anew
  std::shared_ptr<const ValueSummary> values_;
  bool counting_ = false;
  std::optional<Fit> fit_;  // asked for, and what it needs is not known yet
  render::Theme theme_;
  std::string quantity_;
  std::optional<render::Pattern> pattern_;
  bool show_terrain_, show_emitters_;
  bool compares_;
  std::size_t focused_ = 0;
  std::vector<std::optional<playback::Bookmark>> bookmarks_{9};

  std::optional<playback::EditHistory> edits_;
  playback::EditQueue edit_queue_;
  playback::ScenarioPtr shown_scenario_;  // that the live view was given
  std::string shown_quantity_;            // the same
  std::optional<Rejection> rejection_;
  Prober prober_;
  UndoOrder undo_order_;
  bool dragging_ = false;  // the colours
  bool touched_ = false;   // by a command since the last update()
  std::shared_ptr<Files> files_;
  std::string saved_file_;    // view file that ...
  std::string saved_text_;    // ... holds this view
  std::string copied_;        // the command that was copied last
  std::string picture_file_;  // to be written as soon as the picture is settled
  bool opened_unsaved_;       // with edits that no file holds
  std::string kept_hash_;     // of the scenario that the autosave holds, or needs not hold
  std::optional<double> keep_at_s_;
  bool has_kept_;  // an autosave, which a regular end removes
  std::optional<playback::AutosavedView> kept_view_;
  FileWatch file_watch_;
  std::vector<std::string> changed_files_;
  Notice notice_;
  BackgroundJobs jobs_;  // the first to go
};

/// The edits that put a platform elsewhere.
/// @throws Error (bad_input) if there is no such platform, or it moves along a track
std::vector<scenario::Edit> movesOf(const scenario::Scenario& scenario, const std::string& platform,
                                    double latitude_deg, double longitude_deg);

}  // namespace emscape::view
