#include "emscape/playback/transfer_editor.h"

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

bool same(const TransferFunction& a, const TransferFunction& b) {
  return a.name == b.name && a.unit == b.unit && a.categorical == b.categorical &&
         std::equal(a.colors.begin(), a.colors.end(), b.colors.begin(), b.colors.end(),
                    [](const auto& p, const auto& q) {
                      return p.at == q.at && p.color.r == q.color.r && p.color.g == q.color.g &&
                             p.color.b == q.color.b;
                    }) &&
         std::equal(a.opacities.begin(), a.opacities.end(), b.opacities.begin(), b.opacities.end(),
                    [](const auto& p, const auto& q) { return p.at == q.at && p.opacity == q.opacity; });
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

void TransferEditor::setColorMap(const std::string& name) {
  const render::ColorMap& map = render::colorMap(name);
  TransferFunction next = function();
  const double lowest = next.lowest(), range = next.highest() - lowest;
  next.colors.clear();
  for (const render::ColorMap::Point& point : map.points) {
    next.colors.push_back({lowest + range * point.at, point.color});
  }
  set(std::move(next));
}

void TransferEditor::fit(const volume::ValueRange& range) {
  spread(range.min, range.max);
}

void TransferEditor::setLowest(double value) {
  spread(value, function().highest());
}

void TransferEditor::setHighest(double value) {
  spread(function().lowest(), value);
}

void TransferEditor::spread(double lowest, double highest) {
  if (!(highest > lowest) || !std::isfinite(highest - lowest)) return;
  TransferFunction next = function();
  const double from = next.lowest(), to = next.highest();
  const auto moved = [&](double at) {
    // Ends are met exactly.
    return at == to ? highest : lowest + (highest - lowest) * ((at - from) / (to - from));
  };
  for (auto& point : next.colors) point.at = moved(point.at);
  for (auto& point : next.opacities) point.at = moved(point.at);
  // Colours that rounding has brought together are one.
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
  stack_.undo();
  checkSelection();
}

void TransferEditor::redo() {
  endDrag();
  stack_.redo();
  checkSelection();
}

void TransferEditor::set(TransferFunction function) {
  if (!same(function, this->function())) stack_.set(std::move(function));
  checkSelection();
}

void TransferEditor::checkSelection() {
  const int count = static_cast<int>(function().opacities.size());
  if (selected_ && (*selected_ < 0 || *selected_ >= count)) selected_.reset();
}

}  // namespace emscape::playback
