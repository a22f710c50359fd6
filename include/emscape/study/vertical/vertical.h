/// Vertical coverage: a quantity of one emitter over range and height at azimuths, over terrain or, as in
/// Blake's charts, over a smooth earth.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emscape/emfield/columns/surface.h"
#include "emscape/emfield/solver/field_solver.h"
#include "emscape/render/picture/image.h"
#include "emscape/scenario/model/quantities.h"
#include "emscape/scenario/model/scenario.h"

namespace emscape::study {

struct VerticalRequest {
  static constexpr double kMinRange_m = 100, kMaxRange_m = 1.99e6;

  int emitter = 0;                   ///< index into Scenario::emitters
  std::vector<double> azimuths_deg;  ///< clockwise from true north
  double time_s = 0;
  scenario::Quantity quantity = scenario::Quantity::detection_probability;
  double threshold = 0.5;  ///< in the quantity's unit
  /// mean_sea_level: heights from the lowest ground upwards. ground: heights above the ground at each range.
  emfield::HeightReference axis = emfield::HeightReference::mean_sea_level;
  double range_m = 0;        ///< of the right edge, along the ground
  double max_height_m = 0;   ///< of the upper edge, on the axis, 10..1e5; above mean sea level from -500
  bool fits_height = false;  ///< pictures end above the highest point with a field
  /// Blake's chart: over a smooth earth instead of the terrain, at the height of the ground below the emitter
  /// (or ground.surface_msl_m). All heights are above this surface; axis must be mean_sea_level.
  bool smooth_earth = false;
  int ranges = 600, heights = 300;  ///< of the grid, 2..10000
};

/// One azimuth.
struct VerticalCut {
  struct Point {
    double range_m = 0;   ///< over the ground
    double height_m = 0;  ///< on the axis
  };
  using Line = std::vector<Point>;

  double azimuth_deg = 0;
  std::vector<float> values;        ///< ranges x heights, range fastest; NaN: below ground or unknown
  std::vector<float> ground_msl_m;  ///< one per range; NaN: unknown; empty: a smooth earth at 0
  std::vector<Line> contours;       ///< lines on which the quantity equals the threshold
  std::vector<Line> free_space;     ///< smooth_earth: the same without earth
};

struct VerticalDiagram {
  VerticalRequest request;
  std::string scenario, emitter, model, unit;
  std::string clutter;  ///< trees and buildings in the losses, in words
  std::string title;    ///< name of the scenario with the number of edits
  double latitude_deg = 0, longitude_deg = 0;
  double station_msl_m = 0;  ///< of the emitter; smooth_earth: above that surface
  double station_agl_m = 0;
  double surface_msl_m = 0;  ///< smooth_earth: height of its surface
  double floor = 0;          ///< value, in the quantity's unit, of points without a field
  double k_factor = 0, effective_earth_radius_m = 0;
  std::vector<double> ranges_m;   ///< ascending, evenly spaced; the last is that of the request
  std::vector<double> heights_m;  ///< on the axis, ascending, evenly spaced
  std::vector<VerticalCut> cuts;  ///< one per azimuth
  std::vector<std::string> warnings;

  /// Length (m) of the ray from the station to a point, and its elevation (deg) there, both on the effective
  /// earth, on which rays are straight.
  double slantRange_m(double range_m, double height_msl_m) const;
  double elevation_deg(double range_m, double height_msl_m) const;
  /// Range along the ground (m) of a point at a slant range; NaN if there is none.
  double groundRange_m(double slant_range_m, double height_msl_m) const;
  /// Height (m) of a ray after a slant range.
  double rayHeight_msl_m(double slant_range_m, double elevation_deg) const;
};

/// Default range (m) of a diagram: the instrumented range of the emitter's waveform; else the range at which
/// the last of the azimuths leaves the region; else, for an emitter outside it, that of the region's farthest
/// corner.
double defaultRange_m(const scenario::Scenario& scenario, const VerticalRequest& request);

/// Fills what is NaN: the threshold (thresholdOf()), the range (defaultRange_m()), and the height, with that
/// of the region, to which pictures need not reach (fits_height).
/// @param has_quantity  false: detection_probability of a radar, power_density_dbwm2 of another emitter
/// @param option        name of the threshold, for the message
/// @throws Error (usage) as thresholdOf() does
VerticalRequest withDefaults(VerticalRequest request, const scenario::Scenario& scenario, bool has_quantity,
                             const std::string& option);
/// The terrain of a diagram; null: a smooth earth. @throws Error (bad_input)
scenario::TerrainPtr loadVerticalTerrain(const scenario::Scenario& scenario, const VerticalRequest& request);

/// Computes a diagram with the functions of the field: a value equals that of `emscape profile` at its point,
/// with the active jammers and the radar's beam on the target (RadarAim::target).
/// @param terrain  over the whole diagram (circularArea); null: a smooth earth
/// @param options  backend and memory; the rest is set here
/// @throws Error (usage) for an emitter that is off, a quantity that is not defined for a single emitter, and
/// values out of range; as FieldSolver does
VerticalDiagram computeVertical(const std::shared_ptr<const scenario::Scenario>& scenario,
                                const scenario::TerrainPtr& terrain, const VerticalRequest& request,
                                emfield::FieldOptions options);

/// Default size of a picture with this number of panels: 1400 x 800, higher for more than four.
render::ImageSize verticalPlotSize(std::size_t azimuths);
/// @throws Error (usage) for a picture that is too small for this number of panels
void checkVerticalPlot(render::ImageSize size, std::size_t azimuths);

/// Draws a diagram into a .png or .svg, one panel per azimuth.
/// @throws Error (other) naming the file; as checkVerticalPlot() does
void plotVertical(const VerticalDiagram& diagram, render::ImageSize size, const std::string& file);

}  // namespace emscape::study
