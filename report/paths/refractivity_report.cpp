#include "report/paths/refractivity_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "propagation/parabolic_equation/air/ducts.h"
#include "render/annotate/plot.h"

namespace emscape::report {
namespace {

using propagation::Duct;
using propagation::Refractivity;
using propagation::RefractivityField;
using propagation::RefractivityLevel;
using propagation::RefractivityProfile;
using render::Canvas;
using render::PlotLine;
using render::PlotPanel;

constexpr std::size_t kMaxProfiles = 7;
constexpr render::Ink kLayer{{0.84F, 0.37F, 0.00F}, 0.22}, kDuct{{0.00F, 0.45F, 0.70F}, 0.08};
constexpr render::Ink kMember{{0.45F, 0.50F, 0.58F}, 0.35};

/// Drops the digits that binary fractions add: 0.1 m, 0.01 M-units.
Json roundedTo(double value, int decimals) {
  return Json(std::stod(fmt::format("{:.{}f}", value, decimals)));
}

RefractivityProfile profileAt(const RefractivityField& field, std::size_t index) {
  return withEvaporationDuct(field.profiles[index], field.evaporation_duct_m);
}

/// "40 km" or "50.1, -4.2"; empty for a single profile.
std::string nameAt(const RefractivityField& field, std::size_t index) {
  if (!field.ranges_m.empty()) return fmt::format("{:.4g} km", field.ranges_m[index] / 1000);
  if (field.positions.empty()) return "";
  return fmt::format("{:.4g}, {:.4g}", field.positions[index].latitude_deg,
                     field.positions[index].longitude_deg);
}

Json ductJson(const Duct& duct, const std::vector<double>& frequencies_hz) {
  Json json{{"kind", toString(duct.kind)},
            {"base_msl_m", roundedTo(duct.base_msl_m, 1)},
            {"top_msl_m", roundedTo(duct.top_msl_m, 1)},
            {"layer_base_msl_m", roundedTo(duct.layer_base_msl_m, 1)},
            {"strength_m_units", roundedTo(duct.strength_m_units, 2)},
            {"critical_angle_deg", roundedTo(duct.criticalAngle_deg(), 3)},
            {"one_mode_frequency_hz", 1e6 * std::round(duct.oneModeFrequency_hz() / 1e6)}};
  Json modes = Json::array();
  for (const double frequency_hz : frequencies_hz) {
    modes.push_back({{"frequency_hz", frequency_hz}, {"modes", static_cast<int>(duct.modes(frequency_hz))}});
  }
  json["trapped_modes"] = modes;
  return json;
}

/// The duct with the largest deficit; empty without ducts.
std::vector<Duct> strongest(const RefractivityProfile& profile) {
  std::vector<Duct> ducts = ductsOf(profile);
  const auto largest = std::max_element(ducts.begin(), ducts.end(), [](const Duct& a, const Duct& b) {
    return a.strength_m_units < b.strength_m_units;
  });
  return largest == ducts.end() ? std::vector<Duct>{} : std::vector<Duct>{*largest};
}

Json membersJson(const Refractivity& refractivity) {
  double lowest_m = HUGE_VAL, highest_m = -HUGE_VAL, weakest = HUGE_VAL, strongest_units = -HUGE_VAL;
  std::size_t with_duct = 0;
  for (const RefractivityField& member : refractivity.members) {
    for (const Duct& duct : strongest(profileAt(member, 0))) {
      ++with_duct;
      lowest_m = std::min(lowest_m, duct.top_msl_m);
      highest_m = std::max(highest_m, duct.top_msl_m);
      weakest = std::min(weakest, duct.strength_m_units);
      strongest_units = std::max(strongest_units, duct.strength_m_units);
    }
  }
  Json json{{"count", refractivity.members.size()}, {"with_duct", with_duct}};
  if (with_duct > 0) {
    json["duct_top_msl_m"] = {roundedTo(lowest_m, 1), roundedTo(highest_m, 1)};
    json["duct_strength_m_units"] = {roundedTo(weakest, 2), roundedTo(strongest_units, 2)};
  }
  json["quantile"] = refractivity.quantile ? Json(*refractivity.quantile) : Json(nullptr);
  return json;
}

/// Heights of the plot: up to twice the height of the highest duct below 3 km, otherwise up to 1 km.
std::pair<double, double> heightsOf(const RefractivityField& field) {
  const double bottom_m = field.profiles.front().levels.front().height_msl_m;
  double top_m = bottom_m;
  for (std::size_t i = 0; i < field.profiles.size(); ++i) {
    for (const Duct& duct : ductsOf(profileAt(field, i))) {
      if (duct.top_msl_m < bottom_m + 3000)
        top_m = std::max(top_m, bottom_m + 2 * (duct.top_msl_m - bottom_m));
    }
  }
  return {bottom_m, top_m > bottom_m ? top_m : bottom_m + 1000};
}

/// M or N over height.
PlotLine lineOf(const RefractivityProfile& profile, const std::pair<double, double>& heights_m, bool is_n) {
  std::set<double> heights;
  for (int i = 0; i <= 300; ++i)
    heights.insert(heights_m.first + (heights_m.second - heights_m.first) * i / 300);
  for (const RefractivityLevel& level : profile.levels) {
    if (level.height_msl_m > heights_m.first && level.height_msl_m < heights_m.second)
      heights.insert(level.height_msl_m);
  }
  PlotLine line;
  for (const double z : heights)
    line.points.push_back({profile.at(z) - (is_n ? propagation::kFlatteningGradient_m * z : 0), z});
  return line;
}

/// Limits of the values of lines, with a margin.
std::pair<double, double> axisOf(const std::vector<PlotLine>& lines) {
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (const PlotLine& line : lines) {
    for (const PlotLine::Point& point : line.points) {
      lowest = std::min(lowest, point.x);
      highest = std::max(highest, point.x);
    }
  }
  const double margin = std::max(0.05 * (highest - lowest), 0.5);
  return {lowest - margin, highest + margin};
}

std::string textOf(const Duct& duct) {
  const double frequency_hz = duct.oneModeFrequency_hz();
  return fmt::format("{} duct, {:.4g} to {:.4g} m, {:.3g} M-units, traps from {:.3g} {}", toString(duct.kind),
                     duct.base_msl_m, duct.top_msl_m, duct.strength_m_units,
                     frequency_hz / (frequency_hz < 1e9 ? 1e6 : 1e9), frequency_hz < 1e9 ? "MHz" : "GHz");
}

}  // namespace

Json profilesJson(const RefractivityField& field, const std::vector<double>& frequencies_hz) {
  Json profiles = Json::array();
  for (std::size_t i = 0; i < field.profiles.size(); ++i) {
    const RefractivityProfile profile = profileAt(field, i);
    Json json = Json::object();
    if (!field.ranges_m.empty()) json["range_m"] = field.ranges_m[i];
    if (!field.positions.empty()) {
      json["latitude_deg"] = field.positions[i].latitude_deg;
      json["longitude_deg"] = field.positions[i].longitude_deg;
    }
    json["levels"] = field.profiles[i].levels.size();
    json["lowest_msl_m"] = roundedTo(profile.levels.front().height_msl_m, 1);
    json["highest_msl_m"] = roundedTo(profile.levels.back().height_msl_m, 1);
    json["lowest_m_units"] = roundedTo(profile.levels.front().m_units, 2);
    json["ducts"] = Json::array();
    for (const Duct& duct : ductsOf(profile)) json["ducts"].push_back(ductJson(duct, frequencies_hz));
    profiles.push_back(json);
  }
  return profiles;
}

Json refractivityJson(const Refractivity& refractivity, const std::vector<double>& frequencies_hz) {
  Json json{{"profiles", profilesJson(refractivity.air, frequencies_hz)}};
  if (!refractivity.source.empty()) json["source"] = refractivity.source;
  if (!refractivity.members.empty()) json["members"] = membersJson(refractivity);
  return json;
}

std::string airSource(const scenario::Scenario& scenario) {
  return scenario.atmosphere.refractivity ? scenario.atmosphere.refractivity->source : "";
}

void plotRefractivity(const Refractivity& refractivity, const std::string& title, render::ImageSize size,
                      const std::string& file) {
  const RefractivityField& field = refractivity.air;
  const std::pair<double, double> heights_m = heightsOf(field);
  const std::vector<Duct> ducts = ductsOf(profileAt(field, 0));
  render::drawPlot(size, file, [&](Canvas& canvas) {
    const double width = canvas.size().width, height = canvas.size().height;
    const double unit = std::min(height / 800, width / 1400);
    canvas.rectangle({0, 0, width, height}, render::kPlotPaper);
    canvas.text(title, {96 * unit, 28 * unit}, 18 * unit, render::kPlotText, render::Align::left,
                render::Weight::bold);
    double y = 54 * unit;
    std::vector<std::string> texts;
    for (const Duct& duct : ducts) texts.push_back(textOf(duct));
    if (texts.empty()) texts.push_back("no duct: M rises with height");
    if (field.profiles.size() > 1) texts.front() = nameAt(field, 0) + ": " + texts.front();
    for (const std::string& text : texts) {
      canvas.text(text, {96 * unit, y}, 15 * unit, render::kPlotText);
      y += 22 * unit;
    }
    const double top = y + 30 * unit, panel_height = height - top - 60 * unit;
    const double names_width = 150 * unit, panel_width = (width - names_width - 230 * unit) / 2;
    for (const bool is_n : {false, true}) {
      std::vector<PlotLine> lines;
      for (const RefractivityField& member : refractivity.members) {
        lines.push_back(lineOf(profileAt(member, 0), heights_m, is_n));
        lines.back().ink = kMember;
        for (PlotLine::Point& point : lines.back().points) point.is_strong = false;
      }
      for (std::size_t i = 0; i < std::min(field.profiles.size(), kMaxProfiles); ++i) {
        lines.push_back(lineOf(profileAt(field, i), heights_m, is_n));
        lines.back().ink = render::plotInk(i);
        lines.back().name = nameAt(field, i);
      }
      const auto [lowest, highest] = axisOf(lines);
      const render::Rect frame{96 * unit + (is_n ? panel_width + 90 * unit : 0), top, panel_width,
                               panel_height};
      PlotPanel panel(canvas, frame, unit, {lowest, highest, 6, is_n ? "N-units" : "M-units"},
                      {heights_m.first, heights_m.second, 10, is_n ? "" : "height above sea level (m)"});
      const auto band = [&, left = lowest](double from_m, double to_m, const render::Ink& ink) {
        const double upper = panel.at(left, to_m).y, lower = panel.at(left, from_m).y;
        canvas.rectangle({frame.x, upper, frame.width, lower - upper}, ink);
      };
      for (const Duct& duct : ducts) {
        if (duct.base_msl_m >= heights_m.second) continue;
        band(duct.base_msl_m, duct.top_msl_m, kDuct);
        band(duct.layer_base_msl_m, duct.top_msl_m, kLayer);
      }
      panel.drawTitle(is_n ? "Refractivity N" : "Modified refractivity M");
      panel.drawGrid();
      for (const PlotLine& line : lines) panel.drawLine(line);
      if (!is_n) continue;
      panel.drawNames(lines);
      const double x = frame.x + frame.width + 14 * unit;
      double legend = frame.y + frame.height - 60 * unit;
      const auto key = [&](const render::Ink& ink, const char* text) {
        canvas.rectangle({x, legend - 7 * unit, 24 * unit, 14 * unit}, ink);
        canvas.text(text, {x + 32 * unit, legend}, 14 * unit, render::kPlotText);
        legend += 22 * unit;
      };
      if (!ducts.empty()) {
        key(kDuct, "duct");
        key(kLayer, "M falls");
      }
      if (!refractivity.members.empty()) key(kMember, "members");
    }
  });
}

}  // namespace emscape::report
