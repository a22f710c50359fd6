#include "scenario/terrain/file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/files/file_reading.h"
#include "emscape/base/work.h"
#include "scenario/terrain/file_impl.h"
#include "scenario/terrain/file_remedies.h"
#include "scenario/terrain/gdal_messages.h"
#include "scenario/terrain/vrt.h"

namespace emscape::scenario {
namespace {

namespace fs = std::filesystem;

/// Values that mean void in HGT and DTED whatever a file's header says.
constexpr float kVoidValues[] = {-32767.0f, -32768.0f};
constexpr long long kStripPosts = 1 << 21;
constexpr int kRowsPerSample = 4;  ///< rows whose steps are looked at: one of these

/// The band of opacity, which GDAL takes as a mask of whole numbers only; null: there is none.
GDALRasterBandH alphaBandOf(GDALDatasetH dataset) {
  for (int n = GDALGetRasterCount(dataset); n > 1; --n) {
    GDALRasterBandH band = GDALGetRasterBand(dataset, n);
    if (GDALGetRasterColorInterpretation(band) == GCI_AlphaBand) return band;
  }
  return nullptr;
}

/// The height in a colour.
double decoded(HeightEncoding encoding, float red, float green, float blue) {
  const double r = static_cast<double>(red), g = static_cast<double>(green), b = static_cast<double>(blue);
  return encoding == HeightEncoding::terrarium ? r * 256 + g + b / 256 - 32768
                                               : -10000 + (r * 65536 + g * 256 + b) * 0.1;
}

}  // namespace

std::set<fs::path> TerrainFile::Impl::checkedSources() const {
  if (isInMemory()) return {};
  return found([&] { return sourcesOfVrt(name); });
}

/// The bytes of an HGT as a raster that GDAL reads.
std::string TerrainFile::Impl::tileInMemory(MemoryFiles& files, std::string bytes) const {
  const std::optional<TileCorner> corner = cornerInName(source.ownName());
  const int posts = tilePosts(bytes.size());
  if (const std::string foreign = foreignContent(bytes); !foreign.empty()) fail(foreign);
  if (posts == 0) {
    fail(fmt::format(
        "has {} bytes, which is no square of posts of 2 bytes as an HGT tile has (1201, 3601, 7201 or "
        "10801 posts a side); it may be cut off or of another format",
        bytes.size()));
  }
  if (!corner) fail(remedyForTileWithoutPosition());
  const double step_deg = 1.0 / (posts - 1);
  files.add("tile.hdr",
            fmt::format("NROWS {0}\nNCOLS {0}\nNBANDS 1\nNBITS 16\nPIXELTYPE SIGNEDINT\nBYTEORDER M\n"
                        "LAYOUT BIL\nULXMAP {1}\nULYMAP {2}\nXDIM {3:.17g}\nYDIM {3:.17g}\nNODATA -32768\n",
                        posts, corner->longitude_deg, corner->latitude_deg + 1, step_deg));
  files.add("tile.prj",
            "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],"
            "PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]]");
  return files.add("tile.bil", std::move(bytes));
}

void TerrainFile::Impl::unpack() const {
  if (unpacked) return;
  found([&] {
    auto files = std::make_unique<MemoryFiles>();
    if (is_tile) {
      unpacked_name =
          tileInMemory(*files, source.member.empty() ? readWholeText(source.file) : unpackedContent(source));
    } else {
      unpacked_name = files->unpack(source);
    }
    unpacked = std::move(files);
  });
}

gdal::Dataset TerrainFile::Impl::open() const {
  if (const std::string fault = gdal::faultOfName(source.file); !fault.empty()) fail(fault);
  const GdalMessages messages;
  const bool is_picture = keys.encoding.has_value();
  gdal::Dataset dataset;
  if (isInMemory()) {
    unpack();
    dataset = openElevationInMemory(unpacked_name, unpacked->siblings(), is_picture);
  } else {
    dataset = openElevation(name, is_picture);
  }
  if (!dataset) fail(messages.explain(faultOfUnreadable(source, is_picture)));
  return dataset;
}

void TerrainFile::Impl::checkDatasets(GDALDatasetH dataset, const std::set<fs::path>& sources) const {
  const std::string fault = faultOfDataset(dataset);
  if (!fault.empty()) fail(fault);
  std::error_code ignored;
  for (const fs::path& file : sources) {
    if (!fs::exists(file, ignored)) continue;  // GDAL reports it if its heights are read
    const GdalMessages messages;
    const gdal::Dataset opened = openElevationSource(file);
    const std::string fault_of_source =
        opened ? faultOfDataset(opened.get()) : messages.explain("cannot be read as an elevation file");
    if (!fault_of_source.empty()) fail("source " + file.string() + ": " + fault_of_source);
  }
}

TerrainFile::TerrainFile(const ElevationSource& source, const SourceLocation& location,
                         const TerrainFileKeys& keys)
    : impl_(std::make_unique<Impl>()) {
  impl_->name = source.name();
  impl_->source = source;
  impl_->location = location;
  impl_->keys = keys;
  impl_->readHead();
}
TerrainFile::~TerrainFile() = default;

const TerrainFileHead& TerrainFile::head() const {
  return *impl_;
}
const Georeference& TerrainFile::georeference() const {
  return *impl_->georeference;
}
std::string TerrainFile::crs() const {
  OGRSpatialReferenceH system = impl_->georeference->system();
  const char* authority = OSRGetAuthorityName(system, nullptr);
  const char* code = OSRGetAuthorityCode(system, nullptr);
  std::string text = OSRGetName(system);
  if (authority && code) text += std::string(" (") + authority + ":" + code + ")";
  return text;
}
void TerrainFile::release() const {
  impl_->unpacked.reset();
}

HeightTally TerrainFile::read(const PostWindow& window, const RowSink& take) const {
  const Georeference& georeference = *impl_->georeference;
  const GdalMessages messages;  // constructed before the dataset, whose destructor may report errors
  impl_->checkedSources();
  const gdal::Dataset dataset = impl_->open();
  GDALRasterBandH band = GDALGetRasterBand(dataset.get(), impl_->band);
  const bool swaps = impl_->keys.swap_bytes;
  int has_void_value = 0;
  const double void_value = GDALGetRasterNoDataValue(band, &has_void_value);
  // GDAL's mask is of the values before their bytes are exchanged.
  GDALRasterBandH mask_band =
      (GDALGetMaskFlags(band) & GMF_ALL_VALID) == 0 && !swaps ? GDALGetMaskBand(band) : nullptr;
  if (mask_band == nullptr) mask_band = alphaBandOf(dataset.get());
  HeightTally tally;
  const int columns = static_cast<int>(window.columns);
  const int left = static_cast<int>(window.first_column);
  const long long strip_rows = std::max(1LL, kStripPosts / std::max(1LL, window.columns));
  std::vector<float> strip;
  std::vector<GByte> mask;
  std::vector<std::uint8_t> is_known;
  for (long long begin = 0; begin < window.rows; begin += strip_rows) {
    checkpoint();
    const int rows = static_cast<int>(std::min(strip_rows, window.rows - begin));
    const long long south = window.first_row + begin;
    const int top = static_cast<int>(georeference.north_first ? impl_->rows - south - rows : south);
    strip.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    mask.assign(strip.size(), 255);
    if (GDALRasterIO(band, GF_Read, left, top, columns, rows, strip.data(), columns, rows, GDT_Float32, 0,
                     0) != CE_None ||
        (mask_band != nullptr && GDALRasterIO(mask_band, GF_Read, left, top, columns, rows, mask.data(),
                                              columns, rows, GDT_Byte, 0, 0) != CE_None)) {
      impl_->fail(messages.explain("rows " + std::to_string(top) + " to " + std::to_string(top + rows - 1) +
                                   " cannot be read"));
    }
    if (impl_->keys.encoding) {
      std::vector<float> green(strip.size()), blue(strip.size());
      for (auto [next, values] : {std::pair{1, &green}, std::pair{2, &blue}}) {
        if (GDALRasterIO(GDALGetRasterBand(dataset.get(), impl_->band + next), GF_Read, left, top, columns,
                         rows, values->data(), columns, rows, GDT_Float32, 0, 0) != CE_None)
          impl_->fail(messages.explain("rows " + std::to_string(top) + " cannot be read"));
      }
      for (std::size_t k = 0; k < strip.size(); ++k)
        strip[k] = static_cast<float>(decoded(*impl_->keys.encoding, strip[k], green[k], blue[k]));
    }
    is_known.assign(strip.size(), 1);
    for (std::size_t k = 0; k < strip.size(); ++k) {
      if (swaps) {
        strip[k] = impl_->is_real ? withSwappedBytesOfReal(strip[k]) : withSwappedBytes(strip[k]);
        if (has_void_value != 0 && static_cast<double>(strip[k]) == void_value) mask[k] = 0;
      }
      is_known[k] =
          mask[k] != 0 && strip[k] != kVoidValues[0] && strip[k] != kVoidValues[1] && std::isfinite(strip[k]);
    }
    for (int row = 0; impl_->is_16_bits && row < rows; row += kRowsPerSample)
      tally.addSteps(strip, is_known, static_cast<std::size_t>(row) * static_cast<std::size_t>(columns),
                     static_cast<std::size_t>(columns));
    for (std::size_t k = 0; impl_->is_real && k < strip.size(); ++k) {
      if (is_known[k] != 0) tally.addReal(strip[k]);
    }
    for (std::size_t k = 0; k < strip.size(); ++k) {
      const double height_m = (strip[k] * impl_->scale + impl_->offset) * impl_->meaning.unit_m;
      strip[k] = is_known[k] != 0 && tally.add(height_m) ? static_cast<float>(height_m)
                                                         : std::numeric_limits<float>::quiet_NaN();
    }
    for (int row = 0; row < rows; ++row) {
      const int row_of_file = georeference.north_first ? rows - 1 - row : row;
      take(begin + row, strip.data() + static_cast<std::ptrdiff_t>(row_of_file) * columns);
    }
  }
  return tally;
}

}  // namespace emscape::scenario
