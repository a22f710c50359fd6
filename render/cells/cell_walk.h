/// Traversal of a mesh's cells by a ray, from face to face (P. Bunyk, A. Kaufman, C. Silva, Simple, fast, and
/// robust ray casting of irregular grids, 1997). Host and device.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "render/cast/raycast.h"
#include "render/cells/cell_mesh.h"
#include "render/cells/integral/ray_integral.h"

namespace emscape::render {

/// Coordinates relative to a ray: two across it, and the distance along it. They are an affine function of
/// position, so that linear functions of position are linear in them. A point has the same coordinates in
/// every cell. Hence the ray is on the same side of an edge for all its cells; none is missed or met twice.
class RayFrame {
 public:
  EMSCAPE_HD explicit RayFrame(const Ray& ray) : origin_(ray.origin) {
    const Vec3d& d = ray.direction;
    if (fabs(d.y) > fabs(along(d))) w_ = 1;
    if (fabs(d.z) > fabs(along(d))) w_ = 2;
    // Faces towards the eye have the same orientation for every direction.
    is_mirrored_ = along(d) < 0;
    const Vec3d turned = turnedTo(d);
    slope_u_ = turned.x / turned.z;
    slope_v_ = turned.y / turned.z;
    per_w_ = 1 / turned.z;
  }

  struct Position {
    double u, v, distance;
  };
  EMSCAPE_HD Position operator()(const Vec3d& point) const {
    const Vec3d to = turnedTo(point - origin_);
    return {to.x - slope_u_ * to.z, to.y - slope_v_ * to.z, to.z * per_w_};
  }

  /// operator() as numbers: its axes and factors; across, across and along.
  struct Parts {
    int axis[3];  ///< 0..2: x, y, z
    double origin[3];
    double slope_u, slope_v, per_w;
  };
  Parts parts() const {
    const int u = (w_ + 1) % 3, v = (w_ + 2) % 3;
    const Vec3d origin = turnedTo(origin_);
    return {{is_mirrored_ ? v : u, is_mirrored_ ? u : v, w_},
            {origin.x, origin.y, origin.z},
            slope_u_,
            slope_v_,
            per_w_};
  }

 private:
  EMSCAPE_HD double along(const Vec3d& v) const { return w_ == 0 ? v.x : w_ == 1 ? v.y : v.z; }
  /// Components across, across and along the ray's dominant axis.
  EMSCAPE_HD Vec3d turnedTo(const Vec3d& v) const {
    const double u = w_ == 0 ? v.y : w_ == 1 ? v.z : v.x, other = w_ == 0 ? v.z : w_ == 1 ? v.x : v.y;
    return is_mirrored_ ? Vec3d{other, u, along(v)} : Vec3d{u, other, along(v)};
  }

  Vec3d origin_;
  int w_ = 0;
  bool is_mirrored_ = false;
  double slope_u_, slope_v_, per_w_;
};

/// Twice the area of the triangle of two positions and the ray, positive if counter-clockwise as seen against
/// the ray's direction. Exactly antisymmetric.
EMSCAPE_HD inline double spanned(const RayFrame::Position& a, const RayFrame::Position& b) {
#if defined(__CUDA_ARCH__)
  return __dmul_rn(a.u, b.v) - __dmul_rn(a.v, b.u);  // prevents fusion with the difference
#else
  return a.u * b.v - a.v * b.u;
#endif
}

/// volume::kFaceVertices, which device code cannot read.
EMSCAPE_HD inline int faceVertex(int face, int n) {
  constexpr unsigned kVertices = 0x634b39u;  // two bits each
  return static_cast<int>(kVertices >> (2 * (3 * face + n)) & 3u);
}

/// A boundary face through which a ray enters the mesh.
struct EntryHit {
  double distance = 0;
  volume::FaceId face = volume::kNoFace;

  EMSCAPE_HD bool operator<(const EntryHit& o) const {
    return distance != o.distance ? distance < o.distance : face < o.face;
  }
};

/// Limits of a march.
struct MarchLimits {
  double distance = 0;  ///< of the ground, or infinite
  double through = 0;   ///< transmittance below which the march ends, 0..1
};

/// Max number of cells crossed without progress, as along an edge.
constexpr int kMaxStanding = 10000;

struct Corner {
  std::int32_t point = 0;
  RayFrame::Position at{};
  double value = 0;
};

/// A face that a ray crosses. Its corners are ordered so that all areas between its edges and the ray are
/// positive; they are the weights of the opposite corners.
struct Crossing {
  Corner corner[3];
  double area[3];

