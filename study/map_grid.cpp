#include "emscape/study/map_grid.h"

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/fast_geodesy.h"
#include "base/near_angle.h"
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
double metres2PerDegree2(const SineCosine& latitude) {
  constexpr double kPerDegree2 = kPi / 180 * (kPi / 180);
  constexpr double kA2 = kWgs84SemiMajor_m * kWgs84SemiMajor_m;
  const double root = 1 - kWgs84EccentricitySquared * latitude.sine * latitude.sine;
  return kA2 * (1 - kWgs84EccentricitySquared) / (root * root) * latitude.cosine * kPerDegree2;
}

/// Longitudes and latitudes of every kLattice-th pixel.
struct Lattice {
  int nodes_x = 0, nodes_y = 0;
  std::vector<double> longitudes_deg, latitudes_deg;
};

Lattice latticeOf(const Projection& toEarth, const MapGrid& grid) {
  Lattice lattice;
  lattice.nodes_x = (grid.width + kLattice - 1) / kLattice + 1;
  lattice.nodes_y = (grid.height + kLattice - 1) / kLattice + 1;
  for (int j = 0; j < lattice.nodes_y; ++j) {
    for (int i = 0; i < lattice.nodes_x; ++i) {
      lattice.longitudes_deg.push_back(grid.left_m + (i * kLattice + 0.5) * grid.cell_m);
      lattice.latitudes_deg.push_back(grid.top_m - (j * kLattice + 0.5) * grid.cell_m);
    }
  }
  if (!toEarth(lattice.longitudes_deg, lattice.latitudes_deg)) {
    throw Error(ErrorCode::usage, fmt::format("crs '{}' does not reach over the whole area", grid.crs));
  }
  return lattice;
}

/// The bilinear patch between four nodes.
class Patch {
 public:
  /// @param turn  nodes are taken in the same turn of so much as the first; 0: as they are
  Patch(const std::vector<double>& at, std::size_t node, int nodes_x, double turn) : origin_(at[node]) {
    const auto turned = [&](double value) {
      return turn == 0 ? value : origin_ + std::remainder(value - origin_, turn);
    };
    const double east = turned(at[node + 1]), south = turned(at[node + nodes_x]),
                 corner = turned(at[node + nodes_x + 1]);
    east_ = east - origin_;
    south_ = south - origin_;
    twist_ = corner - east - south + origin_;
  }
  /// @param u, v  0..1 to the east and to the south
  double at(double u, double v) const { return origin_ + u * east_ + v * south_ + u * v * twist_; }
  /// Differences from a pixel to the next, to the east and to the south.
  double perColumn(double v) const { return (east_ + v * twist_) / kLattice; }
  double perRow(double u) const { return (south_ + u * twist_) / kLattice; }

 private:
  double origin_, east_, south_, twist_;
};

/// Where the pixels of a patch are.
enum class PatchPart { inside, outside, across };

/// Whether places are in a map's area.
class AreaTest {
 public:
  explicit AreaTest(const MapArea& area) : area_(area) {
    if (area.circle) middle_ = fastGeodesy(area.circle->latitude_deg, area.circle->longitude_deg);
  }
  bool isInside(const emfield::Surface::Place& place) const {
    constexpr double kMargin_deg = 1e-9;
    if (area_.circle) return distance_m(place) <= area_.circle->radius_m;
    const double east_deg = place.longitude_deg - area_.box.west_deg;
    return place.latitude_deg >= area_.box.south_deg - kMargin_deg &&
           place.latitude_deg <= area_.box.north_deg + kMargin_deg &&
           east_deg - 360 * std::floor((east_deg + kMargin_deg) / 360) <=
               area_.box.east_deg - area_.box.west_deg + kMargin_deg;
  }
  /// Of a patch with these corners.
  PatchPart partOf(const emfield::Surface::Place (&corners)[4]) const {
    if (!area_.circle) return PatchPart::across;
    double nearest_m = HUGE_VAL, farthest_m = 0;
    for (const emfield::Surface::Place& corner : corners) {
      nearest_m = std::min(nearest_m, distance_m(corner));
      farthest_m = std::max(farthest_m, distance_m(corner));
    }
    // No place is farther from a corner than the longer diagonal; twice that is beyond any doubt.
    const double diagonal_m =
        2 * std::max(between_m(corners[0], corners[3]), between_m(corners[1], corners[2]));
    return nearest_m + diagonal_m <= area_.circle->radius_m  ? PatchPart::inside
           : nearest_m - diagonal_m > area_.circle->radius_m ? PatchPart::outside
                                                             : PatchPart::across;
  }

