#include "interop/importing/platforms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/geodesy/position_limits.h"
#include "emscape/base/error.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "scenario/schema/sections.h"

namespace emscape::interop {
namespace {

/// Height (m) above the ground to which positions below it are raised.
constexpr double kAboveGround_m = 2;
constexpr double kMaxRegion_m = 4e6;  ///< of the scenario format
constexpr double kMinRegion_m = 20000;
constexpr int kCells = 128, kLevels = 64;

double rounded(double value_m, double unit_m) {
  return std::ceil(value_m / unit_m - 1e-9) * unit_m;
}

/// Lowest and highest position.
std::pair<double, double> heightsOf(const std::vector<std::vector<PoseSample>>& tracks) {
  double lowest_m = 0, highest_m = 0;
  for (const auto& track : tracks) {
    for (const PoseSample& pose : track) {
      lowest_m = std::min(lowest_m, pose.height_msl_m);
      highest_m = std::max(highest_m, pose.height_msl_m);
    }
  }
  return {lowest_m, highest_m};
}

DocumentNodePtr regionNode(const GeodeticPosition& centre, double width_m, double depth_m,
                           const std::vector<std::vector<PoseSample>>& tracks) {
  const auto [lowest_m, highest_m] = heightsOf(tracks);
  const double bottom_m = lowest_m < 0 ? -rounded(-lowest_m, 10) : 0;
  const double top_m = std::min(rounded(std::max(3000.0, 1.3 * highest_m), 500), 100000.0);
  const double cell_m = std::max(width_m, depth_m) / kCells;
  const auto cells = [cell_m](double size_m) {
    return numberNode(std::clamp(std::round(size_m / cell_m), 8.0, static_cast<double>(kCells)));
  };
  return MapBuilder()
      .set("origin", MapBuilder()
                         .set("latitude_deg", decimalNode(centre.latitude_deg, 4))
                         .set("longitude_deg", decimalNode(centre.longitude_deg, 4))
                         .set("height_msl_m", numberNode(bottom_m))
                         .node())
      .set("size_m", listNode({numberNode(width_m), numberNode(depth_m), numberNode(top_m - bottom_m)}))
      .set("dims", listNode({cells(width_m), cells(depth_m), numberNode(kLevels)}))
      .node();
}

}  // namespace

std::vector<PoseSample> trackOf(const RecordedObject& object, const TimeSpan& window, double raise_m,
                                const scenario::Terrain* terrain, Raised& raised) {
  const auto& poses = object.poses;
  const auto earlier = [](const PoseSample& pose, double t_s) { return pose.t_s < t_s; };
  auto begin = std::lower_bound(poses.begin(), poses.end(), window.begin_s, earlier);
  auto end = std::lower_bound(begin, poses.end(), window.end_s, earlier);
  if (begin != poses.begin()) --begin;
  if (end != poses.end()) ++end;
  std::vector<PoseSample> track(begin, end);
  for (PoseSample& pose : track) {
    pose.height_msl_m += raise_m;
    double ground_m = terrain == nullptr ? 0 : terrain->heightMsl_m(pose.latitude_deg, pose.longitude_deg);
    if (std::isnan(ground_m)) {
      ++raised.without_ground;
      ground_m = 0;
    }
    pose.height_msl_m = std::min(pose.height_msl_m, PositionLimits::kHighest_m);
    if (pose.height_msl_m >= ground_m) continue;
    ++raised.positions;
    raised.deepest_m = std::max(raised.deepest_m, ground_m - pose.height_msl_m);
    pose.height_msl_m = ground_m + kAboveGround_m;
  }
  return track;
}

bool isFixed(const std::vector<PoseSample>& track) {
  return std::all_of(track.begin(), track.end(), [&](const PoseSample& pose) {
    const PoseSample& first = track.front();
    const auto near = [](double a, double b, double tolerance) {
      return !(std::abs(a - b) > tolerance);  // unknown angles are equal
    };
    return near(pose.latitude_deg, first.latitude_deg, 1e-7) &&
           near(pose.longitude_deg, first.longitude_deg, 1e-7) &&
           near(pose.height_msl_m, first.height_msl_m, 0.01) &&
           near(pose.heading_deg, first.heading_deg, 0.01) && near(pose.pitch_deg, first.pitch_deg, 0.01) &&
           near(pose.roll_deg, first.roll_deg, 0.01);
  });
}

std::string trackCsv(const std::vector<PoseSample>& track) {
  const auto known = std::find_if(track.begin(), track.end(),
                                  [](const PoseSample& pose) { return !std::isnan(pose.heading_deg); });
  const bool has_attitude = known != track.end();
  std::string text = "t_s,latitude_deg,longitude_deg,height_msl_m";
  if (has_attitude) text += ",heading_deg,pitch_deg,roll_deg";
  text += "\n";
  // Before the first known attitude that one.
  PoseSample last = has_attitude ? *known : PoseSample{};
  std::string last_time;
  for (const PoseSample& pose : track) {
    const std::string time = decimalText(pose.t_s, 6);
    if (time == last_time) continue;
    last_time = time;
    text += fmt::format("{},{},{},{}", time, decimalText(pose.latitude_deg, 9),
                        decimalText(pose.longitude_deg, 9), decimalText(pose.height_msl_m, 3));
    if (has_attitude) {
      if (!std::isnan(pose.heading_deg)) last = pose;
      text += fmt::format(",{},{},{}", decimalText(std::remainder(last.heading_deg, 720), 4),
                          decimalText(last.pitch_deg, 4), decimalText(std::remainder(last.roll_deg, 360), 4));
    }
    text += "\n";
  }
  return text;
}

DocumentNodePtr platformNode(const std::string& name, Side side, const PoseSample& pose,
                             const std::string& track_file) {
  MapBuilder platform;
  platform.set("name", textNode(name));
  if (side != Side::unknown) platform.set("side", textNode(toString(side)));
  if (!track_file.empty()) {
    platform.set("track", MapBuilder().set("file", textNode(track_file)).node());
    return platform.node();
  }
  platform.set("position", MapBuilder()
                               .set("latitude_deg", decimalNode(pose.latitude_deg, 9))
                               .set("longitude_deg", decimalNode(pose.longitude_deg, 9))
                               .set("height_msl_m", decimalNode(pose.height_msl_m, 3))
                               .node());
  MapBuilder attitude;
  const auto angle = [&](const char* key, double value_deg) {
    if (!std::isnan(value_deg) && std::abs(value_deg) >= 1e-4)
      attitude.set(key, decimalNode(std::remainder(value_deg, 360), 4));
  };
  angle("heading_deg", pose.heading_deg);
  angle("pitch_deg", pose.pitch_deg);
  angle("roll_deg", pose.roll_deg);
  if (!attitude.isEmpty()) platform.set("attitude", attitude.node());
  return platform.node();
}

DocumentNodePtr regionAround(const std::vector<std::vector<PoseSample>>& tracks) {
  const PoseSample& first = tracks.front().front();
  const GeoFrame frame(FrameOrigin{FrameKind::altitude, first.latitude_deg, first.longitude_deg, 0});
  Vec3d lower{1e12, 1e12, 0}, upper{-1e12, -1e12, 0};
  for (const auto& track : tracks) {
    for (const PoseSample& pose : track) {
      const Vec3d at = frame.toLocal({pose.latitude_deg, pose.longitude_deg, 0});
      lower = {std::min(lower.x, at.x), std::min(lower.y, at.y), 0};
      upper = {std::max(upper.x, at.x), std::max(upper.y, at.y), 0};
    }
  }
  const double extent_m = std::max(upper.x - lower.x, upper.y - lower.y);
  const double margin_m = std::max(0.1 * extent_m, kMinRegion_m / 2);
  const double width_m = rounded(upper.x - lower.x + 2 * margin_m, 1000);
  const double depth_m = rounded(upper.y - lower.y + 2 * margin_m, 1000);
  if (std::max(width_m, depth_m) > kMaxRegion_m) {
    throw Error(
        ErrorCode::bad_input,
        fmt::format(
            "the objects are {:.0f} km apart, more than the {:.0f} km of a region; choose a part with "
            "--region LAT,LON,SIZE_KM or objects with --only",
            extent_m / 1000, kMaxRegion_m / 1000));
  }
  return regionNode(frame.toGeodetic((lower + upper) / 2.0), width_m, depth_m, tracks);
}

DocumentNodePtr regionOf(double latitude_deg, double longitude_deg, double size_m,
                         const std::vector<std::vector<PoseSample>>& tracks) {
  return regionNode({latitude_deg, longitude_deg, 0}, size_m, size_m, tracks);
}

}  // namespace emscape::interop
