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

/// Calls visit(tile) for each tile of kTile pixels that a box touches.
template <class Visit>
void eachTile(const PixelBox& box, int columns, const Visit& visit) {
  constexpr int kTile = FaceTiles::kTile;
  for (int row = box.first_y / kTile; row * kTile < box.end_y; ++row) {
    for (int column = box.first_x / kTile; column * kTile < box.end_x; ++column)
      visit(row * columns + column);
  }
}

}  // namespace

FaceTiles::FaceTiles(const CellMesh& mesh, const SceneBox& box, const Camera& camera, ImageSize size)
    : size_(size), columns_((size.width + kTile - 1) / kTile), rows_((size.height + kTile - 1) / kTile) {
  const bool parallel_rays = camera.projection == Projection::orthographic;
  for (const volume::FaceId face : mesh.faces->boundary) {
    std::array<Vec3d, 3> drawn_m;
    std::array<Projected, 3> corners;
    for (std::size_t n = 0; n < 3; ++n) {
      const auto point = mesh.cell(face >> 2)[static_cast<std::size_t>(volume::kFaceVertices[face & 3][n])];
      drawn_m[n] = box.toDrawn(mesh.mesh->points_m[static_cast<std::size_t>(point)]);
      corners[n] = project(camera, size, drawn_m[n]);
    }
    // Rays leave through faces whose outward side looks away; one that is seen from its edge may do either.
    const Vec3d normal = cross(drawn_m[1] - drawn_m[0], drawn_m[2] - drawn_m[0]);
    const Vec3d to_face = parallel_rays ? camera.forward : drawn_m[0] - camera.eye_m;
    constexpr double kEdgeOn = 1e-9;
    if (dot(normal, to_face) > kEdgeOn * length(normal) * length(to_face)) continue;
    const PixelBox pixels = coveredBy(corners, size);
    if (pixels.first_x < pixels.end_x && pixels.first_y < pixels.end_y) faces_.push_back({face, pixels});
  }
  first_.assign(static_cast<std::size_t>(count()) + 1, 0);
  for (const Covered& face : faces_)
    eachTile(face.pixels, columns_, [&](int tile) { ++first_[static_cast<std::size_t>(tile) + 1]; });
  for (std::size_t tile = 0; tile + 1 < first_.size(); ++tile) first_[tile + 1] += first_[tile];
  members_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t n = 0; n < faces_.size(); ++n) {
    eachTile(faces_[n].pixels, columns_,
             [&](int tile) { members_[next[static_cast<std::size_t>(tile)]++] = static_cast<int>(n); });
  }
}

FaceTiles::Lists FaceTiles::lists() const {
  Lists lists;
  lists.first.assign(first_.begin(), first_.end());
  lists.faces.resize(members_.size());
  std::transform(members_.begin(), members_.end(), lists.faces.begin(),
                 [this](int member) { return faces_[static_cast<std::size_t>(member)].face; });
  return lists;
}

PixelBox FaceTiles::pixelsOf(int tile) const {
  const int x = tile % columns_ * kTile, y = tile / columns_ * kTile;
  return {x, y, std::min(x + kTile, size_.width), std::min(y + kTile, size_.height)};
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
  for (std::size_t n = first_[static_cast<std::size_t>(tile)]; n < first_[static_cast<std::size_t>(tile) + 1];
       ++n) {
    const Covered& face = faces_[static_cast<std::size_t>(members_[n])];
    const PixelBox& covered = face.pixels;
    for (int y = std::max(covered.first_y, box.first_y); y < std::min(covered.end_y, box.end_y); ++y) {
      for (int x = std::max(covered.first_x, box.first_x); x < std::min(covered.end_x, box.end_x); ++x) {
        const std::size_t pixel = box.index(x, y);
        EntryHit hit;
        if (!entersThrough(view, frames[pixel], face.face, hit)) continue;
        if (camera.orthographic || hit.distance >= 0) entries[pixel].push_back(hit);
      }
    }
  }
  return entries;
}

}  // namespace emscape::render
