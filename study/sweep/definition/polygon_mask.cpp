#include "study/sweep/definition/polygon_mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "emscape/base/error.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "scenario/map/vector_file.h"
#include "scenario/terrain/transformation.h"

namespace emscape::study {
namespace {

struct Corner {
  double x, y;
};

/// A polygon with its holes, in the coordinates of its file.
class Polygon {
 public:
  explicit Polygon(const std::vector<std::vector<Corner>>& rings) {
    for (const std::vector<Corner>& ring : rings) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Corner& a = ring[i];
        const Corner& b = ring[(i + 1) % ring.size()];
        west_ = std::min(west_, a.x), east_ = std::max(east_, a.x);
        south_ = std::min(south_, a.y), north_ = std::max(north_, a.y);
        if (a.y < b.y) edges_.push_back({a, b});
        if (b.y < a.y) edges_.push_back({b, a});
      }
    }
    sortIntoBands();
  }

  double west() const { return west_; }
  double east() const { return east_; }
  double south() const { return south_; }
  double north() const { return north_; }
  /// @pre south() <= y <= north()
  bool contains(double x, double y) const {
    bool is_inside = false;
    if (edges_.empty()) return is_inside;
    const std::size_t band = bandOf(y);
    for (std::size_t i = band_begins_[band]; i < band_begins_[band + 1]; ++i) {
      const auto& [low, high] = edges_[band_edges_[i]];
      if (low.y <= y && y < high.y && x < low.x + (y - low.y) / (high.y - low.y) * (high.x - low.x)) {
        is_inside = !is_inside;
      }
    }
    return is_inside;
  }

 private:
  struct Edge {
    Corner low, high;
  };

  std::size_t bandOf(double y) const {
    const double band = (y - south_) / (north_ - south_) * static_cast<double>(bands_);
    return std::min(static_cast<std::size_t>(band), bands_ - 1);
  }
  /// Lists the edges of each band of y: about five entries per edge in all.
  void sortIntoBands() {
    double crossings = 1;  // edges that a line of constant y meets, on the average
    for (const Edge& edge : edges_) crossings += (edge.high.y - edge.low.y) / (north_ - south_);
    bands_ = static_cast<std::size_t>(4 * static_cast<double>(edges_.size()) / crossings) + 1;
    band_begins_.assign(bands_ + 1, 0);
    const auto eachBand = [&](const Edge& edge, const auto& visit) {
      for (std::size_t band = bandOf(edge.low.y); band <= bandOf(edge.high.y); ++band) visit(band);
    };
    for (const Edge& edge : edges_) eachBand(edge, [&](std::size_t band) { ++band_begins_[band + 1]; });
    for (std::size_t band = 0; band < bands_; ++band) band_begins_[band + 1] += band_begins_[band];
    band_edges_.resize(band_begins_.back());
    std::vector<std::size_t> next(band_begins_.begin(), band_begins_.end() - 1);
    for (std::size_t i = 0; i < edges_.size(); ++i)
      eachBand(edges_[i], [&](std::size_t band) { band_edges_[next[band]++] = i; });
  }

  double west_ = HUGE_VAL, east_ = -HUGE_VAL, south_ = HUGE_VAL, north_ = -HUGE_VAL;
  std::vector<Edge> edges_;  ///< all but those of constant y
  std::size_t bands_ = 1;
  std::vector<std::size_t> band_begins_, band_edges_;
};

/// A coordinate system of polygons.
class LayerSystem {
 public:
  /// @param system  null: longitude and latitude
  explicit LayerSystem(OGRSpatialReferenceH system) {
    if (system == nullptr) {
      setGeographic(360, " of longitudes and latitudes: the file names no coordinate system");
      return;
    }
    from_wgs84_ = scenario::newTransformation(scenario::wgs84Reference().get(), system);
    if (from_wgs84_ == nullptr)
      throw Error(ErrorCode::bad_input, "the map cannot be brought to the coordinate system of its polygons");
    if (OSRIsGeographic(system) == 0) return;
    const double turn = 2 * kPi / OSRGetAngularUnits(system, nullptr);
    const bool is_rounded = std::abs(turn - std::round(turn)) < 1e-4;  // files round a degree's radians
    setGeographic(is_rounded ? std::round(turn) : turn, " of longitudes and latitudes");
  }

