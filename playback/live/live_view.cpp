#include "playback/live/live_view.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <deque>
#include <mutex>

#include "playback/live/live_caster.h"
#include "playback/live/live_fields.h"
#include "playback/live/nearest_time.h"
#include "playback/view/view_settings.h"

namespace emscape::playback {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// The time of the field for a requested time.
double fieldTime_s(const FieldsStatus& fields, double requested_s) {
  const double asked_s = std::isnan(requested_s) ? fields.first_s : requested_s;
  const std::vector<double>& times_s = fields.times_s;
  if (times_s.empty()) return asked_s;
  if (fields.is_continuous) return std::clamp(asked_s, times_s.front(), times_s.back());
  return times_s[static_cast<std::size_t>(nearestTime(times_s, asked_s))];
}

/// Times at which pictures began to show another field.
class FieldRate {
 public:
  void note(double shown_s, SteadyClock::time_point now) {
    if (!changes_.empty() && shown_s == shown_s_) return;
    shown_s_ = shown_s;
    changes_.push_back(now);
    drop(now);
  }
  /// Fields per second over the last two seconds.
  double perSecond(SteadyClock::time_point now) {
    drop(now);
    if (changes_.size() < 2) return 0;
    const std::chrono::duration<double> span = changes_.back() - changes_.front();
    return static_cast<double>(changes_.size() - 1) / std::max(span.count(), 1e-3);
  }

 private:
  void drop(SteadyClock::time_point now) {
    constexpr std::chrono::seconds kSpan{2};
    while (!changes_.empty() && now - changes_.front() > kSpan) changes_.pop_front();
  }

  std::deque<SteadyClock::time_point> changes_;
  double shown_s_ = 0;
};

/// Pictures of existing fields have priority over new fields.
int solveNiceness(const LiveOptions& options) {
  constexpr int kBehindPictures = 4;
  return options.niceness > 0 ? options.niceness + kBehindPictures : 0;
}

FrameSelection selectionOf(const ViewState& view, const LiveOptions& options) {
  FrameSelection selection(view);
  selection.cache_bytes = options.cache_bytes / 2;
  selection.range.reset();  // of the colours, which the painter fits
  selection.independent = true;
  return selection;
}

render::ControllerOptions controllerOptionsOf(const LiveOptions& options, const ViewState& view) {
  render::ControllerOptions controller = options.controller;
  controller.pattern = view.pattern;
  return controller;
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
  mutable FieldRate rate;

  std::atomic<bool> is_built{false};  // the caster's thread begins before `fields`
  LiveCaster caster;
  LiveFields fields;

  Impl(const ViewState& shown, const LiveOptions& options, std::function<void()> wake_in)
      : wake(std::move(wake_in)),
        device(options.target.device()),
        view{0, shown},
        field{1, shown, nullptr},
        caster(view, options.target, controllerOptionsOf(options, shown), options.cast_threads,
               options.niceness,
               {[this](LivePicture made, PictureProgress of_made) { publish(std::move(made), of_made); },
                [this] { tell(); }, [this] { return is_built && fields.isHurried(); }}),
        fields(
            [selection = selectionOf(shown, options), target = options.target](const StopFlag& stop) {
              return selection.input.empty() ? nullptr : openFrameSource(selection, target, {}, &stop);
            },
            field,
            {options.cache_bytes, options.min_seek_interval_ms, options.min_play_interval_ms,
             options.steps_ahead, options.begins_without_field, options.solve_threads,
             solveNiceness(options)},
            {[this](FieldDelivery delivery, Mailbox<FieldRequest>::Time asked) {
               caster.deliver(std::move(delivery), asked);
             },
             [this] { tell(); }, [this] { return caster.isDrawing(); }}) {
    is_built = true;
  }

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
      rate.note(made.status.shown_s, SteadyClock::now());
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
    // Without a size nothing is drawn.
    const bool is_field_shown =
        (view.view.size.count() > 0 ? progress.field_revision : cast.field_revision) == field.revision;
    const bool has_failed = solve.failed_revision == field.revision;
    status.state = cast.state;
    status.reason = cast.reason;
    status.computing = !is_field_shown && !has_failed;
    status.failed = !is_field_shown && has_failed;
    status.exact = progress.complete && progress.column_step == 1 && progress.scene == cast.scene &&
                   cast.view_revision == view.revision && !status.computing;
    status.asked_s = fieldTime_s(solve, field.view.time_s);
    status.is_continuous = solve.is_continuous;
    status.progress = std::move(solve.progress);
    status.fields_per_s = rate.perSecond(SteadyClock::now());
    status.searching = solve.series.search != field.search;
    if (!status.searching && !solve.series.range.empty()) status.series_range = solve.series.range;
    status.field_ms = solve.field_ms;
    status.fields_computed = solve.fields_computed;
    status.fields_abandoned = solve.fields_abandoned;
    status.abandon_ms = solve.abandon_ms;
    status.cached_steps = std::move(solve.cached_steps);
    status.cached_bytes = solve.cached_bytes;
    status.quantities = std::move(solve.quantities);
    status.warnings = std::move(solve.warnings);
    status.error = solve.error.empty() ? cast.error : solve.error;
    status.is_field_error = !solve.error.empty();
    status.error_code = status.is_field_error ? solve.error_code : ErrorCode::other;
    status.wake_ups = cast.wake_ups + solve.wake_ups;
    status.device = device;
    return status;
  }

