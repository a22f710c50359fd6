/// Echo, jamming and detection of a target at the end of a path.
#pragma once

#include <optional>

#include "emscape/base/vec.h"
#include "emscape/emfield/link/path_budget.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::emfield {

/// True if a radar's antenna turns to no target: a fixed scan, of no array.
bool isFixed(const scenario::Emitter& radar);

/// The values of a voxel at that point, without the volume's floor.
struct RadarAtPoint {
  double snr_db = 0;                    ///< -infinity without an echo
  double jammer_to_signal_db = 0;       ///< -infinity without jamming; 100 with jamming and without an echo
  double detection_probability = 0;     ///< against clutter, noise and jamming
  double probability_in_any_range = 0;  ///< the same without limits of range
  PathJamming jamming;
  /// Of a beam that follows the target: its gain towards it, relative to its maximum (dB), <= 0.
  std::optional<double> look_pattern_db;

  /// Of a radar with clutter.
  struct Clutter {
    double surface_to_noise_db = 0;  ///< of land and sea before the filter; -infinity: none in sight
    double rain_to_noise_db = 0;     ///< the same of rain
    double surface_improvement_db = 0, rain_improvement_db = 0;  ///< by the filter; 0 without one
    double response_db = 0;  ///< of the filter at the target's radial speed; 0 without one
    double sclnr_db = 0;     ///< echo over clutter and noise, after the filter
  };
  std::optional<Clutter> clutter;
};

/// @param ray    start of the refracted ray to the point, east-north-up at the radar
/// @param path   to the point: its power density on boresight and its reflected ray
/// @throws Error (bad_input) if a jammer's path to the radar crosses missing terrain
RadarAtPoint radarAtPoint(const scenario::Snapshot& snapshot, int radar, const Vec3d& ray,
                          const PathBudget& path, const scenario::Terrain* terrain);

}  // namespace emscape::emfield
