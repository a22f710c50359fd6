#include "render/cpu/raycast_cpu.h"

#include <algorithm>
#include <array>
#include <atomic>

#include "base/math/simd.h"
#include "emscape/base/parallel.h"
#include "render/cpu/packets.h"
#include "render/patterns/edges.h"

namespace emscape::render {
namespace {

/// Pixels of a lattice along a tile's side: small enough for neighbouring rays to share data, and for a quick
/// stop.
constexpr int kTile = 16;
constexpr int kTilePixels = kTile * kTile;

/// The pixels of a tile along a Z-order curve, so that 4, 8 or 16 in a row are close together.
constexpr std::array<Pixel, kTilePixels> zOrder() {
  std::array<Pixel, kTilePixels> places{};
  for (int n = 0; n < kTilePixels; ++n) {
    Pixel& place = places[static_cast<std::size_t>(n)];
    for (int bit = 0; bit < 4; ++bit) {
      place.x = static_cast<std::uint16_t>(place.x | ((n >> (2 * bit)) & 1) << bit);
      place.y = static_cast<std::uint16_t>(place.y | ((n >> (2 * bit + 1)) & 1) << bit);
    }
  }
  return places;
}
constexpr std::array<Pixel, kTilePixels> kZOrder = zOrder();

/// RaycastTask::castVolume() or castSurface() for one kind of compositing and sampling.
using CastPixel = Rgba (RaycastTask::*)(int, int, RayBounds) const;

template <CastPixel kCast>
EMSCAPE_SIMD_CLONES void castPlain(const RaycastTask& task, const Pixel* pixels, const RayBounds* bounds,
                                   int count, Rgba* fronts) {
  for (int n = 0; n < count; ++n) {
    fronts[n] = (task.*kCast)(pixels[n].x, pixels[n].y, bounds != nullptr ? bounds[n] : RayBounds{});
  }
}

using CastPlain = void (*)(const RaycastTask&, const Pixel*, const RayBounds*, int, Rgba*);

template <class Sampler>
CastPlain plainOf(CompositingMode mode) {
  switch (mode) {
    case CompositingMode::mida:
      return castPlain<&RaycastTask::castVolume<MidaCompositor, Sampler>>;
    case CompositingMode::mip:
      return castPlain<&RaycastTask::castVolume<MipCompositor, Sampler>>;
    case CompositingMode::iso:
      return castPlain<&RaycastTask::castSurface<Sampler>>;
    case CompositingMode::dvr:
      break;
  }
  return castPlain<&RaycastTask::castVolume<DvrCompositor, Sampler>>;
}

using MapPixel = Rgba (*)(const RaycastTask&, Pixel, float, const Rgba&);

template <class Sampler>
Rgba mapOf(const RaycastTask& task, Pixel pixel, float distance, const Rgba& ground) {
  return task.mapColor<Sampler>(pixel.x, pixel.y, distance, ground);
}

using CutPixel = CutRay (*)(const RaycastTask&, Pixel, float);

template <class Sampler>
CutRay cutOf(const RaycastTask& task, Pixel pixel, float limit) {
  return task.cutRay<Sampler>(pixel.x, pixel.y, limit);
}

bool isSet(const StopFlag* stop) {
  return stop != nullptr && stop->load(std::memory_order_relaxed);
}

/// Casts groups of at most kTilePixels pixels.
class GroupCaster {
 public:
  explicit GroupCaster(const CpuCast& cast)
      : cast_(cast),
        in_packets_(!cast.plain && !cast.nearest && packetsCanCast(cast.task.volume)),
        plain_(cast.nearest ? plainOf<NearestSampler>(cast.mode) : plainOf<TrilinearSampler>(cast.mode)),
        cut_(cast.nearest ? cutOf<NearestSampler> : cutOf<TrilinearSampler>),
        map_(cast.nearest ? mapOf<NearestSampler> : mapOf<TrilinearSampler>) {}

