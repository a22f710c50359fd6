#include "emscape/render/transfer/transfer_function.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "emscape/base/error.h"

namespace emscape::render {
namespace {

Rgb rgbOf(unsigned hex) {
  return {static_cast<float>((hex >> 16) & 255U) / 255.0F, static_cast<float>((hex >> 8) & 255U) / 255.0F,
          static_cast<float>(hex & 255U) / 255.0F};
}

Rgb lerpColor(const Rgb& a, const Rgb& b, float f) {
  return {a.r + f * (b.r - a.r), a.g + f * (b.g - a.g), a.b + f * (b.b - a.b)};
}

ColorMap equidistant(const char* name, const std::vector<unsigned>& colors) {
  ColorMap map;
  map.name = name;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    map.points.push_back({static_cast<double>(i) / static_cast<double>(colors.size() - 1), rgbOf(colors[i])});
  }
  return map;
}

/// viridis and inferno: N. Smith and S. van der Walt, dedicated to the public domain (CC0), each 16th colour
/// of 256. cividis: J. Nunez, C. Anderton, R. Renslow, PLOS ONE 13(7), 2018 (CC0). diverging: the blues and
/// reds of Okabe and Ito's palette about a light grey.
const std::vector<ColorMap>& colorMaps() {
  static const std::vector<ColorMap> maps{
      equidistant("viridis",
                  {0x440154, 0x48186a, 0x472d7b, 0x424086, 0x3b528b, 0x33638d, 0x2c728e, 0x26828e, 0x21918c,
                   0x1fa088, 0x28ae80, 0x3fbc73, 0x5ec962, 0x84d44b, 0xaddc30, 0xd8e219, 0xfde725}),
      equidistant("cividis",
                  {0x00224e, 0x002e6a, 0x1a386f, 0x32436d, 0x434e6c, 0x535a6d, 0x61656f, 0x6f7073, 0x7d7c78,
                   0x8c8878, 0x9b9476, 0xaba072, 0xbcae6c, 0xcdbb63, 0xdec958, 0xf0d846, 0xfee838}),
      equidistant("inferno",
                  {0x000004, 0x0b0724, 0x210c4a, 0x3d0965, 0x57106e, 0x71196e, 0x8a226a, 0xa32c61, 0xbc3754,
                   0xd24644, 0xe45a31, 0xf1731d, 0xf98e09, 0xfcac11, 0xf9cb35, 0xf2ea69, 0xfcffa4}),
      equidistant("diverging", {0x004f7c, 0x0072b2, 0x56b4e9, 0xbcdff2, 0xf2f2f0, 0xf5d3a0, 0xe69f00,
                                0xd55e00, 0x8f3f00})};
  return maps;
}

/// Okabe and Ito, Color Universal Design (2008), without black.
constexpr unsigned kCategoryColors[] = {0xe69f00, 0x56b4e9, 0x009e73, 0xf0e442, 0x0072b2, 0xd55e00, 0xcc79a7};

/// Opacity (of one reference step) of the default function at a quantile of the values; the last is the
/// maximum.
struct QuantileOpacity {
  double quantile, opacity;
};
constexpr QuantileOpacity kQuantileOpacity[] = {{0.5, 0.0},    {0.8, 0.0025}, {0.93, 0.008}, {0.98, 0.025},
                                                {0.995, 0.07}, {0.999, 0.14}, {0.9999, 0.3}};
/// Fraction of the range, from below, that is not coloured.
constexpr double kColorsFrom = 0.3;
/// Approximate number of values for the quantiles.
constexpr long long kQuantileSample = 200000;

/// The same over the range of the values, if nothing else is known.
constexpr TransferFunction::OpacityPoint kRangeOpacity[] = {{0.0, 0.0},   {0.2, 0.0},  {0.45, 0.004},
                                                            {0.7, 0.018}, {0.9, 0.07}, {1.0, 0.16}};
constexpr double kCategoryOpacity = 0.03;

/// For values of another program: the quantiles of the ends of the colours and of the ramp of the opacity,
/// and the opacity at its top.
constexpr double kFirstPercentile = 0.01, kLastPercentile = 0.99, kRampOpacity = 0.06;

/// For a probability: transparent where it is small, a shell at one half.
constexpr TransferFunction::OpacityPoint kProbabilityOpacity[] = {{0.0, 0.0},  {0.1, 0.001}, {0.4, 0.01},
                                                                  {0.5, 0.05}, {0.6, 0.03},  {1.0, 0.04}};
/// For a ratio (dB) whose values below 0 are of interest: a shell at 0, little above.
constexpr TransferFunction::OpacityPoint kRatioOpacity[] = {{-30, 0},  {-30, 0.04}, {-3, 0.04}, {0, 0.08},
                                                            {3, 0.01}, {10, 0.002}, {30, 0.003}};

/// For a difference, relative to the largest one, in both directions: transparent where little has changed.
constexpr TransferFunction::OpacityPoint kDifferenceOpacity[] = {
    {0.03, 0.0}, {0.1, 0.003}, {0.3, 0.015}, {0.6, 0.04}, {1.0, 0.1}};

TransferFunction namedDefault(const volume::VolumeInfo& info) {
  TransferFunction function;
  function.name = "default";
  function.unit = info.unit;
  function.categorical = info.categorical;
  return function;
}

std::vector<TransferFunction::ColorPoint> colorsOver(const ColorMap& map, double lowest, double highest) {
  std::vector<TransferFunction::ColorPoint> colors;
  for (const ColorMap::Point& point : map.points) {
    colors.push_back({lowest + (highest - lowest) * point.at, point.color});
  }
  return colors;
}

/// Values with a field, regularly sampled, in ascending order.
std::vector<float> sortedSample(const volume::DenseVolume& volume) {
  const Dims& dims = volume.grid.dims;
  // Odd, so that sampling does not follow the rows of a grid with an even number of columns.
  const long long stride = std::max(1LL, dims.count() / kQuantileSample) | 1LL;
  std::vector<float> values;
  for (long long i = 0; i < dims.count(); i += stride) {
    const float value = volume.values[static_cast<std::size_t>(i)];
    const int column = static_cast<int>(i % (static_cast<long long>(dims.x) * dims.y));
    const int k = static_cast<int>(i / (static_cast<long long>(dims.x) * dims.y));
    if (!std::isfinite(value) || value == volume.info.floor) continue;
    if (volume.isMasked(column % dims.x, column / dims.x, k)) continue;
    values.push_back(value);
  }
  std::sort(values.begin(), values.end());
  return values;
}

/// A power of ten, or five of it, that is about a twentieth of a range.
double roundUnit(double range) {
  const double power = std::pow(10.0, std::floor(std::log10(range / 10)));
  return range / power >= 50 ? 5 * power : power;
}

bool hasScale(const volume::VolumeInfo& info, const char* scale) {
  const auto found = info.extra.find(volume::kScaleKey);
  return found != info.extra.end() && found->second == scale;
}

/// Blue below 0, orange above, symmetrical about it. @param largest  difference; 0: there is none
TransferFunction functionOfDifference(const volume::VolumeInfo& info, double largest) {
  TransferFunction function = namedDefault(info);
  if (!(largest > 0)) largest = 1;
  const double unit = roundUnit(2 * largest);
  largest = std::ceil(largest / unit) * unit;
  function.colors = colorsOver(colorMap("diverging"), -largest, largest);
  for (const TransferFunction::OpacityPoint& point : kDifferenceOpacity) {
    function.opacities.push_back({point.at * largest, point.opacity});
    function.opacities.insert(function.opacities.begin(), {-point.at * largest, point.opacity});
  }
  return function;
}

/// Upper limit of all but a few of the differences of a volume, because differences to the floor would leave
/// the others without colours.
double usualDifference(const volume::DenseVolume& volume) {
  constexpr double kPart = 0.95;
  std::vector<float> values = sortedSample(volume);
  if (values.empty()) return 0;
  for (float& value : values) value = std::abs(value);
  const auto usual =
      values.begin() + static_cast<std::ptrdiff_t>(kPart * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), usual, values.end());
  return double{*usual};
}

