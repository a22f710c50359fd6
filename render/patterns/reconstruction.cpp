#include "render/patterns/reconstruction.h"

#include "base/math/simd.h"
#include "emscape/base/parallel.h"
#include "render/patterns/interpolation.h"

namespace emscape::render {
namespace {

constexpr int kFillGrain = 16;

Lattice lattice(ImageSize size, int first_x, int first_y, int step_x, int step_y) {
  return {first_x,
          first_y,
          step_x,
          step_y,
          (size.width - first_x + step_x - 1) / step_x,
          (size.height - first_y + step_y - 1) / step_y};
}

std::vector<Lattice> withoutEmpty(const std::vector<Lattice>& lattices) {
  std::vector<Lattice> kept;
  for (const Lattice& l : lattices) {
    if (l.columns > 0 && l.rows > 0) kept.push_back(l);
  }
  return kept;
}

/// Bits8Arithmetic in floats, channel by channel, for vectorisation.
struct Bits8Channels {
  static float mean(float a, float b) {
    return static_cast<float>((quantized(a) + quantized(b) + 1) / 2) / 255.0F;
  }
  static Rgba mean(const Rgba& p, const Rgba& q) {
    return {mean(p.r, q.r), mean(p.g, q.g), mean(p.b, q.b), mean(p.a, q.a)};
  }
};

/// Fills every second pixel of a row from its left and right neighbours, starting at first_x (0 or 1).
template <class Arithmetic>
void fillRow(Rgba* row, int width, int first_x) {
  if (width == 1) return;
  if (first_x == 0) row[0] = Arithmetic::mean(row[1], row[1]);
  int x = first_x == 0 ? 2 : 1;
  for (; x + 1 < width; x += 2) row[x] = Arithmetic::mean(row[x - 1], row[x + 1]);
  if (x < width) row[x] = Arithmetic::mean(row[x - 1], row[x - 1]);
}

/// Fills every second pixel of an odd row, from the left one on, from the rows above and below.
template <class Arithmetic>
void fillFromRowsBeside(Image& image, int y) {
  const int width = image.size.width;
  Rgba* row = &image.at(0, y);
  const Rgba* above = row - width;
  const Rgba* below = y + 1 < image.size.height ? row + width : above;
  for (int x = 0; x < width; x += 2) row[x] = Arithmetic::mean(above[x], below[x]);
}

/// Fills some rows. Neighbouring rows may be filled at the same time: of other rows only source pixels
/// are read.
template <class Arithmetic>
void fillRows(Pattern pattern, Image& image, int begin, int end) {
  const int width = image.size.width;
  for (int y = begin; y < end; ++y) {
    const bool odd_row = y % 2 == 1;
    // A checkerboard's odd row may consist of a single missing pixel, with neighbours only above and below.
    const bool single = pattern == Pattern::checkerboard && width == 1;
    if (odd_row && (pattern == Pattern::quarter || single)) fillFromRowsBeside<Arithmetic>(image, y);
    fillRow<Arithmetic>(&image.at(0, y), width, odd_row && pattern == Pattern::checkerboard ? 0 : 1);
  }
}

EMSCAPE_SIMD_CLONES void fillRowsFloat(Pattern pattern, Image& image, int begin, int end) {
  fillRows<FloatArithmetic>(pattern, image, begin, end);
}
EMSCAPE_SIMD_CLONES void fillRows8(Pattern pattern, Image& image, int begin, int end) {
  fillRows<Bits8Channels>(pattern, image, begin, end);
}

}  // namespace

Pattern parsePattern(const std::string& name) {
  return parseName<Pattern>("ray pattern", name);
}

const std::vector<Pattern>& allPatterns() {
  static const std::vector<Pattern> patterns{Pattern::full, Pattern::columns, Pattern::checkerboard,
                                             Pattern::quarter, Pattern::adaptive};
  return patterns;
}

Interpolation parseInterpolation(const std::string& name) {
  return parseName<Interpolation>("interpolation", name);
}

std::vector<Lattice> sourceLattices(Pattern pattern, ImageSize size) {
  switch (pattern) {
    case Pattern::full:
      return withoutEmpty({lattice(size, 0, 0, 1, 1)});
    case Pattern::columns:
      return withoutEmpty({lattice(size, 0, 0, 2, 1)});
    case Pattern::checkerboard:
      return withoutEmpty({lattice(size, 0, 0, 2, 2), lattice(size, 1, 1, 2, 2)});
    case Pattern::quarter:
      return withoutEmpty({lattice(size, 0, 0, 2, 2)});
    case Pattern::adaptive:
      break;
  }
  return {};
}

std::vector<Lattice> missingLattices(Pattern pattern, ImageSize size) {
  switch (pattern) {
    case Pattern::full:
      return {};
    case Pattern::columns:
      return withoutEmpty({lattice(size, 1, 0, 2, 1)});
    case Pattern::checkerboard:
      return withoutEmpty({lattice(size, 1, 0, 2, 2), lattice(size, 0, 1, 2, 2)});
    case Pattern::quarter:
      return withoutEmpty({lattice(size, 1, 0, 2, 2), lattice(size, 0, 1, 2, 2), lattice(size, 1, 1, 2, 2)});
    case Pattern::adaptive:
      break;
  }
  return {};
}

long long pixelCount(const std::vector<Lattice>& lattices) {
  long long count = 0;
  for (const Lattice& l : lattices) count += l.count();
  return count;
}

void interpolate(Pattern pattern, Interpolation interpolation, Image& image) {
  if (pattern == Pattern::full || pattern == Pattern::adaptive || image.size.count() == 0) return;
  const auto fill = interpolation == Interpolation::float32 ? fillRowsFloat : fillRows8;
  parallelFor(image.size.height, kFillGrain, [&](int begin, int end) { fill(pattern, image, begin, end); });
}

}  // namespace emscape::render
