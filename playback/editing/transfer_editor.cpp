#include "playback/editing/transfer_editor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "emscape/base/error.h"

namespace emscape::playback {
namespace {

using render::TransferFunction;

const TransferFunction& requireValues(const TransferFunction& function) {
  if (function.categorical) {
    throw Error(ErrorCode::bad_input,
                "a categorical transfer function cannot be edited: categories have their "
                "own colours");
  }
  return function;
}

bool sameColors(const std::vector<TransferFunction::ColorPoint>& a,
                const std::vector<TransferFunction::ColorPoint>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& p, const auto& q) {
    return p.at == q.at && p.color.r == q.color.r && p.color.g == q.color.g && p.color.b == q.color.b;
  });
}

bool same(const TransferFunction& a, const TransferFunction& b) {
  return a.name == b.name && a.unit == b.unit && a.categorical == b.categorical &&
         sameColors(a.colors, b.colors) &&
         std::equal(a.opacities.begin(), a.opacities.end(), b.opacities.begin(), b.opacities.end(),
                    [](const auto& p, const auto& q) { return p.at == q.at && p.opacity == q.opacity; });
}

std::vector<TransferFunction::ColorPoint> colorsOver(const render::ColorMap& map, double lowest,
                                                     double highest) {
  std::vector<TransferFunction::ColorPoint> colors;
  for (const render::ColorMap::Point& point : map.points) {
    colors.push_back({lowest + (highest - lowest) * point.at, point.color});
  }
  return colors;
}

}  // namespace

double OpacityAxis::position(double opacity) const {
  const double clamped = std::clamp(opacity, 0.0, 1.0);
  if (!logarithmic) return clamped;
  if (clamped < kMinOpacity) return 0;
  return 1 - (1 - kZeroPart) * std::log(clamped) / std::log(kMinOpacity);
}

double OpacityAxis::opacity(double position) const {
  const double clamped = std::clamp(position, 0.0, 1.0);
  if (!logarithmic) return clamped;
  if (clamped < kZeroPart) return 0;
  return std::pow(kMinOpacity, (1 - clamped) / (1 - kZeroPart));
}

TransferEditor::TransferEditor(const TransferFunction& function) : stack_(requireValues(function)) {}

void TransferEditor::setFunction(const TransferFunction& function) {
  set(requireValues(function));
}

void TransferEditor::select(std::optional<int> point) {
  selected_ = point;
  checkSelection();
}

