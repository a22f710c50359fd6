#include "study/picture/map_colors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/text/display_units.h"

namespace emscape::study {
namespace {

constexpr std::size_t kMaxAbsent = 8;  ///< labels of categories that are listed if they are not on the map
constexpr int kMaxSwatches = 16;       ///< of counts; more values have a colour bar
constexpr float kNoPart = 0.005f;      ///< probabilities and fractions below it are transparent

/// Adds the colours of "viridis" or "diverging" from low to high.
void setColors(render::Legend& legend, const char* colors, double low, double high) {
  for (const render::ColorMap::Point& point : render::colorMap(colors).points)
    legend.function.colors.push_back({low + point.at * (high - low), point.color});
  legend.function.opacities = {{low, 0}, {high, 0}};
}

/// The diverging colours of decibels about 0, as of a volume of them. @param side  Map::ratio_side
void setRatioColors(render::Legend& legend, int side) {
  constexpr double kSpan_db = 30;
  setColors(legend, "diverging", -kSpan_db, kSpan_db);
  if (side > 0) return;
  for (auto& point : legend.function.colors) point.at = -point.at;
  std::reverse(legend.function.colors.begin(), legend.function.colors.end());
}

/// Index of a colour of render::categoryColor().
int categoryOf(const Map& map, int value) {
  return value >= 0 && value < static_cast<int>(map.colors.size()) ? map.colors[value] : value;
}

/// The colour of a category that the map states.
std::optional<render::Rgb> statedColor(const Map& map, int value) {
  if (value < 0 || value >= static_cast<int>(map.label_colors.size())) return std::nullopt;
  const std::uint32_t color = map.label_colors[static_cast<std::size_t>(value)];
  return render::Rgb{static_cast<float>(color & 255U) / 255, static_cast<float>(color >> 8 & 255U) / 255,
                     static_cast<float>(color >> 16 & 255U) / 255};
}

/// The number that has no colour: no category, or the first class.
int transparentOf(MapKind kind) {
  return kind == MapKind::category ? -1 : 0;
}

/// What a pixel with that number is: "no coverage", "out of reach", "none".
std::string nameOfTransparent(const Map& map) {
  if (map.kind == MapKind::category || map.labels.empty()) return "none";
  return map.labels.front() == "no" ? "no " + map.title : map.labels.front();
}

/// The colours and their values.
render::Legend colorsOf(const Map& map) {
  render::Legend legend;
  legend.quantity = render::quantityTitle(map.title, map.unit);
  float least = INFINITY, largest = -INFINITY;
  std::set<int> present;  // whole numbers
  float previous = NAN;
  for (const float value : map.values) {
    if (std::isnan(value)) continue;
    least = std::min(least, value);
    largest = std::max(largest, value);
    if (isWhole(map.kind) && value != previous) present.insert(static_cast<int>(value));
    previous = value;
  }
  if (map.kind == MapKind::count) {
    const int last = std::isfinite(largest) ? static_cast<int>(largest) : 0;
    setColors(legend, "viridis", 0, std::max(last, 1));
    legend.whole_numbers = true;
    if (last >= kMaxSwatches) return legend;
    for (int n = 0; n <= last; ++n)
      legend.categories.push_back({n, std::to_string(n), legend.function.color(n)});
    legend.function.categorical = true;
    return legend;
  }
  if (isWhole(map.kind)) {
    legend.function.categorical = true;
    const int first = map.kind == MapKind::category ? 0 : 1;
    int last = std::isfinite(largest) ? static_cast<int>(largest) : 0;
    if (map.kind == MapKind::classes) last = static_cast<int>(map.labels.size()) - 1;
    // Of many, only those on the map.
    const bool has_absent = map.kind == MapKind::classes || map.labels.size() <= kMaxAbsent;
    for (int n = first; n <= last; ++n) {
      if (!has_absent && present.count(n) == 0) continue;
      const std::string label = n < static_cast<int>(map.labels.size()) ? map.labels[n] : std::to_string(n);
      legend.categories.push_back({categoryOf(map, n), label, statedColor(map, n)});
    }
    if (present.count(transparentOf(map.kind)) != 0) legend.note = "no colour: " + nameOfTransparent(map);
    return legend;
  }
  if (map.ratio_side != 0) {
    setRatioColors(legend, map.ratio_side);
    return legend;
  }
  if (!(least <= largest)) least = largest = 0;
  double low = static_cast<double>(least), high = static_cast<double>(largest);
  if (isFraction(map.kind)) {
    low = 0;
    high = 1;
    legend.note = fmt::format("no colour: < {}", kNoPart);
  } else if (map.kind == MapKind::difference) {
    high = std::max(std::abs(low), std::abs(high));
    low = -high;
  }
  if (high - low < 1e-6) high = low + 1;
  const char* const colors = map.kind == MapKind::difference ? "diverging" : "viridis";
  setColors(legend, colors, low, high);
  return legend;
}

}  // namespace

render::Legend legendOf(const Map& map, Units units, FieldUnit field_unit) {
  render::Legend legend = colorsOf(map);
  legend.map_note = map.note;
  if (map.floor)
    legend.note = render::displayText(fmt::format("no colour: none, or <= {:g} {}", *map.floor, map.unit));
  render::setFieldUnit(legend, map.unit, field_unit);
  if (map.unit == "m" && units == Units::nautical) {
    const bool is_distance = map.name.rfind(info(Product::max_range).name, 0) == 0;
    const DisplayUnit unit = is_distance ? distanceUnit(units) : heightUnit(units);
    legend.unit = unit.name;
    legend.scale.factor = 1 / unit.factor;
  }
  if (std::find(map.answers.begin(), map.answers.end(), PixelAnswer::unknown) != map.answers.end())
    legend.hatched = "unknown";
  return legend;
}

bool isUnknown(const Map& map, std::size_t pixel) {
  return !map.answers.empty() && map.answers[pixel] == PixelAnswer::unknown;
}

std::optional<render::Rgb> colorOf(const Map& map, const render::Legend& legend, float value) {
  if (std::isnan(value)) return std::nullopt;
  if (!isWhole(map.kind)) {
    if (isFraction(map.kind) && value < kNoPart) return std::nullopt;
    return legend.function.color(static_cast<double>(value));
  }
  if (map.kind == MapKind::count) {
    const std::size_t n = static_cast<std::size_t>(std::max(value, 0.0f));
    return n < legend.categories.size() ? legend.categories[n].color
                                        : legend.function.color(static_cast<double>(value));
  }
  const int index = static_cast<int>(value);
  if (index == transparentOf(map.kind)) return std::nullopt;
  const std::optional<render::Rgb> stated = statedColor(map, index);
  return stated ? *stated : render::categoryColor(categoryOf(map, index));
}

}  // namespace emscape::study
