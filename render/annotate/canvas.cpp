#include "render/annotate/canvas.h"

#include <cairo-svg.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "base/large_array.h"
#include "base/memory.h"
#include "base/text/utf8.h"
#include "emscape/base/error.h"
#include "emscape/base/parallel.h"
#include "emscape/base/units.h"
#include "emscape/base/work.h"
#include "render/annotate/text_setter.h"
#include "render/picture/bytes_over.h"

namespace emscape::render {
namespace {

constexpr int kRowsAtOnce = 32;

/// Left end of the baseline of a text that is aligned to (0, 0): half the height of capitals lower, so that
/// it is centred there.
Point2 beginOf(const std::string& text, double size_px, Weight weight, Align align) {
  constexpr double kBaseline = 0.36;
  const double shift = align == Align::left ? 0.0 : (align == Align::center ? 0.5 : 1.0);
  return {shift > 0 ? -shift * lineWidth(text, size_px, weight) : 0.0, kBaseline * size_px};
}

/// @throws Error for a picture beyond Cairo's limit, or with its encoded copies beyond the memory
std::shared_ptr<std::vector<std::uint32_t>> noPixels(ImageSize size) {
  constexpr int kMaxSide = 32767;
  constexpr std::size_t kBytesPerPixel = 12;
  const std::string what =
      "a picture of " + std::to_string(size.width) + "x" + std::to_string(size.height) + " pixels";
  if (std::max(size.width, size.height) > kMaxSide) {
    throw Error(ErrorCode::usage,
                what + " is larger than the largest, " + std::to_string(kMaxSide) + " pixels along a side");
  }
  requireMemory({what, static_cast<std::size_t>(size.count()) * kBytesPerPixel, "a smaller one takes less"},
                {});
  auto pixels = std::make_shared<std::vector<std::uint32_t>>();
  resizeInParts(*pixels, static_cast<std::size_t>(size.count()));
  return pixels;
}

cairo_status_t append(void* text, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

double length(const Point2& a) {
  return std::hypot(a.x, a.y);
}

bool overlap(const Rect& a, const Rect& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

Canvas::Canvas(ImageSize size)
    : Canvas([&] {
        struct Held {
          std::shared_ptr<std::vector<std::uint32_t>> pixels;
          std::shared_ptr<cairo_surface_t> surface;  // is destroyed first
        };
        const auto pixels = noPixels(size);
        Canvas canvas(size, pixels->data());
        const auto held = std::make_shared<Held>(Held{pixels, canvas.surface_});
        canvas.surface_ = std::shared_ptr<cairo_surface_t>(held, held->surface.get());
        return canvas;
      }()) {}

Canvas::Canvas(ImageSize size, std::uint32_t* pixels)
    : Canvas(size, cairo_image_surface_create_for_data(reinterpret_cast<unsigned char*>(pixels),
                                                       CAIRO_FORMAT_ARGB32, size.width, size.height,
                                                       size.width * static_cast<int>(sizeof *pixels))) {}

Canvas Canvas::forSvg(ImageSize size) {
  auto text = std::make_shared<std::string>();
  Canvas canvas(size, cairo_svg_surface_create_for_stream(append, text.get(), size.width, size.height));
  canvas.svg_ = std::move(text);
  return canvas;
}

Canvas::Canvas(ImageSize size, cairo_surface_t* surface)
    : size_(size),
      surface_(surface, cairo_surface_destroy),
      cairo_(cairo_create(surface_.get()), cairo_destroy) {
  if (cairo_status(cairo_.get()) != CAIRO_STATUS_SUCCESS) {
    throw Error(ErrorCode::other, "cannot draw a picture of " + std::to_string(size.width) + "x" +
                                      std::to_string(size.height) +
                                      " pixels: " + cairo_status_to_string(cairo_status(cairo_.get())));
  }
  cairo_set_line_cap(cairo_.get(), CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(cairo_.get(), CAIRO_LINE_JOIN_ROUND);
}

std::string Canvas::svg() {
  cairo_surface_finish(surface_.get());
  return *svg_;
}

Image8 Canvas::pixels() const {
  cairo_surface_flush(surface_.get());
  const unsigned char* data = cairo_image_surface_get_data(surface_.get());
  const int stride = cairo_image_surface_get_stride(surface_.get());
  Image8 image;
  image.size = size_;
  resizeInParts(image.rgba, static_cast<std::size_t>(size_.count()) * 4);
  parallelFor(size_.height, kRowsAtOnce, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const auto* row =
          reinterpret_cast<const std::uint32_t*>(data + static_cast<std::ptrdiff_t>(y) * stride);
      std::uint8_t* out = &image.rgba[static_cast<std::size_t>(y) * size_.width * 4];
      for (int x = 0; x < size_.width; ++x) {
        const std::uint32_t rgba = redAndBlueSwapped(row[x]);
        std::memcpy(out + 4 * x, &rgba, 4);
      }
    }
  });
  return image;
}

void Canvas::changeRows(const std::function<void(int y, std::uint32_t* row)>& change) {
  cairo_surface_flush(surface_.get());
  unsigned char* data = cairo_image_surface_get_data(surface_.get());
  const int stride = cairo_image_surface_get_stride(surface_.get());
  parallelFor(size_.height, kRowsAtOnce, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      change(y, reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(y) * stride));
    }
  });
  cairo_surface_mark_dirty(surface_.get());
}

