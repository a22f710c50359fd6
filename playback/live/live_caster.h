/// The thread of a live view that draws. Internal to the module.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "base/thread_arena.h"
#include "base/worker.h"
#include "emscape/playback/pictures/painter.h"
#include "playback/live/live_fields.h"
#include "playback/live/live_view.h"
#include "playback/live/mailbox.h"
#include "render/patterns/frame_controller.h"

namespace emscape::playback {

/// A request for the view.
struct ViewRequest {
  long long revision = 0;  ///< counts requests
  ViewState view;
  bool on_device = false;  ///< LiveView::keepOnDevice()
};

struct CasterStatus {
  render::ControllerState state = render::ControllerState::idle;
  std::string reason;
  long long scene = 0;          ///< counts changes of the scene
  long long view_revision = 0;  ///< of the last requests that were taken
  long long field_revision = 0;
  std::string error;
  long long wake_ups = 0;
};

/// Progress of a picture.
struct PictureProgress {
  long long scene = 0;           ///< that it shows
  bool complete = false;         ///< all of its pixels are cast
  long long field_revision = 0;  ///< of the request for its field
  int column_step = 1;           ///< of its field: Frame::column_step
};

/// Draws the last request: the state machine of render::FrameController on a separate thread.
class LiveCaster {
 public:
  struct Events {
    /// Receives the picture, with the status known to this thread.
    std::function<void(LivePicture, PictureProgress)> publish;
    std::function<void()> changed;  ///< of the status
    /// True while a field is computed that restorations leave the processor to; empty: never.
    std::function<bool()> is_field_hurried;
  };

  /// @param threads   of loops; 0: all
  /// @param niceness  of the threads
  /// @throws Error (bad_input, device)
  LiveCaster(const ViewRequest& first, const ComputeTarget& target,
             const render::ControllerOptions& controller, int threads, int niceness, Events events);
  ~LiveCaster();
  LiveCaster(const LiveCaster&) = delete;
  LiveCaster& operator=(const LiveCaster&) = delete;

  /// Any thread calls these.
  void request(ViewRequest request);
  /// Stops a restoration, which begins again when no field is hurried.
  void defer() { stop_restoration_ = true; }
  void deliver(FieldDelivery delivery, Mailbox<FieldDelivery>::Time asked);
  /// Stops the work in progress soon.
  void stop();
  /// stop(), and waits for the end.
  void close();
  bool isDrawing() const { return is_drawing_; }
  CasterStatus status() const;
  /// See LiveView.
  std::vector<StateChange> takeStateChanges();

 private:
  using Time = std::chrono::steady_clock::time_point;

  void run();
  // Requests
  bool hasMail() const;
  void takeMail();
  void applyView(const ViewRequest& request);
  void applyField(const FieldDelivery& delivery);
  /// Makes a change; exceptions become the error of the status.
  void attempt(const std::function<void()>& change);
  void raise(render::SceneEvent event);
  void changeLabels();
  void countScene();
  void noteInput(Time since);
  // Requests of the controller
  bool canDraw() const;
  bool defers() const { return events_.is_field_hurried && events_.is_field_hurried(); }
  /// Tetrahedra have no patterns: incomplete pictures are projected, or there are none.
  render::ControllerOptions controllerOptions() const;
  void act(const render::ControllerAction& action);
  void drawFrame(const render::FramePlan& plan);
  void restore();
  void publish();
  void publishState();
  void fail(const std::string& what);
  double now_ms() const;

  const Events events_;
  Event event_;
  Mailbox<ViewRequest> view_box_{event_};
  Mailbox<FieldDelivery> field_box_{event_};
  StopFlag stop_restoration_{false};
  StopFlag closing_{false};
  std::atomic<bool> is_drawing_{false};

  // Of the thread
  const Time start_ = std::chrono::steady_clock::now();
  ThreadArena arena_;
  Painter painter_;
  render::ControllerOptions controller_options_;
  render::FrameController controller_;
  ViewRequest request_;
  std::optional<FieldDelivery> field_;
  PictureProgress progress_;     // of the picture
  bool is_labels_only_ = false;  // the next picture only needs new labels
  bool is_raised_ = false;       // an event since the last frame was begun
  std::optional<Time> input_;    // the oldest input that no picture shows yet
  double input_to_frame_ms_ = 0;
  double prepare_ms_ = 0;            // since the last frame
  render::FrameReport drawn_;        // the busy frame
  bool has_image_ = false;           // the last picture can be shown again
  bool finished_is_exact_ = true;    // the last published picture was not quantised before its labels
  render::Image8 busy_image_;        // memory for a picture on the way to its labels
  std::optional<Time> shown_input_;  // input that the next picture is the first to show

  mutable std::mutex mutex_;
  CasterStatus status_;
  std::vector<StateChange> state_changes_;

  Worker worker_;
};

}  // namespace emscape::playback
