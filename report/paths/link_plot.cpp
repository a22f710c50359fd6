#include "report/paths/link_plot.h"

#include <algorithm>
#include <cmath>

#include "render/annotate/plot.h"

namespace emscape::report {
namespace {

using emfield::Detection;
using emfield::DetectionRow;
using emfield::Link;
using emfield::LinkRow;
using render::Canvas;
using render::PlotLine;
using render::PlotPanel;
using render::Rect;

std::vector<PlotLine> linkLines(const NamedLinks& links) {
  std::vector<PlotLine> lines;
  for (const Link& link : links.report.links) {
    PlotLine line;
    line.name = links.scenario->emitters[static_cast<std::size_t>(link.emitter)].name + " at " +
                links.scenario->placed_receivers[static_cast<std::size_t>(link.receiver)].name;
    line.ink = render::plotInk(lines.size());
    for (const LinkRow& row : link.rows) line.points.push_back({row.time_s, row.sinr_db, row.is_received});
    lines.push_back(std::move(line));
  }
  return lines;
}

/// Two lines per pair: for a single look, and for all looks so far.
std::vector<PlotLine> detectionLines(const NamedLinks& links) {
  std::vector<PlotLine> lines;
  for (const Detection& detection : links.report.detections) {
    PlotLine look, all;
    look.name = links.scenario->emitters[static_cast<std::size_t>(detection.radar)].name + ", " +
                links.scenario->targets[static_cast<std::size_t>(detection.target)].name;
    all.name = look.name + ", cumulative";
    look.ink = all.ink = render::plotInk(lines.size() / 2);
    all.is_dashed = true;
    for (const DetectionRow& row : detection.rows) {
      look.points.push_back({row.time_s, row.detection_probability, true});
      all.points.push_back({row.time_s, row.cumulative_probability, false});
    }
    lines.push_back(std::move(look));
    lines.push_back(std::move(all));
  }
  return lines;
}

/// Limits of the ratios, multiples of 10 dB, not below -60 dB.
std::pair<double, double> limitsOf(const std::vector<PlotLine>& lines) {
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (const PlotLine& line : lines) {
    for (const PlotLine::Point& point : line.points) {
      if (!std::isfinite(point.y)) continue;
      lowest = std::min(lowest, point.y);
      highest = std::max(highest, point.y);
    }
  }
  if (lowest > highest) return {-10, 10};
  lowest = std::max(10 * std::floor(lowest / 10), -60.0);
  return {lowest, std::max(10 * std::ceil(highest / 10), lowest + 10)};
}

}  // namespace

void plotLinks(const NamedLinks& links, render::ImageSize size, const std::string& file) {
  render::drawPlot(size, file, [&](Canvas& canvas) {
    const double width = canvas.size().width, height = canvas.size().height;
    const double unit = std::min(height / 800, width / 1400);
    canvas.rectangle({0, 0, width, height}, render::kPlotPaper);
    const std::vector<PlotLine> ratios = linkLines(links), detections = detectionLines(links);
    const double right = std::max(PlotPanel::namesWidth(canvas, ratios, unit),
                                  PlotPanel::namesWidth(canvas, detections, unit));
    const int panels = int(!ratios.empty()) + int(!detections.empty());
    const double panel_height = height / std::max(panels, 1);
    Rect frame{64 * unit, 48 * unit, width - right - 124 * unit, panel_height - 100 * unit};
    const auto drawPanel = [&](const std::string& title, const std::vector<PlotLine>& lines, double lowest,
                               double highest) {
      const std::vector<PlotLine::Point>& points = lines.front().points;
      PlotPanel panel(canvas, frame, unit, render::timeAxis(points.front().x, points.back().x),
                      {lowest, highest, 8, ""});
      panel.drawTitle(title);
      panel.drawGrid();
      for (const PlotLine& line : lines) panel.drawLine(line);
      panel.drawNames(lines);
      frame.y += panel_height;
    };
    if (!ratios.empty()) {
      const auto [lowest, highest] = limitsOf(ratios);
      drawPanel("Signal over noise and interference (dB); thick line: received", ratios, lowest, highest);
    }
    if (!detections.empty())
      drawPanel("Probability of detection of one look and of all looks", detections, 0, 1);
  });
}

}  // namespace emscape::report
