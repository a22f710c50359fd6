#include "emfield/ground/read_cover.h"

#include <algorithm>
#include <cmath>

#include "base/math/simd.h"

namespace emscape::emfield {
namespace {

using scenario::CoverZone;
using scenario::LandCoverView;

/// Sets the indices of the cells at some ranges of a chord; -1: outside. @see LandCoverView::classAt()
EMSCAPE_SIMD_CLONES void findCells(const TerrainChord& of, const LandCoverView& cover, const double* ranges_m,
                                   int count, int* cell) {
  const TerrainChord chord = of;  // stores into cell do not change it
  const Parabola<double>&latitude = chord.position.latitude_rad, &longitude = chord.position.longitude_rad;
  const double south_rad = cover.south_rad, west_rad = cover.west_rad;
  const double per_rad_lat = cover.cells_per_rad_lat, per_rad_lon = cover.cells_per_rad_lon;
  const int row_cells = cover.columns;
  const double rows = cover.rows, columns = cover.columns;
  const double turn = 2 * kPi * per_rad_lon;
  const double turned = turn * std::floor((longitude.c[0] - west_rad) * per_rad_lon / turn);
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const double part = (ranges_m[i] - chord.in_raster.begin_m) * chord.in_raster.per_m;
    const double row = (latitude.at(part) - south_rad) * per_rad_lat;
    const double beyond = (longitude.at(part) - west_rad) * per_rad_lon - turned;
    const double column = beyond < 0 ? beyond + turn : beyond < turn ? beyond : beyond - turn;
    const bool is_inside = row >= 0 && row < rows && column >= 0 && column < columns;
    const int at =
        static_cast<int>(is_inside ? row : 0) * row_cells + static_cast<int>(is_inside ? column : 0);
    cell[i] = is_inside ? at : -1;
  }
}

}  // namespace

ClassCovers::ClassCovers(const LandCoverView& cover) {
  of_cell_.fill(NAN);
  for (int k = 0; k < cover.class_count; ++k) {
    const scenario::CoverValues& values = cover.classes[k];
    of_cell_[k] = values.zone == CoverZone::sea     ? propagation::kSeaCover
                  : values.zone == CoverZone::water ? kLowWater
                  : values.is_known                 ? values.clutter_height_m
                                                    : NAN;
  }
}

// Without branches: classes follow no order along a path.
void ClassCovers::read(const std::uint8_t* cells, const int* cell, const float* ground_msl_m, int count,
                       float* cover_m) const {
  const float* const of_cell = of_cell_.data();
  for (int i = 0; i < count; ++i) {
    const int found = cells[cell[i] >= 0 ? cell[i] : 0];
    cover_m[i] = of_cell[cell[i] >= 0 ? found : LandCoverView::kNoClass];
  }
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const float of_water = ground_msl_m[i] <= scenario::LandCover::kMaxSea_m ? propagation::kSeaCover : 0.0f;
    cover_m[i] = cover_m[i] == kLowWater ? of_water : cover_m[i];
  }
}

float ClassCovers::highest_m() const {
  float highest = 0;
  for (int k = 0; k < 256; ++k) highest = std::max(highest, raise_m(static_cast<std::uint8_t>(k)));
  return highest;
}

void readCoverCpu(const Station& station, const GroundPosts& ground, const FastInverse& path,
                  const ClassCovers& classes, const double* ranges_m, const float* ground_msl_m, int count,
                  float* cover_m) {
  constexpr int kAtOnce = 256;
  const LandCoverView& cover = ground.terrain.cover;
  if (ground.terrain.surface_count > 0 || !cover.isSet()) {
    return readCover(station, ground, path, ranges_m, ground_msl_m, count, cover_m);
  }
  TerrainWalk walk(station, ground.terrain, path);
  int cell[kAtOnce];
  for (int begin = 0; begin < count;) {
    const TerrainChord& chord = walk.chordAt(ranges_m[begin]);
    const double end_m = walk.endOfChord_m(ranges_m[begin]);
    const int most = std::min(begin + kAtOnce, count);
    const int beyond =
        static_cast<int>(std::lower_bound(ranges_m + begin, ranges_m + most, end_m) - ranges_m);
    const int end = std::max(beyond, begin + 1);
    findCells(chord, cover, ranges_m + begin, end - begin, cell);
    classes.read(cover.cells, cell, ground_msl_m + begin, end - begin, cover_m + begin);
    begin = end;
  }
}

}  // namespace emscape::emfield
