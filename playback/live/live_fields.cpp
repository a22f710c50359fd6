#include "playback/live/live_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "base/stopwatch.h"
#include "emscape/base/parallel.h"
#include "playback/frames/busy_field.h"
#include "playback/live/first_line.h"
#include "playback/live/nearest_time.h"

namespace emscape::playback {
namespace {

using SteadyClock = std::chrono::steady_clock;

SteadyClock::duration milliseconds(double ms) {
  return std::chrono::duration_cast<SteadyClock::duration>(std::chrono::duration<double, std::milli>(ms));
}

double since_ms(SteadyClock::time_point time) {
  return std::chrono::duration<double, std::milli>(SteadyClock::now() - time).count();
}

std::vector<double> timesOf(const FrameSource& source) {
  std::vector<double> times_s;
  for (int index = 0; index < source.count(); ++index) times_s.push_back(source.time_s(index));
  return times_s;
}

/// A field that takes longer leaves a core free even if it is not needed yet.
constexpr double kLongField_ms = 200;
/// Time for which a request without patience delays other work.
constexpr double kHurry_ms = 250;
/// Patience of a request after a field was abandoned.
constexpr double kLongPatience_ms = 1000;

}  // namespace

double LiveFields::Content::timeOf(double asked_s) const {
  return is_continuous ? std::clamp(asked_s, times_s.front(), times_s.back())
                       : times_s[static_cast<std::size_t>(nearestTime(times_s, asked_s))];
}

int LiveFields::Content::stepAt(double time_s) const {
  const int nearest = nearestTime(times_s, time_s);
  return times_s[static_cast<std::size_t>(nearest)] == time_s ? nearest : -1;
}

LiveFields::LiveFields(Open open, FieldRequest first, const Options& options, Events events)
    : open_(std::move(open)),
      options_(options),
      events_(std::move(events)),
      arena_(options.threads > 0 ? options.threads : threadCount(), options.niceness),
      narrow_arena_(threadCount() - 1, options.niceness),
      wanted_(first),
      cache_(options.cache_bytes) {
  box_.put(std::move(first));
  worker_.push([this] { run(); });
}

LiveFields::~LiveFields() {
  close();
}

void LiveFields::close() {
  stop();
  worker_.finish();
}

void LiveFields::stop() {
  stop_ = true;
  event_.set();
}

FieldsStatus LiveFields::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  FieldsStatus status = status_;
  status.progress = work_.progress();
  return status;
}

void LiveFields::request(FieldRequest request) {
  const std::lock_guard<std::mutex> lock(patience_mutex_);
  pending_patience_ms_ = std::min(pending_patience_ms_, request.patience_ms);
  if (request.patience_ms == Patience::kNone)
    hurried_until_ = (SteadyClock::now() + milliseconds(kHurry_ms)).time_since_epoch().count();
  box_.put(std::move(request));
  applyPatience();
}

bool LiveFields::isHurried() const {
  return SteadyClock::now().time_since_epoch().count() < hurried_until_;
}

/// Stops the field in progress if a request is pending. The mutex is locked.
void LiveFields::applyPatience() {
  if (!begun_) return;
  if (yields_ && !box_.isEmpty()) {
    stop_at_ = SteadyClock::now();
    work_.stopAt(*stop_at_);
    return;
  }
  if (std::isinf(pending_patience_ms_)) return;
  const bool has_more_time = is_patient_ && pending_patience_ms_ > 0;
  const Time at = std::max(*begun_ + milliseconds(has_more_time ? kLongPatience_ms : pending_patience_ms_),
                           SteadyClock::now());
  stop_at_ = std::min(stop_at_.value_or(at), at);
  work_.stopAt(at);
}

void LiveFields::run() {
  const WorkScope scope(&work_);
  open();
  while (!stop_) {
    accept();
    if (is_due_) {
      serve();
      continue;
    }
    const std::optional<int> step = idleStep();
    if (!is_incomplete_ && !step) {
      wait();
    } else if (SteadyClock::now() < quiet_from_) {
      waitUntil(quiet_from_);
    } else if (is_incomplete_) {
      completeField();
    } else {
      doIdleWork(*step);
    }
  }
}

