/// Balanced cell projection for tiles of pixels, without a rasteriser: the numbers of a cell, and their
/// evaluation for the ray of a pixel. Host and device.
///
/// With r = (x, y, 1) in the camera's axes, the ray t r through the point (x, y) of the picture plane crosses
/// the plane n.p = c of a face at t = c / (n.r). So 1/t and the u of projected_cells.h are linear over the
/// picture plane; with parallel rays t is. A ray enters a cell at the farthest of the planes that the eye is
/// in front of, and leaves it at the nearest of the others. Adjacent cells have the same t at their face.
/// The value along a ray is (value at the eye) + t (g.r), with its gradient g.
#pragma once

#include <cmath>

#include "render/cells/cell_walk.h"
#include "render/cells/pixel_tiles.h"
#include "render/cells/projected_cells.h"

namespace emscape::render {

/// A point of the mesh along the camera's axes relative to the eye, and its value.
struct ViewPoint {
  double x, y, depth, value;
};

/// A cell of a mesh in a picture.
struct PlacedCell {
  std::int32_t corners[4];  ///< points
  PixelBox pixels;          ///< pixels that the cell may cover
};

/// Projection of a picture, as plain data.
struct TileTask {
  CameraView camera;
  DepthAxes axes;
  IntervalsView transfer{};
  PsiLookup psi{};
  double through = 0;  ///< MarchLimits::through
  /// Depth at which the ray of each pixel ends; null: no ray ends.
  const double* end_depth = nullptr;
  const ViewPoint* points = nullptr;
  const PlacedCell* cells = nullptr;  ///< the nearest first

  EMSCAPE_HD ViewPoint viewOf(const Vec3d& point, float value) const {
    const Vec3d from_eye = point - camera.eye;
    return {dot(axes.right, from_eye), dot(axes.up, from_eye), dot(axes.depth, from_eye),
            static_cast<double>(value)};
  }
};

/// The ray of a pixel.
struct PixelRay {
  double x, y;       ///< position in the picture plane
  double length;     ///< reference steps per unit of depth
  double end_depth;  ///< depth of the ray's end

  EMSCAPE_HD PixelRay(const TileTask& task, int pixel_x, int pixel_y) {
    // Offset from the pixel's centre by an invisible fraction: by rounding, a ray within a face or along an
    // edge of a regular mesh would be in none of the adjacent cells, or in several.
    constexpr double kAsideX = 2.3e-7, kAsideY = 1.7e-7;
    const CameraView& camera = task.camera;
    const double pixel = 2 * camera.half_height / camera.size.height;
    const Ray ray = camera.rayThrough<double>(pixel_x, pixel_y);
    const Vec3d across = camera.orthographic ? ray.origin - camera.eye : ray.direction;
    x = dot(task.axes.right, across) + kAsideX * pixel;
    y = dot(task.axes.up, across) + kAsideY * pixel;
    length = sqrt(dot(ray.direction, ray.direction));
    end_depth = task.end_depth != nullptr ? task.end_depth[pixel_y * camera.size.width + pixel_x] : HUGE_VAL;
  }
};

/// Bounding box, in the picture, of the part of a cell in front of the eye.
EMSCAPE_HD inline PixelBox pixelsOf(const TileTask& task, const std::int32_t (&corners)[4]) {
  const CameraView& camera = task.camera;
  double low_x = HUGE_VAL, high_x = -HUGE_VAL, low_y = HUGE_VAL, high_y = -HUGE_VAL;
  const auto add = [&](double x, double y) {
    low_x = fmin(low_x, x);
    high_x = fmax(high_x, x);
    low_y = fmin(low_y, y);
    high_y = fmax(high_y, y);
  };
  for (int n = 0; n < 4; ++n) {
    const ViewPoint& p = task.points[corners[n]];
    if (p.value != p.value) return {};  // no field
    if (camera.orthographic) {
      add(p.x, p.y);
    } else if (p.depth > 0) {
      add(p.x / p.depth, p.y / p.depth);
      for (int m = 0; m < 4; ++m) {
        const ViewPoint& q = task.points[corners[m]];
        if (q.depth > 0) continue;
        // The edge extends to depth 0: infinitely far in the picture plane.
        const auto farAt = [&](double of_p, double of_q) {
          const double at = of_q * p.depth - of_p * q.depth;
          return at > 0 ? HUGE_VAL : at < 0 ? -HUGE_VAL : 0.0;
        };
        const double far_x = farAt(p.x, q.x), far_y = farAt(p.y, q.y);
        if (far_x != 0) add(far_x, p.y / p.depth);
        if (far_y != 0) add(p.x / p.depth, far_y);
      }
    }
  }
  // Inverse of CameraView::rayThrough(); the margin covers rounding and PixelRay's offset.
  constexpr double kMargin = 1e-3;
  const double width = camera.size.width, height = camera.size.height;
  const auto pixelX = [&](double x) {
    return 0.5 * ((x / camera.half_height - camera.shift_x) * height + width - 1);
  };
  const auto pixelY = [&](double y) {
    return 0.5 * ((1 - y / camera.half_height + camera.shift_y) * height - 1);
  };
  const auto within = [](double at, double limit) { return static_cast<int>(fmin(fmax(at, 0.0), limit)); };
  return {within(ceil(pixelX(low_x) - kMargin), width), within(ceil(pixelY(high_y) - kMargin), height),
          within(floor(pixelX(high_x) + kMargin) + 1, width),
          within(floor(pixelY(low_y) + kMargin) + 1, height)};
}

/// @param vertices  four per cell
EMSCAPE_HD inline PlacedCell placed(const TileTask& task, const std::int32_t* vertices, int cell) {
  PlacedCell result;
  for (int n = 0; n < 4; ++n) result.corners[n] = vertices[4 * cell + n];
  result.pixels = pixelsOf(task, result.corners);
  return result;
}

/// Linear function x of_x + y of_y + constant of a position in the picture plane.
struct PlaneFunction {
  double of_x, of_y, constant;

