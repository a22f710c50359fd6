#include "playback/frames/platform_tracks.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/geodesy/geoid.h"
#include "emscape/playback/frames/scene.h"

namespace emscape::playback {
namespace {

constexpr int kMaxPoints = 200;        // of a line
constexpr int kMaxPointsOfAll = 4000;  // of all lines
constexpr int kMinPoints = 64;         // for heights above ground

/// Times of a line's points: those of the track, and others between them so that the line follows the ground.
std::vector<double> timesOf(const std::vector<scenario::TrackPoint>& track, double duration_s,
                            int max_points) {
  double begin_s = track.front().t_s, end_s = track.back().t_s;
  if (duration_s > 0) {
    begin_s = std::max(begin_s, 0.0);
    end_s = std::min(end_s, duration_s);
  }
  std::vector<double> times_s;
  if (!(begin_s < end_s)) return times_s;
  const bool keeps_all = static_cast<int>(track.size()) + kMinPoints <= max_points;
  const int evenly = keeps_all ? kMinPoints : max_points;
  for (int i = 0; i < evenly; ++i) times_s.push_back(begin_s + (end_s - begin_s) * i / (evenly - 1));
  if (keeps_all) {
    for (const scenario::TrackPoint& point : track) {
      if (point.t_s > begin_s && point.t_s < end_s) times_s.push_back(point.t_s);
    }
    std::sort(times_s.begin(), times_s.end());
    times_s.erase(std::unique(times_s.begin(), times_s.end()), times_s.end());
  }
  return times_s;
}

/// NaN if the ground below it is unknown.
Vec3d positionOf(const scenario::SitePosition& site, const scenario::Terrain* terrain,
                 const GeoFrame& frame) {
  GeodeticPosition position{site.latitude_deg, site.longitude_deg, site.height_ellipsoid_m.value_or(0)};
  if (!site.height_ellipsoid_m) {
    double height_msl_m = site.height_msl_m.value_or(0);
    if (site.height_agl_m) {
      height_msl_m =
          *site.height_agl_m + (terrain ? terrain->heightMsl_m(site.latitude_deg, site.longitude_deg) : 0);
    }
    position.height_ellipsoid_m = height_msl_m + geoidUndulation_m(site.latitude_deg, site.longitude_deg);
  }
  return frame.toLocal(position);
}

}  // namespace

PlatformTracks::Line PlatformTracks::lineOf(const scenario::Platform& platform, double duration_s,
                                            int max_points, const scenario::Terrain* terrain,
                                            const GeoFrame& frame) {
  Line line;
  for (const double time_s : timesOf(platform.track, duration_s, max_points)) {
    const Vec3d point_m = positionOf(scenario::pointAt(platform, time_s).position, terrain, frame);
    if (std::isnan(point_m.x + point_m.y + point_m.z)) continue;
    line.track.points_m.push_back(point_m);
    line.times_s.push_back(time_s);
  }
  return line;
}

std::vector<render::Track> PlatformTracks::at(double time_s, const LoadedScenario& scene,
                                              const volume::Grid& grid) {
  if (scenario_ != scene.scenario || grid_ != grid) {
    lines_.clear();
    const GeoFrame frame(grid.frame);
    const std::vector<scenario::Platform>& platforms = scene.scenario->platforms;
    const auto moving =
        static_cast<int>(std::count_if(platforms.begin(), platforms.end(),
                                       [](const scenario::Platform& platform) { return platform.moves(); }));
    for (std::size_t p = 0; p < platforms.size(); ++p) {
      if (!platforms[p].moves()) continue;
      Line line = lineOf(platforms[p], scene.scenario->clock.duration_s,
                         std::clamp(kMaxPointsOfAll / moving, 2, kMaxPoints), scene.terrain.get(), frame);
      for (const scenario::Emitter& emitter : scene.scenario->emitters) {
        if (emitter.platform == static_cast<int>(p)) line.track.kind = markerKindOf(emitter.kind);
      }
      line.track.side = affiliationOf(platforms[p].side);
      if (line.times_s.size() > 1) lines_.push_back(std::move(line));
    }
    scenario_ = scene.scenario;
    grid_ = grid;
  }
  std::vector<render::Track> tracks;
  for (const Line& line : lines_) {
    const auto next = std::upper_bound(line.times_s.begin(), line.times_s.end(), time_s);
    render::Track track = line.track;
    if (next == line.times_s.end()) {
      track.travelled = static_cast<double>(line.times_s.size() - 1);
    } else if (next != line.times_s.begin()) {
      const double before_s = *(next - 1);
      track.travelled =
          static_cast<double>(next - 1 - line.times_s.begin()) + (time_s - before_s) / (*next - before_s);
    }
    tracks.push_back(std::move(track));
  }
  return tracks;
}

std::vector<render::Track> tracksOf(const LoadedScenario& scene, const volume::Grid& grid, double time_s) {
  return PlatformTracks().at(time_s, scene, grid);
}

}  // namespace emscape::playback