 private:
  double distance_m(const emfield::Surface::Place& place) const {
    return fastInverse(middle_, toEcef({place.latitude_deg, place.longitude_deg, 0})).distance_m;
  }
  static double between_m(const emfield::Surface::Place& a, const emfield::Surface::Place& b) {
    return length(toEcef({a.latitude_deg, a.longitude_deg, 0}) -
                  toEcef({b.latitude_deg, b.longitude_deg, 0}));
  }

  const MapArea& area_;
  FastGeodesy middle_{};
};

/// Sets places and areas, on patches between the nodes of a lattice.
void fillPlaces(const Lattice& lattice, const MapArea& area, MapGrid& grid) {
  grid.places.resize(static_cast<std::size_t>(grid.width) * grid.height);
  grid.areas_m2.resize(grid.places.size());
  const AreaTest test(area);
  parallelFor(lattice.nodes_y - 1, 1, [&](int begin, int end) {
    NearAngle latitude_sine;
    for (int patch = begin * (lattice.nodes_x - 1); patch < end * (lattice.nodes_x - 1); ++patch) {
      const int patch_x = patch % (lattice.nodes_x - 1), patch_y = patch / (lattice.nodes_x - 1);
      const std::size_t node = static_cast<std::size_t>(patch_y) * lattice.nodes_x + patch_x;
      const Patch longitudes(lattice.longitudes_deg, node, lattice.nodes_x, 360);
      const Patch latitudes(lattice.latitudes_deg, node, lattice.nodes_x, 0);
      const PatchPart part = test.partOf({{latitudes.at(0, 0), longitudes.at(0, 0)},
                                          {latitudes.at(1, 0), longitudes.at(1, 0)},
                                          {latitudes.at(0, 1), longitudes.at(0, 1)},
                                          {latitudes.at(1, 1), longitudes.at(1, 1)}});
      const int columns = std::min(kLattice, grid.width - patch_x * kLattice);
      const int rows = std::min(kLattice, grid.height - patch_y * kLattice);
      for (int j = 0; j < rows; ++j) {
        const double v = static_cast<double>(j) / kLattice;
        const double lon_u = longitudes.perColumn(v), lat_u = latitudes.perColumn(v);
        const std::size_t first =
            static_cast<std::size_t>(patch_y * kLattice + j) * grid.width + patch_x * kLattice;
        for (int i = 0; i < columns; ++i) {
          const double u = static_cast<double>(i) / kLattice;
          const double latitude = latitudes.at(u, v);
          emfield::Surface::Place& place =
              grid.places[first + i] = {latitude, wrapLongitude_deg(longitudes.at(u, v))};
          if (part == PatchPart::outside || (part == PatchPart::across && !test.isInside(place))) {
            place.latitude_deg = NAN;
            continue;  // its area is 0
          }
          const double lon_v = longitudes.perRow(u), lat_v = latitudes.perRow(u);
          grid.areas_m2[first + i] =
              static_cast<float>(std::abs(lon_u * lat_v - lon_v * lat_u) *
                                 metres2PerDegree2(latitude_sine.at(degToRad(latitude))));
        }
      }
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
  fillPlaces(latticeOf(Projection(reference, earth), grid), area, grid);
  return grid;
}

MapGrid mapGridAt(const std::string& wkt, const std::string& crs, double cell_m, double left_m, double top_m,
                  int width, int height) {
  MapGrid grid;
  grid.width = width;
  grid.height = height;
  grid.cell_m = cell_m;
  grid.left_m = left_m;
  grid.top_m = top_m;
  grid.crs = crs;
  grid.wkt = wkt;
  if (!(static_cast<double>(width) * height <= kMaxPixels)) {
    throw Error(ErrorCode::bad_input,
                fmt::format("a map of {} x {} pixels has more than {:.0f}", width, height, kMaxPixels));
  }
  const MapArea everywhere{{-90, 90, -180, 180}, {}};
  fillPlaces(latticeOf(Projection(study::referenceOf(grid), wgs84Reference()), grid), everywhere, grid);
  return grid;
}

}  // namespace emscape::study
