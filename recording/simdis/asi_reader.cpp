#include "recording/simdis/asi_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>

#include "base/text/unended_line.h"
#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "recording/beams/directions.h"
#include "recording/common/dates.h"
#include "recording/common/samples.h"
#include "recording/common/tally.h"
#include "recording/common/text.h"
#include "recording/common/track_recorder.h"

namespace emscape::interop {
namespace {

constexpr double kStatic = -1;  ///< a time: from the begin on

Domain domainOfPlatformType(const std::string& type) {
  static const std::map<std::string, Domain> kDomains{
      {"aircraft", Domain::air},    {"helicopter", Domain::air},     {"ship", Domain::sea},
      {"surfaceship", Domain::sea}, {"missile", Domain::weapon},     {"submarine", Domain::subsurface},
      {"landsite", Domain::land},   {"groundvehicle", Domain::land}, {"tank", Domain::land},
      {"satellite", Domain::space}, {"decoy", Domain::scenery},      {"chaff", Domain::scenery}};
  const auto found = kDomains.find(lowerCase(type));
  return found == kDomains.end() ? Domain::other : found->second;
}

Side sideOfIdentity(const std::string& identity) {
  switch (identity.empty() ? ' ' : std::toupper(static_cast<unsigned char>(identity.front()))) {
    case 'F':
      return Side::friendly;
    case 'H':
      return Side::hostile;
    case 'N':
      return Side::neutral;
    default:
      return Side::unknown;
  }
}

enum class BeamType { absolute, body, target };

/// What is told of a beam at a time; the rest is unknown.
struct BeamEvent {
  double t_s = 0;
  std::optional<bool> is_on;
  std::optional<RelativeDirection> direction;
  std::optional<std::string> target;
};

struct AsiBeam {
  BeamType type = BeamType::absolute;
  double width_deg = kUnknown, height_deg = kUnknown;
  std::vector<BeamEvent> events;
};

class AsiReader {
 public:
  explicit AsiReader(const ReadOptions& options) : recorder_("SIMDIS ASI", options) {}

  Recording read(LineReader& lines) {
    for (std::string_view line; lines.next(line);) {
      if (line.substr(0, 3) == "\xEF\xBB\xBF") line.remove_prefix(3);
      const std::vector<std::string> words = wordsOf(line, {"#", "//"});
      if (words.empty()) continue;
      location_ = fmt::format("line {}", lines.line());
      ++recorder_.tally().records;
      take(lowerCase(words[0]), words);
      if (!lines.isTerminated()) recorder_.tally().notes.push_back(unendedLineText(lines.line(), "a record"));
    }
    return finish();
  }

 private:
  using Words = std::vector<std::string>;

  void bad(const std::string& reason) { countBad(recorder_.tally(), location_, reason); }

  void take(const std::string& command, const Words& words) {
    const std::string value = words.size() > 1 ? words[1] : "", second = words.size() > 2 ? words[2] : "";
    if (command == "referenceyear") {
      const auto year = numberIn(value);
      if (!year || *year < 1900 || *year > 9999) return bad("ReferenceYear is not 1900 to 9999");
      year_ = static_cast<int>(*year);
    } else if (command == "degreeangles") {
      is_degrees_ = value == "1";
    } else if (command == "coordsystem") {
      is_ecef_ = takeSystem(value);
    } else if (command == "platformcoordsystem") {
      ecef_[value] = takeSystem(second);
    } else if (command.rfind("platform", 0) == 0) {
      takePlatform(command, value, second, words);
    } else if (command.rfind("beam", 0) == 0 || command == "horzbw" || command == "vertbw") {
      takeBeam(command, value, second, words);
    } else if (command != "version" && command != "scenarioinfo" && command != "classification" &&
               command != "reflla") {
      countIgnored(recorder_.tally(), "command " + printableText(words[0].substr(0, 40)));
    }
  }

  /// @return true for ECEF
  bool takeSystem(const std::string& told) {
    const std::string system = lowerCase(told);
    if (system == "ecef") return true;
    if (system != "lla") {
      countIgnored(recorder_.tally(),
                   "coordinate system " + printableText(told) + " (LLA and ECEF are read): taken as LLA");
    }
    return false;
  }

  void takePlatform(const std::string& command, const std::string& id, const std::string& value,
                    const Words& words) {
    if (command == "platformid") {
      recorder_.objectOf(id);
      known_[id] = true;
      return;
    }
    if (known_.count(id) == 0) return bad("platform " + printableText(id) + " has no PlatformID before it");
    RecordedObject& object = recorder_.object(recorder_.objectOf(id));
    if (command == "platformname") {
      const std::string name = printableText(value);
      if (!name.empty()) object.name = name;
    } else if (command == "platformtype") {
      object.type = printableText(value);
      object.domain = domainOfPlatformType(value);
    } else if (command == "platformicon") {
      if (object.type.empty()) object.type = printableText(value);
    } else if (command == "platformfhn") {
      object.side = sideOfIdentity(value);
    } else if (command == "platformdata") {
      takePose(id, words);
    } else {
      countIgnored(recorder_.tally(), "command " + printableText(words[0].substr(0, 40)));
    }
  }

