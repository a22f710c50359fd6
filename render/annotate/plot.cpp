#include "render/annotate/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "base/files/own_file.h"
#include "base/files/whole_file.h"
#include "emscape/base/units.h"
#include "emscape/base/work.h"
#include "emscape/render/annotate/legend.h"

namespace emscape::render {
namespace {

constexpr std::array<Ink, 7> kInks{{{{0.00F, 0.45F, 0.70F}},
                                    {{0.84F, 0.37F, 0.00F}},
                                    {{0.00F, 0.62F, 0.45F}},
                                    {{0.80F, 0.47F, 0.65F}},
                                    {{0.90F, 0.62F, 0.00F}},
                                    {{0.34F, 0.71F, 0.91F}},
                                    {{0.25F, 0.25F, 0.25F}}}};
constexpr double kNamePx = 14, kNameOffset = 32;

bool isSvg(const std::string& file) {
  return std::filesystem::path(file).extension() == ".svg";
}

std::vector<PlotTick> ticksOf(const PlotAxis& axis) {
  if (!axis.marks.empty()) return axis.marks;
  const std::vector<double> values = roundTicks(axis.lowest, axis.highest, axis.ticks);
  const double step = values.size() > 1 ? values[1] - values[0] : 1;
  std::vector<PlotTick> ticks;
  for (const double value : values) ticks.push_back({value, tickText(value, step)});
  return ticks;
}

}  // namespace

const Ink& plotInk(std::size_t index) {
  return kInks[index % kInks.size()];
}

PlotAxis timeAxis(double begin_s, double end_s) {
  if (begin_s == end_s) return {begin_s - 0.5, end_s + 0.5, 10, "time (s)"};
  return {begin_s, end_s, 10, "time (s)"};
}

Point2 PlotPanel::at(double x, double y) const {
  return {frame_.x + frame_.width * (x - x_.lowest) / (x_.highest - x_.lowest),
          frame_.y +
              frame_.height * (y_.highest - std::clamp(y, y_.lowest, y_.highest)) / (y_.highest - y_.lowest)};
}

void PlotPanel::drawTitle(const std::string& title) {
  canvas_.text(title, {frame_.x, frame_.y - 16 * unit_}, 16 * unit_, kPlotText, Align::left, Weight::bold);
}

void PlotPanel::drawGrid() {
  for (const PlotTick& tick : ticksOf(y_)) {
    const Point2 left = at(x_.lowest, tick.at);
    canvas_.line(left, at(x_.highest, tick.at), kPlotGrid, unit_);
    canvas_.text(tick.text, {left.x - 8 * unit_, left.y}, 14 * unit_, kPlotText, Align::right);
  }
  for (const PlotTick& tick : ticksOf(x_)) {
    const Point2 bottom = at(tick.at, y_.lowest);
    canvas_.line({bottom.x, frame_.y}, bottom, kPlotGrid, unit_);
    canvas_.text(tick.text, {bottom.x, bottom.y + 16 * unit_}, 14 * unit_, kPlotText, Align::center);
  }
  if (!x_.title.empty()) {
    canvas_.text(x_.title, {frame_.x + frame_.width, frame_.y + frame_.height + 36 * unit_}, 14 * unit_,
                 kPlotText, Align::right);
  }
  if (!y_.title.empty()) {
    canvas_.text(y_.title, {frame_.x - 66 * unit_, frame_.y + frame_.height / 2}, 14 * unit_, kPlotText,
                 Align::center, Weight::normal, -kPi / 2);
  }
}

void PlotPanel::drawGround(const std::vector<Point2>& heights) const {
  std::vector<Point2> surface;
  const auto drawPiece = [&] {
    if (surface.size() > 1) {
      std::vector<Point2> body = surface;
      const double bottom = frame_.y + frame_.height;
      body.push_back({surface.back().x, bottom});
      body.push_back({surface.front().x, bottom});
      canvas_.polygon(body, kPlotGround);
      canvas_.outline(surface, kPlotSurface, 1.6 * unit_, false);
    }
    surface.clear();
  };
  for (const Point2& height : heights) {
    if (std::isnan(height.y)) {
      drawPiece();
    } else {
      surface.push_back(at(height.x, height.y));
    }
  }
  drawPiece();
}

void PlotPanel::drawBand(double x_begin, double x_end, const Ink& ink) const {
  const double left = at(x_begin, y_.lowest).x;
  canvas_.rectangle({left, frame_.y, at(x_end, y_.lowest).x - left, frame_.height}, ink);
}

void PlotPanel::drawLine(const PlotLine& line) {
  drawLonePoints(line);
  if (line.is_dashed) {
    drawDashed(line);
    return;
  }
  for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
    const PlotLine::Point &a = line.points[i], &b = line.points[i + 1];
    if (!std::isfinite(a.y) || !std::isfinite(b.y)) continue;
    canvas_.line(at(a.x, a.y), at(b.x, b.y), line.ink, (a.is_strong ? 3 : 1.2) * unit_, line.is_dashed);
  }
}

