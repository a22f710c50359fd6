/// The value of a volume at a position, and its explanation.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/emfield/link/path_budget.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/terrain/terrain.h"
#include "emscape/volume/dense_volume.h"

namespace emscape::playback {

/// The value of a volume at a position.
struct VolumeSample {
  enum class Kind {
    value,     ///< a value
    at_floor,  ///< no field: not above the volume's floor
    masked,    ///< the voxel is below the ground, or its field is not known
    outside    ///< the position is outside the volume's box
  };
  Kind kind = Kind::outside;
  float value = 0;  ///< of Kind::value and Kind::at_floor
  Dims voxel;       ///< index of the voxel that holds the position; not of Kind::outside
};

/// Trilinear if all voxels around have a field; else, and for categories, the value of the voxel that
/// contains the position.
VolumeSample sampleVolume(const volume::DenseVolume& volume, const Vec3d& position_m);

/// Contribution of one emitter at a position.
struct EmitterProbe {
  std::string emitter;
  std::optional<emfield::PathBudget> budget;
  std::string refusal;  ///< reason for a missing budget: missing terrain, or a position at the emitter
};

struct ProbeReading {
  Vec3d position_m;  ///< frame metres
  VolumeSample sample;
  /// "-63.2 dBW/m2", or the reason for a missing value.
  std::string text;
  // Only for volumes with a position on the earth:
  std::optional<GeodeticPosition> position;
  std::optional<double> height_msl_m;
  std::optional<double> height_agl_m;  ///< none if the ground is not known
  /// One per emitter, as in `emscape profile` with the emitter's model; empty without a scenario.
  std::vector<EmitterProbe> emitters;
};

/// Reads a position at the volume's time. Pure function; takes some milliseconds, depending on the number of
/// emitters.
/// @param scenario  of the emitters; may be null
/// @param terrain   may be null: heights above ground are then not known, and paths run over a smooth earth
ProbeReading probe(const Vec3d& position_m, const volume::DenseVolume& volume,
                   const std::shared_ptr<const scenario::Scenario>& scenario,
                   const scenario::Terrain* terrain);

}  // namespace emscape::playback
