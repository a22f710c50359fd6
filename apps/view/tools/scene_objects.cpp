#include "apps/view/tools/scene_objects.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text/quantity_text.h"
#include "emscape/base/error.h"
#include "emscape/scenario/model/edit.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::view {
namespace {

/// Collects the objects of an instant.
class Collector {
 public:
  Collector(const playback::LivePicture& picture, scenario::Snapshot snapshot)
      : terrain_(picture.terrain.get()), frame_(picture.grid().frame), snapshot_(std::move(snapshot)) {}

  std::vector<SceneObject> operator()() {
    const scenario::Scenario& scenario = *snapshot_.scenario;
    for (const scenario::Emitter& emitter : scenario.emitters) {
      SceneObject& object = add("emitters.", emitter.name, toString(emitter.kind), emitter.platform);
      object.details = quantityText(emitter.frequency_hz, "Hz") + ", " + quantityText(emitter.power_w, "W") +
                       (object.details.empty() ? "" : ", " + object.details);
    }
    for (const scenario::PlacedReceiver& receiver : scenario.placed_receivers)
      add("receivers.", receiver.name, "receiver", receiver.platform);
    for (const scenario::Target& target : scenario.targets)
      add("targets.", target.name, "target", target.platform);
    for (std::size_t p = 0; p < scenario.platforms.size(); ++p)
      add("platforms.", scenario.platforms[p].name, "platform", static_cast<int>(p));
    return std::move(objects_);
  }

 private:
  SceneObject& add(const char* list, const std::string& name, const char* kind, int platform) {
    const scenario::PlatformState& state = snapshot_.platforms[static_cast<std::size_t>(platform)];
    SceneObject& object = objects_.emplace_back();
    object.path = list + scenario::pathStep(name);
    object.name = name;
    object.kind = kind;
    object.platform = platform;
    object.present = state.present;
    if (!state.present)
      object.details = snapshot_.scenario->platforms[static_cast<std::size_t>(platform)].moves()
                           ? "absent at this time"
                           : "silent: this is the last place known";
    object.position = state.position;
    object.position_m = frame_.toLocal(state.position);
    object.height_msl_m = state.height_msl_m;
    const double ground_m =
        terrain_ != nullptr ? terrain_->heightMsl_m(state.position.latitude_deg, state.position.longitude_deg)
                            : NAN;
    if (!std::isnan(ground_m)) object.height_agl_m = state.height_msl_m - ground_m;
    return object;
  }

  const scenario::Terrain* terrain_;
  const GeoFrame frame_;
  const scenario::Snapshot snapshot_;
  std::vector<SceneObject> objects_;
};

template <class Item>
bool hasName(const std::vector<Item>& items, const std::string& step) {
  return std::any_of(items.begin(), items.end(),
                     [&](const Item& item) { return scenario::pathStep(item.name) == step; });
}

}  // namespace

std::vector<SceneObject> sceneObjectsOf(const playback::LivePicture& picture) {
  if (!picture.scenario || !picture.grid().georeferenced) return {};
  try {
    return Collector(picture,
                     scenario::snapshotAt(picture.scenario, picture.terrain.get(), picture.info().time_s))();
  } catch (const Error&) {  // such as missing terrain below a platform
    return {};
  }
}

void findPixels(std::vector<SceneObject>& objects, const playback::LivePicture& picture) {
  if (objects.empty()) return;  // volumes without a scenario
  const std::vector<std::optional<render::MarkerPlace>> places =
      render::markerPlaces(picture.size, picture.camera, picture.box, picture.annotations);
  // The markers: emitters, then platforms without one, each in the scenario's order.
  const scenario::Scenario& scenario = *picture.scenario;
  const std::size_t emitters = scenario.emitters.size();
  std::vector<std::optional<std::size_t>> markers(scenario.platforms.size());
  std::vector<bool> has_emitter(scenario.platforms.size());
  for (const scenario::Emitter& emitter : scenario.emitters)
    has_emitter[static_cast<std::size_t>(emitter.platform)] = true;
  for (std::size_t p = 0, next = emitters; p < markers.size(); ++p)
    if (!has_emitter[p]) markers[p] = next++;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    SceneObject& object = objects[i];
    const std::optional<std::size_t> marker =
        i < emitters ? i : markers[static_cast<std::size_t>(object.platform)];
    object.pixel = marker && *marker < places.size() ? places[*marker] : std::nullopt;
  }
}

const SceneObject* objectAt(const std::vector<SceneObject>& objects, double x, double y) {
  constexpr double kReach_px = 14;
  constexpr double kCloser_px = 0.5;  // positions of one platform differ by rounding
  const SceneObject* nearest = nullptr;
  double nearest_px = kReach_px;
  for (const SceneObject& object : objects) {
    if (!object.pixel) continue;
    const double away_px = std::hypot(object.pixel->x - x, object.pixel->y - y);
    if (away_px > nearest_px - (nearest != nullptr ? kCloser_px : 0)) continue;
    nearest = &object;
    nearest_px = away_px;
  }
  return nearest;
}

bool hasItem(const scenario::Scenario& scenario, const std::string& path) {
  const std::size_t point = path.find('.');
  if (point == std::string::npos) return false;
  const std::string list = path.substr(0, point), step = path.substr(point + 1);
  if (list == "emitters") return hasName(scenario.emitters, step);
  if (list == "platforms") return hasName(scenario.platforms, step);
  if (list == "targets") return hasName(scenario.targets, step);
  return list == "receivers" &&
         (hasName(scenario.placed_receivers, step) || hasName(scenario.receivers, step));
}

}  // namespace emscape::view