  /// @return number of samples, if counted
  long long operator()(const Pixel* pixels, int count, Image& image) const {
    std::array<Rgba, kTilePixels> colors;
    const auto limit = [&](int n) { return groundLimit(pixels[n]); };
    const long long samples = castVolume(pixels, count, cast_.ground != nullptr, limit, colors.data());
    const bool shows_ground = cast_.ground != nullptr && cast_.shows_ground;
    for (int n = 0; n < count; ++n) {
      const Rgba& front = colors[static_cast<std::size_t>(n)];
      image.at(pixels[n].x, pixels[n].y) = shows_ground ? withGround(front, pixels[n]) : front;
    }
    return samples;
  }

  /// The same into an array, by rays of another camera than that of the layer of the ground.
  long long castApart(const Pixel* pixels, int count, Rgba* colors) const {
    const bool has_ground = cast_.task.ground.heights != nullptr;
    std::array<GroundHit, kTilePixels> hits;
    const auto limit = [&](int n) {
      GroundHit& hit = hits[static_cast<std::size_t>(n)];
      hit = cast_.task.groundAt(pixels[n].x, pixels[n].y);
      return hit.found ? static_cast<float>(hit.distance) : GroundLayer::kNone;
    };
    const long long samples = castVolume(pixels, count, has_ground, limit, colors);
    for (int n = 0; has_ground && n < count; ++n) {
      const GroundHit& hit = hits[static_cast<std::size_t>(n)];
      if (!hit.found) continue;
      const bool is_mapped = cast_.task.map.on && hit.is_surface;
      colors[n] =
          over(colors[n], is_mapped ? map_(cast_.task, pixels[n], static_cast<float>(hit.distance), hit.color)
                                    : hit.color);
    }
    return samples;
  }

  /// The colour of a pixel whose volume has the colour `front`. Its ground must be known.
  Rgba withGround(const Rgba& front, Pixel pixel) const {
    GroundLayer& ground = *cast_.ground;
    const std::size_t index = ground.index(pixel.x, pixel.y);
    if (!(ground.distances[index] < GroundLayer::kNone)) return front;
    if (!cast_.task.map.on || ground.is_surface[index] == 0) return over(front, ground.colors[index]);
    if (ground.is_mapped[index] == 0) {
      ground.mapped[index] = map_(cast_.task, pixel, ground.distances[index], ground.colors[index]);
      ground.is_mapped[index] = 1;
    }
    return over(front, ground.mapped[index]);
  }

 private:
  /// The volume and the sections in front of the ground.
  /// @param limit  limit(n): distance of the ground in pixel n
  template <class Limit>
  long long castVolume(const Pixel* pixels, int count, bool has_ground, const Limit& limit,
                       Rgba* colors) const {
    std::array<CutRay, kTilePixels> cut;
    std::array<RayBounds, kTilePixels> bounds;
    const bool cuts = cast_.task.cut.count > 0;
    const bool bounded = cuts || has_ground;
    for (int n = 0; bounded && n < count; ++n) {
      const auto i = static_cast<std::size_t>(n);
      bounds[i] = {};
      if (has_ground) bounds[i].end = limit(n);
      if (!cuts) continue;
      cut[i] = cut_(cast_.task, pixels[n], bounds[i].end);
      bounds[i] = cut[i].bounds;
    }
    const RayBounds* bound = bounded ? bounds.data() : nullptr;
    long long samples = 0;
    if (in_packets_) {
      samples = castPackets(cast_.task, cast_.mode, pixels, bound, count, colors);
    } else {
      plain_(cast_.task, pixels, bound, count, colors);
    }
    for (int n = 0; cuts && n < count; ++n)
      colors[n] = over(colors[n], cut[static_cast<std::size_t>(n)].section);
    return samples;
  }

  float groundLimit(Pixel pixel) const {
    const std::size_t index = cast_.ground->index(pixel.x, pixel.y);
    float& distance = cast_.ground->distances[index];
    if (distance == GroundLayer::kUnknown) {
      const GroundHit hit = cast_.task.groundAt(pixel.x, pixel.y);
      distance = hit.found ? static_cast<float>(hit.distance) : GroundLayer::kNone;
      if (hit.found) cast_.ground->colors[index] = hit.color;
      cast_.ground->is_surface[index] = hit.is_surface ? 1 : 0;
    }
    return distance;
  }

