#include "scenario/terrain/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/memory.h"
#include "emscape/base/units.h"
#include "scenario/terrain/georeference.h"

namespace emscape::scenario {
namespace {

/// Two posts are the same if they are this close (posts).
constexpr double kSamePost_posts = 0.01;
constexpr float kNoHeight = std::numeric_limits<float>::quiet_NaN();

/// A tile on the lattice of its group, half open: columns begin..end of that lattice.
struct PlacedTile {
  const RasterTile* tile;
  long long column_begin, column_end, row_begin, row_end;
};

/// Tiles that touch each other, and their common window.
struct Patch {
  std::vector<PlacedTile> tiles;  ///< in the order in which the files were named
  long long column_begin, column_end, row_begin, row_end;
};

struct LatticeGroup {
  PostLattice lattice;
  std::string plane;
  VerticalDatum datum;
  std::vector<PlacedTile> tiles;
};

/// True if the first and last of `count` posts from `first` coincide with posts of the other lattice at the
/// same distance.
bool coincide(double first, double last, int count) {
  return std::abs(first - std::round(first)) < kSamePost_posts &&
         std::abs(last - std::round(last)) < kSamePost_posts &&
         std::llround(last) - std::llround(first) == count - 1;
}

bool fits(const RasterTile& tile, const LatticeGroup& group) {
  const int columns = tile.file->head().columns, rows = tile.file->head().rows;
  const PostLattice& own = tile.lattice;
  return tile.file->georeference().plane_name == group.plane &&
         tile.file->head().meaning.datum == group.datum &&
         coincide(group.lattice.column(own.x(0)), group.lattice.column(own.x(columns - 1)), columns) &&
         coincide(group.lattice.row(own.y(0)), group.lattice.row(own.y(rows - 1)), rows);
}

std::vector<LatticeGroup> groupByLattice(const std::vector<RasterTile>& tiles) {
  std::vector<LatticeGroup> groups;
  for (const RasterTile& tile : tiles) {
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const LatticeGroup& candidate) { return fits(tile, candidate); });
    if (group == groups.end()) {
      groups.push_back(
          {tile.lattice, tile.file->georeference().plane_name, tile.file->head().meaning.datum, {}});
      group = groups.end() - 1;
    }
    const PostWindow& window = tile.window;
    const long long column =
        std::llround(group->lattice.column(tile.lattice.x(static_cast<double>(window.first_column))));
    const long long row =
        std::llround(group->lattice.row(tile.lattice.y(static_cast<double>(window.first_row))));
    group->tiles.push_back({&tile, column, column + window.columns, row, row + window.rows});
  }
  return groups;
}

bool touch(const Patch& a, const Patch& b) {
  return a.column_begin <= b.column_end && b.column_begin <= a.column_end && a.row_begin <= b.row_end &&
         b.row_begin <= a.row_end;
}

/// Joins adjacent tiles; distant tiles must not become one sheet that is mostly empty.
std::vector<Patch> joinTouching(const std::vector<PlacedTile>& tiles) {
  std::vector<Patch> patches;
  for (const PlacedTile& tile : tiles) {
    Patch joined{{tile}, tile.column_begin, tile.column_end, tile.row_begin, tile.row_end};
    for (std::size_t k = 0; k < patches.size();) {
      if (!touch(joined, patches[k])) {
        ++k;
        continue;
      }
      const Patch other = std::move(patches[k]);
      patches.erase(patches.begin() + static_cast<std::ptrdiff_t>(k));
      joined.tiles.insert(joined.tiles.end(), other.tiles.begin(), other.tiles.end());
      joined.column_begin = std::min(joined.column_begin, other.column_begin);
      joined.column_end = std::max(joined.column_end, other.column_end);
      joined.row_begin = std::min(joined.row_begin, other.row_begin);
      joined.row_end = std::max(joined.row_end, other.row_end);
      k = 0;  // the larger patch may touch further tiles
    }
    patches.push_back(std::move(joined));
  }
  for (Patch& patch : patches) {
    std::sort(patch.tiles.begin(), patch.tiles.end(),
              [](const PlacedTile& a, const PlacedTile& b) { return a.tile < b.tile; });
  }
  return patches;
}