  void takePose(const std::string& id, const Words& words) {
    const std::string time = words.size() > 2 ? words[2] : "";
    const auto told_s = timeOf(time);
    if (!told_s) return bad("'" + printableText(time) + "' is no time");
    const double t_s = *told_s;
    std::array<double, 6> values{0, 0, 0, kUnknown, kUnknown, kUnknown};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto number = i + 3 < words.size() ? numberIn(words[i + 3]) : std::nullopt;
      if (!number && (i < 3 || i + 3 < words.size()))
        return bad("PlatformData is not: id time and three or six numbers");
      if (number) values[i] = *number;
    }
    const auto own = ecef_.find(id);
    PoseSample pose;
    if (own == ecef_.end() ? is_ecef_ : own->second) {
      pose = poseOfEcef(t_s, {values[0], values[1], values[2]});
      if (!std::isnan(values[3])) {
        const dis::LocalAttitude attitude =
            dis::attitudeOf(dis::axesOf(Vec3d{degToRad(values[3]), degToRad(values[4]), degToRad(values[5])}),
                            pose.latitude_deg, pose.longitude_deg);
        pose.heading_deg = attitude.heading_deg;
        pose.pitch_deg = attitude.pitch_deg;
        pose.roll_deg = attitude.roll_deg;
      }
    } else {
      if (!(std::abs(values[0]) <= 90 && std::abs(values[1]) <= 720))
        return bad("PlatformData with a latitude or longitude that is out of range");
      pose = {t_s,       values[0], values[1], heightMsl_m(values[0], values[1], values[2]),
              values[3], values[4], values[5]};
    }
    const std::size_t object = recorder_.objectOf(id);
    if (t_s == kStatic) {
      recorder_.addFixed(object, pose, location_);
    } else {
      recorder_.add(object, pose, location_);
    }
  }

  void takeBeam(const std::string& command, const std::string& id, const std::string& value,
                const Words& words) {
    if (command == "beamid") {
      if (known_.count(id) == 0)
        return bad("the beam's host " + printableText(id) + " is not a platform before it");
      const std::size_t beam = recorder_.addBeam(recorder_.objectOf(id));
      recorder_.beam(beam).name = "beam " + printableText(value);
      recorder_.beam(beam).kind = BeamKind::radar;
      beams_[value] = beam;
      told_.resize(beam + 1);
      return;
    }
    const auto found = beams_.find(id);
    if (found == beams_.end()) return bad("beam " + printableText(id) + " has no BeamID before it");
    AsiBeam& beam = told_[found->second];
    if (command == "beamtype") {
      const std::string type = lowerCase(value);
      beam.type = type == "body" ? BeamType::body : type == "target" ? BeamType::target : BeamType::absolute;
    } else if (command == "beamdesc") {
      recorder_.beam(found->second).keys.asi_beam = printableText(value);
      if (!value.empty()) recorder_.beam(found->second).name = printableText(value);
    } else if (command == "horzbw" || command == "vertbw") {
      const auto width_deg = numberIn(value);
      if (!width_deg || *width_deg <= 0 || *width_deg > 360)
        return bad("a beamwidth is not 0 to 360 degrees");
      (command == "horzbw" ? beam.width_deg : beam.height_deg) = *width_deg;
    } else if (command == "beamonoffcmd" || command == "beamdatarae" || command == "beamtargetidcmd") {
      takeEvent(beam, command, words);
    } else {
      countIgnored(recorder_.tally(), "command " + printableText(words[0].substr(0, 40)));
    }
  }

  void takeEvent(AsiBeam& beam, const std::string& command, const Words& words) {
    const auto t_s = words.size() > 3 ? timeOf(words[2]) : std::nullopt;
    if (!t_s) return bad(printableText(words[0]) + " is not: id time value");
    BeamEvent event;
    event.t_s = *t_s;
    if (command == "beamonoffcmd") {
      event.is_on = words[3] == "1";
    } else if (command == "beamtargetidcmd") {
      event.target = words[3];
    } else {
      const auto azimuth = numberIn(words[3]),
                 elevation = words.size() > 4 ? numberIn(words[4]) : std::nullopt;
      if (!azimuth || !elevation) return bad("BeamDataRAE is not: id time azimuth elevation range");
      const double azimuth_deg = is_degrees_ ? *azimuth : radToDeg(*azimuth);
      const double elevation_deg = is_degrees_ ? *elevation : radToDeg(*elevation);
      event.direction =
          RelativeDirection{std::remainder(azimuth_deg, 360), std::clamp(elevation_deg, -90.0, 90.0)};
    }
    recorder_.countSample();
    beam.events.push_back(event);
  }

