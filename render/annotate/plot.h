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
/// Okabe and Ito's colours, which readers with colour blindness tell apart; indices beyond them repeat.
const Ink& plotInk(std::size_t index);

struct PlotTick {
  double at = 0;
  std::string text;
};

struct PlotAxis {
  double lowest = 0, highest = 1;    ///< lowest < highest
  int ticks = 8;                     ///< about as many, at round values
  std::string title;                 ///< with the unit; empty: none
  std::vector<PlotTick> marks = {};  ///< in place of round values, for scales that are not linear
};

struct PlotLine {
  struct Point {
    double x, y;            ///< y infinite or NaN: a gap
    bool is_strong = true;  ///< drawn wide
  };
  std::string name;  ///< empty: not among the names
  std::vector<Point> points;
  Ink ink;
  bool is_dashed = false;
};

/// A frame with axes. Nothing is drawn until it is asked for, so that a caller decides on the order.
class PlotPanel {
 public:
  /// @param unit  pixels of the picture in one of a 1400 x 800 one
  PlotPanel(Canvas& canvas, const Rect& frame, double unit, const PlotAxis& x, const PlotAxis& y)
      : canvas_(canvas), frame_(frame), unit_(unit), x_(x), y_(y) {}

  const Rect& frame() const { return frame_; }
  /// Place in the picture of a point; y is limited to its axis.
  Point2 at(double x, double y) const;

  void drawTitle(const std::string& title);
  /// Lines at round values, their numbers, and the titles of the axes.
  void drawGrid();
  /// A band over the whole height.
  void drawBand(double x_begin, double x_end, const Ink& ink) const;
  void drawLine(const PlotLine& line);
  /// The ground below a line of heights, in pieces with gaps where a height is NaN.
  /// @param heights  x, y on the axes
  void drawGround(const std::vector<Point2>& heights) const;
  /// Names to the right of the frame, in the lines' colours: the first ones and the last two if there are
  /// more than stand beside the frame.
  /// @param top  of the first name, below the frame's upper edge (pixels of a 1400 x 800 picture)
  void drawNames(const std::vector<PlotLine>& lines, double top = 8);
  /// Width of the longest name (pixels), of which drawNames() needs 60 pixels of a 1400 x 800 picture more.
  static double namesWidth(const Canvas& canvas, const std::vector<PlotLine>& lines, double unit);

 private:
  Canvas& canvas_;
  Rect frame_;
  double unit_;
  PlotAxis x_, y_;
};

/// The size of a text that is to fit into a room: size_px, or less.
double fittedSize_px(const Canvas& canvas, const std::string& text, double size_px, double room_px,
                     Weight weight = Weight::normal);

/// The lines of a text that is broken between words.
std::vector<std::string> wrappedText(const Canvas& canvas, const std::string& text, double width_px,
                                     double size_px);

/// True for names of plots: .png and .svg.
bool isPlotFile(const std::string& file);

/// Writes what `draw` draws, atomically. @throws Error (other) naming the file
void drawPlot(ImageSize size, const std::string& file, const std::function<void(Canvas&)>& draw);

}  // namespace emscape::render
