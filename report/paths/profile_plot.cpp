#include "report/paths/profile_plot.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text/quantity_text.h"
#include "emfield/link/path_report.h"
#include "emscape/base/units.h"
#include "emscape/render/annotate/legend.h"
#include "render/annotate/plot.h"

namespace emscape::report {
namespace {

using emfield::PathBudget;
using emfield::PathObstacle;
using emfield::PathProfile;
using render::Align;
using render::Canvas;
using render::Ink;
using render::Point2;
using render::Rect;
using render::Weight;

constexpr Ink kSky{{0.925F, 0.955F, 0.985F}};
constexpr Ink kSea{{0.16F, 0.42F, 0.72F}};
constexpr Ink kCover{{0.29F, 0.52F, 0.27F}};
constexpr Ink kZone{{0.98F, 0.72F, 0.20F}, 0.38};
constexpr Ink kZoneRim{{0.82F, 0.54F, 0.06F}, 0.9};
constexpr Ink kClearRay{{0.06F, 0.46F, 0.25F}};
constexpr Ink kBlockedRay{{0.76F, 0.12F, 0.13F}};
constexpr Ink kMast{{0.10F, 0.16F, 0.30F}};

class ProfilePlot {
 public:
  ProfilePlot(const PathBudget& budget, Canvas& canvas)
      : budget_(budget),
        profile_(budget.profile),
        canvas_(canvas),
        unit_(std::min(canvas.size().height / 800.0, canvas.size().width / 1200.0)) {
    const double width = canvas.size().width, height = canvas.size().height;
    frame_ = {84 * unit_, 118 * unit_, width - 112 * unit_, height - 184 * unit_};
    setScale();
  }

  void draw() {
    canvas_.rectangle({0, 0, double(canvas_.size().width), double(canvas_.size().height)},
                      render::kPlotPaper);
    canvas_.rectangle(frame_, kSky);
    drawZone();
    if (!profile_.cover_m.empty()) drawBody(kCover, [&](int i) { return profile_.topMsl_m(i); });
    drawGround();
    drawGrid();
    drawRay();
    drawMast(profile_.begin, 0, Align::left, budget_.emitter);
    drawMast(profile_.end, profile_.count() - 1, Align::right, "point");
    for (const PathObstacle& obstacle : budget_.obstacles) drawObstacle(obstacle);
    canvas_.outline(corners(), render::kPlotFaintText, unit_, true);
    drawLegend();
    drawTitle();
  }

 private:
  double wavelength() const { return wavelength_m(budget_.frequency_hz); }
  double bulgeAt(double range_m) const {
    return range_m * (profile_.range_m - range_m) / (2 * profile_.effective_earth_radius_m);
  }
  /// Position in the plot of a height above mean sea level at a range.
  Point2 at(double range_m, double height_msl_m) const {
    return {frame_.x + frame_.width * range_m / profile_.range_m,
            frame_.y + frame_.height * (top_m_ - height_msl_m - bulgeAt(range_m)) / (top_m_ - bottom_m_)};
  }
  Point2 at(int post, double height_msl_m) const { return at(profile_.ranges_m[post], height_msl_m); }
  double groundAt(int post) const { return static_cast<double>(profile_.ground_msl_m[post]); }
  std::vector<Point2> corners() const {
    return {{frame_.x, frame_.y},
            {frame_.x + frame_.width, frame_.y},
            {frame_.x + frame_.width, frame_.y + frame_.height},
            {frame_.x, frame_.y + frame_.height}};
  }

  /// Limits of the plot: ground, zone and masts, with room above for labels.
  void setScale() {
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (int i = 0; i < profile_.count(); ++i) {
      const double radius_m = profile_.fresnelRadius_m(i, wavelength());
      const double bulge_m = bulgeAt(profile_.ranges_m[i]);
      lowest = std::min({lowest, groundAt(i) + bulge_m, profile_.ray_msl_m[i] - radius_m + bulge_m});
      highest =
          std::max({highest, profile_.topMsl_m(i) + bulge_m, profile_.ray_msl_m[i] + radius_m + bulge_m});
    }
    const double span = std::max(highest - lowest, 10.0);
    bottom_m_ = lowest - 0.08 * span;
    top_m_ = highest + 0.24 * span;
  }

