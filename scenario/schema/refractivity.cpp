// The keys of atmosphere.refractivity.
#include "propagation/parabolic_equation/air/refractivity.h"

#include "propagation/parabolic_equation/air/bulk_duct.h"
#include "scenario/file/schema.h"

namespace emscape::scenario {
namespace {

using document::ValueType;
using document::spec::byDefault;
using document::spec::choice;
using document::spec::number;
using document::spec::optional;
using document::spec::required;
using document::spec::simple;
using document::spec::textOf;
using document::spec::Variants;
using propagation::BulkInputs;

const ObjectSpec& spreadSpec() {
  static const ObjectSpec spec{
      "spread",
      "",
      {
          required("mean", number(), "of the members' normal distribution; within the limits of the key"),
          required("deviation", number().from(0),
                   "standard deviation; a member outside the limits of the key is drawn again"),
      }};
  return spec;
}

ValueSpec spread(const ValueSpec& value) {
  return value.orObject(spreadSpec());
}

}  // namespace

const ObjectSpec& refractivitySpec() {
  const Variants bulk{"bulk"};
  const ValueSpec duct_height = spread(number("m").from(0).to(60));
  const ValueSpec sensor_height = number("m").from(0.5).to(50);
  std::vector<std::string> kinds;
  for (int i = 0; i <= static_cast<int>(RefractivityKind::bulk); ++i)
    kinds.emplace_back(toString(static_cast<RefractivityKind>(i)));
  static const ObjectSpec spec{
      "refractivity",
      "kind",
      {
          required(
              "kind", choice(kinds),
              "standard: 118 M-units per km; linear: gradient_m_per_km; evaporation_duct: Paulus's "
              "profile; surface_duct: falling from the surface; trilinear: falling in a layer; profile: a "
              "CSV file; soundings: a file of IGRA 2, of the University of Wyoming or of the Storm "
              "Prediction Center; bulk: similarity "
              "theory over the sea (NAVSLaM 2.0)"),
          byDefault("surface_m_units", spread(number("M-units").from(200).to(500)),
                    propagation::kSurface_m_units, "M at the surface; only differences bend rays",
                    {"standard", "linear", "evaporation_duct", "surface_duct", "trilinear"}),
          required("gradient_m_per_km", spread(number("M per km").from(-5000).to(5000)),
                   "dM/dz; 117.7 for k_factor 4/3", {"linear"}),
          required("duct_height_m", duct_height, "where M is smallest", {"evaporation_duct"}),
          required("base_m", spread(number("m").from(0).to(20000)), "above sea; standard below",
                   {"trilinear"}),
          required("top_m", spread(number("m").above(0).to(20000)),
                   "of the layer in which M falls, above sea; standard above", {"surface_duct", "trilinear"}),
          required("deficit_m_units", spread(number("M-units").above(0).to(200)),
                   "fall of M through the layer", {"surface_duct", "trilinear"}),
          required("file", textOf(ValueType::file, 4096),
                   "CSV: height_msl_m and m_units, or n_units, or pressure_hpa, temperature_k and "
                   "relative_humidity_percent; for several profiles range_m (from each emitter), or "
                   "latitude_deg and longitude_deg",
                   {"profile"}),
          required("file", textOf(ValueType::file, 4096),
                   "soundings, as IGRA 2, the University of Wyoming (list or CSV) or the Storm Prediction "
                   "Center gives them",
                   {"soundings"}),
          optional("time", simple(ValueType::timestamp),
                   "the sounding nearest to it; by default to the epoch, else the file's last",
                   {"soundings"}),
          required("air_temperature_k", spread(number("K").from(223.15).to(323.15)), "at the sensor", bulk),
          required("sea_temperature_k", spread(number("K").from(270.55).to(309.15)), "of the surface", bulk),
          required("relative_humidity_percent", spread(number("percent").from(10).to(100)),
                   "at the sensor, over water", bulk),
          required("wind_m_s", spread(number("m/s").from(0).to(30)), "at its sensor", bulk),
          byDefault("pressure_hpa", spread(number("hPa").from(920).to(1060)), BulkInputs{}.pressure_hpa,
                    "at sea level", bulk),
          byDefault("salinity_psu", number().from(0).to(60), BulkInputs{}.salinity_psu, "of the sea", bulk),
          byDefault("sensor_height_m", sensor_height, BulkInputs{}.sensor_height_m,
                    "above the sea, of temperature and humidity", bulk),
          optional("wind_height_m", sensor_height, "of the wind; by default sensor_height_m", bulk),
          optional("evaporation_duct_height_m", duct_height,
                   "adds the departure of such a duct from standard air, up to three times its height",
                   {"standard", "linear", "surface_duct", "trilinear", "profile", "soundings"}),
          byDefault("members", simple(ValueType::integer).from(1).to(1000), 1.0,
                    "of an ensemble of the values that have a deviation"),
          byDefault("seed", simple(ValueType::integer).from(0).to(2147483647), 1.0,
                    "of the ensemble: the same seed draws the same members"),
          optional("quantile", number().above(0).to(0.999),
                   "quantile of the power over the members; by default their mean power"),
      }};
  return spec;
}

}  // namespace emscape::scenario
