/// Drawing of lines, shapes and text on a picture: a thin wrapper of Cairo and Pango.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "emscape/render/picture/image.h"
#include "emscape/render/transfer/transfer_function.h"

struct _cairo;
struct _cairo_surface;

namespace emscape::render {

/// A point of a picture in pixels; (0, 0) is the upper left corner of the first pixel.
struct Point2 {
  double x = 0, y = 0;
};
inline Point2 operator+(const Point2& a, const Point2& b) {
  return {a.x + b.x, a.y + b.y};
}
inline Point2 operator-(const Point2& a, const Point2& b) {
  return {a.x - b.x, a.y - b.y};
}
inline Point2 operator*(const Point2& a, double s) {
  return {a.x * s, a.y * s};
}
double length(const Point2& a);

struct Rect {
  double x = 0, y = 0, width = 0, height = 0;
};
bool overlap(const Rect& a, const Rect& b);

/// A colour with opacity, not premultiplied.
struct Ink {
  Rgb color;
  double alpha = 1;
};

enum class Weight { normal, bold };
/// Alignment of a text's box relative to its point.
enum class Align { left, center, right };

/// An RGBA picture to draw on, initially transparent, or a vector drawing that is written as SVG.
class Canvas {
 public:
  explicit Canvas(ImageSize size);
  /// Draws on the caller's pixels: size.count() of them, 0xAARRGGBB, premultiplied, row by row. They are
  /// complete after the destruction of the canvas.
  Canvas(ImageSize size, std::uint32_t* pixels);
  static Canvas forSvg(ImageSize size);

  ImageSize size() const { return size_; }
  /// The pixels drawn so far, premultiplied.
  /// @pre not forSvg
  Image8 pixels() const;
  /// Changes pixels one by one.
  /// @param change  (y, row): row holds width() pixels 0xAARRGGBB, premultiplied; called for every row, on
  /// any thread
  /// @pre not forSvg
  void changeRows(const std::function<void(int y, std::uint32_t* row)>& change);
  /// The drawing as an SVG document. Nothing may be drawn after it.
  /// @pre forSvg
  std::string svg();

  void line(const Point2& from, const Point2& to, const Ink& ink, double width, bool dashed = false);
  void polygon(const std::vector<Point2>& points, const Ink& ink);
  void outline(const std::vector<Point2>& points, const Ink& ink, double width, bool closed,
               bool dashed = false);
  void disc(const Point2& center, double radius, const Ink& ink);
  void circle(const Point2& center, double radius, const Ink& ink, double width);
  void arc(const Point2& center, double radius, double begin_rad, double end_rad, const Ink& ink,
           double width);
  void rectangle(const Rect& rect, const Ink& ink, double corner_radius = 0);
  /// Fills the picture with a vertical gradient.
  void gradient(const Rgb& top, const Rgb& bottom);

  /// Size of a text in a font of `size_px` pixels; the height is that of the font, the same for every text.
  Rect textBox(const std::string& text, double size_px, Weight weight = Weight::normal) const;
  /// Draws a text whose box begins, ends or is centred at `at` horizontally and is centred there vertically.
  void text(const std::string& text, const Point2& at, double size_px, const Ink& ink,
            Align align = Align::left, Weight weight = Weight::normal, double angle_rad = 0);
  /// The same with an outline in another colour, readable on any background.
  void textWithRim(const std::string& text, const Point2& at, double size_px, const Ink& ink, const Ink& rim,
                   Align align = Align::left, Weight weight = Weight::normal, double angle_rad = 0);

 private:
  Canvas(ImageSize size, _cairo_surface* surface);
  void setInk(const Ink& ink) const;
  void path(const std::vector<Point2>& points, bool closed) const;
  /// Moves the origin to a point and turns the axes; call between save and restore.
  void turnTo(const Point2& at, double angle_rad) const;

  ImageSize size_;
  std::shared_ptr<std::string> svg_;  ///< output of the surface so far; null with pixels
  std::shared_ptr<_cairo_surface> surface_;
  std::shared_ptr<_cairo> cairo_;
};

/// The whole text if it fits into a width, else as many of its first characters as fit with an ellipsis.
std::string shortenedText(const Canvas& canvas, const std::string& text, double size_px, double width_px,
                          Weight weight = Weight::normal);

}  // namespace emscape::render