/// A value of an ascending sample; 0.5: the median.
double quantileOf(const std::vector<float>& ascending, double part) {
  return double{ascending[static_cast<std::size_t>(part * static_cast<double>(ascending.size() - 1))]};
}

/// Whether another program wrote the values, whose sense is not known. A floor below all values is that of
/// decibels.
bool isForeign(const volume::VolumeInfo& info, const std::vector<float>& ascending) {
  return !ascending.empty() && !info.categorical && info.extra.count("scenario_hash") == 0 &&
         (info.floor == volume::kNoFloor || info.floor >= ascending.front());
}

/// The largest absolute value of the colours of values about 0: all but a few are within it; 0: the values
/// are not about 0.
double largestOfSigned(const std::vector<float>& ascending) {
  constexpr double kFew = 0.005;
  constexpr double kMinPart = 0.05;  // of the smaller side, in the larger one
  const auto few = static_cast<std::size_t>(kFew * static_cast<double>(ascending.size() - 1));
  const double below = -double{ascending[few]}, above = ascending[ascending.size() - 1 - few];
  return std::min(below, above) > kMinPart * std::max(below, above) ? std::max(below, above) : 0;
}

/// The colours of a volume from `weakest` to `strongest`, ends at round numbers, and no opacities yet.
TransferFunction coloredFunction(const volume::VolumeInfo& info, double weakest, double strongest) {
  const double unit = roundUnit(strongest - weakest);
  TransferFunction function = namedDefault(info);
  function.colors =
      colorsOver(colorMap("viridis"), std::floor(weakest / unit) * unit, std::ceil(strongest / unit) * unit);
  return function;
}

