#include "emscape/volume/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "emscape/base/error.h"
#include "emscape/base/parallel.h"

namespace emscape::volume {
namespace {

constexpr float kUnbounded = std::numeric_limits<float>::infinity();

/// Reduces every layer of a volume in parallel, and then the layers in order, so that the result does not
/// depend on the threads. Calls visit(part, value, masked) for each voxel; part += other joins two.
template <class Part, class Visit>
Part foldLayers(const DenseVolume& volume, const Part& start, const Visit& visit) {
  const Dims& dims = volume.grid.dims;
  std::vector<Part> layers(static_cast<std::size_t>(dims.z), start);
  parallelFor(dims.z, 1, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      Part part = start;
      for (int j = 0; j < dims.y; ++j) {
        const float* row = volume.values.data() + volume.grid.index(0, j, k);
        for (int i = 0; i < dims.x; ++i) visit(part, row[i], volume.isMasked(i, j, k));
      }
      layers[static_cast<std::size_t>(k)] = std::move(part);
    }
  });
  Part sum = start;
  for (const Part& layer : layers) sum += layer;
  return sum;
}

struct Moments {
  long long valid = 0, masked = 0, nan = 0, at_floor = 0;
  float min = kUnbounded, max = -kUnbounded;
  double sum = 0;

  void operator+=(const Moments& other) {
    valid += other.valid;
    masked += other.masked;
    nan += other.nan;
    at_floor += other.at_floor;
    min = std::min(min, other.min);
    max = std::max(max, other.max);
    sum += other.sum;
  }
};

struct Bins {
  std::vector<long long> counts;
  long long below = 0, above = 0;

  void operator+=(const Bins& other) {
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += other.counts[i];
    below += other.below;
    above += other.above;
  }
};

struct Range {
  float min = kUnbounded, max = -kUnbounded;

  void operator+=(const Range& other) {
    min = std::min(min, other.min);
    max = std::max(max, other.max);
  }
};

}  // namespace

Statistics statisticsOf(const DenseVolume& volume) {
  const float floor = volume.info.floor;
  const Moments moments = foldLayers(volume, Moments(), [floor](Moments& part, float value, bool masked) {
    if (masked) {
      ++part.masked;
    } else if (std::isnan(value)) {
      ++part.nan;
    } else {
      ++part.valid;
      if (value == floor) ++part.at_floor;
      part.min = std::min(part.min, value);
      part.max = std::max(part.max, value);
      part.sum += value;
    }
  });
  Statistics statistics;
  statistics.voxels = volume.grid.dims.count();
  statistics.valid = moments.valid;
  statistics.masked = moments.masked;
  statistics.nan = moments.nan;
  statistics.at_floor = moments.at_floor;
  if (moments.valid > 0) {
    statistics.min = moments.min;
    statistics.max = moments.max;
    statistics.mean = moments.sum / static_cast<double>(moments.valid);
  }
  return statistics;
}

Histogram histogramOf(const DenseVolume& volume, int bins, float lower, float upper) {
  if (bins < 1 || bins > 65536) {
    throw Error(ErrorCode::bad_input, "histogram of " + std::to_string(bins) + " bins: must be 1..65536");
  }
  if (!std::isfinite(lower) || !std::isfinite(upper) || lower >= upper) {
    throw Error(ErrorCode::bad_input, "histogram from " + std::to_string(lower) + " to " +
                                          std::to_string(upper) +
                                          ": both must be finite and the first the lesser");
  }
  const double scale = bins / (static_cast<double>(upper) - lower);
  Bins start;
  start.counts.assign(static_cast<std::size_t>(bins), 0);
  const Bins sums = foldLayers(volume, start, [=](Bins& part, float value, bool masked) {
    if (masked || std::isnan(value)) return;
    if (value < lower) {
      ++part.below;
    } else if (value > upper) {
      ++part.above;
    } else {
      const int bin = static_cast<int>((static_cast<double>(value) - lower) * scale);
      ++part.counts[static_cast<std::size_t>(std::min(bin, bins - 1))];
    }
  });
  return {lower, upper, sums.counts, sums.below, sums.above};
}

bool holdsNothing(const VolumeInfo& info) {
  return info.floor != kNoFloor && info.range_min == info.floor && info.range_max == info.floor;
}

void setRangeFromValues(DenseVolume& volume) {
  const float floor = volume.info.floor;
  const Range range = foldLayers(volume, Range(), [floor](Range& part, float value, bool masked) {
    if (masked || !std::isfinite(value) || value == floor) return;
    part.min = std::min(part.min, value);
    part.max = std::max(part.max, value);
  });
  const bool any = range.min <= range.max;
  const float empty = floor == kNoFloor ? 0 : floor;
  volume.info.range_min = any ? range.min : empty;
  volume.info.range_max = any ? range.max : empty;
}

}  // namespace emscape::volume
