/// Platforms at stated poses, for the snapshot and for streams.
#pragma once

#include <string>
#include <vector>

#include "emscape/scenario/model/poses.h"

namespace emscape::scenario {

/// What is out of its range in a pose, such as "heading 400; allowed: -360..360 deg"; empty: nothing.
std::string poseFault(const SitePosition& position, const Attitude& attitude);

/// The pose of each platform; null: none is stated. @throws Error (usage) as withPoses()
std::vector<const PlatformPose*> posesByPlatform(const Scenario& scenario,
                                                 const std::vector<PlatformPose>& poses);

/// The platform as a fixed site at the pose.
Platform posed(const Platform& platform, const PlatformPose& pose);

}  // namespace emscape::scenario
