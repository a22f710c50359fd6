/// State and commands of the window, without drawing or input: no OpenGL, no ImGui.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/view/commands/command.h"
#include "apps/view/commands/event_log.h"
#include "apps/view/commands/window_control.h"
#include "apps/view/files/file_watch.h"
#include "apps/view/files/files.h"
#include "apps/view/parts/background_jobs.h"
#include "apps/view/parts/open_panels.h"
#include "apps/view/parts/program_state.h"
#include "apps/view/parts/undo_order.h"
#include "apps/view/parts/view_options.h"
#include "apps/view/tools/camera_control.h"
#include "apps/view/tools/pick_tool.h"
#include "apps/view/tools/probe_history.h"
#include "apps/view/tools/prober.h"
#include "apps/view/tools/scene_objects.h"
#include "apps/view/values/shown_quantity.h"
#include "apps/view/values/value_summary.h"
#include "playback/editing/autosave.h"
#include "playback/editing/edit_history.h"
#include "playback/editing/renamed_items.h"
#include "playback/editing/timeline.h"
#include "playback/editing/transfer_editor.h"
#include "playback/live/edit_queue.h"
#include "playback/live/live_view.h"
#include "playback/stream/live_battlefield.h"

namespace emscape::view {

/// One line of text that reports the result of a command.
struct Notice {
  std::string text;
  bool is_error = false;
  double since_s = 0;
};

/// Edits that were refused.
struct Rejection {
  std::vector<scenario::Edit> edits;
  std::string message;
};

/// A command that waits for the answer whether an existing file may be replaced.
struct Replacing {
  Command command;
  std::string file;
};

/// Runs commands on a LiveView and holds the requested state. For use by the window's thread.
class Session {
 public:
  /// @param wake   called from any thread when there is something new to show
  /// @param files  shared by the sessions of a window; null: not shared
  Session(const ViewOptions& options, const playback::ComputeTarget& target, WindowControl& window,
          EventLog& log, std::function<void()> wake, std::shared_ptr<Files> files = nullptr);
  /// Waits until the files are written.
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// The verbs of perform(): one table per topic, session_TOPIC.cpp.
  static std::vector<Verb> verbs();
  /// Executes a command. Errors become the notice. Waiting, keys, mouse and expect belong to the script.
  /// @return false if the command was refused, which is told
  bool perform(const Command& command);
  /// Changes values of the scenario while a control or a platform is dragged: one undo step.
  void drag(const std::vector<scenario::Edit>& edits);
  void dragValue(const std::string& path, const std::string& value) { drag({{path, value}}); }
  /// Changes colours and opacities while a control is dragged: one undo step.
  void dragTransfer(const std::function<void(playback::TransferEditor&)>& change);
  /// The same, as a separate undo step.
  void changeTransfer(const std::function<void(playback::TransferEditor&)>& change);
  /// Ends a drag of either kind.
  void endDrag();
  /// Restores the values, or the planes, before the drag.
  void cancelDrag();
  bool isDragging() const { return edit_queue_.isDragging(); }

  /// Advances time and takes new results. @return true if the window must be drawn
  bool update();
  /// Seconds until update() must be called again; empty: at the next event.
  std::optional<double> nextUpdate_s() const;
  /// The part of the window that the picture fills.
  void setPictureSize(render::ImageSize size);
  render::ImageSize pictureSize() const { return view_.size; }
  /// Sets whether busy pictures cast on a GPU are kept in its memory; see LivePicture::on_device.
  void keepOnDevice(bool keep) { live_.keepOnDevice(keep); }

