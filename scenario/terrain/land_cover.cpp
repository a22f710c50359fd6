#include "emscape/scenario/terrain/land_cover.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "emscape/base/units.h"
#include "scenario/terrain/georeference.h"
#include "scenario/terrain/place.h"
#include "scenario/terrain/view.h"

namespace emscape::scenario {
namespace {

constexpr double kMaxCells = 1 << 26;
constexpr int kMaxCode = 65535;
constexpr std::uint16_t kNoCode = kMaxCode;
constexpr std::uint8_t kUnlisted = LandCoverView::kNoClass - 1;  ///< a code that the table lacks
constexpr double kMetresPerDegreeOfCover = 111132;

/// Extents of a cell in the middle of a file (deg).
struct CoverCellSize {
  double latitude_deg = 0, longitude_deg = 0;
};
CoverCellSize cellSizeOf(const TerrainFile& file) {
  const PostLattice& lattice = file.georeference().lattice;
  const double column = 0.5 * (file.head().columns - 1), row = 0.5 * (file.head().rows - 1);
  std::vector<double> x{lattice.x(column - 0.5), lattice.x(column + 0.5), lattice.x(column),
                        lattice.x(column)};
  std::vector<double> y{lattice.y(row), lattice.y(row), lattice.y(row - 0.5), lattice.y(row + 0.5)};
  file.georeference().toGeographic(x, y);
  return {std::hypot(y[3] - y[2], y[1] - y[0]),
          std::hypot(wrapLongitude_deg(x[1] - x[0]), wrapLongitude_deg(x[3] - x[2]))};
}

/// Every n-th code of a part of a file.
struct Codes {
  RasterTile tile;
  int every = 1;
  int columns = 0, rows = 0;
  std::vector<std::uint16_t> codes;

  /// @param cell_m  of the result, in cells of the file
  Codes(RasterTile of, double cells_of_file) : tile(std::move(of)) {
    every = std::max(1, static_cast<int>(cells_of_file));
    columns = static_cast<int>((tile.window.columns + every - 1) / every);
    rows = static_cast<int>((tile.window.rows + every - 1) / every);
    codes.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), kNoCode);
    tile.file->read(tile.window, [&](long long row, const float* values) {
      if (row % every != 0) return;
      std::uint16_t* const to = codes.data() + static_cast<std::size_t>(row / every) * columns;
      for (int i = 0; i < columns; ++i) {
        const float value = values[static_cast<std::ptrdiff_t>(i) * every];
        if (value >= 0 && value < kMaxCode) to[i] = static_cast<std::uint16_t>(value);
      }
    });
  }

  /// The code at a position of the plane.
  std::uint16_t at(double x, double y) const {
    const double column = std::floor(tile.lattice.column(x) + 0.5) - tile.window.first_column;
    const double row = std::floor(tile.lattice.row(y) + 0.5) - tile.window.first_row;
    if (!(column >= 0 && column < tile.window.columns && row >= 0 && row < tile.window.rows)) return kNoCode;
    return codes[static_cast<std::size_t>(row) / every * columns + static_cast<std::size_t>(column) / every];
  }
};

}  // namespace

struct LandCover::Impl {
  std::vector<CoverClass> classes;
  std::vector<CoverValues> values;
  std::vector<std::uint8_t> cells;
  LandCoverView view;
  std::vector<long long> counts;
  long long unknown = 0;
  double cell_m = 0;
  std::vector<std::string> warnings;

  std::vector<RasterTile> tiles;  ///< empty after reading
  std::string first_file;

  void findTiles(const LandCoverSpec& spec, const GeoBox& box);
  void placeCells(const GeoBox& box);
  void fill(const RasterTile& tile, const std::vector<std::uint8_t>& index_of,
            std::map<int, long long>& other);
  void report(const LandCoverSpec& spec, const std::map<int, long long>& other);
};

void LandCover::Impl::findTiles(const LandCoverSpec& spec, const GeoBox& box) {
  TerrainSpec names;
  names.files = spec.files;
  names.locations = spec.locations;
  TerrainFileKeys keys;
  keys.has_classes = true;
  for (std::size_t k = 0; k < spec.files.size(); ++k) {
    const SourceLocation location = k < spec.locations.size() ? spec.locations[k] : SourceLocation{};
    for (const ElevationSource& source : sourcesOf(names, k)) {
      const auto file = std::make_shared<const TerrainFile>(source, location, keys);
      for (RasterTile& tile : tilesWithin(file, box)) tiles.push_back(std::move(tile));
    }
  }
}

