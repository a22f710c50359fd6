/// A recorded battlefield in one form for all formats: objects, their positions over time, their emissions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/enum_names.h"
#include "emscape/base/side.h"

namespace emscape::interop {

using emscape::toString;

/// A value that the recording does not have.
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// scenery: reference points, effects and other objects that carry no emitter.
enum class Domain { other, land, air, sea, subsurface, space, weapon, scenery };
constexpr auto namesOf(Domain) {
  return std::array{"other", "land", "air", "sea", "subsurface", "space", "weapon", "scenery"};
}

/// Position and attitude at one time.
struct PoseSample {
  double t_s = 0;  ///< since Recording::epoch_ms
  double latitude_deg = 0;
  double longitude_deg = 0;  ///< -180..180
  double height_msl_m = 0;
  double heading_deg = kUnknown;  ///< clockwise from true north; kUnknown: along the track
  double pitch_deg = kUnknown;    ///< nose up
  double roll_deg = kUnknown;     ///< right wing down
};

/// From t_s on the object is present: it exists, is seen and works.
struct PresenceSample {
  double t_s = 0;
  bool is_present = true;
};

/// Properties by which an emitter database recognises an object; empty where the format has none.
struct ObjectKeys {
  std::optional<std::array<int, 7>> dis_entity_type;  ///< kind, domain, country, category, ..., extra
  std::string acmi_name;
  std::string acmi_type;  ///< tags separated by +
  std::string cot_type;   ///< "a-f-G-E-S"
};

struct RecordedObject {
  std::string id;    ///< as in the recording
  std::string name;  ///< for people; objects may have the same
  std::string type;  ///< for people
  Domain domain = Domain::other;
  Side side = Side::unknown;
  ObjectKeys keys;
  std::vector<PoseSample> poses;         ///< t_s strictly increasing
  std::vector<PresenceSample> presence;  ///< in the order of time; before the first: present
};

enum class BeamKind { unknown, radar, jammer, transmitter };
constexpr auto namesOf(BeamKind) {
  return std::array{"unknown", "radar", "jammer", "transmitter"};
}

constexpr std::size_t kNoTarget = std::numeric_limits<std::size_t>::max();

/// State of a beam from t_s on. Angles are relative to the object's axes.
struct BeamState {
  double t_s = 0;
  bool is_on = false;
  double frequency_hz = kUnknown;
  double bandwidth_hz = kUnknown;
  double erp_dbm = kUnknown;    ///< power of the transmitter with antenna gain and losses
  double power_dbm = kUnknown;  ///< at the transmitter's output, where that is told instead
  double prf_hz = kUnknown;
  double pulse_width_s = kUnknown;
  double azimuth_deg = kUnknown;             ///< of the beam or of the middle of its sweep, clockwise
  double elevation_deg = kUnknown;           ///< of the same, upwards
  double azimuth_half_sweep_deg = kUnknown;  ///< half the sector; 180: all around
  double elevation_half_sweep_deg = kUnknown;
  double beamwidth_az_deg = kUnknown;  ///< as the recording has it: of the beam, or of the searched sector
  double beamwidth_el_deg = kUnknown;
  /// Object on which the beam is held: index into Recording::objects; kNoTarget: none.
  std::size_t target = kNoTarget;
};

/// True if nothing but the time differs; two unknown values are equal.
bool sameState(const BeamState& a, const BeamState& b);

/// Properties by which an emitter database recognises a beam; empty where the format has none.
struct BeamKeys {
  std::optional<int> dis_name;           ///< emitter name, SISO-REF-010, UID 75
  std::optional<int> dis_function;       ///< function of the system, UID 76
  std::optional<int> dis_beam_function;  ///< function of the beam, UID 78
  std::optional<int> dis_index;          ///< beam parameter index
  std::optional<int> dis_radio;          ///< number of the radio, of a transmitter
  std::string acmi_name{};               ///< of an object of type Beam; comes before that of its carrier
  std::string acmi_type{};               ///< of the same; a row may name that of the carrier, too
  std::string asi_beam{};                ///< description of a beam of SIMDIS
};

struct RecordedBeam {
  std::size_t object = 0;  ///< index into Recording::objects
  std::string name;        ///< for people: "emitter 28665, beam 1"
  BeamKind kind = BeamKind::unknown;
  BeamKeys keys;
  double height_m = 0;            ///< of the antenna above the object's reference point
  std::vector<BeamState> states;  ///< in the order of time; before the first: off
};

/// What was read and what was not.
struct ReadingTally {
  long long records = 0;                     ///< lines or PDUs
  long long bad = 0;                         ///< could not be read
  std::string first_bad;                     ///< location and reason of the first of them
  std::string torn;                          ///< where and how the file ends too early; empty: it does not
  std::map<std::string, long long> ignored;  ///< records and properties without use, by kind
  std::vector<std::string> notes;            ///< assumptions, each with its effect
};

struct Recording {
  std::string file;
  std::string format;                    ///< "ACMI 2.2"
  std::optional<std::int64_t> epoch_ms;  ///< t = 0, since 1970-01-01T00:00:00Z
  double origin_s = 0;                   ///< without an epoch: t = 0 in the times of the file
  bool has_times_of_day = false;         ///< those times are UTC since the begin of a day that is not told
  std::vector<RecordedObject> objects;
  std::vector<RecordedBeam> beams;
  ReadingTally tally;
};

/// First and last time of any pose, beam or presence; {0, 0} without any.
struct TimeSpan {
  double begin_s = 0;
  double end_s = 0;
};
TimeSpan spanOf(const Recording& recording);

/// Name of a part after that of its carrier; the longer one if it has the other at its begin or end.
std::string joinedName(const std::string& carrier, const std::string& part);

/// Position of an object at a time, linear between its samples (angles over the shorter arc), at the nearest
/// end outside them. @pre the object has a pose
PoseSample poseAt(const RecordedObject& object, double t_s);

}  // namespace emscape::interop
