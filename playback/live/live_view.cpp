#include "playback/live/live_view.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "playback/live/live_caster.h"
#include "playback/live/live_fields.h"

namespace emscape::playback {
namespace {

double nearestOf(const std::vector<double>& times_s, double time_s) {
  if (times_s.empty()) return time_s;
  return *std::min_element(times_s.begin(), times_s.end(), [time_s](double a, double b) {
    return std::abs(a - time_s) < std::abs(b - time_s);
  });
}

ViewRequest viewOf(const PictureStyle& style, const LiveOptions& options) {
  ViewRequest view;
  view.camera.value = style.camera;
  view.settings.value = style.settings;
  view.size.value = style.size;
  view.pattern.value = options.controller.pattern;
  view.show_terrain.value = style.show_terrain;
  view.show_emitters.value = style.show_emitters;
  view.theme.value = style.theme;
  return view;
}

/// Pictures of existing fields have priority over new fields.
int solveNiceness(const LiveOptions& options) {
  constexpr int kBehindPictures = 4;
  return options.niceness > 0 ? options.niceness + kBehindPictures : 0;
}

FieldRequest fieldOf(const LiveOptions& options) {
  FieldRequest field;
  field.revision = 1;
  field.time_s = options.time_s;
  field.quantity = options.quantity;
  field.compares = !options.compare.empty();
  return field;
}

FrameSelection selectionOf(const std::string& input, const std::string& scenario,
                           const LiveOptions& options) {
  FrameSelection selection;
  selection.input = input;
  selection.scenario = scenario;
  selection.mesh = options.mesh;
  selection.quantity = options.quantity;
  selection.edits = options.edits;
  selection.compare = options.compare;
  selection.allow_missing_terrain = options.allow_missing_terrain;
  selection.independent = true;
  return selection;
}

}  // namespace

struct LiveView::Impl {
  std::function<void()> wake;
  std::string device;

  mutable std::mutex mutex;  // of what follows, up to the threads
  ViewRequest view;          // the last request
  FieldRequest field;        // the same
  std::shared_ptr<const LivePicture> picture;
  PictureProgress progress;  // of the picture

  LiveCaster caster;
  LiveFields fields;

  Impl(const std::string& input, const std::string& scenario, const PictureStyle& style,
       const LiveOptions& options, std::function<void()> wake_in)
      : wake(std::move(wake_in)),
        device(options.target.device()),
        view(viewOf(style, options)),
        field(fieldOf(options)),
        caster(style, view, options.target, options.controller, options.cast_threads, options.niceness,
               {[this](LivePicture made, PictureProgress of_made) { publish(std::move(made), of_made); },
                [this] { tell(); }}),
        fields(
            [selection = selectionOf(input, scenario, options),
             target = options.target](const StopFlag& stop) {
              return selection.input.empty() ? nullptr : openFrameSource(selection, target, {}, &stop);
            },
            field,
            {options.cache_bytes, options.min_seek_interval_ms, options.steps_ahead, options.solve_threads,
             solveNiceness(options)},
            {[this](FieldDelivery delivery, Mailbox<FieldRequest>::Time asked) {
               caster.deliver(std::move(delivery), asked);
             },
             [this] { tell(); }, [this] { return caster.isDrawing(); }}) {}

  /// Each thread calls the object of the other one: both end before either object is destroyed.
  ~Impl() {
    caster.stop();
    fields.close();
    caster.close();
  }

  void tell() const {
    if (wake) wake();
  }

  void publish(LivePicture made, PictureProgress of_made) {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      progress = of_made;
      made.status.frame = picture ? picture->status.frame + 1 : 1;
      made.status = completed(made.status);
      picture = std::make_shared<const LivePicture>(std::move(made));
    }
    tell();
  }

  /// Adds the work in progress to the picture's status. The mutex is locked.
  LiveStatus completed(LiveStatus status) const {
    const CasterStatus cast = caster.status();
    FieldsStatus solve = fields.status();
    const bool is_field_shown = cast.field_revision == field.revision;
    const bool has_failed = solve.failed_revision == field.revision;
    status.state = cast.state;
    status.reason = cast.reason;
    status.computing = !is_field_shown && !has_failed;
    status.failed = !is_field_shown && has_failed;
    status.exact = progress.complete && progress.scene == cast.scene && cast.view_revision == view.revision &&
                   !status.computing;
    status.asked_s = nearestOf(solve.times_s, field.time_s);
    status.searching = solve.series.search != field.search;
    if (!status.searching && !solve.series.range.empty()) status.series_range = solve.series.range;
    status.field_ms = solve.field_ms;
    status.fields_computed = solve.fields_computed;
    status.cached_steps = std::move(solve.cached_steps);
    status.error = solve.error.empty() ? cast.error : solve.error;
    status.error_code = solve.error.empty() ? ErrorCode::other : solve.error_code;
    status.wake_ups = cast.wake_ups + solve.wake_ups;
    status.device = device;
    return status;
  }

