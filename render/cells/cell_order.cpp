#include "render/cells/cell_order.h"

#include <algorithm>
#include <utility>

#include "emscape/base/parallel.h"
#include "render/cells/projected_cells.h"

namespace emscape::render {

CellOrder centroidOrder(const CellMesh& mesh, const CameraView& camera) {
  struct Item {
    std::uint32_t key;
    std::int32_t cell;
  };
  const CellMeshView view = mesh.view();
  const Vec3d depth = DepthAxes(camera).depth;
  std::vector<Item> items(mesh.mesh->cells.size()), sorted(items.size());
  const auto count = static_cast<int>(items.size());
  // Radix sort, stable, in parallel over blocks: the same on every machine.
  constexpr int kBits = 11, kBuckets = 1 << kBits, kBlock = 1 << 16;
  const int blocks = (count + kBlock - 1) / kBlock;
  const auto overBlocks = [&](auto body) {
    parallelFor(blocks, 1, [&](int begin, int end) {
      for (int b = begin; b < end; ++b) body(b, b * kBlock, std::min(count, (b + 1) * kBlock));
    });
  };
  overBlocks([&](int, int begin, int end) {
    for (int c = begin; c < end; ++c) items[c] = {~centroidKey(view, camera, depth, c), c};
  });
  std::vector<std::int32_t> first(static_cast<std::size_t>(blocks) * kBuckets);
  for (int shift = 0; shift < 32; shift += kBits) {
    const auto bucketOf = [shift](const Item& item) { return (item.key >> shift) & (kBuckets - 1); };
    overBlocks([&](int block, int begin, int end) {
      std::int32_t* const counts = &first[static_cast<std::size_t>(block) * kBuckets];
      std::fill_n(counts, kBuckets, 0);
      for (int n = begin; n < end; ++n) ++counts[bucketOf(items[n])];
    });
    std::int32_t sum = 0;
    for (int bucket = 0; bucket < kBuckets; ++bucket) {
      for (int block = 0; block < blocks; ++block) {
        std::int32_t& here = first[static_cast<std::size_t>(block) * kBuckets + bucket];
        sum += std::exchange(here, sum);
      }
    }
    overBlocks([&](int block, int begin, int end) {
      std::int32_t* const next = &first[static_cast<std::size_t>(block) * kBuckets];
      for (int n = begin; n < end; ++n) sorted[next[bucketOf(items[n])]++] = items[n];
    });
    items.swap(sorted);
  }
  CellOrder order;
  order.cells.resize(items.size());
  overBlocks([&](int, int begin, int end) {
    for (int n = begin; n < end; ++n) order.cells[n] = items[n].cell;
  });
  return order;
}

CellOrder visibilityOrder(const CellMesh& mesh, const CameraView& camera) {
  const CellMeshView view = mesh.view();
  const std::size_t count = mesh.mesh->cells.size();
  std::vector<std::uint8_t> behind(count);
  parallelFor(static_cast<int>(count), 4096, [&](int begin, int end) {
    for (int c = begin; c < end; ++c) behind[static_cast<std::size_t>(c)] = facesBehind(view, camera, c);
  });
  enum State : std::uint8_t { unseen, open, done };
  std::vector<State> states(count, unseen);
  CellOrder order;
  order.cells.reserve(count);
  std::vector<std::int32_t> path;
  for (const std::int32_t start : centroidOrder(mesh, camera).cells) {
    if (states[static_cast<std::size_t>(start)] != unseen) continue;
    path.push_back(start);
    states[static_cast<std::size_t>(start)] = open;
    while (!path.empty()) {
      const auto cell = static_cast<std::size_t>(path.back());
      if (behind[cell] == 0) {
        states[cell] = done;
        order.cells.push_back(path.back());
        path.pop_back();
        continue;
      }
      int face = 0;
      while ((behind[cell] >> face & 1) == 0) ++face;
      behind[cell] &= static_cast<std::uint8_t>(behind[cell] - 1);
      const std::int32_t next = mesh.faces->other_side[4 * cell + static_cast<std::size_t>(face)] / 4;
      State& state = states[static_cast<std::size_t>(next)];
      if (state == open) ++order.cycles;
      if (state != unseen) continue;
      state = open;
      path.push_back(next);
    }
  }
  return order;
}

}  // namespace emscape::render
