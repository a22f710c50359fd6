#include "playback/stream/named_poses.h"

#include "playback/stream/steady_time.h"

namespace emscape::playback {

PlatformIndices platformIndices(const scenario::Scenario& scenario) {
  PlatformIndices indices;
  for (std::size_t p = 0; p < scenario.platforms.size(); ++p)
    indices.emplace(scenario.platforms[p].name, static_cast<int>(p));
  return indices;
}

PosesPtr posesOf(const PlatformIndices& indices, const std::vector<NamedPose>& poses, double arrival_s,
                 bool has_stopped) {
  auto found = std::make_shared<StreamedPoses>();
  found->platforms.reserve(poses.size());
  found->told = arrival_s > 0 ? "live, " + utcTextOf(arrival_s) : "live, nothing received";
  if (has_stopped) found->told += ", stopped";
  for (const NamedPose& pose : poses) {
    if (!pose.position.height_msl_m) continue;  // it has had no sound pose yet
    const auto at = indices.find(pose.platform);
    if (at != indices.end())
      found->platforms.push_back({at->second, pose.position, pose.attitude, pose.is_present});
  }
  return found;
}

}  // namespace emscape::playback
