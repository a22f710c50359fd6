/// Sheets of posts in memory, and how files become sheets.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scenario/terrain/file.h"
#include "scenario/terrain/posts.h"
#include "scenario/terrain/view.h"

namespace emscape::scenario {

using TerrainFilePtr = std::shared_ptr<const TerrainFile>;

/// Part of a file that is to be read.
struct TerrainPiece {
  TerrainFilePtr file;
  PostLattice lattice;  ///< the file's; longitudes moved by whole turns to where they are wanted
  PostWindow window;    ///< of the file's posts
};

enum class PostKind : std::uint8_t {
  absent,  ///< of no file
  empty,   ///< void in every file that has it
  known,
};

/// One lattice of posts, filled from files. The outermost ring of posts is of no file: it is there for what
/// neighbouring sheets know, so that heights go on across the seam.
struct TerrainSheet {
  TerrainFilePtr file;  ///< one of the sheet's, for its plane
  PostLattice lattice;
  int columns, rows;
  bool is_area = false;  ///< reaches half a post beyond the files' posts
  double spacing_m = 0;  ///< of the files' posts, geometric mean of both directions
  double finest_m =
      0;  ///< the lesser of both directions, but at least half the other: meridians crowd near the poles
  std::vector<float> heights_m;  ///< south row first; NaN where not known
  std::vector<PostKind> kinds;
  double first_column, last_column, first_row, last_row;  ///< where heights may be asked for

  /// All posts absent.
  /// @throws Error (bad_input) if the sheet has more than kMostSheetPosts posts
  TerrainSheet(const TerrainFilePtr& of_file, const PostLattice& of_lattice, long long with_columns,
               long long with_rows);

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  PostKind kind(int column, int row) const { return kinds[index(column, row)]; }
  /// For lookups. Of a sheet in a plane of its own only limit() and heightAtPost() have a meaning.
  TerrainRaster raster() const;
  /// One of the four posts about a point within the limits is void.
  bool besideVoid(double column, double row) const;
};

/// Posts that one sheet may hold (8 GiB of heights).
constexpr long long kMostSheetPosts = 1LL << 31;

/// Reads pieces into sheets. Pieces whose posts coincide (to a hundredth of a post) and whose windows touch
/// become one sheet. Where several files know the same post, the one named first is believed.
/// @throws Error (bad_input) if reading fails
std::vector<TerrainSheet> readSheets(const std::vector<TerrainPiece>& pieces);

/// Continues sheets of longitudes and latitudes over their seams: a post of no file beside others takes its
/// height from the other sheets, of which the first that knows it is believed; and at the outer edge of
/// pixel-is-area files the heights are held for half a post.
void closeSeams(std::vector<TerrainSheet>& sheets);

}  // namespace emscape::scenario
