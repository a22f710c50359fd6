#include "emscape/playback/frames/volume_series.h"

#include <cmath>

namespace emscape::playback {

int VolumeSeries::nearestIndex(double time_s) const {
  int first = 0, last = count() - 1;
  while (last - first > 1) {  // time_s(first) <= time_s < time_s(last), or time_s is beyond an end
    const int middle = first + (last - first) / 2;
    (this->time_s(middle) <= time_s ? first : last) = middle;
  }
  return std::abs(this->time_s(last) - time_s) < std::abs(this->time_s(first) - time_s) ? last : first;
}

}  // namespace emscape::playback
