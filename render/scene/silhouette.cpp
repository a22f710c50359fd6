#include "render/scene/silhouette.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "emscape/base/parallel.h"

namespace emscape::render {
namespace {

constexpr int kSilhouetteGrain = 32;
/// Pixels by which the projected outline is widened, so that only its inside must be tested: much more than
/// the projection's rounding errors, but so little that few rays are tested.
constexpr double kMargin = 1.0 / 64;
/// Perspective: parts of the box that are closer to the eye's plane than this fraction of its diagonal are
/// left out of the projection. If the eye is not much farther from the box, rays are tested instead.
constexpr double kNearest = 1e-6;
constexpr double kEyeAtBox = 1e-4;

/// A point of the picture: (0, 0) is the centre of the first pixel.
struct PlanePoint {
  double x = 0, y = 0;
};
/// An interval of a row of pixels, in fractions.
struct Extent {
  double least = 1e300, largest = -1e300;

  void add(double x) {
    least = std::min(least, x);
    largest = std::max(largest, x);
  }
};

/// Coordinates of positions along the axes of a camera: the inverse of CameraView::ray().
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
  /// @param position  in front of the eye's plane, unless the projection is orthographic
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

/// The parts of the box's edges that are at least `nearest` in front of the eye, and all lines between the
/// points where they are cut.
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

/// Extent of the convex hull of the lines between two heights.
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

/// Outline of a box in a picture, unless the eye is in it or too close.
struct Outline {
  bool is_known = false;
  Lines lines;
};

Outline outlineOf(const CameraView& camera, const Vec3d& lower, const Vec3d& upper) {
  const Projection3 project(camera);
  if (camera.orthographic) return {true, outlineOf(project, lower, upper, 0.0)};
  const double diagonal = length(upper - lower);
  if (distanceToBox(camera.eye, lower, upper) <= kEyeAtBox * diagonal) return {};
  // Depths are in units of `forward`, which has any length in index space.
  const double aspect = static_cast<double>(camera.size.width) / camera.size.height;
  const double reach = length(camera.forward) +
                       camera.half_height * ((aspect + std::abs(camera.shift_x)) * length(camera.right) +
                                             (1.0 + std::abs(camera.shift_y)) * length(camera.up));
  return {true, outlineOf(project, lower, upper, kNearest * diagonal / reach)};
}

/// The pixels of a row that an outline covers, and at most those within kMargin of it.
Span spanOf(const Outline& outline, int y, int width) {
  if (!outline.is_known) return {0, width};
  const Extent extent = extentBetween(outline.lines, y - kMargin, y + kMargin);
  const double end = width;
  const auto first = static_cast<int>(std::ceil(std::clamp(extent.least - kMargin, 0.0, end)));
  const auto last = static_cast<int>(std::floor(std::clamp(extent.largest + kMargin, -1.0, end - 1.0)));
  return first <= last ? Span{first, last + 1} : Span{};
}

/// @param trim  called with each row's wide span and its y
template <class Trim>
void findRows(const CameraView& camera, const Vec3d& lower, const Vec3d& upper, const Trim& trim,
              Silhouette& silhouette) {
  const ImageSize size = camera.size;
  silhouette.rows.resize(static_cast<std::size_t>(size.height));
  const Outline outline = outlineOf(camera, lower, upper);
  parallelFor(size.height, kSilhouetteGrain, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      Span& row = silhouette.rows[static_cast<std::size_t>(y)];
      row = spanOf(outline, y, size.width);
      trim(row, y);
    }
  });
}

}  // namespace

long long Silhouette::count() const {
  long long sum = 0;
  for (const Span& row : rows) sum += std::max(0, row.end - row.begin);
  return sum;
}

void findWideSilhouette(const CameraView& camera, const Vec3d& lower, const Vec3d& upper,
                        Silhouette& silhouette) {
  findRows(
      camera, lower, upper, [](Span& /*row*/, int /*y*/) {}, silhouette);
}

void findSilhouette(const CameraView& camera, const Vec3d& lower, const Vec3d& upper,
                    Silhouette& silhouette) {
  const auto meets = [&](int x, int y) {
    const RayInterval inside = clip(camera.ray(x, y), lower, upper);
    return inside.end > inside.begin;
  };
  const auto trim = [&](Span& row, int y) {
    while (row.begin < row.end && !meets(row.begin, y)) ++row.begin;
    while (row.begin < row.end && !meets(row.end - 1, y)) --row.end;
    if (row.end <= row.begin) row = {};
  };
  findRows(camera, lower, upper, trim, silhouette);
}

std::vector<IndexBox> visibleBoxes(const SkipView& skip, const Dims& voxels) {
  constexpr int kEdge = 1 << SkipView::kEdgeBits;
  // Positions of samples are floats; the outer bricks extend to the faces of the box and beyond.
  constexpr double kRounding = 1.0 / 64;
  const auto lower = [&](int brick) { return (brick > 0 ? brick * kEdge : -1) - kRounding; };
  const auto upper = [&](int brick, int bricks, int count) {
    return (brick + 1 < bricks ? (brick + 1) * kEdge : count) + kRounding;
  };
  std::vector<IndexBox> boxes;
  for (int k = 0; k < skip.dims.z; ++k) {
    for (int j = 0; j < skip.dims.y; ++j) {
      const float* levels = skip.levels + (static_cast<std::ptrdiff_t>(k) * skip.dims.y + j) * skip.dims.x;
      int first = 0;
      int end = skip.dims.x;
      while (first < end && levels[first] != SkipView::kNever) ++first;
      while (first < end && levels[end - 1] != SkipView::kNever) --end;
      if (first == end) continue;
      boxes.push_back({{lower(first), lower(j), lower(k)},
                       {upper(end - 1, skip.dims.x, voxels.x), upper(j, skip.dims.y, voxels.y),
                        upper(k, skip.dims.z, voxels.z)}});
    }
  }
  return boxes;
}

void narrowSilhouette(const CameraView& camera, const std::vector<IndexBox>& boxes, Silhouette& silhouette) {
  std::vector<Outline> outlines;
  std::vector<Extent> heights;
  for (const IndexBox& box : boxes) {
    outlines.push_back(outlineOf(camera, box.lower, box.upper));
    Extent& height = heights.emplace_back();
    if (!outlines.back().is_known) return;  // it may cover every pixel
    for (const auto& [p, q] : outlines.back().lines) {
      height.add(p.y);
      height.add(q.y);
    }
  }
  parallelFor(camera.size.height, kSilhouetteGrain, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      Span& row = silhouette.rows[static_cast<std::size_t>(y)];
      Span covered{row.end, row.begin};
      for (std::size_t i = 0; i < outlines.size(); ++i) {
        if (y < heights[i].least - kMargin || y > heights[i].largest + kMargin) continue;
        const Span span = spanOf(outlines[i], y, camera.size.width);
        if (span.end <= span.begin) continue;
        covered.begin = std::min(covered.begin, span.begin);
        covered.end = std::max(covered.end, span.end);
      }
      row = {std::max(row.begin, covered.begin), std::min(row.end, covered.end)};
      if (row.end <= row.begin) row = {};
    }
  });
}

void wholePicture(ImageSize size, Silhouette& silhouette) {
  silhouette.rows.assign(static_cast<std::size_t>(size.height), {0, size.width});
}

}  // namespace emscape::render
