/// The models that have an excess loss per column, with the interface for the field.
///
/// A model is a plain struct with
///     static constexpr bool kNeedsTerrain;  // true: it reads the column's profile
///     static constexpr bool kInParts;       // true: it has begin() and fill()
///     EMSCAPE_HD unsigned operator()(const ExcessColumn&, const ExcessScratch&, float* excess_db) const;
/// which fills the excess (dB) of a column's voxels and returns warnings (bits). It runs on host and device.
/// On a device with more threads than columns that fit into its memory, begin() runs once per column, and
/// fill(), which also takes a ColumnPart, in several threads per column, each for some of its heights.
/// begin() returns 0, or kMissingTerrain with NaN for every voxel; then there is nothing to fill. The member
/// `tables` (const float*), if there is one, points to the model's tables, on the host or on the device. A
/// model with a reflected ray, whose row of the registry says so, also has
///     static constexpr bool kReflects = true;
///     EMSCAPE_HD ReflectedRay reflectedRay(double range_m, float height_msl_m, float& excess_db) const;
/// for one voxel, which returns the ray and the excess between isotropic antennas. A model whose row says
/// on_effective_earth has
///     static constexpr bool kOnEffectiveEarth = true;
/// A model whose profiles have posts where the path crosses the lines between the posts of the elevation
/// model (readsCrossings() in model_info.h) has
///     static constexpr bool kReadsCrossings = true;
/// A model whose row names several mechanisms has
///     static constexpr bool kHasMechanisms = true;
/// and a last parameter (const MechanismStore&), which receives the mechanism of each height; also for
/// fill().
#pragma once

#include <type_traits>
#include <variant>

#include "propagation/diffraction/edge_excess.h"
#include "propagation/diffraction/excess.h"
#include "propagation/free_space/excess.h"
#include "propagation/itm/excess.h"
#include "propagation/p1812/excess.h"
#include "propagation/p452/excess.h"
#include "propagation/p528/excess.h"
#include "propagation/parabolic_equation/excess.h"
#include "propagation/two_ray/excess.h"

namespace emscape::propagation {

using ExcessModel = std::variant<NoExcess, DiffractionExcess, EdgeExcess, TwoRayExcess, ItmExcess, P528Excess,
                                 P1812Excess, P452Excess, PeExcess>;

/// True for models with a reflected ray.
template <class Model, class = void>
struct Reflects : std::false_type {};
template <class Model>
struct Reflects<Model, std::void_t<decltype(Model::kReflects)>> : std::true_type {};

/// True for models whose rays are straight over the effective earth, and whose heights are on it.
template <class Model, class = void>
struct OnEffectiveEarth : std::false_type {};
template <class Model>
struct OnEffectiveEarth<Model, std::void_t<decltype(Model::kOnEffectiveEarth)>> : std::true_type {};

/// True for models whose profiles have posts at crossings.
template <class Model, class = void>
struct ReadsCrossings : std::false_type {};
template <class Model>
struct ReadsCrossings<Model, std::void_t<decltype(Model::kReadsCrossings)>> : std::true_type {};

/// True for models with several mechanisms.
template <class Model, class = void>
struct HasMechanisms : std::false_type {};
template <class Model>
struct HasMechanisms<Model, std::void_t<decltype(Model::kHasMechanisms)>> : std::true_type {};

}  // namespace emscape::propagation
