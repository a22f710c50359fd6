#include "emscape/scenario/model/poses.h"

#include <fmt/format.h>

#include "base/geodesy/position_limits.h"
#include "emscape/base/error.h"
#include "scenario/model/named_items.h"
#include "scenario/model/posed_platform.h"

namespace emscape::scenario {
namespace {

/// @throws Error (usage)
void checkPose(const Scenario& scenario, const PlatformPose& pose) {
  const int count = static_cast<int>(scenario.platforms.size());
  if (pose.platform < 0 || pose.platform >= count) {
    throw Error(ErrorCode::usage, fmt::format("a pose of platform {}: the scenario has platforms 0..{}",
                                              pose.platform, count - 1));
  }
  const std::string fault = poseFault(pose.position, pose.attitude);
  if (fault.empty()) return;
  throw Error(ErrorCode::usage,
              fmt::format("the pose of platform '{}' has {}",
                          scenario.platforms[static_cast<std::size_t>(pose.platform)].name, fault));
}

}  // namespace

std::string poseFault(const SitePosition& at, const Attitude& attitude) {
  std::string fault;
  const auto check = [&fault](const char* what, double value, double low, double high, const char* unit) {
    if (fault.empty() && !(value >= low && value <= high))
      fault = fmt::format("{} {}; allowed: {}..{} {}", what, value, low, high, unit);
  };
  check("latitude", at.latitude_deg, -PositionLimits::kLatitude_deg, PositionLimits::kLatitude_deg, "deg");
  check("longitude", at.longitude_deg, -360, 360, "deg");
  const int heights = int{at.height_msl_m.has_value()} + int{at.height_agl_m.has_value()} +
                      int{at.height_ellipsoid_m.has_value()};
  check("a number of heights of", heights, 1, 1, "");
  const double height_m = at.height_msl_m   ? *at.height_msl_m
                          : at.height_agl_m ? *at.height_agl_m
                                            : at.height_ellipsoid_m.value_or(0);
  check("height", height_m, PositionLimits::kLowest_m, PositionLimits::kHighest_m, "m");
  check("heading", attitude.heading_deg, -360, 360, "deg");
  check("pitch", attitude.pitch_deg, -90, 90, "deg");
  check("roll", attitude.roll_deg, -360, 360, "deg");
  return fault;
}

std::vector<const PlatformPose*> posesByPlatform(const Scenario& scenario,
                                                 const std::vector<PlatformPose>& poses) {
  std::vector<const PlatformPose*> pose_of(scenario.platforms.size());
  for (const PlatformPose& pose : poses) {
    checkPose(scenario, pose);
    pose_of[static_cast<std::size_t>(pose.platform)] = &pose;
  }
  return pose_of;
}

Platform posed(const Platform& platform, const PlatformPose& pose) {
  Platform there;
  there.name = platform.name;
  there.track.emplace_back();
  there.track.front().position = pose.position;
  there.track.front().gap_after = !pose.is_present;
  there.attitude = pose.attitude;
  there.side = platform.side;
  there.sidc = platform.sidc;
  there.location = platform.location;
  return there;
}

SitePosition positionMsl(double latitude_deg, double longitude_deg, double height_msl_m) {
  return {latitude_deg, longitude_deg, height_msl_m, std::nullopt, std::nullopt};
}

SitePosition positionAgl(double latitude_deg, double longitude_deg, double height_agl_m) {
  return {latitude_deg, longitude_deg, std::nullopt, height_agl_m, std::nullopt};
}

int platformNamed(const Scenario& scenario, const std::string& name) {
  return static_cast<int>(indexOfNamed(scenario.platforms, name, "platform"));
}

std::shared_ptr<const Scenario> withPoses(const Scenario& scenario, const std::vector<PlatformPose>& poses) {
  const std::vector<const PlatformPose*> pose_of = posesByPlatform(scenario, poses);
  auto moved = std::make_shared<Scenario>(scenario);
  for (std::size_t p = 0; p < pose_of.size(); ++p) {
    if (pose_of[p] != nullptr) moved->platforms[p] = posed(moved->platforms[p], *pose_of[p]);
  }
  return moved;
}

}  // namespace emscape::scenario
