#include "playback/pictures/real_time_loop.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "emscape/base/error.h"
#include "emscape/base/work.h"

namespace emscape::playback {
namespace {

using render::ControllerAction;
using render::ControllerState;
using render::SceneEvent;

bool sameBits(const render::Image& a, const render::Image& b) {
  return a.size == b.size &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(render::Rgba)) == 0;
}

}  // namespace

RealTimeLoop::RealTimeLoop(const RealTimeOptions& options, const ViewState& view, FrameSource& source,
                           Painter& painter, Display display, Clock& clock, const StopFlag* interrupt)
    : options_(options),
      view_(view),
      source_(source),
      display_(std::move(display)),
      clock_(clock),
      interrupt_(interrupt),
      controller_(options.controller),
      painter_(painter),
      period_ms_(1000 / options.frames_per_s) {
  if (options.orbit_rate_deg_s != 0 && view.camera.kind != render::CameraSpec::Kind::orbit) {
    throw Error(ErrorCode::usage, "a rotating camera must be an orbit");
  }
  report_.frames_per_s = options.frames_per_s;
}

RealTimeLoop::~RealTimeLoop() {
  stop_ = true;
}

RealTimeReport RealTimeLoop::play(const std::function<void(const RealTimeEvent&)>& done) {
  done_ = done;
  beginField(0, true);
  pending_ = field_.take();
  rehearse();
  start_ms_ = clock_.now_ms();
  raise(SceneEvent::field);
  for (double now = 0; now < end_ms(); now = now_ms()) {
    throwIfStopped(interrupt_);
    takeField();
    raiseEvents();
    if (restoration_.done()) endRestoration();
    act(controller_.next(now_ms()));
  }
  if (restoration_.active()) {
    stop_ = true;
    endRestoration();
  }
  if (field_.active()) field_.take();
  report_.seconds = now_ms() / 1000;
  report_.epsilon_ms = controller_.epsilon_ms();
  RealTimeEvent none;
  countSlots(slotAt(end_ms()) - 1, none);
  if (display_) passOn(end_ms());
  return std::move(report_);
}

render::FrameCost RealTimeLoop::costOf(const render::FrameReport& frame, double other_ms) const {
  return {frame.total_ms(), other_ms,
          static_cast<double>(frame.rays) / static_cast<double>(view_.size.count())};
}

double RealTimeLoop::now_ms() const {
  return clock_.now_ms() - start_ms_ - stood_still_ms_;
}

long long RealTimeLoop::slotAt(double time_ms) const {
  return static_cast<long long>(std::floor(time_ms / period_ms_));
}

double RealTimeLoop::slotBegin_ms(long long slot) const {
  return static_cast<double>(slot) * period_ms_;
}

int RealTimeLoop::stepDueAt(long long slot) const {
  const double time_s = source_.time_s(0) + slotBegin_ms(slot) / 1000 * options_.speed;
  constexpr double kRounding_s = 1e-9;
  int step = shown_step_;
  while (step > 0 && source_.time_s(step) > time_s + kRounding_s) --step;
  while (step + 1 < source_.count() && source_.time_s(step + 1) <= time_s + kRounding_s) ++step;
  return step;
}

bool RealTimeLoop::isDue(long long slot) const {
  if (slot == 0 || options_.orbit_rate_deg_s != 0) return true;
  const int step = stepDueAt(slot);
  return step != stepDueAt(slot - 1) && unchanged_steps_.count(step) == 0;
}

double RealTimeLoop::end_ms() const {
  if (options_.duration_s) return *options_.duration_s * 1000;
  const int last = source_.count() - 1;
  const double length_s = source_.time_s(last) - source_.time_s(0);
  const double step_s = last > 0 ? length_s / last : 1;
  return (length_s + step_s) / options_.speed * 1000;
}

void RealTimeLoop::waitUntil(double time_ms) {
  const double until_ms = std::min({time_ms, slotBegin_ms(slotAt(now_ms()) + 1), end_ms()});
  clock_.waitUntil(start_ms_ + stood_still_ms_ + until_ms, event_);
}

