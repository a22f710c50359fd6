/// A radar's surface clutter by azimuth and slant range: the land and sea in its sight, without the antenna's
/// pattern.
///
/// One walk outwards per azimuth: a post is in sight if its elevation is above those of all posts before it,
/// over an earth of effective radius. The face between it and the post before is then also in sight. The
/// face's echo is its reflectivity at the grazing angle of the ray on it, times its area. The map depends on
/// the radar's site, its wave and its range cell, not on the direction of its beam.
///
/// Echoes of second and later trips arrive with those of nearer surfaces (EchoTrips): each has the pattern
/// towards its own surface.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "base/math/device_math.h"
#include "base/math/fast_math.h"
#include "emfield/clutter/reflectivity.h"
#include "emfield/ground/ground_posts.h"
#include "emscape/base/host_device.h"
#include "emscape/scenario/model/scenario.h"
#include "propagation/inputs.h"

namespace emscape::emfield {

/// A cell of the map: the sum over the surface of cross section over range^4, per radian of azimuth and in
/// the radar's range cell about the middle of the map's, with the two-way loss of the atmosphere (1 / (m2
/// rad)); and the sine of the elevation of the surface that echoes; of cells without an echo that of a
/// neighbour.
struct ClutterCell {
  float echo = 0;
  float sine = 0;
};

/// Slant ranges from which echoes arrive together: they differ by whole unambiguous ranges.
struct EchoTrips {
  float repeat_m = 1e30f;  ///< the unambiguous range c / (2 PRF); not less than the region: one trip
  int count = 1;
  float end_m = 1e30f;  ///< of the surfaces that count: the region's farthest point

  /// The range in a trip, 0 .. count - 1, of what arrives with an echo from a range.
  EMSCAPE_HD float range_m(float range_m, int trip) const {
    return range_m + repeat_m * (static_cast<float>(trip) - std::floor(range_m / repeat_m));
  }
};

/// Positions of the cells: azimuth clockwise from north, 2 pi i / azimuths; slant range (n + 1/2) step.
struct ClutterGrid {
  static constexpr int kMaxSteps = 5;

  int azimuths = 0, ranges = 0;
  float step_m = 1;
  int steps_of_cell = 1;   ///< steps in the radar's range cell, an odd number up to kMaxSteps
  float part_of_step = 1;  ///< range cell over step, if that is longer; else 1
  EchoTrips trips;

  std::size_t cells() const { return static_cast<std::size_t>(azimuths) * static_cast<std::size_t>(ranges); }
};

/// Two neighbours of a position in a map, and the interpolation weight of the second: 0 at the first, 1 at
/// the second.
struct ClutterNeighbours {
  int first = 0, second = 0;
  float weight = 0;
};

/// The rows on both sides of an azimuth, -pi..pi.
EMSCAPE_HD inline ClutterNeighbours rowsBeside(float azimuth_rad, int azimuths, float azimuths_per_rad) {
  const float row = azimuth_rad * azimuths_per_rad;
  const float turned = row < 0 ? row + static_cast<float>(azimuths) : row;
  const int i = static_cast<int>(turned), first = i < azimuths ? i : 0;
  return {first, first + 1 < azimuths ? first + 1 : 0, turned - static_cast<float>(i)};
}

/// The cells on both sides of a range, for interpolation between their middles; below the middle of the first
/// cell, that cell. Without branches, for SIMD.
EMSCAPE_HD inline ClutterNeighbours cellsBeside(float range_m, int ranges, float cells_per_m) {
  const float place = range_m * cells_per_m - 0.5f;
  const int last = ranges - 1, n = static_cast<int>(place > 0 ? place : 0.0f);
  const int first = n < last ? n : last, second = n < last ? n + 1 : last;
  const float beyond = place - static_cast<float>(first), weight = beyond > 0 ? beyond : 0.0f;
  return {first, second, weight < 1 ? weight : 1.0f};
}

/// Bilinear: values of two rows (a, b and c, d) at two ranges.
EMSCAPE_HD inline float mixed(float a, float b, float c, float d, float row_weight, float range_weight) {
  const float near_row = a + range_weight * (b - a), far_row = c + range_weight * (d - c);
  return near_row + row_weight * (far_row - near_row);
}

/// All rows of a map as plain data; no cells: no clutter of the surface.
struct ClutterMapView {
  const ClutterCell* cells = nullptr;  ///< azimuths x ranges, range fastest
  int azimuths = 0, ranges = 0;
  float cells_per_m = 0, azimuths_per_rad = 0;
  EchoTrips trips;

