/// Cells that meet or overlap without a common face. Across a face of two cells the number of cells at a
/// point does not change; hence cells overlap where a line has entered the mesh through its boundary at least
/// twice more than it has left it.
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "emscape/base/parallel.h"
#include "emscape/volume/mesh/mesh.h"
#include "volume/mesh/mesh_text.h"

namespace emscape::volume {
namespace {

/// Points at which lines pass through a face, as weights of its corners: near each corner, and inside. They
/// are not simple fractions, because the edges of regular meshes pass through such points.
constexpr double kWeights[4][3] = {
    {0.9713, 0.0129, 0.0158}, {0.0127, 0.9716, 0.0157}, {0.0161, 0.0126, 0.9713}, {0.3517, 0.2931, 0.3552}};
constexpr int kInside = 3;
constexpr double kMaxTests = 2e7;  ///< lines times candidate faces, along an axis

/// A position by a line along an axis: two coordinates across it, and one along it.
struct AlongAxis {
  double u, v, w;
};

AlongAxis alongAxis(const Vec3d& p, int axis) {
  if (axis == 0) return {p.y, p.z, p.x};
  return axis == 1 ? AlongAxis{p.z, p.x, p.y} : AlongAxis{p.x, p.y, p.z};
}
Vec3d position(const AlongAxis& a, int axis) {
  if (axis == 0) return {a.w, a.u, a.v};
  return axis == 1 ? Vec3d{a.v, a.w, a.u} : Vec3d{a.u, a.v, a.w};
}

std::array<Vec3d, 3> cornersOf(const TetrahedralMesh& mesh, FaceId face) {
  const auto& cell = mesh.cells[static_cast<std::size_t>(face >> 2)];
  const auto corner = [&](int n) {
    return mesh
        .points_m[static_cast<std::size_t>(cell[static_cast<std::size_t>(kFaceVertices[face & 3][n])])];
  };
  return {corner(0), corner(1), corner(2)};
}

/// Normal of a face; its length is twice the area.
Vec3d normalOf(const std::array<Vec3d, 3>& corners) {
  return cross(corners[1] - corners[0], corners[2] - corners[0]);
}

int steepestAxis(const Vec3d& normal) {
  const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
  if (x >= y && x >= z) return 0;
  return y >= z ? 1 : 2;
}

/// The intersection of a line with a boundary face.
struct Passage {
  double at;      ///< along the line
  double cosine;  ///< of the angle between the line and the face's normal, 0..1
  FaceId face;
  bool enters;
};

/// The boundary faces by their position across an axis, in square buckets.
class BoundaryAcross {
 public:
  BoundaryAcross(const TetrahedralMesh& mesh, const std::vector<FaceId>& boundary, const MeshBounds& bounds,
                 int axis)
      : mesh_(mesh), axis_(axis), lower_(alongAxis(bounds.lower_m, axis)) {
    const AlongAxis upper = alongAxis(bounds.upper_m, axis);
    size_u_ = upper.u - lower_.u;
    size_v_ = upper.v - lower_.v;
    rows_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(boundary.size()))), 1, 4096);
    // Long faces cover many buckets; then fewer are used.
    std::size_t members = 0;
    for (;; rows_ /= 2) {
      members = 0;
      for (const FaceId face : boundary) {
        const Box box = boxOf(face);
        members += static_cast<std::size_t>(box.end_u - box.first_u) *
                   static_cast<std::size_t>(box.end_v - box.first_v);
      }
      if (members <= 8 * boundary.size() || rows_ == 1) break;
    }
    first_.assign(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(rows_) + 1, 0);
    for (const FaceId face : boundary) eachBucket(face, [&](std::size_t bucket) { ++first_[bucket + 1]; });
    for (std::size_t n = 0; n + 1 < first_.size(); ++n) first_[n + 1] += first_[n];
    members_.resize(members);
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const FaceId face : boundary)
      eachBucket(face, [&](std::size_t bucket) { members_[next[bucket]++] = face; });
  }

  /// Faces to be tested for a line.
  std::size_t candidates(const AlongAxis& line) const {
    const std::size_t bucket = bucketOf(line);
    return first_[bucket + 1] - first_[bucket];
  }

  /// The faces that a line intersects, in its direction. @return false if it intersects an edge, which gives
  /// no information
  bool follow(const AlongAxis& line, std::vector<Passage>& passages) const {
    passages.clear();
    const double rounding = 1e-15 * size_u_ * size_v_;
    const std::size_t bucket = bucketOf(line);
    const auto misses = [](double a, double b, double c) {
      return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
    };
    for (std::size_t n = first_[bucket]; n < first_[bucket + 1]; ++n) {
      const std::array<Vec3d, 3> corners = cornersOf(mesh_, members_[n]);
      AlongAxis c[3];
      for (std::size_t i = 0; i < 3; ++i) {
        c[i] = alongAxis(corners[i], axis_);
        c[i].u -= line.u;
        c[i].v -= line.v;
      }
      if (misses(c[0].u, c[1].u, c[2].u) || misses(c[0].v, c[1].v, c[2].v)) continue;
      double area[3];
      for (int i = 0; i < 3; ++i) {
        const AlongAxis &a = c[(i + 1) % 3], &b = c[(i + 2) % 3];
        area[i] = a.u * b.v - a.v * b.u;
      }
      const double sum = area[0] + area[1] + area[2], sign = sum > 0 ? 1 : -1;
      const double inside =
          sign * (sum > 0 ? std::min({area[0], area[1], area[2]}) : std::max({area[0], area[1], area[2]}));
      if (!(inside >= -rounding)) continue;
      if (!(inside > rounding)) return false;
      passages.push_back({(area[0] * c[0].w + area[1] * c[1].w + area[2] * c[2].w) / sum,
                          std::abs(sum) / length(normalOf(corners)), members_[n], sum < 0});
    }
    std::sort(passages.begin(), passages.end(), [](const Passage& a, const Passage& b) {
      return a.at != b.at ? a.at < b.at : a.face < b.face;
    });
    return true;
  }

 private:
  /// Buckets first..end - 1 along both coordinates.
  struct Box {
    int first_u, first_v, end_u, end_v;
  };
  int bucketAlong(double at, double size) const {
    return std::clamp(static_cast<int>(at / size * rows_), 0, rows_ - 1);
  }
  std::size_t bucketOf(const AlongAxis& line) const {
    return static_cast<std::size_t>(bucketAlong(line.v - lower_.v, size_v_)) *
               static_cast<std::size_t>(rows_) +
           static_cast<std::size_t>(bucketAlong(line.u - lower_.u, size_u_));
  }
  Box boxOf(FaceId face) const {
    const std::array<Vec3d, 3> corners = cornersOf(mesh_, face);
    const AlongAxis a = alongAxis(corners[0], axis_), b = alongAxis(corners[1], axis_),
                    c = alongAxis(corners[2], axis_);
    const auto u = std::minmax({a.u, b.u, c.u}), v = std::minmax({a.v, b.v, c.v});
    return {bucketAlong(u.first - lower_.u, size_u_), bucketAlong(v.first - lower_.v, size_v_),
            bucketAlong(u.second - lower_.u, size_u_) + 1, bucketAlong(v.second - lower_.v, size_v_) + 1};
  }
  template <class Visit>
  void eachBucket(FaceId face, const Visit& visit) const {
    const Box box = boxOf(face);
    for (int v = box.first_v; v < box.end_v; ++v) {
      for (int u = box.first_u; u < box.end_u; ++u)
        visit(static_cast<std::size_t>(v) * static_cast<std::size_t>(rows_) + static_cast<std::size_t>(u));
    }
  }

  const TetrahedralMesh& mesh_;
  int axis_, rows_ = 1;
  AlongAxis lower_;
  double size_u_ = 0, size_v_ = 0;
  std::vector<std::size_t> first_;  ///< of each bucket in members_; one more at the end
  std::vector<FaceId> members_;
};

