/// Files of points, lines or polygons that a study or a picture names.
#pragma once

#include <string>
#include <vector>

#include "base/geodesy/gdal.h"
#include "scenario/terrain/file_names.h"
#include "scenario/terrain/gdal_messages.h"

namespace emscape::scenario {

/// The file of points or polygons in a file: itself, or the only one in a .zip.
/// @throws Error (bad_input) that names the file: an archive that cannot be read, with none or with several
ElevationSource vectorSourceIn(const std::string& file);

/// A GeoPackage, GeoJSON, shapefile, FlatGeobuf, KML, KMZ, GML, GPX or CSV, or a .zip with one. No other
/// format and none of GDAL's virtual file systems: they read further files, databases and network services.
/// What GDAL reports as unreadable is an error. Use it in the thread and scope that made it, as GdalMessages.
class VectorFile {
 public:
  /// @throws Error (bad_input) that names the file and GDAL's reason
  explicit VectorFile(const std::string& file);

  /// Its own name and those of the files beside it that GDAL reads, such as a shapefile's .dbf and .prj; each
  /// exists. In ascending order.
  std::vector<std::string> files() const;

  /// Of GPX the layers of waypoints, routes and tracks, not those of the points of the last two.
  std::vector<OGRLayerH> layers() const;

  /// Calls visit(feature) for each feature of a layer. GDAL's failures inside visit() are not reported here.
  /// @throws Error (bad_input) that names the file and GDAL's reason; also for a row of a CSV file whose
  /// first column of WKT is not a geometry
  template <class Visit>
  void eachFeature(OGRLayerH layer, const Visit& visit) const {
    OGR_L_ResetReading(layer);
    while (const gdal::Feature feature = next(layer)) visit(feature.get());
  }

 private:
  /// Null at the end.
  gdal::Feature next(OGRLayerH layer) const;
  void requireGeometry(OGRLayerH layer, OGRFeatureH feature) const;

  const std::string file_;
  const GdalMessages messages_;
  MemoryFiles unpacked_;  ///< of a .zip
  const gdal::Dataset dataset_;
};

}  // namespace emscape::scenario
