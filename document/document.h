/// A YAML or JSON text as a tree that keeps the position of every key and value.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "emscape/document/problem.h"

namespace emscape::document {

/// line and column count from 1; columns are characters.
struct TextPosition {
  int line = 0;
  int column = 0;
  std::size_t offset = 0;  ///< byte of the text
};

enum class NodeKind { null, scalar, sequence, map };

struct DocumentNode;
using DocumentNodePtr = std::shared_ptr<const DocumentNode>;

/// Duplicate keys are kept; checkObject() reports them.
struct MapEntry {
  std::string key;
  TextPosition position;  ///< of the key
  DocumentNodePtr value;  ///< never null
};

struct DocumentNode {
  NodeKind kind = NodeKind::null;
  TextPosition
      position;  ///< of the value; of its key where the value is missing; of the anchor's value for an alias
  std::string text;                    ///< scalar
  bool quoted = false;                 ///< scalar: text even if it looks like a number or null
  bool anchored = false;               ///< other values may be aliases of this one
  std::vector<DocumentNodePtr> items;  ///< sequence
  std::vector<MapEntry> entries;       ///< map, in the order of the file
  long long unfolded_count = 1;        ///< values in this node with every alias written out
};

/// Builds the tree of one document. Aliases share nodes. Refused, each as a problem with its location: syntax
/// errors, tabs as indentation, tags, merge keys, keys that are not text, aliases within their own anchor,
/// nesting deeper than 32, more than a million values with aliases written out, a second document.
/// @param text  UTF-8 without byte order mark
/// @return null if the text could not be read to its end or is empty
DocumentNodePtr readDocument(const std::string& file, const std::string& text, ProblemList& problems);

}  // namespace emscape::document
