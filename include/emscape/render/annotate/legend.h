/// The legend of a picture: colour bar or categories, with ticks at round values.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/base/units.h"
#include "emscape/render/transfer/transfer_function.h"

namespace emscape::render {

/// Round values (1, 2, 2.5 or 5 times a power of ten apart) within [lowest, highest], about `count` of them.
std::vector<double> roundTicks(double lowest, double highest, int count);
/// Round values of a logarithmic axis (1, 2, 5 or 1, 3 times powers of ten, or these alone), about `count` of
/// them.
std::vector<double> roundLogTicks(double lowest, double highest, int count);
/// The text of a tick, with as many decimals as the step needs.
std::string tickText(double value, double step);

/// One category of a categorical volume.
struct Category {
  int index = 0;
  std::string name;
  std::optional<Rgb> color = std::nullopt;  ///< none: categoryColor(index)
};

/// Conversion of a quantity's values to the unit in which they are shown.
struct FieldScale {
  std::string unit;           ///< "V/m"
  double offset_db = 0;       ///< added to stored values
  double factor = 1;          ///< of lengths
  bool is_amplitude = false;  ///< then raised: 10^(x / 20)

  double shown(double stored) const;
  double stored(double shown) const;
};
/// @param stored_unit  "dBW/m2" and "dBuV/m" are converted; all others are shown as they are
FieldScale fieldScale(const std::string& stored_unit, FieldUnit unit);

/// Contents of a legend.
struct Legend {
  std::string quantity;  ///< as written: "Power density"
  std::string unit;      ///< "dBW/m²"; may be empty
  FieldScale scale;      ///< of the ticks, in `unit`
  TransferFunction function;
  std::optional<double> iso_value;   ///< marked on the colour bar
  bool whole_numbers = false;        ///< counts: no ticks between
  std::string hatched;               ///< what is hatched; empty: nothing is
  std::string map_note;              ///< a line below the colour bar or the categories: where the map layer is
  std::string note;                  ///< a line below that; both may be empty
  std::vector<Category> categories;  ///< categorical volumes: the listed categories
};

/// Sets scale and unit of a legend, and the quantity's name if the unit is of another quantity.
/// @param stored_unit  of the values
void setFieldUnit(Legend& legend, const std::string& stored_unit, FieldUnit unit);
/// A legend for a volume: the quantity's name in words, its unit set with superscripts.
/// @param unit  in which fields are shown
Legend legendOf(const volume::VolumeInfo& info, const TransferFunction& function,
                FieldUnit unit = FieldUnit::stored);
/// "power_density_dbwm2" -> "Power density".
std::string quantityTitle(const std::string& quantity, const std::string& unit);
/// "dBW/m2" -> "dBW/m²", "dBuV/m" -> "dBµV/m".
std::string unitText(const std::string& unit);
/// The same within a sentence, and "SNR >= 10 dB" -> "SNR ≥ 10 dB", "12 km2" -> "12 km²".
std::string displayText(const std::string& text);

}  // namespace emscape::render
