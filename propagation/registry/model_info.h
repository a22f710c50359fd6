/// The registry of propagation models: one row per model, from which the schema of scenarios, its validation,
/// warnings, explanations and the field take what they need to know of a model.
#pragma once

#include <string>
#include <vector>

#include "emscape/propagation/explanation.h"
#include "propagation/checks.h"
#include "propagation/inputs.h"
#include "propagation/limits.h"
#include "propagation/path_column.h"
#include "propagation/registry/excess_model.h"
#include "propagation/setting.h"

namespace emscape::propagation {

/// What a model does about oxygen and water vapour.
enum class GasRole {
  on_request,  ///< a bound: counted only if the atmosphere says `always`
  added,       ///< counted unless the atmosphere says `never`
  included     ///< in the model's own loss
};

struct ModelInfo {
  PropagationModel model = PropagationModel::free_space;
  std::string name;       ///< as in scenario files
  std::string reference;  ///< the publication that the model follows
  /// Keys of the model's own section in an emitter, and what the section is for; none: no section.
  std::vector<Setting> settings;
  std::string settings_description;
  std::vector<PropagationModel> also_uses;  ///< models whose settings enter, too
  std::vector<const ModelLimit*> limits;
  std::vector<std::string> reference_datasets;  ///< of `emscape check` that hold the model to figures

  GasRole gases = GasRole::added;
  bool casts_shadow = false;       ///< no field behind terrain
  bool on_smooth_surface = false;  ///< PathInputs::surface_msl_m is read
  bool needs_extent = false;       ///< PathInputs::extent is read to make the excess

  /// What can be said before anything is computed.
  InputFaults (*check)(const EmitterInputs&) = [](const EmitterInputs&) { return InputFaults{}; };
  /// Warnings from where the emitter stands and where its paths end.
  std::vector<std::string> (*pathWarnings)(const PathInputs&) = [](const PathInputs&) {
    return std::vector<std::string>{};
  };
  /// What the remarks (bits) of the excess model mean, one line each; those on missing terrain left out.
  std::vector<std::string> (*remarkMessages)(unsigned remarks) = [](unsigned) {
    return std::vector<std::string>{};
  };
  /// What the loss of one path is made of, without the air.
  Explanation (*explain)(const PathInputs&, PathColumn&) = nullptr;
  /// The excess per column; null: the model has none. `tables` receives what the result points to.
  ExcessModel (*excess)(const PathInputs&, std::vector<float>& tables) = nullptr;
};

/// All models, in the order of the enumeration.
const std::vector<ModelInfo>& models();
const ModelInfo& modelInfo(PropagationModel model);
/// Null if no model has the name.
const ModelInfo* modelNamed(const std::string& name);

/// Whether the settings of one model enter when another is chosen, or itself.
bool settingsEnter(const ModelInfo& settings_of, const ModelInfo& chosen);

/// Whether an emitter's paths lose to oxygen and water vapour beside what the model says.
bool hasGases(const EmitterInputs& inputs);
/// Whether they lose to gases or rain.
bool hasAirLoss(const EmitterInputs& inputs);
/// Whether the paths have an excess: not by a model without one in clear air.
bool hasExcess(const EmitterInputs& inputs);
/// Whether PathInputs::extent is read.
bool needsExtent(const EmitterInputs& inputs);

/// Whether two settings choose the same model and agree in all values.
bool areSame(const ModelSettings& a, const ModelSettings& b);

}  // namespace emscape::propagation