/// Distances (m) between neighbouring posts in the middle of a sheet.
void measureSpacing(TerrainSheet& sheet) {
  const int column = sheet.columns / 2, row = sheet.rows / 2;
  std::vector<double> x{sheet.lattice.x(column), sheet.lattice.x(column - 1), sheet.lattice.x(column)};
  std::vector<double> y{sheet.lattice.y(row), sheet.lattice.y(row), sheet.lattice.y(row - 1)};
  sheet.file->georeference().toGeographic(x, y);
  const double across_m = geodesicInverse(y[0], x[0], y[1], x[1]).distance_m;
  const double along_m = geodesicInverse(y[0], x[0], y[2], x[2]).distance_m;
  sheet.spacing_m = std::sqrt(across_m * along_m);
  if (!(sheet.spacing_m > 0.0)) {
    throw Error(ErrorCode::bad_input,
                "elevation file " + sheet.file->head().name + ": its posts are not on the earth");
  }
  sheet.finest_m = std::max(std::min(across_m, along_m), 0.5 * std::max(across_m, along_m));
}

/// Counts the posts of a file that files named before it have, too.
struct CommonPosts {
  long long posts = 0;
  double difference_sum_m = 0;

  void add(float used_m, float other_m) {
    ++posts;
    difference_sum_m += static_cast<double>(std::abs(used_m - other_m));
  }
  /// What is said of it; empty: the heights agree, or only edges are common.
  std::string text(long long posts_of_file) const {
    constexpr double kMinShare = 0.05, kMinDifference_m = 30;
    const auto count = static_cast<double>(posts);
    if (count < kMinShare * static_cast<double>(posts_of_file) || difference_sum_m < kMinDifference_m * count)
      return "";
    return fmt::format(
        "its heights differ by {:.0f} m on average from those of files named before it, which are used at "
        "its "
        "{} posts that they have, too. One of them may be no heights: a pattern, such as FOLDER/*_dem.tif, "
        "leaves files out",
        difference_sum_m / count, posts);
  }
};

TerrainSheet readPatch(const Patch& patch, const PostLattice& lattice) {
  PostLattice own = lattice;
  own.x0 = lattice.x(static_cast<double>(patch.column_begin - 1));
  own.y0 = lattice.y(static_cast<double>(patch.row_begin - 1));
  TerrainSheet sheet(patch.tiles.front().tile->file, own, patch.column_end - patch.column_begin + 2,
                     patch.row_end - patch.row_begin + 2);
  for (const PlacedTile& placed : patch.tiles) {
    const TerrainFile& file = *placed.tile->file;
    sheet.is_area = sheet.is_area || file.georeference().is_area;
    const int first_column = static_cast<int>(placed.column_begin - patch.column_begin) + 1;
    const int first_row = static_cast<int>(placed.row_begin - patch.row_begin) + 1;
    FillValues fills(placed.tile->window.columns, file.head().meaning.unit_m);
    CommonPosts overlap;
    const HeightTally tally = file.read(placed.tile->window, [&](long long row, const float* heights_m) {
      fills.add(heights_m);
      std::size_t post = sheet.index(first_column, first_row + static_cast<int>(row));
      for (long long column = 0; column < placed.tile->window.columns; ++column, ++post) {
        if (sheet.kinds[post] == PostKind::known) {
          if (!std::isnan(heights_m[column])) overlap.add(sheet.heights_m[post], heights_m[column]);
          continue;
        }
        sheet.kinds[post] = std::isnan(heights_m[column]) ? PostKind::empty : PostKind::known;
        sheet.heights_m[post] = heights_m[column];
      }
    });
    file.release();
    const FillValues::Result found = fills.result();
    for (const Implausibility& remark : implausibilitiesOf(file, tally, found)) {
      if (remark.is_error)
        throw Error(ErrorCode::bad_input, file.head().location,
                    "elevation file " + file.head().name + ": " + remark.text);
      sheet.remarks.push_back({placed.tile->file, remark.text});
    }
    if (const std::string text =
            overlap.text(static_cast<long long>(placed.tile->window.columns) * placed.tile->window.rows);
        !text.empty())
      sheet.remarks.push_back({placed.tile->file, text});
    if (found.is_partial) sheet.partly_searched.push_back(placed.tile->file);
    for (const FillValues::Found& fill : found.fills) {
      sheet.fills.push_back({placed.tile->file, fill});
      for (long long row = 0; row < placed.tile->window.rows; ++row) {
        std::size_t post = sheet.index(first_column, first_row + static_cast<int>(row));
        for (long long column = 0; column < placed.tile->window.columns; ++column, ++post) {
          if (sheet.heights_m[post] != fill.height_m) continue;
          sheet.kinds[post] = PostKind::empty;
          sheet.heights_m[post] = kNoHeight;
        }
      }
    }
  }
  measureSpacing(sheet);
  return sheet;
}

