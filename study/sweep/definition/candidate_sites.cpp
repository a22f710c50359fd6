#include "study/sweep/definition/candidate_sites.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "document/text_lines.h"
#include "emscape/base/error.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/log.h"
#include "emscape/base/units.h"
#include "scenario/map/point_table.h"
#include "scenario/map/vector_file.h"
#include "scenario/terrain/transformation.h"
#include "study/sweep/definition/study_reading.h"

namespace emscape::study {
namespace {

constexpr std::size_t kMaxCandidates = 10000;

/// To a centimetre, so that values are short.
double rounded(double degrees) {
  return std::round(degrees * 1e7) / 1e7;
}

std::string numberedName(const std::vector<CandidateSite>& sites) {
  return fmt::format("site {}", sites.size() + 1);
}

/// A layer's fields of heights: the first is used, the others are compared with it.
std::vector<int> heightFieldsOf(OGRFeatureDefnH layer) {
  std::vector<int> fields;
  for (int field = 0; field < OGR_FD_GetFieldCount(layer); ++field) {
    if (scenario::heightReferenceOf(OGR_Fld_GetNameRef(OGR_FD_GetFieldDefn(layer, field))))
      fields.push_back(field);
  }
  return fields;
}

/// True for a field whose name is that of a height in some language. Vector files have many other fields.
bool mayBeHeight(const char* name) {
  const std::string upper = document::upperCase(name);
  const auto has = [&](const char* word) { return upper.find(word) != std::string::npos; };
  return upper != "ALTITUDEMODE" && (has("HEIGHT") || has("HOEHE") || has("H\xC3\xB6HE") || has("ALT") ||
                                     has("ELEV") || has("HAUTEUR") || has("MAST"));
}

/// What of a file is not used.
struct Unused {
  std::vector<std::string> columns;
  bool has_third = false;  ///< a point has a third coordinate
  int no_points = 0;       ///< features
};

void addLayer(const scenario::VectorFile& points, OGRLayerH layer, const std::string& file,
              std::vector<CandidateSite>& sites, Unused& unused) {
  const gdal::SpatialReference wgs84 = scenario::wgs84Reference();
  gdal::Transformation transformation;
  if (OGR_L_GetSpatialRef(layer) != nullptr) {
    const gdal::SpatialReference own(OSRClone(OGR_L_GetSpatialRef(layer)));
    OSRSetAxisMappingStrategy(own.get(), OAMS_TRADITIONAL_GIS_ORDER);
    transformation = scenario::transformationBetween(own, wgs84);
  }
  const OGRFeatureDefnH definition = OGR_L_GetLayerDefn(layer);
  const int name_field = OGR_FD_GetFieldIndex(definition, "name");
  const int ele_field = OGR_FD_GetFieldIndex(definition, "ele");
  const std::vector<int> height_fields = heightFieldsOf(definition);
  const auto isUnusedHeight = [&](int field) {
    return field != ele_field && std::count(height_fields.begin(), height_fields.end(), field) == 0 &&
           mayBeHeight(OGR_Fld_GetNameRef(OGR_FD_GetFieldDefn(definition, field)));
  };
  std::set<std::string> others;
  int number = 0;
  points.eachFeature(layer, [&](OGRFeatureH feature) {
    ++number;
    OGRGeometryH geometry = OGR_F_GetGeometryRef(feature);
    const OGRwkbGeometryType type =
        geometry == nullptr ? wkbNone : wkbFlatten(OGR_G_GetGeometryType(geometry));
    const auto fail = [&](const std::string& problem) {
      throw Error(ErrorCode::bad_input, {file, 0, 0}, fmt::format("point {} {}", number, problem));
    };
    if (type == wkbMultiPoint) {
      if (OGR_G_GetGeometryCount(geometry) != 1)
        fail(fmt::format("is a multipoint of {} places; a candidate is one",
                         OGR_G_GetGeometryCount(geometry)));
      geometry = OGR_G_GetGeometryRef(geometry, 0);
    } else if (type != wkbPoint) {
      unused.no_points += geometry == nullptr ? 1 : 0;
      return;
    }
    if (OGR_G_IsEmpty(geometry) != 0) fail("is empty: it has no coordinates");
    const double own_x = OGR_G_GetX(geometry, 0), own_y = OGR_G_GetY(geometry, 0);
    double x = own_x, y = own_y;
    if (transformation != nullptr && OCTTransform(transformation.get(), 1, &x, &y, nullptr) == 0)
      fail(fmt::format("at ({}, {}) has no longitude and latitude", own_x, own_y));
    if (!(std::abs(y) <= 90 && x >= -180 && x <= 360))
      fail(fmt::format("is at longitude {}, latitude {}, outside the allowed range -180 to 360, -90 to 90", x,
                       y));
    std::string name = name_field < 0 ? "" : OGR_F_GetFieldAsString(feature, name_field);
    if (name.empty()) name = numberedName(sites);
    CandidateSite site{std::move(name), y, wrapLongitude_deg(x), {}};
    for (const int height_field : height_fields) {
      if (OGR_F_IsFieldSetAndNotNull(feature, height_field) == 0) continue;
      const char* const field = OGR_Fld_GetNameRef(OGR_FD_GetFieldDefn(definition, height_field));
      const std::string text = OGR_F_GetFieldAsString(feature, height_field);
      const std::optional<double> height_m = document::numberOrCommaIn(text);
      const bool is_used = height_field == height_fields.front();
      if (!height_m && !text.empty() && is_used)
        fail(fmt::format("has {} '{}', not a number of metres", field, text));
      if (!height_m) continue;
      const scenario::PointHeight height{*scenario::heightReferenceOf(field), *height_m};
      if (is_used) {
        site.height = height;
      } else if (site.height) {
        const std::string contradiction =
            scenario::contradictionOfHeights(y, site.longitude_deg, *site.height, height);
        if (!contradiction.empty()) fail("contradicts itself: " + contradiction);
      }
    }
    for (int field = 0; field < OGR_FD_GetFieldCount(definition); ++field) {
      if (isUnusedHeight(field) && OGR_F_IsFieldSetAndNotNull(feature, field) != 0)
        others.insert(OGR_Fld_GetNameRef(OGR_FD_GetFieldDefn(definition, field)));
    }
    unused.has_third = unused.has_third || OGR_G_GetZ(geometry, 0) != 0 ||
                       (ele_field >= 0 && OGR_F_IsFieldSetAndNotNull(feature, ele_field) != 0);
    sites.push_back(std::move(site));
  });
  unused.columns.insert(unused.columns.end(), others.begin(), others.end());
}

/// Says once which heights the sites have, and what of the file is not used.
void tellHeights(const std::string& file, const std::vector<CandidateSite>& sites, const Unused& unused) {
  const auto with_height =
      std::find_if(sites.begin(), sites.end(), [](const CandidateSite& site) { return site.height; });
  std::string text;
  if (!unused.columns.empty())
    text = fmt::format("not used: {} '{}'", unused.columns.size() == 1 ? "column" : "columns",
                       fmt::join(unused.columns, "', '"));
  if (unused.has_third) text = "not used: the heights of the points";
  if (with_height != sites.end()) {
    logInfo(fmt::format("{}: sites have the heights of its {}", file, with_height->height->key()));
  } else if (!text.empty()) {
    text +=
        "; each site has the height of its platform in the scenario (a column or field height_agl_m or "
        "height_msl_m gives each its own)";
  }
  if (!text.empty()) logWarning(fmt::format("{}: {}", file, text));
  if (unused.no_points > 0)
    logWarning(fmt::format("{}: {} of {} features have no point and are left out", file, unused.no_points,
                           static_cast<std::size_t>(unused.no_points) + sites.size()));
}

}  // namespace

std::vector<CandidateSite> readCandidates(const std::string& file) {
  std::vector<CandidateSite> sites;
  Unused unused;
  if (const auto table = scenario::readPointTable(file, &unused.columns)) {
    for (const scenario::NamedPoint& point : *table) {
      sites.push_back({point.name.empty() ? numberedName(sites) : point.name, point.latitude_deg,
                       point.longitude_deg, point.height});
    }
  } else {
    const scenario::VectorFile points(file);
    const scenario::GdalMessages messages;
    for (OGRLayerH layer : points.layers()) addLayer(points, layer, file, sites, unused);
  }
  if (sites.empty() || sites.size() > kMaxCandidates) {
    throw Error(
        ErrorCode::bad_input, {file, 0, 0},
        fmt::format("{} points, outside the allowed range 1 to {}{}", sites.size(), kMaxCandidates,
                    sites.empty()
                        ? "; a CSV file needs the columns latitude_deg and longitude_deg, or mgrs, or WKT"
                        : ""));
  }
  std::set<std::string> names;
  for (const CandidateSite& site : sites) {
    if (hasControlCharacter(site.name)) {
      throw Error(ErrorCode::bad_input, {file, 0, 0},
                  "the name of a point has a line break or another control character");
    }
    if (!names.insert(site.name).second) {
      throw Error(ErrorCode::bad_input, {file, 0, 0}, fmt::format("two points are named '{}'", site.name));
    }
  }
  tellHeights(file, sites, unused);
  return sites;
}

std::vector<CandidateSite> candidatesOver(const MapArea& area, double distance_m) {
  const double middle_lat_deg = (area.box.south_deg + area.box.north_deg) / 2;
  const double middle_lon_deg = (area.box.west_deg + area.box.east_deg) / 2;
  const auto step_deg = [&](double azimuth_rad, double GeodeticPosition::*coordinate, double middle_deg) {
    return std::abs(
        geodesicDirect(middle_lat_deg, wrapLongitude_deg(middle_lon_deg), azimuth_rad, distance_m).*
            coordinate -
        middle_deg);
  };
  const double lat_step_deg = step_deg(0, &GeodeticPosition::latitude_deg, middle_lat_deg);
  const double lon_step_deg =
      step_deg(degToRad(90.0), &GeodeticPosition::longitude_deg, wrapLongitude_deg(middle_lon_deg));
  const int rows = static_cast<int>((area.box.north_deg - middle_lat_deg) / lat_step_deg);
  const int columns = static_cast<int>((area.box.east_deg - middle_lon_deg) / lon_step_deg);
  std::vector<CandidateSite> sites;
  for (int row = rows; row >= -rows; --row) {
    for (int column = -columns; column <= columns; ++column) {
      const double latitude_deg = rounded(middle_lat_deg + row * lat_step_deg);
      const double longitude_deg = rounded(wrapLongitude_deg(middle_lon_deg + column * lon_step_deg));
      if (area.circle &&
          geodesicInverse(area.circle->latitude_deg, area.circle->longitude_deg, latitude_deg, longitude_deg)
                  .distance_m > area.circle->radius_m) {
        continue;
      }
      sites.push_back({fmt::format("site {}", sites.size() + 1), latitude_deg, longitude_deg, {}});
      if (sites.size() > kMaxCandidates) {
        throw Error(ErrorCode::bad_input, fmt::format("candidates every {} m are more than the allowed {}",
                                                      distance_m, kMaxCandidates));
      }
    }
  }
  return sites;
}

}  // namespace emscape::study
