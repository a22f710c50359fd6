#include "emscape/volume/mesh/mesh.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>

#include "emscape/base/parallel.h"
#include "volume/mesh/mesh_text.h"

namespace emscape::volume {
namespace {

constexpr int kGrain = 1 << 14;
/// Minimum volume of a cell, relative to the cube of its longest edge.
constexpr double kDegenerate = 1e-12;

/// Calls test(n) for n in [0, count) in parallel. @return the smallest n for which it is true; -1 if there is
/// none
template <class Test>
long long firstWhere(long long count, const Test& test) {
  std::atomic<long long> first{count};
  const int parts = static_cast<int>((count + kGrain - 1) / kGrain);
  parallelFor(parts, 1, [&](int begin, int end) {
    const long long last = std::min(static_cast<long long>(end) * kGrain, count);
    for (long long n = static_cast<long long>(begin) * kGrain; n < last && n < first.load(); ++n) {
      if (!test(n)) continue;
      long long known = first.load();
      while (n < known && !first.compare_exchange_weak(known, n)) {
      }
    }
  });
  return first.load() < count ? first.load() : -1;
}

bool isFinite(const Vec3d& point) {
  return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
}

/// Six times the signed volume of a cell over the cube of its longest edge; 0 for a repeated vertex.
double shapeOf(const TetrahedralMesh& mesh, const std::array<std::int32_t, 4>& cell) {
  Vec3d corner[4];
  for (int i = 0; i < 4; ++i) corner[i] = mesh.points_m[static_cast<std::size_t>(cell[i])];
  double longest = 0;
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) longest = std::max(longest, length(corner[j] - corner[i]));
  }
  if (!(longest > 0)) return 0;
  // Scaled first, to avoid overflow and underflow.
  const Vec3d a = (corner[1] - corner[0]) / longest;
  const Vec3d b = (corner[2] - corner[0]) / longest;
  const Vec3d c = (corner[3] - corner[0]) / longest;
  return dot(cross(a, b), c);
}

/// A face, in the list of the faces whose vertex of lowest index is `least`.
struct FaceRecord {
  std::int32_t middle, greatest;
  FaceId id;

  bool operator<(const FaceRecord& o) const {
    if (middle != o.middle) return middle < o.middle;
    return greatest != o.greatest ? greatest < o.greatest : id < o.id;
  }
  bool sameFace(const FaceRecord& o) const { return middle == o.middle && greatest == o.greatest; }
};

struct Face {
  std::int32_t least, middle, greatest;
  bool ascends;  ///< its outward order is an even permutation of (least, middle, greatest)
};

Face faceOf(const TetrahedralMesh& mesh, FaceId id) {
  const auto& cell = mesh.cells[static_cast<std::size_t>(id >> 2)];
  const int* const vertex = kFaceVertices[id & 3];
  std::int32_t v[3] = {cell[vertex[0]], cell[vertex[1]], cell[vertex[2]]};
  bool ascends = true;
  const auto order = [&](int a, int b) {
    if (v[a] <= v[b]) return;
    std::swap(v[a], v[b]);
    ascends = !ascends;
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return {v[0], v[1], v[2], ascends};
}

/// The faces of a mesh, in one list per vertex of the lowest index.
struct FaceLists {
  std::vector<std::size_t> first;  ///< of each point's list; one more at the end
  std::vector<FaceRecord> records;
};

FaceLists listFaces(const TetrahedralMesh& mesh) {
  FaceLists lists;
  const auto faces = static_cast<FaceId>(4 * mesh.cells.size());
  lists.first.assign(mesh.points_m.size() + 1, 0);
  for (FaceId id = 0; id < faces; ++id) ++lists.first[static_cast<std::size_t>(faceOf(mesh, id).least) + 1];
  for (std::size_t p = 0; p < mesh.points_m.size(); ++p) lists.first[p + 1] += lists.first[p];
  lists.records.resize(static_cast<std::size_t>(faces));
  std::vector<std::size_t> next(lists.first.begin(), lists.first.end() - 1);
  for (FaceId id = 0; id < faces; ++id) {
    const Face face = faceOf(mesh, id);
    lists.records[next[static_cast<std::size_t>(face.least)]++] = {face.middle, face.greatest, id};
  }
  return lists;
}

/// Sorts a point's faces and joins equal faces. @return false for a face that does not conform
bool joinFaces(const TetrahedralMesh& mesh, FaceRecord* begin, FaceRecord* end, std::vector<FaceId>& other) {
  std::sort(begin, end);
  bool conforms = true;
  for (FaceRecord* at = begin; at != end;) {
    FaceRecord* next = at + 1;
    while (next != end && next->sameFace(*at)) ++next;
    if (next - at == 2) {
      other[static_cast<std::size_t>(at[0].id)] = at[1].id;
      other[static_cast<std::size_t>(at[1].id)] = at[0].id;
      conforms = conforms && faceOf(mesh, at[0].id).ascends != faceOf(mesh, at[1].id).ascends;
    }
    conforms = conforms && next - at <= 2;
    at = next;
  }
  return conforms;
}

[[noreturn]] void failFace(const TetrahedralMesh& mesh, const FaceRecord* begin, const FaceRecord* end,
                           const SourceLocation& location) {
  for (const FaceRecord* at = begin;; ++at) {
    const FaceRecord* next = at + 1;
    while (next != end && next->sameFace(*at)) ++next;
    const auto count = next - at;
    if (count == 1 || (count == 2 && faceOf(mesh, at[0].id).ascends != faceOf(mesh, at[1].id).ascends)) {
      at = next - 1;
      continue;
    }
    const Face face = faceOf(mesh, at->id);
    std::string text = "the face of points " + std::to_string(face.least) + ", " +
                       std::to_string(face.middle) + ", " + std::to_string(face.greatest) + " belongs to ";
    if (count == 2) {
      throw Error(ErrorCode::bad_input, location,
                  text + cellText(mesh, at[0].id >> 2) + " and " + cellText(mesh, at[1].id >> 2) +
                      " on its same side: they overlap");
    }
    throw Error(ErrorCode::bad_input, location,
                text + std::to_string(count) + " cells, among them " + cellText(mesh, at[0].id >> 2) + ", " +
                    cellText(mesh, at[1].id >> 2) + " and " + cellText(mesh, at[2].id >> 2) +
                    "; at most two can meet");
  }
}

}  // namespace