  void drawGround() {
    canvas_.outline(drawBody(render::kPlotGround, [&](int i) { return groundAt(i); }), render::kPlotSurface,
                    1.6 * unit_, false);
  }

  /// Fills the plot below a surface. @return the surface
  template <class HeightOf>
  std::vector<Point2> drawBody(const Ink& ink, HeightOf heightOf) {
    std::vector<Point2> surface;
    for (int i = 0; i < profile_.count(); ++i) surface.push_back(at(i, heightOf(i)));
    std::vector<Point2> body = surface;
    body.push_back(corners()[2]);
    body.push_back(corners()[3]);
    canvas_.polygon(body, ink);
    return surface;
  }

  /// Lines of equal height, which curve with the earth, and of equal range.
  void drawGrid() {
    const std::vector<double> heights = render::roundTicks(bottom_m_, top_m_, 8);
    const double step_m = heights.size() > 1 ? heights[1] - heights[0] : 1;
    for (const double height_m : heights) {
      drawLevel(height_m, height_m == 0 && profile_.has_terrain ? kSea : render::kPlotGrid, unit_);
      const Point2 place = at(0.0, height_m);
      canvas_.text(render::tickText(height_m, step_m), {frame_.x - 8 * unit_, place.y}, 14 * unit_,
                   render::kPlotText, Align::right);
    }
    const std::vector<double> ranges = render::roundTicks(0, profile_.range_m / 1000, 10);
    const double step_km = ranges.size() > 1 ? ranges[1] - ranges[0] : 1;
    const double bottom = frame_.y + frame_.height;
    for (const double range_km : ranges) {
      const double x = frame_.x + frame_.width * range_km * 1000 / profile_.range_m;
      canvas_.line({x, frame_.y}, {x, bottom}, render::kPlotGrid, unit_);
      canvas_.text(render::tickText(range_km, step_km), {x, bottom + 16 * unit_}, 14 * unit_,
                   render::kPlotText, Align::center);
    }
    canvas_.text("Distance over the ground (km)", {frame_.x + frame_.width / 2, bottom + 42 * unit_},
                 15 * unit_, render::kPlotText, Align::center);
    canvas_.text("Height above mean sea level (m)", {22 * unit_, frame_.y + frame_.height / 2}, 15 * unit_,
                 render::kPlotText, Align::center, Weight::normal, -kPi / 2);
  }

  /// A line of equal height, clipped to the frame.
  void drawLevel(double height_msl_m, const Ink& ink, double width) {
    constexpr int kPieces = 100;
    std::vector<Point2> line;
    for (int i = 0; i <= kPieces; ++i) {
      const Point2 point = at(profile_.range_m * i / kPieces, height_msl_m);
      if (point.y >= frame_.y && point.y <= frame_.y + frame_.height) line.push_back(point);
    }
    if (line.size() > 1) canvas_.outline(line, ink, width, false);
  }

  /// Draws the first Fresnel zone, with its radius at each range.
  void drawZone() {
    constexpr int kPieces = 200;
    const Point2 begin = at(0.0, profile_.begin.height_msl_m),
                 end = at(profile_.range_m, profile_.end.height_msl_m);
    const double pixels_per_m = frame_.height / (top_m_ - bottom_m_);
    std::vector<Point2> rim;
    for (int i = -kPieces; i <= kPieces; ++i) {
      // forward above the ray, back below it; denser at the ends, where the curvature is large
      const double part = (1 - std::cos(kPi * (1 - std::abs(double(i)) / kPieces))) / 2;
      const double radius_m = std::sqrt(wavelength() * profile_.range_m * part * (1 - part));
      const Point2 on_ray = begin + (end - begin) * part;
      rim.push_back({on_ray.x, on_ray.y + (i < 0 ? -1 : 1) * radius_m * pixels_per_m});
    }
    canvas_.polygon(rim, kZone);
    canvas_.outline(rim, kZoneRim, unit_, true);
  }

  bool isBlocked() const { return emfield::isBlocked(budget_); }

  void drawRay() {
    const Point2 begin = at(0.0, profile_.begin.height_msl_m),
                 end = at(profile_.range_m, profile_.end.height_msl_m);
    canvas_.line(begin, end, isBlocked() ? kBlockedRay : kClearRay, 2.4 * unit_, isBlocked());
  }