void LiveFields::open() {
  try {
    work_.begin("opening");
    source_ = open_(stop_);
    if (!source_) return;
    if (const LoadedScenario* scene = source_->scene()) opened_scenario_ = scene->scenario;
    Content content;
    content.shown = {opened_scenario_, nullptr, "", wanted_.view.comparison()};
    content.shown.quantity = shownOf(wanted_).quantity;
    content_ = std::make_shared<const Content>(content);
    const std::string& time_utc = wanted_.view.time_utc;
    first_s_ = time_utc.empty() ? source_->firstTime_s() : scenario::parseTime(time_utc, source_->clock());
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      status_.first_s = first_s_;
    }
    noteContent();
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.scenario = opened_scenario_;
    status_.quantities = source_->quantities();
  } catch (const std::exception& error) {
    source_ = nullptr;
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.error = failureLine(error);
    status_.error_code = codeOf(error);
  }
}

/// Takes the pending request.
void LiveFields::accept() {
  std::optional<Mailbox<FieldRequest>::Letter> letter;
  {
    const std::lock_guard<std::mutex> lock(patience_mutex_);
    letter = box_.take();
    pending_patience_ms_ = Patience::kEndless;
  }
  if (!letter) return;
  asked_ = is_due_ ? std::min(asked_, letter->since) : letter->since;
  wanted_ = std::move(letter->value);
  is_due_ = true;
  quiet_from_ = SteadyClock::now() + milliseconds(BusyField::kQuiet_ms);
  if (wanted_.search != search_) beginSearch();
}

void LiveFields::serve() {
  if (!source_) {  // the error has already been reported
    const FieldsStatus told = status();
    fail(told.error, told.error_code);
    return;
  }
  try {
    const Shown wanted = shownOf(wanted_);
    if (wanted_.has_field && serveFromMemory(wanted)) return;
    const bool is_other = !(wanted == content_->shown);
    begin(fmt::format("{} at {:.6g} s", wanted.quantity.empty() ? content_->title : wanted.quantity,
                      askedTime_s()));
    if (is_other) change(wanted);
    if (!wanted_.has_field && deliverWithoutField(wanted_.revision)) return;
    if (!last_ && options_.begins_without_field) deliverWithoutField(0);
    if (!is_other && field_begin_) {
      const bool plays = std::isinf(wanted_.patience_ms);
      const Time may_begin =
          *field_begin_ + milliseconds(plays ? options_.min_play_interval_ms : options_.min_seek_interval_ms);
      if (SteadyClock::now() < may_begin) return waitUntil(may_begin);
    }
    const double time_s = content_->timeOf(askedTime_s());
    const int nearest = nearestTime(content_->times_s, time_s);
    if (nearest != index_) is_playing_ = !content_->is_continuous && nearest == index_ + 1;
    index_ = nearest;
    deliver(content_, compute(time_s, wanted_.patience_ms > Patience::kNone));
  } catch (const Stopped&) {
    const std::lock_guard<std::mutex> lock(patience_mutex_);
    begun_.reset();
    if (std::exchange(yields_, false)) return;
    is_patient_ = true;
    const std::lock_guard<std::mutex> status_lock(mutex_);
    ++status_.fields_abandoned;
    if (stop_at_) status_.abandon_ms = std::max(status_.abandon_ms, since_ms(*stop_at_));
  } catch (const std::exception& error) {
    fail(failureLine(error), codeOf(error));
  }
}

/// Computes the missing columns of the last field: its request without patience. Any request abandons this.
void LiveFields::completeField() {
  wanted_.patience_ms = Patience::kNone;
  asked_ = SteadyClock::now();
  is_due_ = true;
  {
    const std::lock_guard<std::mutex> lock(patience_mutex_);
    yields_ = true;
  }
  serve();
  const std::lock_guard<std::mutex> lock(patience_mutex_);
  yields_ = false;
}

