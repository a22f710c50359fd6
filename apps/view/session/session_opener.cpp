#include "apps/view/session/session_opener.h"

#include <fmt/format.h>

#include <utility>

#include "base/text/failure_text.h"
#include "emscape/base/error.h"

namespace emscape::view {
namespace {

/// Completes the recording of a stream that the next session does not show.
/// @return why it cannot be completed; empty: it can, or there is none
std::string endStream(const Session& session, const ViewOptions& next) {
  const std::shared_ptr<playback::LiveBattlefield>& stream = session.options().stream;
  if (!stream || stream == next.stream) return "";
  try {
    stream->finishRecording();
  } catch (const Error& error) {
    return failureText(error);
  }
  return "";
}

}  // namespace

bool SessionOpener::update(std::unique_ptr<Session>& session) {
  if (std::exchange(files_->cancels_opening, false)) {
    const bool closes = !files_->is_opening && !session->picture();
    cancel(*session);
    if (closes) return close(session);
  }
  if (files_->request && !task_.active()) {
    OpenRequest request = *std::exchange(files_->request, std::nullopt);
    endBeside(std::move(next_));  // there is a newer request
    std::vector<std::string> messages = files_->messages->exchange({});
    if (!messages_before_) messages_before_ = std::move(messages);
    ViewOptions present = session->options();
    // A new input is shown with the options of the start, but with the present window.
    playback::ViewState fresh;
    playback::setInput(fresh, present.view);
    fresh.theme = session->theme();
    if (session->scenario()) fresh.open_panels = session->viewState().open_panels;  // else those for volumes
    present.view = fresh;
    task_.start([request = std::move(request), present] { return prepareOpening(request, present); });
  }
  if (task_.done()) take(*session);
  if (!next_) return false;
  files_->opening.progress = next_->status().progress;
  next_->setPictureSize(session->pictureSize());
  next_->update();
  const bool is_other_input = session->view().input != opening_.options.view.input;
  if (next_->hasField() || (next_->picture() && is_other_input)) {
    if (session->isOccupied()) {
      files_->opening.progress = {"shown after the dialog or text field", "", 1};
      return false;
    }
    replace(session);
    return true;
  }
  if (next_->status().error.empty()) return false;
  session->show(next_->notice());
  giveUp();
  return false;
}

void SessionOpener::take(Session& session) {
  try {
    opening_ = task_.take();
    if (files_->request || !files_->is_opening) return;  // there is a newer request, or it was cancelled
    if (!opening_.colors.empty()) {
      giveUp();
      session.perform({"transfer", {{"file", opening_.colors}}});
      return;
    }
    next_ = make_(opening_.options);
  } catch (const std::exception& error) {
    if (!files_->is_opening) return;  // cancelled
    session.tell(failureText(error), true);
    giveUp();
  }
}

void SessionOpener::replace(std::unique_ptr<Session>& session) {
  const bool takes_edits_along =
      opening_.options.unsaved_edits && session->view().input == opening_.options.view.input;
  if (opening_.restores) {
    session->leaveForKept();
  } else {
    session->leave(!takes_edits_along);
  }
  next_->takeOver(*session);
  const std::string fault = endStream(*session, next_->options());
  endBeside(std::move(session));
  session = std::move(next_);
  messages_before_.reset();
  files_->is_opening = files_->request.has_value();
  session->shown(opening_.left_out);
  if (opening_.imports) session->tellImport();
  if (!fault.empty()) session->tell(fault, true);
  Opening none;
  std::swap(opening_, none);
}

void SessionOpener::cancel(Session& session) {
  const std::string file = files_->is_opening ? files_->opening.file : session.view().input;
  files_->request.reset();
  giveUp();
  session.tell(fmt::format("cancelled: {} is not opened", file));
}

/// Shows the start panel in place of an input without a picture.
bool SessionOpener::close(std::unique_ptr<Session>& session) {
  const Notice notice = session->notice();
  ViewOptions nothing = session->options();
  nothing.view = {};
  nothing.view.theme = session->theme();
  nothing.state.clear();
  nothing.stream.reset();
  nothing.made_of.clear();
  nothing.made_note = {};
  session->leave(true);
  const std::string fault = endStream(*session, nothing);
  endBeside(std::move(session));
  session = make_(nothing);
  session->shown({});
  session->show(notice);
  if (!fault.empty()) session->tell(fault, true);
  return true;
}

void SessionOpener::giveUp() {
  if (messages_before_ && !files_->request) {
    files_->messages->exchange(*std::exchange(messages_before_, std::nullopt));
  }
  endBeside(std::move(next_));
  files_->is_opening = files_->request.has_value();
}

/// Destroys a session on a background thread, since it waits for its running field.
void SessionOpener::endBeside(std::unique_ptr<Session> session) {
  if (!session) return;
  old_sessions_.push([old = std::shared_ptr<Session>(std::move(session))]() mutable { old.reset(); });
}

}  // namespace emscape::view
