#include "emscape/playback/frames/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/quantity_text.h"
#include "emfield/channels/categories.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "playback/frames/ground.h"
#include "volume/labels.h"

namespace emscape::playback {
namespace {

/// Height of a mast above the ground if that is given, else above mean sea level.
void setHeight(render::Marker& marker, const scenario::Platform& platform, double height_msl_m) {
  const std::optional<double>& above_ground_m = platform.track.front().position.height_agl_m;
  marker.is_height_above_ground = above_ground_m && !platform.moves();
  marker.height_m = marker.is_height_above_ground ? *above_ground_m : height_msl_m;
}

}  // namespace

render::MarkerKind markerKindOf(scenario::EmitterKind kind) {
  switch (kind) {
    case scenario::EmitterKind::radar:
      return render::MarkerKind::radar;
    case scenario::EmitterKind::jammer:
      return render::MarkerKind::jammer;
    case scenario::EmitterKind::transmitter:
      break;
  }
  return render::MarkerKind::transmitter;
}

render::Affiliation affiliationOf(const std::optional<scenario::Side>& side) {
  if (!side) return render::Affiliation::none;
  switch (*side) {
    case scenario::Side::friendly:
      return render::Affiliation::friendly;
    case scenario::Side::hostile:
      return render::Affiliation::hostile;
    case scenario::Side::neutral:
      return render::Affiliation::neutral;
    case scenario::Side::unknown:
      break;
  }
  return render::Affiliation::unknown;
}

std::shared_ptr<const render::HeightField> heightFieldOf(const LoadedScenario& scene,
                                                         const volume::Grid& grid) {
  return groundOf(scene, grid, nullptr, false).field;
}

bool isDrawnWithoutEmitters(const scenario::Scenario& scenario, std::size_t platform) {
  const scenario::Platform& drawn = scenario.platforms[platform];
  return drawn.side || drawn.moves() ||
         std::any_of(scenario.targets.begin(), scenario.targets.end(), [&](const scenario::Target& target) {
           return target.platform == static_cast<int>(platform);
         });
}

std::vector<render::Marker> markersOf(const scenario::Snapshot& snapshot, const scenario::TerrainPtr& terrain,
                                      const volume::Grid& grid) {
  const GeoFrame frame(grid.frame);
  const LoadedScenario scene{snapshot.scenario, terrain};
  const std::vector<scenario::Platform>& platforms = snapshot.scenario->platforms;
  std::vector<render::Marker> markers;
  std::vector<bool> has_emitter(platforms.size()), has_receiver(platforms.size());
  for (const scenario::PlacedReceiver& receiver : snapshot.scenario->placed_receivers)
    has_receiver[static_cast<std::size_t>(receiver.platform)] = true;
  const auto add = [&](std::size_t p, const GeodeticPosition& position) -> render::Marker& {
    const scenario::Platform& platform = platforms[p];
    render::Marker& marker = markers.emplace_back();
    marker.position_m = frame.toLocal(position);
    marker.label = platform.name;
    marker.side = affiliationOf(platform.side);
    marker.sidc = platform.sidc;
    marker.moves = platform.moves();
    // Not outside of its track; one that is absent from a fixed place is drawn there, hollow.
    marker.is_shown = snapshot.platforms[p].present || !platform.moves();
    const double ground_m = groundHeight(scene, frame, marker.position_m.x, marker.position_m.y).z_m;
    if (!std::isnan(ground_m)) marker.ground_m = ground_m;
    return marker;
  };
  for (std::size_t e = 0; e < snapshot.emitters.size(); ++e) {
    const scenario::Emitter& emitter = snapshot.scenario->emitters[e];
    const scenario::EmitterState& state = snapshot.emitters[e];
    const auto platform = static_cast<std::size_t>(emitter.platform);
    has_emitter[platform] = true;
    render::Marker& marker = add(platform, state.position);
    marker.label = emitter.name;
    marker.kind = markerKindOf(emitter.kind);
    marker.detail = fmt::format("{} {}", toString(emitter.kind), quantityText(emitter.frequency_hz, "Hz", 4));
    setHeight(marker, platforms[platform], state.height_msl_m);
    marker.active = state.active;
    if (emitter.antenna->view().kind != scenario::PatternKind::isotropic) marker.beam = state.beam.forward;
  }
  for (std::size_t p = 0; p < platforms.size(); ++p) {
    if (has_emitter[p]) continue;
    const scenario::PlatformState& state = snapshot.platforms[p];
    render::Marker& marker = add(p, state.position);
    if (has_receiver[p]) marker.kind = render::MarkerKind::receiver;
    setHeight(marker, platforms[p], state.height_msl_m);
    marker.active = state.present;
  }
  return markers;
}

std::vector<render::Category> categoriesOf(const volume::VolumeInfo& info, const volume::ValueRange& range,
                                           const scenario::Scenario* scenario) {
  const std::string name = info.quantity.substr(0, info.quantity.find(':'));
  const std::vector<std::string> labels = volume::labelsOf(info);
  const auto hash = info.extra.find("scenario_hash");
  if (scenario != nullptr && hash != info.extra.end() && hash->second != scenario->hash) scenario = nullptr;
  std::vector<render::Category> categories;
  for (const scenario::QuantityInfo& quantity : scenario::quantityTable()) {
    if (scenario == nullptr || name != quantity.name) continue;
    const std::vector<std::string> names = emfield::categoryNames(*scenario, quantity.quantity);
    if (!labels.empty() && labels != names) continue;
    for (const int index : emfield::categoriesOf(*scenario, quantity.quantity))
      categories.push_back({index, names[static_cast<std::size_t>(index)]});
    return categories;
  }
  for (std::size_t index = 0; index < labels.size(); ++index) {
    const auto value = static_cast<float>(index);
    if (value >= range.min && value <= range.max)
      categories.push_back({static_cast<int>(index), labels[index]});
  }
  return categories;
}

}  // namespace emscape::playback
