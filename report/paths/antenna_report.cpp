#include "report/paths/antenna_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "emscape/base/units.h"
#include "render/annotate/plot.h"

namespace emscape::report {
namespace {

using render::Canvas;
using render::Point2;

constexpr double kCenter_db = -40;  ///< at the middle of a diagram

/// Level (dB) below the maximum in a direction.
double levelTowards_db(const scenario::Antenna& antenna, double azimuth_deg, double elevation_deg) {
  const double azimuth_rad = degToRad(azimuth_deg), elevation_rad = degToRad(elevation_deg);
  const Vec3d direction{std::cos(elevation_rad) * std::cos(azimuth_rad),
                        std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
  return 2 * ratioToDb(antenna.amplitudeTowards(direction, 0, 0));
}

struct PatternPeak {
  double azimuth_deg = 0, elevation_deg = 0;
};

/// The largest value of a grid, the one nearest to boresight of equal ones.
PatternPeak peakOf(const scenario::PatternFile& pattern) {
  const auto& [azimuths_deg, elevations_deg] = pattern.nodes;
  PatternPeak peak;
  float largest = -1;
  double nearest_deg = 0;
  for (std::size_t e = 0; e < elevations_deg.size(); ++e) {
    for (std::size_t a = 0; a < azimuths_deg.size(); ++a) {
      const float amplitude = pattern.amplitudes[e * azimuths_deg.size() + a];
      const double away_deg = std::hypot(azimuths_deg[a], elevations_deg[e]);
      if (amplitude < largest || (amplitude == largest && away_deg >= nearest_deg)) continue;
      largest = amplitude;
      nearest_deg = away_deg;
      peak = {azimuths_deg[a], elevations_deg[e]};
    }
  }
  return peak;
}

/// A polar diagram. Angles run clockwise from a direction of the page.
class PolarDiagram {
 public:
  PolarDiagram(Canvas& canvas, const Point2& center, double radius, double unit)
      : canvas_(canvas), center_(center), radius_(radius), unit_(unit) {}

  /// @param zero_rad  of the page's clockwise angles from upwards, where the diagram's angle is 0
  /// @param levelAt   level (dB) at an angle (deg)
  void draw(const std::string& title, double zero_rad, const std::vector<std::string>& names,
            const std::function<double(double)>& levelAt) const {
    canvas_.text(title, {center_.x, center_.y - radius_ - 56 * unit_}, 17 * unit_, render::kPlotText,
                 render::Align::center, render::Weight::bold);
    for (double level_db = 0; level_db > kCenter_db; level_db -= 10) {
      const double radius = radiusOf(level_db);
      canvas_.circle(center_, radius, render::kPlotGrid, unit_);
      canvas_.text(fmt::format("{:g}", level_db), at(radius, degToRad(20.0)) + Point2{4 * unit_, 0},
                   13 * unit_, render::kPlotFaintText);
    }
    for (std::size_t i = 0; i < 12; ++i) {
      const double angle_rad = zero_rad + degToRad(30.0 * static_cast<double>(i));
      canvas_.line(center_, at(radius_, angle_rad), render::kPlotGrid, unit_);
      canvas_.text(names[i], at(radius_ + 30 * unit_, angle_rad), 13 * unit_, render::kPlotText,
                   render::Align::center);
    }
    std::vector<Point2> line;
    constexpr int kParts = 1440;
    for (int i = 0; i < kParts; ++i) {
      const double angle_deg = 360.0 * i / kParts;
      line.push_back(at(radiusOf(levelAt(angle_deg)), zero_rad + degToRad(angle_deg)));
    }
    canvas_.outline(line, render::plotInk(0), 2.5 * unit_, true);
  }

 private:
  double radiusOf(double level_db) const { return radius_ * std::clamp(1 - level_db / kCenter_db, 0.0, 1.0); }
  Point2 at(double radius, double clockwise_rad) const {
    return {center_.x + radius * std::sin(clockwise_rad), center_.y - radius * std::cos(clockwise_rad)};
  }

  Canvas& canvas_;
  Point2 center_;
  double radius_, unit_;
};

}  // namespace

AntennaReport readAntennaReport(const std::string& file) {
  AntennaReport report{file, scenario::readPatternFile(file), nullptr, {}};
  report.antenna =
      scenario::antennaOf(file, report.pattern, report.pattern.gain_dbi.value_or(0), report.warnings);
  return report;
}

Json antennaJson(const AntennaReport& report) {
  const PatternPeak peak = peakOf(report.pattern);
  return {{"kind", "antenna"},
          {"file", report.file},
          {"format", report.pattern.format},
          {"description", report.antenna->description},
          {"gain_dbi", number(report.pattern.gain_dbi)},
          {"directivity_dbi", report.antenna->directivity_dbi()},
          {"beamwidth_az_deg", report.antenna->beamwidth_az_deg},
          {"beamwidth_el_deg", report.antenna->beamwidth_el_deg},
          {"maximum_azimuth_deg", peak.azimuth_deg},
          {"maximum_elevation_deg", peak.elevation_deg},
          {"notes", report.pattern.notes},
          {"warnings", report.warnings}};
}

void plotAntenna(const AntennaReport& report, render::ImageSize size, const std::string& file) {
  const PatternPeak peak = peakOf(report.pattern);
  render::drawPlot(size, file, [&](Canvas& canvas) {
    const double width = canvas.size().width, height = canvas.size().height;
    const double unit = std::min(height / 800, width / 1400);
    canvas.rectangle({0, 0, width, height}, render::kPlotPaper);
    const std::string gain =
        report.pattern.gain_dbi ? fmt::format("{:.2f} dBi", *report.pattern.gain_dbi) : "no gain in the file";
    const std::string title = fmt::format(
        "{}: {}, {}", std::filesystem::path(report.file).filename().string(), report.pattern.name, gain);
    canvas.text(title, {40 * unit, 30 * unit},
                render::fittedSize_px(canvas, title, 20 * unit, width - 80 * unit, render::Weight::bold),
                render::kPlotText, render::Align::left, render::Weight::bold);
    canvas.text(fmt::format("beamwidth {:.1f} deg in azimuth, {:.1f} deg in elevation; dB below the maximum",
                            report.antenna->beamwidth_az_deg, report.antenna->beamwidth_el_deg),
                {40 * unit, 58 * unit}, 15 * unit, render::kPlotFaintText);
    const double radius = std::min(width / 4 - 70 * unit, height / 2 - 130 * unit);
    const double middle_y = height / 2 + 70 * unit;
    std::vector<std::string> azimuths, elevations;
    for (int angle = 0; angle < 360; angle += 30) {
      azimuths.push_back(fmt::format("{}", angle > 180 ? angle - 360 : angle));
      // Clockwise from the horizon ahead, which is to the right: downwards.
      elevations.push_back(angle == 180  ? "behind"
                           : angle < 180 ? fmt::format("{}", angle <= 90 ? -angle : angle - 180)
                                         : fmt::format("{}", angle <= 270 ? angle - 180 : 360 - angle));
    }
    PolarDiagram(canvas, {width / 4, middle_y}, radius, unit)
        .draw(fmt::format("azimuth, at elevation {:g} deg", peak.elevation_deg), 0, azimuths,
              [&](double angle_deg) {
                return levelTowards_db(*report.antenna, angle_deg, peak.elevation_deg);
              });
    PolarDiagram(canvas, {3 * width / 4, middle_y}, radius, unit)
        .draw(fmt::format("elevation, at azimuth {:g} deg", peak.azimuth_deg), degToRad(90.0), elevations,
              [&](double angle_deg) {
                const double down_deg = std::remainder(angle_deg, 360.0);
                const bool is_behind = std::abs(down_deg) > 90;
                return levelTowards_db(
                    *report.antenna, peak.azimuth_deg + (is_behind ? 180 : 0),
                    is_behind ? std::copysign(180 - std::abs(down_deg), -down_deg) : -down_deg);
              });
  });
}

}  // namespace emscape::report
