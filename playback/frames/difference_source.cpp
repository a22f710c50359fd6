#include "playback/frames/difference_source.h"

#include <utility>

namespace emscape::playback {
DifferenceSource::DifferenceSource(std::unique_ptr<FrameSource> source, Open open,
                                   const DifferenceReference& reference, bool compares)
    : source_(std::move(source)),
      compares_(compares),
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
  if (!compares_) return frame;
  frame.volume = difference_.of({comparableVolume(frame)}, frame.info().time_s).front();
  frame.changed = true;
  return frame;
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
