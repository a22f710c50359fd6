/// The ground and the emitters of a scenario, for drawing.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "emscape/playback/frames/inputs.h"
#include "emscape/render/annotate/legend.h"
#include "emscape/render/annotate/overlay.h"
#include "emscape/render/scene/height_field.h"
#include "emscape/scenario/model/snapshot.h"
#include "emscape/volume/dense_volume.h"
#include "emscape/volume/grid.h"

namespace emscape::playback {

/// The ground below a grid: terrain at about the spacing of the elevation posts (at most 1500 posts per
/// side), or the smooth earth.
std::shared_ptr<const render::HeightField> heightFieldOf(const LoadedScenario& scene,
                                                         const volume::Grid& grid);

render::MarkerKind markerKindOf(scenario::EmitterKind kind);
render::Affiliation affiliationOf(const std::optional<scenario::Side>& side);

/// The emitters of an instant and then the platforms without one, all of them in the scenario's order, in the
/// grid's frame; those outside of their tracks are not shown.
/// @param terrain  null: the smooth earth
std::vector<render::Marker> markersOf(const scenario::Snapshot& snapshot, const scenario::TerrainPtr& terrain,
                                      const volume::Grid& grid);

/// The tracks of the scenario's moving platforms, in the grid's frame. Frame sources compute them once for
/// all frames.
std::vector<render::Track> tracksOf(const LoadedScenario& scene, const volume::Grid& grid, double time_s);

/// The categories of a volume of indices, for legends: those that can occur in its scenario; if it was
/// computed from another one, or names its indices otherwise, those of its own names that are in the range.
/// @param range     of the colours
/// @param scenario  may be null
std::vector<render::Category> categoriesOf(const volume::VolumeInfo& info, const volume::ValueRange& range,
                                           const scenario::Scenario* scenario);

/// Whether maps have a symbol of a platform without emitters: it has a side, moves, or is a target.
bool isDrawnWithoutEmitters(const scenario::Scenario& scenario, std::size_t platform);

}  // namespace emscape::playback
