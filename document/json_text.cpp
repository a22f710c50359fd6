#include "document/json_text.h"

#include <fmt/format.h>

#include <cstdlib>

#include "base/files/json_writing.h"

namespace emscape::document {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLineLength = 100;
constexpr std::size_t kIndent = 2;

std::string keyText(const std::string& key) {
  return dumpJson(Json(key)) + ": ";
}

std::string onOneLine(const Json& value) {
  if (!value.is_structured()) return dumpJson(value);
  std::string text;
  for (const auto& [key, member] : value.items()) {
    text += (text.empty() ? "" : ", ") + (value.is_object() ? keyText(key) : "") + onOneLine(member);
  }
  return value.is_object() ? "{" + text + "}" : "[" + text + "]";
}

std::string onLines(const Json& value, std::size_t indent) {
  std::string text;
  const std::string margin(indent + kIndent, ' ');
  for (const auto& [key, member] : value.items()) {
    const std::string before = margin + (value.is_object() ? keyText(key) : "");
    std::string after = onOneLine(member);
    if (member.is_structured() && !member.empty() && before.size() + after.size() > kLineLength) {
      after = onLines(member, indent + kIndent);
    }
    text += (text.empty() ? "\n" : ",\n") + before + after;
  }
  text += "\n" + std::string(indent, ' ');
  return value.is_object() ? "{" + text + "}" : "[" + text + "]";
}

}  // namespace

std::string jsonText(const Json& root) {
  return (root.is_structured() && !root.empty() ? onLines(root, 0) : onOneLine(root)) + "\n";
}

Json shortNumber(float value) {
  const double number = std::strtod(fmt::format("{}", value).c_str(), nullptr);
  return static_cast<float>(number) == value ? number : double{value};
}

}  // namespace emscape::document
