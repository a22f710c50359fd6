/// Values with their unit, as text for people.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace emscape {

/// Watts and hertz have the decimal prefix (n, u, m, k, M, G, T) for which the number is at least 1 and below
/// 1000: "10 MW", "9.41 GHz", "0 W". Beyond these prefixes the number has an exponent. Other units have no
/// prefix: "12000 m".
struct PrefixedUnit {
  std::string unit;   ///< "MHz"
  double factor = 1;  ///< value in the plain unit: 1e6
};
/// The prefix of a value; factor 1 if the unit has no prefix, and for 0, infinities and NaN.
/// @param digits  significant digits, to which the value is rounded first: 999999.9 W is 1 MW to 6 digits
PrefixedUnit prefixedUnit(double value, const std::string& unit, int digits = 6);

/// The unit with its signs: "°" for deg, "m²" for m2. parseQuantity() reads both.
std::string unitSigns(const std::string& unit);

/// The usual ones of the units that parseQuantity() reads for a unit, with their signs: "s, ms, µs, ns, min,
/// h"; empty for none.
std::string readUnits(const std::string& unit);

/// Why a text is not read as a number with a unit: "'1,5 MHz': a decimal point is needed, 1.5 MHz", "'1e400'
/// is too large", "'2 kg': 'kg' is not one of the units m, km", "'much' is not a number; units: m, km".
/// @param units   of readUnits(); may be empty
/// @param isRead  whether another text would be read
std::string quantityFault(const std::string& text, const std::string& units,
                          const std::function<bool(const std::string&)>& isRead);

/// "10 MW". @param unit    may be empty  @param digits  significant digits, 1..17
std::string quantityText(double value, const std::string& unit, int digits = 6);
/// "1 MHz to 1 THz", "0 to 100 dB".
std::string rangeText(double minimum, double maximum, const std::string& unit, int digits = 6);

/// Reads a number that may be followed by the unit, with or without a prefix, or by another unit of the same
/// dimension: "3e9", "3 GHz", "3000MHz", "2 km", "10 kt", "-3 dBW", "15 °C". The prefixes k and G, and units
/// of letters only, may be of either case.
/// @param unit    plain: "Hz"
/// @param shown   factor for a number without a unit
/// @return the value in the plain unit; none for another text
std::optional<double> parseQuantity(const std::string& text, const std::string& unit, double shown = 1);

}  // namespace emscape
