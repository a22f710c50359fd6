#include "scenario/map/map_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/geodesy/gdal_file.h"
#include "emscape/base/error.h"
#include "scenario/terrain/gdal_messages.h"
#include "scenario/terrain/raster_access.h"
#include "scenario/terrain/transformation.h"

namespace emscape::scenario {
namespace {

constexpr int kMinSide = 512, kMaxSide = 4096;  // pixels of the part that is read

struct Pixel {
  double x, y;
};

/// An open image.
class MapImage {
 public:
  explicit MapImage(const std::string& file) : file_(file) {
    static const char* const kDrivers[] = {"GTiff", "MBTiles", nullptr};
    if (const std::string fault = gdal::faultOfName(file); !fault.empty()) fail(fault);
    if (const std::string fault = Sidecars().faultOf(file); !fault.empty()) fail(fault);
    dataset_ = gdal::openFile(file, GDAL_OF_RASTER, kDrivers);
    if (dataset_ == nullptr) fail("not a GeoTIFF or MBTiles that can be read");
    if (const std::string fault = faultOfDataset(dataset_.get()); !fault.empty()) fail(fault);
    const bool is_placed = GDALGetGeoTransform(dataset_.get(), to_map_.data()) == CE_None;
    const OGRSpatialReferenceH reference = GDALGetSpatialRef(dataset_.get());
    if (!is_placed || reference == nullptr || GDALInvGeoTransform(to_map_.data(), to_pixel_.data()) == 0)
      fail("has no position on the earth");
    const gdal::SpatialReference own(OSRClone(reference));
    OSRSetAxisMappingStrategy(own.get(), OAMS_TRADITIONAL_GIS_ORDER);
    transformation_ = transformationBetween(wgs84Reference(), own);
    checkBands();
  }

  /// Positions in pixels; NaN where there are none.
  std::vector<Pixel> pixelsOf(const std::vector<GeodeticPosition>& positions) const {
    std::vector<double> x, y;
    for (const GeodeticPosition& position : positions) {
      x.push_back(position.longitude_deg);
      y.push_back(position.latitude_deg);
    }
    std::vector<int> succeeded(x.size());
    OCTTransformEx(transformation_.get(), static_cast<int>(x.size()), x.data(), y.data(), nullptr,
                   succeeded.data());
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    std::vector<Pixel> pixels;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const bool is_valid = succeeded[i] != 0;
      pixels.push_back(is_valid ? Pixel{to_pixel_[0] + x[i] * to_pixel_[1] + y[i] * to_pixel_[2],
                                        to_pixel_[3] + x[i] * to_pixel_[4] + y[i] * to_pixel_[5]}
                                : Pixel{kNaN, kNaN});
    }
    return pixels;
  }

  int width() const { return GDALGetRasterXSize(dataset_.get()); }
  int height() const { return GDALGetRasterYSize(dataset_.get()); }

  /// Part of the image as 0xAABBGGRR, resampled to columns x rows.
  MapColors read(int x, int y, int width, int height, int columns, int rows) const {
    const std::size_t pixels = static_cast<std::size_t>(columns) * rows;
    const int bands = GDALGetRasterCount(dataset_.get());
    std::vector<std::vector<std::uint8_t>> channels;
    for (int band = 1; band <= std::min(bands, 4); ++band) {
      GDALRasterBandH source = GDALGetRasterBand(dataset_.get(), band);
      channels.push_back(readBand(source, x, y, width, height, columns, rows));
    }
    GDALRasterBandH first = GDALGetRasterBand(dataset_.get(), 1);
    const std::vector<std::uint8_t> mask =
        readBand(GDALGetMaskBand(first), x, y, width, height, columns, rows);
    const std::vector<GDALColorEntry> palette = paletteOf(first);
    MapColors colors(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
      std::array<unsigned, 4> rgba{channels[0][i], channels[0][i], channels[0][i], mask[i]};
      if (!palette.empty()) {
        const GDALColorEntry entry =
            channels[0][i] < palette.size() ? palette[channels[0][i]] : GDALColorEntry{0, 0, 0, 0};
        rgba = {static_cast<unsigned>(entry.c1), static_cast<unsigned>(entry.c2),
                static_cast<unsigned>(entry.c3),
                static_cast<unsigned>(entry.c4) * static_cast<unsigned>(mask[i]) / 255U};
      } else if (channels.size() >= 3) {
        rgba = {channels[0][i], channels[1][i], channels[2][i],
                channels.size() == 4 ? channels[3][i] : mask[i]};
      } else if (channels.size() == 2) {
        rgba[3] = channels[1][i];
      }
      colors[i] = rgba[3] << 24 | rgba[2] << 16 | rgba[1] << 8 | rgba[0];
    }
    return colors;
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(ErrorCode::bad_input, {file_, 0, 0}, messages_.explain(problem));
  }

