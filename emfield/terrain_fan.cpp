#include "emfield/terrain_fan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "emfield/fan_chord.h"
#include "emscape/base/parallel.h"
#include "scenario/terrain/view.h"

namespace emscape::emfield {
namespace {

/// The azimuths between which all columns are.
struct Sector {
  double first_rad = 0;
  double width_rad = 2 * kPi;
  bool full_circle = true;
};

constexpr double kMaxSector_rad = 0.9 * kPi;

Sector sectorOf(const std::vector<FanCoordinates>& coordinates, double margin_m) {
  const double reference = coordinates[coordinates.size() / 2].azimuth_rad;
  double lowest = 0, highest = 0, nearest_m = std::numeric_limits<double>::infinity();
  for (const FanCoordinates& point : coordinates) {
    const double offset = std::remainder(point.azimuth_rad - reference, 2 * kPi);
    lowest = std::min(lowest, offset);
    highest = std::max(highest, offset);
    nearest_m = std::min(nearest_m, point.range_m);
  }
  if (!(nearest_m > 2 * margin_m)) return {};
  const double margin_rad = std::asin(margin_m / nearest_m);
  lowest -= margin_rad;
  highest += margin_rad;
  if (highest - lowest > kMaxSector_rad) return {};
  return {reference + lowest, highest - lowest, false};
}

/// Heights of one azimuth.
void readProfile(const Station& station, const scenario::TerrainView& terrain, double azimuth_rad,
                 const std::vector<double>& ranges_m, int count, float* height_msl_m) {
  const double sine = std::sin(azimuth_rad), cosine = std::cos(azimuth_rad);
  const double chord_m = fanChordLength_m(station);
  int index = -1;
  FanChord chord;
  for (int i = 0; i < count; ++i) {
    const int here = fanChordAt(ranges_m[i], chord_m);
    if (here != index) chord = fanChord(station, sine, cosine, index = here, chord_m);
    height_msl_m[i] = chord.heightAt(terrain, ranges_m[i]);
  }
}

}  // namespace

std::vector<FanCoordinates> fanCoordinates(const Station& station, const GridColumns& columns) {
  std::vector<FanCoordinates> result(columns.columns.size());
  const double middle_m = columns.middle_m();
  parallelFor(static_cast<int>(result.size()), 4096, [&](int begin, int end) {
    for (int c = begin; c < end; ++c) result[c] = fanCoordinates(station, columns.columns[c], middle_m);
  });
  return result;
}

std::vector<double> fanRanges(double farthest_m, double even_step_m) {
  constexpr double kMinStep_m = 2, kGrowth = 0.1;
  std::vector<double> ranges{0};
  while (ranges.back() < farthest_m) {
    const double step_m = std::min(even_step_m, std::max(kMinStep_m, kGrowth * ranges.back()));
    ranges.push_back(ranges.back() + step_m);
  }
  return ranges;
}

FanResolution fanResolution(const volume::Grid& grid, const scenario::Terrain* terrain) {
  const double voxel_m = std::min(grid.spacing_m.x, grid.spacing_m.y);
  if (terrain == nullptr) return {voxel_m, voxel_m / 2};
  const double post_m = terrain->postSpacing_m();
  return {std::max(post_m, voxel_m / 8), std::max(post_m / 2, voxel_m / 16)};
}

FanShape fanShape(const Station& station, const std::vector<FanCoordinates>& coordinates,
                  const scenario::Terrain* terrain, const FanResolution& resolution, double tilt_m) {
  double farthest_m = 0;
  for (const FanCoordinates& point : coordinates) farthest_m = std::max(farthest_m, point.range_m);
  farthest_m = std::min(farthest_m + tilt_m, 0.5 * kPi * station.earth_radius_m);

  FanShape shape;
  shape.ranges_m = fanRanges(farthest_m, resolution.range_m);
  if (terrain == nullptr) {
    shape.used_ranges.assign(2, shape.rangeCount());
    return shape;
  }

  const Sector sector = sectorOf(coordinates, tilt_m);
  const double finest_rad = resolution.arc_m / std::max(farthest_m, resolution.arc_m);
  shape.interval_count = std::max(8, static_cast<int>(std::ceil(sector.width_rad / finest_rad)));
  shape.full_circle = sector.full_circle;
  shape.first_azimuth_rad = sector.first_rad;
  shape.azimuth_step_rad = sector.width_rad / shape.interval_count;

  shape.used_ranges.assign(shape.interval_count + 1, tilt_m > 0 ? shape.rangeCount() : 0);
  const FanView view = shape.view();
  for (const FanCoordinates& point : coordinates) {
    const int interval = static_cast<int>(view.azimuthIndex(point.azimuth_rad));
    const int used = view.lastBefore(point.range_m) + 1;
    for (int a : {interval, interval + 1}) shape.used_ranges[a] = std::max(shape.used_ranges[a], used);
  }
  return shape;
}

TerrainFan readTerrainFan(const Station& station, const FanShape& shape, const scenario::Terrain* terrain,
                          int first_interval, int interval_count) {
  TerrainFan fan;
  fan.first_interval = first_interval;
  fan.interval_count = interval_count;
  fan.range_count = shape.rangeCount();
  const std::size_t samples = static_cast<std::size_t>(interval_count + 1) * fan.range_count;
  if (terrain == nullptr) {
    fan.height_msl_m.assign(samples, 0.0f);
    return fan;
  }
  fan.height_msl_m.assign(samples, std::numeric_limits<float>::quiet_NaN());
  const scenario::TerrainView view = terrain->view();
  parallelFor(interval_count + 1, 8, [&](int begin, int end) {
    for (int a = begin; a < end; ++a) {
      readProfile(station, view, shape.first_azimuth_rad + (first_interval + a) * shape.azimuth_step_rad,
                  shape.ranges_m, shape.used_ranges[first_interval + a],
                  fan.height_msl_m.data() + static_cast<std::size_t>(a) * fan.range_count);
    }
  });
  return fan;
}

}  // namespace emscape::emfield
