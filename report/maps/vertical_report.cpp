#include "report/maps/vertical_report.h"

#include <algorithm>
#include <cmath>

#include "base/files/whole_file.h"
#include "base/text/quantity_text.h"
#include "emscape/base/work.h"
#include "report/text.h"
#include "report/warnings.h"

namespace emscape::report {
namespace {

using emfield::HeightReference;
using study::VerticalCut;
using study::VerticalDiagram;

bool isAboveGround(const VerticalDiagram& diagram) {
  return diagram.request.axis == HeightReference::ground;
}

Json toJson(const std::vector<VerticalCut::Line>& lines) {
  Json json = Json::array();
  for (const VerticalCut::Line& line : lines) {
    Json points = Json::array();
    for (const VerticalCut::Point& point : line) points.push_back({point.range_m, point.height_m});
    json.push_back(points);
  }
  return json;
}

}  // namespace

VerticalReach reachOf(const VerticalDiagram& diagram, const VerticalCut& cut) {
  VerticalReach reach;
  std::size_t covered = 0, known = 0, last_known = 0, last_covered = 0;
  const std::size_t width = diagram.ranges_m.size();
  for (std::size_t i = 0; i < width; ++i) {
    for (std::size_t k = 0; k < diagram.heights_m.size(); ++k) {
      const float value = cut.values[k * width + i];
      if (std::isnan(value)) continue;
      ++known;
      last_known = i;
      if (!(static_cast<double>(value) >= diagram.request.threshold)) continue;
      ++covered;
      last_covered = i;
      if (reach.is_any && reach.range_m == diagram.ranges_m[i]) continue;
      reach.is_any = true;
      reach.range_m = diagram.ranges_m[i];
      reach.height_m = diagram.heights_m[k];
    }
  }
  reach.is_at_edge = reach.is_any && last_covered == last_known;
  if (known > 0) reach.covered_part = static_cast<double>(covered) / static_cast<double>(known);
  return reach;
}

Json verticalJson(const VerticalDiagram& diagram, bool with_grid) {
  const study::VerticalRequest& request = diagram.request;
  const std::string height = isAboveGround(diagram) ? "height_agl_m" : "height_msl_m";
  Json json{{"scenario", diagram.scenario},
            {"emitter", diagram.emitter},
            {"model", diagram.model},
            {"clutter", diagram.clutter},
            {"time_s", request.time_s},
            {"quantity", scenario::info(request.quantity).name},
            {"unit", diagram.unit},
            {"threshold", request.threshold},
            {"radar_look", "target"},
            {"latitude_deg", diagram.latitude_deg},
            {"longitude_deg", diagram.longitude_deg},
            {"station_msl_m", diagram.station_msl_m},
            {"station_agl_m", diagram.station_agl_m},
            {"smooth_earth", request.smooth_earth},
            {"k_factor", diagram.k_factor},
            {"effective_earth_radius_m", diagram.effective_earth_radius_m},
            {"contour_columns", {"range_m", height}}};
  if (request.smooth_earth) json["surface_msl_m"] = diagram.surface_msl_m;
  json["azimuths"] = Json::array();
  for (const VerticalCut& cut : diagram.cuts) {
    checkpoint();
    const VerticalReach reach = reachOf(diagram, cut);
    Json of_cut{{"azimuth_deg", cut.azimuth_deg},
                {"max_range_m", reach.is_any ? Json(reach.range_m) : Json(nullptr)},
                {"max_range_" + height, reach.is_any ? Json(reach.height_m) : Json(nullptr)},
                {"max_range_is_edge", reach.is_at_edge},
                {"covered_part", reach.covered_part},
                {"contours", toJson(cut.contours)}};
    if (request.smooth_earth) of_cut["free_space"] = toJson(cut.free_space);
    if (with_grid) {
      Json values = Json::array(), ground = Json::array();
      for (const float value : cut.values) values.push_back(number(static_cast<double>(value)));
      for (const float value : cut.ground_msl_m) ground.push_back(number(static_cast<double>(value)));
      of_cut["ground_msl_m"] = ground;
      of_cut["values"] = values;
    }
    json["azimuths"].push_back(of_cut);
  }
  if (with_grid) {
    json["range_m"] = diagram.ranges_m;
    json[height] = diagram.heights_m;
    json["order"] = "values[height][range], range fastest";
  }
  json["warnings"] = joinedWarnings(diagram.warnings);
  return json;
}

std::string verticalText(const VerticalDiagram& diagram) {
  Text out;
  const study::VerticalRequest& request = diagram.request;
  out.add("Vertical coverage of '{}' in {}, t = {:g} s: {} >= {}\n", diagram.emitter, diagram.scenario,
          request.time_s, scenario::info(request.quantity).name,
          quantityText(request.threshold, diagram.unit));
  if (request.smooth_earth) {
    out.add("Smooth earth of {:.4g} times its radius; the antenna is {:.1f} m above it\n", diagram.k_factor,
            diagram.station_msl_m);
  }
  out.add("ground cover along the paths: {}\n", diagram.clutter);
  out.add("  {:>11} {:>12} {:>14} {:>9}   {}\n", "azimuth deg", "farthest km", "from height m", "covered",
          "contours");
  bool has_edge = false;
  for (const VerticalCut& cut : diagram.cuts) {
    const VerticalReach reach = reachOf(diagram, cut);
    out.add("  {:>11g} {:>12} {:>14} {:>8.1f}%   {}\n", cut.azimuth_deg,
            reach.is_any ? fmt::format("{}{:.1f}", reach.is_at_edge ? "> " : "", reach.range_m / 1000) : "-",
            reach.is_any ? fmt::format("{:.0f}", reach.height_m) : "-", 100 * reach.covered_part,
            cut.contours.size());
    has_edge = has_edge || reach.is_at_edge;
  }
  if (has_edge) {
    out.add(
        "  >: the diagram ends there, or the elevation data; the threshold is still reached (--range M goes "
        "farther)\n");
  }
  return out.take();
}

void writeVerticalCsv(const VerticalDiagram& diagram, const std::string& file) {
  writeWhole(file, [&](std::ostream& out) {
    out << "kind,azimuth_deg,line,range_m,slant_range_m,elevation_deg,height_msl_m,height_agl_m,"
        << scenario::info(diagram.request.quantity).name << "\n";
    const std::size_t width = diagram.ranges_m.size();
    const auto row = [&](const char* kind, const VerticalCut& cut, const std::string& line, double range_m,
                         double height_m, const std::string& value) {
      // The ground is linear between its points.
      const double step_m = diagram.ranges_m[1] - diagram.ranges_m[0];
      const double index = std::clamp((range_m - diagram.ranges_m[0]) / step_m, 0.0, double(width - 1));
      const auto i = std::min(static_cast<std::size_t>(index), width - 2);
      const double part = index - static_cast<double>(i);
      const auto ground = [&](std::size_t post) {
        return cut.ground_msl_m.empty() ? 0 : static_cast<double>(cut.ground_msl_m[post]);
      };
      // A neighbour with weight 0 may be unknown.
      const double ground_m = part == 0 ? ground(i) : (1 - part) * ground(i) + part * ground(i + 1);
      const double msl_m = isAboveGround(diagram) ? height_m + ground_m : height_m;
      const auto text = [](double number, int decimals) {
        return std::isfinite(number) ? fmt::format("{:.{}f}", number, decimals) : std::string();
      };
      out << fmt::format("{},{:g},{},{:.2f},{},{},{},{},{}\n", kind, cut.azimuth_deg, line, range_m,
                         text(diagram.slantRange_m(range_m, msl_m), 2),
                         text(diagram.elevation_deg(range_m, msl_m), 5), text(msl_m, 2),
                         text(msl_m - ground_m, 2), value);
    };
    const auto rows = [&](const char* kind, const VerticalCut& cut,
                          const std::vector<VerticalCut::Line>& lines) {
      for (std::size_t n = 0; n < lines.size(); ++n) {
        for (const VerticalCut::Point& point : lines[n]) {
          row(kind, cut, fmt::format("{}", n), point.range_m, point.height_m,
              fmt::format("{:.6g}", diagram.request.threshold));
        }
      }
    };
    for (const VerticalCut& cut : diagram.cuts) {
      for (std::size_t k = 0; k < diagram.heights_m.size(); ++k) {
        for (std::size_t i = 0; i < width; ++i) {
          const float value = cut.values[k * width + i];
          row("grid", cut, "", diagram.ranges_m[i], diagram.heights_m[k],
              std::isfinite(value) ? fmt::format("{:.6g}", value) : "");
        }
      }
      rows("contour", cut, cut.contours);
      rows("free_space", cut, cut.free_space);
    }
  });
}

}  // namespace emscape::report
