/// Tracks of moving platforms.
#include <algorithm>

#include "render/annotate/overlay_parts.h"

namespace emscape::render {
namespace {

constexpr double kHiddenTrackAlpha = 0.35;
constexpr double kTravelledAlpha = 0.95, kAheadAlpha = 0.6;

Vec3d between(const Vec3d& a, const Vec3d& b, double part) {
  return a + (b - a) * part;
}

/// Clips a leg to the box's sides. @return false if nothing is left
bool clip(const SceneBox& box, Vec3d& from, Vec3d& to) {
  double begin = 0, end = 1;
  const auto cut = [&](double at, double along, double lower, double upper) {
    if (along == 0) return at >= lower && at <= upper;
    const double a = (lower - at) / along, b = (upper - at) / along;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
    return begin < end;
  };
  const Vec3d leg = to - from;
  if (!cut(from.x, leg.x, box.lower_m.x, box.upper_m.x) ||
      !cut(from.y, leg.y, box.lower_m.y, box.upper_m.y)) {
    return false;
  }
  const Vec3d whole = from;
  from = between(whole, to, begin);
  to = between(whole, to, end);
  return true;
}

/// Draws legs that look the same as one line.
class TrackLine {
 public:
  TrackLine(Canvas& canvas, const Style& style, const Projector& projector, const Track& track)
      : canvas_(canvas), style_(style), projector_(projector), track_(track) {}
  ~TrackLine() { flush(); }
  TrackLine(const TrackLine&) = delete;
  TrackLine& operator=(const TrackLine&) = delete;

  /// Adds a part of the track, in units of Track::travelled.
  void add(double from, double to, bool is_hidden, bool is_travelled) {
    if (!(from < to)) return;
    Vec3d a = at(from), b = at(to);
    Point2 begin, end;
    if (!clip(projector_.box, a, b) || !projector_.project(a, begin) || !projector_.project(b, end)) {
      return flush();
    }
    if (is_hidden != is_hidden_ || is_travelled != is_travelled_) flush();
    is_hidden_ = is_hidden;
    is_travelled_ = is_travelled;
    if (line_.empty()) line_.push_back(begin);
    line_.push_back(end);
  }

 private:
  Vec3d at(double position) const {
    const auto point = std::min(static_cast<std::size_t>(position), track_.points_m.size() - 2);
    return between(track_.points_m[point], track_.points_m[point + 1], position - static_cast<double>(point));
  }

  void flush() {
    const double alpha =
        (is_travelled_ ? kTravelledAlpha : kAheadAlpha) * (is_hidden_ ? kHiddenTrackAlpha : 1);
    const double width = (is_travelled_ ? 2.6 : 1.8) * style_.unit;
    if (line_.size() > 1) {
      canvas_.outline(line_, style_.rimInk(0.5 * alpha), width + 1.6 * style_.unit, false);
      canvas_.outline(line_, {colorOf(track_.kind, track_.side), alpha}, width, false);
    }
    line_.clear();
  }

  Canvas& canvas_;
  const Style& style_;
  const Projector& projector_;
  const Track& track_;
  std::vector<Point2> line_;
  bool is_hidden_ = false, is_travelled_ = false;
};

}  // namespace

void drawTracks(Canvas& canvas, const Style& style, const Projector& projector,
                const std::vector<Track>& tracks, const HiddenTest& hidden) {
  for (const Track& track : tracks) {
    if (track.points_m.size() < 2) continue;
    TrackLine line(canvas, style, projector, track);
    bool was_hidden = hidden && hidden(track.points_m.front());
    for (std::size_t leg = 0; leg + 1 < track.points_m.size(); ++leg) {
      const bool ends_hidden = hidden && hidden(track.points_m[leg + 1]);
      const bool is_hidden = was_hidden && ends_hidden;
      was_hidden = ends_hidden;
      const double begin = static_cast<double>(leg), end = begin + 1;
      const double here = std::clamp(track.travelled, begin, end);
      line.add(begin, here, is_hidden, true);
      line.add(here, end, is_hidden, false);
    }
  }
}

}  // namespace emscape::render
