#include "render/cells/integral/linear_transfer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace emscape::render {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMaxOpacity = 1 - 1.0 / (1 << 24);

double extinctionOf(double opacity) {
  return -std::log1p(-std::clamp(opacity, 0.0, kMaxOpacity));
}

/// Segment of the opacity function between two values.
struct OpacityPiece {
  double lower, upper;
  double opacity_lower, opacity_upper;
};

/// Appends a segment, split so that linear extinction approximates linear opacity.
void appendParts(const OpacityPiece& piece, std::vector<OpacityPiece>& parts, int depth = 0) {
  constexpr int kMaxDepth = 24;
  const double middle = 0.5 * (piece.opacity_lower + piece.opacity_upper);
  const double extinction = 0.5 * (extinctionOf(piece.opacity_lower) + extinctionOf(piece.opacity_upper));
  // The max difference is near the middle, up to 1.3 times the one there.
  if (depth == kMaxDepth ||
      std::abs(-std::expm1(-extinction) - middle) <= LinearTransfer::kOpacityError / 1.5) {
    parts.push_back(piece);
    return;
  }
  const double value = 0.5 * (piece.lower + piece.upper);
  appendParts({piece.lower, value, piece.opacity_lower, middle}, parts, depth + 1);
  appendParts({value, piece.upper, middle, piece.opacity_upper}, parts, depth + 1);
}

std::vector<OpacityPiece> opacityPieces(const TransferFunction& function) {
  std::vector<OpacityPiece> pieces;
  const auto& points = function.opacities;
  pieces.push_back({-kInfinity, points.front().at, points.front().opacity, points.front().opacity});
  for (std::size_t n = 0; n + 1 < points.size(); ++n) {
    if (points[n].at < points[n + 1].at) {
      appendParts({points[n].at, points[n + 1].at, points[n].opacity, points[n + 1].opacity}, pieces);
    }
  }
  pieces.push_back({points.back().at, kInfinity, points.back().opacity, points.back().opacity});
  return pieces;
}

bool same(const Rgb& a, const Rgb& b) {
  return a.r == b.r && a.g == b.g && a.b == b.b;
}

}  // namespace

LinearTransfer::LinearTransfer(const TransferFunction& function) {
  std::vector<double> cuts{-kInfinity, kInfinity};
  const std::vector<OpacityPiece> pieces = opacityPieces(function);
  for (const OpacityPiece& piece : pieces) cuts.push_back(piece.lower);
  for (const OpacityPiece& piece : pieces) cuts.push_back(piece.upper);
  for (const TransferFunction::ColorPoint& point : function.colors) cuts.push_back(point.at);
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  std::size_t p = 0;
  for (std::size_t n = 0; n + 1 < cuts.size(); ++n) {
    const double lower = cuts[n], upper = cuts[n + 1];
    while (pieces[p].upper <= lower) ++p;
    const OpacityPiece& piece = pieces[p];
    const auto extinctionAt = [&](double value) {
      const double part = std::isinf(piece.lower) || std::isinf(piece.upper)
                              ? 0
                              : (value - piece.lower) / (piece.upper - piece.lower);
      const double low = extinctionOf(piece.opacity_lower), high = extinctionOf(piece.opacity_upper);
      return low + part * (high - low);
    };
    TransferInterval interval{lower, upper, {extinctionAt(lower), extinctionAt(upper)}, {}, false, false};
    // Beyond the ends colours are constant.
    interval.color[0] = function.color(std::isinf(lower) ? upper : lower);
    interval.color[1] = function.color(std::isinf(upper) ? lower : upper);
    interval.clear = interval.extinction[0] == 0 && interval.extinction[1] == 0;
    interval.uniform =
        interval.extinction[0] == interval.extinction[1] && same(interval.color[0], interval.color[1]);
    intervals_.push_back(interval);
  }
}

}  // namespace emscape::render
