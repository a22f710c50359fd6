/// The order in which a launch casts the tiles of a lattice. Made by the host, read by the device.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

#include "emscape/base/host_device.h"
#include "render/raycast.h"
#include "render/reconstruction.h"

namespace emscape::render::cuda {

/// A lattice in tiles of 32 pixels, nearly square in the picture, and these in a coarse grid of cells. Tiles
/// are numbered cell by cell; some are beyond the lattice. Plain data.
struct TileOrder {
  static constexpr int kAlong = 16;  ///< cells along either axis
  static constexpr int kCells = kAlong * kAlong;

  Lattice lattice;
  int tile_width = 8;                   ///< pixels of the lattice; 8 or 4
  int cell_width = 0, cell_height = 0;  ///< tiles
  int shown_cells = 0;              ///< the first of `cells`, in which the ray of a corner meets the volume
  std::uint8_t cells[kCells] = {};  ///< each cell once, row by row in the grid

  TileOrder() = default;
  /// The cells row by row.
  explicit TileOrder(const Lattice& of)
      : lattice(of),
        tile_width(of.step_x > of.step_y ? 4 : 8),
        cell_width(cellSide(of.columns, tile_width)),
        cell_height(cellSide(of.rows, tileHeight())) {
    std::iota(cells, cells + kCells, std::uint8_t{0});
  }

  EMSCAPE_HD unsigned tilesOfCell() const { return static_cast<unsigned>(cell_width * cell_height); }
  EMSCAPE_HD unsigned shownTiles() const { return static_cast<unsigned>(shown_cells) * tilesOfCell(); }
  EMSCAPE_HD unsigned allTiles() const { return kCells * tilesOfCell(); }

  /// @param lane  0..31
  /// @return false: there is no such pixel
  EMSCAPE_HD bool pixelOf(unsigned tile, unsigned lane, Pixel& pixel) const {
    const int cell = cells[tile / tilesOfCell()];
    const int in_cell = static_cast<int>(tile % tilesOfCell());
    const int in_tile = static_cast<int>(lane);
    const int column =
        (cell % kAlong * cell_width + in_cell % cell_width) * tile_width + in_tile % tile_width;
    const int row =
        (cell / kAlong * cell_height + in_cell / cell_width) * tileHeight() + in_tile / tile_width;
    pixel = pixelAt(column, row);
    return column < lattice.columns && row < lattice.rows;
  }
  /// The pixel where four cells meet, or the nearest one of the lattice. @param column, row  0..kAlong
  Pixel cornerAt(int column, int row) const {
    return pixelAt(std::min(column * cell_width * tile_width, lattice.columns - 1),
                   std::min(row * cell_height * tileHeight(), lattice.rows - 1));
  }

 private:
  EMSCAPE_HD int tileHeight() const { return 32 / tile_width; }
  EMSCAPE_HD Pixel pixelAt(int column, int row) const {
    return {static_cast<std::uint16_t>(lattice.first_x + column * lattice.step_x),
            static_cast<std::uint16_t>(lattice.first_y + row * lattice.step_y)};
  }
  static int cellSide(int pixels, int tile) { return ((pixels + tile - 1) / tile + kAlong - 1) / kAlong; }
};

/// The cells with the longest rays first, so that a launch ends with short rays. A ray's length is that in
/// the volume's box: where rays end early the order is less good.
/// @param task  of which the camera and the volume's size count
inline TileOrder longestFirst(const RaycastTask& task, const Lattice& lattice) {
  constexpr int kAlong = TileOrder::kAlong;
  TileOrder order(lattice);
  std::array<std::array<float, kAlong + 1>, kAlong + 1> corners;
  for (int row = 0; row <= kAlong; ++row) {
    for (int column = 0; column <= kAlong; ++column) {
      const Pixel pixel = order.cornerAt(column, row);
      corners[row][column] = task.segmentsOf(pixel.x, pixel.y, {}).length;
    }
  }
  std::array<float, TileOrder::kCells> longest;
  for (int cell = 0; cell < TileOrder::kCells; ++cell) {
    const auto& above = corners[cell / kAlong];
    const auto& below = corners[cell / kAlong + 1];
    const int column = cell % kAlong;
    longest[cell] = std::max({above[column], above[column + 1], below[column], below[column + 1]});
    order.shown_cells += longest[cell] > 0.0F ? 1 : 0;
  }
  std::stable_sort(order.cells, order.cells + TileOrder::kCells,
                   [&](std::uint8_t a, std::uint8_t b) { return longest[a] > longest[b]; });
  return order;
}

}  // namespace emscape::render::cuda
