#include "render/cells/face_tiles.h"

#include <algorithm>
#include <cmath>

namespace emscape::render {
namespace {

/// Pixels that a face may cover: those between its projected corners, one more to each side for rounding.
/// Empty if it is behind the eye; the whole picture if a part of it is.
PixelBox coveredBy(const std::array<Projected, 3>& corners, ImageSize size) {
  const auto behind = [](const Projected& corner) { return !corner.in_front; };
  if (std::all_of(corners.begin(), corners.end(), behind)) return {};
  if (std::any_of(corners.begin(), corners.end(), behind)) return {0, 0, size.width, size.height};
  const auto x = std::minmax({corners[0].x, corners[1].x, corners[2].x});
  const auto y = std::minmax({corners[0].y, corners[1].y, corners[2].y});
  const auto pixel = [](double at, int limit) { return static_cast<int>(std::clamp<double>(at, 0, limit)); };
  return {pixel(std::floor(x.first) - 1, size.width), pixel(std::floor(y.first) - 1, size.height),
          pixel(std::ceil(x.second) + 2, size.width), pixel(std::ceil(y.second) + 2, size.height)};
}

}  // namespace

FaceTiles::FaceTiles(const CellMesh& mesh, const SceneBox& box, const Camera& camera, ImageSize size)
    : grid_{size} {
  const bool parallel_rays = camera.projection == Projection::orthographic;
  for (const volume::FaceId face : mesh.faces->boundary) {
    std::array<Vec3d, 3> drawn_m;
    std::array<Projected, 3> corners;
    for (std::size_t n = 0; n < 3; ++n) {
      const auto point = mesh.cell(face >> 2)[static_cast<std::size_t>(volume::kFaceVertices[face & 3][n])];
      drawn_m[n] = box.toDrawn(mesh.mesh->points_m[static_cast<std::size_t>(point)]);
      corners[n] = project(camera, size, drawn_m[n]);
    }
    // Rays leave through faces whose outward normal points away; edge-on faces may be entries or exits.
    const Vec3d normal = cross(drawn_m[1] - drawn_m[0], drawn_m[2] - drawn_m[0]);
    const Vec3d to_face = parallel_rays ? camera.forward : drawn_m[0] - camera.eye_m;
    constexpr double kEdgeOn = 1e-9;
    if (dot(normal, to_face) > kEdgeOn * length(normal) * length(to_face)) continue;
    const PixelBox pixels = coveredBy(corners, size);
    if (pixels.isEmpty()) continue;
    faces_.push_back(face);
    boxes_.push_back(pixels);
  }
  lists_ = TileLists(grid_, boxes_.size(), [this](std::size_t n) { return boxes_[n]; });
}

FaceTiles::Lists FaceTiles::lists() const {
  Lists lists;
  for (int tile = 0; tile <= count(); ++tile) lists.first.push_back(static_cast<int>(lists_.first(tile)));
  lists.faces.reserve(lists_.members().size());
  for (const int member : lists_.members()) lists.faces.push_back(faces_[static_cast<std::size_t>(member)]);
  return lists;
}

std::vector<std::vector<EntryHit>> FaceTiles::entriesOf(int tile, const CellMesh& mesh,
                                                        const CameraView& camera) const {
  const PixelBox box = pixelsOf(tile);
  std::vector<std::vector<EntryHit>> entries(box.index(box.first_x, box.end_y));
  const CellMeshView view = mesh.view();
  std::vector<RayFrame> frames;
  for (int y = box.first_y; y < box.end_y; ++y) {
    for (int x = box.first_x; x < box.end_x; ++x) frames.emplace_back(camera.ray(x, y));
  }
  for (std::size_t n = lists_.first(tile); n < lists_.first(tile + 1); ++n) {
    const auto member = static_cast<std::size_t>(lists_.members()[n]);
    const PixelBox covered = common(boxes_[member], box);
    for (int y = covered.first_y; y < covered.end_y; ++y) {
      for (int x = covered.first_x; x < covered.end_x; ++x) {
        const std::size_t pixel = box.index(x, y);
        EntryHit hit;
        if (!entersThrough(view, frames[pixel], faces_[member], hit)) continue;
        if (camera.orthographic || hit.distance >= 0) entries[pixel].push_back(hit);
      }
    }
  }
  return entries;
}

}  // namespace emscape::render
