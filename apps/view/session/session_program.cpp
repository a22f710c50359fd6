/// The program's state, and the verb that cancels it.
#include <fmt/format.h>

#include <cmath>

#include "apps/view/session/session.h"
#include "emscape/base/error.h"

namespace emscape::view {

ProgramState Session::programState() const {
  ProgramFacts facts;
  facts.has_input = hasInput();
  facts.has_picture = picture_ != nullptr;
  facts.has_field = hasField();
  facts.is_playing = timeline_.playing();
  facts.rate = timeline_.rate();
  facts.stream = stream_.text;
  facts.has_pending_edits = edit_queue_.isBusy();
  if (computing_from_s_) facts.computing_s = log_.now_s() - *computing_from_s_;
  if (files_->is_opening) facts.opening = files_->opening;
  return view::programState(facts, status_);
}

/// Logs a change of the state. Called after each command and each update.
void Session::noteProgram() {
  const bool computes = status_.computing || status_.searching || edit_queue_.isBusy();
  if (!computes) {
    computing_from_s_.reset();
  } else if (!computing_from_s_) {
    computing_from_s_ = log_.now_s();
  }
  const ProgramState state = programState();
  noted_words_ = state.badge + state.what + state.picture;
  if (!is_on_screen_) return;
  const Activity before = std::exchange(logged_activity_, state.activity);
  if (before == state.activity) return;
  log_.write(
      "program",
      {{"from", emscape::toString(before)}, {"to", emscape::toString(state.activity)}, {"what", state.what}});
}

void Session::cancel() {
  if (files_->is_opening || (hasInput() && !picture_)) {
    files_->cancels_opening = true;
    wake_();
    return;
  }
  const ProgramState state = programState();
  if (!state.can_cancel) throw Error(ErrorCode::bad_input, "cancel: nothing is being computed or opened");
  timeline_.pause();
  if (edits_) {
    edit_queue_.clear(*edits_);
    if (edits_->scenario() != shown_scenario_) showEdits();
  }
  if (!hasField()) {
    is_opened_ = true;
    live_.showWithoutField();
    return tell("cancelled: the field is computed after the next change or step, or with F5");
  }
  if (status_.computing) {
    showLastQuantity();
    timeline_.seek(picture_->info().time_s);
    askTime();
    const int steps = edits_ ? edits_->stepsTo(picture_->scenario) : 0;
    for (int n = 0; n < std::abs(steps) && edits_->scenario() != picture_->scenario;) {
      const playback::ScenarioPtr before_step = edits_->scenario();
      if (!(steps < 0 ? undo_order_.canUndo() : undo_order_.canRedo())) break;
      undoOrRedo(steps < 0);
      if (edits_->scenario() != before_step) ++n;  // else a step of the colours
    }
  }
  tell("cancelled: the picture shows what it showed before");
}

std::vector<Verb> Session::programVerbs() {
  return {
      {"cancel",
       {},
       "Cancels what is being computed or opened: edits, quantity and time go back to those of the picture",
       [](Session& session, const Command&) { session.cancel(); }}};
}

}  // namespace emscape::view
