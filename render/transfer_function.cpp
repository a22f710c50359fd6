#include "render/transfer_function.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace emscape::render {
namespace {

Rgb rgbOf(unsigned hex) {
  return {static_cast<float>((hex >> 16) & 255U) / 255.0F, static_cast<float>((hex >> 8) & 255U) / 255.0F,
          static_cast<float>(hex & 255U) / 255.0F};
}

Rgb mixed(const Rgb& a, const Rgb& b, float f) {
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

/// viridis and inferno: N. Smith and S. van der Walt, dedicated to the public domain (CC0), each 16th colour of 256. cividis: J. Nunez,
/// C. Anderton, R. Renslow, PLOS ONE 13(7), 2018 (CC0). diverging: the blues and reds of Okabe and Ito's palette about a light grey.
const std::vector<ColorMap>& colorMaps() {
  static const std::vector<ColorMap> maps{
      equidistant("viridis", {0x440154, 0x48186a, 0x472d7b, 0x424086, 0x3b528b, 0x33638d, 0x2c728e, 0x26828e, 0x21918c,
                              0x1fa088, 0x28ae80, 0x3fbc73, 0x5ec962, 0x84d44b, 0xaddc30, 0xd8e219, 0xfde725}),
      equidistant("cividis", {0x00224e, 0x002e6a, 0x1a386f, 0x32436d, 0x434e6c, 0x535a6d, 0x61656f, 0x6f7073, 0x7d7c78,
                              0x8c8878, 0x9b9476, 0xaba072, 0xbcae6c, 0xcdbb63, 0xdec958, 0xf0d846, 0xfee838}),
      equidistant("inferno", {0x000004, 0x0b0724, 0x210c4a, 0x3d0965, 0x57106e, 0x71196e, 0x8a226a, 0xa32c61, 0xbc3754,
                              0xd24644, 0xe45a31, 0xf1731d, 0xf98e09, 0xfcac11, 0xf9cb35, 0xf2ea69, 0xfcffa4}),
      equidistant("diverging", {0x004f7c, 0x0072b2, 0x56b4e9, 0xbcdff2, 0xf2f2f0, 0xf5d3a0, 0xe69f00, 0xd55e00, 0x8f3f00})};
  return maps;
}

/// Okabe and Ito, Color Universal Design (2008), without black.
constexpr unsigned kCategoryColors[] = {0xe69f00, 0x56b4e9, 0x009e73, 0xf0e442, 0x0072b2, 0xd55e00, 0xcc79a7};

/// Opacity of the default function, over the series' range and of one reference step. Low values stay clear so that the strong
/// field is seen through the weak one around it.
constexpr TransferFunction::OpacityPoint kDefaultOpacity[] = {
    {0.0, 0.0}, {0.2, 0.0}, {0.45, 0.004}, {0.7, 0.018}, {0.9, 0.07}, {1.0, 0.16}};
constexpr double kCategoryOpacity = 0.03;

}  // namespace

Rgb parseColor(const std::string& text) {
  const bool well_formed = text.size() == 7 && text[0] == '#' &&
                           text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  if (!well_formed) {
    throw Error(ErrorCode::bad_input, fmt::format("colour '{}': expected \"#rrggbb\" in hexadecimal digits", text));
  }
  return rgbOf(static_cast<unsigned>(std::stoul(text.substr(1), nullptr, 16)));
}

Rgb ColorMap::at(double position) const {
  const auto above = std::find_if(points.begin(), points.end(), [&](const Point& p) { return p.at > position; });
  if (above == points.begin()) return points.front().color;
  if (above == points.end()) return points.back().color;
  const Point& below = *(above - 1);
  return mixed(below.color, above->color, static_cast<float>((position - below.at) / (above->at - below.at)));
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
  constexpr int count = static_cast<int>(std::size(kCategoryColors));
  return rgbOf(kCategoryColors[((index % count) + count) % count]);
}

Rgb TransferFunction::color(double value) const {
  if (categorical) return categoryColor(static_cast<int>(std::lround(value)));
  const auto above =
      std::find_if(colors.begin(), colors.end(), [&](const ColorPoint& p) { return p.at > value; });
  if (above == colors.begin()) return colors.front().color;
  if (above == colors.end()) return colors.back().color;
  const ColorPoint& below = *(above - 1);
  return mixed(below.color, above->color, static_cast<float>((value - below.at) / (above->at - below.at)));
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

double TransferFunction::lowest() const {
  return colors.empty() ? opacities.front().at : std::min(colors.front().at, opacities.front().at);
}
double TransferFunction::highest() const {
  return colors.empty() ? opacities.back().at : std::max(colors.back().at, opacities.back().at);
}

TransferFunction defaultTransferFunction(const volume::VolumeInfo& info) {
  TransferFunction function;
  function.name = "default";
  function.unit = info.unit;
  function.categorical = info.categorical;
  const double lowest = info.range_min;
  const double range = info.range_max > info.range_min ? double{info.range_max} - info.range_min : 1.0;
  if (info.categorical) {
    function.opacities = {{lowest, kCategoryOpacity}, {lowest + range, kCategoryOpacity}};
    return function;
  }
  for (const ColorMap::Point& point : colorMap("viridis").points) {
    function.colors.push_back({lowest + range * point.at, point.color});
  }
  for (const TransferFunction::OpacityPoint& point : kDefaultOpacity) {
    function.opacities.push_back({lowest + range * point.at, point.opacity});
  }
  return function;
}

}  // namespace emscape::render