std::optional<int> TransferEditor::pointNear(double value, double position, double value_scale,
                                             double radius) const {
  std::optional<int> nearest;
  double smallest = radius;
  for (std::size_t i = 0; i < function().opacities.size(); ++i) {
    const TransferFunction::OpacityPoint& point = function().opacities[i];
    const double distance =
        std::hypot((point.at - value) * value_scale, axis.position(point.opacity) - position);
    if (distance > smallest) continue;
    smallest = distance;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

int TransferEditor::add(double value, double opacity) {
  TransferFunction next = function();
  value = std::clamp(value, next.lowest(), next.highest());
  const auto after = std::upper_bound(next.opacities.begin(), next.opacities.end(), value,
                                      [](double at, const auto& point) { return at < point.at; });
  const auto index = static_cast<int>(after - next.opacities.begin());
  next.opacities.insert(after, {value, std::clamp(opacity, 0.0, 1.0)});
  set(std::move(next));
  selected_ = index;
  return index;
}

void TransferEditor::moveSelected(double value, double opacity) {
  if (!selected_) return;
  TransferFunction next = function();
  const auto index = static_cast<std::size_t>(*selected_);
  auto& points = next.opacities;
  value = std::clamp(value, next.lowest(), next.highest());
  if (index > 0) value = std::max(value, points[index - 1].at);
  if (index + 1 < points.size()) value = std::min(value, points[index + 1].at);
  points[index] = {value, std::clamp(opacity, 0.0, 1.0)};
  if (next.highest() > next.lowest()) set(std::move(next));
}

void TransferEditor::removeSelected() {
  if (!selected_ || function().opacities.size() <= 2) return;
  TransferFunction next = function();
  next.opacities.erase(next.opacities.begin() + *selected_);
  if (!(next.highest() > next.lowest())) return;
  const int last = static_cast<int>(next.opacities.size()) - 1;
  set(std::move(next));
  selected_ = std::min(*selected_, last);
}

void TransferEditor::setOpacityPreset(const std::string& name, std::optional<double> at) {
  TransferFunction next = function();
  const double lowest = next.lowest(), highest = next.highest();
  next.opacities = opacityPreset(name, lowest, highest, at.value_or(0.5 * (lowest + highest)));
  selected_.reset();
  set(std::move(next));
}

void TransferEditor::scaleOpacities(double factor) {
  TransferFunction next = function();
  for (auto& point : next.opacities) point.opacity = std::clamp(point.opacity * factor, 0.0, 1.0);
  set(std::move(next));
}

void TransferEditor::setColorMap(const std::string& name) {
  const render::ColorMap& map = render::colorMap(name);
  TransferFunction next = function();
  next.colors = colorsOver(map, next.lowest(), next.highest());
  set(std::move(next));
}

std::string TransferEditor::colorMap() const {
  const double first = function().colors.front().at, range = function().colors.back().at - first;
  for (const std::string& name : presets()) {
    const auto& points = render::colorMap(name).points;
    const auto isPoint = [&](const TransferFunction::ColorPoint& color,
                             const render::ColorMap::Point& point) {
      return std::abs(color.at - first - point.at * range) <= 1e-6 * range &&
             color.color.r == point.color.r && color.color.g == point.color.g &&
             color.color.b == point.color.b;
    };
    if (std::equal(function().colors.begin(), function().colors.end(), points.begin(), points.end(), isPoint))
      return name;
  }
  return "";
}

void TransferEditor::fit(const volume::ValueRange& range) {
  setInterval(range.min, range.max);
}

void TransferEditor::setLowest(double value) {
  setInterval(value, base().highest());
}

void TransferEditor::setHighest(double value) {
  setInterval(base().lowest(), value);
}

void TransferEditor::setInterval(double lowest, double highest) {
  if (!(highest > lowest) || !std::isfinite(highest - lowest)) return;
  TransferFunction next = base();
  const double from = next.lowest(), to = next.highest();
  const auto moved = [&](double at) {
    // The ends are exact.
    return at == to ? highest : lowest + (highest - lowest) * ((at - from) / (to - from));
  };
  for (auto& point : next.colors) point.at = moved(point.at);
  for (auto& point : next.opacities) point.at = moved(point.at);
  // Colours at positions that are equal after rounding are merged.
  next.colors.erase(std::unique(next.colors.begin(), next.colors.end(),
                                [](const auto& a, const auto& b) { return !(a.at < b.at); }),
                    next.colors.end());
  set(std::move(next));
}

void TransferEditor::endDrag() {
  const TransferFunction* begin = stack_.dragged();
  begin != nullptr&& same(*begin, function()) ? stack_.cancelDrag() : stack_.endDrag();
}

void TransferEditor::undo() {
  endDrag();
  if (!stack_.canUndo()) return;
  stack_.undo();
  ++changes_;
  checkSelection();
}

void TransferEditor::redo() {
  endDrag();
  if (!stack_.canRedo()) return;
  stack_.redo();
  ++changes_;
  checkSelection();
}

void TransferEditor::set(TransferFunction function) {
  if (!same(function, this->function())) {
    stack_.set(std::move(function));
    ++changes_;
  }
  checkSelection();
}

void TransferEditor::checkSelection() {
  const int count = static_cast<int>(function().opacities.size());
  if (selected_ && (*selected_ < 0 || *selected_ >= count)) selected_.reset();
}

}  // namespace emscape::playback
