#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/error.h"
#include "emscape/render/annotate/legend.h"
#include "emscape/study/vertical/vertical.h"
#include "render/annotate/legend_ends.h"
#include "render/annotate/overlay_parts.h"
#include "render/annotate/plot.h"
#include "study/vertical/vertical_colors.h"

namespace emscape::study {
namespace {

using emfield::HeightReference;
using render::Align;
using render::Canvas;
using render::Ink;
using render::PlotPanel;
using render::Point2;
using render::Rect;

constexpr Ink kSky{{0.925F, 0.955F, 0.985F}};
constexpr Ink kContour{{0.84F, 0.10F, 0.12F}};
constexpr Ink kFreeSpace{{0.10F, 0.12F, 0.16F}};
constexpr Ink kRay{{0.10F, 0.12F, 0.16F}, 0.45};
constexpr int kBlock_px = 2;  ///< side of the squares of one colour
// Of a picture of 1400 x 800 pixels.
constexpr double kHeader_px = 96;
constexpr double kPanelMargins_px = 84;  ///< title and abscissa of a panel
constexpr double kMinFrame_px = 48, kUsualPanel_px = 176;

double unitOf(render::ImageSize size) {
  return std::min(size.height / 800.0, size.width / 1400.0);
}

/// Height of the panels, with their margins (pixels).
double panelHeight_px(render::ImageSize size, std::size_t panels) {
  return (size.height - kHeader_px * unitOf(size)) / static_cast<double>(panels);
}

class VerticalPlot {
 public:
  VerticalPlot(const VerticalDiagram& diagram, Canvas& canvas)
      : diagram_(diagram),
        request_(diagram.request),
        canvas_(canvas),
        style_(canvas.size(), render::Theme::light),
        unit_(unitOf(canvas.size())),
        colors_(diagram) {
    legend_.quantity = render::quantityTitle(scenario::info(request_.quantity).name, diagram.unit);
    legend_.unit = render::unitText(diagram.unit);
    legend_.function = colors_.function();
    legend_.iso_value = request_.threshold;
    top_m_ = request_.fits_height ? fittedTop_m() : diagram.heights_m.back();
  }

  void draw() {
    const double width = canvas_.size().width, height = canvas_.size().height;
    canvas_.rectangle({0, 0, width, height}, render::kPlotPaper);
    const double header = kHeader_px * unit_;
    const double panel_height = panelHeight_px(canvas_.size(), diagram_.cuts.size());
    const double right = std::max(render::legendWidth(style_, legend_), 60 * unit_) + 24 * unit_;
    Rect frame{92 * unit_, header + 28 * unit_, width - 92 * unit_ - right,
               panel_height - kPanelMargins_px * unit_};
    for (const VerticalCut& cut : diagram_.cuts) {
      drawCut(cut, frame);
      frame.y += panel_height;
    }
    render::drawLegend(canvas_, style_, legend_, {colors_.hasLower(), colors_.hasHigher()});
    drawHeader(frame);
  }

 private:
  bool isChart() const { return request_.smooth_earth; }

  /// The upper edge for a picture that is not half empty: a little above the highest point with a field, the
  /// station and the lines.
  double fittedTop_m() const {
    constexpr double kRoom = 0.08, kWorthFitting = 0.95;
    const std::vector<double>& heights_m = diagram_.heights_m;
    const double bottom_m = heights_m.front(), end_m = heights_m.back();
    double top_m = request_.axis == HeightReference::ground ? diagram_.station_agl_m : diagram_.station_msl_m;
    const std::size_t width = diagram_.ranges_m.size();
    for (const VerticalCut& cut : diagram_.cuts) {
      for (std::size_t n = cut.values.size(); n-- > 0;) {
        if (colors_.shadeOf(cut.values[n]) < 0) continue;
        top_m = std::max(top_m, heights_m[n / width]);
        break;
      }
      for (const VerticalCut::Line& line : cut.free_space)
        for (const VerticalCut::Point& point : line) top_m = std::max(top_m, point.height_m);
      for (const float ground_m : cut.ground_msl_m) {
        if (request_.axis == HeightReference::mean_sea_level && std::isfinite(ground_m))
          top_m = std::max(top_m, static_cast<double>(ground_m));
      }
    }
    top_m += kRoom * (top_m - bottom_m);
    return top_m < bottom_m + kWorthFitting * (end_m - bottom_m) ? std::max(top_m, bottom_m + 10) : end_m;
  }

  std::string heightTitle() const {
    return isChart()                                  ? "height above the surface (m)"
           : request_.axis == HeightReference::ground ? "height above ground (m)"
                                                      : "height above mean sea level (m)";
  }

