#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emscape/render/annotate/legend.h"
#include "emscape/study/exposure/exposure.h"
#include "render/annotate/plot.h"

namespace emscape::study {
namespace {

using render::Align;
using render::Canvas;
using render::PlotAxis;
using render::PlotLine;
using render::PlotPanel;
using render::Rect;

constexpr render::Ink kTogether{{0.10F, 0.11F, 0.13F}};
constexpr render::Ink kThreshold{{0.76F, 0.12F, 0.13F}};
constexpr render::Ink kUnknown{{0.87F, 0.87F, 0.89F}};

/// Adds the points of the rows, wide where the threshold is reached: with one more where a line between
/// values crosses it.
template <class Value, class Height>
void addPoints(const Exposure& exposure, const Value& valueOf, const Height& heightOf, PlotLine& line) {
  const double threshold = exposure.request.threshold;
  for (std::size_t t = 0; t < exposure.rows.size(); ++t) {
    const ExposureRow& row = exposure.rows[t];
    const double value = valueOf(row), height = heightOf(row);
    const bool is_reached = value >= threshold;
    if (t > 0) {
      const ExposureRow& last = exposure.rows[t - 1];
      const double part = (threshold - valueOf(last)) / (value - valueOf(last));
      if (is_reached != (valueOf(last) >= threshold) && std::isfinite(part)) {
        line.points.push_back({last.time_s + part * (row.time_s - last.time_s),
                               heightOf(last) + part * (height - heightOf(last)), is_reached});
      }
    }
    line.points.push_back({row.time_s, height, is_reached});
  }
}

/// The values of each emitter, of all, and the threshold.
std::vector<PlotLine> linesOf(const Exposure& exposure) {
  std::vector<PlotLine> lines;
  const double threshold = exposure.request.threshold;
  const auto addLine = [&](const std::string& name, const render::Ink& ink,
                           const auto& valueOf) -> PlotLine& {
    PlotLine line{name, {}, ink};
    addPoints(exposure, valueOf, valueOf, line);
    lines.push_back(std::move(line));
    return lines.back();
  };
  if (exposure.names.size() != 1) {
    addLine("together", kTogether, [](const ExposureRow& row) { return row.value; });
  }
  for (std::size_t n = 0; n < exposure.names.size(); ++n) {
    addLine(exposure.names[n], render::plotInk(n), [n](const ExposureRow& row) { return row.each[n]; });
  }
  if (std::isfinite(exposure.together.cumulative_probability)) {
    addLine("in any look so far", kTogether, [](const ExposureRow& row) {
      return row.cumulative_probability;
    }).is_dashed = true;
  }
  addLine(fmt::format("{:g} {}", threshold, render::unitText(exposure.unit)), kThreshold,
          [&](const ExposureRow&) { return threshold; })
      .is_dashed = true;
  if (exposure.together.unknown_fraction > 0) lines.push_back({"unknown", {}, kUnknown});
  return lines;
}

/// Bands between the known times where the value of all emitters together is unknown.
void drawUnknown(const Exposure& exposure, const PlotPanel& panel) {
  const std::vector<ExposureRow>& rows = exposure.rows;
  std::size_t begin = 0;
  for (std::size_t t = 1; t <= rows.size(); ++t) {
    const bool goes_on = t < rows.size() && (rows[t - 1].state == ExposureState::unknown ||
                                             rows[t].state == ExposureState::unknown);
    if (goes_on) continue;
    if (t - 1 > begin) panel.drawBand(rows[begin].time_s, rows[t - 1].time_s, kUnknown);
    begin = t;
  }
}

/// Limits of the values: 0..1 for probabilities, else multiples of ten, at most 100 below the maximum.
PlotAxis axisOf(const std::vector<PlotLine>& lines, const std::string& unit) {
  if (unit.empty() && std::all_of(lines.begin(), lines.end(), [](const PlotLine& line) {
        return std::all_of(line.points.begin(), line.points.end(),
                           [](const PlotLine::Point& point) { return !(point.y > 1); });
      })) {
    return {0, 1, 8, ""};
  }
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (const PlotLine& line : lines) {
    for (const PlotLine::Point& point : line.points) {
      if (!std::isfinite(point.y)) continue;
      lowest = std::min(lowest, point.y);
      highest = std::max(highest, point.y);
    }
  }
  highest = std::max(10 * std::ceil(highest / 10), 10 * std::floor(lowest / 10) + 10);
  return {std::max(10 * std::floor(lowest / 10), highest - 100), highest, 8, ""};
}

}  // namespace

void plotExposure(const Exposure& exposure, render::ImageSize size, const std::string& file) {
  render::drawPlot(size, file, [&](Canvas& canvas) {
    const double width = canvas.size().width, height = canvas.size().height;
    const double unit = std::min(height / 800, width / 1400);
    canvas.rectangle({0, 0, width, height}, render::kPlotPaper);
    const std::vector<PlotLine> lines = linesOf(exposure);
    const double right = PlotPanel::namesWidth(canvas, lines, unit);
    const PlotAxis times = render::timeAxis(exposure.rows.front().time_s, exposure.rows.back().time_s);
    const std::string quantity =
        render::quantityTitle(scenario::info(exposure.request.quantity).name, exposure.unit);
    const std::string in_unit = exposure.unit.empty() ? "" : " (" + render::unitText(exposure.unit) + ")";
    const std::string title =
        fmt::format("{}: {} along the track of {}", exposure.title, quantity, exposure.platform);
    canvas.text(title, {92 * unit, 26 * unit},
                render::fittedSize_px(canvas, title, 20 * unit, width - 112 * unit, render::Weight::bold),
                render::kPlotText, Align::left, render::Weight::bold);
    Rect frame{92 * unit, 84 * unit, width - right - 152 * unit, 0.62 * height - 100 * unit};
    PlotPanel values(canvas, frame, unit, times, axisOf(lines, exposure.unit));
    values.drawTitle(quantity + in_unit + "; thick line: the threshold is reached");
    drawUnknown(exposure, values);
    values.drawGrid();
    for (const PlotLine& line : lines) values.drawLine(line);
    values.drawNames(lines);

    PlotLine way{"platform", {}, kTogether}, ground{"ground", {}, render::kPlotSurface};
    double lowest_m = HUGE_VAL, highest_m = -HUGE_VAL;
    addPoints(
        exposure, [](const ExposureRow& row) { return row.value; },
        [](const ExposureRow& row) { return row.height_msl_m; }, way);
    for (const ExposureRow& row : exposure.rows) {
      ground.points.push_back({row.time_s, row.height_msl_m - row.height_agl_m, false});
      highest_m = std::max(highest_m, row.height_msl_m);
      lowest_m = std::min({lowest_m, row.height_msl_m, ground.points.back().y});
    }
    const double span_m = std::max(highest_m - lowest_m, 10.0);
    frame.y += frame.height + 88 * unit;
    frame.height = height - frame.y - 52 * unit;
    PlotPanel heights(canvas, frame, unit, times,
                      {lowest_m - 0.05 * span_m, highest_m + 0.1 * span_m, 5, ""});
    heights.drawTitle("Height above mean sea level (m)");
    std::vector<render::Point2> surface;
    for (const PlotLine::Point& point : ground.points) surface.push_back({point.x, point.y});
    drawUnknown(exposure, heights);
    heights.drawGround(surface);
    heights.drawGrid();
    heights.drawLine(ground);
    heights.drawLine(way);
    heights.drawNames({way, ground});
  });
}

}  // namespace emscape::study