/// The function of values of another program; none if they are all the same.
std::optional<TransferFunction> functionOfForeign(const volume::VolumeInfo& info,
                                                  const std::vector<float>& ascending) {
  if (const double largest = largestOfSigned(ascending); largest > 0)
    return functionOfDifference(info, largest);
  const double lowest = quantileOf(ascending, kFirstPercentile);
  const double highest = quantileOf(ascending, kLastPercentile);
  if (!(highest > lowest)) return std::nullopt;
  TransferFunction function = coloredFunction(info, lowest, highest);
  function.opacities = {{function.colors.front().at, 0}, {function.colors.back().at, kRampOpacity}};
  return function;
}

/// The function of the volume's scale; none if the volume has no scale.
std::optional<TransferFunction> functionOfScale(const volume::VolumeInfo& info, const ColorRange& range) {
  const auto scale = info.extra.find(volume::kScaleKey);
  if (scale == info.extra.end()) return std::nullopt;
  TransferFunction function = namedDefault(info);
  if (scale->second == volume::kProbabilityScale) {
    function.colors = colorsOver(colorMap("viridis"), 0, 1);
    function.opacities.assign(std::begin(kProbabilityOpacity), std::end(kProbabilityOpacity));
    return function;
  }
  if (scale->second == volume::kDifferenceScale) {
    const volume::ValueRange of_colors = colorRangeOf(info, range);
    return functionOfDifference(info,
                                std::max(std::abs(double{of_colors.min}), std::abs(double{of_colors.max})));
  }
  const bool is_above = scale->second == volume::kRatioAboveScale;
  if (!is_above && scale->second != volume::kRatioBelowScale) return std::nullopt;
  function.opacities.assign(std::begin(kRatioOpacity), std::end(kRatioOpacity));
  function.colors =
      colorsOver(colorMap("diverging"), function.opacities.front().at, function.opacities.back().at);
  if (!is_above) return function;
  for (auto& point : function.colors) point.at = -point.at;
  for (auto& point : function.opacities) point.at = -point.at;
  std::reverse(function.colors.begin(), function.colors.end());
  std::reverse(function.opacities.begin(), function.opacities.end());
  return function;
}

}  // namespace

double quietBelow(const TransferFunction& function) {
  const auto& points = function.opacities;
  const auto is_visible = [](const TransferFunction::OpacityPoint& point) { return point.opacity > 0; };
  double quiet = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_visible(points[i])) continue;
    // A transparent point next to a visible one ends the visible range on its side of 0.
    const bool is_end = (points[i].at > 0 && i + 1 < points.size() && is_visible(points[i + 1])) ||
                        (points[i].at < 0 && i > 0 && is_visible(points[i - 1]));
    const double size = std::abs(points[i].at);
    if (is_end) quiet = quiet > 0 ? std::min(quiet, size) : size;
  }
  return function.opacity(0) > 0 ? 0 : quiet;
}

Rgb parseColor(const std::string& text) {
  const bool well_formed = text.size() == 7 && text[0] == '#' &&
                           text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  if (!well_formed) {
    throw Error(ErrorCode::bad_input,
                fmt::format("colour '{}': expected \"#rrggbb\" in hexadecimal digits", text));
  }
  return rgbOf(static_cast<unsigned>(std::stoul(text.substr(1), nullptr, 16)));
}

Rgb ColorMap::at(double position) const {
  const auto above =
      std::find_if(points.begin(), points.end(), [&](const Point& p) { return p.at > position; });
  if (above == points.begin()) return points.front().color;
  if (above == points.end()) return points.back().color;
  const Point& below = *(above - 1);
  return lerpColor(below.color, above->color,
                   static_cast<float>((position - below.at) / (above->at - below.at)));
}

const ColorMap& colorMap(const std::string& name) {
  for (const ColorMap& map : colorMaps()) {
    if (map.name == name) return map;
  }
  throw Error(ErrorCode::bad_input,
              fmt::format("unknown colour map '{}': expected {}", name, fmt::join(colorMapNames(), ", ")));
}

std::vector<std::string> colorMapNames() {
  std::vector<std::string> names;
  for (const ColorMap& map : colorMaps()) names.push_back(map.name);
  return names;
}

