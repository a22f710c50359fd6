/// The engine of a window: computes fields and pictures on its own threads, driven by events.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/error.h"
#include "emscape/base/work.h"
#include "emscape/playback/frames/compute_target.h"
#include "emscape/playback/frames/frame_source.h"
#include "emscape/playback/frames/shown_field.h"
#include "emscape/playback/pictures/painter.h"
#include "emscape/render/annotate/overlay.h"
#include "emscape/render/picture/device_picture.h"
#include "emscape/render/picture/image.h"
#include "emscape/render/scene/camera.h"
#include "emscape/render/scene/frame.h"
#include "emscape/render/scene/height_field.h"
#include "emscape/render/scene/render_settings.h"
#include "emscape/render/transfer/transfer_function.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/terrain/terrain.h"
#include "emscape/volume/value_range.h"
#include "playback/live/patience.h"
#include "render/patterns/frame_controller.h"

namespace emscape::playback {

struct LiveOptions {
  ComputeTarget target;
  render::ControllerOptions controller;
  std::size_t cache_bytes = std::size_t{512} << 20;  ///< of the cached volumes of steps and of the reference
  /// Minimum interval (ms) between the starts of two fields that only a change of time requests.
  double min_seek_interval_ms = 60;
  double min_play_interval_ms = 15;  ///< the same while playing
  /// Number of steps computed ahead of the one on screen, while steps are requested in sequence and there is
  /// no other work.
  int steps_ahead = 2;
  /// Until the first field is computed, the pictures show the ground and the emitters.
  bool begins_without_field = false;
  /// Threads of loops; 0: all, but fields leave one core free while pictures are cast.
  int solve_threads = 0;
  int cast_threads = 0;
  int niceness = 0;  ///< of those threads: see ThreadArena
};

/// The picture on screen and the work in progress.
struct LiveStatus {
  render::ControllerState state = render::ControllerState::idle;
  render::Pattern pattern = render::Pattern::full;  ///< of the picture's busy frame
  std::string cells;  ///< how the picture's tetrahedra were drawn (CellPicture::text()); empty for volumes
  double rays_fraction = 0;  ///< fraction of pixels of that frame that were cast, 0..1
  double cast_ms = 0;        ///< of that frame, interpolation included
  double labels_ms = 0;      ///< to fetch the picture and draw its labels
  double field_ms = 0;       ///< of the last computed field
  /// Time from the oldest input that this picture is the first to show; 0: it shows no new input.
  double input_to_picture_ms = 0;
  double input_to_frame_ms = 0;  ///< from the same input to the beginning of its frame
  /// Of the picture's field: every column_step-th column in each direction is computed, and the others are
  /// interpolated (BusyField); 1: all are computed.
  int column_step = 1;
  /// The picture shows the last request, each of its pixels is cast, and all columns are computed. After a
  /// failure: the last valid request.
  bool exact = false;
  double asked_s = 0;          ///< time of the last requested field
  double shown_s = 0;          ///< time of the picture's field
  bool computing = false;      ///< the last requested field is being computed, or no picture shows it yet
  WorkProgress progress;       ///< of the field in progress, and of the opening of the input
  double fields_per_s = 0;     ///< different fields in the pictures of the last two seconds; 0: at most one
  bool is_continuous = false;  ///< there are fields between the steps, too
  bool failed = false;     ///< the last requested field cannot be computed; the picture shows an earlier one
  bool searching = false;  ///< searchSeriesRange() is in progress
  std::optional<volume::ValueRange>
      series_range;                     ///< result of the search; none before, and if there are no values
  std::vector<int> cached_steps;        ///< indices into times_s() of cached steps, ascending
  std::size_t cached_bytes = 0;         ///< of the steps and of the reference of a comparison
  std::vector<std::string> quantities;  ///< that the input's files hold; empty if the field is computed
  std::shared_ptr<const std::vector<std::string>>
      warnings;                 ///< of the models, about the last field; may be null
  std::string reason;           ///< reason for the pattern
  std::string device;           ///< "cpu" or the name of the GPU
  std::string error;            ///< the last failure, in one line; empty after the next success of its kind
  bool is_field_error = false;  ///< a field failed, which the next one mends; else a picture
  ErrorCode error_code = ErrorCode::other;  ///< of an input that cannot be opened
  long long frame = 0;                      ///< number of the picture, from 1; 0: none yet
  long long fields_computed = 0;
  long long fields_abandoned = 0;  ///< because a request superseded them
  double abandon_ms = 0;           ///< longest time that this took
  long long wake_ups = 0;          ///< of both threads since the start; constant while there is no work