void Canvas::setInk(const Ink& ink) const {
  checkpoint();
  cairo_set_source_rgba(cairo_.get(), ink.color.r, ink.color.g, ink.color.b, ink.alpha);
}

void Canvas::path(const std::vector<Point2>& points, bool closed) const {
  cairo_new_path(cairo_.get());
  for (const Point2& point : points) cairo_line_to(cairo_.get(), point.x, point.y);
  if (closed) cairo_close_path(cairo_.get());
}

void Canvas::line(const Point2& from, const Point2& to, const Ink& ink, double width, bool dashed) {
  outline({from, to}, ink, width, false, dashed);
}

void Canvas::polygon(const std::vector<Point2>& points, const Ink& ink) {
  setInk(ink);
  path(points, true);
  cairo_fill(cairo_.get());
}

void Canvas::outside(const std::vector<Point2>& polygon, const Rect& rect, const Ink& ink) {
  cairo_save(cairo_.get());
  cairo_new_path(cairo_.get());
  cairo_rectangle(cairo_.get(), rect.x, rect.y, rect.width, rect.height);
  cairo_clip(cairo_.get());
  setInk(ink);
  path(polygon, true);
  cairo_rectangle(cairo_.get(), rect.x, rect.y, rect.width, rect.height);
  cairo_set_fill_rule(cairo_.get(), CAIRO_FILL_RULE_EVEN_ODD);
  cairo_fill(cairo_.get());
  cairo_restore(cairo_.get());
}

void Canvas::outline(const std::vector<Point2>& points, const Ink& ink, double width, bool closed,
                     bool dashed) {
  setInk(ink);
  cairo_set_line_width(cairo_.get(), width);
  const double dash = 3 * width;
  cairo_set_dash(cairo_.get(), &dash, dashed ? 1 : 0, 0);
  path(points, closed);
  cairo_stroke(cairo_.get());
  cairo_set_dash(cairo_.get(), nullptr, 0, 0);
}

void Canvas::disc(const Point2& center, double radius, const Ink& ink) {
  setInk(ink);
  cairo_new_path(cairo_.get());
  cairo_arc(cairo_.get(), center.x, center.y, radius, 0, 2 * kPi);
  cairo_fill(cairo_.get());
}

void Canvas::circle(const Point2& center, double radius, const Ink& ink, double width) {
  arc(center, radius, 0, 2 * kPi, ink, width);
}

