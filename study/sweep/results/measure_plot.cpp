#include "study/sweep/results/measure_plot.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "emscape/render/annotate/legend.h"
#include "render/annotate/plot.h"

namespace emscape::study {
namespace {

using render::Canvas;
using render::Ink;
using render::PlotPanel;
using render::Point2;

constexpr Ink kPoint{{0.00F, 0.45F, 0.70F}, 0.45};
constexpr render::ImageSize kSize{900, 420};
constexpr render::Rect kFrame{90, 40, 780, 310};
constexpr std::size_t kMaxPoints = 2000, kMaxValues = 60;

/// Points of one value, or of one interval of values.
struct Bin {
  double sum = 0, min = HUGE_VAL, max = -HUGE_VAL, sum_x = 0;
  int count = 0;
};

class Plot {
 public:
  explicit Plot(const MeasurePlot& plot) : plot_(plot), canvas_(Canvas::forSvg(kSize)) {
    for (std::size_t i = 0; i < plot.x.size(); ++i) {
      if (!std::isfinite(plot.x[i]) || !std::isfinite(plot.y[i])) continue;
      const double x = scaled(plot.x[i]);
      points_.push_back({x, plot.y[i]});
      left_ = std::min(left_, x);
      right_ = std::max(right_, x);
      bottom_ = std::min(bottom_, plot.y[i]);
      top_ = std::max(top_, plot.y[i]);
    }
    if (points_.empty()) left_ = bottom_ = 0, right_ = top_ = 1;
    widen(left_, right_, 0.03);
    widen(bottom_, top_, 0.06);
  }

  std::string draw() {
    canvas_.rectangle({0, 0, static_cast<double>(kSize.width), static_cast<double>(kSize.height)},
                      render::kPlotPaper);
    PlotPanel panel(canvas_, kFrame, 1, {left_, right_, 8, plot_.parameter, marks()}, {bottom_, top_, 6, ""});
    panel.drawTitle(plot_.measure);
    panel.drawGrid();
    const std::vector<Bin> bins = binned();
    if (points_.size() <= kMaxPoints) {
      for (const Point2& point : points_) canvas_.disc(panel.at(point.x, point.y), 3.5, kPoint);
    } else {
      for (const Bin& bin : bins) {
        const double x = bin.sum_x / bin.count;
        canvas_.line(panel.at(x, bin.min), panel.at(x, bin.max), kPoint, 5);
      }
    }
    const auto middle = [&](const Bin& bin) { return panel.at(bin.sum_x / bin.count, bin.sum / bin.count); };
    const Ink& line = render::plotInk(1);
    if (plot_.labels.empty()) {
      for (std::size_t b = 1; b < bins.size(); ++b)
        canvas_.line(middle(bins[b - 1]), middle(bins[b]), line, 2);
    }
    for (const Bin& bin : bins) canvas_.disc(middle(bin), 3, line);
    return canvas_.svg();
  }

 private:
  double scaled(double x) const { return plot_.is_logarithmic ? std::log10(x) : x; }

  static void widen(double& low, double& high, double part) {
    const double more = high > low ? part * (high - low) : std::max(1e-6, std::abs(low) * 0.05);
    low -= more;
    high += more;
  }

  /// Up to kMaxValues values, else the same number of equal intervals; none if almost every point has its own
  /// value.
  std::vector<Bin> binned() const {
    std::map<double, Bin> by_value;
    for (const Point2& point : points_) {
      double key = point.x;
      if (by_value.size() > kMaxValues) break;
      by_value[key].count = 0;
    }
    const bool has_intervals = by_value.size() > kMaxValues;
    by_value.clear();
    for (const Point2& point : points_) {
      const double key =
          has_intervals ? std::floor((point.x - left_) / (right_ - left_) * kMaxValues) : point.x;
      Bin& bin = by_value[key];
      bin.sum += point.y;
      bin.sum_x += point.x;
      bin.min = std::min(bin.min, point.y);
      bin.max = std::max(bin.max, point.y);
      ++bin.count;
    }
    std::vector<Bin> bins;
    if (has_intervals && points_.size() < 8 * kMaxValues) return bins;
    for (const auto& [key, bin] : by_value) bins.push_back(bin);
    return bins;
  }

  /// Marks of labels and of logarithmic axes; none for numbers.
  std::vector<render::PlotTick> marks() const {
    std::vector<render::PlotTick> marks;
    if (!plot_.labels.empty()) {
      const std::size_t step = (plot_.labels.size() + 7) / 8;
      for (std::size_t i = 0; i < plot_.labels.size(); i += step) {
        constexpr std::size_t kShown = 16;
        const std::string& label = plot_.labels[i];
        marks.push_back(
            {static_cast<double>(i), label.size() > kShown ? label.substr(0, kShown - 2) + ".." : label});
      }
    } else if (plot_.is_logarithmic) {
      for (double decade = std::floor(left_); decade <= right_; ++decade) {
        for (const int digit : {1, 2, 5}) {
          const double x = decade + std::log10(digit);
          if (x < left_ || x > right_) continue;
          const double value = std::pow(10, x);
          marks.push_back({x, render::tickText(value, value)});
        }
      }
    }
    return marks;
  }

  const MeasurePlot& plot_;
  Canvas canvas_;
  std::vector<Point2> points_;
  double left_ = HUGE_VAL, right_ = -HUGE_VAL, bottom_ = HUGE_VAL, top_ = -HUGE_VAL;
};

}  // namespace

std::string drawMeasure(const MeasurePlot& plot) {
  return Plot(plot).draw();
}

}  // namespace emscape::study
