// Descriptions of elevation files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "emscape/scenario/terrain/terrain.h"
#include "scenario/terrain/file_notes.h"
#include "scenario/terrain/georeference.h"
#include "scenario/terrain/place.h"

namespace emscape::scenario {
namespace {

bool meet(const GeoBox& a, const GeoBox& b) {
  if (a.south_deg > b.north_deg || a.north_deg < b.south_deg) return false;
  const double turns = std::ceil((b.west_deg - a.east_deg) / 360);
  return a.west_deg + 360 * turns <= b.east_deg;
}

/// Reads all heights of a file, or of a very large one a part: kStrips strips of rows from the first to the
/// last.
void surveyHeights(const TerrainFile& file, TerrainFileInfo& info) {
  constexpr long long kMaxPosts = 1LL << 28;
  constexpr int kStrips = 64;
  const long long rows = file.head().rows, columns = file.head().columns;
  const bool is_partial = rows * columns > kMaxPosts;
  const int strips = is_partial ? kStrips : 1;
  bool is_noted = false;
  HeightTally tally;
  FillValues::Result all_found;
  const long long rows_of_strip = is_partial ? std::max(1LL, kMaxPosts / columns / kStrips) : rows;
  for (int strip = 0; strip < strips; ++strip) {
    const long long first_row = strip == 0 ? 0 : (rows - rows_of_strip) * strip / (strips - 1);
    FillValues fills(columns, file.head().meaning.unit_m);
    tally.add(file.read({0, first_row, columns, rows_of_strip}, [&](long long, const float* heights_m) {
      fills.add(heights_m);
      int voids = 0;
      float lowest_m = HUGE_VALF, highest_m = -HUGE_VALF;
      for (long long column = 0; column < columns; ++column) {
        const float height_m = heights_m[column];  // NaN is neither smaller nor larger
        lowest_m = height_m < lowest_m && height_m >= FillValues::kBelow_m ? height_m : lowest_m;
        highest_m = height_m > highest_m && height_m >= FillValues::kBelow_m ? height_m : highest_m;
        voids += std::isnan(height_m) ? 1 : 0;
      }
      info.void_posts += voids;
      if (lowest_m > highest_m) return;
      info.lowest_m = std::fmin(info.lowest_m, lowest_m);
      info.highest_m = std::fmax(info.highest_m, highest_m);
    }));
    // Heights that may be fill values count once they are known not to be.
    const FillValues::Result found = fills.result();
    if (found.is_partial && !is_noted) info.warnings.emplace_back(kPartlySearched);
    is_noted = is_noted || found.is_partial;
    for (const FillValues::Found& fill : found.fills) {
      info.warnings.push_back(fillText(fill));
      info.void_posts += fill.posts;
    }
    all_found.low_posts += found.low_posts;
    all_found.lowest_m = std::min(all_found.lowest_m, found.lowest_m);
    if (found.lowest_m <= found.highest_m) {
      info.lowest_m = std::fmin(info.lowest_m, found.lowest_m);
      info.highest_m = std::fmax(info.highest_m, found.highest_m);
    }
  }
  for (const Implausibility& remark : implausibilitiesOf(file, tally, all_found))
    info.warnings.push_back(remark.text);
  if (is_partial) {
    info.notes.push_back("is large: its range and voids are those of " +
                         std::to_string(strips * rows_of_strip) + " of its " + std::to_string(rows) +
                         " rows");
  }
}

TerrainFileInfo infoOf(const ElevationSource& source, const SourceLocation& location,
                       const TerrainFileKeys& keys, const GeoBox* needed) {
  const TerrainFile file(source, location, keys);
  TerrainFileInfo info;
  info.file = source.name();
  info.vertical_datum = file.head().meaning.datum_text;
  info.height_unit = file.head().meaning.unit;
  info.format = file.head().format;
  info.crs = file.crs();
  info.box = geographicBoxOf(file);
  info.columns = file.head().columns;
  info.rows = file.head().rows;
  info.pixel_is_area = file.georeference().is_area;
  info.notes.insert(info.notes.end(), file.head().notes.begin(), file.head().notes.end());
  const Assumption assumed = assumptionOf(file);
  if (!assumed.text.empty()) info.warnings.push_back(assumed.text + assumed.effect);
  info.warnings.insert(info.warnings.end(), file.head().meaning.warnings.begin(),
                       file.head().meaning.warnings.end());
  const double column = 0.5 * (file.head().columns - 1), row = 0.5 * (file.head().rows - 1);
  const PostLattice& lattice = file.georeference().lattice;
  std::vector<double> x{lattice.x(column - 0.5), lattice.x(column + 0.5), lattice.x(column),
                        lattice.x(column)};
  std::vector<double> y{lattice.y(row), lattice.y(row), lattice.y(row - 0.5), lattice.y(row + 0.5)};
  file.georeference().toGeographic(x, y);
  if (!std::isfinite(x[2]) || !std::isfinite(y[2]))
    throw Error(ErrorCode::bad_input, "elevation file " + info.file + ": its posts are not on the earth");
  info.post_spacing_lon_deg = std::abs(wrapLongitude_deg(x[1] - x[0]));
  info.post_spacing_lat_deg = std::abs(y[3] - y[2]);
  info.lowest_m = info.highest_m = std::numeric_limits<double>::quiet_NaN();
  info.is_needed = needed == nullptr || meet(info.box, *needed);
  if (info.is_needed) surveyHeights(file, info);
  return info;
}

}  // namespace

TerrainFileInfo Terrain::describe(const std::string& name, bool read_heights, const TerrainFileKeys& keys) {
  const std::vector<ElevationSource> sources = sourcesIn(name);
  const GeoBox nowhere{100, 100, 0, 0};
  TerrainFileInfo info = infoOf(sources.front(), {}, keys, read_heights ? nullptr : &nowhere);
  info.file = name;
  if (sources.size() > 1)
    info.notes.push_back(
        fmt::format("has {} elevation files: this is {}", sources.size(), sources.front().member));
  return info;
}

std::vector<TerrainFileInfo> Terrain::describeAll(const TerrainSpec& spec, const GeoBox* needed) {
  std::vector<TerrainFileInfo> all;
  for (std::size_t k = 0; k < spec.files.size(); ++k) {
    const SourceLocation location = k < spec.locations.size() ? spec.locations[k] : SourceLocation{};
    for (const ElevationSource& source : sourcesOf(spec, k))
      all.push_back(infoOf(source, location, keysOf(spec, k), needed));
  }
  return all;
}

}  // namespace emscape::scenario
