#include "apps/view/files/recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "base/stopwatch.h"
#include "base/text/failure_text.h"
#include "base/thread_arena.h"
#include "emscape/base/error.h"
#include "emscape/base/parallel.h"
#include "emscape/base/work.h"
#include "emscape/scenario/file/scenario_file.h"
#include "playback/pictures/picture_series.h"
#include "playback/pictures/picture_sink.h"

namespace emscape::view {
namespace {

bool isVideo(const std::string& output) {
  return std::filesystem::path(output).extension() == ".mp4";
}

/// Draws all pictures. @param done  called with the number of pictures so far and the total number
void draw(const RecordJob& job, const StopFlag& stop, const std::function<void(int, int)>& done) {
  playback::FrameSelection selection(job.view);
  selection.times = job.times;
  selection.opened = job.opened;
  selection.independent = true;  // each picture equals the window's at its time
  const auto source = playback::openFrameSource(selection, job.target, {}, &stop);
  std::vector<std::unique_ptr<playback::PictureSink>> sinks;
  const playback::LoadedScenario* const scene = source->scene();
  sinks.push_back(
      playback::makePictureSink(job.output, source->name(), source->count(), job.view.size, job.frames_per_s,
                                scene != nullptr ? changesOf(*scene->scenario) : "", job.replaces));
  done(0, source->count());
  playback::Painter painter(job.view, *source, job.target, /*must_show_isosurface=*/false);
  const std::optional<double> frames_per_s =
      isVideo(job.output) ? std::optional(job.frames_per_s) : std::nullopt;
  const playback::Film film = playback::filmOf(job.view, *source, frames_per_s);
  painter.setSpeed(film.speed);
  painter.setFrame(source->frame(0));
  playback::drawPictures(
      *source, painter, render::FramePlan::exact(), sinks, film,
      [&](int pictures) { done(pictures, source->count()); }, &stop);
}

}  // namespace

RecordEstimate estimateOf(const RecordRange& range, double begin_s, double end_s, double step_s,
                          render::ImageSize size, double picture_ms, bool is_video) {
  // Measured on recordings of the shipped scenarios, whose pictures differ little from each other.
  constexpr double kBytesPerPixel = 0.55, kVideoBytesPerPixel = 0.03;
  RecordEstimate estimate;
  if (!(step_s > 0) || !(end_s >= begin_s)) return estimate;
  const double pictures = std::min(1e9, std::floor((end_s - begin_s) / step_s + 1e-9) + 1);
  estimate.pictures = static_cast<int>(pictures);
  estimate.film_s = pictures / range.frames_per_s;
  estimate.speed = step_s * range.frames_per_s;
  estimate.work_s = pictures * picture_ms / 1000;
  estimate.bytes =
      pictures * static_cast<double>(size.count()) * (is_video ? kVideoBytesPerPixel : kBytesPerPixel);
  return estimate;
}

void FieldTimes::add(long long fields, double field_ms) {
  constexpr std::size_t kMost = 9;
  const bool is_first = fields_ == 0;  // also reads terrain and antennas
  if (std::exchange(fields_, fields) == fields || is_first) return;
  last_ms_.push_back(field_ms);
  if (last_ms_.size() > kMost) last_ms_.pop_front();
}

double FieldTimes::usual_ms() const {
  if (last_ms_.empty()) return 0;
  std::vector<double> sorted(last_ms_.begin(), last_ms_.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted[(sorted.size() - 1) / 2];
}

Recorder::~Recorder() {
  cancel();
}

void Recorder::start(const RecordJob& job, std::function<void()> wake) {
  if (running()) {
    throw Error(ErrorCode::usage, fmt::format("{} is being recorded: cancel it first, or wait", output_));
  }
  stop_ = false;
  output_ = job.output;
  counter_ = std::make_shared<Counter>();
  task_.start([this, job, wake = std::move(wake), counter = counter_]() -> Outcome {
    Outcome outcome;
    try {
      // Leaves one core to the window.
      ThreadArena arena(threadCount() - 1);
      arena.run([&] {
        Stopwatch watch;
        double since_first_s = 0;
        draw(job, stop_, [&](int pictures, int total) {
          const double picture_s = watch.lap_ms() / 1000;
          if (pictures > 1) {
            since_first_s += picture_s;
            counter->left_s = since_first_s / (pictures - 1) * (total - pictures);
          }
          counter->pictures = pictures;
          counter->total = total;
          if (wake) wake();
        });
      });
      outcome.text = fmt::format("recorded {} picture{}: {}", counter->total.load(),
                                 counter->total == 1 ? "" : "s", job.output);
    } catch (const Stopped&) {
      outcome.is_complete = false;
      outcome.text = "recording cancelled: ";
      outcome.text += isVideo(job.output)
                          ? fmt::format("{} is not written", job.output)
                          : fmt::format("{} of {} pictures are in {}", counter->pictures.load(),
                                        counter->total.load(), job.output);
    } catch (const std::exception& error) {
      outcome = {failureText(error), true, false};
    }
    if (wake) wake();
    return outcome;
  });
}

Recorder::Progress Recorder::progress() const {
  return {output_, counter_->pictures, counter_->total, counter_->left_s};
}

std::optional<Recorder::Outcome> Recorder::takeOutcome() {
  if (!task_.done()) return std::nullopt;
  return task_.take();
}

}  // namespace emscape::view
