/// Platforms at stated poses. Internal to the module.
#pragma once

#include <vector>

#include "emscape/scenario/model/poses.h"

namespace emscape::scenario {

/// The pose of each platform; null: none is stated. @throws Error (usage) as withPoses()
std::vector<const PlatformPose*> posesByPlatform(const Scenario& scenario,
                                                 const std::vector<PlatformPose>& poses);

/// The platform as a fixed site at the pose.
Platform posed(const Platform& platform, const PlatformPose& pose);

}  // namespace emscape::scenario
