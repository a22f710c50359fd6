#include "playback/live/live_caster.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/stopwatch.h"
#include "emscape/base/error.h"
#include "emscape/base/parallel.h"
#include "playback/live/first_line.h"
#include "playback/pictures/picture_series.h"
#include "playback/view/view_settings.h"

namespace emscape::playback {
namespace {

using render::ControllerAction;
using render::SceneEvent;
using SteadyClock = std::chrono::steady_clock;

constexpr std::size_t kMaxStateChanges = 1000;
/// Interval at which a deferred restoration is tried again.
constexpr std::chrono::milliseconds kDeferral{20};

double between_ms(SteadyClock::time_point begin, SteadyClock::time_point end) {
  return std::chrono::duration<double, std::milli>(end - begin).count();
}

/// A size of 0 draws nothing, but a camera needs one.
ViewState drawable(ViewState view) {
  if (view.size.count() == 0) view.size = {1, 1};
  return view;
}

bool sameBeside(const Frame& a, const Frame& b) {
  if (!a.beside || !b.beside) return !a.beside && !b.beside;
  return sameValues(*a.beside->frame, *b.beside->frame);
}

}  // namespace

LiveCaster::LiveCaster(const ViewRequest& first, const ComputeTarget& target,
                       const render::ControllerOptions& controller, int threads, int niceness, Events events)
    : events_(std::move(events)),
      arena_(threads > 0 ? threads : threadCount(), niceness),
      painter_(drawable(first.view), target, /*must_show_isosurface=*/false),
      controller_options_(controller),
      request_(first) {
  controller_ = render::FrameController(controllerOptions());
  worker_.push([this] { run(); });
}

LiveCaster::~LiveCaster() {
  close();
}

void LiveCaster::close() {
  stop();
  worker_.finish();
}

void LiveCaster::request(ViewRequest request) {
  view_box_.put(std::move(request));
  stop_restoration_ = true;  // after the request is stored: see restore()
}

void LiveCaster::deliver(FieldDelivery delivery, Mailbox<FieldDelivery>::Time asked) {
  field_box_.put(std::move(delivery), asked);
  stop_restoration_ = true;
}

void LiveCaster::stop() {
  closing_ = true;
  stop_restoration_ = true;
  event_.set();
}

CasterStatus LiveCaster::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_;
}

std::vector<StateChange> LiveCaster::takeStateChanges() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(state_changes_, {});
}

void LiveCaster::run() {
  while (!closing_) {
    try {
      takeMail();
      const ControllerAction action = canDraw()
                                          ? controller_.next(now_ms())
                                          : ControllerAction{ControllerAction::Kind::wait, {}, INFINITY};
      if (action.kind == ControllerAction::Kind::restore && defers()) {
        controller_.restoreDone(false);
        event_.waitUntil(SteadyClock::now() + kDeferral);
      } else {
        act(action);
      }
    } catch (const std::exception& error) {
      controller_ = render::FrameController(controllerOptions());
      is_drawing_ = false;
      has_image_ = false;
      fail(failureLine(error));
    }
  }
}

bool LiveCaster::hasMail() const {
  return !view_box_.isEmpty() || !field_box_.isEmpty();
}

void LiveCaster::takeMail() {
  Stopwatch watch;
  auto view = view_box_.take();
  auto field = field_box_.take();
  if (!view && !field) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.error.clear();
  }
  // The field first, because requests for the view refer to the newest field.
  if (field) {
    noteInput(field->since);
    attempt([&] { applyField(field->value); });
  }
  if (view) {
    noteInput(view->since);
    applyView(view->value);
  }
  prepare_ms_ += watch.lap_ms();
  if (field) progress_.column_step = field->value.frame.column_step;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (field) status_.field_revision = progress_.field_revision = field->value.revision;
    if (view) status_.view_revision = view->value.revision;
  }
  if (is_labels_only_ && !is_raised_ && has_image_) {
    shown_input_ = std::exchange(input_, std::nullopt);
    publish();
  }
  is_labels_only_ = false;
  if (!is_raised_) input_.reset();
  publishState();
  events_.changed();
}

