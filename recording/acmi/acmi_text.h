/// The parts of a line of an ACMI text.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "emscape/base/side.h"

namespace emscape::interop {

/// Largest time (s) of a frame after ReferenceTime: what a scenario's track can hold.
constexpr double kMaxAcmiFrame_s = 1e8;
/// The time (s) of a line that begins with #; none for another text, and beyond kMaxAcmiFrame_s.
std::optional<double> acmiFrame_s(std::string_view line);

/// The 64-bit hexadecimal id of an object; none for another text.
std::optional<std::uint64_t> acmiId(std::string_view text);

/// Takes the text up to the next comma that has no backslash before it, without blanks around it.
/// @param rest  what follows the comma
std::string_view nextAcmiPart(std::string_view& rest);

/// A value without the backslashes before commas; control characters become blanks.
std::string acmiValue(std::string_view text);

/// A text as a value: commas and line ends escaped.
std::string escapedAcmi(const std::string& text);

/// True for names that differ at most in upper and lower case, as some programs write them.
bool isSameName(std::string_view a, std::string_view b);

/// True if a Type has a tag.
bool hasAcmiTag(std::string_view type, std::string_view tag);
/// True for the Type of an object that stands for the beam of another.
inline bool isAcmiBeam(std::string_view type) {
  return hasAcmiTag(type, "Beam");
}

/// The side that Color tells; without it Coalition, whose names are free: only the common ones are known.
/// DCS calls its red side Allies: the colour comes before the name.
Side acmiSide(const std::string& color, const std::string& coalition);

/// The parts of a T property, in the order longitude, latitude, altitude, roll, pitch, yaw; parts that are
/// empty or missing have no value.
struct AcmiPlace {
  std::array<std::optional<double>, 6> values;
};
/// @return none if the text has another number of parts than 1 to 3, 5, 6 or 9, or a part is no number
std::optional<AcmiPlace> acmiPlace(std::string_view text);

}  // namespace emscape::interop
