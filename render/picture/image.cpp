#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <new>
#include <utility>

#include "base/files/whole_file.h"
#include "base/large_array.h"
#include "emscape/base/error.h"
#include "emscape/base/work.h"
#include "render/cast/rgba.h"

namespace emscape::render {
namespace {

/// A row without premultiplication, as PNG requires.
void setStraightRow(const std::uint8_t* from, int width, std::uint8_t* to) {
  for (int x = 0; x < width; ++x, from += 4, to += 4) {
    const int alpha = from[3];
    for (int c = 0; c < 3; ++c) {
      to[c] = alpha == 0 || alpha == 255
                  ? from[c]
                  : static_cast<std::uint8_t>(std::min(255, (from[c] * 255 + alpha / 2) / alpha));
    }
    to[3] = from[3];
  }
}

void setOpaqueRow(const std::uint8_t* from, int width, std::uint8_t* to) {
  for (int x = 0; x < width; ++x, from += 4, to += 3) std::copy_n(from, 3, to);
}

bool isOpaque(const Image8& image) {
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
    if (image.rgba[i] != 255) return false;
  }
  return true;
}

/// Encodes a PNG file in memory, row by row, with little compression.
class PngEncoder {
 public:
  PngEncoder(ImageSize size, bool has_alpha) {
    png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, onFault, [](png_structp, const char*) {});
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_write_struct(&png_, nullptr);
      throw std::bad_alloc();
    }
    run([&] {
      png_set_write_fn(png_, this, append, nullptr);
      png_set_IHDR(png_, info_, static_cast<png_uint_32>(size.width), static_cast<png_uint_32>(size.height),
                   8, has_alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                   PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
      png_set_sRGB(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL);
      png_text software{};  // tells our files from others; see report/maps/output_files.h
      software.compression = PNG_TEXT_COMPRESSION_NONE;
      software.key = const_cast<char*>("Software");
      software.text = const_cast<char*>("Emscape");
      png_set_text(png_, info_, &software, 1);
      png_write_info(png_, info_);
      png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_NO_FILTERS);
      constexpr int kFast = 3;
      png_set_compression_level(png_, kFast);
    });
  }
  ~PngEncoder() { png_destroy_write_struct(&png_, &info_); }
  PngEncoder(const PngEncoder&) = delete;
  PngEncoder& operator=(const PngEncoder&) = delete;

  void addRow(const std::uint8_t* row) {
    run([&] { png_write_row(png_, row); });
  }
  std::string finish() {
    run([&] { png_write_end(png_, nullptr); });
    return std::move(encoded_);
  }

 private:
  /// @param calls  of libpng, from which a fault jumps back: no objects with destructors
  template <class Calls>
  void run(const Calls& calls) {
    if (setjmp(png_jmpbuf(png_)) == 0) return calls();
    throw Error(ErrorCode::other, "cannot encode a picture: " + fault_);
  }
  static void onFault(png_structp png, const char* message) {
    static_cast<PngEncoder*>(png_get_error_ptr(png))->setFault(message);
    png_longjmp(png, 1);
  }
  static void append(png_structp png, png_bytep bytes, std::size_t count) {
    if (!static_cast<PngEncoder*>(png_get_io_ptr(png))->add(bytes, count)) png_error(png, "out of memory");
  }
  void setFault(const char* message) noexcept {
    try {
      fault_ = message;
    } catch (const std::bad_alloc&) {
    }
  }
  bool add(const png_byte* bytes, std::size_t count) noexcept {
    try {
      encoded_.append(reinterpret_cast<const char*>(bytes), count);
      return true;
    } catch (const std::bad_alloc&) {
      return false;
    }
  }

  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  std::string encoded_, fault_;
};

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
  resizeInParts(result.rgba, image.pixels.size() * 4);
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
  const bool opaque = isOpaque(image);
  PngEncoder encoder(image.size, !opaque);
  std::vector<std::uint8_t> row(static_cast<std::size_t>(image.size.width) * 4);
  for (int y = 0; y < image.size.height; ++y) {
    checkpoint();
    (opaque ? setOpaqueRow : setStraightRow)(image.at(0, y), image.size.width, row.data());
    encoder.addRow(row.data());
  }
  return encoder.finish();
}

void writePng(const std::string& file, const Image8& image) {
  const WorkPart part("writing " + std::filesystem::path(file).filename().string(), 0, 0);
  const std::string encoded = encodePng(image);
  writeWhole(
      file, [&](std::ostream& out) { out << encoded; }, Replaces::any);
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