/// Time of a field with which each step is shown in time; 0: as long as it takes.
double RealTimeLoop::fieldGoal_ms() const {
  const int last = source_.count() - 1;
  if (options_.whole_fields || last == 0) return 0;
  const double apart_ms = (source_.time_s(last) - source_.time_s(0)) / last / options_.speed * 1000;
  const double between_ms = std::max(period_ms_, apart_ms);
  constexpr double kOfField = 0.9;  // the rest is for what surrounds the field
  return kOfField * std::max(between_ms / 4, between_ms - drawing_ms_);
}

/// @param is_whole  with all columns
void RealTimeLoop::beginField(int step, bool is_whole) {
  event_.begin();
  field_.start([this, step, goal_ms = is_whole ? 0 : fieldGoal_ms()] {
    const double begin_ms = clock_.now_ms();
    NewField field;
    source_.setTimeGoal(goal_ms);
    field.step = step;
    field.frame = source_.frame(step);
    field.ms = clock_.now_ms() - begin_ms;
    return field;
  });
}

/// Begins the step that will be due when it is computed; only later steps than the present one, or the
/// missing columns of that one.
void RealTimeLoop::beginNextField() {
  const int newest = pending_ ? pending_->step : shown_step_;
  if (field_.active() || computed_) return;
  if (std::exchange(needs_whole_, false)) return beginField(newest, true);
  if (newest + 1 >= source_.count()) return;
  const double now = now_ms();
  const long long slot = std::max(slotAt(now) + 1, slotAt(now + field_ms_));
  const int step = std::max(newest + 1, stepDueAt(slot));
  report_.field_steps_skipped += step - newest - 1;
  beginField(step, false);
}

/// Draws the first picture a few times, so that camera and colours are fitted, memory is allocated and the
/// pattern is chosen before the clock starts.
void RealTimeLoop::rehearse() {
  painter_.setFrame(pending_->frame);
  constexpr int kFrames = 4;
  for (int n = 0; n < kFrames; ++n) {
    controller_.event(SceneEvent::field, 0);
    painter_.setAzimuth(view_.camera.azimuth_deg);
    controller_.frameDone(costOf(painter_.draw(controller_.next(0).plan), 0));
  }
}

void RealTimeLoop::takeField() {
  if (!field_.done()) return;
  computed_ = field_.take();
  const Frame& frame = computed_->frame;
  field_ms_ = computed_->ms;
  needs_whole_ = frame.column_step > 1 && (!frame.changed || computed_->step + 1 == source_.count());
}

void RealTimeLoop::raise(SceneEvent event) {
  const bool stops = controller_.state() == ControllerState::restore;
  controller_.event(event, now_ms());
  settled_ = false;
  if (stops) event_ms_ = now_ms();
}

/// At most once in a slot: events between two frames could not be shown.
void RealTimeLoop::raiseEvents() {
  const long long slot = slotAt(now_ms());
  if (slot <= begun_slot_) return;
  if (computed_ && computed_->step <= stepDueAt(slot)) {
    pending_ = std::exchange(computed_, std::nullopt);
    if (pending_->frame.changed) {
      raise(SceneEvent::field);
    } else {
      unchanged_steps_.insert(pending_->step);
    }
  }
  if (options_.orbit_rate_deg_s != 0 && slot > view_slot_) {
    view_slot_ = slot;
    raise(SceneEvent::view);
  }
}

void RealTimeLoop::act(const ControllerAction& action) {
  switch (action.kind) {
    case ControllerAction::Kind::draw:
      drawFrame(action.plan);
      break;
    case ControllerAction::Kind::restore:
      beginRestoration();
      break;
    case ControllerAction::Kind::stop_restore:
      stop_ = true;
      endRestoration();
      break;
    case ControllerAction::Kind::wait:
      if (controller_.state() == ControllerState::idle) settle();
      waitUntil(action.until_ms);
      break;
  }
}

