#include "playback/live/edit_queue.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "base/text/failure_text.h"
#include "emscape/scenario/file/scenario_file.h"
#include "playback/editing/renamed_items.h"

namespace emscape::playback {
namespace {

bool haveSamePaths(const std::vector<scenario::Edit>& a, const std::vector<scenario::Edit>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const scenario::Edit& x, const scenario::Edit& y) { return x.path == y.path; });
}

/// The same scenario with as few edits as have its text: several names in a row are one edit.
ScenarioPtr withNetEdits(const ScenarioPtr& edited) {
  const std::vector<scenario::Edit> edits = edited->edits(), net = foldedEdits(edits);
  if (net.size() == edits.size()) return edited;
  try {
    const ScenarioPtr same = scenario::withEdits(*edited, net);
    return same->hash == edited->hash ? same : edited;
  } catch (const Error&) {
    return edited;
  }
}

}  // namespace

void EditQueue::drag(std::vector<scenario::Edit> edits) {
  if (!std::exchange(is_dragging_, true)) push({Kind::begin_drag, {}, {}});
  const bool is_begun = is_asked_ && waiting_.size() == 1;
  if (!waiting_.empty() && !is_begun && waiting_.back().kind == Kind::move &&
      haveSamePaths(waiting_.back().edits, edits)) {
    waiting_.back().edits = std::move(edits);
  } else {
    push({Kind::move, std::move(edits), {}});
  }
}

void EditQueue::endDrag() {
  if (std::exchange(is_dragging_, false)) push({Kind::end_drag, {}, {}});
}

void EditQueue::cancelDrag() {
  if (std::exchange(is_dragging_, false)) push({Kind::cancel_drag, {}, {}});
}

void EditQueue::clear(EditHistory& history) {
  history.cancelDrag();
  waiting_.clear();
  is_asked_ = is_dragging_ = false;
}

/// @return true if the first operation, which makes edits, is finished
bool EditQueue::makeEdits(EditHistory& history, std::vector<Outcome>& outcomes) {
  if (task_.active()) {
    if (!task_.done()) return false;
    const Result result = task_.take();
    if (std::exchange(is_asked_, false) && result.base == history.scenario()) {
      if (result.edited) history.adopt(result.edited);
      outcomes.push_back({std::move(waiting_.front().edits), result.error});
      return true;
    }
  }
  begin(history);
  return false;
}

void EditQueue::begin(const EditHistory& history) {
  if (waiting_.empty() || !isEdit(waiting_.front().kind) || task_.active()) return;
  const bool replaces = waiting_.front().kind == Kind::replace;
  task_.start([base = history.scenario(), edits = waiting_.front().edits, replaces] {
    Result result{base, nullptr, ""};
    try {
      result.edited = replaces ? scenario::withEdits(*base, edits) : withNetEdits(edited(base, edits));
    } catch (const std::exception& error) {
      result.error = failureText(error);
    }
    return result;
  });
  is_asked_ = true;
}

std::vector<EditQueue::Outcome> EditQueue::update(EditHistory& history) {
  std::vector<Outcome> outcomes;
  for (; !waiting_.empty(); waiting_.pop_front()) {
    switch (waiting_.front().kind) {
      case Kind::set:
      case Kind::replace:
      case Kind::move:
        if (!makeEdits(history, outcomes)) return outcomes;
        break;
      case Kind::begin_drag:
        history.beginDrag();
        break;
      case Kind::end_drag:
        history.endDrag();
        break;
      case Kind::cancel_drag:
        history.cancelDrag();
        break;
      case Kind::callback:
        waiting_.front().callback();
        break;
    }
  }
  return outcomes;
}

}  // namespace emscape::playback