  /// True if nothing is to be done until the next input.
  bool isSettled() const { return exact && state == render::ControllerState::idle && !searching; }
};

/// A change of the controller's state.
struct StateChange {
  render::ControllerState to = render::ControllerState::idle;
  std::chrono::steady_clock::time_point time;
};

/// A picture with the field that it shows; info().range_* is the range of that field. Immutable.
struct LivePicture : ShownField {
  std::shared_ptr<const Frame>
      beside;  ///< field of the columns left of `split_column`; null if there are none
  int split_column = 0;
  bool has_field = true;  ///< false: LiveOptions::begins_without_field, LiveView::showWithoutField()
  render::ImageSize size;
  /// With background and labels. Of a settled picture: as `emscape render` writes it.
  render::Image8 finished;
  /// The same on the GPU, in place of `finished`; null except for busy pictures with keepOnDevice().
  std::shared_ptr<const render::DevicePicture> on_device;
  /// Settled pictures: premultiplied, without background and labels; else empty.
  render::Image8 image;
  render::Camera camera;
  render::SceneBox box;
  render::Annotations annotations;
  render::TransferFunction transfer;
  render::RenderSettings settings;
  std::shared_ptr<const scenario::Scenario> scenario;  ///< null for volumes without one
  scenario::TerrainPtr terrain;                        ///< may be null
  std::shared_ptr<const render::HeightField> ground;   ///< as drawn; null if there is none
  LiveStatus status;                                   ///< when the picture was made
};

/// Computes and draws the requested pictures. One thread calls it; only the constructor and the destructor
/// wait. Requests take effect in order; of several pending requests of one kind only the last is served.
///
/// Two threads work. *solve* opens the input and computes fields (edits and steps; steps are cached until an
/// edit). *cast* draws: BUSY while requests arrive, then RESTORE, which any request stops within a few rows
/// of tiles, then IDLE. An IDLE picture is bit-identical to a full cast of the same scene by Painter.
///
/// A view without colours has those that were fitted to the histogram of its first frame, as in `render`, and
/// again after a change of the quantity or comparison. They are constant otherwise, so that steps and edits
/// can be compared. Each picture contains the function in use, which reproduces it together with camera and
/// settings.
class LiveView {
 public:
  /// @param view  its input may be empty: no pictures. With a size of 0 nothing is drawn before another one
  /// @param wake   called on the threads of this object after each picture and each change of the status; may
  /// be empty. It may call picture() and status(), and must not wait for this object
  /// @throws Error (bad_input) for settings out of their range, (device); faults of the input are in
  /// status().error
  LiveView(const ViewState& view, const LiveOptions& options, std::function<void()> wake);
  /// Stops the work in progress: a picture within a few rows of tiles, a field at its next checkpoint.
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  /// Shows another view: only what differs from the last one is computed and drawn.
  ///
  /// The time is the nearest that there is a field for, also beyond the ends: that of a step, or of a
  /// computed scenario any. An edited scenario keeps the results that the edit does not invalidate; cached
  /// steps are dropped. A comparison is with the reference of the first view, else with the opened scenario
  /// without edits; an edit does not recompute the reference. Of another input, scenario or mesh than the
  /// first view's nothing is shown. If a model refuses an input, fields cannot be compared, or settings are
  /// out of their range, the message is in status().error and the picture stays as it was in this respect.
  /// @param edited       the scenario with the edits of the view; null: as it was shown last
  /// @param patience_ms  with the field in progress, if another one is requested: see Patience
  void show(const ViewState& view, std::shared_ptr<const scenario::Scenario> edited = nullptr,
            double patience_ms = Patience::kNone);
  /// Abandons the field of the last view: the picture shows its ground and its emitters until another field
  /// is requested. For computed grids before the first field.
  void showWithoutField();
  /// Shows platforms at the poses of a live source; the field in progress is completed first. Null: where the
  /// scenario has them.
  /// @param scenario  of the poses; null: that which is shown
  void pose(PosesPtr poses, std::shared_ptr<const scenario::Scenario> scenario = nullptr);
  /// Sets whether busy pictures of a GPU stay in its memory, to be displayed from there; false at first.
  void keepOnDevice(bool keep);

  /// Searches the range of the values over the series, for status().series_range: computes up to 24 steps
  /// when there is no other work. The picture stays.
  void searchSeriesRange();

  /// The latest picture; null before the first.
  std::shared_ptr<const LivePicture> picture() const;
  LiveStatus status() const;
  /// The changes of status().state since the last call, in order; at most the last 1000.
  std::vector<StateChange> takeStateChanges();
  /// Steps of the source, ascending; empty before it is open.
  std::vector<double> times_s() const;
  /// The scenario that was set last or read from the file; null before it is read, and if there is none.
  std::shared_ptr<const scenario::Scenario> scenario() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace emscape::playback
