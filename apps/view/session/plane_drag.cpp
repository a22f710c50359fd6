#include "apps/view/session/plane_drag.h"

#include <algorithm>
#include <cmath>

#include "render/scene/plane_frame.h"

namespace emscape::view {
namespace {

constexpr double kMinPerBox_px =
    20;  // of a movement through the whole box; below it the handle cannot be dragged

render::Projected pixelOf(const playback::LivePicture& picture, const Vec3d& frame_m) {
  return render::project(picture.camera, picture.size, picture.box.toDrawn(frame_m));
}

/// Extent of the box along a direction.
double extent_m(const render::SceneBox& box, const Vec3d& direction) {
  const Vec3d size = box.upper_m - box.lower_m;
  return std::abs(size.x * direction.x) + std::abs(size.y * direction.y) + std::abs(size.z * direction.z);
}

}  // namespace

std::optional<render::Projected> planeHandle(const playback::LivePicture& picture,
                                             const render::CutPlane& plane) {
  const std::optional<render::PlaneFrame> frame =
      plane.on ? render::frameOf(plane, picture.box) : std::nullopt;
  if (!frame) return std::nullopt;
  const Vec3d half = frame->normal * (0.5 * extent_m(picture.box, frame->normal));
  const render::Projected at = pixelOf(picture, frame->center_m());
  const render::Projected a = pixelOf(picture, frame->center_m() - half),
                          b = pixelOf(picture, frame->center_m() + half);
  const bool is_movable = a.in_front && b.in_front && std::hypot(b.x - a.x, b.y - a.y) > kMinPerBox_px;
  return at.in_front && is_movable ? std::optional(at) : std::nullopt;
}

double roundedPosition(double position_m, double extent_m) {
  const double step_m = std::min(1.0, std::pow(10, std::floor(std::log10(std::max(extent_m, 1e-300)) - 1.5)));
  return std::round(position_m / step_m) * step_m;
}

std::optional<std::size_t> planeHandleAt(const Session& session, double x, double y) {
  constexpr double kReach_px = 12;
  if (session.picture() == nullptr) return std::nullopt;
  const std::vector<render::CutPlane>& planes = session.settings().planes;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const std::optional<render::Projected> at = planeHandle(*session.picture(), planes[i]);
    if (at && std::hypot(at->x - x, at->y - y) < kReach_px) return i;
  }
  return std::nullopt;
}

PlaneDrag::PlaneDrag(const Session& session, std::size_t index, double x, double y)
    : index_(index), begin_(session.settings().planes[index]) {
  const playback::LivePicture& picture = *session.picture();
  const render::PlaneFrame frame = *render::frameOf(begin_, picture.box);
  handle_m_ = frame.center_m();
  normal_ = frame.normal;
  reach_m_ = extent_m(picture.box, normal_);
  const render::Projected at = pixelOf(picture, handle_m_);
  offset_x_ = at.x - x;
  offset_y_ = at.y - y;
}

void PlaneDrag::moveTo(double x, double y, Session& session, bool begins) const {
  std::vector<render::CutPlane> planes = session.settings().planes;
  if (index_ >= planes.size() || (!begins && !session.isDraggingPlane())) return;
  if (begins) session.dragPlanes(planes);
  const playback::LivePicture& picture = *session.picture();
  // Newton's method for the point of the normal that is nearest to the cursor in the picture.
  double moved_m = 0;
  for (int round = 0; round < 8; ++round) {
    const double step_m = 1e-3 * reach_m_;
    const render::Projected at = pixelOf(picture, handle_m_ + normal_ * moved_m),
                            next = pixelOf(picture, handle_m_ + normal_ * (moved_m + step_m));
    const double right = next.x - at.x, down = next.y - at.y;
    const double square = right * right + down * down;
    if (!at.in_front || !next.in_front || square < 1e-9) return;
    const double along = ((x + offset_x_ - at.x) * right + (y + offset_y_ - at.y) * down) / square;
    moved_m = std::clamp(moved_m + along * step_m, -reach_m_, reach_m_);
  }
  render::CutPlane moved = begin_;
  if (begin_.kind == render::CutPlane::Kind::horizontal) {
    moved.altitude_m = std::clamp(roundedPosition(begin_.altitude_m + moved_m, reach_m_),
                                  picture.box.lower_m.z, picture.box.upper_m.z);
  } else {
    moved.offset_m = roundedPosition(begin_.offset_m + moved_m, reach_m_);
  }
  if (!render::frameOf(moved, picture.box) || moved == planes[index_]) return;
  planes[index_] = moved;
  session.dragPlanes(planes);
}

void PlaneDrag::finish(Session& session) const {
  session.endPlaneDrag();
  if (index_ >= session.settings().planes.size()) return;
  const render::CutPlane& plane = session.settings().planes[index_];
  const bool is_horizontal = plane.kind == render::CutPlane::Kind::horizontal;
  session.perform(
      {"plane",
       {{"index", index_ + 1},
        {is_horizontal ? "altitude_m" : "offset_m", is_horizontal ? plane.altitude_m : plane.offset_m}}});
}

}  // namespace emscape::view
