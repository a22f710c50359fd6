#include "emscape/playback/frames/scene.h"

#include <algorithm>
#include <cmath>

#include "emfield/channels/categories.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "playback/frames/ground.h"
#include "volume/labels.h"

namespace emscape::playback {
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

std::shared_ptr<const render::HeightField> heightFieldOf(const LoadedScenario& scene,
                                                         const volume::Grid& grid) {
  return groundOf(scene, grid, nullptr, false).field;
}

std::vector<render::Marker> markersOf(const scenario::Snapshot& snapshot, const scenario::TerrainPtr& terrain,
                                      const volume::Grid& grid) {
  const GeoFrame frame(grid.frame);
  const LoadedScenario scene{snapshot.scenario, terrain};
  std::vector<render::Marker> markers;
  for (std::size_t e = 0; e < snapshot.emitters.size(); ++e) {
    const scenario::Emitter& emitter = snapshot.scenario->emitters[e];
    const scenario::EmitterState& state = snapshot.emitters[e];
    render::Marker marker;
    marker.position_m = frame.toLocal(state.position);
    marker.label = emitter.name;
    marker.kind = markerKindOf(emitter.kind);
    marker.active = state.active;
    if (emitter.antenna->view().kind != scenario::PatternKind::isotropic) marker.beam = state.beam.forward;
    const double ground_m = groundHeight(scene, frame, marker.position_m.x, marker.position_m.y).z_m;
    if (!std::isnan(ground_m)) marker.ground_m = ground_m;
    markers.push_back(std::move(marker));
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
