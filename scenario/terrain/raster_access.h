/// Safe reading of rasters through GDAL: formats, memory, and files that belong to a raster. Also used by the
/// readers of maps.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/geodesy/gdal.h"

namespace emscape::scenario {

/// Opens an elevation file in one of the allowed formats; GDAL's other drivers read databases, network
/// services and application files.
/// @param with_pictures  also PNG, whose colours encode heights
/// @return null if none of the formats fits; GDAL has then reported a failure
gdal::Dataset openElevation(const std::string& file, bool with_pictures = false);
/// The same in GDAL's memory. @param siblings  names of the files beside it, ended by null
gdal::Dataset openElevationInMemory(const std::string& name, const std::vector<const char*>& siblings,
                                    bool with_pictures);
/// Names of the formats, and that of a file that is of none of them; empty if GDAL does not know it either.
std::string elevationFormats();
std::string otherFormatOf(const std::string& file);
/// The same for one of many files of a folder, which GDAL does not list if the format does not need it.
gdal::Dataset openElevationSource(const std::string& file);

/// Finds overviews and masks beside rasters (NAME.ovr, NAME.msk). Lists each folder once.
class Sidecars {
 public:
  /// Reports an overview or mask that is not a GeoTIFF: GDAL reads it with all of its drivers, so that it may
  /// name other files and servers. Empty if there is none.
  std::string faultOf(const std::filesystem::path& raster);

 private:
  struct Listing {
    std::vector<std::string> names;  ///< of overviews and masks
    bool is_complete = true;         ///< false: the folder has too many files to list them
  };
  const Listing& listingOf(const std::filesystem::path& folder);

  std::map<std::filesystem::path, Listing> folders_;
};

/// Reports that an open raster has its overviews in a file of another name, which may be on a server, or that
/// a decoded block of its first band or of its mask takes more than 256 MiB. GDAL holds all blocks that a
/// window touches, and a small file may have large ones: without values they take no room in it. Empty if
/// neither is so.
std::string faultOfDataset(GDALDatasetH dataset);

}  // namespace emscape::scenario
