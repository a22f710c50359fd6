/// The registry of propagation models: one row per model, which the scenario schema, validation, warnings,
/// explanations and the field read.
#pragma once

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
  on_request,  ///< the model is a bound: added only if the atmosphere's `gases` is `always`
  added,       ///< added unless the atmosphere's `gases` is `never`
  included     ///< in the model's own loss
};

/// CPU time of an emitter's losses on one core, to an order of magnitude. Measured with the four emitters of
/// scenarios/jacksboro.yaml, which is 30 km wide: the user time of `simulate` of one step, on 40 x 40 x 20
/// and 100 x 100 x 50 voxels.
struct ModelCost {
  double voxel_ns = 0;   ///< at one voxel
  double emitter_s = 0;  ///< of its tables and marches, on a grid of any size
};

/// The excess of a model that marches outwards, and the march that makes its tables.
struct RadialExcess {
  ExcessModel model;  ///< without its tables, and without the warnings that the march returns
  FieldMarch march;
};

struct ModelInfo {
  PropagationModel model = PropagationModel::free_space;
  std::string name;       ///< as in scenario files
  std::string reference;  ///< the publication that the model follows
  std::string accuracy;   ///< as measured, with the names of the tests; README's table quotes it
  ModelCost cost;
  /// Keys of the model's own section in an emitter, and its description; none: no section.
  std::vector<Setting> settings;
  std::string settings_description;
  std::vector<PropagationModel> also_uses;  ///< other models whose settings are read
  std::vector<const ModelLimit*> limits;
  std::vector<std::string> reference_datasets;  ///< of `emscape check` that test the model

  std::vector<Mechanism> mechanisms;  ///< those that may determine its loss; of most models itself

  GasRole gases = GasRole::added;
  bool casts_shadow = false;        ///< no field behind terrain
  bool on_effective_earth = false;  ///< rays by k_factor or the atmosphere's refraction, not its own
  bool on_smooth_surface = false;   ///< PathInputs::surface_msl_m is read
  bool has_reflected_ray = false;   ///< its excess has one: Reflects in excess_model.h
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
  /// The parts of the loss of one path, without the air.
  Explanation (*explain)(const PathInputs&, PathColumn&) = nullptr;
  /// Makes the excess model; null: there is none. `tables` receives the data that the result points to.
  ExcessModel (*excess)(const PathInputs&, std::vector<float>& tables) = nullptr;
  /// The same over a surface, of a model whose `excess` interpolates where the surface's points must equal
  /// `explain`; null: `excess` does not.
  ExcessModel (*excess_at)(const PathInputs&, const PathPoints&, std::vector<float>& tables) = nullptr;
  /// The same of a model that marches outwards, in place of `excess`. @throws Error (bad_input) for what
  /// `choices` refuses
  RadialExcess (*radial)(const PathInputs&, const RadialInputs&) = nullptr;
  /// What such a model chooses by itself. @throws Error (bad_input) with the value and what is allowed
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
/// True if the paths have an excess loss, of the model or of the air.
bool hasExcess(const EmitterInputs& inputs);
/// True if PathInputs::extent is read.
bool needsExtent(const EmitterInputs& inputs);

/// True if two settings choose the same model and agree in all values.
bool areSame(const ModelSettings& a, const ModelSettings& b);

}  // namespace emscape::propagation
