/// Changes of single values in YAML and JSON documents: by another kind of value, or by another one's place.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "document/document.h"
#include "document/text_edit.h"

namespace emscape::test {

/// All changes of one value each: the value left out, in a list, in a map, or replaced by null, by texts,
/// numbers, empty lists and maps, and by other values of the document.
class DocumentChanges {
 public:
  /// @param text  any text; if it is not a YAML or JSON list or map, or has thousands of values, it has no
  /// changes
  explicit DocumentChanges(const std::string& text);

  std::size_t count() const;
  /// The document with a change, in flow style: JSON if the text begins as JSON.
  /// @param change  0 .. count() - 1
  std::string changed(std::size_t change) const;

 private:
  void addPaths(const document::DocumentNode& node, document::NodePath path);

  document::DocumentNodePtr root_;
  bool is_json_ = false;
  std::vector<document::NodePath> paths_;
};

}  // namespace emscape::test
