/// Undo and redo of whole states. A drag is one step.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace emscape::playback {

/// The current state and those before and after it. State is copied at every step: use a small value or a
/// shared pointer. For one thread.
template <class State>
class UndoStack {
 public:
  explicit UndoStack(State state, std::size_t max_steps = 1000)
      : state_(std::move(state)), max_steps_(max_steps) {}

  const State& state() const { return state_; }

  /// Adds a step; undone steps are discarded. Within a drag, the step is the whole drag.
  void set(State next) {
    if (!drag_) push(state_);
    state_ = std::move(next);
  }

  /// All changes until endDrag() or cancelDrag() are one step. An open drag is ended first.
  void beginDrag() {
    endDrag();
    drag_ = state_;
  }
  void endDrag() {
    if (drag_) push(*std::exchange(drag_, std::nullopt));
  }
  /// Returns to the state at the beginning of the drag; the drag makes no step.
  void cancelDrag() {
    if (drag_) state_ = *std::exchange(drag_, std::nullopt);
  }
  /// The state at the beginning of the drag; null if there is none.
  const State* dragged() const { return drag_ ? &*drag_ : nullptr; }

  /// Number of steps ever made. The owner of several stacks uses it to order their steps.
  long long stepsMade() const { return steps_made_; }
  /// Number of steps that can be undone; an open drag is not counted.
  std::size_t stepsBack() const { return past_.size(); }
  /// Forgets the oldest steps, so that at most this many can be undone.
  void keep(std::size_t steps) {
    if (past_.size() > steps) past_.erase(past_.begin(), past_.end() - static_cast<std::ptrdiff_t>(steps));
  }
  bool canUndo() const { return !past_.empty() || drag_; }
  bool canRedo() const { return !future_.empty() && !drag_; }
  /// Number of steps to another state, latest first: negative by undo(), positive by redo(); 0: there is
  /// none.
  int stepsTo(const State& state) const {
    const auto stepsIn = [&](const std::vector<State>& states) {
      const auto found = std::find(states.rbegin(), states.rend(), state);
      return found == states.rend() ? 0 : static_cast<int>(found - states.rbegin()) + 1;
    };
    const int back = stepsIn(past_);
    return back > 0 ? -back : stepsIn(future_);
  }
  /// Goes back one step; an open drag is that step. No effect if there is none.
  void undo() {
    endDrag();
    move(past_, future_);
  }
  /// Goes forward one step. No effect if there is none.
  void redo() {
    endDrag();
    move(future_, past_);
  }

 private:
  void push(State before) {
    past_.push_back(std::move(before));
    keep(max_steps_);
    future_.clear();
    ++steps_made_;
  }
  void move(std::vector<State>& from, std::vector<State>& to) {
    if (from.empty()) return;
    to.push_back(std::exchange(state_, std::move(from.back())));
    from.pop_back();
  }

  State state_;
  std::size_t max_steps_;
  std::optional<State> drag_;  ///< the state at its beginning
  std::vector<State> past_, future_;
  long long steps_made_ = 0;
};

}  // namespace emscape::playback