  // --- state on screen ---
  const playback::LivePicture* picture() const { return picture_.get(); }
  /// False before the first picture with a field: at first pictures show the ground and the emitters.
  bool hasField() const { return picture_ && picture_->has_field; }
  /// True once the first field was shown or cancelled.
  bool isOpened() const { return is_opened_; }
  /// True if the input is files, not a scenario whose field is computed.
  bool showsFiles() const { return hasInput() && !status_.quantities.empty(); }
  /// The quantities that can be shown. Computed again for another scenario.
  const std::vector<ShownQuantity>& quantities();
  /// The requested quantity, or the one that stands for none.
  std::string chosenQuantity() const;
  const playback::LiveStatus& status() const { return status_; }
  /// What the program does, in words.
  ProgramState programState() const;
  /// Limit of status().cached_bytes.
  std::size_t cacheLimit_bytes() const { return cache_limit_bytes_; }
  bool exact() const;
  /// True if requested edits or readings are pending: scripts wait for them.
  bool isAnswering() const { return edit_queue_.isBusy() || prober_.isBusy(); }
  /// True if the picture is exact and no request is pending.
  bool settled() const;
  /// True if files are being read or written, or will be once the picture is settled, or another session is
  /// being opened.
  bool working() const;
  /// True if files are being read or written.
  bool writing() const { return jobs_.busy(); }
  /// The geometry for mouse movements; empty before the first picture.
  std::optional<Viewport> viewport() const;
  /// Report of a frame, for the log and for script comparisons.
  Json report() const;

  // --- files: session_state.cpp, session_files.cpp ---
  const ViewOptions& options() const { return options_; }
  /// True if an input is open or is being opened; else the window offers the start panel.
  bool hasInput() const { return !options_.view.input.empty(); }
  Files& files() { return *files_; }
  const Files& files() const { return *files_; }
  /// The requested view. Time line, bookmarks and panels, which have their own state, are in viewState().
  const playback::ViewState& view() const { return view_; }
  /// The requested state, as a view that can be saved.
  playback::ViewState viewState() const;
  /// Changes the view; a notice reports settings that do not apply to the field on screen.
  void change(const std::function<void(playback::ViewState&)>& change);
  bool hasUnsavedEdits() const;
  /// True if colours or opacities were changed and neither they nor the view were saved since.
  bool hasUnsavedColors() const;
  /// True if quitting would lose edits or colours.
  bool isUnsaved() const { return hasUnsavedEdits() || hasUnsavedColors(); }
  /// The answers given so far to the questions before the end: arguments of `quit`.
  const Json& quitAnswers() const { return quit_answers_; }
  /// True if the program ends as soon as the recording is complete.
  bool quitsWhenRecorded() const { return quits_when_recorded_; }
  const std::optional<Replacing>& replacing() const { return replacing_; }
  /// The file that the user works on: the input, or what it was saved as.
  const std::string& document() const { return saved_as_.empty() ? options_.namesake() : saved_as_; }
  /// The files that `save` and `save_transfer` write without a name.
  std::string usualScenarioFile() const;
  std::string usualColorsFile() const;
  /// Warnings about models, files and scans: of the log since the input was opened, and of the field on
  /// screen.
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// The autosave of an earlier run that did not end regularly.
  const std::optional<playback::AutosavedView>& keptView() const { return kept_view_; }
  /// Files of the input that have changed on the disk since they were read.
  const std::vector<std::string>& changedFiles() const { return changed_files_; }
  /// True while a dialog waits for the user or a text is typed: what a finished job shows comes later.
  bool isOccupied() const;
  /// Keeps what the user has open beside the input, and of the same input the selection.
  void takeOver(const Session& before);
  /// Ends this session. @param keeps_edits  true: unsaved edits are offered when the input is opened again
  void leave(bool keeps_edits);
  /// Ends this session for that of the view that was kept, whose file the next edits replace.
  void leaveForKept();
  /// Called when the session is shown. @param left_out  edits that did not apply: warnings
  void shown(const std::vector<std::string>& left_out);
  void record(const RecordRange& range, const std::string& output, Replaces replaces);
  /// Opens the file browser. @param proposed  file name at first; may be empty
  void browse(FileBrowser::Purpose purpose, const std::string& proposed = "");

