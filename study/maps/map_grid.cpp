#include "emscape/study/maps/map_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/geodesy/fast_geodesy.h"
#include "base/math/simd.h"
#include "emscape/base/error.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "emscape/base/work.h"
#include "scenario/terrain/transformation.h"
#include "study/maps/gdal_support.h"

namespace emscape::study {
namespace {

constexpr double kMaxPixels = 1 << 26;
/// Longest side of the patches on which positions are interpolated: they are within a millimetre of the exact
/// ones up to 85 degrees of latitude. Beyond, no position is interpolated.
constexpr double kPatch_m = 3000;
/// Longest side of a map: once around the earth.
constexpr double kLargestSide_m = 4.1e7;
constexpr double kPolar_deg = 85;
constexpr double kMaxPolarPixels = 1 << 24;  ///< whose positions take seconds
constexpr int kMaxPatchPixels = 64;

struct Middle {
  double latitude_deg, longitude_deg;
};

Middle middleOf(const MapArea& area) {
  if (area.circle) return {area.circle->latitude_deg, area.circle->longitude_deg};
  return {(area.box.south_deg + area.box.north_deg) / 2,
          wrapLongitude_deg((area.box.west_deg + area.box.east_deg) / 2)};
}

/// The zone of UTM, with the exceptions of Norway and Svalbard.
int utmZone(const Middle& at) {
  const double lat = at.latitude_deg, lon = at.longitude_deg;
  if (lat >= 56 && lat < 64 && lon >= 3 && lon < 12) return 32;
  if (lat >= 72 && lat < 84 && lon >= 0 && lon < 42) return lon < 9 ? 31 : lon < 21 ? 33 : lon < 33 ? 35 : 37;
  return std::clamp(static_cast<int>(std::floor((lon + 180) / 6)) + 1, 1, 60);
}

/// @param name  receives the name of the reference
gdal::SpatialReference referenceOf(const std::string& crs, const Middle& middle, std::string& name) {
  const scenario::GdalMessages messages;
  gdal::SpatialReference reference(OSRNewSpatialReference(nullptr));
  name = crs;
  OGRErr found = OGRERR_FAILURE;
  if (crs == "local") {
    const std::string text =
        fmt::format("+proj=aeqd +lat_0={:.9f} +lon_0={:.9f} +datum=WGS84 +units=m +no_defs",
                    middle.latitude_deg, middle.longitude_deg);
    found = OSRImportFromProj4(reference.get(), text.c_str());
  } else {
    int code = 0;
    if (crs == "utm") {
      code = (middle.latitude_deg < 0 ? 32700 : 32600) + utmZone(middle);
      name = fmt::format("EPSG:{}", code);
    } else if (crs.rfind("EPSG:", 0) == 0 && crs.find_first_not_of("0123456789", 5) == std::string::npos) {
      code = std::atoi(crs.c_str() + 5);
    }
    if (code > 0) found = OSRImportFromEPSG(reference.get(), code);
  }
  if (found != OGRERR_NONE) {
    throw Error(ErrorCode::usage,
                fmt::format("crs '{}': neither utm nor local nor a known EPSG:NUMBER", crs));
  }
  if (!OSRIsProjected(reference.get()) || std::abs(OSRGetLinearUnits(reference.get(), nullptr) - 1) > 1e-9) {
    throw Error(ErrorCode::usage,
                fmt::format("crs '{}' is not a projection in metres; pixels are squares of metres", crs));
  }
  OSRSetAxisMappingStrategy(reference.get(), OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

/// Transformation between longitude and latitude and a projection.
class Projection {
 public:
  Projection(const gdal::SpatialReference& from, const gdal::SpatialReference& to)
      : transform_(scenario::transformationBetween(from, to)) {}
  /// @return false if a point has no image
  bool operator()(std::vector<double>& x, std::vector<double>& y) const {
    constexpr std::size_t kAtOnce = 1 << 16;
    const scenario::GdalMessages messages;
    std::vector<int> done(std::min(kAtOnce, x.size()));
    for (std::size_t begin = 0; begin < x.size(); begin += kAtOnce) {
      checkpoint();
      const std::size_t count = std::min(kAtOnce, x.size() - begin);
      OCTTransformEx(transform_.get(), static_cast<int>(count), x.data() + begin, y.data() + begin, nullptr,
                     done.data());
      for (std::size_t i = 0; i < count; ++i) {
        if (done[i] == 0 || !std::isfinite(x[begin + i]) || !std::isfinite(y[begin + i])) return false;
      }
    }
    return true;
  }

 private:
  gdal::Transformation transform_;
};

/// Points along the border of a box (longitude and latitude): at each fraction of the sides one point on the
/// southern, northern, western and eastern side.
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

/// Refuses a projection that is discontinuous at a meridian of the area (usually opposite its central
/// meridian): the pixels would extend around the earth.
/// @param x  of the points of addBorder()  @param width_m  of all
/// @throws Error (usage)
void checkUncut(const std::vector<double>& x, double width_m, const std::string& crs) {
  for (std::size_t n = 4; n < x.size(); ++n) {
    const bool is_on_parallel = n % 4 < 2;
    if (is_on_parallel && std::abs(x[n] - x[n - 4]) > width_m / 2) {
      throw Error(ErrorCode::usage,
                  fmt::format("crs '{}' is cut within the area: places beside each other are {:.0f} km apart "
                              "on its plane; utm and local have no cut there",
                              crs, std::abs(x[n] - x[n - 4]) / 1000));
    }
  }
}

/// Square metres of the ellipsoid per square degree.
double metres2PerDegree2(double latitude_deg) {
  constexpr double kPerDegree2 = kPi / 180 * (kPi / 180);
  constexpr double kA2 = kWgs84SemiMajor_m * kWgs84SemiMajor_m;
  const double sine = std::sin(degToRad(latitude_deg)), cosine = std::cos(degToRad(latitude_deg));
  const double root = 1 - kWgs84EccentricitySquared * sine * sine;
  return kA2 * (1 - kWgs84EccentricitySquared) / (root * root) * cosine * kPerDegree2;
}

/// Longitudes and latitudes at the corners, the middles of the sides and the middles of square patches.
struct Lattice {
  int side = 2;  ///< pixels along a patch, even: every node is the centre of a pixel
  int patches_x = 0, patches_y = 0;
  bool is_polar = false;  ///< a node for each pixel
  std::vector<double> longitudes_deg, latitudes_deg;
  std::vector<double> metres2_per_degree2;  ///< of the ellipsoid there

  int nodesX() const { return 2 * patches_x + 1; }
  /// First of a patch's nodes.
  std::size_t node(int patch_x, int patch_y) const {
    return static_cast<std::size_t>(2 * patch_y) * nodesX() + 2 * patch_x;
  }
};

Lattice latticeOf(const Projection& toEarth, const MapGrid& grid, bool is_polar = false) {
  Lattice lattice;
  lattice.is_polar = is_polar;
  if (!is_polar)
    lattice.side = 2 * static_cast<int>(std::clamp(kPatch_m / 2 / grid.cell_m, 1.0, kMaxPatchPixels / 2.0));
  lattice.patches_x = (grid.width + lattice.side - 1) / lattice.side;
  lattice.patches_y = (grid.height + lattice.side - 1) / lattice.side;
  const int step = lattice.side / 2;
  for (int j = 0; j <= 2 * lattice.patches_y; ++j) {
    checkpoint();
    for (int i = 0; i <= 2 * lattice.patches_x; ++i) {
      lattice.longitudes_deg.push_back(grid.left_m + (i * step + 0.5) * grid.cell_m);
      lattice.latitudes_deg.push_back(grid.top_m - (j * step + 0.5) * grid.cell_m);
    }
  }
  if (!toEarth(lattice.longitudes_deg, lattice.latitudes_deg)) {
    throw Error(ErrorCode::usage,
                fmt::format("crs '{}' does not reach over all pixels of {} m of the area: a smaller "
                            "cell or another projection",
                            grid.crs, grid.cell_m));
  }
  const auto isPolar = [](double latitude_deg) { return std::abs(latitude_deg) > kPolar_deg; };
  const std::vector<double>& latitudes_deg = lattice.latitudes_deg;
  if (!is_polar && std::any_of(latitudes_deg.begin(), latitudes_deg.end(), isPolar)) {
    if (static_cast<double>(grid.width) * grid.height > kMaxPolarPixels) {
      throw Error(
          ErrorCode::usage,
          fmt::format("a map of {} x {} pixels of {} m that reaches beyond {} degrees of latitude has "
                      "more than {:.0f}: a larger cell or a smaller area",
                      grid.width, grid.height, grid.cell_m, kPolar_deg, kMaxPolarPixels));
    }
    return latticeOf(toEarth, grid, true);
  }
  for (const double latitude_deg : latitudes_deg) {
    lattice.metres2_per_degree2.push_back(metres2PerDegree2(latitude_deg));
  }
  return lattice;
}

/// The parabola through three values at 0, 1/2 and 1.
struct Parabola {
  double c0 = 0, c1 = 0, c2 = 0;

  static Parabola through(double begin, double middle, double end) {
    return {begin, 4 * middle - 3 * begin - end, 2 * (begin + end) - 4 * middle};
  }
  double at(double x) const { return c0 + x * (c1 + x * c2); }
  double slope(double x) const { return c1 + 2 * x * c2; }
};

/// The patch through 3 x 3 nodes; each row and each column is a parabola.
class Patch {
 public:
  /// @param turn  period with which nodes are shifted near the first; 0: none
  Patch(const std::vector<double>& at, std::size_t node, int nodes_x, double turn) : origin_(at[node]) {
    const auto fromOrigin = [&](int i, int j) {
      const double difference = at[node + static_cast<std::size_t>(j) * nodes_x + i] - origin_;
      return turn == 0 ? difference : std::remainder(difference, turn);
    };
    for (int i = 0; i < 3; ++i) {
      columns_[i] = Parabola::through(fromOrigin(i, 0), fromOrigin(i, 1), fromOrigin(i, 2));
    }
  }

  /// A row of the patch: values and their slopes to the south.
  struct Row {
    Parabola value, slope_south;
  };
  /// @param v  0..1 to the south
  Row row(double v) const {
    const auto across = [&](auto function) {
      return Parabola::through((columns_[0].*function)(v), (columns_[1].*function)(v),
                               (columns_[2].*function)(v));
    };
    Row row{across(&Parabola::at), across(&Parabola::slope)};
    row.value.c0 += origin_;
    return row;
  }

 private:
  double origin_;
  Parabola columns_[3];
};

/// Position of the pixels of a patch relative to the area.
enum class PatchPart { inside, outside, across };

/// Tests whether positions are in a map's area.
class AreaTest {
 public:
  explicit AreaTest(const MapArea& area) : area_(area) {
    if (area.circle) middle_ = fastGeodesy(area.circle->latitude_deg, area.circle->longitude_deg);
  }
  bool isInside(const emfield::Surface::Position& position) const {
    constexpr double kMargin_deg = 1e-9;
    if (area_.circle) return distance_m(position) <= area_.circle->radius_m;
    const double east_deg = position.longitude_deg - area_.box.west_deg;
    return position.latitude_deg >= area_.box.south_deg - kMargin_deg &&
           position.latitude_deg <= area_.box.north_deg + kMargin_deg &&
           east_deg - 360 * std::floor((east_deg + kMargin_deg) / 360) <=
               area_.box.east_deg - area_.box.west_deg + kMargin_deg;
  }
  /// Marks the positions of a patch's row that are inside. A circle is convex.
  void markInside(const emfield::Surface::Position* row, int count, bool* is_inside) const {
    const auto isIn = [&](int i) { return isInside(row[i]); };
    const bool begin_is_in = isIn(0), end_is_in = isIn(count - 1);
    if (!area_.circle || !(begin_is_in || end_is_in)) {
      for (int i = 0; i < count; ++i) is_inside[i] = isIn(i);
      return;
    }
    int low = 0, high = count - 1;  // if one of them is inside, this holds in every step
    while (begin_is_in != end_is_in && high - low > 1) {
      const int middle = low + (high - low) / 2;
      (isIn(middle) == begin_is_in ? low : high) = middle;
    }
    std::fill(is_inside, is_inside + high, begin_is_in);
    std::fill(is_inside + high, is_inside + count, end_is_in);
  }
  /// Of a patch.
  /// @param radius_m  upper bound of the distance of its positions from its middle
  PatchPart partOf(const emfield::Surface::Position& middle, double radius_m) const {
    if (!area_.circle) return PatchPart::across;
    const double middle_m = distance_m(middle);
    return middle_m + radius_m <= area_.circle->radius_m  ? PatchPart::inside
           : middle_m - radius_m > area_.circle->radius_m ? PatchPart::outside
                                                          : PatchPart::across;
  }

 private:
  double distance_m(const emfield::Surface::Position& position) const {
    return fastInverse(middle_, toEcef({position.latitude_deg, position.longitude_deg, 0})).distance_m;
  }

  const MapArea& area_;
  FastGeodesy middle_{};
};

/// Largest distance of a patch's positions from its middle (m).
double radiusOf(const Lattice& lattice, std::size_t node) {
  const auto at = [&](int i, int j) {
    const std::size_t n = node + static_cast<std::size_t>(j) * lattice.nodesX() + i;
    return toEcef({lattice.latitudes_deg[n], lattice.longitudes_deg[n], 0});
  };
  constexpr double kMargin = 1.05;  // for curved sides
  const Vec3d middle = at(1, 1);
  double chord_m = 0;
  for (const int i : {0, 2}) {
    for (const int j : {0, 2}) chord_m = std::max(chord_m, length(at(i, j) - middle));
  }
  return kMargin * chord_m;
}

/// The area's size on the ellipsoid.
double sizeOf_m2(const MapArea& area) {
  if (area.circle) {
    const double half_rad = area.circle->radius_m / kWgs84SemiMajor_m / 2;
    return 4 * kPi * std::pow(kWgs84SemiMajor_m * std::sin(half_rad), 2);
  }
  constexpr int kStrips = 200;
  const double strip_deg = (area.box.north_deg - area.box.south_deg) / kStrips;
  double sum = 0;
  for (int n = 0; n < kStrips; ++n) sum += metres2PerDegree2(area.box.south_deg + (n + 0.5) * strip_deg);
  return sum * strip_deg * (area.box.east_deg - area.box.west_deg);
}

/// Refuses a projection that leaves out a part of the area, such as one of a zone for a box around the earth:
/// its border says nothing of what is between.
/// @throws Error (usage)
void requireCovered(const MapGrid& grid) {
  constexpr double kEnough = 0.9;
  const double asked_m2 = sizeOf_m2(*grid.area);
  const double covered_m2 = std::accumulate(grid.areas_m2.begin(), grid.areas_m2.end(), 0.0);
  // Pixels belong to the area by their centres.
  const double border_m2 = 4 * std::sqrt(asked_m2) * grid.cell_m;
  if (covered_m2 >= kEnough * asked_m2 - border_m2) return;
  throw Error(
      ErrorCode::usage,
      fmt::format("crs '{}' holds {:.0f} of the area's {:.0f} km2; EPSG:3395 holds all longitudes, as a "
                  "box from -180 to 180, from 80 degrees south to 80 degrees north",
                  grid.crs, covered_m2 / 1e6, asked_m2 / 1e6));
}

/// Sets the positions and areas of a patch's row of pixels.
/// @param per_degree2  m2 per square degree, over areas of the patch
EMSCAPE_SIMD_CLONES void fillRow(const Patch::Row& latitude, const Patch::Row& longitude,
                                 const Parabola& per_degree2, double step, int pixels,
                                 emfield::Surface::Position* positions, float* areas_m2) {
  int beyond = 0;
  for (int i = 0; i < pixels; ++i) {
    const double u = i * step;
    const double latitude_deg = latitude.value.at(u), longitude_deg = longitude.value.at(u);
    const double degrees2 = longitude.value.slope(u) * latitude.slope_south.at(u) -
                            longitude.slope_south.at(u) * latitude.value.slope(u);
    positions[i].latitude_deg = latitude_deg;
    positions[i].longitude_deg = longitude_deg;
    areas_m2[i] = static_cast<float>(std::fabs(degrees2) * per_degree2.at(u));
    beyond |= std::fabs(longitude_deg) < 180 ? 0 : 1;
  }
  if (beyond == 0) return;
  for (int i = 0; i < pixels; ++i) positions[i].longitude_deg = wrapLongitude_deg(positions[i].longitude_deg);
}

/// Area (m2) of the pixel at a node of a lattice with one node per pixel: that of the parallelogram to the
/// neighbours.
double areaAt(const Lattice& lattice, std::size_t node) {
  const auto at = [&](std::size_t n) {
    return toEcef({lattice.latitudes_deg[n], lattice.longitudes_deg[n], 0});
  };
  const Vec3d corner = at(node);
  return length(cross(at(node + 1) - corner, at(node + lattice.nodesX()) - corner));
}

/// Sets positions and areas, on patches between the nodes of a lattice.
void fillPositions(const Lattice& lattice, const MapArea& area, MapGrid& grid) {
  grid.positions.resize(static_cast<std::size_t>(grid.width) * grid.height);
  grid.areas_m2.resize(grid.positions.size());
  const AreaTest test(area);
  const int side = lattice.side, nodes_x = lattice.nodesX();
  const double step = 1.0 / side;
  parallelFor(lattice.patches_y * lattice.patches_x, 1, [&](int begin, int end) {
    for (int patch = begin; patch < end; ++patch) {
      const int patch_x = patch % lattice.patches_x, patch_y = patch / lattice.patches_x;
      const std::size_t node = lattice.node(patch_x, patch_y), middle = node + nodes_x + 1;
      const Patch longitudes(lattice.longitudes_deg, node, nodes_x, 360);
      const Patch latitudes(lattice.latitudes_deg, node, nodes_x, 0);
      const Patch scales(lattice.metres2_per_degree2, node, nodes_x, 0);
      const PatchPart part = test.partOf({lattice.latitudes_deg[middle], lattice.longitudes_deg[middle]},
                                         radiusOf(lattice, node));
      const int columns = std::min(side, grid.width - patch_x * side);
      const int rows = std::min(side, grid.height - patch_y * side);
      for (int j = 0; j < rows; ++j) {
        const double v = j * step;
        const std::size_t first = static_cast<std::size_t>(patch_y * side + j) * grid.width + patch_x * side;
        emfield::Surface::Position* const positions = grid.positions.data() + first;
        float* const areas_m2 = grid.areas_m2.data() + first;
        Parabola per_degree2 = scales.row(v).value;
        for (double* const c : {&per_degree2.c0, &per_degree2.c1, &per_degree2.c2}) *c *= step * step;
        fillRow(latitudes.row(v), longitudes.row(v), per_degree2, step, columns, positions, areas_m2);
        if (lattice.is_polar) {
          for (int i = 0; i < columns; ++i)
            areas_m2[i] =
                static_cast<float>(areaAt(lattice, node + static_cast<std::size_t>(j) * nodes_x + i));
        }
        if (part == PatchPart::inside) continue;
        bool is_inside[kMaxPatchPixels] = {};
        if (part == PatchPart::across) test.markInside(positions, columns, is_inside);
        for (int i = 0; i < columns; ++i) {
          if (is_inside[i]) continue;
          positions[i].latitude_deg = NAN;
          areas_m2[i] = 0;
        }
      }
    }
  });
}

}  // namespace

long long MapGrid::pixelAt(double latitude_deg, double longitude_deg) const {
  const gdal::SpatialReference earth = scenario::wgs84Reference();
  const gdal::SpatialReference reference = study::referenceOf(*this);
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
  grid.area = area;
  const gdal::SpatialReference earth = scenario::wgs84Reference();
  const gdal::SpatialReference reference = referenceOf(crs, middleOf(area), grid.crs);
  grid.wkt = wkt2Of(reference.get());
  std::vector<double> x, y;
  addBorder(area.box, x, y);
  if (!Projection(earth, reference)(x, y)) {
    throw Error(ErrorCode::usage, fmt::format("crs '{}' does not reach over the whole area", crs));
  }
  const auto [least_x, largest_x] = std::minmax_element(x.begin(), x.end());
  const auto [least_y, largest_y] = std::minmax_element(y.begin(), y.end());
  checkUncut(x, *largest_x - *least_x, crs);
  constexpr double kRounding = 1e-6;  // cells
  const double first_column = std::floor(*least_x / cell_m + kRounding),
               end_column = std::ceil(*largest_x / cell_m - kRounding);
  const double first_row = std::floor(*least_y / cell_m + kRounding),
               end_row = std::ceil(*largest_y / cell_m - kRounding);
  const double count = (end_column - first_column) * (end_row - first_row);
  if (!(count <= kMaxPixels)) {
    throw Error(
        ErrorCode::usage,
        fmt::format("a map of {:.9g} x {:.9g} pixels of {} m has more than {:.0f}: a larger cell or a "
                    "smaller area",
                    end_column - first_column, end_row - first_row, cell_m, kMaxPixels));
  }
  grid.width = static_cast<int>(end_column - first_column);
  grid.height = static_cast<int>(end_row - first_row);
  grid.left_m = first_column * cell_m;
  grid.top_m = end_row * cell_m;
  fillPositions(latticeOf(Projection(reference, earth), grid), area, grid);
  requireCovered(grid);
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
  if (!(std::max(width, height) * cell_m <= kLargestSide_m)) {
    throw Error(ErrorCode::bad_input, fmt::format("a map of {} x {} pixels of {} m is larger than the earth",
                                                  width, height, cell_m));
  }
  const MapArea everywhere{{-90, 90, -180, 180}, {}};
  fillPositions(latticeOf(Projection(study::referenceOf(grid), scenario::wgs84Reference()), grid), everywhere,
                grid);
  return grid;
}

}  // namespace emscape::study
