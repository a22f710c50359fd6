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

/// What a moving platform does before and after its track.
enum class OutsideTrack {
  absent,  ///< it is not there: its emitters do not radiate, its receivers and targets have no values
  hold     ///< it stands still at the nearer end
};
constexpr auto namesOf(OutsideTrack) {
  return std::array{"absent", "hold"};
}

struct Platform {
  std::string name;
  std::vector<TrackPoint> track;  ///< one point: a fixed site; several: strictly increasing t_s
  OutsideTrack outside_track = OutsideTrack::absent;
  Attitude attitude;         ///< of a fixed site
  std::string track_file;    ///< empty for a fixed site, and for a track in the scenario itself
  std::optional<Side> side;  ///< as given, else that of the symbol
  std::string sidc;          ///< of its symbol, 20 or 30 digits (MIL-STD-2525D, APP-6D); may be empty
  SourceLocation location;   ///< in the scenario

  bool moves() const { return track.size() > 1; }
  /// False before and after the track of a moving platform, unless it holds its ends, and within gaps of it.
  bool isPresentAt(double t_s) const;
};

/// Index of the first point of a track's leg at t_s: the leg that begins at or before t_s; before the track
/// the first one, at its end and after it the last one.
/// @param track  at least two points
std::size_t legAt(const std::vector<TrackPoint>& track, double t_s);

/// Position and attitude of a platform at t_s, at the nearer end of its track where it is absent: position
/// along the geodesic between the points before and after, height (above the datum of the track) and attitude
/// linear in time, heading and roll along the shorter arc. Without a heading in the track, the heading is the
/// course; a stationary platform keeps its last course.
/// @return a point with heading (0..360), pitch and roll (on a track -180..180) set
TrackPoint pointAt(const Platform& platform, double t_s);

/// "'raider' is absent at t = 0 s: its track runs from 100 to 130 s ('track: {outside: hold}' ...)"
std::string absenceText(const Platform& platform, double t_s);

/// Warning of a result at given times that lack a platform at some of them; empty if it is always present.
std::string absenceText(const Platform& platform, const std::vector<double>& times_s);

}  // namespace emscape::scenario