  CameraControl& camera() { return camera_; }
  const CameraControl& camera() const { return camera_; }
  void cameraMoved();
  /// The camera stays where it is, to be moved freely.
  void stopFollowing();
  const playback::Timeline& timeline() const { return timeline_; }
  /// The largest number of emitters since the input was opened: the time line has a row for each, and does
  /// not shrink by an undo.
  std::size_t mostEmitters() const { return most_emitters_; }
  const render::RenderSettings& settings() const { return view_.settings; }
  /// A plane through the middle of the box; a vertical one faces the viewer.
  render::CutPlane newPlane(render::CutPlane::Kind kind) const;
  /// Changes the planes: one undo step. @throws Error (bad_input) for too many, or values out of their range
  void setPlanes(const std::vector<render::CutPlane>& planes);
  /// The same while one is dragged: all changes until endPlaneDrag() are one undo step.
  void dragPlanes(const std::vector<render::CutPlane>& planes);
  void endPlaneDrag();
  bool isDraggingPlane() const { return planes_.dragged() != nullptr; }
  /// True if the difference to the reference is requested instead of the field.
  bool compares() const { return view_.comparison() == playback::Comparison::difference; }
  /// True if the reference is requested beside the field.
  bool isSplit() const { return view_.comparison() == playback::Comparison::side_by_side; }
  /// Moves the line of a split view. @param x  pixel of the picture
  void moveSplit(double x);
  /// Colours and opacities; null before the first picture, and for categories, which have fixed colours.
  const playback::TransferEditor* transfer() const { return transfer_ ? &*transfer_ : nullptr; }
  /// Statistics of the values of the picture's volume, or of the previous one while they are computed; null
  /// before the first. Computed while the colour panel is open.
  const ValueSummary* values() const { return values_.get(); }
  render::Theme theme() const { return view_.theme; }
  /// The edited scenario; null for volumes without one, and before the input is open.
  playback::ScenarioPtr scenario() const { return edits_ ? edits_->scenario() : nullptr; }
  /// The same as it is in its file.
  playback::ScenarioPtr original() const;
  /// @throws Error (bad_input) if the stream moves the platform: an edit of its place would have no effect
  void requireMovable(const std::string& platform) const;
  /// "live", of the stream; empty without one.
  std::string streamTitle() const;
  /// The last edits if they were refused.
  const std::optional<Rejection>& rejection() const { return rejection_; }
  /// The path of what is selected, such as "emitters.jammer"; empty: nothing.
  std::string selected() const;
  /// The objects of the picture, at its time.
  const std::vector<SceneObject>& objects() const;
  /// Null if the picture has no such object.
  const SceneObject* objectOf(const std::string& path) const;
  const PickTool& tool() const { return tool_; }
  /// The ground under a pixel of the picture (frame metres); there must be a picture.
  std::optional<Vec3d> groundAt(double x, double y) const;
  /// Reads the value under the cursor.
  Prober& cursor() { return cursor_; }
  const Prober& cursor() const { return cursor_; }
  Prober& prober() { return prober_; }
  const Prober& prober() const { return prober_; }
  /// Values over time at the locked probe, while its panel is open.
  const ValueHistory& history() const { return history_.values(); }
  /// True if there is a change of the scenario, of the colours or of the planes.
  bool canUndo() const { return undo_order_.canUndo() || dragging_ || isDragging() || planes_.dragged(); }
  bool canRedo() const { return undo_order_.canRedo() && !dragging_ && !isDragging() && !planes_.dragged(); }
  const std::vector<std::optional<playback::Bookmark>>& bookmarks() const { return bookmarks_; }
  const FieldTimes& fieldTimes() const { return field_times_; }
  const Notice& notice() const { return notice_; }
  void tell(const std::string& text, bool is_error = false);
  /// Tells that the program wrote this file, and remembers it.
  void tellWritten(const std::string& file);
  /// Tells what was assumed for the scenario of a recording.
  void tellImport();
  /// Shows a notice that another session of the window has told and logged.
  void show(const Notice& notice) { notice_ = notice; }
  Panels panels;
  EventLog& log() { return log_; }

