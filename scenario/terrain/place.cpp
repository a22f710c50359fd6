#include "scenario/terrain/place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "scenario/terrain/georeference.h"

namespace emscape::scenario {
namespace {

/// Posts of the geographic lattice per post of the plane, in each direction.
constexpr double kOversampling = 2.0;
/// Points per side of a box whose outline is transformed by a projection.
constexpr int kOutline = 65;
/// Margin, as a fraction of the box, for the outline between these points.
constexpr double kOutlineMargin = 0.01;
constexpr double kMetresPerDegree = 111132.0;

/// Points evenly over a rectangle, its edges included.
void scatter(const PlaneBox& box, std::vector<double>& x, std::vector<double>& y) {
  for (int j = 0; j < kOutline; ++j) {
    for (int i = 0; i < kOutline; ++i) {
      x.push_back(box.x_min + (box.x_max - box.x_min) * i / (kOutline - 1));
      y.push_back(box.y_min + (box.y_max - box.y_min) * j / (kOutline - 1));
    }
  }
}

/// The bounding rectangle of points without NaN; x_min > x_max if there are none.
PlaneBox boundsOf(const std::vector<double>& x, const std::vector<double>& y) {
  PlaneBox box{1.0, 1.0, -1.0, -1.0};
  bool any = false;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (std::isnan(x[k])) continue;
    if (!any) box = {x[k], y[k], x[k], y[k]};
    any = true;
    box = {std::min(box.x_min, x[k]), std::min(box.y_min, y[k]), std::max(box.x_max, x[k]),
           std::max(box.y_max, y[k])};
  }
  if (!any) return box;
  const double x_margin = kOutlineMargin * (box.x_max - box.x_min);
  const double y_margin = kOutlineMargin * (box.y_max - box.y_min);
  return {box.x_min - x_margin, box.y_min - y_margin, box.x_max + x_margin, box.y_max + y_margin};
}

/// The area of columns and rows of posts: half a post larger on each side if they represent areas.
PlaneBox extentOf(const PostLattice& lattice, int columns, int rows, bool is_area) {
  const double rim = is_area ? 0.5 : 0.0;
  return {lattice.x(-rim), lattice.y(-rim), lattice.x(columns - 1 + rim), lattice.y(rows - 1 + rim)};
}

/// The longitudes and latitudes of a rectangle in a file's plane.
GeoBox geographicBox(const TerrainFile& file, const PlaneBox& box) {
  if (file.georeference().is_geographic) return {box.y_min, box.y_max, box.x_min, box.x_max};
  std::vector<double> x, y;
  scatter(box, x, y);
  file.georeference().toGeographic(x, y);
  const auto known =
      std::find_if(x.begin(), x.end(), [](double longitude) { return !std::isnan(longitude); });
  if (known == x.end()) return {1.0, -1.0, 1.0, -1.0};
  const double middle = std::isnan(x[x.size() / 2]) ? *known : x[x.size() / 2];
  for (double& longitude : x) longitude = middle + wrapLongitude_deg(longitude - middle);
  const PlaneBox bounds = boundsOf(x, y);
  GeoBox result{std::max(bounds.y_min, -90.0), std::min(bounds.y_max, 90.0), bounds.x_min, bounds.x_max};
  // If a pole is inside the rectangle, the box has all longitudes.
  for (double pole_deg : {-90.0, 90.0}) {
    std::vector<double> pole_x{0.0}, pole_y{pole_deg};
    file.georeference().toPlane(pole_x, pole_y);
    if (!(pole_x[0] >= box.x_min && pole_x[0] <= box.x_max && pole_y[0] >= box.y_min &&
          pole_y[0] <= box.y_max))
      continue;
    result.west_deg = -180.0;
    result.east_deg = 180.0;
    (pole_deg < 0.0 ? result.south_deg : result.north_deg) = pole_deg;
  }
  return result;
}

/// A part of a box, and the number of turns by which its longitudes exceed those of an area that it meets.
struct Overlap {
  GeoBox part;
  double turns;
};

/// The intersections of a box with an area that is extended by `reach`, in the box's longitudes.
std::vector<Overlap> overlaps(const GeoBox& box, const GeoBox& area, double reach_lat_deg,
                              double reach_lon_deg) {
  std::vector<Overlap> found;
  const double south = std::max(box.south_deg, area.south_deg - reach_lat_deg);
  const double north = std::min(box.north_deg, area.north_deg + reach_lat_deg);
  if (!(south <= north) || !(area.west_deg <= area.east_deg)) return found;
  const double west = area.west_deg - reach_lon_deg, east = area.east_deg + reach_lon_deg;
  const double last = std::floor((box.east_deg - west) / 360.0);
  for (double turns = std::ceil((box.west_deg - east) / 360.0); turns <= last; ++turns) {
    found.push_back({{south, north, std::max(box.west_deg, west + 360.0 * turns),
                      std::min(box.east_deg, east + 360.0 * turns)},
                     turns});
  }
  return found;
}

/// The posts of a rectangle and one more on each side, within the lattice.
PostWindow windowAbout(const PlaneBox& box, const PostLattice& lattice, int columns, int rows) {
  const auto first = [](double post, int count) {
    return static_cast<long long>(std::clamp(std::floor(post - 1e-6), 0.0, static_cast<double>(count)));
  };
  const auto last = [](double post, int count) {
    return static_cast<long long>(std::clamp(std::ceil(post + 1e-6), -1.0, count - 1.0));
  };
  PostWindow window;
  window.first_column = first(lattice.column(box.x_min), columns);
  window.first_row = first(lattice.row(box.y_min), rows);
  window.columns = last(lattice.column(box.x_max), columns) - window.first_column + 1;
  window.rows = last(lattice.row(box.y_max), rows) - window.first_row + 1;
  return window;
}

/// A lattice of whole fractions of a degree for a part of a sheet.
PostLattice geographicLattice(const GeoBox& part, double spacing_m) {
  const double per_degree = std::ceil(kOversampling * kMetresPerDegree / spacing_m);
  const double nearest_equator = part.south_deg > 0.0   ? part.south_deg
                                 : part.north_deg < 0.0 ? part.north_deg
                                                        : 0.0;
  const double per_degree_lon = std::max(std::ceil(per_degree * std::cos(degToRad(nearest_equator))), 1.0);
  PostLattice lattice;
  lattice.step_x = 1.0 / per_degree_lon;
  lattice.step_y = 1.0 / per_degree;
  // Includes the outer ring that every sheet has.
  lattice.x0 = (std::floor(part.west_deg * per_degree_lon) - 1.0) / per_degree_lon;
  lattice.y0 = (std::floor(part.south_deg * per_degree) - 1.0) / per_degree;
  return lattice;
}

/// Refuses a narrow strip across the meridians, or posts far closer along one axis than along the other,
/// where a few posts take gigabytes.
void requirePosts(const TerrainSheet& sheet, long long columns, long long rows) {
  constexpr double kAlwaysAllowed = 1e7, kMaxForEach = 100;
  const double posts = static_cast<double>(columns) * static_cast<double>(rows);
  const double own = static_cast<double>(sheet.columns) * sheet.rows;
  if (posts <= std::max(kAlwaysAllowed, kMaxForEach * own)) return;
  throw Error(ErrorCode::bad_input,
              fmt::format("elevation file {}: {} x {} of its posts take {} x {} posts at latitudes and "
                          "longitudes, more than {:.0f} for each; bring it to a geographic coordinate system "
                          "with square posts (gdalwarp)",
                          sheet.file->head().name, sheet.columns, sheet.rows, columns, rows, kMaxForEach));
}

TerrainSheet resample(const TerrainSheet& sheet, const GeoBox& part) {
  const PostLattice lattice = geographicLattice(part, sheet.finest_m);
  const long long columns = std::llround(std::ceil(lattice.column(part.east_deg))) + 2;
  const long long rows = std::llround(std::ceil(lattice.row(part.north_deg))) + 2;
  requirePosts(sheet, columns, rows);
  TerrainSheet result(sheet.file, lattice, columns, rows);
  result.spacing_m = sheet.spacing_m;
  result.finest_m = sheet.finest_m;
  const TerrainRaster source = sheet.raster();
  std::vector<double> x(static_cast<std::size_t>(result.columns - 2)), y(x.size());
  for (int row = 1; row < result.rows - 1; ++row) {
    for (int column = 1; column < result.columns - 1; ++column) {
      x[static_cast<std::size_t>(column - 1)] = lattice.x(column);
      y[static_cast<std::size_t>(column - 1)] = std::clamp(lattice.y(row), -90.0, 90.0);
    }
    sheet.file->georeference().lineToPlane(x, y);
    for (int column = 1; column < result.columns - 1; ++column) {
      double u = sheet.lattice.column(x[static_cast<std::size_t>(column - 1)]);
      double v = sheet.lattice.row(y[static_cast<std::size_t>(column - 1)]);
      if (!source.limit(u, v)) continue;
      const std::size_t post = result.index(column, row);
      const float height_m = source.heightAtPost(u, v);
      result.heights_m[post] = height_m;
      if (!std::isnan(height_m)) {
        result.kinds[post] = PostKind::known;
      } else if (sheet.isNextToVoid(u, v)) {
        result.kinds[post] = PostKind::empty;
      }
    }
  }
  return result;
}

}  // namespace

