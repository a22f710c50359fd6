/// The registry of propagation models: one row per model, used by the scenario schema, validation, warnings,
/// explanations and the field.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/propagation/explanation.h"
#include "propagation/checks.h"
#include "propagation/choice.h"
#include "propagation/inputs.h"
#include "propagation/limits.h"
#include "propagation/mechanism.h"
#include "propagation/parabolic_equation/field_march.h"
#include "propagation/path_column.h"
#include "propagation/radial.h"
#include "propagation/registry/excess_model.h"
#include "propagation/setting.h"

namespace emscape::propagation {

/// Treatment of oxygen and water vapour by a model.
enum class GasRole {
  on_request,  ///< the model is a lower bound of the loss: added only if the atmosphere's `gases` is `always`
  added,       ///< added unless the atmosphere's `gases` is `never`
  included     ///< part of the model's loss
};

/// Processor time of an emitter's losses on one core (WorkEstimate: within a factor of 5), without marches,
/// whose time is among ModelInfo::choices.
struct ModelCost {
  double column_ns = 0;              ///< of a column of the grid
  double post_ns = 0;                ///< of a post of the terrain on the path to a column
  double voxel_ns = 0;               ///< over a smooth earth
  double voxel_over_terrain_ns = 0;  ///< over terrain
  double emitter_s = 0;              ///< of its tables
};

/// The excess of a model that marches outwards, and the march that makes its tables.
struct RadialExcess {
  ExcessModel model;  ///< without its tables
  FieldMarch march;
  std::optional<SteepGround> steep;  ///< none: no terrain
};

struct ModelInfo {
  PropagationModel model = PropagationModel::free_space;
  std::string name;       ///< as in scenario files
  std::string title;      ///< what it computes, in a few words
  std::string reference;  ///< the publication that the model follows
  std::string accuracy;  ///< measured accuracy, with the names of the tests; quoted in the table of README.md
  ModelCost cost;
  /// Keys and description of the model's section in an emitter; empty: no section.
  std::vector<Setting> settings;
  std::string settings_description;
  std::vector<PropagationModel> also_uses;  ///< other models whose settings are read
  std::vector<const ModelLimit*> limits;
  std::vector<std::string> reference_datasets;  ///< of `emscape check` that test the model

  std::vector<Mechanism> mechanisms;  ///< those that may determine its loss; for most models only its own

  GasRole gases = GasRole::added;
  bool casts_shadow = false;        ///< no field behind terrain
  bool on_effective_earth = false;  ///< refraction by k_factor or the atmosphere, not by the model
  bool on_smooth_surface = false;   ///< PathInputs::surface_msl_m is read
  bool has_reflected_ray = false;   ///< see Reflects in excess_model.h
  bool needs_extent = false;        ///< PathInputs::extent is read to make the excess

  /// Checks before anything is computed.
  InputFaults (*check)(const EmitterInputs&) = [](const EmitterInputs&) { return InputFaults{}; };
  /// Warnings that depend on the emitter's site and the extent of its paths.
  std::vector<std::string> (*pathWarnings)(const PathInputs&) = [](const PathInputs&) {
    return std::vector<std::string>{};
  };
  /// Texts of the excess model's warning bits, one line each, without missing terrain.
  std::vector<std::string> (*warningMessages)(unsigned warnings) = [](unsigned) {
    return std::vector<std::string>{};
  };
  /// The parts of the loss of one path, without atmospheric attenuation.
  Explanation (*explain)(const PathInputs&, PathColumn&) = nullptr;
  /// Makes the excess model; null: none. `tables` receives the data to which the result points.
  ExcessModel (*excess)(const PathInputs&, std::vector<float>& tables) = nullptr;
  /// The same over a surface, for models whose `excess` interpolates, because the surface's points must equal
  /// `explain`; null: `excess` does not interpolate.
  ExcessModel (*excess_at)(const PathInputs&, const PathPoints&, std::vector<float>& tables) = nullptr;
  /// The same for a model that marches outwards, instead of `excess`. @throws Error (bad_input) as `choices`
  RadialExcess (*radial)(const PathInputs&, const RadialInputs&) = nullptr;
  /// The automatic choices of such a model. @throws Error (bad_input) with the value and the allowed range
  std::vector<ModelChoice> (*choices)(const PathInputs&, const RadialInputs&) = nullptr;
};

/// All models, in the order of the enumeration.
const std::vector<ModelInfo>& models();
const ModelInfo& modelInfo(PropagationModel model);
/// Null if no model has the name.
const ModelInfo* modelNamed(const std::string& name);

/// True if a model has several mechanisms: HasMechanisms in excess_model.h.
inline bool hasMechanisms(const ModelInfo& model) {
  return model.mechanisms.size() > 1;
}

/// True if a model reads the settings of another model, or its own.
bool settingsEnter(const ModelInfo& settings_of, const ModelInfo& chosen);

/// True if attenuation by oxygen and water vapour is added to the model's loss.
bool hasGases(const EmitterInputs& inputs);
/// True if attenuation by gases or rain is added.
bool hasAirLoss(const EmitterInputs& inputs);
/// True if ends of paths may have the loss of TerminalClutter.
bool hasTerminalClutter(const EmitterInputs& inputs);
/// True for models whose profiles are raised by the clutter of the land cover: their terrain is the surface
/// that waves meet. p1812 and p452 read the clutter themselves.
bool isRaisedByClutter(const ModelSettings& settings);
/// True for models whose profiles have posts where the path crosses the lines between the posts of the
/// elevation model: ReadsCrossings in excess_model.h.
bool readsCrossings(const ModelSettings& settings);
/// True if the paths have an excess loss, from the model, the atmosphere or clutter.
bool hasExcess(const EmitterInputs& inputs);
/// True if PathInputs::extent is read.
bool needsExtent(const EmitterInputs& inputs);

/// True if two settings choose the same model and agree in all values.
bool areSame(const ModelSettings& a, const ModelSettings& b);

}  // namespace emscape::propagation
