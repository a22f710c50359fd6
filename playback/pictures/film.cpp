#include "playback/pictures/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/error.h"

namespace emscape::playback {
namespace {

using render::CameraSpec;

/// True if bookmarks have times, which ascend.
bool haveTimes(const std::vector<Bookmark>& stops) {
  for (std::size_t n = 0; n < stops.size(); ++n) {
    if (!stops[n].time_s || (n > 0 && !(*stops[n].time_s > *stops[n - 1].time_s))) return false;
  }
  return true;
}

/// Place of a time between bookmarks, as for cameraOnPath().
double placeOf(const std::vector<Bookmark>& stops, double time_s) {
  std::size_t n = 0;
  while (n + 2 < stops.size() && *stops[n + 1].time_s <= time_s) ++n;
  const double from_s = *stops[n].time_s, to_s = *stops[n + 1].time_s;
  return static_cast<double>(n) + std::clamp((time_s - from_s) / (to_s - from_s), 0.0, 1.0);
}

bool canFlyBetween(const CameraSpec& a, const CameraSpec& b) {
  const auto isOrbit = [](const CameraSpec& spec) { return spec.kind == CameraSpec::Kind::orbit; };
  return isOrbit(a) && isOrbit(b) && a.projection == b.projection &&
         a.distance.has_value() == b.distance.has_value() && a.target_m.has_value() == b.target_m.has_value();
}

}  // namespace

CameraSpec cameraOnPath(const std::vector<Bookmark>& stops, double at) {
  const auto last = static_cast<double>(stops.size() - 1);
  const double place = std::clamp(at, 0.0, last);
  const auto before = static_cast<std::size_t>(place);
  const std::size_t after = std::min(before + 1, stops.size() - 1);
  const CameraSpec &a = stops[before].camera, &b = stops[after].camera;
  const double linear = place - static_cast<double>(before);
  if (linear == 0 || !canFlyBetween(a, b)) return a;
  const double part = linear * linear * (3 - 2 * linear);
  CameraSpec spec = a;
  spec.azimuth_deg += part * std::remainder(b.azimuth_deg - a.azimuth_deg, 360.0);
  spec.elevation_deg += part * (b.elevation_deg - a.elevation_deg);
  spec.fov_deg += part * (b.fov_deg - a.fov_deg);
  if (a.distance) spec.distance = *a.distance * std::pow(*b.distance / *a.distance, part);
  if (a.target_m) spec.target_m = *a.target_m * (1 - part) + *b.target_m * part;
  return spec;
}

Film filmOf(const ViewState& view, const FrameSource& source, std::optional<double> frames_per_s) {
  Film film;
  const int count = source.count();
  if (frames_per_s && view.film_speed && count > 1)
    film.speed = *frames_per_s * (source.time_s(count - 1) - source.time_s(0)) / (count - 1);
  if (view.camera_path == CameraPath::fixed) return film;
  const std::vector<Bookmark>& stops = view.bookmarks;
  if (stops.size() < 2) {
    throw Error(ErrorCode::usage,
                fmt::format("camera path: the view has {} bookmark{}; expected at least 2 (--state)",
                            stops.size(), stops.size() == 1 ? "" : "s"));
  }
  const bool has_times = haveTimes(stops);
  for (int n = 0; n < count; ++n) {
    const double evenly =
        count > 1 ? static_cast<double>(n) / (count - 1) * static_cast<double>(stops.size() - 1) : 0;
    film.cameras.push_back(cameraOnPath(stops, has_times ? placeOf(stops, source.time_s(n)) : evenly));
  }
  return film;
}

}  // namespace emscape::playback
