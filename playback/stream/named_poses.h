/// Poses of platforms by their names: what stays the same when a scenario is made anew or edited.
#pragma once

#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "emscape/playback/frames/frame_source.h"

namespace emscape::playback {

struct NamedPose {
  std::string platform;
  scenario::SitePosition position;
  scenario::Attitude attitude;
  bool is_present = true;  ///< false: it was there last
};

using NamedPosesPtr = std::shared_ptr<const std::vector<NamedPose>>;

/// Indices of the platforms of a scenario by the names that poses have.
using PlatformIndices = std::unordered_map<std::string, int>;
PlatformIndices platformIndices(const scenario::Scenario& scenario);

/// The poses for a scenario; those of other platforms are left out.
/// @param arrival_s  of the last record in them (steady clock); 0: none came
/// @param has_stopped  the stream, since then
PosesPtr posesOf(const PlatformIndices& indices, const std::vector<NamedPose>& poses, double arrival_s,
                 bool has_stopped = false);

}  // namespace emscape::playback