/// A raster over the box with the smallest cells of the files, thinned by whole numbers if it were too large.
void LandCover::Impl::placeCells(const GeoBox& box) {
  CoverCellSize size{HUGE_VAL, HUGE_VAL};
  for (const RasterTile& tile : tiles) {
    const CoverCellSize of_file = cellSizeOf(*tile.file);
    size.latitude_deg = std::fmin(size.latitude_deg, of_file.latitude_deg);
    size.longitude_deg = std::fmin(size.longitude_deg, of_file.longitude_deg);
  }
  const double height_deg = box.north_deg - box.south_deg, width_deg = box.east_deg - box.west_deg;
  const auto cellsOf = [&](double thinning) {
    return (height_deg / size.latitude_deg / thinning + 2) * (width_deg / size.longitude_deg / thinning + 2);
  };
  double thinning = 1;
  while (cellsOf(thinning) > kMaxCells) ++thinning;
  if (thinning > 1)
    warnings.push_back(
        fmt::format("land cover: the area takes more than {:.0f} million cells of {:.3g} m: "
                    "every {:g}th is read in each direction",
                    kMaxCells / 1e6, size.latitude_deg * kMetresPerDegreeOfCover, thinning));
  size.latitude_deg *= thinning;
  size.longitude_deg *= thinning;
  // The cells of the first file, if it has longitudes and latitudes.
  const PostLattice& lattice = tiles.front().lattice;
  const bool is_aligned = tiles.front().file->georeference().is_geographic;
  const double x0 = is_aligned ? lattice.x(-0.5) : box.west_deg;
  const double y0 = is_aligned ? lattice.y(-0.5) : box.south_deg;
  const double west = std::floor((box.west_deg - x0) / size.longitude_deg);
  const double south = std::floor((box.south_deg - y0) / size.latitude_deg);
  view.columns = static_cast<int>(std::floor((box.east_deg - x0) / size.longitude_deg) - west) + 1;
  view.rows = static_cast<int>(std::floor((box.north_deg - y0) / size.latitude_deg) - south) + 1;
  view.west_rad = degToRad(x0 + west * size.longitude_deg);
  view.south_rad = degToRad(y0 + south * size.latitude_deg);
  view.cells_per_rad_lon = 1 / degToRad(size.longitude_deg);
  view.cells_per_rad_lat = 1 / degToRad(size.latitude_deg);
  cell_m = size.latitude_deg * kMetresPerDegreeOfCover;
  cells.assign(static_cast<std::size_t>(view.columns) * static_cast<std::size_t>(view.rows),
               LandCoverView::kNoClass);
}

/// Sets the cells of a tile that have no class yet.
void LandCover::Impl::fill(const RasterTile& tile, const std::vector<std::uint8_t>& index_of,
                           std::map<int, long long>& other) {
  const double of_file_deg = cellSizeOf(*tile.file).latitude_deg;
  const Codes codes(tile, radToDeg(1 / view.cells_per_rad_lat) / of_file_deg + 1e-6);
  std::vector<double> x(static_cast<std::size_t>(view.columns)), y(x.size());
  for (int row = 0; row < view.rows; ++row) {
    for (int column = 0; column < view.columns; ++column) {
      x[column] = radToDeg(view.west_rad + (column + 0.5) / view.cells_per_rad_lon);
      y[column] = std::clamp(radToDeg(view.south_rad + (row + 0.5) / view.cells_per_rad_lat), -90.0, 90.0);
    }
    if (!tile.file->georeference().is_geographic) tile.file->georeference().lineToPlane(x, y);
    std::uint8_t* const to = cells.data() + static_cast<std::size_t>(row) * view.columns;
    for (int column = 0; column < view.columns; ++column) {
      if (to[column] != LandCoverView::kNoClass) continue;
      const std::uint16_t code = codes.at(x[column], y[column]);
      if (code == kNoCode) continue;
      to[column] = index_of[code];
      if (to[column] == kUnlisted) ++other[code];
    }
  }
}