/// Visits the absent posts of a sheet that have a neighbour from a file.
template <class Visit>
void visitRim(const TerrainSheet& sheet, const Visit& visit) {
  for (int row = 0; row < sheet.rows; ++row) {
    for (int column = 0; column < sheet.columns; ++column) {
      if (sheet.kind(column, row) != PostKind::absent) continue;
      bool beside_file = false;
      for (int j = std::max(row - 1, 0); j <= std::min(row + 1, sheet.rows - 1); ++j) {
        for (int i = std::max(column - 1, 0); i <= std::min(column + 1, sheet.columns - 1); ++i) {
          beside_file = beside_file || sheet.kind(i, j) != PostKind::absent;
        }
      }
      if (beside_file) visit(column, row);
    }
  }
}

struct RimPost {
  int column, row;
  float height_m;
};

/// Heights of the other sheets at the rim of sheet `k`.
std::vector<RimPost> rimFromOthers(const std::vector<TerrainSheet>& sheets, std::size_t k) {
  std::vector<TerrainRaster> others;
  for (std::size_t other = 0; other < sheets.size(); ++other) {
    if (other != k) others.push_back(sheets[other].raster());
  }
  std::vector<RimPost> rim;
  if (others.empty()) return rim;
  const TerrainView view{others.data(), static_cast<int>(others.size())};
  const PostLattice& lattice = sheets[k].lattice;
  visitRim(sheets[k], [&](int column, int row) {
    const float height_m = view.heightAt(degToRad(lattice.y(row)), degToRad(lattice.x(column)));
    if (!std::isnan(height_m)) rim.push_back({column, row, height_m});
  });
  return rim;
}

/// Extends the sheet's limits to the ring where it is filled.
void fillRim(TerrainSheet& sheet, const std::vector<RimPost>& rim) {
  for (const RimPost& post : rim) {
    sheet.heights_m[sheet.index(post.column, post.row)] = post.height_m;
    sheet.kinds[sheet.index(post.column, post.row)] = PostKind::known;
    sheet.first_column = std::min<double>(sheet.first_column, post.column);
    sheet.last_column = std::max<double>(sheet.last_column, post.column);
    sheet.first_row = std::min<double>(sheet.first_row, post.row);
    sheet.last_row = std::max<double>(sheet.last_row, post.row);
  }
}