 private:
  void checkBands() const {
    const int bands = GDALGetRasterCount(dataset_.get());
    for (int band = 1; band <= bands; ++band) {
      if (GDALGetRasterDataType(GDALGetRasterBand(dataset_.get(), band)) != GDT_Byte)
        fail("has bands of other numbers than 8 bits: an image is expected");
    }
    if (bands < 1 || bands > 4) fail("has other bands than those of an image: 1 to 4 are expected");
  }

  std::vector<std::uint8_t> readBand(GDALRasterBandH band, int x, int y, int width, int height, int columns,
                                     int rows) const {
    std::vector<std::uint8_t> values(static_cast<std::size_t>(columns) * rows);
    if (GDALRasterIO(band, GF_Read, x, y, width, height, values.data(), columns, rows, GDT_Byte, 0, 0) !=
        CE_None)
      fail("cannot be read");
    return values;
  }

  static std::vector<GDALColorEntry> paletteOf(GDALRasterBandH band) {
    std::vector<GDALColorEntry> palette;
    const GDALColorTableH table = GDALGetRasterColorTable(band);
    for (int i = 0; table != nullptr && i < GDALGetColorEntryCount(table); ++i) {
      GDALColorEntry entry{};
      GDALGetColorEntryAsRGB(table, i, &entry);
      palette.push_back(entry);
    }
    return palette;
  }

  const std::string file_;
  const GdalMessages messages_;
  gdal::Dataset dataset_;
  gdal::Transformation transformation_;  ///< from WGS84
  std::array<double, 6> to_map_{}, to_pixel_{};
};

}  // namespace

MapColors readMapColors(const std::string& file, const std::vector<GeodeticPosition>& positions) {
  const MapImage image(file);
  const std::vector<Pixel> pixels = image.pixelsOf(positions);
  // The part of the image that is needed.
  double west = image.width(), east = 0, north = image.height(), south = 0;
  for (const Pixel& pixel : pixels) {
    if (!(pixel.x >= 0 && pixel.x < image.width() && pixel.y >= 0 && pixel.y < image.height())) continue;
    west = std::min(west, pixel.x);
    east = std::max(east, pixel.x);
    north = std::min(north, pixel.y);
    south = std::max(south, pixel.y);
  }
  MapColors colors(positions.size());
  if (!(west <= east && north <= south)) return colors;
  const int x = static_cast<int>(west), y = static_cast<int>(north);
  const int width = std::min(static_cast<int>(east) + 1, image.width()) - x;
  const int height = std::min(static_cast<int>(south) + 1, image.height()) - y;
  // Twice as fine as the positions, were they a square.
  const int side =
      std::clamp(static_cast<int>(2 * std::sqrt(static_cast<double>(positions.size()))), kMinSide, kMaxSide);
  const int read_columns = std::min(width, side), read_rows = std::min(height, side);
  const MapColors read = image.read(x, y, width, height, read_columns, read_rows);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double column = std::floor((pixels[i].x - x) * read_columns / width);
    const double row = std::floor((pixels[i].y - y) * read_rows / height);
    if (!(column >= 0 && column < read_columns && row >= 0 && row < read_rows)) continue;
    colors[i] = read[static_cast<std::size_t>(row) * static_cast<std::size_t>(read_columns) +
                     static_cast<std::size_t>(column)];
  }
  return colors;
}

MapColors landCoverColors(const Terrain* terrain, const std::vector<GeodeticPosition>& positions) {
  const LandCover* const cover = terrain == nullptr ? nullptr : terrain->landCover();
  if (cover == nullptr)
    throw Error(ErrorCode::bad_input,
                fmt::format("'{}' drapes the land cover, but the scenario's terrain has none: "
                            "'terrain: {{land_cover: ...}}' names it",
                            kLandCoverDrape));
  MapColors colors;
  colors.reserve(positions.size());
  for (const GeodeticPosition& position : positions) {
    const int found = cover->classAt(position.latitude_deg, position.longitude_deg);
    colors.push_back(found < 0 ? 0 : cover->classes()[static_cast<std::size_t>(found)].color);
  }
  return colors;
}

MapColors drapeColors(const std::string& name, const Terrain* terrain,
                      const std::vector<GeodeticPosition>& positions) {
  return name == kLandCoverDrape ? landCoverColors(terrain, positions) : readMapColors(name, positions);
}

}  // namespace emscape::scenario
