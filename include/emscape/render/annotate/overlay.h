/// The finished picture: the cast image on a background, with box, axes, markers, legend, time and compass.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/enum_names.h"
#include "emscape/base/units.h"
#include "emscape/render/annotate/legend.h"
#include "emscape/render/picture/device_picture.h"
#include "emscape/render/picture/image.h"
#include "emscape/render/scene/camera.h"
#include "emscape/render/scene/cut_plane.h"

namespace emscape::render {

/// Symbol of a marker.
enum class MarkerKind { radar, transmitter, jammer, receiver, platform };

/// Side of a marker; none: the symbol has the colour of its kind and no frame.
enum class Affiliation { none, friendly, hostile, neutral, unknown };

/// An object with a position and a name.
struct Marker {
  Vec3d position_m;  ///< frame metres
  std::string label;
  std::string detail;  ///< a second line of the label, small, and the height after it; both may be empty
  std::optional<double> height_m;       ///< in the second line, in the picture's units
  bool is_height_above_ground = false;  ///< false: above sea
  MarkerKind kind = MarkerKind::platform;
  Affiliation side = Affiliation::none;
  std::string sidc;                ///< MIL-STD-2525D or APP-6D, of its icon; empty: that of its kind
  bool moves = false;              ///< labels of fixed objects keep their places beside moving ones
  bool is_shown = true;            ///< false: neither drawn nor under the mouse
  bool active = true;              ///< false: drawn hollow
  std::optional<Vec3d> beam;       ///< unit vector east, north, up of the beam's axis (not exaggerated)
  std::optional<double> ground_m;  ///< height of the ground below it (frame z), at which the stem ends
};

/// The track of a moving object.
struct Track {
  MarkerKind kind = MarkerKind::platform;
  std::vector<Vec3d> points_m;  ///< frame metres, in the order of time
  std::vector<double> times_s;  ///< of the points; empty: unknown
  /// Current position: 2.5 is half way from points_m[2] to points_m[3]. The part before it is drawn brighter.
  double travelled = 0;
  Affiliation side = Affiliation::none;
};

/// Kind of a line on the ground.
enum class GroundInk { graticule, coast, ring, place };

/// A line on the ground, or the edge of an area.
struct GroundLine {
  GroundInk ink = GroundInk::place;
  std::vector<Vec3d> points_m;  ///< frame metres, on the ground
  std::string label;     ///< of graticules and rings at the point nearest to the viewer, else in the middle
  bool is_area = false;  ///< filled; the last point is joined to the first
};

/// A named point on the ground.
struct GroundPoint {
  Vec3d position_m;
  std::string label;
};

enum class Theme { dark, light };
constexpr auto namesOf(Theme) {
  return std::array{"dark", "light"};
}
/// "dark" or "light". @throws Error (usage)
Theme parseTheme(const std::string& name);

/// Texts and markers of a picture. Empty texts are left out.
struct Annotations {
  std::string title;     ///< the scenario
  std::string subtitle;  ///< for example the quantity or the combination
  std::string time;      ///< "t = 12.5 s"
  std::string time_utc;
  std::string note;  ///< small, at the bottom: rays, step
  std::vector<Marker> markers;
  std::vector<Track> tracks;
  std::vector<CutPlane> planes;  ///< framed, with captions
  std::vector<GroundLine> ground_lines;
  std::vector<GroundPoint> ground_points;
  std::vector<Category> ground_classes;  ///< names and colours of the classes on the ground
  std::optional<Legend> legend;
  bool reserves_legend = false;  ///< without a legend its room stays free, so that the scene does not move
  bool georeferenced = true;     ///< compass, axes in km and altitude; otherwise axes in the grid's unit
  bool axes = true;
  /// Columns of the picture that are seen of it (joinParts()): symbols in others are left out, and labels
  /// stay between them. No end: all.
  int first_column = 0;
  std::optional<int> end_column;
  /// Position of the frame's origin, from which the axes count: "84.15000°W" and "36.30000°N"; may be empty.
  std::string origin_longitude, origin_latitude;
  bool compass = true;     ///< of georeferenced pictures
  bool scale_bar = false;  ///< the same
  Units units = Units::metric;
  Theme theme = Theme::dark;
  /// Minimum size of texts and symbols: 1 is that of a picture of 1200 x 900, 0 follows the picture's size.
  /// Limited in small pictures.
  double scale = 0;
};

/// Margins that the annotations need. Pass them to makeCamera(), so that annotations do not cover the box.
FrameMargins overlayMargins(ImageSize size, const Annotations& annotations);

/// A rectangle of a picture, from its upper left corner.
struct PixelArea {
  double x = 0, y = 0, width = 0, height = 0;
};
/// The heading of the legend: quantity and unit. The annotations must have a legend.
PixelArea legendHeading(ImageSize size, const Annotations& annotations);

/// Whether the ground hides a position (frame metres); empty: nothing is hidden.
using HiddenTest = std::function<bool(const Vec3d& frame_m)>;

/// Draws both layers. The cast image over `behind`, and `front` over both, gives the picture of compose(),
/// with a difference of at most two levels because each layer is rounded.
/// @param layers  its memory is reused
void drawLayers(OverlayLayers& layers, ImageSize size, const Camera& camera, const SceneBox& box,
                const Annotations& annotations, const HiddenTest& hidden = {});

/// Draws the finished, opaque picture.
Image8 compose(const Image& cast, const Camera& camera, const SceneBox& box, const Annotations& annotations,
               const HiddenTest& hidden = {});

/// The same for a quantised picture; differs from the above by at most one level.
Image8 compose(const Image8& cast, const Camera& camera, const SceneBox& box, const Annotations& annotations,
               const HiddenTest& hidden = {});

/// Replaces the columns of a finished picture before `column` by those of another one of the same size, and
/// draws a line between them, with captions of both parts above.
void joinParts(const Image8& left, int column, const std::array<std::string, 2>& captions,
               const Annotations& annotations, Image8& picture);

}  // namespace emscape::render
