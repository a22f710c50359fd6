/// Inputs of propagation models: the choice of a model, the settings of each model, and the wave, ground and
/// air that all models share. propagation/registry lists the values that each model accepts.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "emscape/base/enum_names.h"
#include "emscape/base/error.h"

namespace emscape::propagation {

using emscape::toString;

/// Direction of a wave's electric field, seen in the direction of propagation.
enum class Polarization { horizontal, vertical, slant_45, slant_135, circular_right, circular_left };
constexpr auto namesOf(Polarization) {
  return std::array{"horizontal", "vertical", "slant_45", "slant_135", "circular_right", "circular_left"};
}

enum class PropagationModel {
  free_space,
  horizon,
  diffraction,
  two_ray,
  itm,
  p528,
  p1812,
  p452,
  parabolic_equation
};
constexpr auto namesOf(PropagationModel) {
  return std::array{"free_space", "horizon", "diffraction", "two_ray",           "itm",
                    "p528",       "p1812",   "p452",        "parabolic_equation"};
}

/// Method of diffraction over terrain.
enum class DiffractionMethod {
  delta_bullington,  ///< terrain as one edge, with the smooth-earth correction (P.526 section 4.5.3)
  single_edge,       ///< only the dominant edge
  deygout            ///< three edges
};
constexpr auto namesOf(DiffractionMethod) {
  return std::array{"delta_bullington", "single_edge", "deygout"};
}

struct DiffractionSettings {
  DiffractionMethod method = DiffractionMethod::delta_bullington;
};

/// Treatment of the interference of two rays.
enum class TwoRaySum {
  coherent,  ///< lobes and nulls
  envelope,  ///< maxima of the lobes: 1 + |reflected|
};
constexpr auto namesOf(TwoRaySum) {
  return std::array{"coherent", "envelope"};
}

/// Factor of the coherent reflection for a rough surface, with z = 8 pi^2 (sigma sin psi / lambda)^2.
enum class RoughnessModel {
  ament,         ///< exp(-z): Gaussian heights (Ament 1953)
  miller_brown,  ///< exp(-z) I0(z): sinusoidal waves of random phase (Miller, Brown, Vegh 1984); fits the sea
};
constexpr auto namesOf(RoughnessModel) {
  return std::array{"ament", "miller_brown"};
}

struct TwoRaySettings {
  TwoRaySum sum = TwoRaySum::coherent;
  RoughnessModel roughness_model = RoughnessModel::miller_brown;
};

/// ITM's terrain input.
enum class ItmForm { point_to_point, area };
constexpr auto namesOf(ItmForm) {
  return std::array{"point_to_point", "area"};
}
/// ITM's mode of variability.
enum class ItmService { single_message, individual, mobile, broadcast };
constexpr auto namesOf(ItmService) {
  return std::array{"single_message", "individual", "mobile", "broadcast"};
}
/// Siting criteria of the antennas in ITM's area mode.
enum class ItmSiting { random = 0, careful = 1, very_careful = 2 };
constexpr auto namesOf(ItmSiting) {
  return std::array{"random", "careful", "very_careful"};
}

struct ItmSettings {
  ItmForm form = ItmForm::point_to_point;
  /// The loss is not exceeded in this percentage of the time, of locations, of situations.
  double time_percent = 50, location_percent = 50, situation_percent = 50;
  ItmService service = ItmService::mobile;
  double irregularity_m = 90;                        ///< of the terrain; area mode
  ItmSiting transmitter_siting = ItmSiting::random;  ///< area mode
  ItmSiting receiver_siting = ItmSiting::random;
};

struct P528Settings {
  double time_percent = 50;  ///< the loss is not exceeded in this percentage of the time
};

/// Radio-climatic zones of a path.
enum class ClearAirZone {
  by_height,     ///< sea where the terrain is at or below mean sea level; land by height and distance from it
  inland,        ///< all of the path
  coastal_land,  ///< all of it: up to 100 m high, within 50 km of the sea
  sea            ///< all of it
};
constexpr auto namesOf(ClearAirZone) {
  return std::array{"by_height", "inland", "coastal_land", "sea"};
}

/// Settings that p1812 and p452 have in common.
struct ClearAirSettings {
  double time_percent = 50;             ///< the loss is not exceeded in this percentage of the time
  double refractivity_lapse_rate = 40;  ///< of the refractivity through the lowest km (Delta N), positive
  ClearAirZone zone = ClearAirZone::by_height;
  double clutter_height_m = 0;  ///< of buildings and trees on land along the path
};

struct P1812Settings : ClearAirSettings {
  double location_percent = 50;   ///< the loss is not exceeded in this percentage of locations
  double location_width_m = 100;  ///< width of the square of the locations
};

struct P452Settings : ClearAirSettings {
  /// Antenna gains toward the horizons, for the coupling into troposcatter.
  double transmitter_gain_dbi = 0, receiver_gain_dbi = 0;
};

/// Value that parabolic_equation stores for a cell of range and height.
enum class PeCells {
  mean,  ///< the mean power
  point  ///< the field at one point: lobes smaller than cells alias
};
constexpr auto namesOf(PeCells) {
  return std::array{"mean", "point"};
}

/// Source of the field at the start of parabolic_equation's march.
enum class PeRadiator {
  isotropic,  ///< one march for all patterns, which are applied along the direct ray
  pattern     ///< the antenna's elevation cut, so that each ray is weighted by its own angle
};
constexpr auto namesOf(PeRadiator) {
  return std::array{"isotropic", "pattern"};
}

/// A number of 0 is chosen by the model.
struct ParabolicEquationSettings {
  double max_angle_deg = 0;  ///< largest angle from the horizontal for which the equation is solved
  double top_m = 0;          ///< height above the ground up to which the equation is solved
  double range_step_m = 0;
  double azimuths = 0;  ///< around the emitter
  PeRadiator source = PeRadiator::isotropic;
  RoughnessModel roughness = RoughnessModel::miller_brown;
  double floor_db = -80;  ///< of the propagation factor; the equation's field is not read below it
  PeCells cells = PeCells::mean;
};

/// The model of an emitter, and the settings of all models; settings of models that are not used have no
/// effect.
struct ModelSettings {
  PropagationModel model = PropagationModel::diffraction;
  DiffractionSettings diffraction;
  TwoRaySettings two_ray;
  ItmSettings itm;
  P528Settings p528;
  P1812Settings p1812;
  P452Settings p452;
  ParabolicEquationSettings parabolic_equation;
  SourceLocation location;  ///< of the chosen model's settings
};

enum class GroundKind { sea, fresh_water, wet_ground, average_ground, dry_ground, concrete };
constexpr auto namesOf(GroundKind) {
  return std::array{"sea", "fresh_water", "wet_ground", "average_ground", "dry_ground", "concrete"};
}

/// Loss by trees and buildings around the ends of paths, where no map of them is given.
enum class TerminalClutterModel { none, p2108 };
constexpr auto namesOf(TerminalClutterModel) {
  return std::array{"none", "p2108"};
}

/// How the loss at the ends joins a model's.
enum class ClutterCombination { sum, larger };
constexpr auto namesOf(ClutterCombination) {
  return std::array{"sum", "larger"};
}

/// The ground: its electrical properties, and what stands on it.
struct Ground {
  GroundKind kind = GroundKind::average_ground;
  std::optional<double> relative_permittivity;  ///< none: that of the kind
  std::optional<double> conductivity_s_m;
  double roughness_m = 0;  ///< standard deviation of the surface's height
  /// Height of the smooth surface of models without terrain; none: that of the ground below each emitter.
  std::optional<double> surface_msl_m;
  /// True: the earth of `diffraction` is sea where the terrain is at or below mean sea level.
  bool sea_by_height = false;
  TerminalClutterModel terminal_clutter = TerminalClutterModel::none;
  double terminal_clutter_percent = 50;  ///< of locations in which the loss is not exceeded
  double terminal_clutter_below_m = 10;  ///< ends up to this height above the ground are within the clutter
  ClutterCombination terminal_clutter_combine = ClutterCombination::sum;
  SourceLocation location;
};

/// Selects the emitters whose paths include the attenuation by oxygen and water vapour.
enum class GasLosses {
  automatic,  ///< all whose model is not a lower bound of the loss: all except free_space and horizon
  always,
  never
};
constexpr auto namesOf(GasLosses) {
  return std::array{"auto", "always", "never"};
}

/// Climates of the models that have statistics.
enum class RadioClimate {
  equatorial,
  continental_subtropical,
  maritime_subtropical,
  desert,
  continental_temperate,
  maritime_temperate_over_land,
  maritime_temperate_over_sea
};
constexpr auto namesOf(RadioClimate) {
  return std::array{"equatorial",
                    "continental_subtropical",
                    "maritime_subtropical",
                    "desert",
                    "continental_temperate",
                    "maritime_temperate_over_land",
                    "maritime_temperate_over_sea"};
}

/// Refractivity over height.
enum class RefractionProfile {
  linear,      ///< rays are straight over an earth of k_factor times its radius
  exponential  ///< the CRPL exponential reference atmosphere of sea_level_refractivity
};
constexpr auto namesOf(RefractionProfile) {
  return std::array{"linear", "exponential"};
}

struct Refractivity;  // propagation/parabolic_equation/air/refractivity_field.h

/// The atmosphere.
struct Atmosphere {
  double k_factor = 4.0 / 3.0;  ///< effective earth radius over earth radius
  double pressure_hpa = 1013.25;
  double temperature_k = 288.15;
  double vapour_g_m3 = 7.5;
  double rain_mm_h = 0;
  std::optional<double> rain_height_m;  ///< above mean sea level, upper limit of the rain; none: by latitude
  GasLosses gases = GasLosses::automatic;
  RefractionProfile refraction = RefractionProfile::linear;
  double sea_level_refractivity = 301;  ///< N-units; itm derives the curvature of rays from it
  RadioClimate climate = RadioClimate::continental_temperate;
  /// Profiles of refractivity, for parabolic_equation; null: the gradient of k_factor.
  std::shared_ptr<const Refractivity> refractivity;
};

}  // namespace emscape::propagation
