/// Differences of volumes to those of a reference. Internal to the module.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/playback/frames/field_series.h"
#include "playback/frames/step_cache.h"

namespace emscape::playback {

/// Key of VolumeInfo::extra for the name of a difference's reference.
constexpr const char* kDifferenceToKey = "difference_to";

/// Differences of volumes to those of a reference series at the same times. The reference's volumes are
/// cached. For one thread.
class DifferenceSeries {
 public:
  using Open = std::function<std::shared_ptr<VolumeSeries>()>;

  /// @param open         opens the reference, when a difference is first requested. May throw Error
  /// @param name         of the reference, for legends and messages
  /// @param cache_bytes  of the reference's volumes; those of one step are kept in any case
  DifferenceSeries(Open open, std::string name, std::size_t cache_bytes);

  /// volume::difference() of each volume and that of the reference at a time. The results are in host memory
  /// and have the time of `volumes`.
  /// @throws Error (bad_input) if the reference has no volumes at that time or other volumes, as
  /// volume::difference(), (device); Stopped
  std::vector<volume::Volume> of(const std::vector<volume::Volume>& volumes, double time_s);
  /// The volumes of the reference. @throws as of()
  const std::vector<volume::Volume>& reference(double time_s);
  /// @return the warnings of the other series, followed by those that only the reference has, which name it
  std::vector<std::string> warnings(std::vector<std::string> others) const;
  /// Drops the cached volumes.
  void clear() {
    cache_.clear();
    between_s_.reset();
  }
  std::size_t cachedBytes() const { return cache_.bytes(); }

 private:
  const Open open_;
  const std::string name_;
  std::shared_ptr<VolumeSeries> reference_;
  StepCache<std::vector<volume::Volume>> cache_;
  std::optional<double> between_s_;      // time of between_
  std::vector<volume::Volume> between_;  // the last volumes that are not of a step
};

}  // namespace emscape::playback
