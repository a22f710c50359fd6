#include "scenario/terrain/georeference.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

#include "emscape/base/error.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/units.h"
#include "scenario/terrain/gdal_messages.h"
#include "scenario/terrain/transformation.h"

namespace emscape::scenario {
namespace {

/// Positions of another datum count as WGS84 if they are closer than this (posts).
constexpr double kSameDatum_posts = 0.05;
/// Georeferences are rounded in files: a lattice this close (posts) to whole fractions of a degree is snapped
/// to them.
constexpr double kSnap_posts = 0.01;
/// Largest error of positions interpolated between transformed ones (posts).
constexpr double kLineTolerance_posts = 0.01;
/// Limits of a plausible georeference. Coordinates: metres or feet of a projection; angles are much smaller.
constexpr double kMaxCrsCoordinate = 1e9;
constexpr double kMinCrsStep = 1e-9;
constexpr double kMaxLongitude_deg = 1080;

[[noreturn]] void fail(const std::string& problem) {
  throw Error(ErrorCode::bad_input, problem);
}

/// Snaps an axis of posts to whole fractions of a degree if that moves none of them by more than kSnap_posts.
void snapToDegrees(double& first, double& step, int count) {
  const double per_degree = std::round(1.0 / step);
  if (per_degree < 1.0) return;
  // Pixel-is-area posts are at odd halves.
  const double halves = std::round(first * 2.0 * per_degree);
  const double last = first + (count - 1) * step;
  const double snapped_first = halves / (2.0 * per_degree);
  const double snapped_last = (halves + 2.0 * (count - 1)) / (2.0 * per_degree);
  if (std::abs(snapped_first - first) > kSnap_posts * step ||
      std::abs(snapped_last - last) > kSnap_posts * step) {
    return;
  }
  first = snapped_first;
  step = 1.0 / per_degree;
}

std::string shortText(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// Points that could not be transformed become NaN.
void transform(const gdal::Transformation& transformation, std::vector<double>& x, std::vector<double>& y) {
  const GdalMessages quiet;
  std::vector<int> done(x.size());
  OCTTransformEx(transformation.get(), static_cast<int>(x.size()), x.data(), y.data(), nullptr, done.data());
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!done[k] || !std::isfinite(x[k]) || !std::isfinite(y[k])) x[k] = y[k] = std::nan("");
  }
}

/// A GDALTransformerFunc. @param transformation  an OGRCoordinateTransformationH; only applied forwards
int transformPoints(void* transformation, int /*backwards*/, int count, double* x, double* y, double* /*z*/,
                    int* done) {
  OCTTransformEx(static_cast<OGRCoordinateTransformationH>(transformation), count, x, y, nullptr, done);
  return TRUE;
}

}  // namespace

Georeference::Georeference(const double (&transform)[6], int columns, int rows, bool with_area)
    : is_area(with_area), columns_(columns), rows_(rows) {
  std::copy(std::begin(transform), std::end(transform), pixel_to_system_);
  const double* g = pixel_to_system_;
  const double area = g[1] * g[5] - g[2] * g[4];
  double reach = 0;  // of the raster's corners from the CRS's origin
  for (const double column : {0.0, double(columns_)}) {
    for (const double row : {0.0, double(rows_)}) {
      reach = std::max(
          {reach, std::abs(g[0] + column * g[1] + row * g[2]), std::abs(g[3] + column * g[4] + row * g[5])});
      if (std::isnan(g[0] + column * g[1] + row * g[2] + g[3] + column * g[4] + row * g[5])) reach = HUGE_VAL;
    }
  }
  if (!std::isfinite(reach) || !std::isfinite(area) || area == 0.0) {
    fail("has a georeference of no extent");
  }
  if (reach > kMaxCrsCoordinate) {
    fail("its posts are not on the earth: a coordinate is " + shortText(reach) + ", more than the allowed " +
         shortText(kMaxCrsCoordinate));
  }
  const double step = std::min(std::hypot(g[1], g[4]), std::hypot(g[2], g[5]));
  if (step < kMinCrsStep) {
    fail("its posts are " + shortText(step) + " apart, less than the allowed " + shortText(kMinCrsStep) +
         " of the coordinates' unit");
  }
  turned = g[2] != 0.0 || g[4] != 0.0 || g[1] < 0.0;
  if (turned) {
    north_first = false;
  } else {
    north_first = g[5] < 0.0;
    lattice.step_x = g[1];
    lattice.step_y = std::abs(g[5]);
    lattice.x0 = g[0] + 0.5 * g[1];
    lattice.y0 = g[3] + (north_first ? rows_ - 0.5 : 0.5) * g[5];
  }
}

