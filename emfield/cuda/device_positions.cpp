#include "emfield/cuda/device_positions.h"

#include <algorithm>

#include "base/cuda/staged_copy.h"
#include "emfield/cuda/position_kernels.h"
#include "emfield/solver/field_engine.h"

namespace emscape::emfield {

using emscape::cuda::Buffer;
using emscape::cuda::uploadStaged;

GridColumns makeDeviceColumns(const Surface& surface, const scenario::Terrain* terrain) {
  const emscape::cuda::Stream stream;
  GridColumns result = emptyColumns(surface);
  const std::size_t count = result.count();
  const auto on_device = std::make_shared<cuda::DevicePositions>();
  on_device->columns.resize(count);
  on_device->first_valid_k.resize(count);
  if (terrain != nullptr) {
    on_device->terrain = std::make_shared<const cuda::DeviceTerrain>(terrain->view(), stream);
    on_device->ground_msl_m.resize(count);
  }
  Buffer<Surface::Position> positions;
  uploadStaged(positions, surface.positions.data(), count, stream);
  Buffer<float> offsets_m;
  uploadStaged(offsets_m, surface.offsets_m.data(), surface.offsets_m.size(), stream);
  Buffer<double> heights_m;
  heights_m.upload(surface.heights_m, stream);
  GeoidView geoid = egm96Grid().view();
  Buffer<float> geoid_posts_m;
  uploadStaged(geoid_posts_m, geoid.posts_m,
               static_cast<std::size_t>(geoid.row_count) * static_cast<std::size_t>(geoid.column_count),
               stream);
  geoid.posts_m = geoid_posts_m.data();

  PositionTask task = positionTask(surface, terrain);
  task.positions = positions.data();
  task.offsets_m = offsets_m.data();
  task.heights_m = heights_m.data();
  if (terrain != nullptr) task.terrain = on_device->terrain->view();
  task.columns = on_device->columns.data();
  task.ground_msl_m = on_device->ground_msl_m.data();
  task.first_valid_k = on_device->first_valid_k.data();
  Buffer<PositionsPart> device_parts(cuda::kPositionsParts);
  cuda::computePositions(task, static_cast<int>(count), geoid, device_parts.data(), stream);
  std::vector<PositionsPart> parts(cuda::kPositionsParts);
  device_parts.download(parts.data(), stream);

  const PositionColumn middle = setMiddle(parts, terrain != nullptr, result);
  Buffer<double> device_beyond_m(cuda::kPositionsParts);
  cuda::spanPositions(task, static_cast<int>(count), middle, geodesyOf(middle), device_beyond_m.data(),
                      stream);
  result.first_valid_k.resize(count);
  emscape::cuda::downloadStaged(result.first_valid_k.data(), on_device->first_valid_k.data(),
                                count * sizeof(std::uint16_t), stream);
  std::vector<double> beyond_m(cuda::kPositionsParts);
  device_beyond_m.download(beyond_m.data(), stream);
  result.beyond_outline_m = *std::max_element(beyond_m.begin(), beyond_m.end());
  result.on_device = on_device;
  return result;
}

std::vector<float> groundOf(const cuda::DevicePositions& positions) {
  std::vector<float> ground_msl_m(positions.ground_msl_m.size());
  positions.ground_msl_m.download(ground_msl_m.data());
  return ground_msl_m;
}

}  // namespace emscape::emfield
