#include "report/paths/section_plot.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/text/quantity_text.h"
#include "emscape/render/annotate/legend.h"
#include "render/annotate/overlay_parts.h"
#include "render/annotate/plot.h"

namespace emscape::report {
namespace {

using emfield::PathBudget;
using emfield::PathSection;
using render::Align;
using render::Canvas;
using render::Ink;
using render::PlotPanel;
using render::Point2;
using render::Rect;
using render::Weight;

constexpr Ink kAir{{0.76F, 0.12F, 0.13F}};
constexpr Ink kEnd{{0.10F, 0.12F, 0.16F}};
constexpr double kMaxSpan_db = 100;

/// Colours of losses; smaller losses are brighter.
render::TransferFunction colorsOf(const PathSection& section) {
  std::vector<float> known;
  std::copy_if(section.loss_db.begin(), section.loss_db.end(), std::back_inserter(known),
               [](float loss_db) { return std::isfinite(loss_db); });
  std::sort(known.begin(), known.end());
  double low = 0, high = 10;
  if (!known.empty()) {  // without the smallest hundredth (next to the antenna) and the largest one (deepest
                         // nulls)
    low = 10 * std::floor(static_cast<double>(known[known.size() / 100]) / 10);
    high = 10 * std::ceil(static_cast<double>(known[known.size() * 99 / 100]) / 10);
    high = std::clamp(high, low + 10, low + kMaxSpan_db);
  }
  render::TransferFunction function;
  for (const render::ColorMap::Point& point : render::colorMap("viridis").points)
    function.colors.push_back({high - point.at * (high - low), point.color});
  std::reverse(function.colors.begin(), function.colors.end());
  function.opacities = {{low, 0}, {high, 0}};
  return function;
}

class SectionPlot {
 public:
  SectionPlot(const PathBudget& budget, const PathSection& section, Canvas& canvas)
      : budget_(budget),
        section_(section),
        canvas_(canvas),
        style_(canvas.size(), render::Theme::light),
        unit_(std::min(canvas.size().height / 800.0, canvas.size().width / 1400.0)),
        bottom_m_(section.heights_msl_m.front() - stepOf(section.heights_msl_m) / 2),
        top_m_(section.heights_msl_m.back() + stepOf(section.heights_msl_m) / 2) {
    legend_.quantity = "Basic transmission loss";
    legend_.unit = "dB";
    legend_.function = colorsOf(section);
  }

  void draw() {
    const double width = canvas_.size().width, height = canvas_.size().height;
    canvas_.rectangle({0, 0, width, height}, render::kPlotPaper);
    const double right = render::legendWidth(style_, legend_) + 24 * unit_;
    const double top = 112 * unit_, panel = height - top - 66 * unit_, air = 190 * unit_;
    drawAir({92 * unit_, top, air, panel});
    drawLoss({152 * unit_ + air, top, width - 152 * unit_ - air - right, panel});
    render::drawLegend(canvas_, style_, legend_);
    drawTitle();
  }

 private:
  static double stepOf(const std::vector<double>& axis) { return axis[1] - axis[0]; }

  void drawAir(const Rect& frame) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const PathSection::Level& level : section_.air) {
      low = std::min(low, level.m_units);
      high = std::max(high, level.m_units);
    }
    const double margin = std::max(0.05 * (high - low), 1.0);
    PlotPanel panel(canvas_, frame, unit_, {low - margin, high + margin, 3, "M (M-units)"},
                    {bottom_m_, top_m_, 8, "Height above mean sea level (m)"});
    panel.drawGrid();
    render::PlotLine line;
    line.ink = kAir;
    for (const PathSection::Level& level : section_.air)
      line.points.push_back({level.m_units, level.height_msl_m, true});
    panel.drawLine(line);
    outline(frame);
    panel.drawTitle("Air at the emitter");
  }

  void drawLoss(const Rect& frame) {
    PlotPanel panel(canvas_, frame, unit_,
                    {0, section_.ranges_m.back() / 1000, 10, "Distance over the ground (km)"},
                    {bottom_m_, top_m_, 8, ""});
    drawCells(panel);
    drawGround(panel);
    panel.drawGrid();
    drawEnd(panel, 0, budget_.profile.begin.height_msl_m, budget_.emitter, Align::left);
    drawEnd(panel, section_.ranges_m.back(), budget_.profile.end.height_msl_m, "point", Align::right);
    outline(frame);
    panel.drawTitle(fmt::format("Loss by {}", toString(budget_.model)));
  }

