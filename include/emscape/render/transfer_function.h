/// From values to colours and opacities.
#pragma once

#include <string>
#include <vector>

#include "emscape/render/image.h"
#include "emscape/volume/dense_volume.h"

namespace emscape::render {

/// A screen colour, sRGB-encoded, 0..1.
struct Rgb {
  float r = 0, g = 0, b = 0;
};
/// Parses "#rrggbb". @throws Error (bad_input)
Rgb parseColor(const std::string& text);

/// A colour map on 0..1, linear between equidistant or given points.
struct ColorMap {
  struct Point {
    double at = 0;
    Rgb color;
  };
  std::string name;
  std::vector<Point> points;  ///< `at` increases from 0 to 1

  Rgb at(double position) const;
};
/// viridis, cividis, inferno, diverging. @throws Error (bad_input) that lists them
const ColorMap& colorMap(const std::string& name);
std::vector<std::string> colorMapNames();
/// Okabe and Ito's palette without black; indices beyond it repeat.
Rgb categoryColor(int index);

/// A transfer function in the unit of the volume's values. Between points colour and opacity are linear;
/// outside they stay as at the ends. Categorical ones give each index its palette colour.
///
/// Opacity is that of one *reference step*: a length of one along the ray measured in voxels (index space). A
/// ray that crosses n voxels of opacity a along any axis lets (1 - a)^n through, whatever the sampling step,
/// the voxels' shape and the vertical exaggeration.
struct TransferFunction {
  struct ColorPoint {
    double at = 0;
    Rgb color;
  };
  struct OpacityPoint {
    double at = 0;
    double opacity = 0;  ///< 0..1, of one reference step
  };
  std::string name;
  std::string unit;                     ///< of `at`; empty: not stated
  std::vector<ColorPoint> colors;       ///< at increases strictly; at least one (none if categorical)
  std::vector<OpacityPoint> opacities;  ///< at does not decrease (a repeated one is a jump); at least one
  bool categorical = false;             ///< value = index of a category; < -0.5 is none

  Rgb color(double value) const;
  double opacity(double value) const;
  /// The interval of a colour bar: that of all points.
  double lowest() const;
  double highest() const;
};

/// A sensible function for a volume. That of the scale that it names (volume::kScaleKey); else viridis,
/// opacity rising from nothing, both by how frequent the values are, so that the common weak field stays
/// clear and the rare strong one shows; the palette where it is categorical. Round numbers at both ends. For
/// a series take one function of one of its volumes, so that colours mean the same throughout.
TransferFunction defaultTransferFunction(const volume::DenseVolume& volume);
/// The same where only the range of the values is known.
TransferFunction defaultTransferFunction(const volume::VolumeInfo& info);

/// Reads a transfer function (JSON or YAML) for a volume.
///
///     { "schema_version": 1, "name": "power density", "domain": "value", "unit": "dBW/m2",
///       "colors": [{"at": -90, "color": "#440154"}, {"at": -20, "rgb": [0.99, 0.906, 0.145]}],
///       "opacity": [{"at": -90, "opacity": 0}, {"at": -20, "opacity": 0.08}] }
///
/// "domain": "value": `at` in the quantity's unit; "relative": 0..1 of info.range_*. "unit", optional with
/// "value", must be that of the volume. "colors" may be the name of a colour map, which then covers the
/// interval of the opacity points.
///
/// @throws Error (bad_input) with file:line:column for what is wrong: unknown, missing or repeated keys,
/// types, ranges, order, unit
TransferFunction readTransferFunction(const std::string& file, const volume::VolumeInfo& info);
/// The same from a text; `file` is the name that errors give.
TransferFunction parseTransferFunction(const std::string& text, const std::string& file,
                                       const volume::VolumeInfo& info);

/// The text of a function, "domain": "value", that parseTransferFunction() reads back to the same bits.
/// @throws Error (bad_input) for a categorical function: categories have their own colours
std::string transferFunctionText(const TransferFunction& function);
/// Writes that text; the file appears whole or not at all. @throws Error (bad_input) as above, (other)
void writeTransferFunction(const std::string& file, const TransferFunction& function);

/// @throws Error (bad_input) if the function states a unit and it is not the volume's
void requireUnitOf(const TransferFunction& function, const volume::VolumeInfo& info);

}  // namespace emscape::render