  /// True if there is room for the title of the heights beside a frame.
  bool hasRoomForTitle(const Rect& frame) const {
    return canvas_.textBox(heightTitle(), 14 * unit_).width <= frame.height + kPanelMargins_px * unit_;
  }

  void drawCut(const VerticalCut& cut, const Rect& frame) {
    const double end_m =
        isChart() ? diagram_.slantRange_m(request_.range_m, diagram_.station_msl_m) : request_.range_m;
    const int ticks = std::clamp(static_cast<int>(frame.height / (16 * unit_)), 2, 8);
    PlotPanel panel(
        canvas_, frame, unit_,
        {0, end_m / 1000, 10, isChart() ? "slant range (km)" : "distance over the ground (km)"},
        {diagram_.heights_m.front(), top_m_, ticks, hasRoomForTitle(frame) ? heightTitle() : "height (m)"});
    canvas_.rectangle(frame, kSky);
    drawValues(cut, panel, end_m);
    if (!isChart()) drawGround(cut, panel);
    panel.drawGrid();
    if (isChart()) drawRays(panel, end_m);
    drawLines(cut.free_space, panel, kFreeSpace, 1.6, true);
    drawLines(cut.contours, panel, kContour, 2.2, false);
    drawStation(panel);
    if (!isChart()) drawUnknown(cut, panel);
    canvas_.outline({{frame.x, frame.y},
                     {frame.x + frame.width, frame.y},
                     {frame.x + frame.width, frame.y + frame.height},
                     {frame.x, frame.y + frame.height}},
                    render::kPlotFaintText, unit_, true);
    panel.drawTitle(fmt::format("Azimuth {:g}°", cut.azimuth_deg));
  }

  /// Squares of equal colour in a row are one rectangle.
  void drawValues(const VerticalCut& cut, const PlotPanel& panel, double end_m) {
    const Rect& frame = panel.frame();
    const double low_m = diagram_.heights_m.front(), high_m = top_m_;
    const double bottom = frame.y + frame.height, right = frame.x + frame.width;
    for (double y = std::floor(frame.y); y < bottom; y += kBlock_px) {
      const double middle = std::clamp(y + kBlock_px / 2.0, frame.y, bottom);
      const double height_m = high_m - (high_m - low_m) * (middle - frame.y) / frame.height;
      const Rect row{frame.x, std::max(y, frame.y), 0,
                     std::min(y + kBlock_px, bottom) - std::max(y, frame.y)};
      int shade = -1;
      double begin = frame.x;
      const auto finish = [&](double end) {
        if (shade >= 0) canvas_.rectangle({begin, row.y, end - begin, row.height}, colors_.inkOf(shade));
        begin = end;
      };
      for (double x = std::floor(frame.x); x < right; x += kBlock_px) {
        const double part = (x + kBlock_px / 2.0 - frame.x) / frame.width;
        const double range_m = part * end_m;
        const int next = colors_.shadeOf(
            valueAt(cut, isChart() ? diagram_.groundRange_m(range_m, height_m) : range_m, height_m));
        if (next == shade) continue;
        finish(std::max(x, frame.x));
        shade = next;
      }
      finish(right);
    }
  }

  /// Linear between the grid's values; the nearest value if one of them is missing.
  float valueAt(const VerticalCut& cut, double range_m, double height_m) const {
    const auto indexOf = [](const std::vector<double>& axis, double at) {
      const double index = (at - axis.front()) / (axis[1] - axis.front());
      return std::clamp(index, 0.0, static_cast<double>(axis.size() - 1));
    };
    if (std::isnan(range_m) || range_m > request_.range_m) return NAN;
    const double x = indexOf(diagram_.ranges_m, range_m), y = indexOf(diagram_.heights_m, height_m);
    const auto width = diagram_.ranges_m.size();
    const auto i = std::min(static_cast<std::size_t>(x), width - 2);
    const auto k = std::min(static_cast<std::size_t>(y), diagram_.heights_m.size() - 2);
    const double u = x - static_cast<double>(i), v = y - static_cast<double>(k);
    const auto at = [&](std::size_t di, std::size_t dk) {
      return static_cast<double>(cut.values[(k + dk) * width + i + di]);
    };
    const double value =
        (1 - v) * ((1 - u) * at(0, 0) + u * at(1, 0)) + v * ((1 - u) * at(0, 1) + u * at(1, 1));
    if (std::isfinite(value)) return static_cast<float>(value);
    return static_cast<float>(at(u > 0.5 ? 1 : 0, v > 0.5 ? 1 : 0));
  }

