/// The ground below a volume, as input of the renderer.
#pragma once

#include <cstdint>
#include <vector>

namespace emscape::render {

/// What is at a post.
enum class GroundKind : std::uint8_t { land, water };

/// Heights at the posts of a regular grid, bilinear between them, in the volume's frame (m): x east, y north,
/// heights in the frame's z. Post (i, j) is at (first_x_m + i * spacing_x_m, first_y_m + j * spacing_y_m).
/// NaN marks a hole: unknown ground is drawn as a hatched pit, never as a plane. The ground is drawn inside
/// the volume's box; edge posts are valid for one spacing beyond.
struct HeightField {
  int columns = 0;  ///< >= 2
  int rows = 0;     ///< >= 2
  double first_x_m = 0, first_y_m = 0;
  double spacing_x_m = 0, spacing_y_m = 0;  ///< > 0
  std::vector<float> heights_m;             ///< columns * rows, x fastest, then y
  std::vector<GroundKind> kinds;            ///< of the posts; empty: land everywhere
  /// Colours of a picture that lies on the ground, 0xAABBGGRR per post; empty: none.
  std::vector<std::uint32_t> colors;
  bool light = false;  ///< true: for pictures on a light background
};

/// Height of the ground (frame z, m) at a position, bilinear between posts; NaN over a hole.
double heightAt_m(const HeightField& ground, double x_m, double y_m);

}  // namespace emscape::render
