#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/files/json_writing.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"
#include "interop/exporting/writers.h"
#include "recording/beams/directions.h"
#include "recording/common/dates.h"

namespace emscape::interop {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// Largest distance (m) of the lines between written positions from the track.
constexpr double kTolerance_m = 0.98;
/// In turns, written positions are so far (m) outside of the track: lines between them are then as far inside
/// as outside of it, and longer by the root of two.
constexpr double kOutside_m = 0.8;
constexpr double kStraight_m = 1e-3;  ///< off the line between the positions before and after
constexpr std::size_t kMaxSkipped = 2000;
constexpr int kMaxShapes = 200;  ///< of a beam over time
constexpr int kArcParts = 12;

/// Steps in which a position is written: of a degree, and of a metre.
struct Steps {
  double angle = 1e6, height = 10;
};
constexpr Steps kFine{}, kCoarse{1e5, 1};

struct TimedPlace {
  double t_s = 0;
  GeodeticPosition position;
  Vec3d ecef;
  Steps steps{};
};

TimedPlace timedPlace(const PoseSample& pose) {
  TimedPlace place;
  place.t_s = pose.t_s;
  place.position = {pose.latitude_deg, pose.longitude_deg,
                    pose.height_msl_m + geoidUndulation_m(pose.latitude_deg, pose.longitude_deg)};
  place.ecef = toEcef(place.position);
  return place;
}

/// A place as it is written: outside of the turn that the track makes there.
TimedPlace outsideOfTurn(const std::vector<TimedPlace>& places, std::size_t i) {
  if (i == 0 || i + 1 == places.size()) return places[i];
  const TimedPlace &before = places[i - 1], &here = places[i], &after = places[i + 1];
  const double part = (here.t_s - before.t_s) / (after.t_s - before.t_s);
  const Vec3d outwards = here.ecef - (before.ecef + (after.ecef - before.ecef) * part);
  if (length(outwards) < kStraight_m) return here;
  TimedPlace place = here;
  place.ecef = here.ecef + outwards * (kOutside_m / length(outwards));
  place.position = fromEcef(place.ecef);
  return place;
}

/// A place as it is read again.
TimedPlace roundedPlace(TimedPlace place, const Steps& steps) {
  const auto near = [](double value, double per_unit) { return std::round(value * per_unit) / per_unit; };
  place.position = {std::clamp(near(place.position.latitude_deg, steps.angle), -90.0, 90.0),
                    near(place.position.longitude_deg, steps.angle),
                    near(place.position.height_ellipsoid_m, steps.height)};
  place.ecef = toEcef(place.position);
  place.steps = steps;
  return place;
}

/// The places that straight lines in time and space need to be within the tolerance, each with as few digits
/// as that allows.
class PlaceReducer {
 public:
  explicit PlaceReducer(const std::vector<TimedPlace>& places) : places_(places) {}

  std::vector<TimedPlace> run() {
    kept_ = {roundedPlace(places_.front(), kFine)};
    TimedPlace last = kept_.front();
    for (std::size_t end = 1; end < places_.size(); ++end) {
      const TimedPlace to = roundedPlace(outsideOfTurn(places_, end), kFine);
      if (end - begin_ > 1 && (end - begin_ > kMaxSkipped || !isWithin(to, end))) keep(last, end - 1);
      last = to;
    }
    if (places_.size() > 1) keep(last, places_.size() - 1);
    return std::move(kept_);
  }

 private:
  /// True if the line from the last kept place is near all places up to `end`.
  bool isWithin(const TimedPlace& to, std::size_t end) const {
    const TimedPlace& from = kept_.back();
    for (std::size_t i = begin_ + 1; i <= end; ++i) {
      const double part = (places_[i].t_s - from.t_s) / (to.t_s - from.t_s);
      if (length(from.ecef + (to.ecef - from.ecef) * part - places_[i].ecef) > kTolerance_m) return false;
    }
    return true;
  }

  void keep(const TimedPlace& place, std::size_t index) {
    const TimedPlace coarse = roundedPlace(places_[index], kCoarse);
    kept_.push_back(isWithin(coarse, index) ? coarse : place);
    begin_ = index;
  }