 private:
  static std::vector<Verb> programVerbs();
  static std::vector<Verb> followVerbs();
  static std::vector<Verb> timeVerbs();
  static std::vector<Verb> cameraVerbs();
  static std::vector<Verb> scenarioVerbs();
  static std::vector<Verb> selectionVerbs();
  static std::vector<Verb> toolVerbs();
  static std::vector<Verb> itemVerbs();
  static std::vector<Verb> probeVerbs();
  static std::vector<Verb> pictureVerbs();
  static std::vector<Verb> planeVerbs();
  static std::vector<Verb> transferVerbs();
  static std::vector<Verb> windowVerbs();
  static std::vector<Verb> stateVerbs();
  static std::vector<Verb> fileVerbs();
  static std::vector<Verb> recordVerbs();
  static std::vector<Verb> quitVerbs();

  void switchPlanes(const Command& command);
  void changePlane(const Command& command);
  void changeMapLayer(const Command& command);
  /// @throws Error (bad_input) for volumes without others to compare with
  void requireReference(const char* verb) const;
  void changeComparison(bool compares);
  void changeSplit(double split);
  void showPlanes();
  void changeSetting(const Command& command);
  void showQuantity(const std::string& name);
  void reportFailure();
  void revertRejected();
  /// @return false if they are shown already
  bool showLastQuantity();
  /// Abandons what is being computed or opened.
  void cancel();
  void noteProgram();
  void follow(const std::string& name, const std::string& mode);
  /// The scenario that the field is computed from; null for volumes.
  playback::ScenarioPtr computedScenario() const { return view_.scenario.empty() ? scenario() : nullptr; }
  void ask(OpenRequest request);
  /// @throws Error (bad_input) if nothing is open
  void requireInput() const;
  void showView(const playback::ViewState& view);
  void noteSavedView(const std::string& file);
  /// @param is_named  by the user: it is the document then
  /// @param asks_again  for the name, if the file cannot be written
  void saveScenario(const std::string& file, bool is_named, bool asks_again = false);
  void quit(const Command& command);
  /// Remembers that the program wrote this file.
  void noteWritten(const std::string& file);
  /// True if the user is asked first, since the file exists and is not as this session wrote it. With the
  /// argument `replace`, which is the answer, and in scripts there is no question.
  bool asksToReplace(const Command& command, const std::string& file);
  /// Whether the question was answered with yes; scripts do so unless they say no.
  bool mayReplace(const Command& command) const;
  void saveView(const std::string& file);
  void copyCommand();
  void writePendingPicture();
  void lookForKeptView();
  /// True if the program has made the input of a recording.
  bool isImported() const { return !options_.made_of.empty() && !options_.stream; }
  /// The user's files that the input is read from or made of.
  std::vector<std::string> sources() const;
  void watchFiles();
  void takeChangedFiles();
  void keepEdits(double now_s);
  void keepView();
  void dropKeptView();
  bool isPictureSettled() const;
  /// @return true if they have changed
  bool takeWarnings(double now_s);
  std::string importText() const;
  void checkScenario();
  void checkSteps();
  void joinModelWarnings(double now_s);
  std::string recordTimes(const RecordRange& range) const;
  void finishJobs();
  void askTime();
  void takeStream();
  void adoptStreamed();
  void indexStreamed();
  double untilStream_s() const;
  playback::PosesPtr streamedPoses() const;
  /// @throws Error (bad_input) if edits concern the place of a platform that the stream moves
  void requireMovable(const std::vector<scenario::Edit>& edits) const;
  void setTimelineScenario();
  void takeScenario();
  void takePicture();
  void showEdits();
  void showScenario(const std::vector<playback::RenamedItem>& renamed);
  void followNames(const std::vector<playback::RenamedItem>& renamed);
  /// Takes effect with one of the next updates.
  void changeScenario(const std::vector<scenario::Edit>& edits);
  /// @throws Error (bad_input) if there is none
  const scenario::Scenario& requireScenario() const;
  /// @param on  none: the other state
  void enableEmitter(const std::string& name, std::optional<bool> on);
  /// @param path  empty: all edits
  void revertEdits(const std::string& path);
  void takeEdits();
  void focusEmitter(const std::optional<std::string>& name);
  void focusObject(const SceneObject& object);
  void focusGround(double x, double y);
  void focusPosition(const std::string& text);
  void select(const std::string& path);
  void selectNext(int change);
  const SceneObject& requireObject(const std::string& path) const;
  void copyText(const std::string& text);
  ToolPoint pointOf(const Command& command) const;
  double measuringFrequency_hz() const;
  void addMeasured(const ToolPoint& point);
  void measure(const Command& command);
  void drawTrack(const Command& command);
  void placeItem(const Command& command);
  /// Reports of the probe, and of the selection and tools, for the log.
  Json probeReport() const;
  Json selectionReport() const;
  void askHistory();
  void tellRate();
  void pause();
  /// Undoes or redoes a step after the edits that were requested before.
  void askUndo(bool undo);
  void undoOrRedo(bool undo);
  void noteSteps();