MeshBounds boundsOf(const TetrahedralMesh& mesh) {
  MeshBounds bounds{mesh.points_m.front(), mesh.points_m.front()};
  for (const Vec3d& p : mesh.points_m) {
    bounds.lower_m = {std::min(bounds.lower_m.x, p.x), std::min(bounds.lower_m.y, p.y),
                      std::min(bounds.lower_m.z, p.z)};
    bounds.upper_m = {std::max(bounds.upper_m.x, p.x), std::max(bounds.upper_m.y, p.y),
                      std::max(bounds.upper_m.z, p.z)};
  }
  return bounds;
}

long long orientCells(TetrahedralMesh& mesh, const SourceLocation& location) {
  const auto fail = [&](const std::string& what) { throw Error(ErrorCode::bad_input, location, what); };
  const auto points = static_cast<long long>(mesh.points_m.size());
  const auto cells = static_cast<long long>(mesh.cells.size());
  if (cells == 0) fail("the mesh has no cells");
  if (points > kMaxMeshPoints) {
    fail(std::to_string(points) + " points: at most " + std::to_string(kMaxMeshPoints) + " can be used");
  }
  if (cells > kMaxMeshCells) {
    fail(std::to_string(cells) + " cells: at most " + std::to_string(kMaxMeshCells) + " can be used");
  }
  const long long bad_point =
      firstWhere(points, [&](long long n) { return !isFinite(mesh.points_m[static_cast<std::size_t>(n)]); });
  if (bad_point >= 0) fail("point " + std::to_string(bad_point) + " has a coordinate that is not finite");
  const long long bad_vertex = firstWhere(cells, [&](long long n) {
    const auto& cell = mesh.cells[static_cast<std::size_t>(n)];
    return std::any_of(cell.begin(), cell.end(), [&](std::int32_t v) { return v < 0 || v >= points; });
  });
  if (bad_vertex >= 0) {
    fail(cellText(mesh, bad_vertex) + ": points must be 0.." + std::to_string(points - 1));
  }
  const long long degenerate = firstWhere(cells, [&](long long n) {
    return !(std::abs(shapeOf(mesh, mesh.cells[static_cast<std::size_t>(n)])) > 6 * kDegenerate);
  });
  if (degenerate >= 0) fail(cellText(mesh, degenerate) + " is degenerate: it has no volume");
  std::atomic<long long> inverted{0};
  parallelFor(static_cast<int>(cells), kGrain, [&](int begin, int end) {
    long long swapped = 0;
    for (int n = begin; n < end; ++n) {
      auto& cell = mesh.cells[static_cast<std::size_t>(n)];
      if (shapeOf(mesh, cell) > 0) continue;
      std::swap(cell[2], cell[3]);
      ++swapped;
    }
    inverted += swapped;
  });
  return inverted;
}

