/// The engine behind a window: fields and pictures on threads of their own, driven by events.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/error.h"
#include "emscape/playback/compute_target.h"
#include "emscape/playback/painter.h"
#include "emscape/render/annotate/overlay.h"
#include "emscape/render/camera.h"
#include "emscape/render/device_picture.h"
#include "emscape/render/frame_controller.h"
#include "emscape/render/height_field.h"
#include "emscape/render/image.h"
#include "emscape/render/pattern.h"
#include "emscape/render/render_settings.h"
#include "emscape/render/transfer_function.h"
#include "emscape/scenario/scenario.h"
#include "emscape/scenario/terrain.h"
#include "emscape/volume/value_range.h"
#include "emscape/volume/volume.h"

namespace emscape::playback {

struct LiveOptions {
  ComputeTarget target;
  render::ControllerOptions controller;
  std::size_t cache_bytes = std::size_t{1}
                            << 30;  ///< of the volumes of steps that need not be computed again
  bool allow_missing_terrain = false;
  std::string quantity;               ///< quantity or channel; empty: the first
  std::vector<scenario::Edit> edits;  ///< to the scenario as it is opened
  std::string compare;                ///< as FrameSelection::compare: the view begins with the comparison
  double time_s = 0;                  ///< the first step that is shown is the nearest
  /// At least so long between the beginnings of two fields that a change of the time alone asks for (ms).
  double min_seek_interval_ms = 60;
  /// So many steps after the one on screen are computed in advance where steps are asked for one after
  /// another and nothing else is to be done.
  int steps_ahead = 2;
  /// Threads of loops; 0: solving takes one fewer than there are while pictures are cast on all of them.
  int solve_threads = 0;
  int cast_threads = 0;
  int niceness = 0;  ///< of those threads: see ThreadArena
};

/// What is on screen and what is being done.
struct LiveStatus {
  render::ControllerState state = render::ControllerState::idle;
  render::Pattern pattern = render::Pattern::full;  ///< of the picture's busy frame
  double rays_fraction = 0;                         ///< of that frame: pixels that were cast, 0..1
  double cast_ms = 0;                               ///< of that frame, interpolation included
  double labels_ms = 0;                             ///< of fetching the picture and drawing its labels
  double field_ms = 0;                              ///< of the last field that was computed
  /// From the oldest input that this picture is the first to show to the picture; 0: it shows no new input.
  double input_to_picture_ms = 0;
  double input_to_frame_ms = 0;  ///< from the same input to the begin of its frame
  /// The picture shows what was asked for last, and each of its pixels is cast. After a failure: the last
  /// that could be shown.
  bool exact = false;
  double asked_s = 0;                              ///< time of the step asked for last
  double shown_s = 0;                              ///< time of the picture's step
  bool computing = false;                          ///< the field of what was asked for last is under way
  bool searching = false;                          ///< the values of the series, for searchSeriesRange()
  std::optional<volume::ValueRange> series_range;  ///< found by it; none before, and without values
  std::vector<int> cached_steps;  ///< indices into times_s() that need not be computed, ascending
  std::string reason;             ///< why with this pattern
  std::string device;             ///< "cpu" or the name of the GPU
  std::string error;              ///< the last failure, in one line; empty after the next success of its kind
  ErrorCode error_code = ErrorCode::other;  ///< of an input that cannot be opened
  long long frame = 0;                      ///< number of the picture, from 1; 0: there is none yet
  long long fields_computed = 0;
  long long wake_ups = 0;  ///< of both threads since the start: stands still while nothing is to be done

