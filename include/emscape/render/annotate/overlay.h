/// The finished picture: what was cast, on a background, with box, axes, markers, legend, time and compass.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emscape/render/annotate/legend.h"
#include "emscape/render/camera.h"
#include "emscape/render/device_picture.h"
#include "emscape/render/image.h"

namespace emscape::render {

/// How a marker looks.
enum class MarkerKind { radar, transmitter, jammer, receiver, platform };

/// Something with a place and a name.
struct Marker {
  Vec3d position_m;  ///< frame metres
  std::string label;
  MarkerKind kind = MarkerKind::platform;
  bool active = true;              ///< false: drawn hollow
  std::optional<Vec3d> beam;       ///< unit vector east, north, up of the beam's axis (not exaggerated)
  std::optional<double> ground_m;  ///< height of the ground below it (frame z): where the stem ends
};

/// The way of something that moves.
struct Track {
  MarkerKind kind = MarkerKind::platform;
  std::vector<Vec3d> points_m;  ///< frame metres, in the order of time
  /// How far it has come: 2.5 is half way from points_m[2] to points_m[3]. The part behind it is
  /// drawn brighter.
  double travelled = 0;
};

enum class Theme { dark, light };
/// "dark" or "light". @throws Error (usage)
Theme parseTheme(const std::string& name);

/// What is written on and around a picture. Empty texts are left out.
struct Annotations {
  std::string title;     ///< the scenario
  std::string subtitle;  ///< for example the quantity, or what is combined
  std::string time;      ///< "t = 12.5 s"
  std::string time_utc;
  std::string note;  ///< small, at the bottom: rays, step
  std::vector<Marker> markers;
  std::vector<Track> tracks;
  std::optional<Legend> legend;
  bool georeferenced = true;  ///< compass, axes in km and altitude; otherwise axes in the grid's unit
  bool axes = true;
  Theme theme = Theme::dark;
};

/// Space that annotations take from a picture: give it to makeCamera() so that they do not cover the
/// box.
FrameMargins overlayMargins(ImageSize size, const Annotations& annotations);

/// Whether the ground hides a position (frame metres); empty: nothing is hidden.
using HiddenTest = std::function<bool(const Vec3d& frame_m)>;

/// Draws both layers. What is cast put over `behind`, and `front` over that, is the picture of compose(); at
/// most two levels apart, as each layer is rounded.
/// @param layers  its memory is used again
void drawLayers(OverlayLayers& layers, ImageSize size, const Camera& camera, const SceneBox& box,
                const Annotations& annotations, const HiddenTest& hidden = {});

/// Draws the finished, opaque picture.
Image8 compose(const Image& cast, const Camera& camera, const SceneBox& box, const Annotations& annotations,
               const HiddenTest& hidden = {});

/// The same of a picture that is quantised already; differs from the above by at most one level.
Image8 compose(const Image8& cast, const Camera& camera, const SceneBox& box, const Annotations& annotations,
               const HiddenTest& hidden = {});

}  // namespace emscape::render
