#include "recording/acmi/acmi_text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "recording/common/text.h"

namespace emscape::interop {

std::optional<double> acmiFrame_s(std::string_view line) {
  const auto time_s = line.substr(0, 1) == "#" ? numberIn(line.substr(1)) : std::nullopt;
  return time_s && std::abs(*time_s) <= kMaxAcmiFrame_s ? time_s : std::nullopt;
}

std::optional<std::uint64_t> acmiId(std::string_view text) {
  text = trimmed(text);
  std::uint64_t id = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), id, 16);
  if (fault != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return id;
}

std::string_view nextAcmiPart(std::string_view& rest) {
  std::size_t at = 0;
  while (at < rest.size() && rest[at] != ',') at += rest[at] == '\\' && at + 1 < rest.size() ? 2 : 1;
  const std::string_view part = rest.substr(0, at);
  rest.remove_prefix(std::min(at + 1, rest.size()));
  return trimmed(part);
}

std::string acmiValue(std::string_view text) {
  std::string value;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\\' && i + 1 < text.size() && text[i + 1] == ',') continue;
    value += static_cast<unsigned char>(text[i]) < 0x20 || text[i] == 0x7F ? ' ' : text[i];
  }
  return value;
}

std::string escapedAcmi(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == ',' || c == '\n') escaped += '\\';
    if (c != '\r') escaped += c;
  }
  return escaped;
}

bool isSameName(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return x == y ||
           std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
  });
}

bool hasAcmiTag(std::string_view type, std::string_view tag) {
  for (;;) {
    const std::size_t at = type.find('+');
    if (isSameName(trimmed(type.substr(0, at)), tag)) return true;
    if (at == std::string_view::npos) return false;
    type.remove_prefix(at + 1);
  }
}

Side acmiSide(const std::string& color, const std::string& coalition) {
  if (isSameName(color, "Blue")) return Side::friendly;
  if (isSameName(color, "Red")) return Side::hostile;
  if (!color.empty()) return Side::neutral;
  const std::string name = lowerCase(coalition);
  const auto isOneOf = [&name](std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (isOneOf({"friend", "friends", "friendly", "blue", "blufor", "allies"})) return Side::friendly;
  if (isOneOf({"hostile", "hostiles", "enemy", "enemies", "red", "opfor"})) return Side::hostile;
  if (isOneOf({"neutral", "neutrals", "green", "white", "grey"})) return Side::neutral;
  return Side::unknown;
}

std::optional<AcmiPlace> acmiPlace(std::string_view text) {
  std::array<std::string_view, 9> parts;
  std::size_t count = 0;
  for (;;) {
    const std::size_t at = text.find('|');
    if (count == parts.size()) return std::nullopt;
    parts[count++] = trimmed(text.substr(0, at));
    if (at == std::string_view::npos) break;
    text.remove_prefix(at + 1);
  }
  if (count == 4 || count == 7 || count == 8) return std::nullopt;
  AcmiPlace place;
  const bool has_attitude =
      count >= 6;  // 5 parts: a position in a plane follows; 9: attitude, then the plane
  for (std::size_t i = 0; i < (has_attitude ? 6u : std::min<std::size_t>(count, 3)); ++i) {
    if (parts[i].empty()) continue;
    place.values[i] = numberIn(parts[i]);
    if (!place.values[i]) return std::nullopt;
  }
  return place;
}

}  // namespace emscape::interop
