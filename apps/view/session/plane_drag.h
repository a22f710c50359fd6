/// Dragging of a cutting plane by its handle in the picture.
#pragma once

#include <cstddef>
#include <optional>

#include "apps/view/session/session.h"

namespace emscape::view {

/// The handle of a plane: the middle of its frame, in pixels of the picture; empty if the plane is off, does
/// not meet the box, or the camera looks along its normal.
std::optional<render::Projected> planeHandle(const playback::LivePicture& picture,
                                             const render::CutPlane& plane);

/// A position along a box of that extent: of whole metres, or of a hundredth of a small box.
double roundedPosition(double position_m, double extent_m);

/// Index of the plane whose handle is under a pixel; empty if there is none.
std::optional<std::size_t> planeHandleAt(const Session& session, double x, double y);

/// Moves a plane along its normal, so that its handle keeps its distance from the cursor.
class PlaneDrag {
 public:
  /// @param index  of a plane with a handle
  PlaneDrag(const Session& session, std::size_t index, double x, double y);

  /// @param begins  true for the first movement; without it, a drag that was cancelled stays so
  void moveTo(double x, double y, Session& session, bool begins) const;
  /// Ends the drag with the command of its result.
  void finish(Session& session) const;

 private:
  std::size_t index_;
  render::CutPlane begin_;
  Vec3d handle_m_, normal_;  // frame metres
  double reach_m_ = 0;       // from the handle to the ends of the box along the normal
  double offset_x_ = 0, offset_y_ = 0;
};

}  // namespace emscape::view
