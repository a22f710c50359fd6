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
#include "playback/difference_source.h"
#include "playback/platform_tracks.h"

namespace emscape::playback {
namespace {

std::vector<double> timesOf(const FrameSelection& selection, const scenario::Clock& clock) {
  if (selection.first_only) return {0.0};
  return selection.times.empty() ? scenario::timesOf(clock) : scenario::parseTimes(selection.times, clock);
}

/// The one quantity that is needed: "snr_db" of the channel "snr_db:search radar".
std::vector<std::string> quantitiesOf(const std::string& quantity, const scenario::Scenario& scenario) {
  return {quantity.empty() ? scenario.output.quantities.front() : quantity.substr(0, quantity.find(':'))};
}

emfield::FieldOptions fieldOptionsOf(const FrameSelection& selection, const ComputeTarget& target,
                                     const scenario::Scenario& scenario) {
  emfield::FieldOptions options = target.fieldOptions();
  options.quantities = quantitiesOf(selection.quantity, scenario);
  options.allow_missing_terrain = selection.allow_missing_terrain;
  if (selection.independent) options.move_tolerance_m = 0;
  return options;
}

std::size_t channelOf(const std::vector<emfield::Channel>& channels, const std::string& name) {
  if (name.find(':') == std::string::npos) return 0;
  std::string names;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c].name == name) return c;
    names += (c == 0 ? "" : ", ") + channels[c].name;
  }
  throw Error(ErrorCode::usage,
              fmt::format("quantity '{}': there is no such channel; there are {}", name, names));
}

/// A scenario's frames, computed as they are asked for.
class ComputedFrames : public FrameSource {
 public:
  ComputedFrames(const LoadedScenario& input, const FrameSelection& selection, const ComputeTarget& target,
                 const ProgressSink& progress, const StopFlag* stop)
      : selection_(selection),
        series_(std::make_unique<FieldSeries>(input, timesOf(selection, input.scenario->clock),
                                              fieldOptionsOf(selection, target, *input.scenario), stop)) {
    range_ = rangeOf(*series_, selection.quantity, progress);
  }

  int count() const override { return series_->count(); }
  double time_s(int index) const override { return series_->time_s(index); }
  Frame frame(int index) override {
    std::vector<volume::Volume> volumes = series_->compute(index);
    std::vector<volume::Volume> chosen{volumes[channelOf(series_->channels(), selection_.quantity)]};
    if (range_) setRanges(chosen, {*range_});
    const volume::Volume& volume = chosen.front();
    const LoadedScenario& input = series_->input();
    return {volume, markersOf(series_->snapshot(index), input.terrain.get(), volume.grid()),
            tracks_.at(series_->time_s(index), input, volume.grid()), series_->changed()};
  }
  std::string name() const override { return series_->input().scenario->name; }
  const LoadedScenario* scene() const override { return &series_->input(); }
  std::vector<std::string> warnings() const override { return series_->warnings(); }

  void setScenario(std::shared_ptr<const scenario::Scenario> scenario) override {
    std::vector<double> times_s = timesOf(selection_, scenario->clock);
    series_->setScenario(withScenario(series_->input(), std::move(scenario)), std::move(times_s));
  }
  void setQuantity(const std::string& quantity) override {
    emfield::FieldOptions options = series_->options();
    options.quantities = quantitiesOf(quantity, *series_->input().scenario);
    auto series =
        std::make_unique<FieldSeries>(series_->input(), series_->times_s(), options, series_->stopFlag());
    range_ = rangeOf(*series, quantity, {});
    series_ = std::move(series);
    selection_.quantity = quantity;
  }

 private:
  /// That of all frames; none if each has its own.
  std::optional<ValueRange> rangeOf(FieldSeries& series, const std::string& quantity,
                                    const ProgressSink& progress) const {
    const std::size_t channel = channelOf(series.channels(), quantity);
    if (selection_.range || selection_.independent) return selection_.range;
    return series.findRanges(rangeSearchStride(series.count()), progress)[channel];
  }

  FrameSelection selection_;
  std::unique_ptr<FieldSeries> series_;
  std::optional<ValueRange> range_;
  PlatformTracks tracks_;
};

