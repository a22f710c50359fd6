#include <algorithm>
#include <iterator>

#include "propagation/clear_air/row.h"
#include "propagation/diffraction/model.h"
#include "propagation/horizon/model.h"
#include "propagation/itm/model.h"
#include "propagation/p1812/model.h"
#include "propagation/p2108/p2108.h"
#include "propagation/p452/model.h"
#include "propagation/p528/model.h"
#include "propagation/p528/p528.h"
#include "propagation/parabolic_equation/model.h"
#include "propagation/parabolic_equation/plan.h"
#include "propagation/registry/model_info.h"
#include "propagation/two_ray/model.h"

namespace emscape::propagation {
namespace {

template <std::size_t kCount>
std::vector<const ModelLimit*> listOf(const ModelLimit* const (&limits)[kCount]) {
  return {std::begin(limits), std::end(limits)};
}

ModelInfo rowOf(PropagationModel model, const char* title, const char* reference) {
  ModelInfo row;
  row.model = model;
  row.name = toString(model);
  row.title = title;
  row.reference = reference;
  row.mechanisms = {mechanismOf(model)};
  return row;
}

ModelInfo freeSpaceRow() {
  ModelInfo row = rowOf(PropagationModel::free_space, "free space: spreading only", "ITU-R P.525");
  row.accuracy = "1e-4 dB from emitter to voxel, on and off the beam's axis (FreeSpaceTable)";
  row.reference_datasets = {"radar/freespace_conversions_derived.csv"};
  row.cost = {80, 0, 0, 0, 0};
  row.gases = GasRole::on_request;
  row.explain = [](const PathInputs&, PathColumn&) {
    Explanation explanation;
    explanation.why = "free-space spreading only, without terrain and the earth's curvature";
    return explanation;
  };
  return row;
}

ModelInfo horizonRow() {
  ModelInfo row =
      rowOf(PropagationModel::horizon, "line of sight: shadow behind terrain", "ITU-R P.834, P.453");
  row.cost = {300, 0.4, 3, 8, 0};
  row.accuracy = "the shadow's edge within 0.1 m of a walk over the posts of the terrain (FieldAtPosts)";
  row.gases = GasRole::on_request;
  row.casts_shadow = true;
  row.pathWarnings = horizonPathWarnings;
  row.on_effective_earth = true;
  row.explain = explainHorizon;
  return row;
}

ModelInfo diffractionRow() {
  ModelInfo row = rowOf(PropagationModel::diffraction, "diffraction over terrain, ITU-R P.526",
                        "ITU-R P.526-15, section 4.5");
  row.cost = {400, 1, 12, 20, 0};
  row.accuracy = "the field within 0.1 dB of path by path at 99 % of voxels (Excess)";
  row.settings = diffractionSettings();
  row.settings_description = "settings of the model; also used above itm's heights";
  row.limits = listOf(kDiffractionLimits);
  row.reference_datasets = {"p526_delta_bullington", "radar/knife_edge_J_nu_derived.csv"};
  row.check = checkDiffraction;
  row.pathWarnings = diffractionPathWarnings;
  row.on_effective_earth = true;
  row.explain = explainDiffraction;
  row.excess = [](const PathInputs& inputs, std::vector<float>&) -> ExcessModel {
    const bool is_bullington =
        inputs.emitter.settings.diffraction.method == DiffractionMethod::delta_bullington;
    return is_bullington ? ExcessModel(diffractionExcess(inputs)) : ExcessModel(edgeExcess(inputs));
  };
  return row;
}

ModelInfo twoRayRow() {
  ModelInfo row = rowOf(PropagationModel::two_ray, "direct and reflected ray over a smooth surface",
                        "Blake 1980; ITU-R P.526-15, P.527-6");
  row.cost = {1200, 0, 180, 180, 0};
  row.accuracy = "the formula, at each voxel";
  row.settings = twoRaySettings();
  row.settings_description = "settings of the model";
  row.limits = listOf(kTwoRayLimits);
  row.reference_datasets = {"radar/two_ray_flat_pec_derived.csv"};
  row.on_smooth_surface = true;
  row.has_reflected_ray = true;
  row.check = checkTwoRay;
  row.pathWarnings = twoRayPathWarnings;
  row.on_effective_earth = true;
  row.explain = explainTwoRay;
  row.excess = [](const PathInputs& inputs, std::vector<float>&) -> ExcessModel {
    return twoRayExcess(inputs);
  };
  return row;
}

ModelInfo itmRow() {
  ModelInfo row =
      rowOf(PropagationModel::itm, "Longley-Rice (ITM): terrain, 20 MHz to 20 GHz", "NTIA Report 82-100");
  row.cost = {2400, 4, 31, 190, 0};
  row.accuracy = "0.0008 dB from NTIA's own program; the field within 1 dB of each path (Excess)";
  row.settings = itmSettings();
  row.settings_description = "settings of the model";
  row.also_uses = {PropagationModel::diffraction};
  row.limits = listOf(kItmLimits);
  row.reference_datasets = {"itm_p2p", "itm_p2p_published", "itm_area"};
  row.check = checkItm;
  row.pathWarnings = diffractionPathWarnings;
  row.warningMessages = itmWarningMessages;
  row.explain = explainItm;
  row.excess = [](const PathInputs& inputs, std::vector<float>&) -> ExcessModel { return itmExcess(inputs); };
  return row;
}

ModelInfo p528Row() {
  ModelInfo row = rowOf(PropagationModel::p528, "ITU-R P.528: aeronautical, smooth earth", "ITU-R P.528-5");
  row.cost = {300, 0, 15, 15, 0.18};
  row.accuracy = "tables within 0.5 dB, more where the model steps at the horizon (Excess)";
  row.settings = p528Settings();
  row.settings_description = "settings of the model";
  row.limits = listOf(kP528Limits);
  row.reference_datasets = {"p528"};
  row.gases = GasRole::included;
  row.on_smooth_surface = true;
  row.needs_extent = true;
  row.check = checkP528;
  row.pathWarnings = p528PathWarnings;
  row.explain = explainP528;
  row.excess = [](const PathInputs& inputs, std::vector<float>& tables) -> ExcessModel {
    return p528Excess(inputs, tables);
  };
  row.excess_at = [](const PathInputs& inputs, const PathPoints& points,
                     std::vector<float>& tables) -> ExcessModel {
    return p528ExcessAt(inputs, points, tables);
  };
  return row;
}

ModelInfo p1812Row() {
  ModelInfo row = rowOf(PropagationModel::p1812, "ITU-R P.1812: terrestrial, by share of time and places",
                        "ITU-R P.1812-8");
  row.cost = {2500, 10, 85, 240, 0};
  row.accuracy =
      "0.0002 dB from ITU-R's validation set; the field within 0.1 dB at 99 % of heights (ExcessModels)";
  row.settings = p1812Settings();
  row.settings_description = "settings of the model";
  row.limits = listOf(kP1812Limits);
  row.reference_datasets = {"p1812"};
  row.check = checkP1812;
  row.pathWarnings = p1812PathWarnings;
  row.warningMessages = clearAirWarningMessages;
  row.explain = explainP1812;
  row.excess = [](const PathInputs& inputs, std::vector<float>&) -> ExcessModel {
    return p1812Excess(inputs);
  };
  return row;
}

ModelInfo p452Row() {
  ModelInfo row =
      rowOf(PropagationModel::p452, "ITU-R P.452: interference, by share of time", "ITU-R P.452-18");
  row.cost = {2500, 10, 85, 240, 0};
  row.accuracy = "0.0003 dB from ITU-R's validation set; the field as p1812";
  row.settings = p452Settings();
  row.settings_description = "settings of the model";
  row.limits = listOf(kP452Limits);
  row.reference_datasets = {"p452"};
  row.gases = GasRole::included;
  row.check = checkP452;
  row.pathWarnings = p452PathWarnings;
  row.warningMessages = clearAirWarningMessages;
  row.explain = explainP452;
  row.excess = [](const PathInputs& inputs, std::vector<float>&) -> ExcessModel {
    return p452Excess(inputs);
  };
  return row;
}

ModelInfo parabolicEquationRow() {
  ModelInfo row = rowOf(PropagationModel::parabolic_equation, "parabolic equation: ducts, lobes, terrain",
                        "Feit and Fleck 1978; Donohue and Kuttler 2000");
  row.cost = {1000, 5, 200, 300, 0};
  row.accuracy =
      "automatic settings: 90 % of voxels within 0.01 dB (smooth earth), 0.05 dB (gentle hills) and 2.8 dB "
      "(mountains) of single marches, which over mountains are some dB off themselves; with set steps over a "
      "smooth earth 0.3 dB from exact fields to 60 dB below free space (emscape check, pe)";
  row.settings = peSettings();
  row.settings_description = "settings of the model; those that are auto are chosen from the scenario";
  row.limits = listOf(kPeLimits);
  row.reference_datasets = {"pe/two_ray_pec_h.csv",      "pe/gaussian_beam_linear_m.csv",
                            "pe/smooth_earth_modes.csv", "pe/smooth_earth_decay.csv",
                            "pe/ntia_lfmf_10_30mhz.csv", "pe/knife_edge.csv",
                            "pe/sloped_plane_pec_h.csv", "pe/duct_fields.csv",
                            "pe/duct_modes.csv",         "pe/lobe_cell_mean.csv",
                            "pe/roughness.csv"};
  row.mechanisms = {Mechanism::parabolic_equation, Mechanism::diffraction,  Mechanism::two_ray,
                    Mechanism::extended_optics,    Mechanism::troposcatter, Mechanism::floor};
  row.check = checkPe;
  row.warningMessages = peWarningMessages;
  row.explain = explainPe;
  row.radial = [](const PathInputs& inputs, const RadialInputs& radials) -> RadialExcess {
    PeField field = peField(inputs, radials);
    return {field.excess, std::move(field.march), std::move(field.steep)};
  };
  row.choices = peChoices;
  return row;
}

}  // namespace

const std::vector<ModelInfo>& models() {
  static const std::vector<ModelInfo> rows{freeSpaceRow(), horizonRow(), diffractionRow(),
                                           twoRayRow(),    itmRow(),     p528Row(),
                                           p1812Row(),     p452Row(),    parabolicEquationRow()};
  return rows;
}

const ModelInfo& modelInfo(PropagationModel model) {
  return *std::find_if(models().begin(), models().end(),
                       [model](const ModelInfo& row) { return row.model == model; });
}

const ModelInfo* modelNamed(const std::string& name) {
  const auto found = std::find_if(models().begin(), models().end(),
                                  [&name](const ModelInfo& row) { return row.name == name; });
  return found == models().end() ? nullptr : &*found;
}

bool settingsEnter(const ModelInfo& settings_of, const ModelInfo& chosen) {
  return settings_of.model == chosen.model ||
         std::count(chosen.also_uses.begin(), chosen.also_uses.end(), settings_of.model) > 0;
}

bool hasGases(const EmitterInputs& inputs) {
  const GasRole role = modelInfo(inputs.settings.model).gases;
  switch (inputs.atmosphere.gases) {
    case GasLosses::never:
      return false;
    case GasLosses::always:
      return role != GasRole::included;
    case GasLosses::automatic:
      return role == GasRole::added;
  }
  return false;
}

bool hasAirLoss(const EmitterInputs& inputs) {
  return inputs.atmosphere.rain_mm_h > 0 || hasGases(inputs);
}

bool hasTerminalClutter(const EmitterInputs& inputs) {
  const PropagationModel model = inputs.settings.model;
  return inputs.ground.terminal_clutter == TerminalClutterModel::p2108 && model != PropagationModel::p528 &&
         model != PropagationModel::parabolic_equation && kP2108Frequency.holds(inputs.frequency_hz);
}

bool isRaisedByClutter(const ModelSettings& settings) {
  return settings.model == PropagationModel::diffraction ||
         (settings.model == PropagationModel::itm && settings.itm.form == ItmForm::point_to_point);
}

bool readsCrossings(const ModelSettings& settings) {
  return settings.model == PropagationModel::diffraction &&
         settings.diffraction.method == DiffractionMethod::delta_bullington;
}

bool hasExcess(const EmitterInputs& inputs) {
  const ModelInfo& row = modelInfo(inputs.settings.model);
  return row.excess != nullptr || row.radial != nullptr || hasAirLoss(inputs) || hasTerminalClutter(inputs);
}

bool needsExtent(const EmitterInputs& inputs) {
  return modelInfo(inputs.settings.model).needs_extent || hasAirLoss(inputs);
}

bool areSame(const ModelSettings& a, const ModelSettings& b) {
  return a.model == b.model && std::all_of(models().begin(), models().end(), [&](const ModelInfo& row) {
           return std::all_of(row.settings.begin(), row.settings.end(),
                              [&](const Setting& setting) { return setting.get(a) == setting.get(b); });
         });
}

}  // namespace emscape::propagation
