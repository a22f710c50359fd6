#include "playback/frames/difference_series.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <set>
#include <utility>

#include "emscape/base/error.h"
#include "volume/difference.h"

namespace emscape::playback {
namespace {

/// Times closer than this are the same step (s).
constexpr double kSameTime_s = 1e-6;

/// The values in host memory, copied only if necessary. info is not that of `volume`.
std::shared_ptr<const volume::DenseVolume> valuesOf(const volume::Volume& volume) {
  return volume.dense() ? volume.dense() : volume.host();
}

}  // namespace

DifferenceSeries::DifferenceSeries(Open open, std::string name, std::size_t cache_bytes)
    : open_(std::move(open)), name_(std::move(name)), cache_(cache_bytes) {}

std::vector<volume::Volume> DifferenceSeries::of(const std::vector<volume::Volume>& volumes, double time_s) {
  const std::vector<volume::Volume>& others = reference(time_s);
  if (others.size() != volumes.size())
    throw Error(ErrorCode::bad_input, name_ + " has other quantities or emitters in it");
  std::vector<volume::Volume> differences;
  for (std::size_t c = 0; c < volumes.size(); ++c) {
    volume::DenseVolume made = volume::difference(*valuesOf(volumes[c]), *valuesOf(others[c]));
    made.info.time_s = volumes[c].info().time_s;
    made.info.time_utc = volumes[c].info().time_utc;
    made.info.extra[kDifferenceToKey] = name_;
    differences.emplace_back(std::move(made));
  }
  return differences;
}

const std::vector<volume::Volume>& DifferenceSeries::reference(double time_s) {
  if (!reference_) reference_ = open_();
  const int step = reference_->nearestIndex(time_s);
  if (std::abs(reference_->time_s(step) - time_s) > kSameTime_s) {
    if (reference_->isContinuous()) {
      if (between_s_ != time_s) {
        between_s_.reset();
        between_ = reference_->computeAt(time_s);
        between_s_ = time_s;
      }
      return between_;
    }
    throw Error(ErrorCode::bad_input,
                fmt::format("{} has no step at {:g} s to compare with; the nearest is at {:g} s", name_,
                            time_s, reference_->time_s(step)));
  }
  if (!cache_.find(step)) {
    cache_.keep(step, reference_->compute(step),
                [step](int other) { return std::abs(static_cast<long long>(other) - step); });
  }
  return *cache_.find(step);
}

std::vector<std::string> DifferenceSeries::warnings(std::vector<std::string> others) const {
  if (!reference_) return others;
  const std::set<std::string> of_both(others.begin(), others.end());
  for (const std::string& warning : reference_->warnings()) {
    if (of_both.count(warning) == 0) others.push_back(name_ + ": " + warning);
  }
  return others;
}

}  // namespace emscape::playback
