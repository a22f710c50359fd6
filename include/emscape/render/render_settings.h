/// How a volume is shown.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "emscape/render/cut_plane.h"

namespace emscape::render {

/// How the samples of a ray become a pixel.
enum class CompositingMode { dvr, mida, mip, iso };
const char* toString(CompositingMode mode);
/// @throws Error (usage) that lists the names
CompositingMode parseCompositingMode(const std::string& name);

/// Limits of a setting, both of them allowed.
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

/// Each number is within its SettingLimits.
struct RenderSettings {
  CompositingMode mode = CompositingMode::dvr;
  double step_voxels = 1;  ///< between samples, in voxels along the ray
  double mida_gamma = 0;   ///< -1 (DVR) .. 0 (MIDA) .. 1 (MIP)
  bool exact = false;      ///< true: no early termination
  bool shading = false;    ///< light on the fog of DVR and MIDA; isosurfaces always have it
  /// Value of the isosurface; NaN: the middle of the transfer function's interval
  double iso_value = std::numeric_limits<double>::quiet_NaN();
  double iso_opacity = 1;
  bool skip_empty = true;  ///< skip bricks that cannot change the picture; the picture is the same either way
  bool plain = false;      ///< the reference form of the ray caster; slow, for comparison
  double vertical_exaggeration = 0;  ///< 0: niceVerticalExaggeration()
  std::vector<CutPlane> planes;      ///< that cut the volume open; at most kMaxCutPlanes
};

}  // namespace emscape::render