  /// Sends a changed request. The mutex is not locked.
  template <class Request, class Thread>
  void ask(Request& request, Thread& thread, const std::function<void()>& change) {
    std::unique_lock<std::mutex> lock(mutex);
    change();
    ++request.revision;
    Request sent = request;
    lock.unlock();
    thread.request(std::move(sent));
  }
};

LiveView::LiveView(const ViewState& view, const LiveOptions& options, std::function<void()> wake)
    : impl_(std::make_unique<Impl>(view, options, std::move(wake))) {}

LiveView::~LiveView() = default;

void LiveView::show(const ViewState& view, std::shared_ptr<const scenario::Scenario> edited,
                    double patience_ms) {
  const FieldsStatus fields = impl_->fields.status();
  bool is_other_view = false, is_other_field = false;
  {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    const ViewState& before = impl_->view.view;
    const ViewChange change = changeOf(before, view);
    const bool is_other_time =
        change.time &&
        (fields.times_s.empty() || fieldTime_s(fields, view.time_s) != fieldTime_s(fields, before.time_s));
    is_other_view = change.size || change.camera || change.settings || change.colors || change.ground ||
                    change.labels || change.pattern || change.split;
    is_other_field = change.field || before.comparison() != view.comparison() || is_other_time ||
                     (edited && edited != impl_->field.scenario);
    impl_->view.view = impl_->field.view = view;
  }
  if (is_other_view) impl_->ask(impl_->view, impl_->caster, [] {});
  if (!is_other_field) return;
  if (patience_ms == Patience::kNone) impl_->caster.defer();
  impl_->ask(impl_->field, impl_->fields, [&] {
    impl_->field.patience_ms = patience_ms;
    impl_->field.has_field = true;
    if (edited) impl_->field.scenario = std::move(edited);
  });
}

void LiveView::showWithoutField() {
  impl_->ask(impl_->field, impl_->fields, [&] {
    impl_->field.patience_ms = Patience::kNone;
    impl_->field.has_field = false;
  });
}

void LiveView::pose(PosesPtr poses, std::shared_ptr<const scenario::Scenario> scenario) {
  impl_->ask(impl_->field, impl_->fields, [&] {
    impl_->field.patience_ms = Patience::kEndless;
    impl_->field.poses = std::move(poses);
    if (scenario) impl_->field.scenario = std::move(scenario);
  });
}

void LiveView::keepOnDevice(bool keep) {
  impl_->ask(impl_->view, impl_->caster, [&] { impl_->view.on_device = keep; });
}

void LiveView::searchSeriesRange() {
  impl_->ask(impl_->field, impl_->fields, [&] {
    impl_->field.patience_ms = Patience::kEndless;
    ++impl_->field.search;
  });
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