  EMSCAPE_HD double operator()(double x, double y) const { return of_x * x + (of_y * y + constant); }
};

/// Segment of a ray in a cell.
struct RaySegment {
  double begin, end;   ///< depths
  double front, back;  ///< values

  EMSCAPE_HD double middle() const { return 0.5 * (begin + end); }
};

/// A cell prepared for the rays of a picture.
struct TileCell {
  /// 1/t at the planes of the faces, with parallel rays -t; entry faces first.
  PlaneFunction nearness[4];
  int entries = 0;  ///< number of entry faces; 0: the eye is in the cell
  double eye_value;
  Vec3d gradient;  ///< of the value, in the camera's axes
  PixelBox pixels;

  TileCell() = default;
  EMSCAPE_HD TileCell(const TileTask& task, int rank) : pixels(task.cells[rank].pixels) {
    Vec3d p[4];
    double values[4];
    for (int n = 0; n < 4; ++n) {
      const ViewPoint& corner = task.points[task.cells[rank].corners[n]];
      p[n] = {corner.x, corner.y, corner.depth};
      values[n] = corner.value;
    }
    const double volume6 = dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]);
    const double per_volume = 1 / fabs(volume6);
    eye_value = values[0];
    gradient = {0, 0, 0};
    int last = 4;
    for (int n = 0; n < 4; ++n) {
      const Vec3d &a = p[faceVertex(n, 0)], &b = p[faceVertex(n, 1)], &c = p[faceVertex(n, 2)];
      Vec3d outward = cross(b - a, c - a);
      if (volume6 < 0) outward = outward * -1.0;  // the camera's axes may be left-handed
      const double at = dot(outward, a);
      // The weight of corner n is (at - outward.p) / |volume6|.
      const double rise = (values[n] - values[0]) * per_volume;
      gradient = gradient - outward * rise;
      eye_value += at * rise;
      const bool is_parallel = task.camera.orthographic;
      const double along = is_parallel ? outward.z : at;  // of the ray; of the eye, from within
      constexpr double kTiny = 1e-100;                    // the ray, or the eye, is in the plane
      const double per = 1 / (fabs(along) < kTiny ? kTiny : along);
      const PlaneFunction plane{outward.x * per, outward.y * per, (is_parallel ? -at : outward.z) * per};
      nearness[per < 0 ? entries++ : --last] = plane;
    }
  }

  /// @return false if the ray does not cross the cell
  EMSCAPE_HD bool meets(const PixelRay& ray, bool is_parallel, RaySegment& segment) const {
    double enter = HUGE_VAL, leave = -HUGE_VAL;
    for (int n = 0; n < entries; ++n) enter = fmin(enter, nearness[n](ray.x, ray.y));
    for (int n = entries; n < 4; ++n) leave = fmax(leave, nearness[n](ray.x, ray.y));
    const double across = gradient.x * ray.x + gradient.y * ray.y;
    double front = eye_value, slope = gradient.z;
    if (is_parallel) {
      segment.begin = fmax(0.0, -enter);
      segment.end = -leave;
      front += across;
    } else {
      if (!(enter > leave && leave > 0)) return false;
      segment.begin = 1 / enter;
      segment.end = 1 / leave;
      slope += across;
    }
    segment.end = fmin(segment.end, ray.end_depth);
    segment.front = front + segment.begin * slope;
    segment.back = front + segment.end * slope;
    return segment.end > segment.begin;
  }
};

/// Adds a ray's segment behind the earlier ones.
EMSCAPE_HD inline void addSegment(const RaySegment& segment, const PixelRay& ray, RayIntegral& integral) {
  integral.add(segment.front, segment.back, (segment.end - segment.begin) * ray.length);
}

/// The same for the segment in a cell, if the ray crosses it.
EMSCAPE_HD inline void addSegment(const TileTask& task, const TileCell& cell, const PixelRay& ray,
                                  RayIntegral& integral) {
  RaySegment segment;
  if (integral.through() < task.through || !cell.meets(ray, task.camera.orthographic, segment)) return;
  addSegment(segment, ray, integral);
}

}  // namespace emscape::render
