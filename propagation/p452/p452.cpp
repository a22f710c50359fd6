#include "propagation/p452/p452.h"

#include "propagation/air/gases.h"

namespace emscape::propagation {

template <class Real>
P452Model<Real> p452Model(const P452Parameters& parameters) {
  const auto gases_db_per_km = [&](double vapour_g_m3) {
    return Real(lineByLineGasAttenuation(parameters.clear_air.frequency_hz, parameters.dry_pressure_hpa,
                                         parameters.temperature_k, vapour_g_m3)
                    .total_db_per_km());
  };
  P452Model<Real> model;
  model.clear_air = clearAirModel<Real>(parameters.clear_air);
  model.sea_level_refractivity = Real(parameters.sea_level_refractivity);
  for (int i = 0; i < 3; ++i)
    model.gases_db_per_km[i] = gases_db_per_km(kP452LandVapour_g_m3 + kP452SeaVapour_g_m3 * i / 2);
  model.scatter_gases_db_per_km = gases_db_per_km(3);
  model.coupling_db = Real(0.051 * std::exp(0.055 * parameters.gains_dbi));
  return model;
}
template P452Model<double> p452Model<double>(const P452Parameters& parameters);
template P452Model<float> p452Model<float>(const P452Parameters& parameters);

}  // namespace emscape::propagation
