/// Changes values in the text of a document and leaves everything else as it stands: comments, order, quotes,
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
/// do not exist become maps. Only what lies on the path is copied.
/// @param value  null: the key or item is removed
/// @pre every index of the path is that of an item, and every key that of a map or of what does not exist
DocumentNodePtr withValueAt(const DocumentNodePtr& root, const NodePath& path, const DocumentNodePtr& value);

/// How the text must change for withValueAt(root, path, value). The new value is written on one line.
/// @param text  what readDocument() made `root` of
/// @throws Error (bad_input), without a place, where the text cannot be changed at one place: anchors,
/// aliases, block texts with an indentation indicator
Splice spliceFor(const std::string& text, const DocumentNodePtr& root, const NodePath& path,
                 const DocumentNodePtr& value);

/// Whether two documents mean the same: kinds, texts, order of keys; numbers differ from texts that look like
/// them.
bool sameValue(const DocumentNode& a, const DocumentNode& b);

/// A value on one line, as YAML's flow style.
/// @param json  all texts and keys in double quotes
std::string flowText(const DocumentNode& node, bool json);

}  // namespace emscape::document
