#include "emfield/excess/excess_model.h"

namespace emscape::emfield {
namespace {

using scenario::Emitter;
using scenario::Polarization;
using scenario::PropagationModel;
using scenario::Scenario;

/// How the wave lies to the ground. Mixed polarisations count as vertical: the part that is diffracted the
/// less weakly.
LinearPolarization linearPolarization(Polarization polarization) {
  return polarization == Polarization::horizontal ? LinearPolarization::horizontal
                                                  : LinearPolarization::vertical;
}

DiffractionExcess diffractionExcess(const Emitter& emitter, const Station& station) {
  DiffractionParameters parameters;
  parameters.frequency_hz = emitter.frequency_hz;
  parameters.effective_earth_radius_m = station.effective_earth_radius_m;
  parameters.polarization = linearPolarization(emitter.polarization);
  return {diffractionModel<float>(parameters), static_cast<float>(station.height_msl_m)};
}

}  // namespace

bool hasExcess(const Scenario&, const Emitter& emitter) {
  return emitter.propagation == PropagationModel::diffraction;
}

ExcessModel makeExcessModel(const Scenario&, const Emitter& emitter, const Station& station) {
  return diffractionExcess(emitter, station);
}

bool needsTerrain(const ExcessModel& model) {
  return std::visit([](const auto& m) { return std::decay_t<decltype(m)>::kNeedsTerrain; }, model);
}

}  // namespace emscape::emfield
