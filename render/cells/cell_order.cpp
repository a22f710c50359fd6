#include "render/cells/cell_order.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "emscape/base/parallel.h"
#include "render/cells/projected_cells.h"

namespace emscape::render {
namespace {

/// Sort keys, increasing with the distances of the centroids.
std::vector<float> depths(const CellMesh& mesh, const CameraView& camera) {
  const Vec3d depth = DepthAxes(camera).depth;
  const CellMeshView view = mesh.view();
  std::vector<float> result(mesh.mesh->cells.size());
  parallelFor(static_cast<int>(result.size()), 4096, [&](int begin, int end) {
    for (int c = begin; c < end; ++c) {
      result[static_cast<std::size_t>(c)] = centroidDepth(view, camera, depth, c);
    }
  });
  return result;
}

/// Keys whose order as unsigned numbers is that of the floats, the largest first.
std::uint32_t descendingKey(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return (bits >> 31) != 0 ? bits : ~(bits | 0x80000000u);
}

/// Faces across which a cell hides its neighbour: one bit per face.
std::uint8_t facesBehind(const CellMesh& mesh, const CameraView& camera, int cell) {
  std::uint8_t behind = 0;
  for (int i = 0; i < 4; ++i) {
    const volume::FaceId here = 4 * cell + i;
    const volume::FaceId there = mesh.faces->other_side[static_cast<std::size_t>(here)];
    if (there == volume::kNoFace) continue;
    // Both sides of a face use the same numbers.
    const volume::FaceId decides = std::min(here, there);
    const auto& vertices = mesh.cell(decides / 4);
    const int* const face = volume::kFaceVertices[decides % 4];
    const Vec3d a = mesh.point(vertices[static_cast<std::size_t>(face[0])]);
    const Vec3d outward = cross(mesh.point(vertices[static_cast<std::size_t>(face[1])]) - a,
                                mesh.point(vertices[static_cast<std::size_t>(face[2])]) - a);
    const double away = camera.orthographic ? dot(outward, camera.forward) : dot(outward, a - camera.eye);
    if (here == decides ? away > 0 : away < 0) behind |= static_cast<std::uint8_t>(1 << i);
  }
  return behind;
}

}  // namespace

CellOrder centroidOrder(const CellMesh& mesh, const CameraView& camera) {
  const std::vector<float> depth = depths(mesh, camera);
  struct Item {
    std::uint32_t key;
    std::int32_t cell;
  };
  std::vector<Item> items(depth.size()), sorted(depth.size());
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
    for (int c = begin; c < end; ++c) items[c] = {descendingKey(depth[c]), c};
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
  const std::size_t count = mesh.mesh->cells.size();
  std::vector<std::uint8_t> behind(count);
  parallelFor(static_cast<int>(count), 4096, [&](int begin, int end) {
    for (int c = begin; c < end; ++c) behind[static_cast<std::size_t>(c)] = facesBehind(mesh, camera, c);
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
