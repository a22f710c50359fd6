/// The parts of a finished picture's annotations; internal to this library.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "emscape/render/annotate/overlay.h"
#include "render/annotate/canvas.h"

namespace emscape::render {

/// Sizes and colours of a picture's annotations.
struct Style {
  double unit = 1;  ///< pixels per unit of length at 1200 x 900
  double text_px = 15;
  double small_px = 12.5;
  double name_px = 400;   ///< maximum width of names in the legend; longer ones are shortened
  double label_px = 200;  ///< maximum width of labels
  Rgb background_top, background_bottom;
  Rgb text, muted, rim;

  /// @param scale  as Annotations::scale
  Style(ImageSize size, Theme theme, double scale = 0);
  Ink textInk(double alpha = 1) const { return {text, alpha}; }
  Ink mutedInk(double alpha = 1) const { return {muted, alpha}; }
  Ink rimInk(double alpha = 0.75) const { return {rim, alpha}; }
};

/// Projects frame metres to points of the picture.
struct Projector {
  const Camera& camera;
  const SceneBox& box;
  ImageSize size;

  /// @return true if the position is in front of the camera
  bool project(const Vec3d& frame_m, Point2& point) const;
};

/// Edges of the box behind the volume, drawn first.
void drawFarEdges(Canvas& canvas, const Style& style, const Projector& projector);
/// The other edges, ticks and axis titles. Adds the boxes of all texts to `taken`.
void drawNearEdges(Canvas& canvas, const Style& style, const Projector& projector,
                   const Annotations& annotations, std::vector<Rect>& taken);
/// Height of the two lines of text at the top, with their distance from the picture's edge (pixels).
double headerHeight(const Style& style);
/// Width of the legend's column, with its distance from the picture's edge (pixels).
double legendWidth(const Style& style, const Legend& legend);
/// Minimum height of a picture with room for all entries of a categorical legend; 0 for other legends.
double legendHeight(const Style& style, const Legend& legend);
void drawLegend(Canvas& canvas, const Style& style, const Legend& legend);
/// The classes on the ground at the left, below the header; those without room are counted. Adds their box to
/// `taken`. @param bottom  end of the room (pixels)
void drawGroundClasses(Canvas& canvas, const Style& style, const std::vector<Category>& classes,
                       double bottom, std::vector<Rect>& taken);
/// Frames of the planes that are on, and their captions. Adds the boxes of the captions to `taken`.
void drawPlanes(Canvas& canvas, const Style& style, const Projector& projector,
                const Annotations& annotations, std::vector<Rect>& taken);
/// Tracks, within the sides of the box and above its bottom face.
void drawTracks(Canvas& canvas, const Style& style, const Projector& projector,
                const std::vector<Track>& tracks, const HiddenTest& hidden);
/// Stems, beams, symbols and labels. Labels avoid `taken`, as many as fit.
void drawMarkers(Canvas& canvas, const Style& style, const Projector& projector,
                 const std::vector<Marker>& markers, Units units, const HiddenTest& hidden,
                 const std::vector<Rect>& taken);
/// The point of the picture at a position; none if it is behind the camera.
using GroundProjection = std::function<std::optional<Point2>(const Vec3d&)>;

/// Lines and points on the ground, where it does not hide them. Labels avoid `taken` and `symbols`, which are
/// drawn later; those that find no room are left out.
void drawGroundMarks(Canvas& canvas, const Style& style, const GroundProjection& project,
                     const std::vector<GroundLine>& lines, const std::vector<GroundPoint>& points,
                     const std::vector<Point2>& symbols, const HiddenTest& hidden, std::vector<Rect>& taken);
/// A bar of a round length, as it is in the middle of the ground. @param left  its left end
void drawScaleBar(Canvas& canvas, const Style& style, const Projector& projector, Units units,
                  const Point2& left, std::vector<Rect>& taken);
/// Colour of a symbol and of its parts.
Rgb colorOf(MarkerKind kind);
/// Radar: disc with a dish's arc; transmitter: triangle; jammer: diamond; receiver: square; platform: small
/// disc.
/// @param is_active  false: hollow  @param radius  pixels
void drawSymbol(Canvas& canvas, MarkerKind kind, bool is_active, const Point2& at, double radius,
                double alpha = 1);
/// The symbol of a marker, with a frame if it has a side. @param radius  of one without a side (pixels)
void drawMark(Canvas& canvas, const Marker& marker, const Point2& at, double radius, double alpha = 1);
/// Size of that symbol; 1 is about a radius.
double symbolSize(const Marker& marker);
/// Colour of stems, beams and tracks: that of the side, else of the kind.
Rgb colorOf(MarkerKind kind, Affiliation side);
/// A compass rose on the ground in the camera's perspective, centred at a point.
void drawCompass(Canvas& canvas, const Style& style, const Camera& camera, const Point2& center,
                 double radius);

}  // namespace emscape::render
