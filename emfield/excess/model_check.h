/// Checks that the emitters' models can compute the scenario. The messages come from the models' rows in the
/// registry; this module adds the emitter's name and the line in the scenario.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emfield/columns/grid_columns.h"
#include "emfield/columns/station.h"
#include "emscape/emfield/solver/steep_ground.h"
#include "emscape/scenario/model/snapshot.h"
#include "propagation/column.h"
#include "propagation/inputs.h"

namespace emscape::emfield {

/// Checks before anything is computed.
/// @return warnings, each naming its emitter
/// @throws Error (bad_input) at the location in the scenario for a value that a model refuses
std::vector<std::string> checkModels(const scenario::Scenario& scenario);
/// The same for one emitter.
std::vector<std::string> checkModel(const scenario::Scenario& scenario, const scenario::Emitter& emitter);

/// A text of propagation::steepGroundWarning() with its emitter's name.
std::string steepGroundText(const std::string& emitter, const std::string& text);
/// Keeps of each emitter the march that loses most, as keepSteepest(kept, its name, march) does of one.
void keepSteepest(SteepGrounds& kept, const SteepGrounds& more);
void keepSteepest(SteepGrounds& kept, const std::string& emitter, const propagation::SteepGround& march);

/// Warnings that depend on an emitter's site and the extent of its paths.
/// @param inputs   of the emitter's paths, including their extent
/// @param warnings  of the model on the paths
/// @return warnings, each naming the emitter
std::vector<std::string> pathWarnings(const scenario::Emitter& emitter, const propagation::PathInputs& inputs,
                                      unsigned warnings);

/// Height (m) above the ground, or above the surface of models on a smooth one, as which a model takes lower
/// ends of paths; none: it has no such height.
std::optional<double> lowestHeight_m(propagation::PropagationModel model);

/// Warnings of ends of a path below that height. @param emitter_agl_m, point_agl_m  above ground or surface
std::vector<std::string> lowEndWarnings(const scenario::Emitter& emitter, double emitter_agl_m,
                                        double point_agl_m);

/// A warning if ground lies clearly below mean sea level and the emitter's model, its clutter or the ground's
/// constants take it for sea; and one if its clutter takes ground at or below mean sea level for land.
/// @param lowest_m  of the ground (above mean sea level); NaN: unknown
/// @param at_sea_level  part of the ground that is at or below mean sea level, 0..1; see partAtSeaLevel()
std::vector<std::string> seaWarnings(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                                     double lowest_m, double at_sea_level);

/// A warning if ground lies clearly below the smooth surface of an emitter's model, as a sea below a hill: it
/// has no field of its own there. The surface is that of the beginning of the emitter's track.
std::vector<std::string> smoothSurfaceWarnings(const scenario::Scenario& scenario,
                                               const scenario::Emitter& emitter,
                                               const scenario::Terrain& terrain);

/// A warning if the field at a path's end is weaker than that by troposcatter, which the emitter's model
/// lacks.
/// @param column     of the path; its heights are not read
/// @param end_msl_m  height of the path's end
/// @param loss_db    over free space, by the model
std::vector<std::string> scatterWarnings(const scenario::Emitter& emitter,
                                         const propagation::PathInputs& inputs,
                                         const propagation::ExcessColumn& column, double end_msl_m,
                                         double loss_db);
/// The same for the farthest and lowest point of a grid, over the smooth earth, from the highest place of the
/// emitter's platform. @param terrain  may be null
std::vector<std::string> farthestScatterWarnings(const scenario::Scenario& scenario,
                                                 const scenario::Emitter& emitter,
                                                 const scenario::Terrain* terrain,
                                                 const GridColumns& columns);

/// A warning if a radar's echoes are carried by ducts and the clutter of the surface is not.
std::vector<std::string> ductedClutterWarnings(const scenario::Scenario& scenario,
                                               const scenario::Emitter& radar, const Station& station);
/// The same at the highest place of its platform. @param terrain  may be null
std::vector<std::string> ductedClutterWarnings(const scenario::Scenario& scenario,
                                               const scenario::Emitter& radar,
                                               const scenario::Terrain* terrain);

/// A warning if a radar sees surfaces beyond the region whose echoes of later trips arrive with those inside:
/// their clutter is left out.
std::vector<std::string> laterTripWarnings(const scenario::Scenario& scenario, const scenario::Emitter& radar,
                                           const Station& station);
/// The same at the highest place of its platform. @param terrain  may be null
std::vector<std::string> laterTripWarnings(const scenario::Scenario& scenario, const scenario::Emitter& radar,
                                           const scenario::Terrain* terrain);

/// Part of heights (m above mean sea level) of at most 0.5 m; 0 without heights.
double partAtSeaLevel(const std::vector<float>& heights_m);
/// The same of a sample of the region's ground; 0 unless some clutter is of land without sea.
double partAtSeaLevel(const scenario::Scenario& scenario, const scenario::Terrain& terrain);

}  // namespace emscape::emfield
