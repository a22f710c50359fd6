#include "playback/stream/named_poses.h"

namespace emscape::playback {

PlatformIndices platformIndices(const scenario::Scenario& scenario) {
  PlatformIndices indices;
  for (std::size_t p = 0; p < scenario.platforms.size(); ++p)
    indices.emplace(scenario.platforms[p].name, static_cast<int>(p));
  return indices;
}

PosesPtr posesOf(const PlatformIndices& indices, const std::vector<NamedPose>& poses) {
  auto found = std::make_shared<std::vector<scenario::PlatformPose>>();
  found->reserve(poses.size());
  for (const NamedPose& pose : poses) {
    if (!pose.position.height_msl_m) continue;  // it has had no sound pose yet
    const auto at = indices.find(pose.platform);
    if (at != indices.end()) found->push_back({at->second, pose.position, pose.attitude});
  }
  return found;
}

}  // namespace emscape::playback
