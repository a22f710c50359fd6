/// What clicks in the picture do, beside selecting.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/view/tools/measurement.h"

namespace emscape::view {

/// A point that was clicked.
struct ToolPoint {
  Vec3d position_m;  ///< frame metres
  emfield::PathEnd end;
};

struct PickTool {
  enum class Kind {
    none,     ///< clicks select
    measure,  ///< the second click completes a measurement
    track,    ///< clicks are the points of a platform's track
    place     ///< the click is the place of a new item
  };
  Kind kind = Kind::none;
  std::string subject;            ///< platform of the track, or kind of the new item
  std::vector<ToolPoint> points;  ///< clicked so far; of a complete measurement both
  std::optional<Measurement> measurement;

  bool isOn() const { return kind != Kind::none; }
};

}  // namespace emscape::view
