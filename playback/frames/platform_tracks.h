/// The tracks of a scenario's moving platforms, as lines. Internal to the module.
#pragma once

#include <memory>
#include <vector>

#include "emscape/playback/frames/inputs.h"
#include "emscape/render/annotate/overlay.h"
#include "emscape/volume/grid.h"

namespace emscape::playback {

/// The part of a track between two times.
render::Track partOf(const render::Track& track, double from_s, double to_s);

/// Keeps the lines: only the current positions differ from one time to the next. For one thread.
class PlatformTracks {
 public:
  /// @param grid  the frame of the lines
  std::vector<render::Track> at(double time_s, const LoadedScenario& scene, const volume::Grid& grid);

 private:
  static render::Track lineOf(const scenario::Platform& platform, double duration_s, int max_points,
                              const scenario::Terrain* terrain, const GeoFrame& frame);

  std::shared_ptr<const scenario::Scenario> scenario_;  // of the lines
  volume::Grid grid_;
  std::vector<render::Track> lines_;
};

}  // namespace emscape::playback