  /// Beyond the last range, the value at the last range.
  EMSCAPE_HD ClutterCell cellAt(float azimuth_rad, float range_m) const {
    const ClutterNeighbours rows = rowsBeside(azimuth_rad, azimuths, azimuths_per_rad);
    const ClutterNeighbours columns = cellsBeside(range_m, ranges, cells_per_m);
    // Indices instead of pointers per lane, so that the look-ups become gathers.
    const int a = rows.first * ranges + columns.first, b = rows.first * ranges + columns.second;
    const int c = rows.second * ranges + columns.first, d = rows.second * ranges + columns.second;
    return {mixed(cells[a].echo, cells[b].echo, cells[c].echo, cells[d].echo, rows.weight, columns.weight),
            mixed(cells[a].sine, cells[b].sine, cells[c].sine, cells[d].sine, rows.weight, columns.weight)};
  }
};

/// Inputs of the rows of a map, as plain data.
struct ClutterMapTask {
  Station station;
  GroundPosts ground;  ///< posts as far as the last cell
  SurfaceEcho surface;
  ClutterGrid grid;
  float air_db_per_m = 0;  ///< one way

  /// Fills the cells of one azimuth.
  /// @param row  ranges cells
  EMSCAPE_HD void operator()(int azimuth, ClutterCell* row) const {
    for (int n = 0; n < grid.ranges; ++n) row[n] = {};
    const double angle_rad = 2 * kPi * azimuth / grid.azimuths;
    const FastInverse path{ground.ranges_m[ground.range_count - 1], std::sin(angle_rad), std::cos(angle_rad)};
    TerrainWalk walk(station, ground.terrain, path);  // of the land cover
    const bool has_cover = !ground.is_smooth && ground.terrain.cover.isSet();
    double highest = -HUGE_VAL;
    Post before;
    visitPosts(station, ground, path, ground.range_count, [&](int i, float here_msl_m) {
      Post here;
      here.range_m = ground.ranges_m[i];
      here.height_msl_m = static_cast<double>(here_msl_m);
      const double below_m = this->below_m(here.range_m, here.height_msl_m);
      here.slant_m = std::sqrt(here.range_m * here.range_m + below_m * below_m);
      here.face = surface.faceOn(here_msl_m);
      if (has_cover) {
        const scenario::CoverValues cover = coverAt(walk, ground, here.range_m);
        if (cover.is_known) here.face = surface.faceOn(cover);
      }
      if (i > 0 && here_msl_m == here_msl_m) {
        const double slope = -below_m / here.range_m;
        if (slope > highest) {
          if (before.height_msl_m == before.height_msl_m) addFace(before, here, row);
          highest = slope;
        }
      }
      before = here;
    });
    sumOverRangeCell(row);
    normalize(row);
  }

 private:
  /// From sums over steps to sums over the range cell about the middle of each step.
  EMSCAPE_HD void sumOverRangeCell(ClutterCell* row) const {
    const int beside = grid.steps_of_cell / 2;
    ClutterCell before[ClutterGrid::kMaxSteps / 2];  // as they were, the nearest first
    for (int n = 0; n < grid.ranges; ++n) {
      const ClutterCell here = row[n];
      for (int i = 0; i < beside; ++i) {
        const ClutterCell behind = n + 1 + i < grid.ranges ? row[n + 1 + i] : ClutterCell{};
        row[n].echo += before[i].echo + behind.echo;
        row[n].sine += before[i].sine + behind.sine;
      }
      for (int i = beside - 1; i > 0; --i) before[i] = before[i - 1];
      before[0] = here;
    }
  }
  /// From sums of depths weighted by the echo to means of sines, seen from the middles of the cells.
  EMSCAPE_HD void normalize(ClutterCell* row) const {
    int first = 0;
    while (first < grid.ranges && !(row[first].echo > 0)) ++first;
    if (first == grid.ranges) return;
    const auto sineAt = [&](int n) {
      return row[n].sine / (row[n].echo * grid.step_m * (static_cast<float>(n) + 0.5f));
    };
    float sine = sineAt(first);
    for (int n = 0; n < grid.ranges; ++n) {
      if (row[n].echo > 0) sine = sineAt(n);
      row[n].sine = sine > -1 ? sine : -1.0f;
    }
  }

  struct Post {
    double range_m = 0, height_msl_m = 0, slant_m = 0;
    SurfaceFace face;
  };