void PlotPanel::drawLonePoints(const PlotLine& line) {
  const auto isKnown = [&](std::size_t i) {
    return i < line.points.size() && std::isfinite(line.points[i].y);
  };
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    const PlotLine::Point& point = line.points[i];
    if (isKnown(i) && !isKnown(i + 1) && (i == 0 || !isKnown(i - 1)))
      canvas_.disc(at(point.x, point.y), (point.is_strong ? 5 : 3) * unit_, line.ink);
  }
}

/// Points of equal width are one path, since dashes begin anew with each path.
void PlotPanel::drawDashed(const PlotLine& line) {
  std::vector<Point2> path;
  const std::size_t count = line.points.size();
  for (std::size_t i = 0; i < count; ++i) {
    const PlotLine::Point& here = line.points[i];
    const bool is_known = std::isfinite(here.y);
    if (is_known) path.push_back(at(here.x, here.y));
    const bool goes_on =
        is_known && i + 1 < count && (path.size() == 1 || here.is_strong == line.points[i - 1].is_strong);
    if (goes_on) continue;
    if (path.size() > 1) {
      const bool is_strong = line.points[is_known ? i - 1 : i - 2].is_strong;  // of the last segment
      canvas_.outline(path, line.ink, (is_strong ? 3 : 1.2) * unit_, false, true);
    }
    path.clear();
    if (is_known) path.push_back(at(here.x, here.y));
  }
}

void PlotPanel::drawNames(const std::vector<PlotLine>& lines, double top) {
  std::vector<const PlotLine*> named;
  for (const PlotLine& line : lines) {
    if (!line.name.empty()) named.push_back(&line);
  }
  constexpr double kRow = 22, kBelow = 30;  // space below the frame for an axis's numbers and title
  const auto rows = static_cast<std::size_t>(std::max((frame_.height / unit_ + kBelow - top) / kRow, 4.0));
  const bool fits = named.size() <= rows;
  const std::size_t tail = 2, head = fits ? named.size() : rows - 1 - tail;
  const double x = frame_.x + frame_.width + 14 * unit_;
  double y = frame_.y + top * unit_;
  for (std::size_t i = 0; i < named.size(); ++i, y += kRow * unit_) {
    if (i == head) {
      const std::size_t left_out = named.size() - head - tail;
      canvas_.text(fmt::format("and {} more", left_out), {x + kNameOffset * unit_, y}, kNamePx * unit_,
                   kPlotFaintText);
      y += kRow * unit_;
      i += left_out;
    }
    canvas_.line({x, y}, {x + 24 * unit_, y}, named[i]->ink, 2.5 * unit_, named[i]->is_dashed);
    canvas_.text(named[i]->name, {x + kNameOffset * unit_, y}, kNamePx * unit_, kPlotText);
  }
}

double PlotPanel::namesWidth(const Canvas& canvas, const std::vector<PlotLine>& lines, double unit) {
  double width = 0;
  for (const PlotLine& line : lines) width = std::max(width, canvas.textBox(line.name, kNamePx * unit).width);
  return width;
}

double fittedSize_px(const Canvas& canvas, const std::string& text, double size_px, double room_px,
                     Weight weight) {
  const double width = canvas.textBox(text, size_px, weight).width;
  return width > room_px ? size_px * room_px / width : size_px;
}

std::vector<std::string> wrappedText(const Canvas& canvas, const std::string& text, double width_px,
                                     double size_px) {
  std::vector<std::string> lines(1);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    const std::string longer = lines.back().empty() ? word : lines.back() + " " + word;
    if (canvas.textBox(longer, size_px).width <= width_px) {
      lines.back() = longer;
    } else {
      lines.push_back(word);
    }
    begin = end + 1;
  }
  return lines;
}

bool isPlotFile(const std::string& file) {
  return isSvg(file) || std::filesystem::path(file).extension() == ".png";
}

void drawPlot(ImageSize size, const std::string& file, const std::function<void(Canvas&)>& draw) {
  const WorkPart part("drawing " + std::filesystem::path(file).filename().string(), 0, 0);
  Canvas canvas = isSvg(file) ? Canvas::forSvg(size) : Canvas(size);
  draw(canvas);
  if (isSvg(file)) {
    const std::string text = canvas.svg();
    writeWhole(file, [&](std::ostream& out) { out << text << "<!-- Emscape -->\n"; });
  } else {
    requireOwn(file);
    writePng(file, canvas.pixels());
  }
}

}  // namespace emscape::render
