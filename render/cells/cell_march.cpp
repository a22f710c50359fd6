#include "render/cells/cell_march.h"

#include <algorithm>
#include <atomic>
#include <limits>

#include "emscape/base/parallel.h"

namespace emscape::render {

int cellAt(const CellMesh& mesh, const Vec3d& position) {
  const auto vectorTo = [&](std::int32_t point) { return mesh.point(point) - position; };
  const int cells = static_cast<int>(mesh.mesh->cells.size());
  std::atomic<int> found{cells};
  parallelFor(cells, 4096, [&](int begin, int end) {
    for (int n = begin; n < end && n < found.load(); ++n) {
      const auto& cell = mesh.cell(n);
      const bool inside =
          std::all_of(std::begin(volume::kFaceVertices), std::end(volume::kFaceVertices), [&](const int* v) {
            const auto to = [&](int i) { return vectorTo(cell[static_cast<std::size_t>(v[i])]); };
            return dot(cross(to(0), to(1)), to(2)) >= 0;
          });
      if (!inside) continue;
      int known = found.load();
      while (n < known && !found.compare_exchange_weak(known, n)) {
      }
    }
  });
  return found.load() < cells ? found.load() : -1;
}

long long marchInTurn(const CellMeshView& mesh, const IntervalsView& transfer, const PsiLookup& psi,
                      MarchTask* tasks, int count) {
  long long cells = 0;
  for (MarchTask* task = tasks; task < tasks + count; ++task) {
    RayIntegral integral(transfer, psi);
    const MarchLimits& limits = task->limits;
    double been = -std::numeric_limits<double>::infinity();
    for (const EntryHit& entry : task->entries) {
      if (entry.distance >= limits.distance || integral.through() < limits.through) break;
      been = march(mesh, task->frame, entry, been, limits, integral, cells);
    }
    task->color = integral.color();
  }
  return cells;
}

}  // namespace emscape::render
