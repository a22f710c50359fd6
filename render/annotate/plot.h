/// Lines in axes, and files of plots.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "render/annotate/canvas.h"

namespace emscape::render {

constexpr Ink kPlotPaper{{1.0F, 1.0F, 1.0F}};
constexpr Ink kPlotText{{0.13F, 0.15F, 0.18F}};
constexpr Ink kPlotFaintText{{0.40F, 0.43F, 0.47F}};
constexpr Ink kPlotGrid{{0.45F, 0.50F, 0.58F}, 0.28};
constexpr Ink kPlotGround{{0.62F, 0.56F, 0.45F}};
constexpr Ink kPlotSurface{{0.36F, 0.31F, 0.22F}};
/// Okabe and Ito's colours, which are distinguishable with colour blindness; indices beyond them repeat.
const Ink& plotInk(std::size_t index);

struct PlotTick {
  double at = 0;
  std::string text;
};

struct PlotAxis {
  double lowest = 0, highest = 1;    ///< lowest < highest
  int ticks = 8;                     ///< approximate number, at round values
  std::string title;                 ///< with the unit; empty: none
  std::vector<PlotTick> marks = {};  ///< instead of round values, for scales that are not linear
};

/// Of times (s); a single one is in the middle of a second.
PlotAxis timeAxis(double begin_s, double end_s);

struct PlotLine {
  struct Point {
    double x, y;            ///< y infinite or NaN: a gap
    bool is_strong = true;  ///< drawn wide
  };
  std::string name;  ///< empty: not listed among the names
  std::vector<Point> points;
  Ink ink;
  bool is_dashed = false;
};

/// A frame with axes. The caller draws its parts in the desired order.
class PlotPanel {
 public:
  /// @param unit  pixels per pixel of a 1400 x 800 picture
  PlotPanel(Canvas& canvas, const Rect& frame, double unit, const PlotAxis& x, const PlotAxis& y)
      : canvas_(canvas), frame_(frame), unit_(unit), x_(x), y_(y) {}

  const Rect& frame() const { return frame_; }
  /// Position of a point in the picture; y is limited to its axis.
  Point2 at(double x, double y) const;

  void drawTitle(const std::string& title);
  /// Lines at round values, their numbers, and the titles of the axes.
  void drawGrid();
  /// A band over the whole height.
  void drawBand(double x_begin, double x_end, const Ink& ink) const;
  /// Points without a neighbour are discs.
  void drawLine(const PlotLine& line);
  /// The ground below a line of heights, in pieces with gaps where a height is NaN.
  /// @param heights  x, y on the axes
  void drawGround(const std::vector<Point2>& heights) const;
  /// Names to the right of the frame, in the lines' colours: the first ones and the last two if not all fit
  /// beside the frame.
  /// @param top  of the first name, measured down from the frame's upper edge (pixels of a 1400 x 800
  /// picture)
  void drawNames(const std::vector<PlotLine>& lines, double top = 8);
  /// Width of the longest name (pixels); drawNames() needs 60 pixels of a 1400 x 800 picture more.
  static double namesWidth(const Canvas& canvas, const std::vector<PlotLine>& lines, double unit);

 private:
  void drawLonePoints(const PlotLine& line);
  void drawDashed(const PlotLine& line);

  Canvas& canvas_;
  Rect frame_;
  double unit_;
  PlotAxis x_, y_;
};

/// The size of a text that must fit into a given width: size_px, or less.
double fittedSize_px(const Canvas& canvas, const std::string& text, double size_px, double room_px,
                     Weight weight = Weight::normal);

/// Breaks a text between words into lines.
std::vector<std::string> wrappedText(const Canvas& canvas, const std::string& text, double width_px,
                                     double size_px);

/// True for file names of plots: .png and .svg.
bool isPlotFile(const std::string& file);

/// Writes the drawing of `draw`, atomically. @throws Error (other) naming the file
void drawPlot(ImageSize size, const std::string& file, const std::function<void(Canvas&)>& draw);

}  // namespace emscape::render
