/// Sheets of posts in memory, read from files.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scenario/terrain/file.h"
#include "scenario/terrain/fill_values.h"
#include "scenario/terrain/posts.h"
#include "scenario/terrain/view.h"

namespace emscape::scenario {

using TerrainFilePtr = std::shared_ptr<const TerrainFile>;

/// The part of a file to read.
struct RasterTile {
  TerrainFilePtr file;
  PostLattice lattice;  ///< of the file; longitudes shifted by whole turns to those of the box
  PostWindow window;    ///< of the file's posts
};

enum class PostKind : std::uint8_t {
  absent,  ///< in no file
  empty,   ///< void in every file that has the post
  known,
};

/// One lattice of posts, filled from files. The outermost ring of posts is not from a file: it has the
/// heights of neighbouring sheets, so that heights are continuous across the seam.
struct TerrainSheet {
  TerrainFilePtr file;  ///< one of the sheet's files, for its plane and datum
  PostLattice lattice;
  int columns, rows;
  bool is_area = false;  ///< reaches half a post beyond the files' posts
  double spacing_m = 0;  ///< of the files' posts, geometric mean of both directions
  double finest_m =
      0;  ///< the smaller of both directions, but at least half the other: meridians converge near the poles
  std::vector<float> heights_m;  ///< south row first; NaN where not known
  std::vector<PostKind> kinds;
  /// Fill values that files did not declare; their posts are void.
  struct Fill {
    TerrainFilePtr file;
    FillValues::Found value;
  };
  std::vector<Fill> fills;
  /// What else is said of heights of files.
  struct Remark {
    TerrainFilePtr file;
    std::string text;
  };
  std::vector<Remark> remarks;
  std::vector<TerrainFilePtr> partly_searched;            ///< for fill values; see FillValues::Result
  double first_column, last_column, first_row, last_row;  ///< limits of lookups

  /// All posts absent.
  /// @throws Error (bad_input) if the sheet has more than kMaxSheetPosts posts; (other) if they do not fit
  /// into memory
  TerrainSheet(const TerrainFilePtr& of_file, const PostLattice& of_lattice, long long with_columns,
               long long with_rows);

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  PostKind kind(int column, int row) const { return kinds[index(column, row)]; }
  /// For lookups. For a sheet in its own plane only limit() and heightAtPost() are defined.
  TerrainRaster raster() const;
  /// True if one of the four posts around a point within the limits is void.
  bool isNextToVoid(double column, double row) const;
};

/// Posts that one sheet may hold (8 GiB of heights).
constexpr long long kMaxSheetPosts = 1LL << 31;

/// Reads tiles into sheets. Tiles whose posts coincide (to a hundredth of a post) and whose windows touch
/// become one sheet, if their heights have the same datum. Where several files have the same post, the one
/// listed first takes precedence.
/// @throws Error (bad_input) if reading fails
std::vector<TerrainSheet> readSheets(const std::vector<RasterTile>& tiles);

/// Continues sheets of longitudes and latitudes over their seams: the ring of a sheet gets its heights from
/// the first other sheet that has them; at the outer edge of pixel-is-area files the heights are extended by
/// half a post.
void closeSeams(std::vector<TerrainSheet>& sheets);

}  // namespace emscape::scenario
