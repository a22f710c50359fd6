#include "apps/view/tools/probe_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/text/failure_text.h"
#include "base/thread_arena.h"
#include "emscape/base/error.h"
#include "emscape/base/work.h"
#include "emscape/playback/frames/field_series.h"

namespace emscape::view {
namespace {

constexpr std::size_t kMaxTimes = 500;
constexpr int kHistoryNiceness = 10;

emfield::FieldOptions optionsOf(const HistoryQuestion& question) {
  auto surface = std::make_shared<emfield::Surface>();
  surface->width = surface->height = 1;
  surface->positions.push_back({question.latitude_deg, question.longitude_deg});
  surface->reference = emfield::HeightReference::mean_sea_level;
  surface->heights_m = {question.height_msl_m};
  emfield::FieldOptions options;
  options.quantities = {question.channel.substr(0, question.channel.find(':'))};
  options.surface = surface;
  options.allow_missing_terrain = true;
  return options;
}

/// @throws Error (bad_input) if the scenario has no such channel
std::size_t channelIn(const playback::FieldSeries& series, const std::string& name) {
  const std::vector<emfield::Channel>& all = series.channels();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& channel) { return channel.name == name; });
  if (found == all.end()) throw Error(ErrorCode::bad_input, "no values over time for " + name);
  return static_cast<std::size_t>(found - all.begin());
}

std::vector<double> atMost(std::size_t count, const std::vector<double>& times_s) {
  if (times_s.size() <= count) return times_s;
  std::vector<double> kept;
  for (std::size_t i = 0; i < count; ++i) kept.push_back(times_s[i * (times_s.size() - 1) / (count - 1)]);
  return kept;
}

}  // namespace

bool HistoryQuestion::operator==(const HistoryQuestion& other) const {
  return input.scenario == other.input.scenario && input.terrain == other.input.terrain &&
         channel == other.channel && latitude_deg == other.latitude_deg &&
         longitude_deg == other.longitude_deg && height_msl_m == other.height_msl_m &&
         times_s == other.times_s;
}

ProbeHistory::ProbeHistory(std::function<void()> wake) : wake_(std::move(wake)) {}

ProbeHistory::~ProbeHistory() {
  clear();
}

void ProbeHistory::clear() {
  if (work_) work_->stop = true;
  work_.reset();
  question_ = {};
  values_ = {};
}

void ProbeHistory::ask(HistoryQuestion question) {
  question.times_s = atMost(kMaxTimes, question.times_s);
  if (work_ && question == question_) return;
  clear();
  question_ = question;
  work_ = std::make_shared<Work>();
  work_->values.times_s = question.times_s;
  work_->values.values.assign(question.times_s.size(), std::numeric_limits<float>::quiet_NaN());
  values_ = work_->values;
  worker_.push(
      [question = std::move(question), work = work_, wake = wake_] { compute(question, *work, wake); });
}

bool ProbeHistory::update() {
  if (!work_) return false;
  const std::lock_guard<std::mutex> lock(work_->mutex);
  if (work_->values.computed == values_.computed && work_->values.error == values_.error) return false;
  values_ = work_->values;
  return true;
}

void ProbeHistory::compute(const HistoryQuestion& question, Work& work, const std::function<void()>& wake) {
  if (work.stop) return;
  const auto fail = [&](const std::string& text) {
    const std::lock_guard<std::mutex> lock(work.mutex);
    work.values.error = text;
  };
  try {
    ThreadArena arena(1, kHistoryNiceness);
    arena.run([&] {
      playback::FieldSeries series(question.input, question.times_s, optionsOf(question), &work.stop);
      const std::size_t channel = channelIn(series, question.channel);
      for (int step = 0; step < series.count(); ++step) {
        const std::shared_ptr<const volume::DenseVolume> volume = series.compute(step)[channel].host();
        const float value =
            volume->isMasked(0, 0, 0) ? std::numeric_limits<float>::quiet_NaN() : volume->values[0];
        {
          const std::lock_guard<std::mutex> lock(work.mutex);
          work.values.values[static_cast<std::size_t>(step)] = value;
          work.values.computed = static_cast<std::size_t>(step) + 1;
          work.values.unit = volume->info.unit;
          work.values.floor = volume->info.floor;
        }
        if (wake) wake();
      }
    });
  } catch (const Stopped&) {
    return;
  } catch (const std::exception& error) {
    fail(failureText(error));
  }
  if (wake) wake();
}

std::string csvOf(const ValueHistory& history, const std::string& channel) {
  std::string text = fmt::format("t_s,\"{}\"\n", channel);
  for (std::size_t i = 0; i < history.computed; ++i) {
    const float value = history.values[i];
    const bool is_field = std::isfinite(value) && value > history.floor;
    text += fmt::format("{},{}\n", history.times_s[i], is_field ? fmt::format("{:.3f}", value) : "");
  }
  return text;
}

}  // namespace emscape::view
