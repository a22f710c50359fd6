/// A radar's surface clutter by azimuth and slant range: the land and sea in its sight, without the antenna's
/// pattern.
///
/// One walk outwards per azimuth: a post is in sight if its elevation is above those of all posts before it,
/// over an earth of effective radius. The face between it and the post before is then also in sight. The
/// face's echo is its reflectivity at the grazing angle of the ray on it, times its area. The map depends on
/// the radar's site, its wave, its range cell and the width of its beam, not on the beam's direction.
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
#include "emfield/clutter/clutter_beam.h"
#include "emfield/clutter/reflectivity.h"
#include "emfield/ground/ground_posts.h"
#include "emscape/base/host_device.h"
#include "emscape/scenario/model/scenario.h"
#include "propagation/inputs.h"

namespace emscape::emfield {

/// A cell of the map: the sum over the surface of cross section over range^4, per radian of azimuth and in
/// the radar's range cell about the middle of the map's, with the two-way loss of the atmosphere (1 / (m2
/// rad)); and the same sum of echo times sine, sine^2 and sine^3 of the surface's elevation. Such moments of
/// several surfaces are those of all of them, and can be interpolated.
struct ClutterCell {
  float echo = 0, sine = 0, sine2 = 0, sine3 = 0;

  EMSCAPE_HD void add(const ClutterCell& more, float times) {
    echo += times * more.echo;
    sine += times * more.sine;
    sine2 += times * more.sine2;
    sine3 += times * more.sine3;
  }
};

/// Two surfaces that echo for all those of a cell.
struct TwoSurfaces {
  float sine[2];  ///< of their elevations
  float echo[2];
};

/// The two with the moments of a cell, Gauss's quadrature: exact for patterns that are cubic in the sine, and
/// for cells with surfaces at no more than two elevations. Without branches, for SIMD.
/// @see Golub, Welsch, Math. Comp. 23 (1969), p. 221
EMSCAPE_HD inline TwoSurfaces twoSurfaces(const ClutterCell& cell) {
  constexpr float kRounding = 1e-6f;  // of sums of floats
  const float per_echo = 1 / (cell.echo > 1e-37f ? cell.echo : 1e-37f);
  const float mean = cell.sine * per_echo, square = cell.sine2 * per_echo, cube = cell.sine3 * per_echo;
  const float mean2 = mean * mean, rest = square - (1 + kRounding) * mean2;
  const float variance = rest > 1e-12f ? rest : 1e-12f;
  const float third = cube - mean * (3 * square - 2 * mean2);
  const float rounding = kRounding * (mean < 0 ? -mean : mean) * (3 * square + 2 * mean2);
  const float surely = third > rounding ? third - rounding : third < -rounding ? third + rounding : 0.0f;
  const float shift = 0.5f * surely / variance;
  const float root = std::sqrt(shift * shift + variance);
  // the product of the distances from the mean is the variance: without cancellation
  const float longer = root + (shift > 0 ? shift : -shift), shorter = variance / longer;
  const float above = shift > 0 ? longer : shorter, below = shift > 0 ? shorter : longer;
  const float part = below / (above + below);
  return {{mean - below, mean + above}, {(1 - part) * cell.echo, part * cell.echo}};
}

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

/// Bilinear: cells of two rows (a, b and c, d) at two ranges.
EMSCAPE_HD inline ClutterCell mixed(const ClutterCell& a, const ClutterCell& b, const ClutterCell& c,
                                    const ClutterCell& d, float row_weight, float range_weight) {
  const auto mix = [&](float at_a, float at_b, float at_c, float at_d) {
    const float near_row = at_a + range_weight * (at_b - at_a), far_row = at_c + range_weight * (at_d - at_c);
    return near_row + row_weight * (far_row - near_row);
  };
  return {mix(a.echo, b.echo, c.echo, d.echo), mix(a.sine, b.sine, c.sine, d.sine),
          mix(a.sine2, b.sine2, c.sine2, d.sine2), mix(a.sine3, b.sine3, c.sine3, d.sine3)};
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
    return mixed(cells[a], cells[b], cells[c], cells[d], rows.weight, columns.weight);
  }
};

/// Inputs of the rows of a map, as plain data.
struct ClutterMapTask {
  Station station;
  GroundPosts ground;  ///< posts as far as the last cell
  SurfaceEcho surface;
  ClutterGrid grid;
  PowerBeside power;
  float air_db_per_m = 0;  ///< one way

  /// Fills the cells of one azimuth with what is in sight along it.
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
  }

  /// In one range, from the echoes along each azimuth to those of a beam with its axis on it, in place.
  EMSCAPE_HD void weighBeside(int range, ClutterCell* cells) const {
    const int beside = power.beside, rows = grid.azimuths;
    if (beside == 0) return;
    ClutterCell first[PowerBeside::kMaxBeside], before[PowerBeside::kMaxBeside];  // as they were
    const auto at = [&](int row) -> ClutterCell& {
      return cells[static_cast<std::size_t>(row) * grid.ranges + range];
    };
    for (int n = 0; n < beside; ++n) {
      first[n] = at(n);
      before[n] = at(rows - beside + n);
    }
    int oldest = 0;  // of before
    for (int row = 0; row < rows; ++row) {
      const ClutterCell here = at(row);
      ClutterCell sum;
      sum.add(here, power.parts[beside]);
      for (int n = 0; n < beside; ++n) {
        const int i = oldest + n, ahead = row + 1 + n;
        sum.add(before[i < beside ? i : i - beside], power.parts[n]);
        sum.add(ahead < rows ? at(ahead) : first[ahead - rows], power.parts[beside + 1 + n]);
      }
      at(row) = sum;
      before[oldest] = here;
      oldest = oldest + 1 < beside ? oldest + 1 : 0;
    }
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
        row[n].add(before[i], 1);
        row[n].add(behind, 1);
      }
      for (int i = beside - 1; i > 0; --i) before[i] = before[i - 1];
      before[0] = here;
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
      const double up = -depth_m / range_m, of_up = echo * up;
      row[n].add({static_cast<float>(echo), static_cast<float>(of_up), static_cast<float>(of_up * up),
                  static_cast<float>(of_up * up * up)},
                 1);
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
  scenario::AntennaPtr antenna;
};
ClutterMapInputs clutterMapInputs(const scenario::Emitter& radar);

/// The task of a radar's map without the ground; empty if it has no map. Four rows per beamwidth, 90 to 1440
/// in all; five, three or one cell per range cell, at most 2048 as far as the region's farthest point: at
/// most 48 MB.
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
