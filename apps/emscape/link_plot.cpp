#include "apps/emscape/link_plot.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/emscape/profile_plot.h"
#include "emscape/base/units.h"
#include "emscape/render/annotate/legend.h"
#include "render/annotate/canvas.h"

namespace emscape::app {
namespace {

using emfield::Detection;
using emfield::DetectionRow;
using emfield::Link;
using emfield::LinkRow;
using render::Align;
using render::Canvas;
using render::Ink;
using render::Point2;
using render::Rect;
using render::Weight;

constexpr Ink kPaper{{1.0F, 1.0F, 1.0F}};
constexpr Ink kText{{0.13F, 0.15F, 0.18F}};
constexpr Ink kGrid{{0.45F, 0.50F, 0.58F}, 0.28};
/// Okabe and Ito's colours, which readers with colour blindness tell apart.
constexpr std::array<Ink, 7> kLines{{{{0.00F, 0.45F, 0.70F}},
                                     {{0.84F, 0.37F, 0.00F}},
                                     {{0.00F, 0.62F, 0.45F}},
                                     {{0.80F, 0.47F, 0.65F}},
                                     {{0.90F, 0.62F, 0.00F}},
                                     {{0.34F, 0.71F, 0.91F}},
                                     {{0.25F, 0.25F, 0.25F}}}};

struct Point {
  double time_s, value;
  bool is_strong;  ///< received: drawn wide
};
struct Line {
  std::string name;
  std::vector<Point> points;  ///< values may be infinite: gaps
  bool is_dashed = false;
  std::size_t color = 0;
};

/// One panel: lines over time in a frame.
class Panel {
 public:
  Panel(Canvas& canvas, const Rect& frame, double unit) : canvas_(canvas), frame_(frame), unit_(unit) {}

  void draw(const std::string& title, const std::vector<Line>& lines, double lowest, double highest) {
    lowest_ = lowest;
    highest_ = highest;
    begin_s_ = lines.front().points.front().time_s;
    end_s_ = std::max(lines.front().points.back().time_s, begin_s_ + 1e-3);
    canvas_.text(title, {frame_.x, frame_.y - 16 * unit_}, 16 * unit_, kText, Align::left, Weight::bold);
    drawGrid();
    for (const Line& line : lines) drawLine(line);
    drawNames(lines);
  }

 private:
  Point2 at(double time_s, double value) const {
    return {
        frame_.x + frame_.width * (time_s - begin_s_) / (end_s_ - begin_s_),
        frame_.y + frame_.height * (highest_ - std::clamp(value, lowest_, highest_)) / (highest_ - lowest_)};
  }

  void drawGrid() {
    const std::vector<double> values = render::roundTicks(lowest_, highest_, 8);
    for (const double value : values) {
      const Point2 left = at(begin_s_, value);
      canvas_.line(left, at(end_s_, value), kGrid, unit_);
      canvas_.text(render::tickText(value, values.size() > 1 ? values[1] - values[0] : 1),
                   {left.x - 8 * unit_, left.y}, 14 * unit_, kText, Align::right);
    }
    const std::vector<double> times = render::roundTicks(begin_s_, end_s_, 10);
    for (const double time_s : times) {
      const Point2 bottom = at(time_s, lowest_);
      canvas_.line({bottom.x, frame_.y}, bottom, kGrid, unit_);
      canvas_.text(render::tickText(time_s, times.size() > 1 ? times[1] - times[0] : 1),
                   {bottom.x, bottom.y + 16 * unit_}, 14 * unit_, kText, Align::center);
    }
    canvas_.text("time (s)", {frame_.x + frame_.width, frame_.y + frame_.height + 36 * unit_}, 14 * unit_,
                 kText, Align::right);
  }

  void drawLine(const Line& line) {
    for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
      const Point &a = line.points[i], &b = line.points[i + 1];
      if (!std::isfinite(a.value) || !std::isfinite(b.value)) continue;
      canvas_.line(at(a.time_s, a.value), at(b.time_s, b.value), inkOf(line), (a.is_strong ? 3 : 1.2) * unit_,
                   line.is_dashed);
    }
  }

