#include "render/patterns/frame_controller.h"

#include <algorithm>
#include <limits>

#include "emscape/base/error.h"

namespace emscape::render {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

/// As in Feng et al. 2016: a restoration then takes about epsilon (1:1), 1.33 epsilon (1:3).
double epsilonFactor(Pattern pattern) {
  switch (pattern) {
    case Pattern::full:
    case Pattern::columns:
    case Pattern::checkerboard:
      return 1;
    default:
      return 1.5;
  }
}

}  // namespace

FrameController::FrameController(const ControllerOptions& options)
    : options_(options), choice_(options.budget_ms, options.pattern) {}

void FrameController::event(SceneEvent event, double now_ms) {
  state_ = ControllerState::busy;
  changed_ = true;
  last_event_ms_ = now_ms;
  if (event == SceneEvent::resized || event == SceneEvent::mode) {
    choice_.forget();
    forgetTimes();
  }
}

void FrameController::setOptions(const ControllerOptions& options, double now_ms) {
  options_ = options;
  choice_ = PatternChoice(options.budget_ms, options.pattern);
  event(SceneEvent::mode, now_ms);
}

ControllerAction FrameController::next(double now_ms) {
  using Kind = ControllerAction::Kind;
  ControllerAction action{Kind::wait, plan(), kForever};
  if (doing_ == Doing::restoration && state_ == ControllerState::busy) action.kind = Kind::stop_restore;
  if (doing_ != Doing::nothing || state_ != ControllerState::busy) return action;
  if (changed_) {
    doing_ = Doing::frame;
    changed_ = false;
    drawn_ = action.plan.pattern;
    action.kind = Kind::draw;
  } else if (now_ms < last_event_ms_ + epsilon_ms()) {
    action.until_ms = last_event_ms_ + epsilon_ms();
  } else if (drawn_ == Pattern::full && !options_.smooths_edges) {
    state_ = ControllerState::idle;
  } else {
    doing_ = Doing::restoration;
    state_ = ControllerState::restore;
    action.kind = Kind::restore;
  }
  return action;
}

void FrameController::frameDone(const FrameCost& cost) {
  end(Doing::frame);
  if (warm_up_left_ > 0) {
    --warm_up_left_;
  } else {
    draw_ms_.add(cost.draw_ms);
  }
  if (drawn_ == choice_.pattern() && choice_.add(cost)) draw_ms_.clear();
}

bool FrameController::restoreDone(bool complete) {
  end(Doing::restoration);
  if (state_ != ControllerState::restore) return false;
  state_ = complete ? ControllerState::idle : ControllerState::busy;
  return complete;
}

FramePlan FrameController::plan() const {
  return {choice_.pattern(), options_.interpolation, choice_.tolerance_levels()};
}

double FrameController::epsilon_ms() const {
  if (options_.epsilon_ms) return *options_.epsilon_ms;
  return std::max(options_.epsilon_floor_ms, epsilonFactor(drawn_) * draw_ms_.median());
}

void FrameController::end(Doing doing) {
  if (doing_ != doing) throw Error(ErrorCode::other, "FrameController: end of a frame that was not started");
  doing_ = Doing::nothing;
}

void FrameController::forgetTimes() {
  draw_ms_.clear();
  warm_up_left_ = kWarmUpFrames;
}

}  // namespace emscape::render
