#include "emscape/study/map_grid.h"

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/fast_geodesy.h"
#include "emscape/base/error.h"
#include "emscape/base/geo_frame.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "study/gdal_support.h"

namespace emscape::study {
namespace {

constexpr double kMaxPixels = 1 << 26;
/// Pixels between places that are transformed exactly; those between are on a bilinear patch.
constexpr int kLattice = 8;

struct Middle {
  double latitude_deg, longitude_deg;
};

Middle middleOf(const MapArea& area) {
  if (area.circle) return {area.circle->latitude_deg, area.circle->longitude_deg};
  return {(area.box.south_deg + area.box.north_deg) / 2,
          wrapLongitude_deg((area.box.west_deg + area.box.east_deg) / 2)};
}

/// @param name  receives the name by which the reference is known
OGRSpatialReference referenceOf(const std::string& crs, const Middle& middle, std::string& name) {
  const scenario::GdalMessages messages;
  OGRSpatialReference reference;
  name = crs;
  OGRErr found = OGRERR_FAILURE;
  if (crs == "local") {
    const std::string text =
        fmt::format("+proj=aeqd +lat_0={:.9f} +lon_0={:.9f} +datum=WGS84 +units=m +no_defs",
                    middle.latitude_deg, middle.longitude_deg);
    found = reference.importFromProj4(text.c_str());
  } else {
    int code = 0;
    if (crs == "utm") {
      const int zone = std::clamp(static_cast<int>(std::floor((middle.longitude_deg + 180) / 6)) + 1, 1, 60);
      code = (middle.latitude_deg < 0 ? 32700 : 32600) + zone;
      name = fmt::format("EPSG:{}", code);
    } else if (crs.rfind("EPSG:", 0) == 0 && crs.find_first_not_of("0123456789", 5) == std::string::npos) {
      code = std::atoi(crs.c_str() + 5);
    }
    if (code > 0) found = reference.importFromEPSG(code);
  }
  if (found != OGRERR_NONE) {
    throw Error(ErrorCode::usage,
                fmt::format("crs '{}': neither utm nor local nor a known EPSG:NUMBER", crs));
  }
  if (!reference.IsProjected() || std::abs(reference.GetLinearUnits() - 1) > 1e-9) {
    throw Error(ErrorCode::usage,
                fmt::format("crs '{}' is no projection in metres; pixels are squares of metres", crs));
  }
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

std::string wkt2Of(const OGRSpatialReference& reference) {
  static const char* const kOptions[] = {"FORMAT=WKT2_2019", nullptr};
  char* text = nullptr;
  reference.exportToWkt(&text, kOptions);
  std::string wkt = text == nullptr ? "" : text;
  CPLFree(text);
  return wkt;
}

/// Between longitude, latitude and a projection.
class Projection {
 public:
  Projection(const OGRSpatialReference& from, const OGRSpatialReference& to)
      : transform_(OGRCreateCoordinateTransformation(&from, &to)) {
    if (transform_ == nullptr) throw Error(ErrorCode::other, "PROJ cannot make the map's projection");
  }
  /// @return false if a point has no image
  bool operator()(std::vector<double>& x, std::vector<double>& y) const {
    const scenario::GdalMessages messages;
    std::vector<int> done(x.size());
    transform_->Transform(static_cast<int>(x.size()), x.data(), y.data(), nullptr, done.data());
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (done[i] == 0 || !std::isfinite(x[i]) || !std::isfinite(y[i])) return false;
    }
    return true;
  }

 private:
  struct Destroy {
    void operator()(OGRCoordinateTransformation* transform) const {
      OGRCoordinateTransformation::DestroyCT(transform);
    }
  };
  std::unique_ptr<OGRCoordinateTransformation, Destroy> transform_;
};

/// Points along the border of a box, by longitude and latitude.
void addBorder(const scenario::GeoBox& box, std::vector<double>& longitudes, std::vector<double>& latitudes) {
  constexpr int kPerSide = 32;
  for (int n = 0; n <= kPerSide; ++n) {
    const double part = static_cast<double>(n) / kPerSide;
    const double longitude = box.west_deg + part * (box.east_deg - box.west_deg);
    const double latitude = box.south_deg + part * (box.north_deg - box.south_deg);
    for (const double side : {box.south_deg, box.north_deg}) {
      longitudes.push_back(longitude);
      latitudes.push_back(side);
    }
    for (const double side : {box.west_deg, box.east_deg}) {
      longitudes.push_back(side);
      latitudes.push_back(latitude);
    }
  }
}

/// Square metres of the ellipsoid per square degree.
double metres2PerDegree2(double latitude_deg) {
  constexpr double kA = 6378137.0, kE2 = 6.69437999014e-3;
  const double sine = std::sin(degToRad(latitude_deg)), root = 1 - kE2 * sine * sine;
  const double meridian_m = kA * (1 - kE2) / std::pow(root, 1.5), prime_m = kA / std::sqrt(root);
  return meridian_m * prime_m * std::cos(degToRad(latitude_deg)) * degToRad(1.0) * degToRad(1.0);
}

/// Sets places and areas from those of every kLattice-th pixel.
void fillPlaces(const Projection& toEarth, MapGrid& grid) {
  const int nodes_x = (grid.width + kLattice - 1) / kLattice + 1;
  const int nodes_y = (grid.height + kLattice - 1) / kLattice + 1;
  std::vector<double> longitudes, latitudes;
  for (int j = 0; j < nodes_y; ++j) {
    for (int i = 0; i < nodes_x; ++i) {
      longitudes.push_back(grid.left_m + (i * kLattice + 0.5) * grid.cell_m);
      latitudes.push_back(grid.top_m - (j * kLattice + 0.5) * grid.cell_m);
    }
  }
  if (!toEarth(longitudes, latitudes)) {
    throw Error(ErrorCode::usage, fmt::format("crs '{}' does not reach over the whole area", grid.crs));
  }
  grid.places.resize(static_cast<std::size_t>(grid.width) * grid.height);
  grid.areas_m2.resize(grid.places.size());
  parallelFor(grid.height, 8, [&](int begin, int end) {
    for (int pixel = begin * grid.width; pixel < end * grid.width; ++pixel) {
      const int i = pixel % grid.width, j = pixel / grid.width;
      const std::size_t node = static_cast<std::size_t>(j / kLattice) * nodes_x + i / kLattice;
      const double u = static_cast<double>(i % kLattice) / kLattice,
                   v = static_cast<double>(j % kLattice) / kLattice;
      const auto patch = [&](const std::vector<double>& at, double& du, double& dv) {
        const double origin = at[node];
        const auto turned = [&](double value) {  // in the same turn as the origin
          return &at == &longitudes ? origin + std::remainder(value - origin, 360.0) : value;
        };
        const double east = turned(at[node + 1]), south = turned(at[node + nodes_x]),
                     corner = turned(at[node + nodes_x + 1]);
        const double twist = corner - east - south + origin;
        du = (east - origin + v * twist) / kLattice;
        dv = (south - origin + u * twist) / kLattice;
        return origin + u * (east - origin) + v * (south - origin) + u * v * twist;
      };
      double lon_u = 0, lon_v = 0, lat_u = 0, lat_v = 0;
      const double longitude = patch(longitudes, lon_u, lon_v), latitude = patch(latitudes, lat_u, lat_v);
      grid.places[pixel] = {latitude, wrapLongitude_deg(longitude)};
      grid.areas_m2[pixel] =
          static_cast<float>(std::abs(lon_u * lat_v - lon_v * lat_u) * metres2PerDegree2(latitude));
    }
  });
}

void leaveOut(const MapArea& area, MapGrid& grid) {
  constexpr double kMargin_deg = 1e-9;
  const FastGeodesy middle =
      area.circle ? fastGeodesy(area.circle->latitude_deg, area.circle->longitude_deg) : FastGeodesy{};
  const auto isInside = [&](const emfield::Surface::Place& place) {
    if (area.circle) {
      return fastInverse(middle, toEcef({place.latitude_deg, place.longitude_deg, 0})).distance_m <=
             area.circle->radius_m;
    }
    const double east_deg = place.longitude_deg - area.box.west_deg;
    return place.latitude_deg >= area.box.south_deg - kMargin_deg &&
           place.latitude_deg <= area.box.north_deg + kMargin_deg &&
           east_deg - 360 * std::floor((east_deg + kMargin_deg) / 360) <=
               area.box.east_deg - area.box.west_deg + kMargin_deg;
  };
  parallelFor(static_cast<int>(grid.places.size()), 4096, [&](int begin, int end) {
    for (int pixel = begin; pixel < end; ++pixel) {
      if (isInside(grid.places[pixel])) continue;
      grid.places[pixel].latitude_deg = NAN;
      grid.areas_m2[pixel] = 0;
    }
  });
}

}  // namespace

long long MapGrid::pixelAt(double latitude_deg, double longitude_deg) const {
  const OGRSpatialReference earth = wgs84Reference();
  const OGRSpatialReference reference = study::referenceOf(*this);
  std::vector<double> x{longitude_deg}, y{latitude_deg};
  if (!Projection(earth, reference)(x, y)) return -1;
  const double column = std::floor((x[0] - left_m) / cell_m), row = std::floor((top_m - y[0]) / cell_m);
  if (!(column >= 0 && column < width && row >= 0 && row < height)) return -1;
  return static_cast<long long>(row) * width + static_cast<long long>(column);
}

MapGrid makeMapGrid(const MapArea& area, double cell_m, const std::string& crs) {
  if (!(cell_m > 0) || !std::isfinite(cell_m)) {
    throw Error(ErrorCode::usage, fmt::format("cell {} m; a positive number of metres", cell_m));
  }
  MapGrid grid;
  grid.cell_m = cell_m;
  const OGRSpatialReference earth = wgs84Reference();
  const OGRSpatialReference reference = referenceOf(crs, middleOf(area), grid.crs);
  grid.wkt = wkt2Of(reference);
  std::vector<double> x, y;
  addBorder(area.box, x, y);
  if (!Projection(earth, reference)(x, y)) {
    throw Error(ErrorCode::usage, fmt::format("crs '{}' does not reach over the whole area", crs));
  }
  const auto [least_x, largest_x] = std::minmax_element(x.begin(), x.end());
  const auto [least_y, largest_y] = std::minmax_element(y.begin(), y.end());
  constexpr double kRounding = 1e-6;  // cells
  const double first_column = std::floor(*least_x / cell_m + kRounding),
               end_column = std::ceil(*largest_x / cell_m - kRounding);
  const double first_row = std::floor(*least_y / cell_m + kRounding),
               end_row = std::ceil(*largest_y / cell_m - kRounding);
  const double count = (end_column - first_column) * (end_row - first_row);
  if (!(count <= kMaxPixels)) {
    throw Error(
        ErrorCode::usage,
        fmt::format("a map of {:.0f} x {:.0f} pixels of {} m has more than {:.0f}: a larger cell or a "
                    "smaller area",
                    end_column - first_column, end_row - first_row, cell_m, kMaxPixels));
  }
  grid.width = static_cast<int>(end_column - first_column);
  grid.height = static_cast<int>(end_row - first_row);
  grid.left_m = first_column * cell_m;
  grid.top_m = end_row * cell_m;
  fillPlaces(Projection(reference, earth), grid);
  leaveOut(area, grid);
  return grid;
}

}  // namespace emscape::study
