#include "emscape/propagation/settings.h"

namespace emscape::propagation {
namespace {

template <class Enum, std::size_t kCount>
const char* nameOf(Enum value, const char* const (&names)[kCount]) {
  return names[static_cast<std::size_t>(value)];
}

}  // namespace

const char* toString(Polarization polarization) {
  return nameOf(polarization,
                {"horizontal", "vertical", "slant_45", "slant_135", "circular_right", "circular_left"});
}

const char* toString(PropagationModel model) {
  return nameOf(model, {"free_space", "horizon", "diffraction", "two_ray", "itm", "p528", "p1812", "p452",
                        "parabolic_equation"});
}

const char* toString(DiffractionMethod method) {
  return nameOf(method, {"delta_bullington", "single_edge", "deygout"});
}

const char* toString(TwoRaySum sum) {
  return nameOf(sum, {"coherent", "envelope"});
}

const char* toString(RoughnessModel model) {
  return nameOf(model, {"ament", "miller_brown"});
}

const char* toString(PeCells cells) {
  return nameOf(cells, {"mean", "point"});
}

const char* toString(PeRadiator radiator) {
  return nameOf(radiator, {"isotropic", "pattern"});
}

const char* toString(ItmForm form) {
  return nameOf(form, {"point_to_point", "area"});
}

const char* toString(ItmService service) {
  return nameOf(service, {"single_message", "individual", "mobile", "broadcast"});
}

const char* toString(ItmSiting siting) {
  return nameOf(siting, {"random", "careful", "very_careful"});
}

const char* toString(ClearAirZone zone) {
  return nameOf(zone, {"by_height", "inland", "coastal_land", "sea"});
}

const char* toString(GroundKind kind) {
  return nameOf(kind, {"sea", "fresh_water", "wet_ground", "average_ground", "dry_ground", "concrete"});
}

const char* toString(GasLosses gases) {
  return nameOf(gases, {"auto", "always", "never"});
}

const char* toString(RefractionProfile profile) {
  return nameOf(profile, {"linear", "exponential"});
}

const char* toString(RadioClimate climate) {
  return nameOf(climate,
                {"equatorial", "continental_subtropical", "maritime_subtropical", "desert",
                 "continental_temperate", "maritime_temperate_over_land", "maritime_temperate_over_sea"});
}

}  // namespace emscape::propagation
