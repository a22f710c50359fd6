#include "emscape/playback/frame_source.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "emscape/base/error.h"
#include "emscape/playback/scene.h"
#include "emscape/playback/stop.h"
#include "emscape/playback/volume_input.h"
#include "emscape/volume/file.h"

namespace emscape::playback {
namespace {

std::vector<double> timesOf(const FrameSelection& selection, const scenario::Clock& clock) {
  if (selection.first_only) return {0.0};
  return selection.times.empty() ? scenario::timesOf(clock) : scenario::parseTimes(selection.times, clock);
}

/// The one quantity that is needed: "snr_db" of the channel "snr_db:search radar".
emfield::FieldOptions fieldOptionsOf(const FrameSelection& selection, const ComputeTarget& target,
                                     const scenario::Scenario& scenario) {
  emfield::FieldOptions options = target.fieldOptions();
  options.quantities = {selection.quantity.empty()
                            ? scenario.output.quantities.front()
                            : selection.quantity.substr(0, selection.quantity.find(':'))};
  options.allow_missing_terrain = selection.allow_missing_terrain;
  return options;
}

/// A scenario's frames, computed as they are asked for.
class ComputedFrames : public FrameSource {
 public:
  ComputedFrames(const LoadedScenario& input, const FrameSelection& selection, const ComputeTarget& target,
                 const ProgressSink& progress, const StopFlag* stop)
      : series_(input, timesOf(selection, input.scenario->clock),
                fieldOptionsOf(selection, target, *input.scenario), stop),
        channel_(channelOf(selection.quantity)) {
    if (selection.range) {
      ranges_.assign(series_.channels().size(), *selection.range);
      return;
    }
    // Beams come round: a part of the steps shows the range well enough for colours.
    constexpr int kMaxSteps = 24;
    ranges_ = series_.findRanges((count() + kMaxSteps - 1) / kMaxSteps, progress);
  }

  int count() const override { return series_.count(); }
  double time_s(int index) const override { return series_.time_s(index); }
  Frame frame(int index) override {
    std::vector<volume::Volume> volumes = series_.compute(index);
    setRanges(volumes, ranges_);
    const volume::Volume& volume = volumes[channel_];
    return {volume, markersOf(series_.snapshot(index), series_.input().terrain.get(), volume.grid()),
            series_.changed()};
  }
  std::string name() const override { return series_.input().scenario->name; }
  const LoadedScenario* scene() const override { return &series_.input(); }
  std::vector<std::string> warnings() const override { return series_.warnings(); }

 private:
  std::size_t channelOf(const std::string& name) const {
    if (name.find(':') == std::string::npos) return 0;
    std::string names;
    for (std::size_t c = 0; c < series_.channels().size(); ++c) {
      if (series_.channels()[c].name == name) return c;
      names += (c == 0 ? "" : ", ") + series_.channels()[c].name;
    }
    throw Error(ErrorCode::usage,
                fmt::format("quantity '{}': there is no such channel; there are {}", name, names));
  }

  FieldSeries series_;
  const std::size_t channel_;
  std::vector<ValueRange> ranges_;
};

/// Volumes from files.
class StoredFrames : public FrameSource {
 public:
  StoredFrames(const FrameSelection& selection, const StopFlag* stop)
      : stop_(stop),
        quantity_(selection.quantity),
        range_(selection.range),
        files_(volumeFilesOf(selection.input, quantity_)) {
    if (!selection.scenario.empty()) {
      scene_ = loadScenarioWithTerrain(selection.scenario, selection.edits);
    } else if (!selection.edits.empty()) {
      throw Error(ErrorCode::usage, "edits change a scenario; volumes have none unless one is named beside them");
    }
    if (selection.first_only) {
      files_.resize(1);
    } else if (!selection.times.empty()) {
      files_ = nearest(scenario::parseTimes(selection.times, clockOfFiles()));
    }
    namespace fs = std::filesystem;
    const fs::path input = selection.input;
    name_ = scene_ ? scene_->scenario->name
                   : (input.has_filename() ? input : input.parent_path()).stem().string();
  }

  int count() const override { return static_cast<int>(files_.size()); }
  double time_s(int index) const override { return files_[static_cast<std::size_t>(index)].time_s; }
  Frame frame(int index) override {
    throwIfStopped(stop_);
    auto volume = std::make_shared<const volume::DenseVolume>(
        volume::readVolume(files_[static_cast<std::size_t>(index)].file, quantity_));
    volume::VolumeInfo info = volume->info;
    if (range_) {
      info.range_min = range_->min;
      info.range_max = range_->max;
    }
    Frame frame{{volume, info}, {}, true};
    if (scene_ && volume->grid.georeferenced) {
      const scenario::Snapshot snapshot =
          scenario::snapshotAt(scene_->scenario, scene_->terrain.get(), volume->info.time_s);
      frame.markers = markersOf(snapshot, scene_->terrain.get(), volume->grid);
    }
    return frame;
  }
  std::string name() const override { return name_; }
  const LoadedScenario* scene() const override { return scene_ ? &*scene_ : nullptr; }
  std::vector<std::string> warnings() const override { return {}; }

 private:
  /// The time line of the files, for times on the command line that say no step.
  scenario::Clock clockOfFiles() const {
    scenario::Clock clock;
    clock.duration_s = files_.back().time_s;
    if (files_.size() > 1)
      clock.step_s = (files_.back().time_s - files_.front().time_s) / static_cast<double>(files_.size() - 1);
    if (clock.step_s <= 0) clock.step_s = 1;
    return clock;
  }

  std::vector<VolumeFile> nearest(const std::vector<double>& times_s) const {
    std::vector<VolumeFile> chosen;
    for (const double time_s : times_s) {
      chosen.push_back(
          *std::min_element(files_.begin(), files_.end(), [time_s](const VolumeFile& a, const VolumeFile& b) {
            return std::abs(a.time_s - time_s) < std::abs(b.time_s - time_s);
          }));
    }
    return chosen;
  }

  const StopFlag* const stop_;
  std::string quantity_;
  const std::optional<ValueRange> range_;
  std::vector<VolumeFile> files_;
  std::optional<LoadedScenario> scene_;
  std::string name_;
};

}  // namespace

int FrameSource::nearestIndex(double time_s) const {
  int first = 0, last = count() - 1;
  while (last - first > 1) {  // time_s(first) <= time_s < time_s(last), or time_s lies beyond an end
    const int middle = first + (last - first) / 2;
    (this->time_s(middle) <= time_s ? first : last) = middle;
  }
  return std::abs(this->time_s(last) - time_s) < std::abs(this->time_s(first) - time_s) ? last : first;
}

std::unique_ptr<FrameSource> openFrameSource(const FrameSelection& selection, const ComputeTarget& target,
                                             const ProgressSink& progress, const StopFlag* stop) {
  switch (inputKindOf(selection.input)) {
    case InputKind::scenario:
      return std::make_unique<ComputedFrames>(loadScenarioWithTerrain(selection.input, selection.edits),
                                              selection, target, progress, stop);
    case InputKind::volume:
      return std::make_unique<StoredFrames>(selection, stop);
    default:
      throw Error(ErrorCode::usage, selection.input + " is neither a scenario nor a volume");
  }
}

}  // namespace emscape::playback