MeshFaces facesOf(const TetrahedralMesh& mesh, const SourceLocation& location) {
  FaceLists lists = listFaces(mesh);
  MeshFaces faces;
  faces.other_side.assign(lists.records.size(), kNoFace);
  const auto begin = [&](long long p) {
    return lists.records.data() + lists.first[static_cast<std::size_t>(p)];
  };
  const long long bad = firstWhere(static_cast<long long>(mesh.points_m.size()), [&](long long p) {
    return !joinFaces(mesh, begin(p), begin(p + 1), faces.other_side);
  });
  if (bad >= 0) failFace(mesh, begin(bad), begin(bad + 1), location);
  for (std::size_t id = 0; id < faces.other_side.size(); ++id) {
    if (faces.other_side[id] == kNoFace) faces.boundary.push_back(static_cast<FaceId>(id));
  }
  return faces;
}

std::vector<std::array<std::int32_t, 4>> latticeCells(const Dims& points) {
  // Corners of a hexahedron: bit 0 for x, 1 for y, 2 for z. Each cell goes from corner 0 to 7 along three
  // edges.
  constexpr int kCells[6][4] = {{0, 1, 3, 7}, {0, 1, 7, 5}, {0, 2, 7, 3},
                                {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 7, 6}};
  std::vector<std::array<std::int32_t, 4>> cells;
  cells.reserve(6 * static_cast<std::size_t>(Dims{points.x - 1, points.y - 1, points.z - 1}.count()));
  for (int k = 0; k + 1 < points.z; ++k) {
    for (int j = 0; j + 1 < points.y; ++j) {
      for (int i = 0; i + 1 < points.x; ++i) {
        for (const auto& corners : kCells) {
          auto& cell = cells.emplace_back();
          for (std::size_t n = 0; n < 4; ++n) {
            const int corner = corners[n];
            cell[n] =
                ((k + (corner >> 2)) * points.y + j + ((corner >> 1) & 1)) * points.x + i + (corner & 1);
          }
        }
      }
    }
  }
  return cells;
}

void checkMeshField(const MeshField& field, const SourceLocation& location) {
  const auto fail = [&](const std::string& what) { throw Error(ErrorCode::bad_input, location, what); };
  if (field.info.quantity.empty()) fail("a field has no name");
  if (!field.mesh) fail("the field " + field.info.quantity + " has no mesh");
  if (field.values.size() != field.mesh->points_m.size()) {
    fail("the field " + field.info.quantity + " has " + std::to_string(field.values.size()) + " values for " +
         std::to_string(field.mesh->points_m.size()) + " points");
  }
  const long long infinite = firstWhere(static_cast<long long>(field.values.size()), [&](long long n) {
    return std::isinf(field.values[static_cast<std::size_t>(n)]);
  });
  if (infinite >= 0) {
    fail("the field " + field.info.quantity + " is infinite at point " + std::to_string(infinite) +
         ": values must be finite, or NaN where no field is known");
  }
}

Statistics statisticsOf(const MeshField& field) {
  Statistics statistics;
  statistics.voxels = static_cast<long long>(field.values.size());
  double sum = 0;
  for (const float value : field.values) {
    if (std::isnan(value)) {
      ++statistics.nan;
      continue;
    }
    if (value == field.info.floor) ++statistics.at_floor;
    statistics.min = statistics.valid == 0 ? value : std::min(statistics.min, value);
    statistics.max = statistics.valid == 0 ? value : std::max(statistics.max, value);
    sum += static_cast<double>(value);
    ++statistics.valid;
  }
  if (statistics.valid > 0) statistics.mean = sum / static_cast<double>(statistics.valid);
  return statistics;
}

void setRangeFromValues(MeshField& field) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  float min = kInfinity, max = -kInfinity;
  for (const float value : field.values) {
    if (!std::isfinite(value) || value == field.info.floor) continue;
    min = std::min(min, value);
    max = std::max(max, value);
  }
  const float empty = field.info.floor == kNoFloor ? 0 : field.info.floor;
  field.info.range_min = min <= max ? min : empty;
  field.info.range_max = min <= max ? max : empty;
}

DenseVolume valuesOf(const MeshField& field) {
  DenseVolume volume;
  volume.info = field.info;
  std::copy_if(field.values.begin(), field.values.end(), std::back_inserter(volume.values),
               [](float value) { return !std::isnan(value); });
  volume.grid.dims = {static_cast<int>(volume.values.size()), 1, 1};
  return volume;
}

}  // namespace emscape::volume
