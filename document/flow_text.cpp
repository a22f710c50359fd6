#include <fmt/format.h>

#include <cmath>

#include "document/schema_check.h"
#include "document/text_edit.h"

namespace emscape::document {

namespace {

std::string doubleQuoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (c == '\n') {
      quoted += "\\n";
    } else if (c == '\t') {
      quoted += "\\t";
    } else if (byte < 0x20 || byte == 0x7F) {
      quoted += fmt::format("\\u{:04x}", byte);
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

bool isPlainCharacter(char c) {
  const auto byte = static_cast<unsigned char>(c);
  const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  return letter || byte >= 0x80 || c == '_' || c == '.' || c == '+' || c == '-' || c == '/' || c == ' ' ||
         c == '(' || c == ')';
}

/// True if a text needs no quotes in any context.
bool canBePlain(const std::string& text) {
  if (text.empty() || text.front() == ' ' || text.back() == ' ' || text.front() == '-' || text == "null" ||
      text == "Null" || text == "NULL") {
    return false;
  }
  for (const char c : text) {
    if (!isPlainCharacter(c)) return false;
  }
  return true;
}

/// JSON knows no leading '+' or '.', no leading zeros and no infinities.
std::string jsonNumber(const std::string& text, double value) {
  const std::string digits = text[0] == '-' ? text.substr(1) : text;
  const bool leading_zero = digits.size() > 1 && digits[0] == '0' && digits[1] >= '0' && digits[1] <= '9';
  const bool ends_in_dot = digits.find('.') != std::string::npos &&
                           (digits.find('.') + 1 == digits.size() || digits[digits.find('.') + 1] < '0' ||
                            digits[digits.find('.') + 1] > '9');
  const bool is_json = digits[0] >= '0' && digits[0] <= '9' && !leading_zero && !ends_in_dot;
  return is_json || !std::isfinite(value) ? text : fmt::format("{}", value);
}

std::string scalarText(const DocumentNode& node, bool json) {
  if (!node.quoted) {
    if (const auto value = numberOf(node.text)) return json ? jsonNumber(node.text, *value) : node.text;
    if (booleanOf(node.text)) return node.text;
  }
  const bool like_another = numberOf(node.text) || booleanOf(node.text);
  return !json && !like_another && canBePlain(node.text) ? node.text : doubleQuoted(node.text);
}

}  // namespace

std::string flowText(const DocumentNode& node, bool json) {
  std::string text;
  switch (node.kind) {
    case NodeKind::null:
      return "null";
    case NodeKind::scalar:
      return scalarText(node, json);
    case NodeKind::sequence:
      for (const DocumentNodePtr& item : node.items)
        text += (text.empty() ? "" : ", ") + flowText(*item, json);
      return "[" + text + "]";
    case NodeKind::map:
      break;
  }
  for (const MapEntry& entry : node.entries) {
    const bool plain = !json && canBePlain(entry.key) && !numberOf(entry.key);
    text += (text.empty() ? "" : ", ") + (plain ? entry.key : doubleQuoted(entry.key)) + ": " +
            flowText(*entry.value, json);
  }
  return "{" + text + "}";
}

bool sameValue(const DocumentNode& a, const DocumentNode& b) {
  if (&a == &b) return true;
  if (a.kind != b.kind || a.items.size() != b.items.size() || a.entries.size() != b.entries.size())
    return false;
  if (a.kind == NodeKind::scalar) {
    const auto number_a = a.quoted ? std::nullopt : numberOf(a.text);
    const auto number_b = b.quoted ? std::nullopt : numberOf(b.text);
    const bool boolean_a = !a.quoted && booleanOf(a.text).has_value();
    const bool boolean_b = !b.quoted && booleanOf(b.text).has_value();
    if (number_a && number_b) return a.text == b.text || number_a.value_or(0) == number_b.value_or(0);
    return !number_a && !number_b && boolean_a == boolean_b && a.text == b.text;
  }
  for (std::size_t i = 0; i < a.items.size(); ++i) {
    if (!sameValue(*a.items[i], *b.items[i])) return false;
  }
  for (std::size_t i = 0; i < a.entries.size(); ++i) {
    if (a.entries[i].key != b.entries[i].key || !sameValue(*a.entries[i].value, *b.entries[i].value))
      return false;
  }
  return true;
}

}  // namespace emscape::document
