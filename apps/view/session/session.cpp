#include "apps/view/session/session.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/memory.h"
#include "base/text/failure_text.h"
#include "emscape/base/cuda/device.h"
#include "emscape/base/error.h"
#include "emscape/render/annotate/overlay.h"
#include "emscape/render/cells/cell_renderer.h"
#include "playback/view/view_settings.h"

namespace emscape::view {
namespace {

/// Limit of the memory of cached fields: a part of what is free, on the host and on the GPU.
std::size_t cacheLimitOf(const playback::ComputeTarget& target) {
  constexpr std::size_t kMax = std::size_t{512} << 20, kPart = 8;
  std::size_t limit = std::min(kMax, availableMemory_bytes().value_or(kMax) / kPart);
  if (target.onGpu()) limit = std::min(limit, findDevice().free_bytes / kPart);
  return limit;
}

playback::LiveOptions liveOptionsOf(const ViewOptions& options, const playback::ComputeTarget& target,
                                    std::size_t cache_bytes) {
  constexpr int kNiceness = 5;  // the window has priority
  playback::LiveOptions live;
  live.target = target;
  live.controller = options.controller;
  live.cache_bytes = cache_bytes;
  live.niceness = kNiceness;
  live.begins_without_field = true;
  return live;
}

/// The first view. Its size is set when the window has one.
playback::ViewState firstView(const ViewOptions& options, const WindowControl& window) {
  playback::ViewState view = options.view;
  view.size = {};
  if (options.fits_labels) view.label_scale = window.scale();
  return view;
}

/// The time (s) for which a notice is shown.
double timeOf(const Notice& notice) {
  constexpr double kCharactersRead_s = 15;
  return std::max(notice.is_error ? 12.0 : 4.0, static_cast<double>(notice.text.size()) / kCharactersRead_s);
}

}  // namespace

Session::Session(const ViewOptions& options, const playback::ComputeTarget& target, WindowControl& window,
                 EventLog& log, std::function<void()> wake, std::shared_ptr<Files> files)
    : options_(options),
      window_(window),
      log_(log),
      target_(target),
      wake_(std::move(wake)),
      cache_limit_bytes_(cacheLimitOf(target)),
      view_(firstView(options, window)),
      live_(view_, liveOptionsOf(options, target, cache_limit_bytes_), wake_),
      edit_queue_(wake_),
      prober_(Prober::Detail::explained, wake_),
      cursor_(Prober::Detail::value, wake_),
      history_(wake_),
      planes_(view_.settings.planes),
      files_(files ? std::move(files) : std::make_shared<Files>()),
      opened_unsaved_(options.unsaved_edits),
      has_kept_(options.unsaved_edits),
      file_watch_(wake_),
      jobs_(wake_) {
  if (options_.stream) stream_.wake = options_.stream->setWake(wake_);
  watchFiles();
  showView(options.view);
}

Session::~Session() = default;

std::vector<Verb> Session::verbs() {
  std::vector<Verb> all;
  for (const auto& topic :
       {timeVerbs(), cameraVerbs(), followVerbs(), scenarioVerbs(), itemVerbs(), selectionVerbs(),
        toolVerbs(), probeVerbs(), pictureVerbs(), planeVerbs(), transferVerbs(), windowVerbs(), stateVerbs(),
        fileVerbs(), recordVerbs(), programVerbs(), quitVerbs()}) {
    all.insert(all.end(), topic.begin(), topic.end());
  }
  return all;
}

bool Session::perform(const Command& command) {
  Json fields{{"do", command.verb}};
  fields.update(command.arguments);
  log_.write("command", fields);
  touched_ = true;
  const Verb& verb = verbNamed(command.verb);
  if (!verb.run) throw Error(ErrorCode::bad_input, command.verb + ": only a script can do that");
  bool is_accepted = true;
  try {
    requireAllowed(command);
    const std::string refusal = std::exchange(refused_, {});
    const bool is_mended = refused_verb_ == command.verb && notice_.text == refusal;
    verb.run(*this, command);
    if (is_mended && notice_.text == refusal) notice_ = {};
  } catch (const Error& error) {
    is_accepted = false;
    tell(failureText(error), true);
    refused_ = notice_.text;
    refused_verb_ = command.verb;
  }
  noteSteps();
  status_ = live_.status();
  noteProgram();
  return is_accepted;
}

void Session::tell(const std::string& text, bool is_error) {
  notice_ = {text, is_error, log_.now_s()};
  touched_ = true;
  log_.write(is_error ? "error" : "notice", {{"text", text}});
}

// --- time, pictures, scenario ---

void Session::askTime() {
  if (timeline_.times_s().empty() || view_.time_s == timeline_.asked_s()) return;
  view_.time_s = timeline_.asked_s();
  live_.show(view_, nullptr, timeline_.playing() ? playback::Patience::kEndless : playback::Patience::kShort);
}

void Session::setTimelineScenario() {
  timeline_.setScenario(*edits_->scenario());
  most_emitters_ = std::max(most_emitters_, timeline_.bars().size());
}

void Session::takeScenario() {
  std::vector<double> times_s = live_.times_s();
  if (times_s.empty() || times_s == timeline_.times_s()) return;
  const bool is_first = timeline_.times_s().empty();
  timeline_.setSteps(std::move(times_s));
  timeline_.setContinuous(live_.status().is_continuous);
  if (is_first) {
    timeline_.seek(std::isnan(options_.view.time_s) ? live_.status().asked_s : options_.view.time_s);
    if (const auto& part = options_.view.play_range) timeline_.setPlayRange(part->begin_s, part->end_s);
    if (const auto& part = options_.view.visible_time) timeline_.setVisible(part->begin_s, part->end_s);
    view_.time_s = timeline_.asked_s();
    if (live_.scenario()) {
      edits_.emplace(live_.scenario());
      view_.edits = edits_->edits();
      shown_scenario_ = edits_->scenario();
      watchFiles();
    } else if (std::exchange(panels.scenario, false)) {
      panels.colors = true;  // there is nothing to change but the colours
    }
  }
  if (edits_) setTimelineScenario();
}

void Session::takePicture() {
  const std::shared_ptr<const playback::LivePicture> next = live_.picture();
  if (!next || next == picture_) return;
  const bool is_first = !hasField() && next->has_field;
  is_opened_ = is_opened_ || is_first;
  picture_ = next;
  takeScenario();
  if (!hasField()) return;
  if (takes_colors_) takeColors();
  if (is_first) log_.write("first_picture", {{"device", picture_->status.device}});
  if (is_first && is_on_screen_) tellImport();
  if (is_first && !options_.state.empty()) noteSavedView(options_.state);
}

void Session::finishJobs() {
  try {
    while (jobs_.finish()) touched_ = true;
  } catch (const std::exception& error) {
    tell(failureText(error), true);
  }
  noteSteps();
}

/// Tells a failure of a field or picture. Its message goes as soon as a field that the user requested after
/// it succeeds. The field to which the session returns from a refused quantity or comparison does not count,
/// but another quantity or comparison; nor do the fields of a playing series, which would end it unread.
void Session::reportFailure() {
  const bool has_succeeded = failure_.is_field && status_.error.empty() && !status_.computing;
  const bool is_requested = failure_.shown.empty() || fieldName(chosenQuantity()) != failure_.shown;
  if (has_succeeded && is_requested && !timeline_.playing()) {
    if (notice_.text == failure_.told) notice_ = {};
    failure_ = {};
  }
  if (status_.error == failure_.text) return;
  failure_.text = status_.error;
  if (status_.error.empty()) return;
  failure_ = {status_.error, status_.error, "", status_.is_field_error};
  tell(status_.error, true);
}

bool Session::update() {
  const double now_s = log_.now_s();
  timeline_.advance(now_s - advanced_at_s_);
  advanced_at_s_ = now_s;
  askTime();
  if (timeline_.times_s().empty()) takeScenario();
  takeEdits();
  takeStream();
  const playback::LiveStatus before = status_;
  status_ = live_.status();
  field_times_.add(status_.fields_computed, status_.field_ms);
  if (status_.is_continuous != timeline_.isContinuous() && !timeline_.times_s().empty()) {
    timeline_.setContinuous(status_.is_continuous);
  }
  const auto old_picture = picture_;
  takePicture();
  countValues();
  if (fit_) fitColors();
  finishJobs();
  if (touched_) status_ = live_.status();  // a pending request is not shown yet
  for (const playback::StateChange& change : live_.takeStateChanges()) {
    log_.write("state", {{"from", render::toString(logged_state_)}, {"to", render::toString(change.to)}});
    logged_state_ = change.to;
  }
  reportFailure();
  revertRejected();
  if (const auto recorded = files_->recorder.takeOutcome()) {
    if (recorded->is_complete) noteWritten(files_->recorder.progress().output);
    tell(recorded->text, recorded->is_error);
    if (std::exchange(quits_when_recorded_, false) && !recorded->is_error) {
      perform({"quit", {{"edits", quit_answers_.value("edits", "ask")}}});
    }
  }
  if (files_->recorder.running()) {
    const Recorder::Progress progress = files_->recorder.progress();
    const std::pair<int, int> shown{progress.pictures, progress.total};
    if (std::exchange(recorded_, shown) != shown) touched_ = true;
  }
  takeChangedFiles();
  if (asks_to_restore_ && !isOccupied()) {
    asks_to_restore_ = false;
    panels.restore = touched_ = true;
  }
  if (takeWarnings(now_s)) touched_ = true;
  writePendingPicture();
  keepEdits(now_s);
  const bool notice_ends = !notice_.text.empty() && now_s - notice_.since_s > timeOf(notice_);
  if (notice_ends) notice_ = {};
  prober_.turnOn(panels.probe && !panels.hidden);
  cursor_.turnOn(!panels.hidden);
  const bool is_probed = prober_.update(picture_), is_read = cursor_.update(picture_);
  askHistory();
  const bool has_history = history_.update();
  const bool touched = std::exchange(touched_, false);
  const std::string words = noted_words_;
  noteProgram();
  return touched || words != noted_words_ || is_probed || is_read || has_history || notice_ends ||
         picture_ != old_picture || status_.state != before.state || status_.computing != before.computing ||
         status_.cached_steps != before.cached_steps || timeline_.playing();
}

std::optional<double> Session::nextUpdate_s() const {
  constexpr double kRedraw_s = 1.0 / 60, kProgress_s = 0.1;
  if (timeline_.playing())
    return timeline_.isContinuous() ? kRedraw_s
                                    : std::min(2 * kRedraw_s, timeline_.untilNextStep_s().value_or(1));
  if (options_.stream) return untilStream_s();
  if (computing_from_s_) return kProgress_s;
  if (files_->recorder.running() || files_->browser.reading()) return 0.1;
  if (!notice_.text.empty()) return 0.5;
  if (status_.warnings != joined_warnings_) return 0.5;
  if (keep_at_s_) return std::max(0.0, *keep_at_s_ - log_.now_s());
  return std::nullopt;
}

void Session::setPictureSize(render::ImageSize size) {
  if (size == view_.size || size.width < 1 || size.height < 1) return;
  view_.size = size;
  live_.show(view_);
}

bool Session::exact() const {
  return picture_ && status_.exact;
}

bool Session::settled() const {
  return isPictureSettled() && !working();
}

bool Session::isPictureSettled() const {
  return picture_ && !edit_queue_.isBusy() && status_.isSettled() && !fit_ &&
         picture_->status.frame == status_.frame && picture_->size == view_.size;
}

std::optional<Viewport> Session::viewport() const {
  if (!picture_) return std::nullopt;
  return Viewport{picture_->box, picture_->size,
                  render::overlayMargins(picture_->size, picture_->annotations)};
}

// --- requests ---

void Session::cameraMoved() {
  view_.camera = camera_.spec();
  live_.show(view_);
}

void Session::change(const std::function<void(playback::ViewState&)>& change) {
  playback::ViewState view = view_;
  change(view);
  if (picture_ && picture_->cells && playback::changeOf(view_, view).settings) {
    try {
      render::checkCellSettings(view.settings);
    } catch (const Error& error) {
      return tell(error.what(), true);
    }
  }
  view_ = std::move(view);
  if (view_.settings.mode != render::CompositingMode::iso) fog_mode_ = view_.settings.mode;
  live_.show(view_);
}

}  // namespace emscape::view