/// Delivers a field that is in memory: the last one, or a cached step. The source need not show it: it stays
/// as it is after an abandoned field.
bool LiveFields::serveFromMemory(const Shown& wanted) {
  const double asked_s = askedTime_s();
  const auto publishTimes = [this](const Content& content) {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.times_s = content.times_s;
    status_.is_continuous = content.is_continuous;
  };
  if (last_ && last_->shown == wanted && last_frame_.info().time_s == last_->timeOf(asked_s) &&
      (last_frame_.column_step == 1 || wanted_.patience_ms > Patience::kNone)) {
    publishTimes(*last_);
    deliver(last_, last_frame_);
    return true;
  }
  if (!cached_ || !(cached_->shown == wanted)) return false;
  const int step = cached_->stepAt(cached_->timeOf(asked_s));
  const Frame* const frame = step < 0 ? nullptr : cache_.find(step);
  if (frame == nullptr) return false;
  publishTimes(*cached_);
  if (step != index_) is_playing_ = !cached_->is_continuous && step == index_ + 1;
  index_ = step;
  deliver(cached_, *frame);
  return true;
}

double LiveFields::askedTime_s() const {
  return std::isnan(wanted_.view.time_s) ? first_s_ : wanted_.view.time_s;
}

/// What a request shows. Without a quantity it is the first of the computed scenario.
LiveFields::Shown LiveFields::shownOf(const FieldRequest& request) const {
  Shown shown{request.scenario ? request.scenario : opened_scenario_, request.poses, request.view.quantity,
              request.view.comparison()};
  const bool is_computed = source_->scene() != nullptr && request.view.scenario.empty();
  if (shown.quantity.empty() && is_computed) shown.quantity = shown.scenario->output.quantities.front();
  return shown;
}

/// Makes the source show something else.
void LiveFields::change(const Shown& wanted) {
  Content content{content_->shown, "", std::nullopt, {}, false};
  const auto changed = [&] {
    content_ = std::make_shared<const Content>(content);
    noteContent();
  };
  if (wanted.scenario != content.shown.scenario) {
    source_->setScenario(wanted.scenario);
    content.shown.scenario = wanted.scenario;
    content.shown.poses = nullptr;
    changed();
  }
  if (wanted.poses != content.shown.poses) {
    source_->setPoses(wanted.poses);
    content.shown.poses = wanted.poses;
    changed();
  }
  if (wanted.quantity != content.shown.quantity) {
    source_->setQuantity(wanted.quantity);
    content.shown.quantity = wanted.quantity;
    changed();
  }
  if (wanted.comparison != content.shown.comparison) {
    source_->setComparison(wanted.comparison);
    content.shown.comparison = wanted.comparison;
    changed();
  }
  if (range_search_.next()) beginSearch();
}

/// Completes content_ by what the source has.
void LiveFields::noteContent() {
  Content content = *content_;
  content.title = source_->name();
  if (const LoadedScenario* scene = source_->scene()) content.scene = *scene;
  content.times_s = timesOf(*source_);
  content.is_continuous = source_->isContinuous();
  content_ = std::make_shared<const Content>(std::move(content));
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.times_s = content_->times_s;
  status_.is_continuous = content_->is_continuous;
}

/// Begins work that newer requests may abandon.
void LiveFields::begin(const std::string& what) {
  const std::lock_guard<std::mutex> lock(patience_mutex_);
  work_.begin(what);
  begun_ = SteadyClock::now();
  stop_at_.reset();
  applyPatience();  // of requests since accept()
}

Frame LiveFields::compute(double time_s, bool is_busy) {
  Stopwatch watch;
  source_->setTimeGoal(is_busy ? BusyField::kGoal_ms : 0);
  field_begin_ = SteadyClock::now();
  const FieldsStatus before = status();
  const bool shares = (events_.is_shared && events_.is_shared()) || before.field_ms > kLongField_ms;
  Frame frame;
  const bool leaves_a_core = options_.threads == 0 && shares && before.fields_computed > 0 && !isHurried();
  const int step = content_->stepAt(time_s);
  (leaves_a_core ? narrow_arena_ : arena_).run([&] {
    const WorkScope scope(&work_);  // the arena may run it on another thread
    checkpoint();
    frame = step < 0 ? source_->frameAt(time_s) : source_->frame(step);
  });
  {
    const std::lock_guard<std::mutex> lock(patience_mutex_);
    begun_.reset();
    is_patient_ = false;
  }
  if (!cached_ || !(cached_->shown == content_->shown)) cache_.clear();
  cached_ = content_;
  const std::size_t of_source = std::min(source_->cachedBytes(), options_.cache_bytes);
  cache_.setLimit(options_.cache_bytes - of_source);
  if (step >= 0 && frame.column_step == 1) cache_.keep(step, frame, distance());
  auto warnings = std::make_shared<const std::vector<std::string>>(source_->warnings());
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.warnings = std::move(warnings);
  status_.field_ms = watch.lap_ms();
  ++status_.fields_computed;
  status_.cached_steps = cache_.indices();
  status_.cached_bytes = cache_.bytes() + of_source;
  return frame;
}

