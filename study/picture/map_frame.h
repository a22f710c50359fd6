/// What a map's picture has around and above its colours: outline of the area, graticule, scale bar, north
/// arrow, coast.
#pragma once

#include <string>
#include <vector>

#include "emscape/base/units.h"
#include "render/annotate/overlay_parts.h"
#include "study/picture/map_plane.h"

namespace emscape::study {

class MapFrame {
 public:
  /// @param frame  of the map in the picture (pixels)
  MapFrame(const MapGrid& grid, const render::Rect& frame, const render::Style& style);

  const render::Rect& rect() const { return frame_; }
  /// The point of the picture at a point of the plane.
  render::Point2 at(const PlanePoint& point) const;
  /// The points of the picture of positions; NaN without an image.
  std::vector<render::Point2> at(const std::vector<GeoPoint>& positions) const;

  /// Covers what the pixels show outside the area, and draws the frame.
  void drawOutline(render::Canvas& canvas) const;
  /// Meridians and parallels, with their degrees below and left of the frame.
  void drawGraticule(render::Canvas& canvas) const;
  /// A line, limited to the frame.
  void drawLine(render::Canvas& canvas, const std::vector<render::Point2>& points, const render::Ink& ink,
                double width) const;
  /// Scale bar, north arrow and a remark, below the frame.
  void drawFoot(render::Canvas& canvas, Units units, const std::string& remark) const;

  /// Height needed below the frame (pixels).
  static double footHeight(const render::Style& style) { return 98 * style.unit; }

 private:
  double pixelsPerMetre() const { return frame_.width / (grid_.width * grid_.cell_m); }
  /// @return the bar's left end
  double drawScaleBar(render::Canvas& canvas, double right, double y, double metres_per_metre,
                      Units units) const;
  void drawNorthArrow(render::Canvas& canvas, const render::Point2& center, double north_rad) const;

  const MapGrid& grid_;
  MapPlane plane_;
  render::Rect frame_;
  const render::Style& style_;
};

}  // namespace emscape::study
