#include "report/paths/link_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emscape/scenario/file/scenario_file.h"
#include "render/annotate/plot.h"

namespace emscape::report {
namespace {

using emfield::Detection;
using emfield::DetectionRow;
using emfield::Link;
using emfield::LinkRow;
using render::Align;
using render::Canvas;
using render::PlotLine;
using render::PlotPanel;
using render::Point2;
using render::Rect;

constexpr double kLowest_db = -60;  ///< ratios below it count as no signal

/// A time without a line, and the reason.
struct Gap {
  double begin_s = 0, end_s = 0;
  std::string why;
};

/// A pair's line and the times at which it has none.
struct PairLine {
  PlotLine line;
  std::vector<Gap> gaps;
};

/// The times in a row without a signal.
/// @param isEmpty  (row)
template <class Row, class Test>
std::vector<Gap> gapsOf(const std::vector<Row>& rows, const Test& isEmpty) {
  std::vector<Gap> gaps;
  for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = ++end) {
    if (!isEmpty(rows[begin])) continue;
    std::size_t blocked = 0, silent = 0;
    for (end = begin; end < rows.size() && isEmpty(rows[end]); ++end) {
      blocked += rows[end].is_blocked ? 1 : 0;
      silent += rows[end].active ? 0 : 1;
    }
    --end;
    const std::size_t count = end + 1 - begin;
    const std::string why = 2 * silent >= count    ? "silent"
                            : 2 * blocked >= count ? "blocked by terrain"
                                                   : "no signal";
    const double begin_s = rows[begin].time_s, end_s = rows[std::min(end + 1, rows.size() - 1)].time_s;
    const std::string when = begin == 0 && end + 1 == rows.size() ? " all the time"
                             : begin == 0                         ? fmt::format(" until {:g} s", end_s)
                             : end + 1 == rows.size()             ? fmt::format(" from {:g} s on", begin_s)
                                                      : fmt::format(" from {:g} to {:g} s", begin_s, end_s);
    gaps.push_back({begin_s, end_s, why + when});
  }
  return gaps;
}

std::vector<PairLine> linkLines(const NamedLinks& links) {
  std::vector<PairLine> pairs;
  for (const Link& link : links.report.links) {
    PlotLine line;
    line.name = links.scenario->emitters[static_cast<std::size_t>(link.emitter)].name + " at " +
                links.scenario->placed_receivers[static_cast<std::size_t>(link.receiver)].name;
    line.ink = render::plotInk(pairs.size());
    for (const LinkRow& row : link.rows) line.points.push_back({row.time_s, row.sinr_db, row.is_received});
    pairs.push_back({std::move(line), gapsOf(link.rows, [](const LinkRow& row) {
                       return !std::isfinite(row.sinr_db) || row.sinr_db < kLowest_db;
                     })});
  }
  return pairs;
}

/// Two lines per pair: for a single look, and for all looks so far.
std::vector<PairLine> detectionLines(const NamedLinks& links) {
  constexpr double kNone = 0.005;
  std::vector<PairLine> pairs;
  for (const Detection& detection : links.report.detections) {
    PlotLine look, all;
    look.name = links.scenario->emitters[static_cast<std::size_t>(detection.radar)].name + ", " +
                links.scenario->targets[static_cast<std::size_t>(detection.target)].name;
    all.name = look.name + ", cumulative";
    look.ink = all.ink = render::plotInk(pairs.size() / 2);
    all.is_dashed = true;
    for (const DetectionRow& row : detection.rows) {
      look.points.push_back({row.time_s, row.detection_probability, true});
      all.points.push_back({row.time_s, row.cumulative_probability, false});
    }
    pairs.push_back({std::move(look), gapsOf(detection.rows, [](const DetectionRow& row) {
                       return row.detection_probability < kNone && (row.is_blocked || !row.active);
                     })});
    pairs.push_back({std::move(all), {}});
  }
  return pairs;
}

std::vector<PlotLine> linesOf(const std::vector<PairLine>& pairs) {
  std::vector<PlotLine> lines;
  for (const PairLine& pair : pairs) lines.push_back(pair.line);
  return lines;
}

/// Limits of the ratios, multiples of 10 dB, not below -60 dB. Values beyond most of the others by more than
/// kSpike_db are left out: short peaks next to an antenna would flatten all lines.
std::pair<double, double> limitsOf(const std::vector<PlotLine>& lines) {
  constexpr double kSpike_db = 15, kMost = 0.97;
  std::vector<double> known;
  for (const PlotLine& line : lines) {
    for (const PlotLine::Point& point : line.points)
      if (std::isfinite(point.y) && point.y >= kLowest_db) known.push_back(point.y);
  }
  if (known.empty()) return {-10, 10};
  std::sort(known.begin(), known.end());
  const double most = known[static_cast<std::size_t>(kMost * static_cast<double>(known.size() - 1))];
  const double highest = known.back() > most + kSpike_db ? most + 5 : known.back();
  const double lowest = std::max(10 * std::floor(known.front() / 10), kLowest_db);
  return {lowest, std::max(10 * std::ceil(highest / 10), lowest + 10)};
}

/// Writes the values of peaks beyond the axis, below the frame's upper edge.
void drawPeaks(Canvas& canvas, const PlotPanel& panel, double unit, const PlotLine& line, double highest) {
  const std::vector<PlotLine::Point>& points = line.points;
  for (std::size_t begin = 0, end = 0; begin < points.size(); begin = ++end) {
    end = begin;
    if (!(std::isfinite(points[begin].y) && points[begin].y > highest)) continue;
    std::size_t peak = begin;
    for (; end < points.size() && points[end].y > highest; ++end)
      if (points[end].y > points[peak].y) peak = end;
    const Point2 top = panel.at(points[peak].x, highest);
    const std::string text = fmt::format("↑ {:.0f} dB", points[peak].y);
    const double room = panel.frame().x + panel.frame().width - top.x - 6 * unit;
    const bool fits = canvas.textBox(text, 13 * unit).width <= room;
    canvas.textWithRim(text, {top.x + (fits ? 6 : -6) * unit, top.y + 12 * unit}, 13 * unit, line.ink,
                       render::kPlotPaper, fits ? Align::left : Align::right);
  }
}

/// Marks long times without a signal above the frame's lower edge, a row each, with the reason.
void drawGaps(Canvas& canvas, const PlotPanel& panel, double unit, const std::vector<PairLine>& pairs) {
  constexpr double kRow = 22, kMinPart = 0.08;
  constexpr std::size_t kMaxRows = 6;
  const Rect& frame = panel.frame();
  std::size_t row = 0;
  for (const PairLine& pair : pairs) {
    for (const Gap& gap : pair.gaps) {
      const double left = panel.at(gap.begin_s, 0).x, right = panel.at(gap.end_s, 0).x;
      if (right - left < kMinPart * frame.width) continue;
      if (row == kMaxRows) return;
      const double y = frame.y + frame.height - (14 + kRow * static_cast<double>(row++)) * unit;
      for (const double x : {left, right})
        canvas.line({x, y - 5 * unit}, {x, y + 5 * unit}, pair.line.ink, 1.5 * unit);
      canvas.line({left, y}, {right, y}, pair.line.ink, 1.5 * unit);
      const std::string text =
          render::shortenedText(canvas, pair.line.name + ": " + gap.why, 13 * unit, frame.width - 12 * unit);
      const double half = canvas.textBox(text, 13 * unit).width / 2 + 6 * unit;
      const double x = std::clamp((left + right) / 2, frame.x + half, frame.x + frame.width - half);
      canvas.rectangle({x - half, y - 8 * unit, 2 * half, 16 * unit}, render::kPlotPaper);
      canvas.text(text, {x, y}, 13 * unit, pair.line.ink, Align::center);
    }
  }
}

}  // namespace

