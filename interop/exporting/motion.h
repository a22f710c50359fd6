/// Platforms and beams of a scenario over time, for the writers of recordings.
#pragma once

#include <vector>

#include "emscape/base/vec.h"
#include "emscape/scenario/model/scenario.h"
#include "recording/common/recording.h"

namespace emscape::interop {

/// Refuses what would need too much memory or disk. @throws Error (usage)
void requireFewRecords(const scenario::Scenario& scenario, double step_s);

/// The part of the scenario's time in which a platform is present.
struct Presence {
  double begin_s = 0, end_s = 0;  ///< end before begin: never
};
Presence presenceOf(const scenario::Scenario& scenario, const scenario::Platform& platform);

/// Times (s) at which a platform's position is written, while it is present: of its track, the begin, the
/// end, and others so that none is more than step_s after the one before. A fixed platform: begin and end.
std::vector<double> timesOfPositions(const scenario::Scenario& scenario, const scenario::Platform& platform,
                                     double step_s);

/// Position and attitude of a platform, with its height above mean sea level.
PoseSample poseOf(const scenario::Platform& platform, const scenario::Terrain* terrain, double t_s);

/// What a platform probably is: scenarios do not tell.
Domain domainOf(const scenario::Scenario& scenario, const scenario::Platform& platform,
                const scenario::Terrain* terrain);

/// The state of an emitter's beam: direction, sweep, power; off where its platform is absent. Angles are
/// relative to the platform.
BeamState beamStateAt(const scenario::Scenario& scenario, const scenario::Emitter& emitter, double t_s);

/// Times (s) at which an emitter's state changes while its platform is present: switching, and dwells at most
/// every step_s; and just after the platform's end before the scenario's.
std::vector<double> timesOfChanges(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                                   double step_s);

/// Widths (deg) of a beam as recordings tell them: those of the beam, or of the sector that it sweeps.
struct BeamWidths {
  double azimuth_deg = 0, elevation_deg = 0;
};
BeamWidths widthsOf(const BeamState& state);

/// Velocity (m/s) east, north and up on the way to the next of some times; zero at the last one.
Vec3d velocityAt_mps(const scenario::Platform& platform, const scenario::Terrain* terrain,
                     const std::vector<double>& times, std::size_t index);

/// Length (m) of a drawn beam: recordings have one, the scenario has not. A quarter of the region's width.
double drawnRange_m(const scenario::Scenario& scenario);

/// Seconds from 1970 to t = 0; 0 for a scenario without an epoch.
double epochOf_s(const scenario::Scenario& scenario);

/// A text in double quotes as a pattern of an emitter database that matches it alone.
std::string quotedPattern(std::string text);

/// A row of the emitter database for an emitter of the scenario.
struct ExportedRow {
  std::string match;  ///< conditions in YAML's flow style
  std::size_t emitter = 0;
};
/// The text of an emitter database for a folder. @throws Error (bad_input) without the scenario's text
std::string databaseText(const scenario::Scenario& scenario, const std::vector<ExportedRow>& rows,
                         const std::string& folder);

}  // namespace emscape::interop
