/// Transfer functions: from values to colours and opacities.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/render/picture/image.h"
#include "emscape/volume/dense_volume.h"
#include "emscape/volume/value_range.h"

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
/// Okabe and Ito's palette without black: seven colours, then the same darker, then lighter. From 21 on they
/// repeat.
Rgb categoryColor(int index);

/// A transfer function in the unit of the volume's values. Between points colour and opacity are linear;
/// outside they are constant. Categorical functions give each index its palette colour.
///
/// Opacity is per *reference step*: one voxel along the ray (in index space). A ray that crosses n voxels of
/// opacity a along any axis has the transmittance (1 - a)^n, whatever the sampling step, the shape of the
/// voxels and the vertical exaggeration.
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
  std::string unit;                     ///< of `at`; empty: unknown
  std::vector<ColorPoint> colors;       ///< at increases strictly; at least one (none if categorical)
  std::vector<OpacityPoint> opacities;  ///< at does not decrease (a repeated one is a jump); at least one
  bool categorical = false;             ///< value = index of a category; < -0.5 is none

  Rgb color(double value) const;
  double opacity(double value) const;
  /// The interval of the colour bar: that of all points.
  double lowest() const;
  double highest() const;
};
bool operator==(const TransferFunction& a, const TransferFunction& b);

/// The largest magnitude below which values of either sign are transparent; 0 if there is none.
double quietBelow(const TransferFunction& function);

/// The range that colours are fitted to; none: that of the volume's values.
using ColorRange = std::optional<volume::ValueRange>;
inline volume::ValueRange colorRangeOf(const volume::VolumeInfo& info, const ColorRange& range) {
  return range.value_or(volume::ValueRange{info.range_min, info.range_max});
}

/// The default function of a volume: that of its scale (volume::kScaleKey); the palette for categorical
/// volumes; for values of other programs on both sides of 0 blue below and orange above it, symmetrical; else
/// viridis with opacity rising from 0, both fitted to the frequency of the values, so that the
/// common weak field is transparent and the rare strong field is visible. Both ends are round numbers. For a
/// series use the function of one of its volumes, so that colours are comparable.
/// @param range  of the colours, where they are not fitted to the frequency of values; none: that of the
/// values
TransferFunction defaultTransferFunction(const volume::DenseVolume& volume, const ColorRange& range = {});
/// The default function if only the range of the colours is known.
TransferFunction defaultTransferFunction(const volume::VolumeInfo& info, const ColorRange& range = {});

/// Reads a transfer function (JSON or YAML) for a volume.
///
///     { "schema_version": 1, "name": "power density", "domain": "value", "unit": "dBW/m2",
///       "colors": [{"at": -90, "color": "#440154"}, {"at": -20, "rgb": [0.99, 0.906, 0.145]}],
///       "opacity": [{"at": -90, "opacity": 0}, {"at": -20, "opacity": 0.08}] }
///
/// "domain": "value": `at` in the quantity's unit; "relative": 0..1 of the range of the colours. "unit",
/// optional with "value", must be that of the volume. "colors" may be the name of a colour map, which then
/// covers the interval of the opacity points.
///
/// @throws Error (bad_input) with file:line:column for unknown, missing or repeated keys, and wrong types,
/// ranges, order or unit
TransferFunction readTransferFunction(const std::string& file, const volume::VolumeInfo& info,
                                      const ColorRange& range = {});
/// The same from a text; `file` is the name that errors give.
TransferFunction parseTransferFunction(const std::string& text, const std::string& file,
                                       const volume::VolumeInfo& info, const ColorRange& range = {});

/// The text of a function ("domain": "value"); parseTransferFunction() reads it back exactly.
/// @throws Error (bad_input) for a categorical function: categories have their own colours
std::string transferFunctionText(const TransferFunction& function);
/// Writes that text; the file is written atomically. @throws Error (bad_input) as above, (other)
void writeTransferFunction(const std::string& file, const TransferFunction& function);

/// @throws Error (bad_input) if the function has a unit other than the volume's
void requireUnitOf(const TransferFunction& function, const volume::VolumeInfo& info);

}  // namespace emscape::render