  void drawGround(const VerticalCut& cut, const PlotPanel& panel) {
    if (request_.axis == HeightReference::ground || cut.ground_msl_m.empty()) return;
    std::vector<Point2> heights{{0, static_cast<double>(cut.ground_msl_m.front())}};
    for (std::size_t i = 0; i < cut.ground_msl_m.size(); ++i) {
      heights.push_back({diagram_.ranges_m[i] / 1000, static_cast<double>(cut.ground_msl_m[i])});
    }
    panel.drawGround(heights);
  }

  /// Lines of constant elevation from the station.
  void drawRays(const PlotPanel& panel, double end_m) {
    constexpr int kPieces = 200;
    const double top_m = top_m_;
    const Rect& frame = panel.frame();
    double last_x = -HUGE_VAL, last_y = HUGE_VAL;
    for (const double elevation_deg :
         {0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0, 90.0}) {
      std::vector<Point2> line;
      for (int i = 0; i <= kPieces; ++i) {
        const double slant_m = end_m * i / kPieces;
        const double height_m = diagram_.rayHeight_msl_m(slant_m, elevation_deg);
        if (height_m <= top_m) {
          line.push_back(panel.at(slant_m / 1000, height_m));
          continue;
        }
        const double before_m = end_m * (i - 1) / kPieces;
        const double before_height_m = diagram_.rayHeight_msl_m(before_m, elevation_deg);
        const double part = (top_m - before_height_m) / (height_m - before_height_m);
        line.push_back(panel.at((before_m + part * (slant_m - before_m)) / 1000, top_m));
        break;
      }
      if (line.size() < 2) continue;
      canvas_.outline(line, kRay, unit_, false);
      const std::string text = fmt::format("{:g}°", elevation_deg);
      const Point2 end = line.back();
      const bool is_at_top = end.y <= frame.y + 0.5;
      // Numbers that would overlap are left out.
      if (is_at_top ? std::abs(end.x - last_x) < 34 * unit_ : std::abs(end.y - last_y) < 16 * unit_) continue;
      if (is_at_top) {
        last_x = end.x;
        canvas_.textWithRim(text, {end.x, frame.y + 11 * unit_}, 13 * unit_, render::kPlotText,
                            render::kPlotPaper, Align::center);
      } else {
        last_y = end.y;
        canvas_.text(text, {end.x + 6 * unit_, end.y}, 13 * unit_, render::kPlotFaintText);
      }
    }
  }

  void drawLines(const std::vector<VerticalCut::Line>& lines, const PlotPanel& panel, const Ink& ink,
                 double width, bool is_dashed) {
    for (const VerticalCut::Line& line : lines) {
      std::vector<Point2> points;
      const auto finish = [&] {
        if (is_dashed) {
          drawDashes(points, ink, width);
        } else if (points.size() > 1) {
          canvas_.outline(points, ink, width * unit_, false);
        }
        points.clear();
      };
      for (const VerticalCut::Point& point : line) {
        const double range_m =
            isChart() ? diagram_.slantRange_m(point.range_m, point.height_m) : point.range_m;
        const Point2 at = panel.at(range_m / 1000, point.height_m);
        if (at.x <= panel.frame().x + panel.frame().width) {
          points.push_back(at);
        } else {
          finish();
        }
      }
      finish();
    }
  }

  /// Dashes of equal length, however short the pieces of the line.
  void drawDashes(const std::vector<Point2>& points, const Ink& ink, double width) {
    const double dash = 9 * unit_;
    double along = 0;
    std::vector<Point2> piece;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i > 0) along += length(points[i] - points[i - 1]);
      const bool is_drawn = static_cast<long long>(along / dash) % 2 == 0;
      if (is_drawn) piece.push_back(points[i]);
      if (!is_drawn || i + 1 == points.size()) {
        if (piece.size() > 1) canvas_.outline(piece, ink, width * unit_, false);
        piece.clear();
      }
    }
  }

  void drawStation(const PlotPanel& panel) {
    const double height_m =
        request_.axis == HeightReference::ground ? diagram_.station_agl_m : diagram_.station_msl_m;
    if (height_m > top_m_) return;
    const Point2 at = panel.at(0, height_m);
    canvas_.disc(at, 5.5 * unit_, {{0.10F, 0.16F, 0.30F}});
    canvas_.textWithRim(diagram_.emitter, {at.x + 10 * unit_, at.y - 12 * unit_}, 13 * unit_,
                        render::kPlotText, render::kPlotPaper);
  }

