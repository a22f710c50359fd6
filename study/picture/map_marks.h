/// Places, range rings and a picture on the ground of a study's maps.
#pragma once

#include <vector>

#include "playback/frames/ground_marks.h"
#include "study/maps/map_study.h"
#include "study/picture/map_picture.h"

namespace emscape::study {

/// The plane of a map, for marks in its metres. @param grid  must outlive the result
playback::MarkedPlane markedPlane(const MapGrid& grid);

/// The marks of the pictures of a study (MapStudy::view), read once.
class MapMarks {
 public:
  /// @throws Error (bad_input) naming a file of places; (usage) for rings about an emitter that the scenario
  /// does not have
  explicit MapMarks(const MapStudy& study);

  /// Sets the lines and points of a picture, for the emitters' positions at its time.
  void addTo(MapPictureOptions& options, const scenario::Snapshot& snapshot) const;

 private:
  const MapStudy& study_;
  std::vector<render::GroundLine> place_lines_;
  std::vector<render::GroundPoint> place_points_;
};

/// The colours of a picture on the ground at squares. @throws Error (bad_input) naming the file
scenario::MapColors drapeOf(const MapGrid& squares, const std::string& name,
                            const scenario::Terrain* terrain);

/// The description of a map with heights in units.
std::string descriptionOf(const Map& map, Units units);

}  // namespace emscape::study
