#include "apps/view/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "emscape/base/error.h"
#include "emscape/render/overlay.h"

namespace emscape::view {
namespace {

playback::LiveOptions liveOptionsOf(const ViewOptions& options, const playback::ComputeTarget& target) {
  constexpr std::size_t kCacheBytes = std::size_t{512} << 20;
  playback::LiveOptions live;
  live.target = target;
  live.controller = options.controller;
  live.cache_bytes = kCacheBytes;
  live.allow_missing_terrain = options.allow_missing_terrain;
  live.quantity = options.quantity;
  live.edits = options.edits;
  live.time_s = options.time_s.value_or(0);
  return live;
}

double rounded(double value, double unit) {
  return std::round(value / unit) * unit;
}

/// For the shell: as it is, or in single quotes.
std::string quoted(const std::string& text) {
  const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) return text;
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

}  // namespace

Session::Session(const ViewOptions& options, const playback::ComputeTarget& target, WindowControl& window,
                 EventLog& log, std::function<void()> wake)
    : options_(options),
      window_(window),
      log_(log),
      live_(options.input, options.scenario, options_.style, liveOptionsOf(options, target), std::move(wake)),
      camera_(options.style.camera),
      settings_(options.style.settings),
      theme_(options.style.theme),
      quantity_(options.quantity),
      pattern_(options.controller.pattern),
      show_terrain_(options.style.show_terrain),
      show_emitters_(options.style.show_emitters) {
  if (settings_.mode != render::CompositingMode::iso) fog_mode_ = settings_.mode;
  if (options.range) live_.setRange(*options.range);
}

void Session::tell(const std::string& text, bool is_error) {
  notice_ = {text, is_error, log_.now_s()};
  log_.write(is_error ? "error" : "notice", {{"text", text}});
}

// --- time, pictures, scenario ---

void Session::askTime() {
  if (playhead_.times_s().empty()) return;
  if (asked_s_ == playhead_.step_s()) return;
  asked_s_ = playhead_.step_s();
  live_.seek(*asked_s_);
}

void Session::takeScenario() {
  if (!playhead_.times_s().empty()) return;
  playhead_.setTimes_s(live_.times_s());
  if (playhead_.times_s().empty()) return;
  playhead_.seek(options_.time_s.value_or(playhead_.times_s().front()));
  asked_s_ = playhead_.step_s();
  if (!live_.scenario()) return;
  edits_.emplace(live_.scenario());
}

void Session::takePicture() {
  const std::shared_ptr<const playback::LivePicture> next = live_.picture();
  if (!next || next == picture_) return;
  const bool is_first = !picture_;
  picture_ = next;
  if (fitting_) fitted_ = picture_->transfer;
  if (picture_->status.isSettled()) fitting_ = false;
  if (is_first) log_.write("first_picture", {{"device", picture_->status.device}});
}

bool Session::update() {
  const double now_s = log_.now_s();
  playhead_.advance(now_s - advanced_at_s_);
  advanced_at_s_ = now_s;
  askTime();
  takeScenario();
  const playback::LiveStatus before = status_;
  status_ = live_.status();
  const auto old_picture = picture_;
  takePicture();
  if (status_.state != before.state) {
    log_.write("state", {{"from", render::toString(before.state)}, {"to", render::toString(status_.state)}});
  }
  if (status_.error != told_error_) {
    told_error_ = status_.error;
    if (!told_error_.empty()) tell(told_error_, true);
  }
  const bool notice_ends = !notice_.text.empty() && now_s - notice_.since_s > (notice_.is_error ? 12 : 4);
  if (notice_ends) notice_ = {};
  const bool touched = std::exchange(touched_, false);
  return touched || notice_ends || picture_ != old_picture || status_.state != before.state ||
         status_.computing != before.computing || status_.cached_steps != before.cached_steps ||
         playhead_.playing();
}

std::optional<double> Session::nextUpdate_s() const {
  constexpr double kRedraw_s = 1.0 / 30;
  if (playhead_.playing()) return std::min(kRedraw_s, playhead_.untilNextStep_s().value_or(kRedraw_s));
  if (!notice_.text.empty()) return 0.5;
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
  return picture_ && status_.isSettled() && picture_->status.frame == status_.frame &&
         picture_->image.size == picture_size_;
}

std::optional<Viewport> Session::viewport() const {
  if (!picture_) return std::nullopt;
  return Viewport{picture_->box, picture_->image.size,
                  render::overlayMargins(picture_->image.size, picture_->annotations)};
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

void Session::setColors(const ColorAdjustment& colors) {
  if (!fitted_) return;
  live_.setTransferFunction(adjusted(*fitted_, colors));
  colors_ = colors;
  fitting_ = false;
}

void Session::fitColors(bool to_series) {
  colors_ = {};
  fitting_ = true;
  if (to_series) {
    live_.fitToSeries();
  } else {
    live_.fitToStep();
  }
}

void Session::changeScenario(const std::vector<scenario::Edit>& edits) {
  if (!edits_) throw Error(ErrorCode::bad_input, "there is no scenario to change");
  edits_->set(edits);
  showScenario();
  for (const scenario::Edit& edit : edits) log_.write("edit", {{"path", edit.path}, {"value", edit.value}});
}

void Session::dragValue(const std::string& path, const std::string& value) {
  if (!edits_) return;
  if (!dragging_) edits_->beginDrag();
  dragging_ = true;
  try {
    changeScenario({{path, value}});
  } catch (const Error& error) {
    tell(error.what(), true);
  }
}

void Session::endDrag() {
  if (dragging_) edits_->endDrag();
  dragging_ = false;
}

void Session::showScenario() {
  live_.setScenario(edits_->scenario());
}

// --- what is reported ---

Json Session::report() const {
  const render::CameraSpec& camera = camera_.spec();
  Json report{{"frame", status_.frame},
              {"state", render::toString(status_.state)},
              {"pattern", render::toString(status_.pattern)},
              {"rays_fraction", rounded(status_.rays_fraction, 1e-4)},
              {"cast_ms", rounded(status_.cast_ms, 1e-2)},
              {"field_ms", rounded(status_.field_ms, 1e-2)},
              {"input_to_picture_ms", rounded(status_.input_to_picture_ms, 1e-2)},
              {"asked_s", playhead_.step_s()},
              {"shown_s", status_.shown_s},
              {"exact", exact()},
              {"settled", settled()},
              {"computing", status_.computing},
              {"cached_steps", status_.cached_steps.size()},
              {"device", status_.device},
              {"error", notice_.is_error ? notice_.text : std::string()},
              {"playing", playhead_.playing()},
              {"rate", playhead_.rate()},
              {"loop", playhead_.loop()},
              {"azimuth_deg", rounded(camera.azimuth_deg, 1e-6)},
              {"elevation_deg", rounded(camera.elevation_deg, 1e-6)},
              {"distance", camera.distance.value_or(0)},
              {"mode", render::toString(settings_.mode)},
              {"theme", theme_ == render::Theme::dark ? "dark" : "light"},
              {"terrain", show_terrain_},
              {"emitters", show_emitters_},
              {"edits", edits_ ? edits_->edits().size() : 0},
              {"can_undo", canUndo()},
              {"can_redo", canRedo()},
              {"picture_width", picture_ ? picture_->image.size.width : 0},
              {"picture_height", picture_ ? picture_->image.size.height : 0},
              {"scale", window_.scale()}};
  if (picture_) {
    report["range_min"] = picture_->transfer.lowest();
    report["range_max"] = picture_->transfer.highest();
  }
  report["rss_mib"] = rounded(residentMemory_mib(), 0.1);
  return report;
}

std::string Session::renderCommand() const {
  std::string text = "emscape render " + quoted(options_.input);
  if (!options_.scenario.empty()) text += " --scenario " + quoted(options_.scenario);
  text += fmt::format(" --camera {} --times {:g} --mode {}", quoted(render::toString(camera_.spec())),
                      playhead_.step_s(), render::toString(settings_.mode));
  if (!quantity_.empty()) text += " --quantity " + quoted(quantity_);
  if (picture_ && picture_->range) {
    text += fmt::format(" --range={:g}:{:g}", picture_->range->min, picture_->range->max);
  }
  if (settings_.mode == render::CompositingMode::iso && !std::isnan(settings_.iso_value)) {
    text += fmt::format(" --iso-value={:g}", settings_.iso_value);
  }
  if (settings_.shading) text += " --shading";
  if (settings_.vertical_exaggeration > 0)
    text += fmt::format(" --exaggeration {:g}", settings_.vertical_exaggeration);
  if (theme_ == render::Theme::light) text += " --theme light";
  if (!show_terrain_) text += " --terrain off";
  if (!show_emitters_) text += " --emitters off";
  if (edits_) {
    for (const scenario::Edit& edit : edits_->edits()) text += " --set " + quoted(scenario::toString(edit));
  }
  return text + fmt::format(" --size {}x{} -o picture.png", picture_size_.width, picture_size_.height);
}

}  // namespace emscape::view
