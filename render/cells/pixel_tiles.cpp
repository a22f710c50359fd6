#include "render/cells/pixel_tiles.h"

#include <algorithm>
#include <utility>

#include "emscape/base/parallel.h"

namespace emscape::render {

TileLists::TileLists(const TileGrid& grid, std::size_t count,
                     const std::function<PixelBox(std::size_t)>& boxOf) {
  // Counting sort, stable, in parallel over blocks of boxes.
  constexpr std::size_t kBlock = 1 << 15;
  const auto tiles = static_cast<std::size_t>(grid.count());
  const std::size_t blocks = (count + kBlock - 1) / kBlock;
  std::vector<std::size_t> next(blocks * tiles, 0);  // of a block and a tile: a count, then the next place
  const auto overBlocks = [&](const auto& visit) {
    parallelFor(static_cast<int>(blocks), 1, [&](int begin, int end) {
      for (auto b = static_cast<std::size_t>(begin); b < static_cast<std::size_t>(end); ++b) {
        std::size_t* const of_block = &next[b * tiles];
        for (std::size_t n = b * kBlock; n < std::min(count, (b + 1) * kBlock); ++n) {
          grid.eachTile(boxOf(n), [&](int tile) { visit(of_block[tile], static_cast<int>(n)); });
        }
      }
    });
  };
  overBlocks([](std::size_t& found, int) { ++found; });
  std::size_t sum = 0;
  for (std::size_t tile = 0; tile < tiles; ++tile) {
    first_.push_back(sum);
    for (std::size_t b = 0; b < blocks; ++b) sum += std::exchange(next[b * tiles + tile], sum);
  }
  first_.push_back(sum);
  members_.resize(sum);
  overBlocks([this](std::size_t& place, int n) { members_[place++] = n; });
}

}  // namespace emscape::render