/// Extends the outermost heights by half a post.
void holdOuterHeights(TerrainSheet& sheet) {
  const auto hold = [&](int column, int row) {
    const std::size_t ring = sheet.index(column, row);
    if (sheet.kinds[ring] != PostKind::absent) return;
    const std::size_t inner =
        sheet.index(std::clamp(column, 1, sheet.columns - 2), std::clamp(row, 1, sheet.rows - 2));
    if (sheet.kinds[inner] != PostKind::known) return;
    sheet.kinds[ring] = PostKind::known;
    sheet.heights_m[ring] = sheet.heights_m[inner];
  };
  for (int column = 0; column < sheet.columns; ++column) {
    hold(column, 0);
    hold(column, sheet.rows - 1);
  }
  for (int row = 0; row < sheet.rows; ++row) {
    hold(0, row);
    hold(sheet.columns - 1, row);
  }
  sheet.first_column = std::min(sheet.first_column, 0.5);
  sheet.last_column = std::max(sheet.last_column, sheet.columns - 1.5);
  sheet.first_row = std::min(sheet.first_row, 0.5);
  sheet.last_row = std::max(sheet.last_row, sheet.rows - 1.5);
}

}  // namespace

TerrainSheet::TerrainSheet(const TerrainFilePtr& of_file, const PostLattice& of_lattice,
                           long long with_columns, long long with_rows)
    : file(of_file), lattice(of_lattice) {
  if (with_columns > kMaxSheetPosts / with_rows) {
    throw Error(ErrorCode::bad_input,
                "elevation file " + file->head().name + ": the region takes " + std::to_string(with_columns) +
                    " x " + std::to_string(with_rows) + " posts of its spacing, more than " +
                    std::to_string(kMaxSheetPosts) + "; use a coarser file or a smaller region");
  }
  columns = static_cast<int>(with_columns);
  rows = static_cast<int>(with_rows);
  first_column = first_row = 1;
  last_column = columns - 2;
  last_row = rows - 2;
  const std::size_t posts = static_cast<std::size_t>(with_columns * with_rows);
  requireMemory({"elevation file " + file->head().name + ": the region's " + std::to_string(with_columns) +
                     " x " + std::to_string(with_rows) + " posts",
                 posts * (sizeof(float) + sizeof(PostKind)), "a coarser file or a smaller region takes less"},
                {});
  heights_m.assign(posts, kNoHeight);
  kinds.assign(posts, PostKind::absent);
}

TerrainRaster TerrainSheet::raster() const {
  TerrainRaster raster;
  raster.heights_msl_m = heights_m.data();
  raster.columns = columns;
  raster.rows = rows;
  raster.south_rad = degToRad(lattice.y0);
  raster.west_rad = degToRad(lattice.x0);
  raster.posts_per_rad_lat = radToDeg(1.0) / lattice.step_y;
  raster.posts_per_rad_lon = radToDeg(1.0) / lattice.step_x;
  raster.first_column = first_column;
  raster.last_column = last_column;
  raster.first_row = first_row;
  raster.last_row = last_row;
  return raster;
}

bool TerrainSheet::isNextToVoid(double column, double row) const {
  const int i = std::min(static_cast<int>(column), columns - 2);
  const int j = std::min(static_cast<int>(row), rows - 2);
  return kind(i, j) == PostKind::empty || kind(i + 1, j) == PostKind::empty ||
         kind(i, j + 1) == PostKind::empty || kind(i + 1, j + 1) == PostKind::empty;
}

std::vector<TerrainSheet> readSheets(const std::vector<RasterTile>& tiles) {
  std::vector<TerrainSheet> sheets;
  for (const LatticeGroup& group : groupByLattice(tiles)) {
    for (const Patch& patch : joinTouching(group.tiles)) sheets.push_back(readPatch(patch, group.lattice));
  }
  return sheets;
}

void closeSeams(std::vector<TerrainSheet>& sheets) {
  // All rims are computed before any is filled, so that heights are not passed on from sheet to sheet.
  std::vector<std::vector<RimPost>> rims;
  for (std::size_t k = 0; k < sheets.size(); ++k) rims.push_back(rimFromOthers(sheets, k));
  for (std::size_t k = 0; k < sheets.size(); ++k) {
    fillRim(sheets[k], rims[k]);
    if (sheets[k].is_area) holdOuterHeights(sheets[k]);
  }
}

}  // namespace emscape::scenario
