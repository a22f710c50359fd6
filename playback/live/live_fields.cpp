#include "playback/live/live_fields.h"

#include <algorithm>
#include <chrono>

#include "base/stopwatch.h"
#include "emscape/base/parallel.h"
#include "emscape/playback/stop.h"
#include "playback/live/first_line.h"

namespace emscape::playback {
namespace {

using SteadyClock = std::chrono::steady_clock;

SteadyClock::duration milliseconds(double ms) {
  return std::chrono::duration_cast<SteadyClock::duration>(std::chrono::duration<double, std::milli>(ms));
}

std::vector<double> timesOf(const FrameSource& source) {
  std::vector<double> times_s;
  for (int index = 0; index < source.count(); ++index) times_s.push_back(source.time_s(index));
  return times_s;
}

/// Delay after a request before unrequested work starts.
constexpr double kQuiet_ms = 150;
/// A field that takes longer leaves a core free even if it is not needed yet.
constexpr double kLongField_ms = 200;

}  // namespace

LiveFields::LiveFields(Open open, FieldRequest first, const Options& options, Events events)
    : open_(std::move(open)),
      options_(options),
      events_(std::move(events)),
      arena_(options.threads > 0 ? options.threads : threadCount(), options.niceness),
      narrow_arena_(threadCount() - 1, options.niceness),
      cache_(options.cache_bytes) {
  compares_ = !first.view.compare.empty();
  wanted_ = first;
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
  return status_;
}

void LiveFields::run() {
  open();
  while (!stop_) {
    if (auto letter = box_.take()) accept(std::move(*letter));
    if (is_due_) {
      serve();
      continue;
    }
    const std::optional<int> step = idleStep();
    if (!step) {
      wait();
    } else if (SteadyClock::now() < quiet_from_) {
      waitUntil(quiet_from_);
    } else {
      doIdleWork(*step);
    }
  }
}

void LiveFields::open() {
  try {
    source_ = open_(stop_);
    if (!source_) return;
    if (const LoadedScenario* scene = source_->scene()) scenario_ = scene->scenario;
    quantity_ = quantityOf(wanted_);
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.scenario = scenario_;
    status_.quantities = source_->quantities();
    status_.times_s = timesOf(*source_);
  } catch (const std::exception& error) {
    source_ = nullptr;
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.error = failureLine(error);
    status_.error_code = codeOf(error);
  }
}

void LiveFields::accept(Mailbox<FieldRequest>::Letter letter) {
  asked_ = is_due_ ? std::min(asked_, letter.since) : letter.since;
  wanted_ = std::move(letter.value);
  is_due_ = true;
  quiet_from_ = SteadyClock::now() + milliseconds(kQuiet_ms);
  if (wanted_.search != search_) beginSearch();
}

void LiveFields::serve() {
  if (!source_) {  // the error has already been reported
    const FieldsStatus told = status();
    fail(told.error, told.error_code);
    return;
  }
  try {
    const bool is_changed = applyChanges();
    const int index = source_->nearestIndex(wanted_.view.time_s);
    const Frame* frame = cache_.find(index);
    if (!frame && !is_changed && field_begin_) {
      const Time may_begin = *field_begin_ + milliseconds(options_.min_seek_interval_ms);
      if (SteadyClock::now() < may_begin) return waitUntil(may_begin);
    }
    if (index != index_) is_playing_ = index == index_ + 1;
    index_ = index;
    deliver(frame ? *frame : compute(index));
  } catch (const Stopped&) {
  } catch (const std::exception& error) {
    fail(failureLine(error), codeOf(error));
  }
}

/// The name of the requested quantity: if the view has none, the first of the computed scenario.
std::string LiveFields::quantityOf(const FieldRequest& request) const {
  const bool is_computed = source_->scene() != nullptr && request.view.scenario.empty();
  if (!request.view.quantity.empty() || !is_computed) return request.view.quantity;
  return (request.scenario ? request.scenario : scenario_)->output.quantities.front();
}

/// Sets the requested scenario and quantity of the source. @return true if they have changed
bool LiveFields::applyChanges() {
  const std::string quantity = quantityOf(wanted_);
  const bool compares = !wanted_.view.compare.empty();
  const bool is_edited = wanted_.scenario && wanted_.scenario != scenario_;
  const bool is_other_quantity = quantity != quantity_;
  const bool is_other_comparison = compares != compares_;
  if (!is_edited && !is_other_quantity && !is_other_comparison) return false;
  if (is_edited) {
    source_->setScenario(wanted_.scenario);
    scenario_ = wanted_.scenario;
    cache_.clear();
  }
  if (is_other_quantity) {
    source_->setQuantity(quantity);
    quantity_ = quantity;
    cache_.clear();
  }
  if (is_other_comparison) {
    source_->setComparison(compares);
    compares_ = compares;
    cache_.clear();
  }
  if (range_search_.next()) beginSearch();
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.times_s = timesOf(*source_);
  status_.cached_steps.clear();
  return true;
}

Frame LiveFields::compute(int index) {
  Stopwatch watch;
  field_begin_ = SteadyClock::now();
  const FieldsStatus before = status();
  const bool shares = (events_.is_shared && events_.is_shared()) || before.field_ms > kLongField_ms;
  Frame frame;
  const bool leaves_a_core = options_.threads == 0 && shares && before.fields_computed > 0;
  (leaves_a_core ? narrow_arena_ : arena_).run([&] { frame = source_->frame(index); });
  cache_.keep(index, frame, distance());
  auto warnings = std::make_shared<const std::vector<std::string>>(source_->warnings());
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.warnings = std::move(warnings);
  status_.field_ms = watch.lap_ms();
  ++status_.fields_computed;
  status_.cached_steps = cache_.indices();
  return frame;
}

void LiveFields::deliver(const Frame& frame) {
  is_due_ = false;
  FieldDelivery delivery{wanted_.revision, source_->name(), std::nullopt, quantity_, frame};
  if (const LoadedScenario* scene = source_->scene()) delivery.scene = *scene;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.error.clear();
  }
  events_.deliver(std::move(delivery), asked_);
  events_.changed();
}

void LiveFields::fail(const std::string& line, ErrorCode code) {
  is_due_ = false;
  range_search_ = RangeSearch();
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
    const Frame* cached = cache_.find(index);
    const Frame frame = cached ? *cached : compute(index);
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
}

void LiveFields::waitUntil(Time time) {
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