/// Volumes from files.
class StoredFrames : public FrameSource {
 public:
  StoredFrames(const FrameSelection& selection, const StopFlag* stop)
      : stop_(stop), quantity_(selection.quantity), selection_(selection), files_(filesOf(quantity_)) {
    if (!selection.scenario.empty()) {
      scene_ = loadScenarioWithTerrain(selection.scenario, selection.edits);
    } else if (!selection.edits.empty()) {
      throw Error(ErrorCode::usage, "edits change a scenario; volumes have none unless --scenario names one");
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
    if (selection_.range) {
      info.range_min = selection_.range->min;
      info.range_max = selection_.range->max;
    }
    Frame frame{{volume, info}, {}, {}, true};
    if (scene_ && volume->grid.georeferenced) {
      const scenario::Snapshot snapshot =
          scenario::snapshotAt(scene_->scenario, scene_->terrain.get(), volume->info.time_s);
      frame.markers = markersOf(snapshot, scene_->terrain.get(), volume->grid);
      frame.tracks = tracks_.at(volume->info.time_s, *scene_, volume->grid);
    }
    return frame;
  }
  std::string name() const override { return name_; }
  const LoadedScenario* scene() const override { return scene_ ? &*scene_ : nullptr; }
  std::vector<std::string> warnings() const override { return {}; }

  void setScenario(std::shared_ptr<const scenario::Scenario> scenario) override {
    if (!scene_) return FrameSource::setScenario(std::move(scenario));
    scene_ = withScenario(*scene_, std::move(scenario));
    name_ = scene_->scenario->name;
  }
  void setQuantity(const std::string& quantity) override {
    std::string chosen = quantity;
    files_ = filesOf(chosen);
    quantity_ = chosen;
  }

 private:
  /// The files to be shown. @param quantity  as for volumeFilesOf()
  std::vector<VolumeFile> filesOf(std::string& quantity) const {
    return chosenFiles(volumeFilesOf(selection_.input, quantity), selection_.times, selection_.first_only);
  }

  const StopFlag* const stop_;
  std::string quantity_;
  const FrameSelection selection_;
  std::vector<VolumeFile> files_;
  std::optional<LoadedScenario> scene_;
  std::string name_;
  PlatformTracks tracks_;
};

}  // namespace

void FrameSource::setScenario(std::shared_ptr<const scenario::Scenario> /*scenario*/) {
  throw Error(ErrorCode::usage, name() + ": volumes without a scenario cannot be edited");
}

void FrameSource::setComparison(bool on) {
  if (on) throw Error(ErrorCode::usage, name() + ": there is nothing to compare with");
}

void FrameSource::setQuantity(const std::string& quantity) {
  throw Error(ErrorCode::usage, fmt::format("quantity '{}': {} holds one quantity alone", quantity, name()));
}

int FrameSource::nearestIndex(double time_s) const {
  int first = 0, last = count() - 1;
  while (last - first > 1) {  // time_s(first) <= time_s < time_s(last), or time_s is beyond an end
    const int middle = first + (last - first) / 2;
    (this->time_s(middle) <= time_s ? first : last) = middle;
  }
  return std::abs(this->time_s(last) - time_s) < std::abs(this->time_s(first) - time_s) ? last : first;
}

namespace {

std::unique_ptr<FrameSource> openField(const FrameSelection& selection, const ComputeTarget& target,
                                       const ProgressSink& progress, const StopFlag* stop) {
  switch (inputKindOf(selection.input)) {
    case InputKind::scenario:
      return std::make_unique<ComputedFrames>(loadScenarioWithTerrain(selection.input, selection.edits),
                                              selection, target, progress, stop);
    case InputKind::volume:
      return std::make_unique<StoredFrames>(selection, stop);
    case InputKind::mesh:
      throw Error(
          ErrorCode::usage,
          selection.input + " holds fields on tetrahedra; pictures of them are drawn by emscape render");
    default:
      throw Error(ErrorCode::usage, selection.input + " is neither a scenario nor a volume");
  }
}

/// The reference of a selection's comparison.
FrameSelection referenceOf(const FrameSelection& selection) {
  FrameSelection reference = selection;
  reference.scenario.clear();
  reference.edits.clear();
  if (selection.compare.empty() || selection.compare == kOriginal) {
    if (inputKindOf(selection.input) != InputKind::scenario) {
      throw Error(ErrorCode::usage, selection.input +
                                        ": volumes have no original to compare with; name the other volumes "
                                        "in its place");
    }
    return reference;
  }
  reference.input = selection.compare;
  return reference;
}

std::unique_ptr<DifferenceSource> openComparison(const FrameSelection& selection, const ComputeTarget& target,
                                                 const StopFlag* stop) {
  FrameSelection field = selection;
  field.independent = true;
  const bool compares = !selection.compare.empty();
  if (compares) {
    field.range.reset();  // a range is that of the differences
    referenceOf(field);   // throws its faults now
  }
  const auto openReference = [field, target, stop] {
    return openField(referenceOf(field), target, {}, stop);
  };
  const std::string name =
      !compares || selection.compare == kOriginal ? "the original scenario" : selection.compare;
  return std::make_unique<DifferenceSource>(openField(field, target, {}, stop), openReference, name,
                                            compares);
}

}  // namespace

std::unique_ptr<FrameSource> openFrameSource(const FrameSelection& selection, const ComputeTarget& target,
                                             const ProgressSink& progress, const StopFlag* stop) {
  if (selection.compare.empty() && !selection.independent)
    return openField(selection, target, progress, stop);
  std::unique_ptr<DifferenceSource> source = openComparison(selection, target, stop);
  if (selection.range && !selection.compare.empty()) {
    source->setRange(*selection.range);
  } else if (!selection.independent && source->count() > 1) {
    source->findRange(progress);
  }
  return source;
}

}  // namespace emscape::playback