  /// Depth (m) of a point below the radar's horizontal plane, over the effective earth.
  EMSCAPE_HD double below_m(double range_m, double height_msl_m) const {
    return station.height_msl_m - height_msl_m + range_m * range_m / (2 * station.effective_earth_radius_m);
  }

  /// Adds the echo of the face between two posts, cell by cell.
  EMSCAPE_HD void addFace(const Post& a, const Post& b, ClutterCell* row) const {
    const SurfaceFace face = b.face.is_sea && !a.face.is_sea ? a.face : b.face;
    const double per_m = 1 / static_cast<double>(grid.step_m);
    const double from_a = a.slant_m * per_m, whole = (b.slant_m - a.slant_m) * per_m;
    const double begin = whole > 0 ? from_a : from_a + whole, end = whole > 0 ? from_a + whole : from_a;
    constexpr double kSmall = 1e-9;  // of a cell: the face is at a single range
    const int last = end < grid.ranges ? static_cast<int>(end) : grid.ranges - 1;
    for (int n = static_cast<int>(begin); n <= last; ++n) {
      const double from = begin > n ? begin : n, to = end < n + 1 ? end : n + 1;
      const bool is_point = end - begin < kSmall;
      const double share = is_point ? 1 : (to - from) / (end - begin);
      const double t = is_point ? 0.5 : ((from + to) / 2 - from_a) / whole;
      const double x_m = a.range_m + t * (b.range_m - a.range_m);
      const double rise_m = b.height_msl_m - a.height_msl_m, run_m = b.range_m - a.range_m;
      const double depth_m = below_m(x_m, a.height_msl_m + t * rise_m);
      const double tilt = rise_m / run_m - x_m / station.effective_earth_radius_m;
      const double length = std::sqrt(1 + tilt * tilt);
      const double range2_m2 = x_m * x_m + depth_m * depth_m, range_m = std::sqrt(range2_m2);
      const double sine = (x_m * tilt + depth_m) / (range_m * length);
      const double area_m2 = x_m * run_m * share * length;  // per radian
      const double echo = surface.reflectivity(face, sine) * area_m2 / (range2_m2 * range2_m2) *
                          std::pow(10.0, -0.2 * static_cast<double>(air_db_per_m) * range_m) *
                          static_cast<double>(grid.part_of_step);
      row[n].echo += static_cast<float>(echo);
      row[n].sine -= static_cast<float>(echo * depth_m);  // becomes a mean sine at the end
    }
  }
};

EMSCAPE_HD inline ClutterMapView clutterMapView(const ClutterGrid& grid, const ClutterCell* cells) {
  return {
      cells,     grid.azimuths, grid.ranges, 1 / grid.step_m, static_cast<float>(grid.azimuths / (2 * kPi)),
      grid.trips};
}

/// True for radars with an echo of land or sea.
bool hasClutterMap(const scenario::Emitter& radar);

/// The settings of a radar that its map depends on, besides its wave.
struct ClutterMapInputs {
  std::optional<double> land_gamma_db;
  bool land_by_cover = false;
  std::optional<int> sea_state;
  double range_cell_m = 0;
  double unambiguous_range_m = 0;
  int azimuths = 0;
};
ClutterMapInputs clutterMapInputs(const scenario::Emitter& radar);

/// The task of a radar's map without the ground; empty if it has no map. Two rows per beamwidth, 90 to 1440
/// in all; five, three or one cell per range cell, at most 2048 as far as the region's farthest point: at
/// most 24 MB.
/// @param extent  of paths that may extend beyond the region; null: none. The positions of the cells do not
/// change
std::optional<ClutterMapTask> clutterMapTask(const scenario::Scenario& scenario,
                                             const scenario::Emitter& radar, const Station& station,
                                             const propagation::PathExtent* extent = nullptr);

/// Largest size of a radar's map over the region; 0 without one.
std::size_t clutterMapBytes(const scenario::Emitter& radar);

/// Specific attenuation (dB/m) by gases and rain at mean sea level, one way.
double airLossAtSea_db_per_m(const scenario::Scenario& scenario, const scenario::Emitter& radar);

/// Ranges of the posts that a map's rows visit.
std::vector<double> clutterPostRanges(const ClutterGrid& grid, double post_spacing_m);

/// Fills a map on the CPU.
void fillClutterMapCpu(const ClutterMapTask& task, ClutterCell* cells);

}  // namespace emscape::emfield