void RealTimeLoop::drawFrame(const render::FramePlan& plan) {
  RealTimeEvent event;
  const double begin_ms = now_ms();
  const long long slot = slotAt(begin_ms);
  begun_slot_ = slot;
  if (event_ms_) event.abort_latency_ms = begin_ms - *std::exchange(event_ms_, std::nullopt);
  if (pending_) {
    const bool is_completion = report_.field_updates > 0 && pending_->step == shown_step_;
    if (is_completion && !isDue(slot)) ++report_.due;
    painter_.setFrame(pending_->frame);
    shown_step_ = pending_->step;
    event.field_ms = pending_->ms;
    event.column_step = pending_->frame.column_step;
    ++report_.field_updates;
    report_.field_updates_interpolated += event.column_step > 1 ? 1 : 0;
    pending_.reset();
  }
  if (options_.orbit_rate_deg_s != 0) {
    painter_.setAzimuth(view_.camera.azimuth_deg + options_.orbit_rate_deg_s * slotBegin_ms(slot) / 1000);
  }
  event.prepare_ms = now_ms() - begin_ms;
  drawn_ = painter_.draw(plan);
  drawing_ms_ = now_ms() - begin_ms;
  beginNextField();  // in parallel, in the remaining time of the slot
  event.labels_ms = show();
  event.rays = drawn_.rays;
  event.cast_ms = drawn_.cast_ms;
  event.interpolate_ms = drawn_.interpolate_ms;
  event.restored = drawn_.pattern == render::Pattern::full;
  if (reported_pattern_ != drawn_.pattern) event.reason = controller_.reason();
  reported_pattern_ = drawn_.pattern;
  countSlots(slot, event);
  report(event);
  controller_.frameDone(costOf(drawn_, event.prepare_ms + std::max(event.field_ms, event.labels_ms)));
}

void RealTimeLoop::beginRestoration() {
  stop_ = false;
  event_.begin();
  restoration_.start([this] { return painter_.restore(&stop_); });
}

void RealTimeLoop::endRestoration() {
  const render::FrameReport restored = restoration_.take();
  RealTimeEvent event;
  event.state = ControllerState::restore;
  event.rays = restored.rays;
  event.cast_ms = restored.cast_ms;
  event.restored = controller_.restoreDone(restored.complete);
  if (event.restored) event.labels_ms = show();
  report(event);
}

/// The picture is exact from now on.
void RealTimeLoop::settle() {
  if (pending_) {  // the field is unchanged, but not the time
    painter_.setFrame(pending_->frame);
    shown_step_ = pending_->step;
    pending_.reset();
    beginNextField();
    show();
  }
  if (settled_) return;
  settled_ = true;
  RealTimeEvent event;
  event.state = ControllerState::idle;
  event.restored = true;
  if (options_.verify) {
    const double begin_ms = clock_.now_ms();
    const render::Image& settled = painter_.image();
    event.equals_full = sameBits(settled, painter_.fullCast());
    stood_still_ms_ += clock_.now_ms() - begin_ms;
  }
  report(event);
}

/// Counts slots up to this one, in which a frame was drawn: late if it came after the last slot that
/// requested it.
void RealTimeLoop::countSlots(long long slot, RealTimeEvent& event) {
  for (long long s = accounted_slot_ + 1; s <= slot; ++s) {
    if (!isDue(s)) continue;
    ++report_.due;
    event.late = now_ms() > slotBegin_ms(s + 1);
  }
  accounted_slot_ = std::max(accounted_slot_, slot);
}

/// Displays the picture. @return its time (ms)
double RealTimeLoop::show() {
  if (!display_) return 0;
  const double begin_ms = clock_.now_ms();
  render::Image8 picture = painter_.picture(
      fmt::format("{} rays, {}", render::toString(drawn_.pattern), render::toString(controller_.state())));
  const bool is_first = !displayed_;
  passOn(now_ms());
  displayed_ = std::move(picture);
  if (is_first) displayed_since_ = 0;
  return clock_.now_ms() - begin_ms;
}

/// Ends the display of the present picture.
void RealTimeLoop::passOn(double now_ms) {
  const long long slot = slotAt(std::min(now_ms, end_ms()));
  if (displayed_) display_(*displayed_, static_cast<int>(slot - displayed_since_));
  displayed_since_ = slot;
}

void RealTimeLoop::report(RealTimeEvent event) {
  event.time_ms = now_ms();
  event.scenario_s = source_.time_s(shown_step_);
  event.pattern = drawn_.pattern;
  done_(event);
  report_.totals.add(event);
  if (options_.keep_events) report_.events.push_back(std::move(event));
}

}  // namespace emscape::playback
