#include "render/silhouette.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"

namespace emscape::render {
namespace {

constexpr int kRowGrain = 32;
/// Pixels by which the projected outline is widened, so that only its inside must be looked at: far more than
/// the projection's rounding errors, little enough that few rays are tested.
constexpr double kMargin = 1.0 / 64;
/// Perspective: what of the box lies nearer to the eye's plane than this part of its diagonal is left out of
/// the projection; if the eye is not far from the box by comparison, rays are tested instead.
constexpr double kNearest = 1e-6;
constexpr double kEyeAtBox = 1e-4;

/// A point of the picture: (0, 0) is the centre of the first pixel.
struct PlanePoint {
  double x = 0, y = 0;
};
/// A piece of a row of pixels, in fractions.
struct Extent {
  double least = 1e300, largest = -1e300;

  void add(double x) {
    least = std::min(least, x);
    largest = std::max(largest, x);
  }
};

/// Positions by what each axis of a camera has of them: the inverse of CameraView::ray().
class Projection3 {
 public:
  explicit Projection3(const CameraView& camera) : camera_(camera) {
    const Vec3d normal = cross(camera.right, camera.up);
    const double volume = dot(camera.forward, normal);
    to_forward_ = normal / volume;
    to_right_ = cross(camera.up, camera.forward) / volume;
    to_up_ = cross(camera.forward, camera.right) / volume;
  }
  double depth(const Vec3d& position) const { return dot(position - camera_.eye, to_forward_); }
  /// @param position  before the eye's plane, unless the projection is orthographic
  PlanePoint operator()(const Vec3d& position) const {
    const Vec3d offset = position - camera_.eye;
    const double scale = camera_.half_height * (camera_.orthographic ? 1.0 : dot(offset, to_forward_));
    const double plane_x = dot(offset, to_right_) / scale - camera_.shift_x;
    const double plane_y = dot(offset, to_up_) / scale - camera_.shift_y;
    const ImageSize size = camera_.size;
    return {0.5 * (plane_x * size.height + size.width) - 0.5, 0.5 * (1.0 - plane_y) * size.height - 0.5};
  }

 private:
  const CameraView& camera_;
  Vec3d to_forward_, to_right_, to_up_;
};

/// Lines whose ends span the box' outline in the picture.
using Lines = std::vector<std::array<PlanePoint, 2>>;

/// The box' edges as far as they lie at least `nearest` before the eye, and all lines between the points
/// where they are cut.
Lines outlineOf(const Projection3& project, const Vec3d& lower, const Vec3d& upper, double nearest) {
  const auto corner = [&](unsigned i) {
    return Vec3d{(i & 1U) != 0 ? upper.x : lower.x, (i & 2U) != 0 ? upper.y : lower.y,
                 (i & 4U) != 0 ? upper.z : lower.z};
  };
  Lines lines;
  std::vector<PlanePoint> cuts;
  for (unsigned i = 0; i < 8; ++i) {
    for (unsigned axis = 1; axis < 8; axis *= 2) {
      if ((i & axis) != 0) continue;
      Vec3d p = corner(i);
      Vec3d q = corner(i | axis);
      if (project.depth(p) < project.depth(q)) std::swap(p, q);
      const double p_depth = project.depth(p);
      const double q_depth = project.depth(q);
      if (p_depth < nearest) continue;
      const bool is_cut = q_depth < nearest;
      if (is_cut) q = p + (q - p) * ((p_depth - nearest) / (p_depth - q_depth));
      lines.push_back({project(p), project(q)});
      if (is_cut) cuts.push_back(lines.back()[1]);
    }
  }
  for (std::size_t a = 0; a < cuts.size(); ++a) {
    for (std::size_t b = a + 1; b < cuts.size(); ++b) lines.push_back({cuts[a], cuts[b]});
  }
  return lines;
}

/// What lies between two heights of the convex hull of the lines.
Extent extentBetween(const Lines& lines, double top, double bottom) {
  Extent extent;
  for (const auto& [p, q] : lines) {
    if (std::max(p.y, q.y) < top || std::min(p.y, q.y) > bottom) continue;
    const double height = q.y - p.y;
    for (const double y : {std::min(std::max(p.y, top), bottom), std::min(std::max(q.y, top), bottom)}) {
      extent.add(height != 0 ? p.x + (q.x - p.x) * std::min(1.0, std::max(0.0, (y - p.y) / height)) : p.x);
    }
    if (height == 0) extent.add(q.x);
  }
  return extent;
}

double distanceToBox(const Vec3d& p, const Vec3d& lower, const Vec3d& upper) {
  const auto beyond = [](double x, double low, double high) { return std::max({low - x, x - high, 0.0}); };
  return length(
      Vec3d{beyond(p.x, lower.x, upper.x), beyond(p.y, lower.y, upper.y), beyond(p.z, lower.z, upper.z)});
}

}  // namespace

long long Silhouette::count() const {
  long long sum = 0;
  for (const Span& row : rows) sum += std::max(0, row.end - row.begin);
  return sum;
}

void findSilhouette(const CameraView& camera, const Vec3d& lower, const Vec3d& upper,
                    Silhouette& silhouette) {
  const ImageSize size = camera.size;
  wholePicture(size, silhouette);
  const double diagonal = length(upper - lower);
  double nearest = 0;
  bool may_project = true;
  if (!camera.orthographic) {
    // Depths count lengths along `forward`, which is of any length in index space.
    const double aspect = static_cast<double>(size.width) / size.height;
    const double reach = length(camera.forward) +
                         camera.half_height * ((aspect + std::abs(camera.shift_x)) * length(camera.right) +
                                               (1.0 + std::abs(camera.shift_y)) * length(camera.up));
    nearest = kNearest * diagonal / reach;
    may_project = distanceToBox(camera.eye, lower, upper) > kEyeAtBox * diagonal;
  }
  const Lines lines = may_project ? outlineOf(Projection3(camera), lower, upper, nearest) : Lines{};
  const auto meets = [&](int x, int y) {
    const RayInterval inside = clip(camera.ray(x, y), lower, upper);
    return inside.end > inside.begin;
  };
  parallelFor(size.height, kRowGrain, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      Span& row = silhouette.rows[static_cast<std::size_t>(y)];
      if (may_project) {
        const Extent extent = extentBetween(lines, y - kMargin, y + kMargin);
        const double end = size.width;
        row.begin = static_cast<int>(std::ceil(std::clamp(extent.least - kMargin, 0.0, end)));
        row.end = static_cast<int>(std::floor(std::clamp(extent.largest + kMargin, -1.0, end - 1.0))) + 1;
      }
      while (row.begin < row.end && !meets(row.begin, y)) ++row.begin;
      while (row.begin < row.end && !meets(row.end - 1, y)) --row.end;
      if (row.end <= row.begin) row = {};
    }
  });
}

void wholePicture(ImageSize size, Silhouette& silhouette) {
  silhouette.rows.assign(static_cast<std::size_t>(size.height), {0, size.width});
}

}  // namespace emscape::render