  /// Says where the elevation data end, beyond which nothing is known.
  void drawUnknown(const VerticalCut& cut, const PlotPanel& panel) {
    const std::size_t width = diagram_.ranges_m.size();
    std::size_t known = 0;  // ranges with a value
    for (std::size_t n = 0; n < cut.values.size(); ++n)
      if (!std::isnan(cut.values[n])) known = std::max(known, n % width + 1);
    if (known == 0 || known == width) return;
    const double from_km = diagram_.ranges_m[known - 1] / 1000;
    const Rect& frame = panel.frame();
    const double left = panel.at(from_km, 0).x, right = frame.x + frame.width;
    const std::string text = fmt::format("unknown beyond {:.1f} km: no elevation data", from_km);
    if (canvas_.textBox(text, 14 * unit_).width > right - left - 8 * unit_) return;
    canvas_.text(text, {(left + right) / 2, frame.y + frame.height / 2}, 14 * unit_, render::kPlotFaintText,
                 Align::center);
  }

  void drawHeader(const Rect& frame) {
    const std::string earth =
        isChart() ? fmt::format("smooth earth of {:.3g} times its radius, antenna {:.1f} m above it",
                                diagram_.k_factor, diagram_.station_msl_m)
                  : fmt::format("antenna at {:.0f} m above mean sea level", diagram_.station_msl_m);
    const std::string title = fmt::format("{}: {} of {}", diagram_.title, legend_.quantity, diagram_.emitter);
    const double room = canvas_.size().width - frame.x - 20 * unit_;
    canvas_.text(title, {frame.x, 26 * unit_},
                 render::fittedSize_px(canvas_, title, 20 * unit_, room, render::Weight::bold),
                 render::kPlotText, Align::left, render::Weight::bold);
    std::string heights = hasRoomForTitle(frame) ? "" : "; " + heightTitle();
    if (top_m_ < diagram_.heights_m.back())
      heights += fmt::format("; no field above the picture, up to {:.0f} m", diagram_.heights_m.back());
    canvas_.text(fmt::format("t = {:g} s, {}, {}{}", request_.time_s, diagram_.model, earth, heights),
                 {frame.x, 52 * unit_}, 15 * unit_, render::kPlotFaintText);
    double x = frame.x;
    const auto entry = [&](const std::string& words, const Ink& ink, bool is_dashed) {
      const double y = 78 * unit_;
      canvas_.line({x, y}, {x + 26 * unit_, y}, ink, 2.2 * unit_, is_dashed);
      canvas_.text(words, {x + 34 * unit_, y}, 14 * unit_, render::kPlotText);
      x += 34 * unit_ + canvas_.textBox(words, 14 * unit_).width + 28 * unit_;
    };
    entry(fmt::format("{} = {:g} {}", legend_.quantity, request_.threshold, legend_.unit), kContour, false);
    if (isChart()) {
      entry("the same in free space", kFreeSpace, true);
      entry("rays of constant elevation", kRay, false);
    }
  }

  const VerticalDiagram& diagram_;
  const VerticalRequest& request_;
  Canvas& canvas_;
  render::Style style_;
  double unit_;  ///< pixels of the picture in one of a 1400 x 800 one
  VerticalColors colors_;
  render::Legend legend_;
  double top_m_ = 0;  ///< of the panels
};

}  // namespace

render::ImageSize verticalPlotSize(std::size_t azimuths) {
  constexpr int kWidth_px = 1400, kHeight_px = 800;
  const double needed_px = kHeader_px + kUsualPanel_px * static_cast<double>(azimuths);
  return {kWidth_px,
          std::max(kHeight_px, static_cast<int>(std::min(needed_px, double{render::kMaxImageSide})))};
}

void checkVerticalPlot(render::ImageSize size, std::size_t azimuths) {
  const double min_px = (kPanelMargins_px + kMinFrame_px) * unitOf(size);
  if (panelHeight_px(size, azimuths) >= min_px) return;
  throw Error(
      ErrorCode::usage,
      fmt::format("a picture of {}x{} pixels has no room for {} azimuths, a panel each; at most {}",
                  size.width, size.height, azimuths, static_cast<int>(panelHeight_px(size, 1) / min_px)));
}

void plotVertical(const VerticalDiagram& diagram, render::ImageSize size, const std::string& file) {
  checkVerticalPlot(size, diagram.cuts.size());
  render::drawPlot(size, file, [&](Canvas& canvas) { VerticalPlot(diagram, canvas).draw(); });
}

}  // namespace emscape::study
