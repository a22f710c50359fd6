#include "emscape/emfield/columns/terrain_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "base/memory.h"
#include "emscape/base/error.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/parallel.h"
#include "emscape/emfield/solver/field_solver.h"

namespace emscape::emfield {
namespace {

constexpr int kMaxLayers = 4096;
constexpr double kDefaultFirst_m = 5;
constexpr double kMaxHeight_m = 100e3;  ///< above ground, of layers that need not end at the region's top

[[noreturn]] void refuse(const std::string& text, const std::string& what) {
  throw Error(ErrorCode::usage,
              fmt::format("mesh '{}': {}; expected terrain:LAYERS[,FIRST_M[,RATIO]]", text, what));
}

double numberIn(const std::string& text, const char* name, const std::string& number, double least,
                double largest) {
  double value = std::numeric_limits<double>::quiet_NaN();
  const char* const end = number.data() + number.size();
  const auto [at, failure] = std::from_chars(number.data(), end, value);
  if (failure != std::errc() || at != end || !(value >= least && value <= largest)) {
    refuse(text, fmt::format("{} '{}' must be a number {}..{}", name, number, least, largest));
  }
  return value;
}

/// Thickness of all layers together.
double totalOf(int layers, double first_m, double ratio) {
  double total = 0, thickness = first_m;
  for (int n = 0; n < layers; ++n, thickness *= ratio) total += thickness;
  return total;
}

/// Memory for making and writing the mesh: vertices, and of a file their offset and type; coordinates, number
/// in the lattice and number in the mesh.
constexpr std::size_t kCellBytes = 4 * sizeof(std::int32_t) + sizeof(std::int64_t) + 1;
constexpr std::size_t kPointBytes = sizeof(Vec3d) + sizeof(std::size_t) + sizeof(std::int32_t);

/// A column of the region: its position, and its foot in the frame.
struct Foot {
  Surface::Position position;
  double ground_msl_m = 0;  ///< NaN over a hole
  Vec3d position_m;
};

Vec3d localOf(const GeoFrame& frame, const Foot& foot, double height_m) {
  const double msl_m = foot.ground_msl_m + height_m;
  if (frame.origin().kind == FrameKind::altitude) return {foot.position_m.x, foot.position_m.y, msl_m};
  const auto& [latitude_deg, longitude_deg] = foot.position;
  return frame.toLocal({latitude_deg, longitude_deg, msl_m + geoidUndulation_m(latitude_deg, longitude_deg)});
}

Foot footOf(const GeoFrame& frame, const scenario::Terrain* terrain, double x_m, double y_m) {
  Foot foot;
  foot.position_m = {x_m, y_m, 0};
  // In a tangent frame the position on the earth also depends on z: repeated with the computed z.
  const int rounds = frame.origin().kind == FrameKind::enu ? 2 : 1;
  for (int round = 0; round < rounds; ++round) {
    const GeodeticPosition at = frame.toGeodetic({x_m, y_m, foot.position_m.z});
    foot.position = {at.latitude_deg, at.longitude_deg};
    foot.ground_msl_m = terrain != nullptr ? terrain->heightMsl_m(at.latitude_deg, at.longitude_deg) : 0.0;
    if (std::isnan(foot.ground_msl_m)) return foot;
    foot.position_m.z = localOf(frame, foot, 0).z;
  }
  return foot;
}

std::vector<Foot> feetOf(const volume::Grid& grid, const scenario::Terrain* terrain) {
  const GeoFrame frame(grid.frame);
  std::vector<Foot> feet(static_cast<std::size_t>(grid.dims.x) * grid.dims.y);
  parallelFor(static_cast<int>(feet.size()), 256, [&](int begin, int end) {
    for (int c = begin; c < end; ++c) {
      const Vec3d center = grid.center_m(c % grid.dims.x, c / grid.dims.x, 0);
      feet[static_cast<std::size_t>(c)] = footOf(frame, terrain, center.x, center.y);
    }
  });
  return feet;
}

}  // namespace

TerrainMeshSpec parseTerrainMesh(const std::string& text) {
  const std::string kind = "terrain:";
  if (text == "terrain") refuse(text, "LAYERS is missing");
  if (text.rfind(kind, 0) != 0) refuse(text, "the only kind is terrain");
  std::vector<std::string> numbers{""};
  for (const char character : text.substr(kind.size())) {
    if (character == ',') {
      numbers.emplace_back();
    } else {
      numbers.back() += character;
    }
  }
  if (numbers.size() > 3) refuse(text, fmt::format("{} values", numbers.size()));
  const double layers = numberIn(text, "LAYERS", numbers[0], 1, kMaxLayers);
  if (layers != std::floor(layers)) refuse(text, fmt::format("LAYERS '{}' is not whole", numbers[0]));
  TerrainMeshSpec spec;
  spec.layers = static_cast<int>(layers);
  if (numbers.size() > 1) spec.first_m = numberIn(text, "FIRST_M", numbers[1], 0.01, 1e4);
  if (numbers.size() > 2) spec.ratio = numberIn(text, "RATIO", numbers[2], 1, 3);
  return spec;
}

std::vector<double> layerHeights_m(const TerrainMeshSpec& spec, double height_m) {
  const double even_m = height_m / spec.layers;
  const double first_m = spec.first_m.value_or(std::min(kDefaultFirst_m, even_m));
  double ratio = spec.ratio.value_or(1);
  if (!spec.ratio) {
    if (first_m > even_m * (1 + 1e-9)) {
      throw Error(
          ErrorCode::usage,
          fmt::format("mesh: {} layers of at least {} m are higher than the region, whose top is {:.0f} m "
                      "above its lowest ground; FIRST_M must be at most {:.4g}",
                      spec.layers, first_m, height_m, even_m));
    }
    double least = 1, largest = 2;
    while (totalOf(spec.layers, first_m, largest) < height_m && largest < 1e9) largest *= 2;
    for (int n = 0; n < 100; ++n) {
      ratio = 0.5 * (least + largest);
      (totalOf(spec.layers, first_m, ratio) < height_m ? least : largest) = ratio;
    }
  }
  std::vector<double> heights_m;
  for (int n = 0; n <= spec.layers; ++n) heights_m.push_back(totalOf(n, first_m, ratio));
  if (!spec.ratio) heights_m.back() = height_m;
  const double allowed_m = std::max(kMaxHeight_m, height_m);
  if (!(heights_m.back() <= allowed_m)) {
    throw Error(
        ErrorCode::usage,
        fmt::format("mesh: {} layers (LAYERS), the first of {} m (FIRST_M), each {} times as thick as "
                    "the one below it (RATIO), reach {} above ground, outside the allowed range "
                    "up to {:.10g} m",
                    spec.layers, first_m, ratio,
                    std::isfinite(heights_m.back()) ? fmt::format("{:.6g} m", heights_m.back())
                                                    : "an infinite height",
                    allowed_m));
  }
  return heights_m;
}

TerrainMesh::TerrainMesh(const scenario::Scenario& scenario, const scenario::Terrain* terrain,
                         const TerrainMeshSpec& spec) {
  const volume::Grid grid = gridOf(scenario.region);
  const auto fail = [&](const std::string& what) {
    throw Error(ErrorCode::bad_input, {scenario.file}, what);
  };
  const Dims lattice{grid.dims.x, grid.dims.y, spec.layers + 1};
  if (lattice.x < 2 || lattice.y < 2) {
    fail(fmt::format("a mesh over {} x {} columns (region.dims): at least 2 x 2 are needed", lattice.x,
                     lattice.y));
  }
  const long long cells = 6LL * (lattice.x - 1) * (lattice.y - 1) * spec.layers;
  if (cells > volume::kMaxMeshCells) {
    fail(fmt::format("a mesh of {} tetrahedra ({} x {} columns, {} layers): at most {} can be used", cells,
                     lattice.x, lattice.y, spec.layers, volume::kMaxMeshCells));
  }
  const auto count = [](long long number) { return static_cast<std::size_t>(number); };
  requireMemory({fmt::format("the mesh of {} tetrahedra ({} x {} columns, {} layers)", cells, lattice.x,
                             lattice.y, spec.layers),
                 count(cells) * kCellBytes + count(lattice.count()) * kPointBytes +
                     count(lattice.x) * count(lattice.y) * sizeof(Foot),
                 "fewer columns (region.dims) or layers take less"},
                {scenario.file});
  const std::vector<Foot> feet = feetOf(grid, terrain);
  double lowest_m = std::numeric_limits<double>::infinity();
  for (const Foot& foot : feet) {
    if (!std::isnan(foot.ground_msl_m)) lowest_m = std::min(lowest_m, foot.position_m.z);
  }
  if (std::isinf(lowest_m)) fail("a mesh over the ground: the ground is missing below the whole region");
  if (!(lowest_m < grid.upper_m().z)) fail("a mesh over the ground: the region ends below the ground");

  auto surface = std::make_shared<Surface>();
  surface->width = lattice.x;
  surface->height = lattice.y;
  surface->heights_m = layerHeights_m(spec, grid.upper_m().z - lowest_m);
  for (const Foot& foot : feet) surface->positions.push_back(foot.position);

  auto mesh = std::make_shared<volume::TetrahedralMesh>();
  mesh->frame = grid.frame;
  mesh->georeferenced = true;
  mesh->cells = volume::latticeCells(lattice);
  // Points of the cells that have ground below them, in the order of the lattice.
  const auto isHole = [&](std::int32_t point) {
    return std::isnan(feet[static_cast<std::size_t>(point) % feet.size()].ground_msl_m);
  };
  mesh->cells.erase(
      std::remove_if(mesh->cells.begin(), mesh->cells.end(),
                     [&](const auto& cell) { return std::any_of(cell.begin(), cell.end(), isHole); }),
      mesh->cells.end());
  if (mesh->cells.empty())
    fail("a mesh over the ground: no four neighbouring columns have ground below them");
  std::vector<std::int32_t> number(static_cast<std::size_t>(lattice.count()), -1);
  for (const auto& cell : mesh->cells) {
    for (const std::int32_t vertex : cell) number[static_cast<std::size_t>(vertex)] = 0;
  }
  for (std::size_t n = 0; n < number.size(); ++n) {
    if (number[n] < 0) continue;
    number[n] = static_cast<std::int32_t>(lattice_.size());
    lattice_.push_back(n);
  }
  for (auto& cell : mesh->cells) {
    for (std::int32_t& vertex : cell) vertex = number[static_cast<std::size_t>(vertex)];
  }
  const GeoFrame frame(grid.frame);
  mesh->points_m.resize(lattice_.size());
  parallelFor(static_cast<int>(lattice_.size()), 4096, [&](int begin, int end) {
    for (int n = begin; n < end; ++n) {
      const std::size_t position = lattice_[static_cast<std::size_t>(n)];
      mesh->points_m[static_cast<std::size_t>(n)] =
          localOf(frame, feet[position % feet.size()], surface->heights_m[position / feet.size()]);
    }
  });
  surface_ = std::move(surface);
  mesh_ = std::move(mesh);
}

volume::MeshField TerrainMesh::field(const volume::DenseVolume& volume) const {
  volume::MeshField field{mesh_, volume.info, std::vector<float>(lattice_.size())};
  const std::size_t columns = surface_->positions.size();
  for (std::size_t n = 0; n < lattice_.size(); ++n) {
    const std::size_t voxel = lattice_[n];
    const bool masked =
        !volume.first_valid_k.empty() && voxel / columns < volume.first_valid_k[voxel % columns];
    field.values[n] = masked ? std::numeric_limits<float>::quiet_NaN() : volume.values[voxel];
  }
  return field;
}

}  // namespace emscape::emfield
