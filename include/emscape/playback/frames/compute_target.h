/// The processor on which fields are computed and pictures are cast.
#pragma once

#include <string>

#include "emscape/base/backend.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/render/scene/renderer.h"
#include "emscape/volume/device_volume.h"

namespace emscape::playback {

/// A processor, and the storage of volumes on a GPU.
struct ComputeTarget {
  ResolvedBackend choice;
  volume::VoxelPrecision precision = volume::VoxelPrecision::float32;

  bool onGpu() const { return choice.backend == Backend::cuda; }
  /// For reports: "cpu", or the name of the GPU.
  const std::string& device() const { return choice.device; }
  /// Options for this target. Fields are computed on dense voxels, also if sparse ones are requested.
  emfield::FieldOptions fieldOptions() const;
  render::RendererOptions rendererOptions() const;
};

}  // namespace emscape::playback
