#include "playback/frames/difference_source.h"

#include <utility>

namespace emscape::playback {
namespace {

constexpr std::size_t kCacheBytes = std::size_t{512} << 20;

}  // namespace

DifferenceSource::DifferenceSource(std::unique_ptr<FrameSource> source, Open open, std::string name,
                                   bool compares)
    : source_(std::move(source)),
      compares_(compares),
      difference_(
          [this, open = std::move(open)] {
            std::unique_ptr<FrameSource> opened = open();
            if (quantity_) opened->setQuantity(*quantity_);
            reference_ = opened.get();
            return opened;
          },
          std::move(name), kCacheBytes) {}

Frame DifferenceSource::makeFrame(int index) {
  Frame frame = source_->frame(index);
  if (!compares_) return frame;
  frame.volume = difference_.of({comparableVolume(frame)}, time_s(index)).front();
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