  /// Range of x after which a place repeats; infinity: none.
  double turn() const { return turn_; }

  /// @throws Error (bad_input): fewer than three corners, which GDAL makes of text that it cannot read, a
  /// corner that is not on the earth, or an edge that may lead either way around it; an edge along a pole is
  /// a point and has no way
  void check(const std::vector<Corner>& ring) const {
    const bool is_closed =
        ring.size() > 1 && ring.front().x == ring.back().x && ring.front().y == ring.back().y;
    if (const std::size_t corners = ring.size() - (is_closed ? 1 : 0); corners < 3) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("a ring of a polygon has {} corner{}, but needs 3 or more", corners,
                              corners == 1 ? "" : "s"));
    }
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Corner& corner = ring[i];
      const Corner& next = ring[(i + 1) % ring.size()];
      if (!(std::abs(corner.x) <= max_x_ && std::abs(corner.y) <= max_y_)) {
        throw Error(
            ErrorCode::bad_input,
            fmt::format("a corner of a polygon is at ({}, {}), outside the allowed range -{} to {}, -{} "
                        "to {}{}",
                        corner.x, corner.y, max_x_, max_x_, max_y_, max_y_, kind_));
      }
      const bool is_at_pole = next.y == corner.y && std::abs(corner.y) == max_y_;
      if (std::abs(next.x - corner.x) > turn_ / 2 && !is_at_pole) {
        throw Error(ErrorCode::bad_input,
                    fmt::format("an edge of a polygon from longitude {} to {} may lead either way around the "
                                "earth; split long edges, and let longitudes pass 180",
                                corner.x, next.x));
      }
    }
  }

  /// Brings longitudes (x) and latitudes (y) of WGS84 (deg) to the system. @return false where that fails
  std::vector<int> fromWgs84(std::vector<double>& x, std::vector<double>& y) const {
    std::vector<int> done(x.size(), 1);
    if (from_wgs84_ != nullptr) {
      OCTTransformEx(from_wgs84_.get(), static_cast<int>(x.size()), x.data(), y.data(), nullptr, done.data());
    }
    return done;
  }

 private:
  void setGeographic(double turn, const char* kind) {
    turn_ = max_x_ = turn;
    max_y_ = turn / 4;
    kind_ = kind;
  }

  double turn_ = std::numeric_limits<double>::infinity();
  double max_x_ = 1e10, max_y_ = 1e10;  // of the earth, in any unit of a projection
  const char* kind_ = "";
  gdal::Transformation from_wgs84_;
};

struct PixelCentre {
  double x, y;
  std::size_t pixel;
};

/// The centres of a map's pixels in a coordinate system, in ascending y.
std::vector<PixelCentre> centresIn(const LayerSystem& system, const MapGrid& grid) {
  constexpr std::size_t kAtOnce = 1 << 16;
  std::vector<PixelCentre> centres;
  for (std::size_t begin = 0; begin < grid.pixels(); begin += kAtOnce) {
    const std::size_t end = std::min(begin + kAtOnce, grid.pixels());
    std::vector<double> x, y;
    for (std::size_t p = begin; p < end; ++p) {
      x.push_back(grid.positions[p].longitude_deg);
      y.push_back(grid.positions[p].latitude_deg);
    }
    const std::vector<int> done = system.fromWgs84(x, y);
    for (std::size_t p = begin; p < end; ++p) {
      const PixelCentre centre{x[p - begin], y[p - begin], p};
      if (done[p - begin] != 0 && std::isfinite(centre.x) && std::isfinite(centre.y))
        centres.push_back(centre);
    }
  }
  std::sort(centres.begin(), centres.end(),
            [](const PixelCentre& a, const PixelCentre& b) { return a.y < b.y; });
  return centres;
}