  /// Names to the right of the frame, in the lines' colours.
  void drawNames(const std::vector<Line>& lines) {
    double y = frame_.y + 8 * unit_;
    for (const Line& line : lines) {
      const double x = frame_.x + frame_.width + 14 * unit_;
      canvas_.line({x, y}, {x + 24 * unit_, y}, inkOf(line), 2.5 * unit_, line.is_dashed);
      canvas_.text(line.name, {x + 32 * unit_, y}, 14 * unit_, kText);
      y += 22 * unit_;
    }
  }

  static const Ink& inkOf(const Line& line) { return kLines[line.color % kLines.size()]; }

  Canvas& canvas_;
  Rect frame_;
  double unit_;  ///< pixels of the picture in one of a 1400 x 800 one
  double lowest_ = 0, highest_ = 1, begin_s_ = 0, end_s_ = 1;
};

std::vector<Line> linkLines(const NamedLinks& links) {
  std::vector<Line> lines;
  for (const Link& link : links.report.links) {
    Line line;
    line.name = links.scenario->emitters[static_cast<std::size_t>(link.emitter)].name + " at " +
                links.scenario->placed_receivers[static_cast<std::size_t>(link.receiver)].name;
    line.color = lines.size();
    for (const LinkRow& row : link.rows) line.points.push_back({row.time_s, row.sinr_db, row.is_received});
    lines.push_back(std::move(line));
  }
  return lines;
}

/// Two lines per pair: of one look and of all looks so far.
std::vector<Line> detectionLines(const NamedLinks& links) {
  std::vector<Line> lines;
  for (const Detection& detection : links.report.detections) {
    Line look, all;
    look.name = links.scenario->emitters[static_cast<std::size_t>(detection.radar)].name + ", " +
                links.scenario->targets[static_cast<std::size_t>(detection.target)].name;
    all.name = look.name + ", cumulative";
    look.color = all.color = lines.size() / 2;
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

/// Limits of the ratios, in tens of dB, not below -60 dB.
std::pair<double, double> limitsOf(const std::vector<Line>& lines) {
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (const Line& line : lines) {
    for (const Point& point : line.points) {
      if (!std::isfinite(point.value)) continue;
      lowest = std::min(lowest, point.value);
      highest = std::max(highest, point.value);
    }
  }
  if (lowest > highest) return {-10, 10};
  lowest = std::max(10 * std::floor(lowest / 10), -60.0);
  return {lowest, std::max(10 * std::ceil(highest / 10), lowest + 10)};
}

}  // namespace

void plotLinks(const NamedLinks& links, render::ImageSize size, const std::string& file) {
  drawPlot(size, file, [&](Canvas& canvas) {
    const double width = canvas.size().width, height = canvas.size().height;
    const double unit = std::min(height / 800, width / 1400);
    canvas.rectangle({0, 0, width, height}, kPaper);
    const std::vector<Line> ratios = linkLines(links), detections = detectionLines(links);
    double right = 0;
    for (const std::vector<Line>* lines : {&ratios, &detections}) {
      for (const Line& line : *lines) right = std::max(right, canvas.textBox(line.name, 14 * unit).width);
    }
    const int panels = int(!ratios.empty()) + int(!detections.empty());
    const double panel_height = height / std::max(panels, 1);
    Rect frame{64 * unit, 48 * unit, width - right - 124 * unit, panel_height - 100 * unit};
    if (!ratios.empty()) {
      const auto [lowest, highest] = limitsOf(ratios);
      Panel(canvas, frame, unit)
          .draw("Signal over noise and interference (dB); wide where received", ratios, lowest, highest);
      frame.y += panel_height;
    }
    if (!detections.empty())
      Panel(canvas, frame, unit)
          .draw("Probability of detection of one look and of all looks", detections, 0, 1);
  });
}

}  // namespace emscape::app