  /// Seconds of the reference year, or kStatic. Dates are ISO 8601, "DDD YYYY HH:MM:SS" (day of the year) or
  /// "Mon DD YYYY HH:MM:SS".
  std::optional<double> timeOf(const std::string& text) {
    if (const auto number = numberIn(text)) return *number < 0 ? kStatic : *number;
    std::optional<double> utc_s = utcSeconds(text);
    const Words words = wordsOf(text);
    if (!utc_s && words.size() == 3) {
      const auto day = numberIn(words[0]), year = numberIn(words[1]);
      const auto clock_s = utcSeconds("1970-01-01T" + words[2]);
      const bool is_sound =
          day && year && clock_s && *day >= 1 && *day <= 366 && *year >= 1900 && *year <= 9999;
      if (is_sound) utc_s = secondsOfDate(static_cast<int>(*year), 1, 1) + (*day - 1) * 86400 + *clock_s;
    }
    if (!utc_s) return std::nullopt;
    if (!year_) {  // that of the first date
      const std::string date = utcTextOf(*utc_s);
      year_ = static_cast<int>(numberIn(std::string_view(date).substr(0, 4)).value_or(1970));
    }
    return *utc_s - secondsOfDate(*year_, 1, 1);
  }

  /// The states of a beam. Commands of one kind may stand together, so that times go back.
  std::vector<BeamState> statesOf(AsiBeam& beam, double begin_s,
                                  const std::unordered_map<std::string, std::size_t>& objects) {
    for (BeamEvent& event : beam.events) {
      if (event.t_s == kStatic) event.t_s = begin_s;
    }
    std::stable_sort(beam.events.begin(), beam.events.end(),
                     [](const BeamEvent& a, const BeamEvent& b) { return a.t_s < b.t_s; });
    BeamState state;
    // A beam that is never switched is on from its first direction or target on.
    state.is_on = std::none_of(beam.events.begin(), beam.events.end(),
                               [](const BeamEvent& event) { return event.is_on.has_value(); });
    state.beamwidth_az_deg = beam.width_deg;
    state.beamwidth_el_deg = beam.height_deg;
    std::vector<BeamState> states;
    for (const BeamEvent& event : beam.events) {
      state.t_s = event.t_s;
      if (event.is_on) state.is_on = *event.is_on;
      if (event.direction && beam.type != BeamType::target) {
        state.azimuth_deg = event.direction->azimuth_deg;
        state.elevation_deg = event.direction->elevation_deg;
      }
      if (event.target && beam.type == BeamType::target) {
        const auto target = objects.find(*event.target);
        state.target = target == objects.end() ? kNoTarget : target->second;
      }
      addState(states, state);
    }
    return states;
  }

  Recording finish() {
    std::unordered_map<std::string, std::size_t> objects;
    for (const auto& [id, is_known] : known_) objects[id] = recorder_.objectOf(id);
    double begin_s = std::numeric_limits<double>::infinity();
    for (const auto& [id, index] : objects) {
      for (const PoseSample& pose : recorder_.object(index).poses) begin_s = std::min(begin_s, pose.t_s);
    }
    for (const AsiBeam& beam : told_) {
      for (const BeamEvent& event : beam.events) {
        if (event.t_s != kStatic) begin_s = std::min(begin_s, event.t_s);
      }
    }
    if (!std::isfinite(begin_s)) begin_s = 0;
    for (std::size_t i = 0; i < told_.size(); ++i)
      recorder_.beam(i).states = statesOf(told_[i], begin_s, objects);
    if (year_) recorder_.hasUtc(secondsOfDate(*year_, 1, 1));
    Recording recording = recorder_.finish();
    std::vector<bool> is_from_north;
    for (const AsiBeam& beam : told_) is_from_north.push_back(beam.type == BeamType::absolute);
    turnIntoCarriers(recording, is_from_north);
    return recording;
  }

  TrackRecorder recorder_;
  std::string location_;
  std::unordered_map<std::string, bool> known_, ecef_;  ///< platforms by id
  std::unordered_map<std::string, std::size_t> beams_;  ///< by id
  std::vector<AsiBeam> told_;                           ///< of the recorder's beams
  std::optional<int> year_;
  bool is_degrees_ = false, is_ecef_ = false;
};

}  // namespace

bool isAsi(std::string_view head) {
  for (std::size_t begin = 0; begin < head.size();) {
    const std::size_t end = std::min(head.find('\n', begin), head.size());
    const std::vector<std::string> words = wordsOf(head.substr(begin, end - begin), {"#", "//"});
    if (!words.empty()) {
      const std::string command = lowerCase(words[0]);
      for (const char* known : {"referenceyear", "degreeangles", "platformid", "reflla", "scenarioinfo"}) {
        if (command == known) return true;
      }
    }
    begin = end + 1;
  }
  return false;
}

Recording readAsi(ByteSource& source, const ReadOptions& options) {
  LineReader lines(source);
  return AsiReader(options).read(lines);
}

}  // namespace emscape::interop
