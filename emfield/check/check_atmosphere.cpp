/// Attenuation by gases and rain.
#include "emfield/check/datasets.h"
#include "emfield/check/reference_table.h"
#include "emscape/base/units.h"
#include "propagation/air/gases.h"
#include "propagation/air/rain.h"

namespace emscape::emfield {

using namespace propagation;

DatasetCheck checkSpecificGasAttenuation(const std::filesystem::path& folder) {
  const ReferenceTable cases(folder / "cases.csv",
                             {"f_ghz", "pressure_hpa", "temperature_k", "vapour_g_m3", "gamma_oxygen_db_km",
                              "gamma_water_db_km", "gamma_db_km"});
  FigureCheck total{"gamma_db_km", 1e-5, "relative"}, oxygen{"gamma_oxygen_db_km", 1e-5, "relative"},
      vapour{"gamma_water_db_km", 1e-5, "relative"};
  for (int i = 0; i < cases.rows(); ++i) {
    // pressure_hpa is that of dry air
    const GasAttenuation gamma =
        gasAttenuation(cases.number(i, "f_ghz") * 1e9, cases.number(i, "pressure_hpa"),
                       cases.number(i, "temperature_k"), cases.number(i, "vapour_g_m3"));
    const int line = cases.location(i).line;
    total.compareRelative(gamma.total_db_per_km(), cases.number(i, "gamma_db_km"), line);
    oxygen.compareRelative(gamma.oxygen_db_per_km, cases.number(i, "gamma_oxygen_db_km"), line);
    vapour.compareRelative(gamma.vapour_db_per_km, cases.number(i, "gamma_water_db_km"), line);
  }
  return {cases.rows(), {total, oxygen, vapour}};
}

DatasetCheck checkSlantGasAttenuation(const std::filesystem::path& folder) {
  const ReferenceTable cases(folder / "cases.csv", {"f_ghz", "elevation_deg", "vapour_g_m3", "pressure_hpa",
                                                    "temperature_k", "attenuation_db"});
  FigureCheck attenuation{"attenuation_db", 1e-3, "dB"};
  for (int i = 0; i < cases.rows(); ++i) {
    AirState surface;
    surface.temperature_k = cases.number(i, "temperature_k");
    surface.vapour_g_m3 = cases.number(i, "vapour_g_m3");
    surface.pressure_hpa =
        cases.number(i, "pressure_hpa") + surface.vapourPressure_hpa();  // given: that of dry air
    attenuation.compare(slantGasAttenuationDb(cases.number(i, "f_ghz") * 1e9,
                                              degToRad(cases.number(i, "elevation_deg")), surface),
                        cases.number(i, "attenuation_db"), cases.location(i).line);
  }
  return {cases.rows(), {attenuation}};
}

DatasetCheck checkRain(const std::filesystem::path& folder) {
  const ReferenceTable cases(
      folder / "cases.csv", {"elevation_deg", "f_ghz", "rain_mm_h", "tilt_deg", "k", "alpha", "gamma_db_km"});
  FigureCheck gamma{"gamma_db_km", 1e-5, "relative"}, k{"k", 1e-5, "relative"},
      alpha{"alpha", 1e-5, "relative"};
  for (int i = 0; i < cases.rows(); ++i) {
    const RainCoefficients<double> rain =
        rainCoefficients(cases.number(i, "f_ghz") * 1e9, degToRad(cases.number(i, "elevation_deg")),
                         degToRad(cases.number(i, "tilt_deg")));
    const int line = cases.location(i).line;
    gamma.compareRelative(rain.specificAttenuation_db_per_km(cases.number(i, "rain_mm_h")),
                          cases.number(i, "gamma_db_km"), line);
    k.compareRelative(rain.k, cases.number(i, "k"), line);
    alpha.compareRelative(rain.alpha, cases.number(i, "alpha"), line);
  }
  return {cases.rows(), {gamma, k, alpha}};
}

}  // namespace emscape::emfield