  // Colours: session_transfer.cpp
  enum class Fit { step, series, anew };
  void takeColors();
  /// The colours of the next pictures are those that their field had last, or fitted.
  void leaveField() { leaveField(fieldName(chosenQuantity())); }
  /// @param field  that is left: fieldName()
  void leaveField(const std::string& field);
  std::string fieldName(const std::string& quantity) const;
  void countValues();
  void fitColors();
  /// @throws Error (bad_input) if there are no editable colours
  playback::TransferEditor& requireTransfer();
  void readTransfer(const std::string& file);
  void saveTransfer(const std::string& file);
  Json transferReport() const;

  const ViewOptions options_;
  WindowControl& window_;
  EventLog& log_;
  const playback::ComputeTarget target_;
  const std::function<void()> wake_;
  const std::size_t cache_limit_bytes_;
  playback::ViewState view_;  // requested; without a size nothing is drawn before the window has set it
  playback::LiveView live_;

  std::shared_ptr<const playback::LivePicture> picture_;
  playback::LiveStatus status_;
  struct {
    std::string text;       // of the status when it was read last
    std::string told;       // notice of the last failure
    std::string shown;      // field to which the session has returned from the refused one; empty: it has not
    bool is_field = false;  // that failed; else a picture
  } failure_;
  render::ControllerState logged_state_ = render::ControllerState::idle;
  Activity logged_activity_ = Activity::empty;
  bool is_opened_ = false;
  bool is_on_screen_ = false;               // else it is opened beside the one on screen
  std::string noted_words_;                 // of the program's state at the last update
  std::optional<double> computing_from_s_;  // when the pending field was requested
  CameraControl camera_;
  playback::Timeline timeline_;
  std::size_t most_emitters_ = 0;
  double advanced_at_s_ = 0;
  render::CompositingMode fog_mode_ = render::CompositingMode::dvr;  // mode to which the key I returns
  double last_map_height_agl_m_ = 100;  // to which the key of the map layer returns
  double last_split_ = 0.5;             // to which the key of the split view returns
  std::optional<playback::TransferEditor> transfer_;
  bool takes_colors_ = true;  // true: takes the colours of the next pictures, which are fitted again
  struct FieldColors {
    render::TransferFunction function;
    std::optional<render::TransferFunction> saved;
    double iso_value = 0;
  };
  std::map<std::string, FieldColors> field_colors_;  // of quantities and differences that were shown
  std::shared_ptr<const ValueSummary> values_;
  bool counting_ = false;
  std::optional<Fit> fit_;  // requested, but its data are not yet available
  std::size_t focused_ = 0;
  std::vector<std::optional<playback::Bookmark>> bookmarks_{9};

