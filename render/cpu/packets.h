/// Casts rays in packets: each lane of a vector register is a ray. The fast form of
/// RaycastTask::castVolume().
///
/// A lane's result does not depend on its neighbours, so a pixel is the same in every packet.
#pragma once

#include "emscape/render/scene/render_settings.h"
#include "render/cast/raycast.h"
#include "render/patterns/reconstruction.h"

namespace emscape::render {

/// True if packets can cast a volume: no NaN or infinity, at least two voxels wide, fewer than 2^31 of them.
bool packetsCanCast(const VolumeView& volume);

/// Casts the volume as some pixels show it (see RaycastTask::castVolume()), with the widest vectors that the
/// processor has.
/// @param pixels  fast if neighbours in the list are neighbours in the picture
/// @param bounds  of the samples on each ray; null: none
/// @param fronts  receives `count` colours
/// @return samples taken Without shading, values are read as 16-bit codes if these resolve a 4096th of the
/// transfer function's interval.
/// @accuracy each channel within one level of 255 of the scalar form
long long castPackets(const RaycastTask& task, CompositingMode mode, const Pixel* pixels,
                      const RayBounds* bounds, int count, Rgba* fronts);

}  // namespace emscape::render