/// A line along an axis through a face.
struct Line {
  FaceId face;
  int weights;  ///< row of kWeights
};

/// One line through the inside of each boundary face and one near each of its vertices, along the axis that
/// is closest to the face's normal.
std::array<std::vector<Line>, 3> linesThrough(const TetrahedralMesh& mesh,
                                              const std::vector<FaceId>& boundary) {
  std::array<std::vector<Line>, 3> lines;
  std::vector<bool> has_line(mesh.points_m.size());
  for (const FaceId face : boundary) {
    auto& along = lines[static_cast<std::size_t>(steepestAxis(normalOf(cornersOf(mesh, face))))];
    along.push_back({face, kInside});
    for (int n = 0; n < 3; ++n) {
      const auto vertex = static_cast<std::size_t>(kFaceVertices[face & 3][n]);
      auto known =
          has_line[static_cast<std::size_t>(mesh.cells[static_cast<std::size_t>(face >> 2)][vertex])];
      if (!known) along.push_back({face, n});
      known = true;
    }
  }
  return lines;
}

/// Result of a line.
struct Contact {
  bool touches = false;   ///< its face lies on one of another cell
  bool overlaps = false;  ///< at `at`, along the line
  double at = 0;
};

/// @param face  through which the line passes
/// @param rounding_m  thickness of overlaps that are ignored
Contact contactOf(const std::vector<Passage>& passages, FaceId face, double rounding_m) {
  Contact contact;
  int cells = 0;  // that hold the line
  for (std::size_t n = 0; n < passages.size(); ++n) {
    const Passage& here = passages[n];
    const int before = cells;
    cells += here.enters ? 1 : -1;
    // Where rounding has opened the boundary, a line gives no information.
    if (cells < 0 || (n + 1 == passages.size() && cells != 0)) return {};
    if (n + 1 == passages.size()) break;
    const Passage& next = passages[n + 1];
    const double thickness_m = (next.at - here.at) * std::min(here.cosine, next.cosine);
    if (thickness_m <= rounding_m) {
      const bool is_own = here.face == face || next.face == face;
      contact.touches = contact.touches || (is_own && before > 0 && here.enters != next.enters);
    } else if (cells > 1 && !contact.overlaps) {
      contact.overlaps = true;
      contact.at = here.at + 0.4142 * (next.at - here.at);
    }
  }
  return contact;
}