  const std::vector<TimedPlace>& places_;
  std::vector<TimedPlace> kept_;
  std::size_t begin_ = 0;  ///< index of the last kept one
};

/// A number in short form: whole ones without a decimal.
void addNumber(OrderedJson& list, double value, double steps) {
  const double rounded = std::round(value * steps) / steps;
  if (rounded == std::floor(rounded)) {
    list.push_back(std::llround(rounded));
  } else {
    list.push_back(rounded);
  }
}

/// Longitude, latitude and height above the ellipsoid.
void addTo(OrderedJson& list, const GeodeticPosition& at, const Steps& steps = kFine) {
  addNumber(list, at.longitude_deg, steps.angle);
  addNumber(list, at.latitude_deg, steps.angle);
  addNumber(list, at.height_ellipsoid_m, steps.height);
}

OrderedJson rgba(scenario::EmitterKind kind, int alpha) {
  if (kind == scenario::EmitterKind::jammer) return {255, 70, 50, alpha};
  if (kind == scenario::EmitterKind::radar) return {255, 210, 0, alpha};
  return {60, 200, 255, alpha};
}

class CzmlWriter {
 public:
  CzmlWriter(const ExportJob& job, const TextSink& sink)
      : job_(job), scenario_(job.scenario), sink_(sink), epoch_s_(epochOf_s(job.scenario)) {}

  long long run(std::vector<ExportedRow>& rows) {
    const std::string all = interval(0, std::max(scenario_.clock.duration_s, 1.0));
    sink_("[\n" +
          dumpJson(OrderedJson{{"id", "document"},
                               {"name", scenario_.name},
                               {"version", "1.0"},
                               {"clock", {{"interval", all}, {"currentTime", time(0)}, {"multiplier", 1}}}}));
    for (std::size_t i = 0; i < scenario_.platforms.size(); ++i) {
      if (job_.progress)
        job_.progress("writing CZML",
                      static_cast<double>(i) / static_cast<double>(scenario_.platforms.size()));
      writePlatform(i);
    }
    for (std::size_t i = 0; i < scenario_.emitters.size(); ++i) writeBeam(i);
    sink_(job_.czml_packets + "\n]\n");
    addRowsOfPlatforms(scenario_, rows);
    return records_;
  }

 private:
  std::string time(double t_s) const { return utcTextOf(epoch_s_ + t_s); }
  std::string interval(double begin_s, double end_s) const { return time(begin_s) + "/" + time(end_s); }
  void packet(const OrderedJson& json) { sink_(",\n" + dumpJson(json)); }

  void writePlatform(std::size_t index) {
    const scenario::Platform& platform = scenario_.platforms[index];
    std::vector<TimedPlace> places;
    if (platform.moves()) {
      for (const double t_s : timesOfPositions(scenario_, platform, job_.step_s))
        places.push_back(timedPlace(poseOf(platform, job_.terrain, t_s)));
    } else {
      places.push_back(timedPlace(poseOf(platform, job_.terrain, 0)));
    }
    if (places.empty()) return;  // never present
    OrderedJson samples = OrderedJson::array();
    const std::vector<TimedPlace> kept = PlaceReducer(places).run();
    for (const TimedPlace& place : kept) {
      if (platform.moves()) addNumber(samples, place.t_s, 1000);
      addTo(samples, place.position, place.steps);
      ++records_;
    }
    OrderedJson position{{"cartographicDegrees", samples}};
    const bool holds = platform.outside_track == scenario::OutsideTrack::hold;
    if (platform.moves()) {
      const char* const outside = holds ? "HOLD" : "NONE";
      position = {{"epoch", time(0)},
                  {"cartographicDegrees", samples},
                  {"interpolationAlgorithm", "LINEAR"},
                  {"forwardExtrapolationType", outside},
                  {"backwardExtrapolationType", outside}};
    }
    OrderedJson json{{"id", fmt::format("platform/{}", index + 1)}, {"name", platform.name}};
    if (platform.moves() && !holds) json["availability"] = interval(kept.front().t_s, kept.back().t_s);
    json["position"] = position;
    json["point"] = {{"pixelSize", 8}, {"color", {{"rgba", sideColor(platform)}}}};
    json["label"] = {{"text", platform.name},
                     {"font", "12pt sans-serif"},
                     {"horizontalOrigin", "LEFT"},
                     {"pixelOffset", {{"cartesian2", {10, 0}}}}};
    if (platform.moves()) {
      json["path"] = {{"width", 2},
                      {"material", {{"solidColor", {{"color", {{"rgba", sideColor(platform)}}}}}}}};
    }
    packet(json);
  }

