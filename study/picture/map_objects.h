/// Emitters and moving platforms of a scenario, for files of maps.
#pragma once

#include <string>
#include <vector>

#include "emscape/render/transfer/transfer_function.h"
#include "study/maps/map_study.h"

namespace emscape::study {

/// A position at a time.
struct MapPosition {
  double time_s = 0;
  GeodeticPosition position;
  double height_msl_m = 0;
};

struct MapEmitter {
  const scenario::Emitter* emitter = nullptr;
  std::string platform;
  bool is_moving = false;
  /// One if it is fixed; else one for each of the study's times at which its platform is present.
  std::vector<MapPosition> positions;
};

/// A platform and its loads, by name.
struct MapSite {
  std::string platform;
  bool is_moving = false;
  std::vector<std::string> emitters, receivers, targets;
  /// One if it is fixed; else one for each of the study's times at which it is present.
  std::vector<MapPosition> positions;
};

struct MapTrack {
  const scenario::Platform* platform = nullptr;
  std::vector<MapPosition> positions;  ///< two or more, in the order of time
};

/// The colour of an emitter's point: that of its kind; grey if it is switched off.
render::Rgb pointColorOf(const scenario::Emitter& emitter);

/// All emitters of the study's first scenario, active or not.
std::vector<MapEmitter> emittersOf(const MapStudy& study);
/// All platforms of the study's first scenario.
std::vector<MapSite> sitesOf(const MapStudy& study);
/// The tracks of its moving platforms within the scenario's duration, where they are present: their own
/// points and the study's times. Points over missing terrain whose height is given above ground are left out.
std::vector<MapTrack> tracksOf(const MapStudy& study);

/// The parts of a track between its crossings of the antimeridian, which end and begin at +-180 degrees: a
/// line in longitudes would go around the earth.
std::vector<MapTrack> cutAtAntimeridian(const MapTrack& track);

/// ISO 8601 UTC of a time, with milliseconds. Time 0 of a scenario without an epoch is 1970-01-01T00:00:00Z.
std::string utcOf(const MapStudy& study, double time_s);
/// End of the interval that the map of a time represents: the next of the study's times; for the last time,
/// after the same interval as the previous one; one second for a single time.
double endOf(const MapStudy& study, double time_s);

}  // namespace emscape::study
