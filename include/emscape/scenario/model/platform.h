/// Platforms: a fixed site or a track.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/error.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/side.h"

namespace emscape::scenario {

using emscape::Side;

/// A position as given in a file: exactly one of the heights is set.
struct SitePosition {
  double latitude_deg = 0;
  double longitude_deg = 0;
  std::optional<double> height_msl_m;
  std::optional<double> height_agl_m;
  std::optional<double> height_ellipsoid_m;
};

/// Degrees: heading clockwise from true north, pitch nose up, roll right wing down.
struct Attitude {
  double heading_deg = 0;
  double pitch_deg = 0;
  double roll_deg = 0;
};

/// One row of a track file. Without an attitude the heading is along the track, and pitch and roll are 0.
struct TrackPoint {
  double t_s = 0;
  SitePosition position;
  std::optional<double> heading_deg;
  std::optional<double> pitch_deg;
  std::optional<double> roll_deg;
  bool gap_after = false;  ///< the platform is absent from here to the next point
};

struct Platform {
  std::string name;
  /// One point: a fixed site. Several: strictly increasing t_s; outside the track's time the platform stays
  /// at its ends.
  std::vector<TrackPoint> track;
  Attitude attitude;         ///< of a fixed site
  std::string track_file;    ///< empty for a fixed site, and for a track in the scenario itself
  std::optional<Side> side;  ///< as given, else that of the symbol
  std::string sidc;          ///< of its symbol, 20 or 30 digits (MIL-STD-2525D, APP-6D); may be empty
  SourceLocation location;   ///< in the scenario

  bool moves() const { return track.size() > 1; }
};

/// Index of the first point of a track's leg at t_s: the leg that begins at or before t_s; before the track
/// the first one, at its end and after it the last one.
/// @param track  at least two points
std::size_t legAt(const std::vector<TrackPoint>& track, double t_s);

/// Position and attitude of a platform at t_s: position along the geodesic between the points before and
/// after, height (above the datum of the track) and attitude linear in time, heading and roll along the
/// shorter arc. Without a heading in the track, the heading is the course; a stationary platform keeps its
/// last course.
/// @return a point with heading (0..360), pitch and roll (on a track -180..180) set
TrackPoint pointAt(const Platform& platform, double t_s);

}  // namespace emscape::scenario