GeoBox geographicBoxOf(const TerrainFile& file) {
  const GeoBox box = geographicBox(file, extentOf(file.georeference().lattice, file.head().columns,
                                                  file.head().rows, file.georeference().is_area));
  if (!(box.south_deg <= box.north_deg))
    throw Error(ErrorCode::bad_input,
                "elevation file " + file.head().name + ": its posts are not on the earth");
  return box;
}

std::vector<RasterTile> tilesWithin(const TerrainFilePtr& file, const GeoBox& box) {
  std::vector<RasterTile> tiles;
  const PostLattice& lattice = file->georeference().lattice;
  const GeoBox area = geographicBoxOf(*file);
  if (file->georeference().is_geographic) {
    // Interpolation at the box's edge needs the post outside it.
    for (const auto& [part, turns] : overlaps(box, area, lattice.step_y, lattice.step_x)) {
      PostLattice moved = lattice;
      moved.x0 += 360.0 * turns;
      const PostWindow window = windowAbout({part.west_deg, part.south_deg, part.east_deg, part.north_deg},
                                            moved, file->head().columns, file->head().rows);
      if (!window.empty()) tiles.push_back({file, moved, window});
    }
    return tiles;
  }
  for (const auto& [part, turns] : overlaps(box, area, 0.0, 0.0)) {
    std::vector<double> x, y;
    scatter({part.west_deg, part.south_deg, part.east_deg, part.north_deg}, x, y);
    file->georeference().toPlane(x, y);
    const PostWindow window = windowAbout(boundsOf(x, y), lattice, file->head().columns, file->head().rows);
    if (!window.empty()) tiles.push_back({file, lattice, window});
  }
  return tiles;
}

std::vector<TerrainSheet> toGeographicSheets(TerrainSheet sheet, const GeoBox& box) {
  std::vector<TerrainSheet> alone;
  alone.push_back(std::move(sheet));
  closeSeams(alone);
  const TerrainSheet& closed = alone.front();
  std::vector<TerrainSheet> sheets;
  const PlaneBox extent{closed.lattice.x(closed.first_column), closed.lattice.y(closed.first_row),
                        closed.lattice.x(closed.last_column), closed.lattice.y(closed.last_row)};
  for (const Overlap& overlap : overlaps(box, geographicBox(*closed.file, extent), 0.0, 0.0)) {
    sheets.push_back(resample(closed, overlap.part));
  }
  return sheets;
}

}  // namespace emscape::scenario
