/// Pictures: premultiplied RGBA in float (cast) and in 8 bits (displayed), PNG files, and the difference of
/// two pictures.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "emscape/base/host_device.h"

namespace emscape::render {

/// A colour with its coverage, premultiplied: r, g, b <= a. Components are sRGB-encoded, 0..1; compositing is
/// linear in them, as is usual in volume renderers whose transfer functions are given in screen colours.
struct Rgba {
  float r = 0, g = 0, b = 0, a = 0;
};
inline bool operator==(const Rgba& p, const Rgba& q) {
  return p.r == q.r && p.g == q.g && p.b == q.b && p.a == q.a;
}

/// Width and height in pixels. Pixel (x, y): x to the right, y down, from 0.
struct ImageSize {
  int width = 0, height = 0;

  EMSCAPE_HD long long count() const { return static_cast<long long>(width) * height; }
  EMSCAPE_HD bool operator==(const ImageSize& o) const { return width == o.width && height == o.height; }
  EMSCAPE_HD bool operator!=(const ImageSize& o) const { return !(*this == o); }
};

/// Longest side of a picture (pixels): the limit of cairo, which draws texts.
constexpr int kMaxImageSide = 32767;

/// Parses "WxH". @throws Error (usage) unless both are 1..kMaxImageSide
ImageSize parseImageSize(const std::string& text);

/// A cast picture.
struct Image {
  ImageSize size;
  std::vector<Rgba> pixels;  ///< rows from the top; size.count() of them

  Image() = default;
  explicit Image(ImageSize image_size)
      : size(image_size), pixels(static_cast<std::size_t>(image_size.count())) {}
  Rgba& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * size.width + x]; }
  const Rgba& at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * size.width + x]; }
};

/// A picture with 8 bits per channel, r g b a, premultiplied.
struct Image8 {
  ImageSize size;
  std::vector<std::uint8_t> rgba;  ///< rows from the top; 4 * size.count() bytes

  const std::uint8_t* at(int x, int y) const {
    return &rgba[4 * (static_cast<std::size_t>(y) * size.width + x)];
  }
};

/// Quantises a picture: the only step at which it loses precision.
Image8 quantize(const Image& image);

/// A picture as the bytes of a PNG file (8 bit; RGB if every pixel is opaque, else RGBA).
/// @throws Error (other)
std::string encodePng(const Image8& image);
/// Writes a PNG (8 bit; RGB if every pixel is opaque, else RGBA). The file is written atomically.
/// @throws Error (other) naming the file
void writePng(const std::string& file, const Image8& image);
/// Reads a PNG as 8 bit RGBA. @throws Error (bad_input) naming the file
Image8 readPng(const std::string& file);

/// Difference of a picture from a reference, as in the tables of Feng et al. 2016.
struct ImageDifference {
  std::array<int, 4> max{};      ///< largest |difference| of r, g, b, a, in levels of 255
  std::array<double, 4> mean{};  ///< sum of |differences| / number of erroneous pixels; 0 if there are none
  long long erroneous = 0;       ///< pixels in which any channel differs
  long long nonzero = 0;         ///< pixels of the reference that are not all zero
  double ratio_percent = 0;      ///< erroneous / nonzero
  double mean_all = 0;           ///< mean over all pixels and channels, in levels
  double psnr_db = 0;            ///< over all pixels and channels; infinity if equal
};
/// @throws Error (bad_input) if the sizes differ
ImageDifference compare(const Image8& image, const Image8& reference);

}  // namespace emscape::render