  static OrderedJson sideColor(const scenario::Platform& platform) {
    switch (platform.side.value_or(scenario::Side::unknown)) {
      case scenario::Side::friendly:
        return {80, 160, 255, 255};
      case scenario::Side::hostile:
        return {255, 80, 80, 255};
      case scenario::Side::neutral:
        return {90, 220, 90, 255};
      case scenario::Side::unknown:
        break;
    }
    return {255, 255, 255, 255};
  }

  /// A beam is a surface from its platform along the middle of its elevation, a sector where it sweeps: which
  /// of its directions it has at a moment is not shown.
  void writeBeam(std::size_t index) {
    const scenario::Emitter& emitter = scenario_.emitters[index];
    const scenario::Platform& platform = scenario_.platforms[static_cast<std::size_t>(emitter.platform)];
    std::vector<double> times = timesOfChanges(scenario_, emitter, job_.step_s);
    if (platform.moves()) {
      const double step_s = std::max(job_.step_s, scenario_.clock.duration_s / kMaxShapes);
      for (double t_s = step_s; t_s < scenario_.clock.duration_s; t_s += step_s) times.push_back(t_s);
      std::sort(times.begin(), times.end());
      times.erase(std::unique(times.begin(), times.end()), times.end());
    }
    const double end_s = std::max(scenario_.clock.duration_s, 1.0);
    OrderedJson positions = OrderedJson::array(), shown = OrderedJson::array();
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double until_s = i + 1 < times.size() ? times[i + 1] : end_s;
      if (until_s <= times[i]) continue;
      const BeamState state = beamStateAt(scenario_, emitter, times[i]);
      shown.push_back({{"interval", interval(times[i], until_s)}, {"boolean", state.is_on}});
      if (!state.is_on) continue;
      OrderedJson corners = OrderedJson::array();
      addCorners(corners, poseOf(platform, job_.terrain, (times[i] + until_s) / 2), state);
      positions.push_back({{"interval", interval(times[i], until_s)}, {"cartographicDegrees", corners}});
    }
    if (positions.empty()) return;  // never on
    packet({{"id", fmt::format("beam/{}", index + 1)},
            {"name", emitter.name},
            {"parent", fmt::format("platform/{}", emitter.platform + 1)},
            {"polygon",
             {{"show", shown},
              {"positions", positions},
              {"perPositionHeight", true},
              {"material", {{"solidColor", {{"color", {{"rgba", rgba(emitter.kind, 70)}}}}}}},
              {"outline", true},
              {"outlineColor", {{"rgba", rgba(emitter.kind, 255)}}}}}});
    ++records_;
  }

  void addCorners(OrderedJson& corners, const PoseSample& pose, const BeamState& state) const {
    const BeamWidths widths = widthsOf(state);
    const bool is_circle = widths.azimuth_deg >= 359;
    const dis::BodyAxes axes =
        dis::axesOf(dis::LocalAttitude{pose.heading_deg, pose.pitch_deg, pose.roll_deg}, pose.latitude_deg,
                    pose.longitude_deg);
    const TimedPlace apex = timedPlace(pose);
    if (!is_circle) addTo(corners, apex.position, kCoarse);
    const int parts = is_circle ? 3 * kArcParts : kArcParts;
    for (int i = 0; i < parts + (is_circle ? 0 : 1); ++i) {
      const double azimuth_rad =
          degToRad(state.azimuth_deg + widths.azimuth_deg * (static_cast<double>(i) / parts - 0.5));
      const double elevation_rad = degToRad(state.elevation_deg);
      const Vec3d body{std::cos(elevation_rad) * std::cos(azimuth_rad),
                       std::cos(elevation_rad) * std::sin(azimuth_rad), -std::sin(elevation_rad)};
      addTo(corners, fromEcef(apex.ecef + axes.toWorld(body) * drawnRange_m(scenario_)), kCoarse);
    }
  }

  const ExportJob& job_;
  const scenario::Scenario& scenario_;
  const TextSink& sink_;
  double epoch_s_ = 0;
  long long records_ = 0;
};

}  // namespace

long long writeCzml(const ExportJob& job, const TextSink& sink, std::vector<ExportedRow>& rows) {
  return CzmlWriter(job, sink).run(rows);
}

}  // namespace emscape::interop