  const CpuCast& cast_;
  const bool in_packets_;
  const CastPlain plain_;
  const CutPixel cut_;
  const MapPixel map_;
};

}  // namespace

bool castCpu(const CpuCast& cast, const Lattice& lattice, Image& image, const StopFlag* stop,
             long long& samples) {
  const GroupCaster cast_group(cast);
  const int tile_columns = (lattice.columns + kTile - 1) / kTile;
  const int tile_rows = (lattice.rows + kTile - 1) / kTile;
  std::atomic<long long> taken{0};
  parallelFor(tile_columns * tile_rows, 1, [&](int begin, int end) {
    std::array<Pixel, kTilePixels> pixels;
    for (int tile = begin; tile < end && !isSet(stop); ++tile) {
      const int first_column = tile % tile_columns * kTile;
      const int first_row = tile / tile_columns * kTile;
      int count = 0;
      for (const Pixel& place : kZOrder) {
        const int column = first_column + place.x;
        const int row = first_row + place.y;
        if (column >= lattice.columns || row >= lattice.rows) continue;
        pixels[static_cast<std::size_t>(count++)] = {
            static_cast<std::uint16_t>(lattice.first_x + column * lattice.step_x),
            static_cast<std::uint16_t>(lattice.first_y + row * lattice.step_y)};
      }
      taken += cast_group(pixels.data(), count, image);
    }
  });
  samples += taken;
  return !isSet(stop);
}

bool castCpu(const CpuCast& cast, const std::vector<Pixel>& pixels, Image& image, const StopFlag* stop,
             long long& samples) {
  const GroupCaster cast_group(cast);
  const int count = static_cast<int>(pixels.size());
  std::atomic<long long> taken{0};
  parallelFor((count + kTilePixels - 1) / kTilePixels, 1, [&](int begin, int end) {
    for (int group = begin; group < end && !isSet(stop); ++group) {
      const int first = group * kTilePixels;
      taken +=
          cast_group(&pixels[static_cast<std::size_t>(first)], std::min(kTilePixels, count - first), image);
    }
  });
  samples += taken;
  return !isSet(stop);
}

bool castEdges(const CpuCast& cast, const std::vector<Pixel>& pixels, Image& image, const StopFlag* stop,
               long long& samples) {
  std::vector<RaycastTask> tasks(kEdgeRays, cast.task);
  std::vector<GroupCaster> casters;
  std::vector<CpuCast> casts;
  for (int ray = 0; ray < kEdgeRays; ++ray) {
    RaycastTask& task = tasks[static_cast<std::size_t>(ray)];
    task.camera = edgeCamera(task.camera, ray);
    casts.push_back({task, cast.mode, cast.nearest, cast.plain});
  }
  for (const CpuCast& of_ray : casts) casters.emplace_back(of_ray);
  const int count = static_cast<int>(pixels.size());
  std::vector<Rgba> means(pixels.size());
  std::atomic<long long> taken{0};
  parallelFor((count + kTilePixels - 1) / kTilePixels, 1, [&](int begin, int end) {
    std::array<Rgba, kTilePixels> colors;
    for (int group = begin; group < end && !isSet(stop); ++group) {
      const auto first = static_cast<std::size_t>(group) * kTilePixels;
      const int in_group = std::min(kTilePixels, count - static_cast<int>(first));
      for (const GroupCaster& caster : casters) {
        taken += caster.castApart(&pixels[first], in_group, colors.data());
        for (std::size_t n = 0; n < static_cast<std::size_t>(in_group); ++n)
          means[first + n] = addScaled(colors[n], 1.0F / kEdgeRays, means[first + n]);
      }
    }
  });
  samples += taken;
  if (isSet(stop)) return false;
  for (std::size_t n = 0; n < pixels.size(); ++n) image.at(pixels[n].x, pixels[n].y) = means[n];
  return true;
}

void composeGround(const CpuCast& cast, const Image& volume, Image& picture) {
  constexpr int kRowGrain = 16;
  const GroupCaster group(cast);
  parallelFor(picture.size.height, kRowGrain, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      for (int x = 0; x < picture.size.width; ++x) {
        picture.at(x, y) =
            group.withGround(volume.at(x, y), {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)});
      }
    }
  });
}

}  // namespace emscape::render
