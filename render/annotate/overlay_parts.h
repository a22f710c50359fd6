/// The parts of a finished picture's annotations; internal to this library.
#pragma once

#include <vector>

#include "emscape/render/annotate/overlay.h"
#include "render/annotate/canvas.h"

namespace emscape::render {

/// Sizes and colours of a picture's annotations.
struct Style {
  double unit = 1;  ///< pixels that a length of one at 1200 x 900 takes
  double text_px = 15;
  double small_px = 12.5;
  Rgb background_top, background_bottom;
  Rgb text, muted, rim;

  Style(ImageSize size, Theme theme);
  Ink textInk(double alpha = 1) const { return {text, alpha}; }
  Ink mutedInk(double alpha = 1) const { return {muted, alpha}; }
  Ink rimInk(double alpha = 0.75) const { return {rim, alpha}; }
};

/// Projects frame metres to points of the picture.
struct Projector {
  const Camera& camera;
  const SceneBox& box;
  ImageSize size;

  /// @return whether the position lies before the camera
  bool project(const Vec3d& frame_m, Point2& point) const;
};

/// Edges of the box behind the volume, drawn before it.
void drawFarEdges(Canvas& canvas, const Style& style, const Projector& projector);
/// The other edges, ticks and axis titles. Adds the boxes of all texts to `taken`.
void drawNearEdges(Canvas& canvas, const Style& style, const Projector& projector,
                   const Annotations& annotations, std::vector<Rect>& taken);
/// Height of the two lines of text at the top, with their distance from the picture's edge (pixels).
double headerHeight(const Style& style);
/// Width of the column that a legend takes, with its distance from the picture's edge (pixels).
double legendWidth(const Style& style, const Legend& legend);
/// Height of a picture that has room for all entries of a categorical legend; 0 for others, which fit any.
double legendHeight(const Style& style, const Legend& legend);
void drawLegend(Canvas& canvas, const Style& style, const Legend& legend);
/// Ways, as far as they lie above the box's bottom face and within its sides.
void drawTracks(Canvas& canvas, const Style& style, const Projector& projector,
                const std::vector<Track>& tracks, const HiddenTest& hidden);
/// Stems, beams, symbols and names. Names avoid `taken`.
void drawMarkers(Canvas& canvas, const Style& style, const Projector& projector,
                 const std::vector<Marker>& markers, const HiddenTest& hidden, std::vector<Rect>& taken);
/// Colour of a symbol and of what belongs to it.
Rgb colorOf(MarkerKind kind);
/// A compass rose lying on the ground as the camera sees it, centred at a point.
void drawCompass(Canvas& canvas, const Style& style, const Camera& camera, const Point2& center,
                 double radius);

}  // namespace emscape::render
