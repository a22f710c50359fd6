/// Changes values in the text of a document and leaves everything else unchanged: comments, order, quotes,
/// line ends.
#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "document/document.h"

namespace emscape::document {

/// One step down a document: a key of a map, or the index of an item of a list.
using PathStep = std::variant<std::string, std::size_t>;
using NodePath = std::vector<PathStep>;

/// Replaces the bytes [begin, end) of a text.
struct Splice {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::string text;
};

/// The value at a path; null if there is none.
DocumentNodePtr valueAt(const DocumentNodePtr& root, const NodePath& path);

/// The document with the value at a path replaced, or added as the last key of its map; keys on the way that
/// do not exist become maps. Only the nodes on the path are copied.
/// @param value  null: the key or item is removed
/// @pre every index of the path is that of an existing item or, if a value is added, the number of items, and
/// every key belongs to a map or to a missing value
DocumentNodePtr withValueAt(const DocumentNodePtr& root, const NodePath& path, const DocumentNodePtr& value);

/// The change of the text for withValueAt(root, path, value). The new value is written on one line; a new
/// item of a list in block style with one line per key.
/// @param text  the text from which readDocument() built `root`
/// @throws Error (bad_input), without a location, if the text cannot be changed in one span: anchors,
/// aliases, block texts with an indentation indicator
Splice spliceFor(const std::string& text, const DocumentNodePtr& root, const NodePath& path,
                 const DocumentNodePtr& value);

/// True if two documents are equal in kinds, texts and order of keys; a number differs from a text that looks
/// like it.
bool sameValue(const DocumentNode& a, const DocumentNode& b);

/// A value on one line, in YAML's flow style.
/// @param json  all texts and keys in double quotes
std::string flowText(const DocumentNode& node, bool json);

}  // namespace emscape::document
