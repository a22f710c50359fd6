/// Edits of a scenario that are read and checked on a background thread.
#pragma once

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "base/worker.h"
#include "playback/editing/edit_history.h"

namespace emscape::playback {

/// Executes changes of an EditHistory in the order of the requests. Reading a large scenario again takes
/// longer than a frame of a window: it is done on a thread of this object, everything else in update(). Of
/// the pending moves of a drag only the last is made. For one thread.
class EditQueue {
 public:
  /// Result of set() or drag().
  struct Outcome {
    std::vector<scenario::Edit> edits;
    std::string error;  ///< empty: success; else all faults, with nothing changed
  };

  /// @param wake  called on the thread of this object when update() has something to do; may be empty
  explicit EditQueue(std::function<void()> wake) : task_(std::move(wake)) {}

  /// As the functions of EditHistory.
  void set(std::vector<scenario::Edit> edits) { push({Kind::set, std::move(edits), {}}); }
  /// Replaces all edits of the scenario's file by these, as one step.
  void replace(std::vector<scenario::Edit> edits) { push({Kind::replace, std::move(edits), {}}); }
  /// As set(), as a part of one drag, which the first call begins.
  void drag(std::vector<scenario::Edit> edits);
  void endDrag();
  void cancelDrag();
  /// Calls back from update() when all earlier requests are done.
  void then(std::function<void()> callback) { push({Kind::callback, {}, std::move(callback)}); }

  /// True between the first drag() and the end of the drag.
  bool isDragging() const { return is_dragging_; }
  /// True if a request is pending.
  bool isBusy() const { return !waiting_.empty(); }
  /// Begins with the first request before the next update(), if it is an edit and no other one is in
  /// progress.
  void begin(const EditHistory& history);
  /// Executes the operations that are ready. @return the edits made or refused since the last call
  std::vector<Outcome> update(EditHistory& history);
  /// Drops all pending requests, and takes back a drag that is open.
  void clear(EditHistory& history);

 private:
  enum class Kind { set, replace, move, begin_drag, end_drag, cancel_drag, callback };
  struct Operation {
    Kind kind;
    std::vector<scenario::Edit> edits;
    std::function<void()> callback;
  };
  struct Result {
    ScenarioPtr base, edited;  ///< edited is null if the edits are refused
    std::string error;
  };

  static bool isEdit(Kind kind) { return kind == Kind::set || kind == Kind::replace || kind == Kind::move; }
  void push(Operation operation) { waiting_.push_back(std::move(operation)); }
  bool makeEdits(EditHistory& history, std::vector<Outcome>& outcomes);

  std::deque<Operation> waiting_;
  bool is_asked_ = false;  // the first pending one is in progress
  bool is_dragging_ = false;
  AsyncTasks<Result> task_;
};

}  // namespace emscape::playback
