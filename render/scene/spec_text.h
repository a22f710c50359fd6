/// Text forms such as `orbit:azimuth_deg=225,elevation_deg=30`: a kind and keys with values.
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace emscape::render {

/// A parsed text form. Its errors begin with the described object and the whole text.
class SpecText {
 public:
  /// @param what      the described object, for example "camera"
  /// @param kinds     allowed kinds
  /// @param expected  text of the error for another kind
  /// @throws Error (usage) for another kind, a part without '=' and a repeated key
  SpecText(std::string what, std::string text, const std::set<std::string>& kinds,
           const std::string& expected);

  const std::string& kind() const { return kind_; }
  const std::vector<std::pair<std::string, std::string>>& entries() const { return entries_; }
  bool has(const std::string& key) const { return keys_.count(key) > 0; }

  /// A number within a range. @throws Error (usage) that gives the range
  double number(const std::string& key, const std::string& value, double least, double largest) const;
  /// @throws Error (usage)
  [[noreturn]] void refuse(const std::string& why) const;
  /// @param allowed  a list of keys
  [[noreturn]] void refuseKey(const std::string& key, const std::string& allowed) const;

 private:
  std::string what_, text_, kind_;
  std::vector<std::pair<std::string, std::string>> entries_;
  std::set<std::string> keys_;
};

}  // namespace emscape::render
