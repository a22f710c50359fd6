/// A scenario: the objects on the battlefield, their positions and times.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/enum_names.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/propagation/settings.h"
#include "emscape/scenario/model/clock.h"
#include "emscape/scenario/model/edit.h"
#include "emscape/scenario/model/emitter.h"
#include "emscape/scenario/model/interval.h"
#include "emscape/scenario/model/platform.h"
#include "emscape/scenario/model/quantities.h"
#include "emscape/scenario/model/target.h"
#include "emscape/scenario/terrain/terrain.h"

namespace emscape::scenario {

using emscape::toString;

/// A receiver without a platform, which is at every voxel: for received_power_dbm, sinr_db and
/// intercept_margin_db.
struct ReceiverProfile {
  std::string name;
  double gain_dbi = 0;                                    ///< in every direction
  double losses_db = 0;                                   ///< between antenna and receiver
  std::optional<propagation::Polarization> polarization;  ///< none: matched to every emitter
  /// 0: tuned to every emitter; for links and sinr_db, to the wanted emitter.
  double center_frequency_hz = 0;
  double bandwidth_hz = 0;  ///< 0: that of the emitter's signal. Noise requires > 0
  double cross_polar_isolation_db = kCrossPolarIsolation_db;
  std::optional<double> noise_figure_db;  ///< referred to 290 K
  double antenna_temperature_k = 290;     ///< noise from sky and ground
  /// Thresholds of reception: a signal is received if it meets all given ones. None: not evaluated.
  std::optional<double> sensitivity_dbm;   ///< minimum power after the losses
  std::optional<double> required_sinr_db;  ///< minimum signal over noise and interference

  bool hasNoise() const { return noise_figure_db && bandwidth_hz > 0; }
  bool hasThreshold() const { return sensitivity_dbm || required_sinr_db; }
};

/// A receiver on a platform, with its own antenna, whose gain replaces `gain_dbi`.
struct PlacedReceiver : ReceiverProfile {
  int platform = -1;   ///< index into Scenario::platforms
  AntennaPtr antenna;  ///< not null
  ScanSpec scan;
};

/// The box of the field. altitude: x and y centred on the origin, z upwards from the origin's height above
/// mean sea level. enu: the same, with z upwards from the tangent point.
struct Region {
  FrameOrigin origin;
  Vec3d size_m;
  Dims dims;
};

/// A named frequency interval, for combination by band.
struct Band {
  std::string name;
  double begin_hz = 0;
  double end_hz = 0;
};

enum class CombineMode { sum, max, per_emitter, per_band };
constexpr auto namesOf(CombineMode) {
  return std::array{"sum", "max", "per_emitter", "per_band"};
}

/// Direction of a radar's beam for the probability of detection and the signal-to-noise ratio.
enum class RadarAim {
  scan,   ///< the direction of the radar's scan at the time
  target  ///< towards each voxel, as closely as the scan permits
};
constexpr auto namesOf(RadarAim) {
  return std::array{"scan", "target"};
}

struct OutputSpec {
  std::vector<std::string> quantities{"power_density_dbwm2"};  ///< names of the quantity table
  CombineMode combine = CombineMode::sum;
  RadarAim radar_look = RadarAim::scan;
  double floor = -120;                 ///< lowest stored value, in each quantity's unit
  double count_threshold_dbwm2 = -90;  ///< emitter_count, occupancy: emitters above this power density
  IntervalSpec interval = {};
  int receiver = 0;  ///< for the quantities of a receiver: index into Scenario::receivers
  int wanted_emitter =
      -1;  ///< emitter whose signal sinr_db is computed for: index into Scenario::emitters; -1: none
  double detection_threshold =
      0.5;  ///< detection_age_s: minimum probability of a look that counts as a detection
  ExposureGroup exposure_group = ExposureGroup::general_public;  ///< exposure_ratio: whose reference levels
};

struct ScenarioSource;  // scenario/file/source.h

/// Plain values; copies are independent. Several threads may read a scenario; set() is a write.
struct Scenario {
  std::string name;
  std::string file;  ///< from which it was read
  /// FNV-1a (64 bits, hex) of the text of the file with its edits and of the hashes of the track and antenna
  /// files that it names; elevation files enter only with name and size.
  std::string hash;
  Clock clock;
  Region region;
  std::optional<TerrainSpec> terrain;
  propagation::Atmosphere atmosphere;
  propagation::Ground ground;
  std::vector<Platform> platforms;
  std::vector<Emitter> emitters;
  std::vector<ReceiverProfile> receivers;  ///< without a platform; see OutputSpec::receiver
  std::vector<PlacedReceiver> placed_receivers;
  std::vector<Target> targets;
  std::vector<Band> bands;
  OutputSpec output;

  /// Changes a value: edits the text of the scenario's file in memory and parses it again, with the checks of
  /// a file. The files that it names are not read again. Antennas that the edit does not change stay the same
  /// objects. Direct changes of members are lost.
  /// @throws Error (bad_input) that lists all faults as loadScenario() does, with the edit as the location of
  /// its faults; or if the scenario was not read from a file. The scenario is then unchanged.
  void set(const std::string& path, const std::string& value);
  /// Applies several edits in order and checks the result: for values that depend on each other.
  void set(const std::vector<Edit>& edits);
  /// The edits since the file was read, in an order in which they can be repeated. Of several edits of one
  /// path only the last is listed.
  std::vector<Edit> edits() const;

  std::shared_ptr<const ScenarioSource> source;  ///< null if it was not read from a file
};

/// The area for which terrain is needed: the region, every platform's track and the ground between them, with
/// a margin of 2 km. A box that contains a pole spans all longitudes.
GeoBox terrainBox(const Scenario& scenario);

/// The middle of the region and the begin of each platform's track, for hints on missing terrain.
std::vector<NeededPlace> neededPlaces(const Scenario& scenario);

/// The terrain that a scenario names, within terrainBox(); null if it names none.
/// @throws Error (bad_input) naming the file
TerrainPtr loadTerrain(const Scenario& scenario);
/// True if the terrain has a map of what stands on it: land cover or a surface model.
bool hasClutterMap(const Scenario& scenario);

/// True if results may be without values where terrain is missing, as the scenario says.
/// @param otherwise  if it says nothing
bool mayLackTerrain(const Scenario& scenario, bool otherwise);

}  // namespace emscape::scenario