Rgb categoryColor(int index) {
  constexpr int count = static_cast<int>(std::size(kCategoryColors)), kShades = 3;
  const int distinct = ((index % (kShades * count)) + kShades * count) % (kShades * count);
  const Rgb color = rgbOf(kCategoryColors[distinct % count]);
  const int shade = distinct / count;
  return shade == 0   ? color
         : shade == 1 ? lerpColor(color, {0, 0, 0}, 0.4f)
                      : lerpColor(color, {1, 1, 1}, 0.4f);
}

Rgb TransferFunction::color(double value) const {
  if (categorical) return categoryColor(static_cast<int>(std::lround(value)));
  const auto above =
      std::find_if(colors.begin(), colors.end(), [&](const ColorPoint& p) { return p.at > value; });
  if (above == colors.begin()) return colors.front().color;
  if (above == colors.end()) return colors.back().color;
  const ColorPoint& below = *(above - 1);
  return lerpColor(below.color, above->color,
                   static_cast<float>((value - below.at) / (above->at - below.at)));
}

double TransferFunction::opacity(double value) const {
  if (categorical && value < -0.5) return 0;
  const auto above =
      std::find_if(opacities.begin(), opacities.end(), [&](const OpacityPoint& p) { return p.at > value; });
  if (above == opacities.begin()) return opacities.front().opacity;
  if (above == opacities.end()) return opacities.back().opacity;
  const OpacityPoint& below = *(above - 1);
  return below.opacity + (above->opacity - below.opacity) * (value - below.at) / (above->at - below.at);
}

bool operator==(const TransferFunction& a, const TransferFunction& b) {
  const auto same_color = [](const TransferFunction::ColorPoint& p, const TransferFunction::ColorPoint& q) {
    return p.at == q.at && p.color.r == q.color.r && p.color.g == q.color.g && p.color.b == q.color.b;
  };
  const auto same_opacity = [](const TransferFunction::OpacityPoint& p,
                               const TransferFunction::OpacityPoint& q) {
    return p.at == q.at && p.opacity == q.opacity;
  };
  return a.name == b.name && a.unit == b.unit && a.categorical == b.categorical &&
         std::equal(a.colors.begin(), a.colors.end(), b.colors.begin(), b.colors.end(), same_color) &&
         std::equal(a.opacities.begin(), a.opacities.end(), b.opacities.begin(), b.opacities.end(),
                    same_opacity);
}

double TransferFunction::lowest() const {
  return colors.empty() ? opacities.front().at : std::min(colors.front().at, opacities.front().at);
}
double TransferFunction::highest() const {
  return colors.empty() ? opacities.back().at : std::max(colors.back().at, opacities.back().at);
}

TransferFunction defaultTransferFunction(const volume::VolumeInfo& info, const ColorRange& range) {
  if (const auto function = functionOfScale(info, range)) return *function;
  TransferFunction function = namedDefault(info);
  const volume::ValueRange of_colors = colorRangeOf(info, range);
  const double lowest = of_colors.min;
  const double width = of_colors.max > of_colors.min ? double{of_colors.max} - of_colors.min : 1.0;
  if (info.categorical) {
    function.opacities = {{lowest, kCategoryOpacity}, {lowest + width, kCategoryOpacity}};
    return function;
  }
  function.colors = colorsOver(colorMap("viridis"), lowest, lowest + width);
  for (const TransferFunction::OpacityPoint& point : kRangeOpacity) {
    function.opacities.push_back({lowest + width * point.at, point.opacity});
  }
  return function;
}

TransferFunction defaultTransferFunction(const volume::DenseVolume& volume, const ColorRange& range) {
  if (hasScale(volume.info, volume::kDifferenceScale)) {
    return functionOfDifference(volume.info, usualDifference(volume));
  }
  if (const auto function = functionOfScale(volume.info, range)) return *function;
  const std::vector<float> values = sortedSample(volume);
  if (volume.info.categorical || values.empty()) return defaultTransferFunction(volume.info, range);
  if (isForeign(volume.info, values)) {
    if (const auto function = functionOfForeign(volume.info, values)) return *function;
  }
  const double weakest = quantileOf(values, kColorsFrom);
  const double strongest = quantileOf(values, std::prev(std::end(kQuantileOpacity))->quantile);
  if (!(strongest > weakest)) return defaultTransferFunction(volume.info, range);
  TransferFunction function = coloredFunction(volume.info, weakest, strongest);
  function.opacities.push_back({function.colors.front().at, 0});
  for (const QuantileOpacity& point : kQuantileOpacity) {
    function.opacities.push_back({quantileOf(values, point.quantile), point.opacity});
  }
  function.opacities.push_back({function.colors.back().at, function.opacities.back().opacity});
  return function;
}

}  // namespace emscape::render
