/// Settings of volume rendering.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/enum_names.h"
#include "emscape/render/scene/cut_plane.h"

namespace emscape::render {

using emscape::toString;

/// Method that combines the samples of a ray into a pixel.
enum class CompositingMode { dvr, mida, mip, iso };
constexpr auto namesOf(CompositingMode) {
  return std::array{"dvr", "mida", "mip", "iso"};
}
/// @throws Error (usage) that lists the names
CompositingMode parseCompositingMode(const std::string& name);

/// Limits of a setting, inclusive.
struct SettingLimits {
  const char* name;
  double min, max;

  /// @throws Error (bad_input) with the name, the value and the limits
  void require(double value) const;
};
inline constexpr SettingLimits kStepLimits{"step_voxels", 0.05, 10};
inline constexpr SettingLimits kMidaGammaLimits{"mida_gamma", -1, 1};
inline constexpr SettingLimits kIsoOpacityLimits{"iso_opacity", 0, 1};
inline constexpr SettingLimits kExaggerationLimits{"vertical_exaggeration", 0, 100};
inline constexpr SettingLimits kMapHeightLimits{"map_layer", 0, 100000};
inline constexpr SettingLimits kMapOpacityLimits{"map_opacity", 0, 1};

/// Settings of volume rendering; each number must be within its SettingLimits.
struct RenderSettings {
  CompositingMode mode = CompositingMode::dvr;
  double step_voxels = 1;  ///< sampling distance along the ray (voxels)
  double mida_gamma = 0;   ///< -1 (DVR) .. 0 (MIDA) .. 1 (MIP)
  bool exact = false;      ///< true: no early termination
  bool shading = false;    ///< shading of DVR and MIDA by the gradient; isosurfaces are always shaded
  /// Value of the isosurface; NaN: the centre of the transfer function's interval
  double iso_value = std::numeric_limits<double>::quiet_NaN();
  double iso_opacity = 1;
  bool skip_empty = true;            ///< skip bricks without visible values; does not change the picture
  bool plain = false;                ///< scalar reference form of the ray caster; slow, for comparison
  double vertical_exaggeration = 0;  ///< 0: niceVerticalExaggeration()
  std::vector<CutPlane> planes;      ///< cut planes, at most kMaxCutPlanes
  /// The map layer: the values at this height above the ground (m), painted on the ground; none: no layer
  std::optional<double> map_height_agl_m;
  double map_opacity = 0.8;
};

}  // namespace emscape::render
