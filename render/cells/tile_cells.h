/// Balanced cell projection for tiles of pixels, without a rasteriser: the numbers of a cell, and what a
/// pixel's ray makes of them. Host and device.
///
/// With r = (x, y, 1) in the camera's axes, the ray t r through the place (x, y) of the picture plane crosses
/// the plane n.p = c of a face at t = c / (n.r): 1/t is linear over the picture plane, and with it the u of
/// projected_cells.h; with parallel rays t itself is. A ray enters a cell at the farthest of the planes that
/// the eye is in front of, and leaves it at the nearest of the others. Where cells meet they find the same t.
/// The value along a ray is (value at the eye) + t (g.r), with its gradient g.
#pragma once

#include <cmath>

#include "render/cells/cell_walk.h"
#include "render/cells/pixel_tiles.h"
#include "render/cells/projected_cells.h"

namespace emscape::render {

/// A point of the mesh along the camera's axes, from the eye on, and its value.
struct ViewPoint {
  double x, y, depth, value;
};

/// A cell of a mesh in a picture.
struct PlacedCell {
  std::int32_t corners[4];  ///< points
  PixelBox pixels;          ///< that it may cover
};

/// A picture that is to be projected, as plain data.
struct TileTask {
  CameraView camera;
  DepthAxes axes;
  IntervalsView transfer{};
  PsiLookup psi{};
  double through = 0;  ///< MarchLimits::through
  /// Per pixel the depth at which its ray ends; null: none ends.
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
  double x, y;       ///< place in the picture plane
  double length;     ///< of its part of depth 1, in reference steps
  double end_depth;  ///< where it ends

  EMSCAPE_HD PixelRay(const TileTask& task, int pixel_x, int pixel_y) {
    // Beside the centre of the pixel by a part of it that no picture shows: a ray within a face or along an
    // edge of a regular mesh is in none of the cells there, or in several, as rounding has it.
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

/// The part of the picture in which the corners of a cell span what is in front of the eye.
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
        // The edge goes on to where its depth is 0: infinitely far in the picture plane.
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
  // The inverse of CameraView::rayThrough(); the margin is for rounding and PixelRay's step aside.
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

/// The function x of_x + y of_y + constant of a place in the picture plane.
struct PlaneFunction {
  double of_x, of_y, constant;

  EMSCAPE_HD double operator()(double x, double y) const { return of_x * x + (of_y * y + constant); }
};

/// A part of a ray in a cell.
struct RaySegment {
  double begin, end;   ///< depths
  double front, back;  ///< values
};

/// A cell as the rays of a picture meet it.
struct TileCell {
  /// 1/t at the planes of the faces, with parallel rays -t: those through which rays enter first.
  PlaneFunction nearness[4];
  int entries = 0;  ///< their number; none: the eye is in the cell
  double eye_value;
  Vec3d gradient;  ///< of the value, along the camera's axes
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
      if (volume6 < 0) outward = outward * -1.0;  // the camera's axes may mirror
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

  /// @return false if the ray does not meet it
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

/// Adds what a ray gathers in a cell behind those before.
EMSCAPE_HD inline void addSegment(const TileTask& task, const TileCell& cell, const PixelRay& ray,
                                  RayIntegral& integral) {
  RaySegment segment;
  if (integral.through() < task.through || !cell.meets(ray, task.camera.orthographic, segment)) return;
  integral.add(segment.front, segment.back, (segment.end - segment.begin) * ray.length);
}

}  // namespace emscape::render
