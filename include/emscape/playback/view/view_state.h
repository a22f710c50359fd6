/// The record of a picture: what is shown, and how. Command line, window, view files and bindings use it.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "emscape/playback/frames/frame_source.h"
#include "emscape/render/annotate/overlay.h"
#include "emscape/render/cells/cell_renderer.h"
#include "emscape/render/picture/image.h"
#include "emscape/render/scene/camera.h"
#include "emscape/render/scene/frame.h"
#include "emscape/render/scene/render_settings.h"
#include "emscape/render/transfer/transfer_function.h"
#include "emscape/scenario/model/emitter.h"

namespace emscape::playback {

/// How fields on tetrahedra are drawn.
enum class CellMethod {
  automatic,  ///< complete pictures are marched; others are projected if the CPU marches and OpenGL has a
              ///< GPU
  march,      ///< CellRenderer::render()
  project     ///< CellRenderer::project(); pictures that are not complete by centroids
};
constexpr auto namesOf(CellMethod) {
  return std::array{"auto", "march", "project"};
}
/// @throws Error (usage) that lists the names
CellMethod parseCellMethod(const std::string& name);

struct CellStyle {
  CellMethod method = CellMethod::automatic;
  render::ProjectionOptions projection;
};

/// Labels of emitters and platforms.
enum class Labels {
  off,
  names,
  all  ///< also kind, frequency and height
};
constexpr auto namesOf(Labels) {
  return std::array{"off", "names", "all"};
}

/// How the camera follows a platform.
enum class FollowMode {
  follow,  ///< an orbit about the platform
  chase    ///< the same, with the bearing of the camera counted from the platform's heading: 180 is behind it
};
constexpr auto namesOf(FollowMode) {
  return std::array{"follow", "chase"};
}

/// Cameras of the pictures of a series.
enum class CameraPath {
  fixed,     ///< ViewState::camera
  bookmarks  ///< from one bookmark to the next
};
constexpr auto namesOf(CameraPath) {
  return std::array{"fixed", "bookmarks"};
}

/// Sides of the emitters and platforms that are drawn.
enum class ShownSides { all, friendly, hostile, neutral, unknown };
constexpr auto namesOf(ShownSides) {
  return std::array{"all", "friend", "hostile", "neutral", "unknown"};
}

/// Whether something is drawn; automatic: where it helps.
enum class Shown { automatic, on, off };
constexpr auto namesOf(Shown) {
  return std::array{"auto", "on", "off"};
}

/// Circles on the ground about an emitter.
struct RangeRings {
  std::string emitter;
  double spacing_m = 10000;  ///< > 0
  int count = 0;             ///< 0: up to the edge of the volume
};
/// Parses "EMITTER:spacing_m=..[,count=..]". @throws Error (usage)
RangeRings parseRangeRings(const std::string& text);
/// parseRangeRings() reads it back exactly.
std::string toString(const RangeRings& rings);

/// A stored camera, and a time if that is stored too.
struct Bookmark {
  std::string name;
  render::CameraSpec camera;
  std::optional<double> time_s;
};

/// A view of a field, and the settings of playback. playback/view/view_settings.h has a row for each setting.
struct ViewState : FieldChoice {
  render::CameraSpec camera;
  /// Fitted, if there is none: to `range` if that is given, else to the first volume. Categories have their
  /// own colours.
  std::optional<render::TransferFunction> transfer;
  /// File of the transfer function, instead of `transfer`; may be empty.
  std::string transfer_file;
  render::RenderSettings settings;  ///< without skip_empty and plain, which are not stored
  CellStyle cells;
  render::Theme theme = render::Theme::dark;
  bool show_terrain = true;
  bool show_emitters = true;
  Labels labels = Labels::names;
  ShownSides sides = ShownSides::all;
  double label_scale = 0;  ///< as render::Annotations::scale
  /// Coasts of GSHHG, if it is installed; automatic: where no terrain is a sea by its heights.
  Shown coast = Shown::automatic;
  /// Lines of latitude and longitude; automatic: on the smooth earth.
  Shown graticule = Shown::automatic;
  bool show_compass = true;
  bool show_scale_bar = false;
  std::vector<RangeRings> range_rings;
  std::vector<std::string> places;  ///< vector files of named points, lines and areas
  std::string drape;                ///< picture on the ground: GeoTIFF or MBTiles; may be empty
  Units units = Units::metric;
  FieldUnit field_unit = FieldUnit::stored;
  PositionFormat positions = PositionFormat::decimal;
  render::ImageSize size{1280, 720};
  /// Pixels that are cast while the picture changes; none: as many as time allows.
  std::optional<render::Pattern> pattern;

  std::string follow;  ///< platform at which the camera looks, as it moves; empty: none
  FollowMode follow_mode = FollowMode::follow;
  double trail_s = 0;  ///< length of the tracks behind moving platforms; 0: whole tracks
  CameraPath camera_path = CameraPath::fixed;
  bool film_speed = true;  ///< videos state their speed

  /// Since the scenario's epoch; NaN: FrameSource::firstTime_s().
  double time_s = std::numeric_limits<double>::quiet_NaN();
  /// A UTC time of the input's clock, in place of `time_s`; may be empty.
  std::string time_utc;
  double rate = 1;  ///< scenario seconds per second; negative: backwards
  bool loop = false;
  std::optional<scenario::TimeInterval> play_range;    ///< range of playing; none: all steps
  std::optional<scenario::TimeInterval> visible_time;  ///< range of the time line; none: all steps
  std::vector<Bookmark> bookmarks;
  std::vector<std::string> open_panels;  ///< of the window
};

/// Removes the values in the unit of the quantity: colours, range and isosurface.
void dropColors(ViewState& view);
/// Changes the quantity or channel of a view, with dropColors() if it is another one.
void changeQuantity(ViewState& view, const std::string& quantity);
/// Changes the reference of a comparison (FieldChoice::compare), with dropColors() if a difference is shown
/// instead of fields or the other way round.
void changeComparison(ViewState& view, const std::string& compare);
/// The same for the part of the picture with the reference (FieldChoice::split), which is the original if
/// there is none.
void changeSplit(ViewState& view, double split);
/// Fits the colours to a range; this replaces a transfer function.
void changeRange(ViewState& view, const ValueRange& range);
/// Sets what view files do not contain to that of another view: its input and how that is drawn.
void setInput(ViewState& view, const ViewState& opened);

}  // namespace emscape::playback
