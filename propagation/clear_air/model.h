/// Parameters of an emitter that ITU-R P.1812 and P.452 have in common, as plain data.
#pragma once

#include "propagation/clear_air/climate.h"
#include "propagation/diffraction/diffraction.h"
#include "propagation/normal_deviate.h"

namespace emscape::propagation {

template <class Real>
struct ClearAirModel {
  Real frequency_ghz;
  Real time_percent;               ///< p: the loss is not exceeded in this percentage of the time, 0..50
  Real time_deviate;               ///< normalDeviate(p)
  Real latitude_deg;               ///< of the path's middle
  DiffractionModel<Real> median;   ///< over the effective earth a_e; sea_fraction is not used
  DiffractionModel<Real> ducting;  ///< the same over a_beta
};

struct ClearAirParameters {
  double frequency_hz = 0;
  double time_percent = 50;
  double latitude_deg = 0;
  double lapse_rate = 40;  ///< Delta N (N-units/km)
  LinearPolarization polarization = LinearPolarization::vertical;
};

template <class Real>
ClearAirModel<Real> clearAirModel(const ClearAirParameters& parameters) {
  ClearAirModel<Real> model;
  model.frequency_ghz = Real(parameters.frequency_hz / 1e9);
  model.time_percent = Real(parameters.time_percent);
  model.time_deviate = Real(normalDeviate(parameters.time_percent / 100));
  model.latitude_deg = Real(parameters.latitude_deg);
  DiffractionParameters diffraction;
  diffraction.frequency_hz = parameters.frequency_hz;
  diffraction.polarization = parameters.polarization;
  diffraction.effective_earth_radius_m = medianEarthRadius_m(parameters.lapse_rate);
  model.median = diffractionModel<Real>(diffraction);
  diffraction.effective_earth_radius_m = kDuctingEarthRadius_m;
  model.ducting = diffractionModel<Real>(diffraction);
  return model;
}

}  // namespace emscape::propagation