void LiveCaster::applyView(const ViewRequest& request) {
  const ViewRequest before = std::exchange(request_, request);
  const ViewState& view = request.view;
  const ViewChange change = changeOf(before.view, view);
  const auto apply = [this](bool differs, SceneEvent event, const auto& set) {
    if (!differs) return;
    attempt([&] {
      set();
      raise(event);
    });
  };
  apply(change.size && view.size.count() > 0, SceneEvent::resized, [&] { painter_.setSize(view.size); });
  apply(change.settings, SceneEvent::mode, [&] { painter_.setSettings(view.settings); });
  apply(change.camera, SceneEvent::view, [&] {
    painter_.setFollowed(view);
    painter_.setCamera(view.camera);
  });
  if (change.colors && (view.transfer || view.range)) {
    attempt([&] {
      if (painter_.setColors(view)) raise(SceneEvent::transfer_function);
    });
  }
  apply(change.split, SceneEvent::view, [&] { painter_.setSplit(view.split); });
  if (change.ground) {
    attempt([&] { painter_.setScenery(view); });
    raise(SceneEvent::mode);  // also without the file that could not be read
  }
  if (change.labels) attempt([&] { painter_.setScenery(view); });
  if (change.labels || request.on_device != before.on_device) changeLabels();
  apply(change.pattern, SceneEvent::mode, [&] {
    controller_options_.pattern = view.pattern;
    controller_.setOptions(controllerOptions(), now_ms());
  });
}

void LiveCaster::applyField(const FieldDelivery& delivery) {
  const bool is_first = !field_;
  const auto nameOf = [](const FieldDelivery& of) { return of.frame.info().quantity; };
  const bool is_other_quantity =
      field_ && (field_->quantity != delivery.quantity || nameOf(*field_) != nameOf(delivery));
  const bool is_other_grid = field_ && field_->frame.grid() != delivery.frame.grid();
  const scenario::TerrainPtr ground = field_ && field_->scene ? field_->scene->terrain : nullptr;
  const bool is_other_ground = ground != (delivery.scene ? delivery.scene->terrain : nullptr);
  const bool is_same_field = !is_first && !is_other_ground && sameValues(field_->frame, delivery.frame) &&
                             sameBeside(field_->frame, delivery.frame);
  const render::Camera before = is_first ? render::Camera{} : painter_.camera();
  painter_.setScene(delivery.title, delivery.scene ? &*delivery.scene : nullptr);
  field_ = delivery;
  changeLabels();
  std::exception_ptr refused;
  try {
    painter_.setFrame(delivery.frame);
  } catch (const Error&) {
    refused = std::current_exception();
    if (!painter_.hasColors()) {  // not from the file: as without one
      painter_.setColors({});
      painter_.setFrame(delivery.frame);
    }
  }
  if (is_first && delivery.frame.cells) controller_.setOptions(controllerOptions(), now_ms());
  if (!is_same_field) {
    raise(is_other_grid ? SceneEvent::resized : SceneEvent::field);
  } else if (before.eye_m != painter_.camera().eye_m || before.forward != painter_.camera().forward) {
    raise(SceneEvent::view);  // it follows a platform
  }
  if (is_other_quantity && !is_same_field) painter_.setColors({});  // else it only has another name
  if (refused) std::rethrow_exception(refused);
}

void LiveCaster::attempt(const std::function<void()>& change) {
  try {
    change();
  } catch (const std::exception& error) {
    fail(failureLine(error));
  }
}

void LiveCaster::raise(SceneEvent event) {
  is_raised_ = true;
  progress_.complete = false;
  countScene();
  if (canDraw()) controller_.event(event, now_ms());
}

void LiveCaster::countScene() {
  ++progress_.scene;
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.scene = progress_.scene;
}

void LiveCaster::changeLabels() {
  is_labels_only_ = true;
  countScene();
}

void LiveCaster::noteInput(Time since) {
  input_ = input_ ? std::min(*input_, since) : since;
}

bool LiveCaster::canDraw() const {
  return painter_.hasFrame() && request_.view.size.count() > 0;
}

render::ControllerOptions LiveCaster::controllerOptions() const {
  render::ControllerOptions options = controller_options_;
  const bool has_cells = field_ && field_->frame.cells;
  options.smooths_edges = !has_cells;
  if (has_cells && !options.pattern)
    options.pattern = painter_.projectsCells() ? render::Pattern::columns : render::Pattern::full;
  return options;
}

void LiveCaster::act(const ControllerAction& action) {
  const bool settles = controller_.state() == render::ControllerState::idle && progress_.complete;
  if (settles && has_image_ && !finished_is_exact_) publish();
  publishState();
  switch (action.kind) {
    case ControllerAction::Kind::draw:
      drawFrame(action.plan);
      break;
    case ControllerAction::Kind::restore:
      restore();
      break;
    case ControllerAction::Kind::stop_restore:  // restorations end before events are reported
      break;
    case ControllerAction::Kind::wait:
      if (std::isinf(action.until_ms)) {
        event_.wait();
      } else {
        event_.waitUntil(start_ + std::chrono::duration_cast<SteadyClock::duration>(
                                      std::chrono::duration<double, std::milli>(action.until_ms)));
      }
      const std::lock_guard<std::mutex> lock(mutex_);
      ++status_.wake_ups;
      break;
  }
}

