#include <png.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "base/files/whole_file.h"
#include "emscape/base/error.h"
#include "render/cast/rgba.h"

namespace emscape::render {
namespace {

/// PNG requires colours that are not premultiplied.
std::vector<std::uint8_t> straightAlpha(const Image8& image) {
  std::vector<std::uint8_t> straight(image.rgba);
  for (std::size_t i = 0; i < straight.size(); i += 4) {
    const int alpha = straight[i + 3];
    if (alpha == 0 || alpha == 255) continue;
    for (std::size_t c = i; c < i + 3; ++c) {
      straight[c] = static_cast<std::uint8_t>(std::min(255, (straight[c] * 255 + alpha / 2) / alpha));
    }
  }
  return straight;
}

std::vector<std::uint8_t> withoutAlpha(const Image8& image) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(image.rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    rgb.insert(rgb.end(), image.rgba.begin() + static_cast<std::ptrdiff_t>(i),
               image.rgba.begin() + static_cast<std::ptrdiff_t>(i) + 3);
  }
  return rgb;
}

bool isOpaque(const Image8& image) {
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
    if (image.rgba[i] != 255) return false;
  }
  return true;
}

}  // namespace

ImageSize parseImageSize(const std::string& text) {
  int width = 0;
  int height = 0;
  int used = 0;
  const bool whole = std::sscanf(text.c_str(), "%6dx%6d%n", &width, &height, &used) == 2 &&
                     static_cast<std::size_t>(used) == text.size();
  if (!whole || width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide) {
    throw Error(ErrorCode::usage, "image size '" + text + "': expected WIDTHxHEIGHT, each 1.." +
                                      std::to_string(kMaxImageSide) + " pixels, for example 1200x900");
  }
  return {width, height};
}

Image8 quantize(const Image& image) {
  Image8 result;
  result.size = image.size;
  result.rgba.resize(image.pixels.size() * 4);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const Rgba& pixel = image.pixels[i];
    result.rgba[4 * i] = quantized(pixel.r);
    result.rgba[4 * i + 1] = quantized(pixel.g);
    result.rgba[4 * i + 2] = quantized(pixel.b);
    result.rgba[4 * i + 3] = quantized(pixel.a);
  }
  return result;
}

std::string encodePng(const Image8& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.size.width);
  png.height = static_cast<png_uint_32>(image.size.height);
  const bool opaque = isOpaque(image);
  png.format = opaque ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  png.flags = PNG_IMAGE_FLAG_FAST;
  const std::vector<std::uint8_t> pixels = opaque ? withoutAlpha(image) : straightAlpha(image);
  png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string encoded(bytes, '\0');
  if (png_image_write_to_memory(&png, encoded.data(), &bytes, 0, pixels.data(), 0, nullptr) == 0) {
    throw Error(ErrorCode::other, std::string("cannot encode a picture: ") + png.message);
  }
  encoded.resize(bytes);
  return encoded;
}

void writePng(const std::string& file, const Image8& image) {
  const std::string encoded = encodePng(image);
  writeWhole(file, [&](std::ostream& out) { out << encoded; });
}

Image8 readPng(const std::string& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&png, file.c_str()) == 0) {
    throw Error(ErrorCode::bad_input, "cannot read picture '" + file + "': " + png.message);
  }
  png.format = PNG_FORMAT_RGBA;
  Image8 image;
  image.size = {static_cast<int>(png.width), static_cast<int>(png.height)};
  image.rgba.resize(PNG_IMAGE_SIZE(png));
  if (png_image_finish_read(&png, nullptr, image.rgba.data(), 0, nullptr) == 0) {
    throw Error(ErrorCode::bad_input, "cannot read picture '" + file + "': " + png.message);
  }
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    for (std::size_t c = i; c < i + 3; ++c) {
      image.rgba[c] = static_cast<std::uint8_t>((image.rgba[c] * image.rgba[i + 3] + 127) / 255);
    }
  }
  return image;
}

ImageDifference compare(const Image8& image, const Image8& reference) {
  if (image.size != reference.size) {
    throw Error(ErrorCode::bad_input,
                "pictures of different sizes cannot be compared: " + std::to_string(image.size.width) + "x" +
                    std::to_string(image.size.height) + " and " + std::to_string(reference.size.width) + "x" +
                    std::to_string(reference.size.height));
  }
  ImageDifference difference;
  std::array<double, 4> sum{};
  double squares = 0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    bool erroneous = false;
    bool nonzero = false;
    for (std::size_t c = 0; c < 4; ++c) {
      const int error = std::abs(int{image.rgba[i + c]} - int{reference.rgba[i + c]});
      erroneous |= error != 0;
      nonzero |= reference.rgba[i + c] != 0;
      difference.max[c] = std::max(difference.max[c], error);
      sum[c] += error;
      squares += static_cast<double>(error) * error;
    }
    difference.erroneous += erroneous ? 1 : 0;
    difference.nonzero += nonzero ? 1 : 0;
  }
  const double channels = static_cast<double>(image.rgba.size());
  for (std::size_t c = 0; c < 4; ++c) {
    if (difference.erroneous > 0) difference.mean[c] = sum[c] / static_cast<double>(difference.erroneous);
    if (channels > 0) difference.mean_all += sum[c] / channels;
  }
  if (difference.nonzero > 0) {
    difference.ratio_percent =
        100.0 * static_cast<double>(difference.erroneous) / static_cast<double>(difference.nonzero);
  }
  difference.psnr_db = squares > 0 ? 10.0 * std::log10(255.0 * 255.0 * channels / squares)
                                   : std::numeric_limits<double>::infinity();
  return difference;
}

}  // namespace emscape::render