void LandCover::Impl::report(const LandCoverSpec& spec, const std::map<int, long long>& other) {
  constexpr std::size_t kMaxNamed = 8;
  counts.assign(classes.size(), 0);
  for (const std::uint8_t cell : cells) {
    if (cell < classes.size()) {
      ++counts[cell];
    } else {
      ++unknown;
    }
  }
  std::vector<std::string> named;
  for (const auto& [code, count] : other) {
    if (named.size() == kMaxNamed) break;
    named.push_back(fmt::format("{} ({} cell{})", code, count, count == 1 ? "" : "s"));
  }
  std::string text = fmt::format("{}", fmt::join(named, ", "));
  if (other.size() > kMaxNamed) text += fmt::format(" and {} more", other.size() - kMaxNamed);
  const std::string table =
      spec.table.empty() ? fmt::format("the table '{}'", toString(spec.classes)) : "the table " + spec.table;
  const auto all = static_cast<long long>(cells.size());
  if (unknown == all && !other.empty()) {
    throw Error(
        ErrorCode::bad_input, spec.locations.empty() ? SourceLocation{} : spec.locations.front(),
        fmt::format("land cover: no code of the files within the area is in {}: {}. 'classes' names "
                    "the product (worldcover, corine, nlcd); 'table: FILE.csv' in its place names a table "
                    "of your own",
                    table, text));
  }
  if (!other.empty())
    warnings.push_back(
        fmt::format("land cover: codes that {} does not have, which leave the ground without a "
                    "class: {}; a table of your own names them: 'table: FILE.csv' in place of 'classes'",
                    table, text));
  long long unlisted = 0;
  for (const auto& [code, count] : other) unlisted += count;
  if (unknown > unlisted)
    warnings.push_back(fmt::format(
        "land cover: {:.3g} % of the area has no class in the files: there the heights tell the sea, and "
        "clutter heights and kinds of land are those of the emitters' sections",
        100.0 * static_cast<double>(unknown - unlisted) / static_cast<double>(all)));
}

LandCover::LandCover(const LandCoverSpec& spec, const GeoBox& box) : impl_(std::make_unique<Impl>()) {
  Impl& cover = *impl_;
  cover.classes = spec.table.empty() ? coverTable(spec.classes) : readCoverTable(spec.table);
  std::vector<std::uint8_t> index_of(kMaxCode + 1, kUnlisted);
  for (std::size_t k = 0; k < cover.classes.size(); ++k) {
    const CoverClass& of = cover.classes[k];
    index_of[static_cast<std::size_t>(of.code)] = static_cast<std::uint8_t>(k);
    cover.values.push_back(
        {true, static_cast<float>(of.clutter_height_m), of.zone, of.kind ? static_cast<int>(*of.kind) : -1});
  }
  cover.findTiles(spec, box);
  if (cover.tiles.empty()) {
    cover.counts.assign(cover.classes.size(), 0);
    cover.warnings.push_back("land cover: no file of 'land_cover' reaches the area: it has no effect");
    return;
  }
  cover.placeCells(box);
  std::map<int, long long> other;
  for (const RasterTile& tile : cover.tiles) {
    cover.fill(tile, index_of, other);
    tile.file->release();
  }
  cover.tiles.clear();
  cover.report(spec, other);
  // Elevation posts are often at the edges of cells: rounding would decide on the class there.
  constexpr double kShift_m = 0.05, kEarth_m = 6371e3;
  cover.view.south_rad -= kShift_m / kEarth_m;
  cover.view.west_rad -= kShift_m / kEarth_m;
  cover.view.cells = cover.cells.data();
  cover.view.classes = cover.values.data();
  cover.view.class_count = static_cast<int>(cover.values.size());
}
LandCover::~LandCover() = default;

const std::vector<CoverClass>& LandCover::classes() const {
  return impl_->classes;
}
const std::vector<long long>& LandCover::cellCounts() const {
  return impl_->counts;
}
long long LandCover::unknownCells() const {
  return impl_->unknown;
}
double LandCover::cell_m() const {
  return impl_->cell_m;
}
int LandCover::classAt(double latitude_deg, double longitude_deg) const {
  return impl_->view.isSet() ? impl_->view.classAt(degToRad(latitude_deg), degToRad(longitude_deg)) : -1;
}
LandCoverView LandCover::view() const {
  return impl_->view;
}
const std::vector<std::string>& LandCover::warnings() const {
  return impl_->warnings;
}

}  // namespace emscape::scenario