  EMSCAPE_HD double sum() const { return area[0] + area[1] + area[2]; }
  /// Whether the line crosses the face in this direction.
  EMSCAPE_HD bool isPassed() const { return area[0] >= 0 && area[1] >= 0 && area[2] >= 0 && sum() > 0; }
  EMSCAPE_HD double mean(double a, double b, double c) const {
    const double total = sum();
    // Edge-on face: after rounding, the crossing may be anywhere between its corners.
    return total > 0 ? (area[0] * a + area[1] * b + area[2] * c) / total : (a + b + c) / 3;
  }
  EMSCAPE_HD double distance() const {
    return mean(corner[0].at.distance, corner[1].at.distance, corner[2].at.distance);
  }
  EMSCAPE_HD double value() const { return mean(corner[0].value, corner[1].value, corner[2].value); }
};

EMSCAPE_HD inline Corner cornerOf(const CellMeshView& mesh, const RayFrame& frame, std::int32_t point) {
  return {point, frame(mesh.points[point]), static_cast<double>(mesh.values[point])};
}

/// A face of a cell as a ray enters it.
EMSCAPE_HD inline Crossing entryOf(const CellMeshView& mesh, const RayFrame& frame, volume::FaceId face) {
  Crossing entry;
  // Reversed: the face's order is that for a ray leaving the cell.
  for (int n = 0; n < 3; ++n)
    entry.corner[n] = cornerOf(mesh, frame, mesh.vertex(face >> 2, faceVertex(face & 3, 2 - n)));
  for (int n = 0; n < 3; ++n)
    entry.area[n] = spanned(entry.corner[(n + 1) % 3].at, entry.corner[(n + 2) % 3].at);
  return entry;
}

/// Corner of the entry face that the exit face does not have; `crossing` becomes the exit face.
EMSCAPE_HD inline std::int32_t leave(Crossing& crossing, const Corner& fourth) {
  double edge[3];
  for (int n = 0; n < 3; ++n) edge[n] = spanned(fourth.at, crossing.corner[n].at);
  // The face without corner n has the edges from the fourth corner to n + 1 and n + 2. One of the three faces
  // contains the ray; if rounding leaves none, the ray is on their common edge. A ray in the plane of a face
  // is also on edges of another face, which gives its position.
  int left_out = 0;
  double best = -HUGE_VAL, best_area = best;
  for (int n = 0; n < 3; ++n) {
    const double before = edge[(n + 1) % 3], after = -edge[(n + 2) % 3];
    const double inside = fmin(before, after), area = before + after + crossing.area[n];
    if (inside < best || (inside == best && area <= best_area)) continue;
    best = inside;
    best_area = area;
    left_out = n;
  }
  const int first = (left_out + 1) % 3, second = (left_out + 2) % 3;
  const Crossing face{{crossing.corner[first], crossing.corner[second], fourth},
                      {fmax(0.0, -edge[second]), fmax(0.0, edge[first]), crossing.area[left_out]}};
  const std::int32_t point = crossing.corner[left_out].point;
  crossing = face;
  return point;
}

/// Whether the line of a ray enters the mesh through a face. An edge belongs to the faces on both its sides.
/// @param hit  its distance is set; negative behind the ray's origin
EMSCAPE_HD inline bool entersThrough(const CellMeshView& mesh, const RayFrame& frame, volume::FaceId face,
                                     EntryHit& hit) {
  const Crossing entry = entryOf(mesh, frame, face);
  if (!entry.isPassed()) return false;
  hit = {entry.distance(), face};
  return true;
}

/// Face through which the line of a ray enters a cell that it crosses.
EMSCAPE_HD inline volume::FaceId entryFaceOf(const CellMeshView& mesh, const RayFrame& frame, int cell) {
  volume::FaceId entered = 4 * cell;
  double best = -HUGE_VAL;
  for (volume::FaceId face = 4 * cell; face < 4 * cell + 4; ++face) {
    const Crossing entry = entryOf(mesh, frame, face);
    const double inside = fmin(fmin(entry.area[0], entry.area[1]), entry.area[2]);
    if (inside <= best) continue;
    best = inside;
    entered = face;
  }
  return entered;
}

/// Follows a ray from cell to cell until it leaves the mesh or reaches a limit. Parts behind its origin and
/// parts already followed are skipped: rounding may move an entry into cells that the ray has just left, and
/// an edge is an entry for the faces on both its sides.
/// @param been  distance up to which the ray has been followed; initially -infinity
/// @param cells  incremented by the number of cells crossed
/// @return the new value of `been`
EMSCAPE_HD inline double march(const CellMeshView& mesh, const RayFrame& frame, const EntryHit& entry,
                               double been, const MarchLimits& limits, RayIntegral& integral,
                               long long& cells) {
  Crossing crossing = entryOf(mesh, frame, entry.face);
  int cell = entry.face >> 2;
  Corner fourth = cornerOf(mesh, frame, mesh.vertex(cell, entry.face & 3));
  double distance = entry.distance, value = crossing.value();
  for (int standing = 0; standing < kMaxStanding;) {
    const std::int32_t behind = leave(crossing, fourth);
    ++cells;
    const double next = fmax(crossing.distance(), distance);
    const double next_value = crossing.value();
    standing = next > distance ? 0 : standing + 1;
    const double begin = fmax(fmax(distance, been), 0.0), end = fmin(next, limits.distance);
    if (end > begin && value == value && next_value == next_value) {
      const double slope = (next_value - value) / (next - distance);
      const double front = begin > distance ? value + slope * (begin - distance) : value;
      const double back = end < next ? value + slope * (end - distance) : next_value;
      integral.add(front, back, end - begin);
    }
    distance = next;
    value = next_value;
    if (distance >= limits.distance || integral.through() < limits.through) break;
    int local = 0;
    while (mesh.vertex(cell, local) != behind) ++local;
    const volume::FaceId other = mesh.other_side[4 * cell + local];
    if (other == volume::kNoFace) break;
    cell = other >> 2;
    fourth = cornerOf(mesh, frame, mesh.vertex(cell, other & 3));
  }
  return fmax(distance, been);
}

}  // namespace emscape::render