void Georeference::placeOnEarth(gdal::SpatialReference system, const std::string& name) {
  const GdalMessages messages;
  system_ = std::move(system);
  OSRSetAxisMappingStrategy(system_.get(), OAMS_TRADITIONAL_GIS_ORDER);
  const gdal::SpatialReference wgs84(OSRNewSpatialReference(nullptr));
  OSRSetWellKnownGeogCS(wgs84.get(), "WGS84");
  OSRSetAxisMappingStrategy(wgs84.get(), OAMS_TRADITIONAL_GIS_ORDER);
  // Most files are of WGS84 itself; transformations take milliseconds to make.
  const bool is_wgs84 = OSRIsSame(system_.get(), wgs84.get()) != 0;
  if (!is_wgs84) {
    to_wgs84_ = newTransformation(system_.get(), wgs84.get());
    from_wgs84_ = newTransformation(wgs84.get(), system_.get());
  }
  if (!is_wgs84 && (!to_wgs84_ || !from_wgs84_)) {
    fail(messages.explain(std::string("its coordinate reference system '") + OSRGetName(system_.get()) +
                          "' cannot be brought to latitude and longitude"));
  }
  const double* g = pixel_to_system_;
  const double post = turned ? std::min(std::hypot(g[1], g[4]), std::hypot(g[2], g[5]))
                             : std::min(lattice.step_x, lattice.step_y);
  if (from_wgs84_)
    line_transformer_.reset(
        GDALCreateApproxTransformer(transformPoints, from_wgs84_.get(), kLineTolerance_posts * post));

  is_geographic = OSRIsGeographic(system_.get()) && !turned && liesOnWgs84();
  if (is_geographic) {
    snapToDegrees(lattice.x0, lattice.step_x, columns_);
    snapToDegrees(lattice.y0, lattice.step_y, rows_);
    const double west_deg = lattice.x(-0.5), east_deg = lattice.x(columns_ - 0.5);
    if (west_deg < -kMaxLongitude_deg || east_deg > kMaxLongitude_deg) {
      fail("its longitudes run from " + shortText(west_deg) + " to " + shortText(east_deg) +
           " deg, outside the allowed range " + shortText(-kMaxLongitude_deg) + " to " +
           shortText(kMaxLongitude_deg) + " deg");
    }
    plane_name = "WGS84";
    return;
  }
  char* wkt = nullptr;
  OSRExportToWkt(system_.get(), &wkt);
  plane_name = turned ? name : std::string(wkt ? wkt : "");
  CPLFree(wkt);
}

/// True if the CRS's longitudes and latitudes differ from WGS84's by less than kSameDatum_posts.
bool Georeference::liesOnWgs84() const {
  std::vector<double> x, y;
  for (double part_y : {0.0, 0.5, 1.0}) {
    for (double part_x : {0.0, 0.5, 1.0}) {
      x.push_back(lattice.x(part_x * (columns_ - 1)));
      y.push_back(lattice.y(part_y * (rows_ - 1)));
    }
  }
  std::vector<double> longitude = x, latitude = y;
  if (to_wgs84_) transform(to_wgs84_, longitude, latitude);
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!(std::abs(wrapLongitude_deg(longitude[k] - x[k])) <= kSameDatum_posts * lattice.step_x &&
          std::abs(latitude[k] - y[k]) <= kSameDatum_posts * lattice.step_y)) {
      return false;
    }
  }
  return true;
}

void Georeference::systemOfPlane(std::vector<double>& x, std::vector<double>& y) const {
  if (!turned) return;
  const double* g = pixel_to_system_;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double column = x[k] + 0.5, row = y[k] + 0.5;
    x[k] = g[0] + column * g[1] + row * g[2];
    y[k] = g[3] + column * g[4] + row * g[5];
  }
}

void Georeference::planeOfSystem(std::vector<double>& x, std::vector<double>& y) const {
  const double* g = pixel_to_system_;
  if (OSRIsGeographic(system_.get())) {
    // The range of longitudes that the file uses, in whole turns.
    const double turn = 2.0 * kPi / OSRGetAngularUnits(system_.get(), nullptr);
    const double middle = g[0] + 0.5 * (columns_ * g[1] + rows_ * g[2]);
    for (double& longitude : x) longitude = middle + std::remainder(longitude - middle, turn);
  }
  if (!turned) return;
  const double area = g[1] * g[5] - g[2] * g[4];
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double east = x[k] - g[0], north = y[k] - g[3];
    x[k] = (east * g[5] - north * g[2]) / area - 0.5;
    y[k] = (north * g[1] - east * g[4]) / area - 0.5;
  }
}

void Georeference::toGeographic(std::vector<double>& x, std::vector<double>& y) const {
  systemOfPlane(x, y);
  if (to_wgs84_) transform(to_wgs84_, x, y);
}

void Georeference::toPlane(std::vector<double>& x, std::vector<double>& y) const {
  if (from_wgs84_) transform(from_wgs84_, x, y);
  planeOfSystem(x, y);
}

void Georeference::lineToPlane(std::vector<double>& x, std::vector<double>& y) const {
  if (!line_transformer_) return toPlane(x, y);
  const GdalMessages quiet;
  std::vector<double> z(x.size(), 0.0);
  std::vector<int> done(x.size());
  GDALApproxTransform(line_transformer_.get(), FALSE, static_cast<int>(x.size()), x.data(), y.data(),
                      z.data(), done.data());
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!done[k]) x[k] = y[k] = std::nan("");
  }
  planeOfSystem(x, y);
}

}  // namespace emscape::scenario
