#include "playback/frames/difference_source.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "emscape/base/error.h"
#include "emscape/playback/frames/scene.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::playback {
DifferenceSource::DifferenceSource(std::unique_ptr<FrameSource> source, Open open,
                                   const DifferenceReference& reference, Comparison comparison)
    : source_(std::move(source)),
      comparison_(comparison),
      name_(reference.name),
      reference_is_continuous_(reference.is_continuous),
      difference_(
          [this, open = std::move(open)] {
            std::unique_ptr<FrameSource> opened = open();
            if (quantity_) opened->setQuantity(*quantity_);
            reference_ = opened.get();
            return opened;
          },
          reference.name, reference.cache_bytes) {}

Frame DifferenceSource::compared(Frame frame) {
  if (!compares()) return frame;
  frame.changed = true;
  if (comparison_ == Comparison::side_by_side) {
    frame.beside = besideOf(frame);
    return frame;
  }
  frame.volume = difference_.of({comparableVolume(frame)}, frame.info().time_s).front();
  return frame;
}

FieldBeside DifferenceSource::besideOf(const Frame& frame) {
  const double time_s = frame.info().time_s;
  auto other = std::make_shared<Frame>();
  comparableVolume(frame);  // throws for other fields
  other->volume = difference_.reference(time_s).front();
  const volume::VolumeInfo &own = frame.info(), &info = other->info();
  if (other->grid() != frame.grid()) {
    throw Error(ErrorCode::bad_input,
                name_ + " is on another grid: fields are drawn side by side on the same one");
  }
  if (info.quantity != own.quantity || info.unit != own.unit) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{} is {} in {}, the field {} in {}: only one quantity is drawn side by side",
                            name_, info.quantity, info.unit, own.quantity, own.unit));
  }
  const LoadedScenario* const scene = reference_->scene();
  if (scene != nullptr && frame.grid().georeferenced) {
    other->markers = markersOf(scenario::snapshotAt(scene->scenario, scene->terrain.get(), time_s),
                               scene->terrain, frame.grid());
    other->tracks = reference_tracks_.at(time_s, *scene, frame.grid());
  } else {
    other->markers = frame.markers;
    other->tracks = frame.tracks;
  }
  const bool is_same_name = source_->name() == reference_->name();
  return {std::move(other), std::filesystem::path(name_).filename().string(),
          is_same_name ? "with the changes" : source_->name()};
}

void DifferenceSource::setScenario(std::shared_ptr<const scenario::Scenario> scenario) {
  source_->setScenario(std::move(scenario));
}

void DifferenceSource::setQuantity(const std::string& quantity) {
  source_->setQuantity(quantity);
  quantity_ = quantity;
  difference_.clear();
  if (reference_ != nullptr) reference_->setQuantity(quantity);
}

}  // namespace emscape::playback
