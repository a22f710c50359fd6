/// Square tiles of a picture, and lists of the pixel boxes that touch each tile.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "emscape/base/host_device.h"
#include "emscape/render/picture/image.h"

namespace emscape::render {

/// Pixels first_x..end_x - 1, first_y..end_y - 1.
struct PixelBox {
  int first_x = 0, first_y = 0, end_x = 0, end_y = 0;

  EMSCAPE_HD bool holds(int x, int y) const { return x >= first_x && x < end_x && y >= first_y && y < end_y; }
  EMSCAPE_HD bool isEmpty() const { return first_x >= end_x || first_y >= end_y; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - first_y) * (end_x - first_x) + (x - first_x);
  }
};
EMSCAPE_HD inline PixelBox common(const PixelBox& a, const PixelBox& b) {
  return {a.first_x > b.first_x ? a.first_x : b.first_x, a.first_y > b.first_y ? a.first_y : b.first_y,
          a.end_x < b.end_x ? a.end_x : b.end_x, a.end_y < b.end_y ? a.end_y : b.end_y};
}

/// Tiles are numbered along rows, from the top row.
struct TileGrid {
  static constexpr int kTile = 16;  ///< pixels along a side

  ImageSize size;

  EMSCAPE_HD int columns() const { return (size.width + kTile - 1) / kTile; }
  EMSCAPE_HD int count() const { return columns() * ((size.height + kTile - 1) / kTile); }
  EMSCAPE_HD int tileOf(int x, int y) const { return y / kTile * columns() + x / kTile; }
  EMSCAPE_HD PixelBox pixelsOf(int tile) const {
    const int x = tile % columns() * kTile, y = tile / columns() * kTile;
    return common({x, y, x + kTile, y + kTile}, {0, 0, size.width, size.height});
  }
  /// Calls visit(tile) for each tile that a box touches.
  template <class Visit>
  EMSCAPE_HD void eachTile(const PixelBox& box, const Visit& visit) const {
    if (box.isEmpty()) return;
    for (int row = box.first_y / kTile; row * kTile < box.end_y; ++row) {
      for (int column = box.first_x / kTile; column * kTile < box.end_x; ++column)
        visit(row * columns() + column);
    }
  }
};

/// Lists of the boxes that touch each tile.
class TileLists {
 public:
  TileLists() = default;
  /// @param boxOf  gives the box of each index 0..count - 1; called from several threads
  TileLists(const TileGrid& grid, std::size_t count, const std::function<PixelBox(std::size_t)>& boxOf);

  /// Indices of the boxes that touch a tile, ascending: members()[first(tile)] .. members()[first(tile + 1) -
  /// 1].
  const std::vector<int>& members() const { return members_; }
  std::size_t first(int tile) const { return first_[static_cast<std::size_t>(tile)]; }

 private:
  std::vector<std::size_t> first_;  ///< one more at the end
  std::vector<int> members_;
};

}  // namespace emscape::render