  /// Nothing happens until the next input.
  bool isSettled() const { return exact && state == render::ControllerState::idle && !searching; }
};

/// The controller went over to another state.
struct StateChange {
  render::ControllerState to = render::ControllerState::idle;
  std::chrono::steady_clock::time_point time;
};

/// A picture with what it shows. Does not change.
struct LivePicture {
  render::ImageSize size;
  /// On its background, with its labels. Of a settled picture: as `emscape render` writes it.
  render::Image8 finished;
  /// The same on the GPU, in place of `finished`; null but for busy pictures with keepOnDevice().
  std::shared_ptr<const render::DevicePicture> on_device;
  /// Premultiplied, without background and labels; empty but for settled pictures.
  render::Image8 image;
  render::Camera camera;
  render::SceneBox box;
  render::Annotations annotations;
  render::TransferFunction transfer;
  render::RenderSettings settings;
  /// That of colours fitted by setRange(); none: they were fitted to the values of a step, or set.
  std::optional<volume::ValueRange> range;
  volume::Volume volume;                               ///< info().range_* are its own
  std::shared_ptr<const scenario::Scenario> scenario;  ///< null for volumes without one
  scenario::TerrainPtr terrain;                        ///< may be null
  std::shared_ptr<const render::HeightField> ground;   ///< as it is drawn; null where none is
  LiveStatus status;                                   ///< when the picture was made
};

/// Computes and draws what is asked for. One user thread calls it; no function but the constructor and the
/// destructor waits for anything. Requests take effect in the order in which they are made, of several of a
/// kind that are not begun the last counts.
///
/// Two threads work: *solve* opens the input and computes fields (edits and steps; steps are cached until an
/// edit), *cast* draws: BUSY while requests come, then RESTORE, which any request stops within a few rows of
/// tiles, then IDLE. An IDLE picture is bit-identical to a full cast by Painter of the same scene.
///
/// Colours are fitted once, to the first frame (to how frequent its values are, as `render` does), and again
/// for another quantity; they then stay, so that they mean the same over the series and edits can be
/// compared. fitToStep(), setRange() and setTransferFunction() are orders of the user. The function in use is
/// part of each picture: whoever stores it with camera and settings gets the same picture again.
class LiveView {
 public:
  /// @param input                    scenario or volume file, .pvd, folder of volumes; empty: there is
  /// nothing to show, and no picture comes
  /// @param scenario_beside_volumes  whose ground and emitters are drawn with volumes; may be empty
  /// @param style  sides of 0: nothing is drawn before resize()
  /// @param wake   called on the threads of this object after each picture and each change of the status; may
  /// be empty. May call picture() and status(); must not wait for this object
  /// @throws Error (bad_input) for settings out of their range, (device); what is wrong with the input is
  /// told by status().error
  LiveView(const std::string& input, const std::string& scenario_beside_volumes, const PictureStyle& style,
           const LiveOptions& options, std::function<void()> wake);
  /// Stops what is under way: a picture within a few rows of tiles, a field at the end of its step.
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  /// The step nearest to a time. @param time_s  any, beyond the ends too
  void seek(double time_s);
  /// An edited scenario: what the edit does not concern is not computed again; the cached steps are dropped.
  /// What the models refuse goes to status().error, and what was on screen stays. @param scenario  not null
  void setScenario(std::shared_ptr<const scenario::Scenario> scenario);
  /// Another quantity or channel; empty: the first. Colours are fitted anew.
  void setQuantity(const std::string& quantity);

  /// Whether the difference to the reference is shown: LiveOptions::compare, else the scenario as it was
  /// opened, without LiveOptions::edits. Colours are fitted anew. An edit does not compute the reference
  /// again. What cannot be compared, such as indices, goes to status().error, and what was on screen stays.
  void setComparison(bool on);

  void setCamera(const render::CameraSpec& camera);
  void setTransferFunction(const render::TransferFunction& function);
  /// Values out of their range go to status().error, and the settings stay.
  void setSettings(const render::RenderSettings& settings);
  /// A side of 0: nothing is drawn until the next resize.
  void resize(render::ImageSize size);
  /// Of busy frames; none: that which meets the budget.
  void setPattern(std::optional<render::Pattern> pattern);
  void showTerrain(bool show);
  void showEmitters(bool show);
  void setTheme(render::Theme theme);
  /// Whether busy pictures that a GPU casts stay in its memory, for who shows them from there. At first they
  /// do not.
  void keepOnDevice(bool keep);

  /// Colours fitted to the step on screen.
  void fitToStep();
  /// Colours over a range.
  void setRange(const volume::ValueRange& range);
  /// Searches the range of the values over the series, for status().series_range: computes up to 24 steps of
  /// it when nothing else is to be done. What is shown stays.
  void searchSeriesRange();

  /// The latest; null before the first.
  std::shared_ptr<const LivePicture> picture() const;
  LiveStatus status() const;
  /// The changes of status().state since the last call, in their order: who looks now and then sees them all.
  /// At most the last 1000.
  std::vector<StateChange> takeStateChanges();
  /// Steps of the source, ascending; empty before it is open.
  std::vector<double> times_s() const;
  /// As it was set last, or read from the file; null before it is read, and without one.
  std::shared_ptr<const scenario::Scenario> scenario() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace emscape::playback
