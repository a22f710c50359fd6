#include "render/annotate/label_placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

namespace emscape::render {
namespace {

constexpr std::array kReaches{1.0, 2.4, 4.5, 7.5, 11.0};  // in gaps

Rect around(const Point2& at, double radius) {
  return {at.x - radius, at.y - radius, 2 * radius, 2 * radius};
}

struct LeaderLine {
  Point2 from, to;
};

LeaderLine lineOf(const LabelRequest& label, const Rect& rect) {
  return {label.at, nearestIn(rect, label.at)};
}

Rect boxOf(const LeaderLine& line) {
  const auto [from, to] = line;
  return {std::min(from.x, to.x), std::min(from.y, to.y), std::abs(to.x - from.x), std::abs(to.y - from.y)};
}

/// Whether a part of a line is within a rectangle: its part between the left and the right side is cut to
/// that between the upper and the lower one.
bool crosses(const LeaderLine& line, const Rect& rect) {
  double begin = 0, end = 1;
  const auto cut = [&](double from, double to, double low, double high) {
    const double along = to - from;
    if (along == 0) return from >= low && from <= high;
    const double a = (low - from) / along, b = (high - from) / along;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
    return begin <= end;
  };
  return cut(line.from.x, line.to.x, rect.x, rect.x + rect.width) &&
         cut(line.from.y, line.to.y, rect.y, rect.y + rect.height);
}

/// Rectangles in cells, so that few are compared.
class Occupied {
 public:
  explicit Occupied(ImageSize size)
      : columns_(size.width / kCell + 1),
        rows_(size.height / kCell + 1),
        cells_(std::size_t(columns_) * rows_) {}

  void add(const Rect& rect) {
    forCells(rect, [&](std::vector<Rect>& cell) {
      cell.push_back(rect);
      return false;
    });
  }

  bool hits(const Rect& rect) {
    return forCells(rect, [&](const std::vector<Rect>& cell) {
      return std::any_of(cell.begin(), cell.end(), [&](const Rect& other) { return overlap(rect, other); });
    });
  }

  bool hits(const LeaderLine& line) {
    return forCells(boxOf(line), [&](const std::vector<Rect>& cell) {
      return std::any_of(cell.begin(), cell.end(), [&](const Rect& other) { return crosses(line, other); });
    });
  }

 private:
  static constexpr int kCell = 48;

  /// Calls `use` for the cells of a rectangle until it returns true. @return whether it did
  template <class Use>
  bool forCells(const Rect& rect, const Use& use) {
    const auto index = [](double at, int count) {
      return static_cast<int>(std::clamp(at / kCell, 0.0, count - 1.0));
    };
    for (int y = index(rect.y, rows_); y <= index(rect.y + rect.height, rows_); ++y) {
      for (int x = index(rect.x, columns_); x <= index(rect.x + rect.width, columns_); ++x) {
        if (use(cells_[static_cast<std::size_t>(y) * columns_ + x])) return true;
      }
    }
    return false;
  }

  int columns_, rows_;
  std::vector<std::vector<Rect>> cells_;
};

/// From the edge of a label's symbol to a rectangle.
double distanceTo(const Rect& rect, const LabelRequest& label) {
  return length(nearestIn(rect, label.at) - label.at) - label.radius;
}

/// The placed labels and the lines that lead to them: no line crosses a label.
struct PlacedLabels {
  Occupied rects;
  std::vector<LeaderLine> lines;

  void add(const LabelRequest& label, const LabelPlace& place) {
    rects.add(place.rect);
    if (place.needs_line) lines.push_back(lineOf(label, place.rect));
  }
  bool isClear(const LabelRequest& label, const LabelPlace& place) {
    const bool is_crossed = std::any_of(lines.begin(), lines.end(),
                                        [&](const LeaderLine& line) { return crosses(line, place.rect); });
    return !is_crossed && !(place.needs_line && rects.hits(lineOf(label, place.rect)));
  }
};

/// Tries positions, best first: beside, above, below, oblique, then further away. Of those equally far away,
/// the ones that are nearer to another symbol are the last.
/// @param symbols  those that matter
std::optional<LabelPlace> placeOf(const LabelRequest& label, ImageSize size, double gap, Occupied& occupied,
                                  const std::vector<const LabelRequest*>& symbols, PlacedLabels& placed) {
  const double width = label.width, height = label.height;
  for (const double reach : kReaches) {
    std::optional<LabelPlace> nearer_to_other;
    const double d = label.radius + gap * reach, o = 0.7 * d;
    const Point2& at = label.at;
    const std::array<Point2, 8> corners{{{at.x + d, at.y - height / 2},
                                         {at.x - d - width, at.y - height / 2},
                                         {at.x - width / 2, at.y - d - height},
                                         {at.x - width / 2, at.y + d},
                                         {at.x + o, at.y - o - height},
                                         {at.x - o - width, at.y - o - height},
                                         {at.x + o, at.y + o},
                                         {at.x - o - width, at.y + o}}};
    for (const Point2& corner : corners) {
      const Rect rect{corner.x, corner.y, width, height};
      const bool is_inside =
          rect.x >= 0 && rect.y >= 0 && rect.x + width <= size.width && rect.y + height <= size.height;
      if (!is_inside || occupied.hits(rect)) continue;
      const double own = distanceTo(rect, label);
      const bool is_own = std::none_of(symbols.begin(), symbols.end(), [&](const LabelRequest* other) {
        return distanceTo(rect, *other) < own;
      });
      const LabelPlace place{rect, !is_own || reach > kReaches.front()};
      if ((!is_own && nearer_to_other) || !placed.isClear(label, place)) continue;
      if (is_own) return place;
      nearer_to_other = place;
    }
    if (nearer_to_other) return nearer_to_other;
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::optional<LabelPlace>> placeLabels(const std::vector<LabelRequest>& requests, ImageSize size,
                                                   double gap, const std::vector<Rect>& taken) {
  std::vector<std::size_t> order(requests.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const LabelRequest &first = requests[a], &second = requests[b];
    return std::tie(first.moves, first.rank, first.depth) < std::tie(second.moves, second.rank, second.depth);
  });
  Occupied occupied(size);
  PlacedLabels placed{Occupied(size), {}};
  for (const Rect& rect : taken) occupied.add(rect);
  std::vector<const LabelRequest*> symbols;
  const auto addSymbols = [&](bool moves) {
    for (const LabelRequest& request : requests) {
      if (request.moves != moves) continue;
      occupied.add(around(request.at, request.radius));
      symbols.push_back(&request);
    }
  };
  addSymbols(false);
  const double picture = static_cast<double>(size.count());
  double covered = 0;
  bool has_moving = false;
  std::vector<std::optional<LabelPlace>> places(requests.size());
  for (const std::size_t index : order) {
    const LabelRequest& request = requests[index];
    if (request.width <= 0) continue;
    if (request.moves && !std::exchange(has_moving, true)) addSymbols(true);
    const double area = request.width * request.height;
    if (covered + area > (request.moves ? kLabelsPart : kFixedLabelsPart) * picture) continue;
    places[index] = placeOf(request, size, gap, occupied, symbols, placed);
    if (!places[index]) continue;
    occupied.add(places[index]->rect);
    placed.add(request, *places[index]);
    covered += area;
  }
  return places;
}

Point2 nearestIn(const Rect& rect, const Point2& to) {
  return {std::clamp(to.x, rect.x, rect.x + rect.width), std::clamp(to.y, rect.y, rect.y + rect.height)};
}

}  // namespace emscape::render
