#include "interop/importing/nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "document/schema_check.h"
#include "document/text_edit.h"

namespace emscape::interop {
namespace {

DocumentNodePtr scalarNode(std::string text, bool quoted) {
  auto node = std::make_shared<DocumentNode>();
  node->kind = document::NodeKind::scalar;
  node->text = std::move(text);
  node->quoted = quoted;
  return node;
}

}  // namespace

DocumentNodePtr numberNode(double value, int digits) {
  const std::string exact = fmt::format("{:.{}g}", value, digits);
  // 9.41e+09 as 9.41e9
  std::string text = exact;
  const std::size_t at = text.find("e+");
  if (at != std::string::npos) {
    text.erase(at + 1, 1);
    while (at + 1 < text.size() - 1 && text[at + 1] == '0') text.erase(at + 1, 1);
    if (text.find('.') == std::string::npos) text.insert(at, ".0");
  }
  return scalarNode(text, false);
}

std::string decimalText(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

DocumentNodePtr decimalNode(double value, int decimals) {
  return scalarNode(decimalText(value, decimals), false);
}

DocumentNodePtr booleanNode(bool value) {
  return scalarNode(value ? "true" : "false", false);
}

DocumentNodePtr textNode(const std::string& text) {
  return scalarNode(text, true);
}

DocumentNodePtr listNode(std::vector<DocumentNodePtr> items) {
  auto node = std::make_shared<DocumentNode>();
  node->kind = document::NodeKind::sequence;
  node->items = std::move(items);
  return node;
}

MapBuilder::MapBuilder(const DocumentNodePtr& node) {
  if (node) node_.entries = node->entries;
}

MapBuilder& MapBuilder::set(const std::string& key, const DocumentNodePtr& value) {
  if (!value) return *this;
  for (document::MapEntry& entry : node_.entries) {
    if (entry.key == key) {
      entry.value = value;
      return *this;
    }
  }
  node_.entries.push_back({key, {}, value});
  return *this;
}

MapBuilder& MapBuilder::remove(const std::string& key) {
  auto& entries = node_.entries;
  entries.erase(
      std::remove_if(entries.begin(), entries.end(), [&](const auto& entry) { return entry.key == key; }),
      entries.end());
  return *this;
}

DocumentNodePtr MapBuilder::find(const std::string& key) const {
  for (const document::MapEntry& entry : node_.entries) {
    if (entry.key == key) return entry.value;
  }
  return nullptr;
}

std::string MapBuilder::textOf(const std::string& key) const {
  const DocumentNodePtr value = find(key);
  return value && value->kind == document::NodeKind::scalar ? value->text : "";
}

double MapBuilder::numberOf(const std::string& key) const {
  return document::numberOf(textOf(key)).value_or(std::nan(""));
}

DocumentNodePtr MapBuilder::node() const {
  auto node = std::make_shared<DocumentNode>(node_);
  node->kind = document::NodeKind::map;
  return node;
}

std::string blockText(const std::vector<DocumentNodePtr>& items, int indent) {
  std::string text;
  const std::string blanks(static_cast<std::size_t>(indent), ' ');
  for (const DocumentNodePtr& item : items) {
    bool is_first = true;
    for (const document::MapEntry& entry : item->entries) {
      text += blanks + (is_first ? "- " : "  ") + entry.key + ": " + document::flowText(*entry.value, false) +
              "\n";
      is_first = false;
    }
  }
  return text;
}

}  // namespace emscape::interop
