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
#include "emscape/playback/frames/compute_target.h"
#include "emscape/playback/frames/shown_field.h"
#include "emscape/playback/pictures/painter.h"
#include "emscape/render/annotate/overlay.h"
#include "emscape/render/patterns/frame_controller.h"
#include "emscape/render/picture/device_picture.h"
#include "emscape/render/picture/image.h"
#include "emscape/render/scene/camera.h"
#include "emscape/render/scene/height_field.h"
#include "emscape/render/scene/pattern.h"
#include "emscape/render/scene/render_settings.h"
#include "emscape/render/transfer/transfer_function.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/terrain/terrain.h"
#include "emscape/volume/value_range.h"

namespace emscape::playback {

struct LiveOptions {
  ComputeTarget target;
  render::ControllerOptions controller;
  std::size_t cache_bytes = std::size_t{1} << 30;  ///< of the cached volumes of steps
  bool allow_missing_terrain = false;
  std::string quantity;               ///< quantity or channel; empty: the first
  std::vector<scenario::Edit> edits;  ///< applied when the scenario is opened
  std::string mesh;                   ///< as FrameSelection::mesh
  std::string compare;                ///< as FrameSelection::compare: the view starts with the comparison
  double time_s = 0;                  ///< the view starts with the nearest step
  /// Minimum interval (ms) between the starts of two fields that only a change of time requests.
  double min_seek_interval_ms = 60;
  /// Number of steps computed ahead of the one on screen, while steps are requested in sequence and there is
  /// no other work.
  int steps_ahead = 2;
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
  /// The picture shows the last request, and each of its pixels is cast. After a failure: the last valid
  /// request.
  bool exact = false;
  double asked_s = 0;      ///< time of the last requested step
  double shown_s = 0;      ///< time of the picture's step
  bool computing = false;  ///< the last requested field is being computed
  bool failed = false;     ///< the last requested field cannot be computed; the picture shows an earlier one
  bool searching = false;  ///< searchSeriesRange() is in progress
  std::optional<volume::ValueRange>
      series_range;               ///< result of the search; none before, and if there are no values
  std::vector<int> cached_steps;  ///< indices into times_s() of cached steps, ascending
  std::string reason;             ///< reason for the pattern
  std::string device;             ///< "cpu" or the name of the GPU
  std::string error;              ///< the last failure, in one line; empty after the next success of its kind
  ErrorCode error_code = ErrorCode::other;  ///< of an input that cannot be opened
  long long frame = 0;                      ///< number of the picture, from 1; 0: none yet
  long long fields_computed = 0;
  long long wake_ups = 0;  ///< of both threads since the start; constant while there is no work

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
  /// Range of the colours after setRange(); none: they were fitted to the values of a step, or set.
  std::optional<volume::ValueRange> range;
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
/// Colours are fitted to the histogram of the first frame, as in `render`, and again after a change of the
/// quantity. Otherwise they are constant, so that steps and edits can be compared; setRange()
/// and setTransferFunction() change them. Each picture contains the function in use, which reproduces it
/// together with camera and settings.
class LiveView {
 public:
  /// @param input  scenario or volume file, .pvd, folder of volumes; empty: no pictures
  /// @param scenario_beside_volumes  scenario of the ground and emitters that are drawn with volumes; may be
  /// empty
  /// @param style  with a size of 0 nothing is drawn before resize()
  /// @param wake   called on the threads of this object after each picture and each change of the status; may
  /// be empty. It may call picture() and status(), and must not wait for this object
  /// @throws Error (bad_input) for settings out of their range, (device); faults of the input are in
  /// status().error
  LiveView(const std::string& input, const std::string& scenario_beside_volumes, const PictureStyle& style,
           const LiveOptions& options, std::function<void()> wake);
  /// Stops the work in progress: a picture within a few rows of tiles, a field at the end of its step.
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  /// Shows the step nearest to a time. @param time_s any, also beyond the ends
  void seek(double time_s);
  /// Shows an edited scenario. Results that the edit does not invalidate are kept; cached steps are dropped.
  /// If a model refuses an input, the message is in status().error and the picture stays. @param scenario
  /// not null
  void setScenario(std::shared_ptr<const scenario::Scenario> scenario);
  /// setScenario() and setQuantity() in one request, for a scenario that does not have the present quantity.
  void setScenario(std::shared_ptr<const scenario::Scenario> scenario, const std::string& quantity);
  /// Shows another quantity or channel; empty: the first. Colours are fitted again.
  void setQuantity(const std::string& quantity);

  /// Shows the difference to the reference: LiveOptions::compare, else the opened scenario without
  /// LiveOptions::edits. Colours are fitted again. An edit does not recompute the reference. If the two
  /// cannot be compared (indices, for example), the message is in status().error and the picture stays.
  void setComparison(bool on);

  void setCamera(const render::CameraSpec& camera);
  void setTransferFunction(const render::TransferFunction& function);
  /// Sets the render settings. For values out of range the message is in status().error and the settings
  /// stay.
  void setSettings(const render::RenderSettings& settings);
  /// Sets the size of the picture. With a side of 0 nothing is drawn until the next resize.
  void resize(render::ImageSize size);
  /// Pattern of busy frames; none: the one that meets the budget.
  void setPattern(std::optional<render::Pattern> pattern);
  void showTerrain(bool show);
  void showEmitters(bool show);
  void setTheme(render::Theme theme);
  /// Sets whether busy pictures of a GPU stay in its memory, to be displayed from there; false at first.
  void keepOnDevice(bool keep);

  /// Fits the colours to a range.
  void setRange(const volume::ValueRange& range);
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