/// The first cells that contain a position.
std::vector<int> cellsAt(const TetrahedralMesh& mesh, const Vec3d& position) {
  std::mutex mutex;
  std::vector<int> found;
  parallelFor(static_cast<int>(mesh.cells.size()), 1 << 14, [&](int begin, int end) {
    for (int cell = begin; cell < end; ++cell) {
      bool inside = true;
      for (int n = 0; n < 4 && inside; ++n) {
        const std::array<Vec3d, 3> corners = cornersOf(mesh, 4 * cell + n);
        inside = dot(normalOf(corners), position - corners[0]) < 0;
      }
      if (!inside) continue;
      const std::lock_guard<std::mutex> lock(mutex);
      found.push_back(cell);
    }
  });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

long long touchingFaces(const TetrahedralMesh& mesh, const MeshFaces& faces, const SourceLocation& location) {
  const MeshBounds bounds = boundsOf(mesh);
  const auto largest = [](const Vec3d& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); };
  const double rounding_m = 1e-6 * length(bounds.upper_m - bounds.lower_m) +
                            2e-7 * std::max(largest(bounds.lower_m), largest(bounds.upper_m));
  const std::array<std::vector<Line>, 3> lines = linesThrough(mesh, faces.boundary);
  long long touching = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<Line>& along = lines[static_cast<std::size_t>(axis)];
    if (along.empty()) continue;
    const BoundaryAcross boundary(mesh, faces.boundary, bounds, axis);
    const auto placeOf = [&](const Line& line) {
      const std::array<Vec3d, 3> corners = cornersOf(mesh, line.face);
      const double* const weight = kWeights[line.weights];
      return alongAxis(corners[0] * weight[0] + corners[1] * weight[1] + corners[2] * weight[2], axis);
    };
    double tests = 0;
    for (const Line& line : along) tests += static_cast<double>(boundary.candidates(placeOf(line)));
    const auto step = static_cast<std::size_t>(std::ceil(std::max(1.0, tests / kMaxTests)));
    std::vector<Contact> contacts((along.size() + step - 1) / step);
    parallelFor(static_cast<int>(contacts.size()), 1024, [&](int begin, int end) {
      std::vector<Passage> passages;
      for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
        const Line& line = along[n * step];
        if (boundary.follow(placeOf(line), passages))
          contacts[n] = contactOf(passages, line.face, rounding_m);
      }
    });
    for (std::size_t n = 0; n < contacts.size(); ++n) {
      const Line& line = along[n * step];
      if (contacts[n].touches && line.weights == kInside) ++touching;
      if (!contacts[n].overlaps) continue;
      AlongAxis place = placeOf(line);
      place.w = contacts[n].at;
      const Vec3d at = position(place, axis);
      const std::vector<int> cells = cellsAt(mesh, at);
      if (cells.size() < 2) continue;
      throw Error(ErrorCode::bad_input, location,
                  cellText(mesh, cells[0]) + " and " + cellText(mesh, cells[1]) + " overlap, at (" +
                      std::to_string(at.x) + ", " + std::to_string(at.y) + ", " + std::to_string(at.z) + ")");
    }
  }
  return touching;
}

}  // namespace emscape::volume
