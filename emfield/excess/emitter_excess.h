/// The excess loss of an emitter's paths: a model of the registry, the atmospheric attenuation, and their
/// tables.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "emfield/columns/grid_columns.h"
#include "emfield/columns/station.h"
#include "emscape/propagation/steep_ground.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/model/snapshot.h"
#include "propagation/air/air_loss.h"
#include "propagation/inputs.h"
#include "propagation/p2108/p2108.h"
#include "propagation/radial.h"
#include "propagation/registry/excess_model.h"

namespace emscape::propagation {
struct FieldMarch;
}

namespace emscape::emfield {

/// Excess loss of the paths from one emitter.
struct EmitterExcess {
  propagation::ExcessModel model;
  propagation::AirLoss air;
  propagation::TerminalClutter terminal;
  bool is_raised = false;    ///< see propagation::isRaisedByClutter
  bool has_clutter = false;  ///< see hasClutter() and GroundPosts
  /// The pending march for the model's tables; null if they are complete, or if there are none.
  std::shared_ptr<propagation::FieldMarch> march;
  std::shared_ptr<const propagation::SteepGround> steep;  ///< of the march; null: none

  /// Tables of model and air, in host memory; empty if not needed.
  std::shared_ptr<const std::vector<float>> model_tables, air_tables;
  /// The same, pointing to copies of the tables elsewhere.
  EmitterExcess withTablesAt(const float* model_tables_copy, const float* air_tables_copy) const;
};

/// The models' inputs for an emitter of a scenario.
propagation::EmitterInputs emitterInputs(const scenario::Scenario& scenario,
                                         const scenario::Emitter& emitter);

/// The models' inputs for the emitter's paths from its site.
/// @param beam        of the emitter, for models that depend on the antenna
/// @param terrain     null: none
/// @param extent      read only where propagation::needsExtent()
/// @throws Error (bad_input) for a model without terrain if the ground below the emitter is missing
propagation::PathInputs pathInputs(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                                   const scenario::BeamPose& beam, const Station& station,
                                   const scenario::Terrain* terrain, const propagation::PathExtent& extent);

/// Loss of an emitter's paths at their ends; none where a map of the clutter is given.
/// @param terrain  null: a smooth earth at mean sea level
propagation::TerminalClutter terminalClutter(const scenario::Scenario& scenario,
                                             const scenario::Emitter& emitter, const Station& station,
                                             const scenario::Terrain* terrain);

/// Calls a function and adds to its Errors the names of emitter and model and the line of the model's
/// settings.
void inModel(const scenario::Emitter& emitter, const std::function<void()>& body);

/// Extent of the paths from a station to a grid.
propagation::PathExtent pathExtent(const Station& station, const GridColumns& columns);

/// True if an emitter's voxels have an excess: false for free_space and horizon in clear air, which need no
/// memory for it.
bool hasExcess(const scenario::Scenario& scenario, const scenario::Emitter& emitter);
/// True if planExcess() of some emitter reads the columns of a surface, which must then be in host memory.
bool needsHostColumns(const scenario::Scenario& scenario);

/// The excess of an emitter that has one.
/// @param radials  for models with ModelInfo::radial
/// @param points   of a surface, for models with ModelInfo::excess_at; null: these models interpolate
EmitterExcess planExcess(const propagation::PathInputs& inputs,
                         const propagation::RadialInputs* radials = nullptr,
                         const propagation::PathPoints* points = nullptr);
/// The same over the columns of a grid.
/// @throws as pathInputs()
EmitterExcess planExcess(const scenario::Scenario& scenario, const scenario::Emitter& emitter,
                         const scenario::BeamPose& beam, const Station& station,
                         const scenario::Terrain* terrain, const GridColumns& columns);
/// Runs the model's march on the CPU, if it has one. @throws Error (bad_input) that names the emitter
void marchTables(const scenario::Emitter& emitter, EmitterExcess& excess);

}  // namespace emscape::emfield