void LiveFields::deliver(const ContentPtr& content, const Frame& frame) {
  is_due_ = false;
  {
    const std::lock_guard<std::mutex> lock(patience_mutex_);
    if (pending_patience_ms_ > Patience::kNone) hurried_until_ = 0;
  }
  last_ = content;
  last_frame_ = frame;
  is_incomplete_ = frame.column_step > 1;
  if (is_incomplete_) quiet_from_ = SteadyClock::now() + milliseconds(BusyField::kQuiet_ms);
  FieldDelivery delivery{wanted_.revision, content->title, content->scene, content->shown.quantity, frame};
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.error.clear();
  }
  events_.deliver(std::move(delivery), asked_);
  events_.changed();
}

/// @param revision  of the delivery
/// @return false if the source has nothing to show without a field
bool LiveFields::deliverWithoutField(long long revision) {
  const std::optional<Frame> frame = source_->withoutField(content_->timeOf(askedTime_s()));
  if (!frame) return false;
  if (revision > 0) {
    is_due_ = is_incomplete_ = false;
    const std::lock_guard<std::mutex> lock(patience_mutex_);
    begun_.reset();
  }
  events_.deliver({revision, content_->title, content_->scene, content_->shown.quantity, *frame}, asked_);
  events_.changed();
  return true;
}

void LiveFields::fail(const std::string& line, ErrorCode code) {
  is_due_ = is_incomplete_ = false;
  range_search_ = RangeSearch();
  {
    const std::lock_guard<std::mutex> lock(patience_mutex_);
    begun_.reset();
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.error = line;
    status_.error_code = code;
    status_.failed_revision = wanted_.revision;
    if (status_.series.search != search_) status_.series = {search_, {}};
  }
  events_.changed();
}

void LiveFields::beginSearch() {
  search_ = wanted_.search;
  if (!source_) return endSearch({});
  range_search_ = RangeSearch(source_->count());
}

void LiveFields::endSearch(const ValueRange& range) {
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.series = {search_, range};
}

std::optional<int> LiveFields::idleStep() const {
  if (!source_) return std::nullopt;
  if (is_playing_) {
    const int last = std::min(index_ + options_.steps_ahead, source_->count() - 1);
    for (int index = index_ + 1; index <= last; ++index) {
      if (!cache_.find(index) && cache_.wouldKeep(index, distance())) return index;
    }
  }
  return range_search_.next();
}

void LiveFields::doIdleWork(int index) {
  try {
    const Shown wanted = shownOf(wanted_);
    begin("range of the series");
    if (!(wanted == content_->shown)) change(wanted);  // after an abandoned field
    const Frame* cached = cached_ == content_ ? cache_.find(index) : nullptr;
    const Frame frame = cached ? *cached : compute(source_->time_s(index), false);
    if (range_search_.next() == index) {
      range_search_.add(frame.info());
      if (!range_search_.next()) endSearch(range_search_.range());
    }
    events_.changed();
  } catch (const Stopped&) {
  } catch (const std::exception& error) {
    is_playing_ = false;
    fail(failureLine(error), codeOf(error));
  }
  const std::lock_guard<std::mutex> lock(patience_mutex_);
  begun_.reset();
}

void LiveFields::waitUntil(Time time) {
  {
    const std::lock_guard<std::mutex> lock(patience_mutex_);
    begun_.reset();
  }
  event_.waitUntil(time);
  const std::lock_guard<std::mutex> lock(mutex_);
  ++status_.wake_ups;
}

void LiveFields::wait() {
  event_.wait();
  const std::lock_guard<std::mutex> lock(mutex_);
  ++status_.wake_ups;
}

StepCache<Frame>::Distance LiveFields::distance() const {
  return [this](int index) {
    const long long steps = static_cast<long long>(index) - index_;
    return steps >= 0 ? steps : options_.steps_ahead - steps;
  };
}

}  // namespace emscape::playback
