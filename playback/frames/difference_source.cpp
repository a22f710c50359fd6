#include "playback/frames/difference_source.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <utility>

#include "emscape/base/error.h"
#include "volume/difference.h"

namespace emscape::playback {
namespace {

constexpr std::size_t kCacheBytes = std::size_t{512} << 20;
/// Times closer than this are the same step (s).
constexpr double kSameTime_s = 1e-6;

/// The values in host memory, copied only if necessary. info is not that of `volume`.
std::shared_ptr<const volume::DenseVolume> valuesOf(const volume::Volume& volume) {
  return volume.dense() ? volume.dense() : volume.host();
}

}  // namespace

volume::Volume differenceOf(const volume::Volume& a, const volume::Volume& b, const std::string& reference) {
  volume::DenseVolume made = volume::difference(*valuesOf(a), *valuesOf(b));
  made.info.time_s = a.info().time_s;
  made.info.time_utc = a.info().time_utc;
  made.info.extra[kDifferenceToKey] = reference;
  return volume::Volume(std::move(made));
}

DifferenceSource::DifferenceSource(std::unique_ptr<FrameSource> source, Open open, std::string name,
                                   bool compares)
    : source_(std::move(source)),
      open_(std::move(open)),
      name_(std::move(name)),
      compares_(compares),
      cache_(kCacheBytes) {}

Frame DifferenceSource::frame(int index) {
  Frame frame = source_->frame(index);
  if (!compares_) return frame;
  const volume::VolumeInfo& info = frame.info();
  if (frame.cells) {
    throw Error(ErrorCode::usage,
                info.quantity + ": fields on tetrahedra are not compared; their volumes are");
  }
  volume::requireDifference(info.quantity, info.categorical);
  frame.volume = differenceOf(frame.volume, referenceVolume(time_s(index)), name_);
  frame.changed = true;
  if (range_) {
    std::vector<volume::Volume> one{frame.volume};
    setRanges(one, {*range_});
    frame.volume = one.front();
  }
  return frame;
}

FrameSource& DifferenceSource::reference() {
  if (!reference_) {
    std::unique_ptr<FrameSource> opened = open_();
    if (quantity_) opened->setQuantity(*quantity_);
    reference_ = std::move(opened);
  }
  return *reference_;
}

volume::Volume DifferenceSource::referenceVolume(double time_s) {
  FrameSource& source = reference();
  const int index = source.nearestIndex(time_s);
  if (std::abs(source.time_s(index) - time_s) > kSameTime_s) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{} has no step at {:g} s to compare with; the nearest is at {:g} s", name_,
                            time_s, source.time_s(index)));
  }
  if (const Frame* kept = cache_.find(index)) return kept->volume;
  Frame frame = source.frame(index);
  cache_.keep(index, frame, [index](int other) { return std::abs(static_cast<long long>(other) - index); });
  return frame.volume;
}

std::vector<std::string> DifferenceSource::warnings() const {
  std::vector<std::string> all = source_->warnings();
  if (!reference_) return all;
  for (const std::string& warning : reference_->warnings()) {
    all.push_back(name_ + ": " + warning);
  }
  return all;
}

void DifferenceSource::setScenario(std::shared_ptr<const scenario::Scenario> scenario) {
  source_->setScenario(std::move(scenario));
}

void DifferenceSource::setQuantity(const std::string& quantity) {
  source_->setQuantity(quantity);
  quantity_ = quantity;
  cache_.clear();
  if (reference_) reference_->setQuantity(quantity);
}

void DifferenceSource::findRange(const ProgressSink& progress) {
  ValueRange range;
  range_.reset();
  for (int index = 0; index < count(); index += rangeSearchStride(count())) {
    const volume::VolumeInfo info = frame(index).volume.info();
    range.add({info.range_min, info.range_max});
    if (progress) progress("value range", static_cast<double>(index + 1) / count());
  }
  if (!range.empty()) range_ = range;
}

}  // namespace emscape::playback