  /// Draws each sample as a rectangle of whole pixels, since the background would show through smoothed
  /// edges; adjacent ones of equal colour in a row are drawn as one.
  void drawCells(const PlotPanel& panel) {
    constexpr int kShades = 64;
    const Rect& frame = panel.frame();
    const auto width = section_.ranges_m.size(), height = section_.heights_msl_m.size();
    const double low = legend_.function.lowest(), high = legend_.function.highest();
    for (std::size_t k = 0; k < height; ++k) {
      const double above =
          frame.y + frame.height * static_cast<double>(height - 1 - k) / static_cast<double>(height);
      const double below =
          frame.y + frame.height * static_cast<double>(height - k) / static_cast<double>(height);
      const Rect row{0, std::floor(above), 0, std::ceil(below) - std::floor(above)};
      const auto shadeOf = [&](std::size_t i) {
        const auto loss_db = static_cast<double>(section_.loss_db[k * width + i]);
        if (std::isnan(loss_db)) return -1;
        return static_cast<int>(std::clamp((loss_db - low) / (high - low) * kShades, 0.0, kShades - 1.0));
      };
      for (std::size_t begin = 0, end = 0; begin < width; begin = end) {
        const int shade = shadeOf(begin);
        while (end < width && shadeOf(end) == shade) ++end;
        if (shade < 0) continue;
        const auto edgeOf = [&](std::size_t i) {
          const double x = frame.x + frame.width * static_cast<double>(i) / static_cast<double>(width);
          return i == 0 ? frame.x : i == width ? frame.x + frame.width : std::floor(x);
        };
        const double from = edgeOf(begin), to = edgeOf(end);
        canvas_.rectangle({from, std::max(row.y, frame.y), to - from,
                           std::min(row.y + row.height, frame.y + frame.height) - std::max(row.y, frame.y)},
                          {legend_.function.color(low + (shade + 0.5) / kShades * (high - low))});
      }
    }
  }

  void drawGround(const PlotPanel& panel) {
    std::vector<Point2> heights;
    for (std::size_t i = 0; i < static_cast<std::size_t>(budget_.profile.count()); ++i) {
      heights.push_back(
          {budget_.profile.ranges_m[i] / 1000, static_cast<double>(budget_.profile.ground_msl_m[i])});
    }
    panel.drawGround(heights);
  }

  void drawEnd(const PlotPanel& panel, double range_m, double height_msl_m, const std::string& name,
               Align align) {
    const Point2 at = panel.at(range_m / 1000, height_msl_m);
    canvas_.disc(at, 5 * unit_, kEnd);
    canvas_.textWithRim(name, {at.x + (align == Align::left ? 9 : -9) * unit_, at.y - 12 * unit_}, 14 * unit_,
                        kEnd, render::kPlotPaper, align, Weight::bold);
  }

  void outline(const Rect& frame) {
    canvas_.outline({{frame.x, frame.y},
                     {frame.x + frame.width, frame.y},
                     {frame.x + frame.width, frame.y + frame.height},
                     {frame.x, frame.y + frame.height}},
                    render::kPlotFaintText, unit_, true);
  }

  void drawTitle() {
    const emfield::PathEnd& end = budget_.profile.end;
    const double width = canvas_.size().width - 184 * unit_;
    const std::string title =
        fmt::format("{} to {:.5f}, {:.5f} deg   ({}, t = {:g} s)", budget_.emitter, end.position.latitude_deg,
                    end.position.longitude_deg, quantityText(budget_.frequency_hz, "Hz", 4), budget_.time_s);
    canvas_.text(title, {92 * unit_, 26 * unit_},
                 render::fittedSize_px(canvas_, title, 20 * unit_, width, Weight::bold), render::kPlotText,
                 Align::left, Weight::bold);
    const std::vector<std::string> lines = render::wrappedText(canvas_, budget_.verdict, width, 16 * unit_);
    double y = (lines.size() > 1 ? 50 : 56) * unit_;
    for (const std::string& line : lines) {
      canvas_.text(line, {92 * unit_, y}, 16 * unit_, render::kPlotText);
      y += 20 * unit_;
    }
  }

  const PathBudget& budget_;
  const PathSection& section_;
  Canvas& canvas_;
  render::Style style_;
  double unit_;  ///< pixels per pixel of a 1400 x 800 picture
  double bottom_m_, top_m_;
  render::Legend legend_;
};

}  // namespace

void plotSection(const PathBudget& budget, const PathSection& section, render::ImageSize size,
                 const std::string& file) {
  render::drawPlot(size, file, [&](Canvas& canvas) { SectionPlot(budget, section, canvas).draw(); });
}

}  // namespace emscape::report
