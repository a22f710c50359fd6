#include "emfield/excess/shadow.h"

#include <vector>

#include "emfield/excess/shadow_edge.h"
#include "emfield/excess/surface_horizon.h"
#include "emfield/ground/read_posts.h"
#include "emscape/base/parallel.h"

namespace emscape::emfield {

void findShadowEdgesCpu(const Station& station, const GroundPosts& ground, const ExcessGrid& grid,
                        const TerrainBounds* bounds, float* edges_m) {
  ShadowTask task{station, ground};
  std::vector<RangeTerms<float>> terms(static_cast<std::size_t>(ground.range_count));
  for (std::size_t i = 0; i < terms.size(); ++i) terms[i] = task.geometry().termsAt(ground.ranges_m[i]);
  task.terms = terms.data();
  std::vector<char> is_left;  // empty: all are
  if (bounds != nullptr && bounds->isUsable() && grid.part.isAll())
    is_left = findSurfaceShadows(task, grid, *bounds, edges_m);
  parallelFor(static_cast<int>(grid.column_count), 64, [&](int begin, int end) {
    std::vector<float> heights_m(terms.size());
    const auto slopeTo = [&](const FastInverse& path, int count) {
      readPostsCpu(station, ground, path, 0, count, heights_m.data());
      return grazingSlopeCpu(task.geometry(), heights_m.data() + 1, terms.data() + 1, count - 1);
    };
    for (int c = begin; c < end; ++c) {
      const auto column = static_cast<std::size_t>(c);
      if (!is_left.empty() && is_left[column] == 0) continue;
      if (grid.isLeftOut(column) || !grid.part.contains(grid.dims, column)) continue;
      edges_m[c] = task.edge_m(grid, column, slopeTo);
    }
  });
}

}  // namespace emscape::emfield
