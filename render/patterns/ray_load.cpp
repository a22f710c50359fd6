#include "render/patterns/ray_load.h"

#include <cmath>

#include "render/cast/raycast.h"

namespace emscape::render {
namespace {

/// The ray of a pixel in drawn positions; its parameter is in metres.
Ray rayOf(const Camera& camera, int x, int y, ImageSize size) {
  const Vec3d offset = camera.right * (camera.planeX(x, size) * camera.half_height) +
                       camera.up * (camera.planeY(y, size) * camera.half_height);
  if (camera.projection == Projection::orthographic) return {camera.eye_m + offset, camera.forward};
  return {camera.eye_m, normalized(camera.forward + offset)};
}

}  // namespace

RayLoad rayLoadOf(const std::vector<Lattice>& pixels, ImageSize size, const Camera& camera,
                  const volume::Grid& grid, const SceneBox& box, double step_voxels) {
  const Vec3d voxel_m{grid.spacing_m.x, grid.spacing_m.y, grid.spacing_m.z * box.vertical_exaggeration};
  RayLoad load;
  for (const Lattice& lattice : pixels) {
    for (int j = 0; j < lattice.rows; ++j) {
      for (int i = 0; i < lattice.columns; ++i) {
        const Ray ray =
            rayOf(camera, lattice.first_x + i * lattice.step_x, lattice.first_y + j * lattice.step_y, size);
        const RayInterval inside = clip(ray, box.lower_m, box.drawnUpper_m());
        if (!(inside.end > inside.begin)) continue;
        const Vec3d& along = ray.direction;
        const double voxels_per_m =
            length(Vec3d{along.x / voxel_m.x, along.y / voxel_m.y, along.z / voxel_m.z});
        ++load.rays;
        load.samples += std::llround(std::ceil((inside.end - inside.begin) * voxels_per_m / step_voxels));
      }
    }
  }
  return load;
}

}  // namespace emscape::render
