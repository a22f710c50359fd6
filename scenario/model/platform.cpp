#include "emscape/scenario/model/platform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/math/device_math.h"
#include "emscape/base/units.h"
#include "recording/common/ticks.h"

namespace emscape::scenario {

namespace {

double positiveDegrees(double angle_deg) {
  const double rest = std::fmod(angle_deg, 360.0);
  return rest < 0 ? rest + 360.0 : rest;
}

std::optional<double> lerpIfBoth(const std::optional<double>& a, const std::optional<double>& b,
                                 double part) {
  if (!a || !b) return std::nullopt;
  return lerp(*a, *b, part);
}

/// Over the shorter arc; from a_deg on, thus also outside one turn.
double lerpDegrees(double a_deg, double b_deg, double part) {
  return a_deg + std::remainder(b_deg - a_deg, 360.0) * part;
}

GeodesicInverse geodesic(const SitePosition& a, const SitePosition& b) {
  return geodesicInverse(a.latitude_deg, a.longitude_deg, b.latitude_deg, b.longitude_deg);
}

/// Course (deg) at a point of the leg from track[i] to track[i + 1]; none if the leg has no length.
std::optional<double> courseOnLeg(const std::vector<TrackPoint>& track, std::size_t i,
                                  const SitePosition& at) {
  const SitePosition& begin = track[i].position;
  const SitePosition& end = track[i + 1].position;
  constexpr double kStandingStill_m = 1e-3;
  if (geodesic(begin, end).distance_m < kStandingStill_m) return std::nullopt;
  // From the farther end, the direction is well defined.
  const GeodesicInverse ahead = geodesic(at, end), behind = geodesic(at, begin);
  return ahead.distance_m >= behind.distance_m ? radToDeg(ahead.azimuth_rad)
                                               : positiveDegrees(radToDeg(behind.azimuth_rad) + 180);
}

/// Course (deg) at a point of leg i; if the platform is stationary, the last course before, else the first
/// after, else 0.
double courseAt(const std::vector<TrackPoint>& track, std::size_t i, const SitePosition& at) {
  if (const auto course = courseOnLeg(track, i, at)) return *course;
  for (std::size_t before = i; before-- > 0;) {
    if (const auto course = courseOnLeg(track, before, track[before + 1].position)) return *course;
  }
  for (std::size_t after = i + 1; after + 1 < track.size(); ++after) {
    if (const auto course = courseOnLeg(track, after, track[after].position)) return *course;
  }
  return 0;
}

SitePosition positionOnLeg(const SitePosition& a, const SitePosition& b, double part) {
  if (part == 1) return b;
  SitePosition position = a;
  const GeodesicInverse leg = geodesic(a, b);
  if (part > 0 && leg.distance_m > 0) {
    const GeodeticPosition foot =
        geodesicDirect(a.latitude_deg, a.longitude_deg, leg.azimuth_rad, leg.distance_m * part);
    position.latitude_deg = foot.latitude_deg;
    position.longitude_deg = foot.longitude_deg;
  }
  position.height_msl_m = lerpIfBoth(a.height_msl_m, b.height_msl_m, part);
  position.height_agl_m = lerpIfBoth(a.height_agl_m, b.height_agl_m, part);
  position.height_ellipsoid_m = lerpIfBoth(a.height_ellipsoid_m, b.height_ellipsoid_m, part);
  return position;
}

/// "its track runs from 100 to 130 s ('track: {outside: hold}' keeps it at the track's ends)"
std::string spanText(const Platform& platform) {
  if (!platform.moves()) return "its place is the last one known";
  const bool has_gap = std::any_of(platform.track.begin(), platform.track.end(),
                                   [](const TrackPoint& point) { return point.gap_after; });
  return fmt::format(
      "its track runs from {:g} to {:g} s{} ('track: {{outside: hold}}' keeps it at the track's ends)",
      platform.track.front().t_s, platform.track.back().t_s, has_gap ? ", with gaps" : "");
}

}  // namespace

bool Platform::isPresentAt(double t_s) const {
  if (!moves()) return !track.front().gap_after;  // a pose that was the last one (PlatformPose)
  if (t_s < track.front().t_s - interop::kTickRounding_s || t_s > track.back().t_s + interop::kTickRounding_s)
    return outside_track == OutsideTrack::hold;
  const std::size_t leg = legAt(track, t_s);
  return !track[leg].gap_after || t_s <= track[leg].t_s + interop::kTickRounding_s ||
         t_s >= track[leg + 1].t_s - interop::kTickRounding_s;
}

std::string absenceText(const Platform& platform, double t_s) {
  return fmt::format("'{}' is absent at t = {:g} s: {}", platform.name, t_s, spanText(platform));
}

std::string absenceText(const Platform& platform, const std::vector<double>& times_s) {
  const auto absent =
      std::count_if(times_s.begin(), times_s.end(), [&](double t_s) { return !platform.isPresentAt(t_s); });
  if (absent == 0) return "";
  return fmt::format("'{}' is absent at {} of {} times, which have no values: {}", platform.name, absent,
                     times_s.size(), spanText(platform));
}

std::size_t legAt(const std::vector<TrackPoint>& track, double t_s) {
  const auto next = std::upper_bound(track.begin() + 1, track.end() - 1, t_s,
                                     [](double t, const TrackPoint& point) { return t < point.t_s; });
  return static_cast<std::size_t>(next - track.begin()) - 1;
}

TrackPoint pointAt(const Platform& platform, double t_s) {
  const std::vector<TrackPoint>& track = platform.track;
  TrackPoint point = track.front();
  if (track.size() == 1) {
    point.heading_deg = positiveDegrees(platform.attitude.heading_deg);
    point.pitch_deg = platform.attitude.pitch_deg;
    point.roll_deg = platform.attitude.roll_deg;
  } else {
    const std::size_t i = legAt(track, t_s);
    const TrackPoint& a = track[i];
    const TrackPoint& b = track[i + 1];
    const double part = std::clamp((t_s - a.t_s) / (b.t_s - a.t_s), 0.0, 1.0);
    point.position = positionOnLeg(a.position, b.position, part);
    point.heading_deg = a.heading_deg && b.heading_deg
                            ? positiveDegrees(lerpDegrees(*a.heading_deg, *b.heading_deg, part))
                            : courseAt(track, i, point.position);
    point.pitch_deg = lerpIfBoth(a.pitch_deg, b.pitch_deg, part).value_or(0);
    point.roll_deg =
        a.roll_deg && b.roll_deg ? std::remainder(lerpDegrees(*a.roll_deg, *b.roll_deg, part), 360.0) : 0;
  }
  point.t_s = t_s;
  return point;
}

}  // namespace emscape::scenario