  std::optional<playback::EditHistory> edits_;
  mutable playback::ScenarioPtr original_, original_of_;  // the scenario that was asked for last
  playback::EditQueue edit_queue_;
  playback::ScenarioPtr shown_scenario_;  // the scenario of the live view
  struct {
    std::string quantity, compare;
    double split = 0, iso_value = 0;
  } last_shown_;  // of the view of the last computed field
  struct {
    playback::ScenarioPtr scenario;  // as the stream has it
    playback::NamedPosesPtr poses;
    playback::PlatformIndices indices;  // in the shown scenario
    std::shared_ptr<void> wake;
    std::string text;  // of its status
    double told_s = -1e9, arrival_s = 0;
    long long records = 0;
    std::size_t entities = 0;
    bool has_trouble = false, is_moving = false, has_stopped = false;
  } stream_;
  std::optional<Rejection> rejection_;
  std::string selected_;
  mutable std::vector<SceneObject> objects_;  // of ...
  mutable std::shared_ptr<const playback::LivePicture> objects_of_;
  PickTool tool_;
  Prober prober_, cursor_;
  ProbeHistory history_;
  playback::UndoStack<std::vector<render::CutPlane>> planes_;  // those of the view
  UndoOrder undo_order_;
  bool dragging_ = false;           // the colours
  std::pair<int, int> recorded_{};  // pictures that the progress of a recording shows, and their number
  bool touched_ = false;            // by a command since the last update()
  std::shared_ptr<Files> files_;
  std::string saved_as_;                                  // the file of a name that the user gave
  std::string saved_file_;                                // view file that ...
  std::string saved_text_;                                // ... holds this view
  std::string copied_;                                    // the command that was copied last
  std::string picture_file_;                              // written when the picture is settled
  std::optional<render::TransferFunction> saved_colors_;  // as fitted, read or written last
  std::optional<Replacing> replacing_;
  std::map<std::string, std::size_t> written_;  // states of this session's outputs, by absolute name
  Json quit_answers_ = Json::object();
  bool quits_when_recorded_ = false;
  bool opened_unsaved_;    // with unsaved edits
  std::string kept_hash_;  // of the scenario in the autosave, or of one without unsaved edits
  std::optional<double> keep_at_s_;
  bool has_kept_;  // true: there is an autosave; a regular end removes it
  std::optional<playback::AutosavedView> kept_view_;
  bool asks_to_restore_ = false;  // as soon as the user is not occupied
  FieldTimes field_times_;
  FileWatch file_watch_;
  std::vector<std::string> changed_files_;
  std::vector<ShownQuantity> quantities_;
  playback::ScenarioPtr quantities_of_;
  std::vector<std::string> warnings_;
  std::string import_text_;  // among them
  playback::ScenarioPtr checked_scenario_;
  playback::ScenarioPtr stepped_scenario_;  ///< whose steps are checked
  std::vector<std::string> step_warnings_;
  std::vector<std::string> scenario_warnings_;                       // of that scenario
  std::shared_ptr<const std::vector<std::string>> joined_warnings_;  // of the models, ...
  std::vector<std::string> model_warnings_;                          // ... joined
  double joined_at_s_ = -1e9;
  Notice notice_;
  std::string refused_, refused_verb_;  // notice and verb of the last command, if it was refused
  BackgroundJobs jobs_;                 // destroyed first
};

/// A file of the input's name with another ending, in its folder.
std::string besideInput(const std::string& input, const std::string& ending);

/// The edits that move a platform.
/// @throws Error (bad_input) if there is no such platform, or it moves along a track
std::vector<scenario::Edit> movesOf(const scenario::Scenario& scenario, const std::string& platform,
                                    double latitude_deg, double longitude_deg);

}  // namespace emscape::view
