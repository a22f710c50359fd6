/// An elevation file behind TerrainFile: how it is opened, and what its head says.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "base/geodesy/gdal_file.h"
#include "scenario/terrain/file.h"
#include "scenario/terrain/georeference.h"
#include "scenario/terrain/raster_access.h"

namespace emscape::scenario {

struct TerrainFile::Impl : TerrainFileHead {
  ElevationSource source;
  double scale = 1.0, offset = 0.0;
  int band = 1;
  std::optional<Georeference> georeference;
  bool is_16_bits = false, is_real = false;  ///< type of the band; is_real: of 32 bits
  bool is_ellipsoidal = false;               ///< as its netCDF variable states
  std::string band_warning;                  ///< of bands with names
  std::string depth_name;                    ///< long name of a netCDF variable that speaks of depth
  bool is_tile = false;                      ///< an HGT that GDAL does not read by itself
  mutable std::unique_ptr<MemoryFiles> unpacked;
  mutable std::string unpacked_name;

  [[noreturn]] void fail(const std::string& problem) const {
    const std::string file = (keys.has_classes ? "land cover file " : "elevation file ") + name + ": ";
    throw Error(ErrorCode::bad_input, location, problem.rfind(file, 0) == 0 ? problem : file + problem);
  }
  /// Errors of what a function finds become those of the file.
  template <class Find>
  auto found(const Find& find) const {
    try {
      return find();
    } catch (const Error& error) {
      if (!error.location().file.empty()) throw;
      fail(error.message());
    }
  }

  std::set<std::filesystem::path> checkedSources() const;  ///< none if the file is not a VRT
  gdal::Dataset open() const;                              ///< after checkedSources()
  bool isInMemory() const { return !source.member.empty() || is_tile; }
  void unpack() const;
  std::string tileInMemory(MemoryFiles& files, std::string bytes) const;
  void checkDatasets(GDALDatasetH dataset, const std::set<std::filesystem::path>& sources) const;
  void readHead();  ///< file_head.cpp
  void readBand(GDALDatasetH dataset);
  void readMeaningOfNetcdf(GDALRasterBandH of_heights);
  void requireClasses(GDALRasterBandH band_of_codes) const;
  void placePosts(GDALDatasetH dataset);  ///< file_posts.cpp
};

/// Posts per axis of an HGT of a number of bytes; 0 if it is not square.
int tilePosts(std::uintmax_t bytes);

}  // namespace emscape::scenario
