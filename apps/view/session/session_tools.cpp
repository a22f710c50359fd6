/// Verbs whose arguments are points that are clicked: measuring, drawing a track, placing a new item.
#include <fmt/format.h>

#include <cmath>

#include "apps/view/session/session.h"
#include "emscape/base/error.h"
#include "emscape/base/geodesy/geoid.h"

namespace emscape::view {
namespace {

constexpr double kEyeHeight_m = 2;  // above ground, of clicked points
constexpr double kUsualFrequency_hz = 1e9;

/// @throws Error (bad_input) without a picture that has a position on the earth
const playback::LivePicture& requirePlace(const playback::LivePicture* picture, const std::string& verb) {
  if (picture != nullptr && picture->grid().georeferenced) return *picture;
  throw Error(ErrorCode::bad_input, verb + ": the picture has no position on the earth");
}

/// A point above the ground. @throws Error (bad_input) where the ground is not known
ToolPoint pointAt(double latitude_deg, double longitude_deg, double height_agl_m,
                  const playback::LivePicture& picture) {
  const double ground_m = picture.terrain ? picture.terrain->heightMsl_m(latitude_deg, longitude_deg) : 0;
  if (std::isnan(ground_m)) {
    throw Error(ErrorCode::bad_input,
                fmt::format("the ground at {:g}, {:g} is not known", latitude_deg, longitude_deg));
  }
  ToolPoint point;
  point.end.height_msl_m = ground_m + height_agl_m;
  point.end.position = {latitude_deg, longitude_deg,
                        point.end.height_msl_m + geoidUndulation_m(latitude_deg, longitude_deg)};
  point.position_m = GeoFrame(picture.grid().frame).toLocal(point.end.position);
  return point;
}

}  // namespace

/// The point that a command names by a pixel: an object there, or the ground.
/// @throws Error (bad_input) if there is neither
ToolPoint Session::pointOf(const Command& command) const {
  const playback::LivePicture& picture = requirePlace(picture_.get(), command.verb);
  const double x = command.number("x"), y = command.number("y");
  if (const SceneObject* object = objectAt(objects(), x, y))
    return {object->position_m, {object->position, object->height_msl_m}};
  const std::optional<Vec3d> ground_m = groundAt(x, y);
  if (!ground_m) throw Error(ErrorCode::bad_input, command.verb + ": there is no ground");
  const GeodeticPosition position = GeoFrame(picture.grid().frame).toGeodetic(*ground_m);
  return pointAt(position.latitude_deg, position.longitude_deg, kEyeHeight_m, picture);
}

/// The frequency of the Fresnel zone of a measurement: of the selected emitter, else of the first one.
double Session::measuringFrequency_hz() const {
  if (!scenario() || scenario()->emitters.empty()) return kUsualFrequency_hz;
  for (const scenario::Emitter& emitter : scenario()->emitters) {
    if (selected() == "emitters." + scenario::pathStep(emitter.name)) return emitter.frequency_hz;
  }
  return scenario()->emitters.front().frequency_hz;
}

void Session::addMeasured(const ToolPoint& point) {
  if (tool_.points.size() >= 2) {
    tool_.points.clear();
    tool_.measurement.reset();
  }
  tool_.points.push_back(point);
  if (tool_.points.size() < 2) return;
  const propagation::Atmosphere atmosphere =
      picture_->scenario ? picture_->scenario->atmosphere : propagation::Atmosphere{};
  tool_.measurement = view::measure(tool_.points[0].end, tool_.points[1].end, atmosphere,
                                    measuringFrequency_hz(), picture_->terrain.get());
  const Measurement& result = *tool_.measurement;
  log_.write("measured", {{"distance_m", result.distance_m},
                          {"slant_m", result.slant_m},
                          {"bearing_deg", result.bearing_deg},
                          {"in_sight", !result.is_blocked},
                          {"verdict", verdictOf(result, view_.units)}});
}

void Session::measure(const Command& command) {
  const playback::LivePicture& picture = requirePlace(picture_.get(), "measure");
  const auto isGiven = [&](const std::string& end) {
    return command.has((end + "_latitude_deg").c_str()) && command.has((end + "_longitude_deg").c_str());
  };
  if (command.arguments.empty()) {
    tool_ =
        tool_.kind == PickTool::Kind::measure ? PickTool{} : PickTool{PickTool::Kind::measure, "", {}, {}};
    return;
  }
  const bool is_pixel = command.has("x") && command.has("y");
  if (is_pixel == (isGiven("from") && isGiven("to")))
    throw Error(ErrorCode::bad_input, "measure: expected x and y, or the positions of both ends");
  if (tool_.kind != PickTool::Kind::measure) tool_ = {PickTool::Kind::measure, "", {}, {}};
  if (is_pixel) return addMeasured(pointOf(command));
  tool_.points.clear();
  for (const std::string end : {"from", "to"}) {
    addMeasured(pointAt(command.number((end + "_latitude_deg").c_str()),
                        command.number((end + "_longitude_deg").c_str()),
                        command.number((end + "_height_agl_m").c_str(), kEyeHeight_m), picture));
  }
}

void Session::drawTrack(const Command& command) {
  if (command.has("platform")) {
    select("platforms." + scenario::pathStep(command.text("platform")));  // throws if there is none
    requireMovable(command.text("platform"));
    tool_ = {PickTool::Kind::track, command.text("platform"), {}, {}};
    return;
  }
  if (tool_.kind != PickTool::Kind::track)
    throw Error(ErrorCode::bad_input, "draw_track: expected platform first");
  if (command.has("x") && command.has("y")) {
    tool_.points.push_back(pointOf(command));
    return;
  }
  if (tool_.points.size() < 2)
    throw Error(ErrorCode::bad_input, "a track has at least two points; click them in the picture");
  Json points = Json::array();
  for (const ToolPoint& point : tool_.points) {
    points.push_back(
        fmt::format("{:.7f},{:.7f}", point.end.position.latitude_deg, point.end.position.longitude_deg));
  }
  if (perform({"track", {{"platform", tool_.subject}, {"points", points}}})) tool_ = {};
}

void Session::placeItem(const Command& command) {
  if (command.has("what")) {
    if (!scenario()) throw Error(ErrorCode::bad_input, "there is no scenario to change");
    tool_ = {PickTool::Kind::place, command.text("what"), {}, {}};
    return;
  }
  if (tool_.kind != PickTool::Kind::place || !command.has("x") || !command.has("y"))
    throw Error(ErrorCode::bad_input, "place: expected what first, then x and y");
  const GeodeticPosition position = pointOf(command).end.position;
  const bool is_added = perform({"add",
                                 {{"what", tool_.subject},
                                  {"latitude_deg", position.latitude_deg},
                                  {"longitude_deg", position.longitude_deg}}});
  if (is_added) tool_ = {};
}

std::vector<Verb> Session::toolVerbs() {
  constexpr NumberLimits kLatitude{-90, 90}, kLongitude{-180, 180}, kHeight_m{0, 1e5};
  return {
      {"measure",
       {{"x", kNumber, false},
        {"y", kNumber, false},
        {"from_latitude_deg", kNumber, false, kLatitude},
        {"from_longitude_deg", kNumber, false, kLongitude},
        {"from_height_agl_m", kNumber, false, kHeight_m},
        {"to_latitude_deg", kNumber, false, kLatitude},
        {"to_longitude_deg", kNumber, false, kLongitude},
        {"to_height_agl_m", kNumber, false, kHeight_m}},
       "Measures distance, bearing and line of sight between two positions, by default 2 m above the ground; "
       "or adds the point under a pixel of the picture; without arguments: clicks measure, or no longer do",
       [](Session& session, const Command& command) { session.measure(command); }},
      {"draw_track",
       {{"platform", kText, false}, {"x", kNumber, false}, {"y", kNumber, false}},
       "Clicks draw the track of a platform; with `x` and `y` adds the ground under a pixel of the picture; "
       "without arguments ends: the platform moves along the points",
       [](Session& session, const Command& command) { session.drawTrack(command); }},
      {"place",
       {{"what", kText, false, {}, {"radar", "transmitter", "jammer", "platform", "receiver", "target"}},
        {"x", kNumber, false},
        {"y", kNumber, false}},
       "The next click adds a radar, transmitter, jammer, platform, receiver or target there; with `x` and "
       "`y` adds it under a "
       "pixel of the picture",
       [](Session& session, const Command& command) { session.placeItem(command); }},
  };
}

}  // namespace emscape::view
