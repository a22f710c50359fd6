/// Edits of a scenario that are read and checked beside the thread that asks for them.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emscape/playback/edit_history.h"
#include "playback/latest_worker.h"

namespace emscape::playback {

/// Carries out changes of an EditHistory in the order in which they were asked for. To read a large scenario
/// again takes longer than a frame of a window: that is done on a thread of this object, everything else in
/// update(). Of the moves of a drag that are not begun only the last is made. One thread uses it.
class EditQueue {
 public:
  /// What came of set() or drag().
  struct Outcome {
    std::vector<scenario::Edit> edits;
    std::string error;  ///< empty: they are made; else all faults, and nothing is changed
  };

  /// @param wake  called on the thread of this object when update() has something to do; may be empty
  explicit EditQueue(std::function<void()> wake);

  /// As the functions of EditHistory.
  void set(std::vector<scenario::Edit> edits) { push({Kind::set, std::move(edits), {}}); }
  /// The same as a part of one drag, which the first call begins.
  void drag(std::vector<scenario::Edit> edits);
  void endDrag();
  void cancelDrag();
  /// Calls back from update() when all that was asked for before is done.
  void then(std::function<void()> callback) { push({Kind::callback, {}, std::move(callback)}); }

  /// Between the first drag() and the end of the drag.
  bool isDragging() const { return is_dragging_; }
  /// True if anything that was asked for is still to be done.
  bool isBusy() const { return !waiting_.empty(); }
  /// Makes what can be made now. @return the edits that have been made or refused since the last call
  std::vector<Outcome> update(EditHistory& history);
  /// Forgets what has not been done.
  void clear();

 private:
  enum class Kind { set, move, begin_drag, end_drag, cancel_drag, callback };
  struct Operation {
    Kind kind;
    std::vector<scenario::Edit> edits;
    std::function<void()> callback;
  };
  struct Request {
    long long number;
    ScenarioPtr base;
    std::vector<scenario::Edit> edits;
  };
  struct Result {
    long long number;
    ScenarioPtr base, edited;  ///< edited is null if the edits are refused
    std::string error;
  };

  void push(Operation operation) { waiting_.push_back(std::move(operation)); }
  bool makeEdits(EditHistory& history, std::vector<Outcome>& outcomes);

  std::deque<Operation> waiting_;
  bool is_asked_ = false;  // the first one that waits is under way
  bool is_dragging_ = false;
  long long number_ = 0;
  LatestWorker<Request, Result> worker_;
};

}  // namespace emscape::playback
