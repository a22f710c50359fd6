/// Two renderers of one scene: one on the CPU, one on the GPU.
#pragma once

#include <random>

#include "emscape/render/scene/renderer.h"
#include "tests/render/random_scene.h"
#include "tests/support/gpu.h"

namespace emscape::render::testing {

inline RendererOptions onGpu() {
  return on(Backend::cuda);
}

/// The same random scene for both.
inline void setSameRandomScene(Renderer& cpu, Renderer& gpu, std::mt19937& random, ImageSize size) {
  std::mt19937 again = random;
  setRandomScene(cpu, random, size);
  setRandomScene(gpu, again, size);
}

/// Pixels of two pictures, and how many of them differ by more than a level of 255 in any channel.
struct Agreement {
  long long pixels = 0;
  long long apart = 0;
  int largest_levels = 0;

  void add(const Image8& p, const Image8& q) {
    for (std::size_t n = 0; n < p.rgba.size(); n += 4) {
      int largest = 0;
      for (std::size_t c = n; c < n + 4; ++c) {
        largest = std::max(largest, std::abs(int{p.rgba[c]} - int{q.rgba[c]}));
      }
      ++pixels;
      apart += largest > 1 ? 1 : 0;
      largest_levels = std::max(largest_levels, largest);
    }
  }
  void add(const Image& p, const Image& q) { add(quantize(p), quantize(q)); }
  double shareApart() const { return static_cast<double>(apart) / static_cast<double>(pixels); }
};

}  // namespace emscape::render::testing