void Canvas::arc(const Point2& center, double radius, double begin_rad, double end_rad, const Ink& ink,
                 double width) {
  setInk(ink);
  cairo_set_line_width(cairo_.get(), width);
  cairo_new_path(cairo_.get());
  cairo_arc(cairo_.get(), center.x, center.y, radius, begin_rad, end_rad);
  cairo_stroke(cairo_.get());
}

void Canvas::rectangle(const Rect& rect, const Ink& ink, double corner_radius) {
  setInk(ink);
  cairo_new_path(cairo_.get());
  if (corner_radius <= 0) {
    cairo_rectangle(cairo_.get(), rect.x, rect.y, rect.width, rect.height);
  } else {
    const double r = corner_radius;
    cairo_arc(cairo_.get(), rect.x + r, rect.y + r, r, kPi, 1.5 * kPi);
    cairo_arc(cairo_.get(), rect.x + rect.width - r, rect.y + r, r, 1.5 * kPi, 2 * kPi);
    cairo_arc(cairo_.get(), rect.x + rect.width - r, rect.y + rect.height - r, r, 0, 0.5 * kPi);
    cairo_arc(cairo_.get(), rect.x + r, rect.y + rect.height - r, r, 0.5 * kPi, kPi);
    cairo_close_path(cairo_.get());
  }
  cairo_fill(cairo_.get());
}

void Canvas::gradient(const Rgb& top, const Rgb& bottom) {
  const std::unique_ptr<cairo_pattern_t, void (*)(cairo_pattern_t*)> pattern(
      cairo_pattern_create_linear(0, 0, 0, size_.height), cairo_pattern_destroy);
  cairo_pattern_add_color_stop_rgb(pattern.get(), 0, top.r, top.g, top.b);
  cairo_pattern_add_color_stop_rgb(pattern.get(), 1, bottom.r, bottom.g, bottom.b);
  cairo_set_source(cairo_.get(), pattern.get());
  cairo_paint(cairo_.get());
}

Rect Canvas::textBox(const std::string& text, double size_px, Weight weight) const {
  return {0, 0, lineWidth(text, size_px, weight), 1.2 * size_px};
}

void Canvas::turnTo(const Point2& at, double angle_rad) const {
  cairo_new_path(cairo_.get());
  cairo_translate(cairo_.get(), at.x, at.y);
  cairo_rotate(cairo_.get(), angle_rad);
}

void Canvas::text(const std::string& text, const Point2& at, double size_px, const Ink& ink, Align align,
                  Weight weight, double angle_rad) {
  setInk(ink);
  cairo_save(cairo_.get());
  turnTo(at, angle_rad);
  fillLine(cairo_.get(), text, size_px, weight, beginOf(text, size_px, weight, align));
  cairo_restore(cairo_.get());
}

void Canvas::textWithRim(const std::string& words, const Point2& at, double size_px, const Ink& ink,
                         const Ink& rim, Align align, Weight weight, double angle_rad) {
  setInk(rim);
  cairo_set_line_width(cairo_.get(), 0.22 * size_px);
  cairo_save(cairo_.get());
  turnTo(at, angle_rad);
  addLineToPath(cairo_.get(), words, size_px, weight, beginOf(words, size_px, weight, align));
  cairo_stroke(cairo_.get());
  cairo_restore(cairo_.get());
  text(words, at, size_px, ink, align, weight, angle_rad);
}

std::string shortenedText(const Canvas& canvas, const std::string& text, double size_px, double width_px,
                          Weight weight) {
  const auto fits = [&](const std::string& some) {
    return canvas.textBox(some, size_px, weight).width <= width_px;
  };
  if (text.empty() || fits(text)) return text;
  std::vector<std::string> shorter{"…"};
  for (std::size_t end = 0; end < text.size();) {
    end += std::max<std::size_t>(1, utf8SequenceLength(std::string_view(text).substr(end)));
    shorter.push_back(text.substr(0, end) + "…");
  }
  const auto first_too_long = std::partition_point(shorter.begin() + 1, shorter.end(), fits);
  return *(first_too_long - 1);
}

}  // namespace emscape::render