void mark(const Polygon& polygon, const std::vector<PixelCentre>& centres, double turn,
          std::vector<std::uint8_t>& pixels) {
  const auto begin = std::partition_point(
      centres.begin(), centres.end(), [&](const PixelCentre& centre) { return centre.y < polygon.south(); });
  const auto end = std::partition_point(
      begin, centres.end(), [&](const PixelCentre& centre) { return centre.y <= polygon.north(); });
  parallelFor(static_cast<int>(end - begin), 1024, [&](int first, int last) {
    for (auto centre = begin + first; centre != begin + last; ++centre) {
      double x = centre->x;
      if (std::isfinite(turn)) x += std::ceil((polygon.west() - x) / turn) * turn;
      for (; x <= polygon.east() && pixels[centre->pixel] == 0; x += turn) {
        if (x >= polygon.west() && polygon.contains(x, centre->y)) pixels[centre->pixel] = 1;
      }
    }
  });
}

std::vector<Corner> cornersOf(OGRGeometryH ring) {
  std::vector<Corner> corners(static_cast<std::size_t>(OGR_G_GetPointCount(ring)));
  if (!corners.empty())
    OGR_G_GetPoints(ring, &corners[0].x, sizeof(Corner), &corners[0].y, sizeof(Corner), nullptr, 0);
  return corners;
}

/// Calls visit(polygon) for each polygon in a geometry without curves.
template <class Visit>
void eachPolygon(OGRGeometryH geometry, const LayerSystem& system, const Visit& visit) {
  const OGRwkbGeometryType type = wkbFlatten(OGR_G_GetGeometryType(geometry));
  const bool is_polygon = type == wkbPolygon || type == wkbTriangle;
  std::vector<std::vector<Corner>> rings;
  for (int i = 0; i < OGR_G_GetGeometryCount(geometry); ++i) {
    OGRGeometryH part = OGR_G_GetGeometryRef(geometry, i);
    if (is_polygon) {
      rings.push_back(cornersOf(part));
      system.check(rings.back());
    } else {
      eachPolygon(part, system, visit);
    }
  }
  if (is_polygon) visit(Polygon(rings));
}

}  // namespace

std::vector<std::uint8_t> pixelsWithin(const std::string& file, const MapGrid& grid) {
  const scenario::VectorFile polygons(file);
  const scenario::GdalMessages messages;
  const auto fail = [&](const std::string& problem) {
    throw Error(ErrorCode::bad_input, {file, 0, 0}, messages.explain(problem));
  };
  std::vector<std::uint8_t> pixels(grid.pixels());
  bool has_polygon = false;
  for (OGRLayerH layer : polygons.layers()) {
    try {
      const LayerSystem system(OGR_L_GetSpatialRef(layer));
      const std::vector<PixelCentre> centres = centresIn(system, grid);
      polygons.eachFeature(layer, [&](OGRFeatureH feature) {
        OGRGeometryH geometry = OGR_F_GetGeometryRef(feature);
        if (geometry == nullptr) return;
        const gdal::Geometry straight(OGR_G_GetLinearGeometry(geometry, 0, nullptr));
        eachPolygon(straight.get(), system, [&](const Polygon& polygon) {
          has_polygon = true;
          mark(polygon, centres, system.turn(), pixels);
        });
      });
    } catch (const Error& error) {
      if (error.code() != ErrorCode::bad_input || !error.location().file.empty()) throw;
      fail(error.message());
    }
  }
  if (!has_polygon) fail("has no polygon");
  if (std::find(pixels.begin(), pixels.end(), 1) == pixels.end()) fail("has no pixel of the map");
  return pixels;
}

}  // namespace emscape::study