void LiveCaster::drawFrame(const render::FramePlan& plan) {
  is_drawing_ = true;
  const Time begin = SteadyClock::now();
  is_raised_ = false;
  shown_input_ = std::exchange(input_, std::nullopt);
  input_to_frame_ms_ = shown_input_ ? between_ms(*shown_input_, begin) : 0;
  arena_.run([&] { drawn_ = painter_.draw(plan, &closing_); });
  has_image_ = drawn_.complete;
  if (drawn_.complete) {
    progress_.complete = drawn_.pattern == render::Pattern::full && !controllerOptions().smooths_edges;
    publish();
  }
  const double other_ms =
      std::exchange(prepare_ms_, 0) + between_ms(begin, SteadyClock::now()) - drawn_.total_ms();
  controller_.frameDone({drawn_.total_ms(), std::max(other_ms, 0.0),
                         static_cast<double>(drawn_.rays) / static_cast<double>(request_.view.size.count())});
  is_drawing_ = false;
}

void LiveCaster::restore() {
  is_drawing_ = true;
  stop_restoration_ = false;
  // Requests are stored before the flag is set: one that arrived before the line above is in its mailbox.
  if (hasMail() || closing_) stop_restoration_ = true;
  render::FrameReport restored;
  arena_.run([&] { restored = painter_.restore(&stop_restoration_, render::Edges::smooth); });
  is_drawing_ = false;
  has_image_ = restored.complete;
  if (controller_.restoreDone(restored.complete)) {
    progress_.complete = true;
    publishState();
    publish();
  }
}

void LiveCaster::publish() {
  Stopwatch watch;
  LivePicture picture;
  arena_.run([&] {
    const render::Pattern pattern = progress_.complete ? render::Pattern::full : drawn_.pattern;
    const std::string note = painter_.note(pattern);
    // The float picture takes longer to transfer from a GPU; in busy frames the quantised one is sufficient.
    finished_is_exact_ = progress_.complete && (controller_.state() != render::ControllerState::busy ||
                                                painter_.backend() == Backend::cpu);
    if (finished_is_exact_) {
      picture.finished = painter_.picture(note);
      painter_.fetch(picture.image);
      return;
    }
    if (request_.on_device) picture.on_device = painter_.annotatedOnDevice(note);
    if (picture.on_device) return;
    painter_.fetch(busy_image_);
    picture.finished = painter_.annotated(busy_image_, note);
  });
  picture.size = painter_.size();
  const double labels_ms = watch.lap_ms();
  picture.camera = painter_.camera();
  picture.box = painter_.sceneBox();
  picture.annotations = painter_.annotations();
  picture.transfer = painter_.transferFunction();
  picture.settings = painter_.settings();
  static_cast<ShownField&>(picture) = field_->frame;
  picture.split_column = painter_.splitColumn();
  if (picture.split_column > 0) picture.beside = field_->frame.beside->frame;
  picture.has_field = field_->frame.has_field;
  if (field_->scene) {
    picture.scenario = field_->scene->scenario;
    picture.terrain = field_->scene->terrain;
  }
  picture.ground = painter_.heightField();
  LiveStatus& status = picture.status;
  status.pattern = drawn_.pattern;
  status.rays_fraction = static_cast<double>(drawn_.rays) / static_cast<double>(picture.size.count());
  status.cast_ms = drawn_.total_ms();
  if (painter_.cellPicture()) status.cells = painter_.cellPicture()->text();
  status.labels_ms = labels_ms;
  status.shown_s = picture.info().time_s;
  status.column_step = field_->frame.column_step;
  if (shown_input_) {
    status.input_to_picture_ms = between_ms(*shown_input_, SteadyClock::now());
    status.input_to_frame_ms = input_to_frame_ms_;
  }
  shown_input_.reset();
  events_.publish(std::move(picture), progress_);
}

void LiveCaster::publishState() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (status_.state == controller_.state()) return;
    status_.state = controller_.state();
    if (state_changes_.size() >= kMaxStateChanges) state_changes_.erase(state_changes_.begin());
    state_changes_.push_back({status_.state, SteadyClock::now()});
    status_.reason = controller_.reason();
  }
  events_.changed();
}

void LiveCaster::fail(const std::string& what) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.error = what;
  }
  events_.changed();
}

double LiveCaster::now_ms() const {
  return between_ms(start_, SteadyClock::now());
}

}  // namespace emscape::playback
