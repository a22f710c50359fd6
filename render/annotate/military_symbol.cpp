#include "render/annotate/military_symbol.h"

#include <algorithm>
#include <cstring>
#include <sstream>
#include <vector>

#include "render/annotate/military_symbol_table.h"
#include "render/annotate/overlay_parts.h"

namespace emscape::render {
namespace {

constexpr double kCenter = 100, kHalf = 72;  // of the drawings; half the side of the square around a frame
constexpr double kLineWidth = 5;
constexpr const char* kLandUnits = "10";

/// The tables are sorted by set and code.
const char* find(const SymbolDrawing* drawings, int count, const std::string& set, const std::string& code) {
  const auto order = [&](const SymbolDrawing& row) {
    const int by_set = set.compare(row.set);
    return by_set != 0 ? by_set : code.compare(row.code);
  };
  const SymbolDrawing* const end = drawings + count;
  const SymbolDrawing* const found =
      std::partition_point(drawings, end, [&](const SymbolDrawing& row) { return order(row) > 0; });
  return found == end || order(*found) != 0 ? nullptr : found->drawing;
}

char letterOf(Affiliation side) {
  switch (side) {
    case Affiliation::friendly:
      return 'F';
    case Affiliation::hostile:
      return 'H';
    case Affiliation::neutral:
      return 'N';
    default:
      return 'U';
  }
}

/// Draws the items of a drawing.
class SymbolPen {
 public:
  SymbolPen(Canvas& canvas, const std::string& set, char side, const Point2& at, double radius, double alpha)
      : canvas_(canvas), set_(set), side_(side), at_(at), scale_(radius / kHalf), alpha_(alpha) {}

  /// @param fill  of the first item; the others are black
  void draw(const char* drawing, const Ink* fill = nullptr) const {
    std::istringstream items(drawing);
    for (std::string item; std::getline(items, item, ';'); fill = nullptr) {
      if (std::strchr("FHNU", item[0])) {
        if (item[0] != side_) continue;
        item.erase(0, 1);
      }
      drawItem(item, fill);
    }
  }

 private:
  void drawItem(const std::string& item, const Ink* fill) const {
    const char kind = item[0];
    const std::string rest = item.substr(1);
    if (kind == '@') {
      if (const char* const other = find(kIcons, kIconsCount, set_, rest)) draw(other);
    } else if (kind == 't') {
      std::istringstream in(rest);
      double x = 0, y = 0, size = 0;
      char comma = 0;
      std::string text;
      in >> x >> comma >> y >> size >> comma >> text;
      constexpr double kHalfCapital = 0.36;  // of the size: texts are centred at their point
      canvas_.text(text, pointAt(x, y - kHalfCapital * size), size * scale_, black(), Align::center,
                   Weight::bold);
    } else {
      const std::vector<Point2> points = pointsOf(rest);
      if (fill || kind == 'w') canvas_.polygon(points, fill ? *fill : Ink{{1, 1, 1}, alpha_});
      if (!fill && (kind == 'f' || kind == 'b')) canvas_.polygon(points, black());
      if (kind != 'f') canvas_.outline(points, black(), kLineWidth * scale_, kind == 'c');
    }
  }

  std::vector<Point2> pointsOf(const std::string& numbers) const {
    std::vector<Point2> points;
    std::istringstream in(numbers);
    char comma = 0;
    for (double x = 0, y = 0; in >> x >> comma >> y;) points.push_back(pointAt(x, y));
    return points;
  }
  Point2 pointAt(double x, double y) const { return at_ + Point2{x - kCenter, y - kCenter} * scale_; }
  Ink black() const { return {{0, 0, 0}, alpha_}; }

  Canvas& canvas_;
  const std::string& set_;
  char side_;
  Point2 at_;
  double scale_, alpha_;
};

}  // namespace

Rgb colorOf(Affiliation side) {
  switch (side) {
    case Affiliation::friendly:
      return parseColor("#80e0ff");
    case Affiliation::hostile:
      return parseColor("#ff8080");
    case Affiliation::neutral:
      return parseColor("#aaffaa");
    default:
      return parseColor("#ffff80");
  }
}

void drawMilitarySymbol(Canvas& canvas, Affiliation side, const std::string& sidc, bool is_active,
                        const Point2& at, double radius, double alpha) {
  std::string set = sidc.size() >= 20 ? sidc.substr(4, 2) : kLandUnits;
  const std::string letter(1, letterOf(side));
  const char* frame = find(kFrames, kFramesCount, set, letter);
  if (!frame) frame = find(kFrames, kFramesCount, kLandUnits, letter);
  const SymbolPen pen(canvas, set, letter[0], at, radius, alpha);
  const Ink fill{colorOf(side), is_active ? alpha : 0.35 * alpha};
  pen.draw(frame, &fill);
  if (sidc.size() < 20) return;
  const std::string entity = sidc.substr(10, 6);
  for (const std::string& code : {entity, entity.substr(0, 4) + "00", entity.substr(0, 2) + "0000"}) {
    const char* const icon = find(kIcons, kIconsCount, set, code);
    if (!icon) continue;
    pen.draw(icon);
    break;
  }
}

double symbolSize(const Marker& marker) {
  if (marker.side == Affiliation::none) return 1.2;
  return marker.sidc.empty() ? 1.6 : 2.3;
}

Rgb colorOf(MarkerKind kind, Affiliation side) {
  return side == Affiliation::none ? colorOf(kind) : colorOf(side);
}

void drawMark(Canvas& canvas, const Marker& marker, const Point2& at, double radius, double alpha) {
  if (marker.side != Affiliation::none)
    drawMilitarySymbol(canvas, marker.side, marker.sidc, marker.active, at, symbolSize(marker) * radius,
                       alpha);
  if (marker.sidc.empty()) {
    const double part = marker.side == Affiliation::none ? 1 : 0.7;
    drawSymbol(canvas, marker.kind, marker.active, at, part * radius, alpha);
  }
}

}  // namespace emscape::render
