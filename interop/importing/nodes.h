/// Building of documents.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "document/document.h"

namespace emscape::interop {

using document::DocumentNode;
using document::DocumentNodePtr;

/// A number with the fewest digits that are within half a unit of its last significant one.
/// @param digits  significant ones
DocumentNodePtr numberNode(double value, int digits = 9);
/// A number with so many decimals, without zeros at the end.
std::string decimalText(double value, int decimals);
DocumentNodePtr decimalNode(double value, int decimals);
DocumentNodePtr booleanNode(bool value);
DocumentNodePtr textNode(const std::string& text);
DocumentNodePtr listNode(std::vector<DocumentNodePtr> items);

/// A map under construction.
class MapBuilder {
 public:
  MapBuilder() = default;
  /// Begins with the entries of a node, which may be null.
  explicit MapBuilder(const DocumentNodePtr& node);

  /// Adds or replaces a key; a null value is left out.
  MapBuilder& set(const std::string& key, const DocumentNodePtr& value);
  MapBuilder& remove(const std::string& key);
  DocumentNodePtr find(const std::string& key) const;  ///< null if missing
  /// The value of a key as text; empty if it is missing or no scalar.
  std::string textOf(const std::string& key) const;
  /// The value of a key as a number; NaN if it is missing or no number.
  double numberOf(const std::string& key) const;
  DocumentNodePtr node() const;
  const std::vector<document::MapEntry>& entries() const { return node_.entries; }
  bool isEmpty() const { return node_.entries.empty(); }

 private:
  DocumentNode node_;
};

/// The items of a list in block style, each key of an item on its own line, values on one line.
/// @param indent  blanks before the hyphens
std::string blockText(const std::vector<DocumentNodePtr>& items, int indent);

}  // namespace emscape::interop