  /// Changes the request for the view.
  void askView(const std::function<void(ViewRequest&)>& change) {
    ViewRequest request;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      change(view);
      ++view.revision;
      request = view;
    }
    caster.request(std::move(request));
  }

  void askField(const std::function<void(FieldRequest&)>& change) {
    FieldRequest request;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      change(field);
      ++field.revision;
      request = field;
    }
    fields.request(std::move(request));
  }
};

LiveView::LiveView(const std::string& input, const std::string& scenario_beside_volumes,
                   const PictureStyle& style, const LiveOptions& options, std::function<void()> wake)
    : impl_(std::make_unique<Impl>(input, scenario_beside_volumes, style, options, std::move(wake))) {}

LiveView::~LiveView() = default;

void LiveView::seek(double time_s) {
  const std::vector<double> steps_s = times_s();
  {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    if (!steps_s.empty() && nearestOf(steps_s, time_s) == nearestOf(steps_s, impl_->field.time_s)) {
      impl_->field.time_s = time_s;
      return;
    }
  }
  impl_->askField([&](FieldRequest& field) { field.time_s = time_s; });
}

void LiveView::setScenario(std::shared_ptr<const scenario::Scenario> scenario) {
  impl_->askField([&](FieldRequest& field) { field.scenario = std::move(scenario); });
}

void LiveView::setScenario(std::shared_ptr<const scenario::Scenario> scenario, const std::string& quantity) {
  impl_->askField([&](FieldRequest& field) {
    field.scenario = std::move(scenario);
    field.quantity = quantity;
  });
}

void LiveView::setQuantity(const std::string& quantity) {
  impl_->askField([&](FieldRequest& field) { field.quantity = quantity; });
}

void LiveView::setComparison(bool on) {
  impl_->askField([&](FieldRequest& field) { field.compares = on; });
}

void LiveView::setCamera(const render::CameraSpec& camera) {
  impl_->askView([&](ViewRequest& view) { view.camera.set(camera); });
}

void LiveView::setTransferFunction(const render::TransferFunction& function) {
  impl_->askView([&](ViewRequest& view) { view.colors.set({ColorOrder::Kind::function, {}, function}); });
}

void LiveView::setSettings(const render::RenderSettings& settings) {
  impl_->askView([&](ViewRequest& view) { view.settings.set(settings); });
}

void LiveView::resize(render::ImageSize size) {
  impl_->askView([&](ViewRequest& view) { view.size.set(size); });
}

void LiveView::setPattern(std::optional<render::Pattern> pattern) {
  impl_->askView([&](ViewRequest& view) { view.pattern.set(pattern); });
}

void LiveView::showTerrain(bool show) {
  impl_->askView([&](ViewRequest& view) { view.show_terrain.set(show); });
}

void LiveView::showEmitters(bool show) {
  impl_->askView([&](ViewRequest& view) { view.show_emitters.set(show); });
}

void LiveView::setTheme(render::Theme theme) {
  impl_->askView([&](ViewRequest& view) { view.theme.set(theme); });
}

void LiveView::keepOnDevice(bool keep) {
  impl_->askView([&](ViewRequest& view) { view.on_device.set(keep); });
}

void LiveView::searchSeriesRange() {
  impl_->askField([](FieldRequest& field) { ++field.search; });
}

void LiveView::setRange(const volume::ValueRange& range) {
  impl_->askView([&](ViewRequest& view) { view.colors.set({ColorOrder::Kind::range, range, {}}); });
}

std::shared_ptr<const LivePicture> LiveView::picture() const {
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  return impl_->picture;
}

LiveStatus LiveView::status() const {
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  return impl_->completed(impl_->picture ? impl_->picture->status : LiveStatus{});
}

std::vector<StateChange> LiveView::takeStateChanges() {
  return impl_->caster.takeStateChanges();
}

std::vector<double> LiveView::times_s() const {
  return impl_->fields.status().times_s;
}

std::shared_ptr<const scenario::Scenario> LiveView::scenario() const {
  {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    if (impl_->field.scenario) return impl_->field.scenario;
  }
  return impl_->fields.status().scenario;
}

}  // namespace emscape::playback