  void drawObstacle(const PathObstacle& obstacle) {
    const Point2 top = at(obstacle.post, profile_.topMsl_m(obstacle.post));
    const Point2 ray = at(obstacle.post, profile_.ray_msl_m[obstacle.post]);
    const Ink ink = obstacle.clearance_m < 0 ? kBlockedRay : kClearRay;
    canvas_.line(top, ray, ink, (obstacle.decides ? 2 : 1.2) * unit_);
    canvas_.disc(top, (obstacle.decides ? 6 : 4) * unit_, ink);
    if (!obstacle.decides) return;
    label(top.x, Align::center, ink,
          {fmt::format("{:.1f} km: {:.0f} m {} the ray", obstacle.range_m / 1000,
                       std::abs(obstacle.clearance_m), obstacle.clearance_m < 0 ? "above" : "below"),
           fmt::format("{:.1f} Fresnel radii{}", std::abs(obstacle.clearanceInFresnelRadii()),
                       obstacle.cover_m > 0 ? "; " + emfield::coverText(obstacle) : "")});
  }

  void drawMast(const emfield::PathEnd& end, int post, Align align, const std::string& name) {
    const Point2 ground = at(post, groundAt(post)), top = at(post, end.height_msl_m);
    canvas_.line(ground, top, kMast, 2.5 * unit_, align == Align::right);
    canvas_.disc(top, 6 * unit_, kMast);
    labelEnd(top, align,
             {name, fmt::format("{:.0f} m, {:.0f} m above ground", end.height_msl_m,
                                end.height_msl_m - groundAt(post))});
  }

  /// The label of an end beside its point: above it, or below it if the ray goes up from there.
  void labelEnd(const Point2& top, Align align, const std::array<std::string, 2>& words) {
    const double row = 20 * unit_, gap = 12 * unit_;
    const double width = std::max(canvas_.textBox(words[0], 15 * unit_, Weight::bold).width,
                                  canvas_.textBox(words[1], 14 * unit_).width);
    const Point2 other = align == Align::left ? at(profile_.range_m, profile_.end.height_msl_m)
                                              : at(0.0, profile_.begin.height_msl_m);
    // The ray's height over the label's far side.
    const double lift = (top.y - other.y) * (width + 2 * gap) / std::max(frame_.width, 1.0);
    const bool is_below = lift > 0.5 * gap && top.y + gap + 2 * row < frame_.y + frame_.height;
    Rect box{align == Align::left ? top.x + gap : top.x - gap - width,
             is_below ? top.y + 0.4 * gap : top.y - gap - 2 * row, width, 2 * row};
    box.y = std::max(box.y, frame_.y + 0.3 * gap);
    drawLabel(box, align, kMast, words);
  }

  /// A title and a remark over the plot.
  void label(double x, Align align, const Ink& ink, const std::array<std::string, 2>& words) {
    const double row = 20 * unit_, gap = 12 * unit_;
    const double width = std::max(canvas_.textBox(words[0], 15 * unit_, Weight::bold).width,
                                  canvas_.textBox(words[1], 14 * unit_).width);
    Rect box{x - width / 2, 0, width, 2 * row};
    if (align == Align::left) box.x = x + gap;
    if (align == Align::right) box.x = x - gap - width;
    box.x =
        std::clamp(box.x, frame_.x + gap, std::max(frame_.x + gap, frame_.x + frame_.width - gap - width));
    box.y = highestBetween(box.x - gap, box.x + width + gap) - gap - box.height;
    const auto isTaken = [&](const Rect& other) { return overlap(box, other); };
    while (std::any_of(labels_.begin(), labels_.end(), isTaken)) box.y -= row;
    box.y = std::max(box.y, frame_.y);
    drawLabel(box, align, ink, words);
  }

  void drawLabel(const Rect& box, Align align, const Ink& ink, const std::array<std::string, 2>& words) {
    const double row = 20 * unit_;
    labels_.push_back(box);
    const double anchor = align == Align::left    ? box.x
                          : align == Align::right ? box.x + box.width
                                                  : box.x + box.width / 2;
    canvas_.textWithRim(words[0], {anchor, box.y + row / 2}, 15 * unit_, ink, render::kPlotPaper, align,
                        Weight::bold);
    canvas_.textWithRim(words[1], {anchor, box.y + 1.5 * row}, 14 * unit_, ink, render::kPlotPaper, align);
  }

