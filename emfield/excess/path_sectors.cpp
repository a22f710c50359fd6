#include "emfield/excess/path_sectors.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/parallel.h"

namespace emscape::emfield {
namespace {

/// Number of columns that are counted and sorted together, in their order.
constexpr int kPart = 1 << 14;

/// Sine of the angle from one azimuth to another.
double sineBetween(const PathSectors::Azimuth& from, const PathSectors::Azimuth& to) {
  return to.sine * from.cosine - to.cosine * from.sine;
}

}  // namespace

int PathSectors::countFor(const GroundPosts& ground, std::size_t paths) {
  constexpr double kWidth_posts = 1.5, kPathsPerSector = 32, kMinSectors = 360;
  if (ground.range_count < 2) return 0;
  const double farthest_m = ground.ranges_m[ground.range_count - 1];
  const double step_m = farthest_m - ground.ranges_m[ground.range_count - 2];
  const double count =
      std::min(8 * farthest_m / (kWidth_posts * step_m), static_cast<double>(paths) / kPathsPerSector);
  return count < kMinSectors ? 0 : static_cast<int>(count);
}

// Within a quadrant sectors divide sin / (sin + cos) evenly, which takes no arc tangent.
int PathSectors::sectorOf(double sin_azimuth, double cos_azimuth) const {
  const double east = std::fabs(sin_azimuth), north = std::fabs(cos_azimuth);
  const bool is_odd = (sin_azimuth >= 0) != (cos_azimuth >= 0);  // quadrants 90..180 and 270..360 degrees
  const int quadrant = sin_azimuth >= 0 ? (is_odd ? 1 : 0) : (is_odd ? 3 : 2);
  const int within = static_cast<int>((is_odd ? north : east) / (east + north) * per_quadrant_);
  return quadrant * per_quadrant_ + std::min(within, per_quadrant_ - 1);
}

PathSectors::Azimuth PathSectors::azimuthAt(int sector, double part) const {
  const double along = (sector % per_quadrant_ + part) / per_quadrant_;
  const double length = std::hypot(1 - along, along);
  const double cosine = (1 - along) / length, sine = along / length;
  switch (sector / per_quadrant_) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

double PathSectors::farthest_m(int sector) const {
  double farthest_m = 0;
  for (const SectorPath* to = begin(sector); to < end(sector); ++to) {
    farthest_m = std::max(farthest_m, to->distance_m);
  }
  return farthest_m;
}

double PathSectors::halfWidth_rad(int sector) const {
  constexpr double kRounding = 1e-9;
  const Azimuth at = middle(sector);
  const double widest = std::max(std::fabs(sineBetween(at, azimuthAt(sector, 0))),
                                 std::fabs(sineBetween(at, azimuthAt(sector, 1))));
  return std::asin(widest) + kRounding;
}

PathSectors::PathSectors(const Station& station, const ExcessGrid& grid, int count)
    : per_quadrant_((count + 3) / 4) {
  const int columns = static_cast<int>(grid.column_count), sectors = this->count();
  const int parts = (columns + kPart - 1) / kPart;
  UnsetVector<int> sector_of(grid.column_count);  // -1: none
  // Number of paths of each part to each sector; then the index of the next path.
  std::vector<std::size_t> next(static_cast<std::size_t>(parts) * sectors);
  const auto inParts = [&](const auto& visit) {
    parallelFor(parts, 1, [&](int begin, int end) {
      for (int part = begin; part < end; ++part) {
        std::size_t* const of_part = next.data() + static_cast<std::size_t>(part) * sectors;
        for (int c = part * kPart; c < std::min((part + 1) * kPart, columns); ++c) visit(c, of_part);
      }
    });
  };
  inParts([&](int c, std::size_t* of_part) {
    const auto column = static_cast<std::size_t>(c);
    sector_of[column] = -1;
    if (grid.isLeftOut(column) || grid.isWithoutGround(column)) return;
    const FastInverse point = grid.coordinatesOf(station, column, 0);
    sector_of[column] = sectorOf(point.sin_azimuth, point.cos_azimuth);
    ++of_part[sector_of[column]];
  });
  first_.push_back(0);
  for (int sector = 0; sector < sectors; ++sector) {
    std::size_t at = first_.back();
    for (int part = 0; part < parts; ++part) {
      std::size_t& of_part = next[static_cast<std::size_t>(part) * sectors + sector];
      at += std::exchange(of_part, at);
    }
    first_.push_back(at);
  }
  std::vector<Azimuth> middles;
  for (int sector = 0; sector < sectors; ++sector) middles.push_back(middle(sector));
  paths_.resize(first_.back());
  inParts([&](int c, std::size_t* of_part) {
    const auto column = static_cast<std::size_t>(c);
    if (sector_of[column] < 0) return;
    const FastInverse point = grid.coordinatesOf(station, column, 0);
    const double sine = sineBetween(middles[sector_of[column]], {point.sin_azimuth, point.cos_azimuth});
    const PositionColumn* const of_surface = grid.columns.of_surface;
    paths_[of_part[sector_of[column]]++] = {
        point.distance_m, of_surface != nullptr ? of_surface[column].base_msl_m : 0,
        static_cast<float>(sine * (1 + sine * sine / 6)), grid.ground_msl_m[column], c};
  });
}

}  // namespace emscape::emfield