void plotLinks(const NamedLinks& links, render::ImageSize size, const std::string& file) {
  render::drawPlot(size, file, [&](Canvas& canvas) {
    const double width = canvas.size().width, height = canvas.size().height;
    const double unit = std::min(height / 800, width / 1400);
    canvas.rectangle({0, 0, width, height}, render::kPlotPaper);
    const std::vector<PairLine> ratios = linkLines(links), detections = detectionLines(links);
    const double right = std::max(PlotPanel::namesWidth(canvas, linesOf(ratios), unit),
                                  PlotPanel::namesWidth(canvas, linesOf(detections), unit));
    const int panels = int(!ratios.empty()) + int(!detections.empty());
    const double header = 44 * unit, panel_height = (height - header) / std::max(panels, 1);
    Rect frame{64 * unit, header + 48 * unit, width - right - 124 * unit, panel_height - 100 * unit};
    const std::string title = fmt::format("{}: {} over time", titleOf(*links.scenario),
                                          detections.empty() ? "links"
                                          : ratios.empty()   ? "detection of targets"
                                                             : "links and detection of targets");
    canvas.text(title, {frame.x, 26 * unit},
                render::fittedSize_px(canvas, title, 20 * unit, width - 84 * unit, render::Weight::bold),
                render::kPlotText, Align::left, render::Weight::bold);
    const auto drawPanel = [&](const std::string& heading, const std::vector<PairLine>& pairs, double lowest,
                               double highest) {
      const std::vector<PlotLine> lines = linesOf(pairs);
      const std::vector<PlotLine::Point>& points = lines.front().points;
      PlotPanel panel(canvas, frame, unit, render::timeAxis(points.front().x, points.back().x),
                      {lowest, highest, 8, ""});
      panel.drawTitle(heading);
      panel.drawGrid();
      for (const PlotLine& line : lines) panel.drawLine(line);
      for (const PlotLine& line : lines) drawPeaks(canvas, panel, unit, line, highest);
      drawGaps(canvas, panel, unit, pairs);
      panel.drawNames(lines);
      frame.y += panel_height;
    };
    if (!ratios.empty()) {
      const auto [lowest, highest] = limitsOf(linesOf(ratios));
      drawPanel("Signal over noise and interference (dB); thick line: received", ratios, lowest, highest);
    }
    if (!detections.empty())
      drawPanel("Probability of detection of one look, and of all looks so far (cumulative)", detections, 0,
                1);
  });
}

}  // namespace emscape::report