  /// The uppermost pixel of ground and zone between two columns of the picture.
  double highestBetween(double left, double right) const {
    double highest = frame_.y + frame_.height;
    for (int i = 0; i < profile_.count(); ++i) {
      const Point2 top = at(i, profile_.topMsl_m(i));
      if (top.x < left || top.x > right) continue;
      const double zone_msl_m = profile_.ray_msl_m[i] + profile_.fresnelRadius_m(i, wavelength());
      highest = std::min({highest, top.y, at(i, zone_msl_m).y});
    }
    return highest;
  }

  void drawLegend() {
    const double row = 20 * unit_, y = frame_.y - 16 * unit_;
    double x = frame_.x;
    const auto entry = [&](const std::string& words, auto sample) {
      sample(Rect{x, y - row / 4, 26 * unit_, row / 2});
      canvas_.text(words, {x + 34 * unit_, y}, 14 * unit_, render::kPlotText);
      x += 34 * unit_ + canvas_.textBox(words, 14 * unit_).width + 28 * unit_;
    };
    const auto middle = [](const Rect& box) { return box.y + box.height / 2; };
    entry(profile_.has_terrain ? "ground" : "smooth earth",
          [&](const Rect& box) { canvas_.rectangle(box, render::kPlotGround); });
    if (!profile_.cover_m.empty())
      entry("ground cover", [&](const Rect& box) { canvas_.rectangle(box, kCover); });
    entry(isBlocked() ? "ray, blocked" : "ray", [&](const Rect& box) {
      canvas_.line({box.x, middle(box)}, {box.x + box.width, middle(box)},
                   isBlocked() ? kBlockedRay : kClearRay, 2.4 * unit_, isBlocked());
    });
    entry("first Fresnel zone", [&](const Rect& box) { canvas_.rectangle(box, kZone); });
    entry(budget_.obstacles.size() > 1 ? "obstacles, the largest decides" : "nearest to the ray",
          [&](const Rect& box) {
            canvas_.disc({box.x + box.width / 2, middle(box)}, 4 * unit_,
                         isBlocked() ? kBlockedRay : kClearRay);
          });
    const double vertical = frame_.height / (top_m_ - bottom_m_), level = frame_.width / profile_.range_m;
    canvas_.text(fmt::format("earth of {:.3g} times its radius; heights {:.3g}-fold", budget_.k_factor,
                             vertical / level),
                 {frame_.x + frame_.width, y}, 14 * unit_, render::kPlotFaintText, Align::right);
  }

  void drawTitle() {
    const emfield::PathEnd& end = profile_.end;
    const std::string title =
        fmt::format("{} to {:.5f}, {:.5f} deg   ({}, {}, t = {:g} s)", budget_.emitter,
                    end.position.latitude_deg, end.position.longitude_deg,
                    quantityText(budget_.frequency_hz, "Hz", 4), toString(budget_.model), budget_.time_s);
    canvas_.text(title, {frame_.x, 26 * unit_},
                 render::fittedSize_px(canvas_, title, 20 * unit_, frame_.width, Weight::bold),
                 render::kPlotText, Align::left, Weight::bold);
    double y = 54 * unit_;
    for (const std::string& line : render::wrappedText(canvas_, budget_.verdict, frame_.width, 16 * unit_)) {
      canvas_.text(line, {frame_.x, y}, 16 * unit_, render::kPlotText);
      y += 21 * unit_;
    }
  }

  const PathBudget& budget_;
  const PathProfile& profile_;
  Canvas& canvas_;
  double unit_;  ///< pixels per pixel of a 1200 x 800 picture
  Rect frame_;
  double bottom_m_ = 0, top_m_ = 0;  ///< over the chord between the ends' sea levels
  std::vector<Rect> labels_;         ///< areas of labels
};

}  // namespace

void plotProfile(const PathBudget& budget, render::ImageSize size, const std::string& file) {
  render::drawPlot(size, file, [&](Canvas& canvas) { ProfilePlot(budget, canvas).draw(); });
}

}  // namespace emscape::report
