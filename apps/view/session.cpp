#include "apps/view/session.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "emscape/base/error.h"
#include "emscape/render/overlay.h"

namespace emscape::view {
namespace {

playback::LiveOptions liveOptionsOf(const ViewOptions& options, const playback::ComputeTarget& target) {
  constexpr std::size_t kCacheBytes = std::size_t{512} << 20;
  constexpr int kNiceness = 5;  // the window answers first
  playback::LiveOptions live;
  live.target = target;
  live.controller = options.controller;
  live.cache_bytes = kCacheBytes;
  live.allow_missing_terrain = options.allow_missing_terrain;
  live.quantity = options.view.quantity;
  live.edits = options.view.edits;
  live.compare = options.view.compare;
  live.time_s = options.view.time_s;
  live.niceness = kNiceness;
  return live;
}

/// Nothing is drawn before the window says how large the picture is.
playback::PictureStyle styleOf(const ViewOptions& options) {
  playback::PictureStyle style = playback::pictureStyleOf(options.view);
  style.transfer = options.transfer;
  style.size = {};
  return style;
}

double rounded(double value, double unit) {
  return std::round(value / unit) * unit;
}

}  // namespace

Session::Session(const ViewOptions& options, const playback::ComputeTarget& target, WindowControl& window,
                 EventLog& log, std::function<void()> wake, std::shared_ptr<Files> files)
    : options_(options),
      window_(window),
      log_(log),
      target_(target),
      wake_(std::move(wake)),
      live_(options.input, options.scenario, styleOf(options), liveOptionsOf(options, target), wake_),
      pattern_(options.controller.pattern),
      edit_queue_(wake_),
      prober_(wake_),
      files_(files ? std::move(files) : std::make_shared<Files>()),
      opened_unsaved_(options.unsaved_edits),
      has_kept_(options.unsaved_edits),
      jobs_(wake_) {
  showView(options.view);
  if (options.view.range && !options.view.transfer && options.transfer.empty()) {
    live_.setRange(*options.view.range);
  }
}

std::vector<Verb> Session::verbs() {
  std::vector<Verb> all;
  for (const auto& topic :
       {timeVerbs(), cameraVerbs(), scenarioVerbs(), probeVerbs(), pictureVerbs(), planeVerbs(),
        transferVerbs(), windowVerbs(), stateVerbs(), fileVerbs(), recordVerbs()}) {
    all.insert(all.end(), topic.begin(), topic.end());
  }
  return all;
}

void Session::perform(const Command& command) {
  Json fields{{"do", command.verb}};
  fields.update(command.arguments);
  log_.write("command", fields);
  touched_ = true;
  const Verb& verb = verbNamed(command.verb);
  if (!verb.run) throw Error(ErrorCode::bad_input, command.verb + ": only a script can do that");
  try {
    verb.run(*this, command);
  } catch (const Error& error) {
    tell(error.what(), true);
  }
  noteSteps();
}

void Session::tell(const std::string& text, bool is_error) {
  notice_ = {text, is_error, log_.now_s()};
  log_.write(is_error ? "error" : "notice", {{"text", text}});
}

// --- time, pictures, scenario ---

void Session::askTime() {
  if (timeline_.times_s().empty() || asked_s_ == timeline_.step_s()) return;
  asked_s_ = timeline_.step_s();
  live_.seek(*asked_s_);
}

void Session::takeScenario() {
  std::vector<double> times_s = live_.times_s();
  if (times_s.empty() || times_s == timeline_.times_s()) return;
  const bool is_first = timeline_.times_s().empty();
  timeline_.setSteps(std::move(times_s));
  if (is_first) {
    timeline_.seek(options_.view.time_s);
    asked_s_ = timeline_.step_s();
    if (live_.scenario()) {
      edits_.emplace(live_.scenario());
      shown_scenario_ = edits_->scenario();
      shown_quantity_ = quantity_.empty() ? shown_scenario_->output.quantities.front() : quantity_;
    }
  }
  if (edits_) timeline_.setScenario(*edits_->scenario());
}

void Session::takePicture() {
  const std::shared_ptr<const playback::LivePicture> next = live_.picture();
  if (!next || next == picture_) return;
  const bool is_first = !picture_;
  picture_ = next;
  takeScenario();
  if (takes_colors_) takeColors();
  if (is_first) log_.write("first_picture", {{"device", picture_->status.device}});
  if (is_first && !options_.state.empty()) noteSavedView(options_.state);
}

void Session::finishJobs() {
  try {
    while (jobs_.finish()) touched_ = true;
  } catch (const std::exception& error) {
    tell(error.what(), true);
  }
  noteSteps();
}

bool Session::update() {
  const double now_s = log_.now_s();
  timeline_.advance(now_s - advanced_at_s_);
  advanced_at_s_ = now_s;
  askTime();
  if (timeline_.times_s().empty()) takeScenario();
  takeEdits();
  const playback::LiveStatus before = status_;
  status_ = live_.status();
  const auto old_picture = picture_;
  takePicture();
  countValues();
  if (fit_) fitColors();
  finishJobs();
  if (touched_) status_ = live_.status();  // what was just asked for is not shown yet
  for (const playback::StateChange& change : live_.takeStateChanges()) {
    log_.write("state", {{"from", render::toString(logged_state_)}, {"to", render::toString(change.to)}});
    logged_state_ = change.to;
  }
  if (status_.error != told_error_) {
    told_error_ = status_.error;
    if (!told_error_.empty()) tell(told_error_, true);
  }
  if (const auto recorded = files_->recorder.takeOutcome()) tell(recorded->text, recorded->is_error);
  writePendingPicture();
  keepEdits(now_s);
  const bool notice_ends = !notice_.text.empty() && now_s - notice_.since_s > (notice_.is_error ? 12 : 4);
  if (notice_ends) notice_ = {};
  prober_.turnOn(panels.probe && !panels.hidden);
  const bool is_read = prober_.update(picture_);
  const bool touched = std::exchange(touched_, false);
  return touched || is_read || notice_ends || picture_ != old_picture || status_.state != before.state ||
         status_.computing != before.computing || status_.cached_steps != before.cached_steps ||
         timeline_.playing();
}

std::optional<double> Session::nextUpdate_s() const {
  constexpr double kRedraw_s = 1.0 / 30;
  if (timeline_.playing()) return std::min(kRedraw_s, timeline_.untilNextStep_s().value_or(kRedraw_s));
  if (!notice_.text.empty()) return 0.5;
  if (files_->recorder.running() || files_->browser.reading()) return 0.1;
  if (keep_at_s_) return std::max(0.0, *keep_at_s_ - log_.now_s());
  return std::nullopt;
}

void Session::setPictureSize(render::ImageSize size) {
  if (size == picture_size_ || size.width < 1 || size.height < 1) return;
  picture_size_ = size;
  live_.resize(size);
}

bool Session::exact() const {
  return picture_ && status_.exact;
}

bool Session::settled() const {
  return isPictureSettled() && !working();
}

bool Session::isPictureSettled() const {
  return picture_ && !edit_queue_.isBusy() && status_.isSettled() && !fit_ &&
         picture_->status.frame == status_.frame && picture_->size == picture_size_;
}

std::optional<Viewport> Session::viewport() const {
  if (!picture_) return std::nullopt;
  return Viewport{picture_->box, picture_->size,
                  render::overlayMargins(picture_->size, picture_->annotations)};
}

// --- what is asked for ---

void Session::cameraMoved() {
  live_.setCamera(camera_.spec());
}

void Session::setSettings(const render::RenderSettings& settings) {
  settings_ = settings;
  if (settings.mode != render::CompositingMode::iso) fog_mode_ = settings.mode;
  live_.setSettings(settings);
}

void Session::changeScenario(const std::vector<scenario::Edit>& edits) {
  if (!edits_) throw Error(ErrorCode::bad_input, "there is no scenario to change");
  edit_queue_.set(edits);
}

void Session::drag(const std::vector<scenario::Edit>& edits) {
  if (edits_) edit_queue_.drag(edits);
}

void Session::endDrag() {
  edit_queue_.endDrag();
  if (!std::exchange(dragging_, false)) return;
  if (transfer_) transfer_->endDrag();
  noteSteps();
}

void Session::cancelDrag() {
  edit_queue_.cancelDrag();
}

void Session::takeEdits() {
  if (!edits_) return;
  for (const playback::EditQueue::Outcome& outcome : edit_queue_.update(*edits_)) {
    touched_ = true;
    if (!outcome.error.empty()) {
      rejection_ = Rejection{outcome.edits, outcome.error};
      tell(outcome.error, true);
      continue;
    }
    rejection_.reset();
    for (const scenario::Edit& edit : outcome.edits) {
      log_.write("edit", {{"path", edit.path}, {"value", edit.value}});
    }
  }
  noteSteps();
  if (edits_->scenario() != shown_scenario_) showScenario();
}

void Session::noteSteps() {
  if (edits_) undo_order_.note(History::scenario, edits_->stepsMade());
  if (transfer_) undo_order_.note(History::transfer, transfer_->stepsMade());
}

void Session::askUndo(bool undo) {
  endDrag();
  if (edit_queue_.isBusy()) {
    edit_queue_.then([this, undo] { undoOrRedo(undo); });
  } else {
    undoOrRedo(undo);
  }
}

void Session::undoOrRedo(bool undo) {
  noteSteps();
  const std::optional<History> history = undo ? undo_order_.undo() : undo_order_.redo();
  if (history == History::scenario) {
    undo ? edits_->undo() : edits_->redo();
    showScenario();
  } else if (history == History::transfer) {
    changeTransfer([undo](playback::TransferEditor& editor) { undo ? editor.undo() : editor.redo(); });
  }
}

void Session::showScenario() {
  touched_ = true;
  shown_scenario_ = edits_->scenario();
  timeline_.setScenario(*shown_scenario_);
  live_.setScenario(shown_scenario_);
  // Without a choice of the user the first quantity of the scenario is shown, as `render` does.
  const std::string quantity = quantity_.empty() ? shown_scenario_->output.quantities.front() : quantity_;
  if (std::exchange(shown_quantity_, quantity) == quantity) return;
  takes_colors_ = true;
  live_.setQuantity(quantity);
}

// --- what is reported ---

Json Session::report() const {
  const render::CameraSpec& camera = camera_.spec();
  Json report{{"frame", status_.frame},
              {"state", render::toString(status_.state)},
              {"pattern", render::toString(status_.pattern)},
              {"rays_fraction", rounded(status_.rays_fraction, 1e-4)},
              {"cast_ms", rounded(status_.cast_ms, 1e-2)},
              {"labels_ms", rounded(status_.labels_ms, 1e-2)},
              {"field_ms", rounded(status_.field_ms, 1e-2)},
              {"input_to_picture_ms", rounded(status_.input_to_picture_ms, 1e-2)},
              {"input_to_frame_ms", rounded(status_.input_to_frame_ms, 1e-2)},
              {"fields_computed", status_.fields_computed},
              {"asked_s", timeline_.step_s()},
              {"shown_s", status_.shown_s},
              {"exact", exact()},
              {"settled", settled()},
              {"computing", status_.computing},
              {"cached_steps", status_.cached_steps.size()},
              {"device", status_.device},
              {"error", notice_.is_error ? notice_.text : std::string()},
              {"playing", timeline_.playing()},
              {"rate", timeline_.rate()},
              {"loop", timeline_.loop()},
              {"play_from_s", timeline_.playRange().begin_s},
              {"play_to_s", timeline_.playRange().end_s},
              {"visible_from_s", timeline_.visible().begin_s},
              {"visible_to_s", timeline_.visible().end_s},
              {"azimuth_deg", rounded(camera.azimuth_deg, 1e-6)},
              {"elevation_deg", rounded(camera.elevation_deg, 1e-6)},
              {"distance", camera.distance.value_or(0)},
              {"mode", render::toString(settings_.mode)},
              {"iso_value", std::isnan(settings_.iso_value) ? Json() : Json(settings_.iso_value)},
              {"theme", theme_ == render::Theme::dark ? "dark" : "light"},
              {"terrain", show_terrain_},
              {"emitters", show_emitters_},
              {"planes", std::count_if(settings_.planes.begin(), settings_.planes.end(),
                                       [](const render::CutPlane& plane) { return plane.on; })},
              {"compare", compares_},
              {"edits", edits_ ? edits_->edits().size() : 0},
              {"unsaved", hasUnsavedEdits()},
              {"input", options_.input},
              {"working", working()},
              {"kept", kept_view_.has_value()},
              {"copied", copied_},
              {"recording", files_->recorder.running()},
              {"can_undo", canUndo()},
              {"can_redo", canRedo()},
              {"picture_width", picture_ ? picture_->size.width : 0},
              {"picture_height", picture_ ? picture_->size.height : 0},
              {"scale", window_.scale()}};
  if (picture_) {
    report["range_min"] = picture_->transfer.lowest();
    report["quantity"] = picture_->volume.info().quantity;
    report["range_max"] = picture_->transfer.highest();
  }
  report.update(probeReport());
  report.update(transferReport());
  report["rss_mib"] = rounded(residentMemory_mib(), 0.1);
  report["cpu_s"] = rounded(processorTime_s(), 1e-3);
  return report;
}

}  // namespace emscape::view
