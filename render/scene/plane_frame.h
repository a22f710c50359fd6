/// Where cutting planes meet the volume's box: frames and captions of sections.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "emscape/base/units.h"
#include "emscape/base/vec.h"
#include "emscape/render/scene/camera.h"
#include "emscape/render/scene/cut_plane.h"

namespace emscape::render {

/// The section of a box, in frame metres.
struct PlaneFrame {
  std::array<Vec3d, 4> corners_m;  ///< around the section; of a vertical plane the first two at the bottom
  Vec3d normal;                    ///< unit vector along which the plane's altitude or offset grows

  Vec3d center_m() const { return (corners_m[0] + corners_m[2]) * 0.5; }
};

/// @return none if the plane does not meet the box
std::optional<PlaneFrame> frameOf(const CutPlane& plane, const SceneBox& box);

/// "altitude 1500 m"; "bearing 90°, offset 200 m"; "z = 0.5" of a volume without a position on the earth.
std::string captionOf(const CutPlane& plane, Units units = Units::metric, bool is_on_earth = true);

}  // namespace emscape::render
