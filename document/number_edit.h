/// Edits of numbers in a document without parsing its text again.
#pragma once

#include <string>

#include "document/text_edit.h"

namespace emscape::document {

/// The document that readDocument() would build after a change that replaces a scalar by a number and leaves
/// all other values unchanged.
/// @param splice  of spliceFor(text, root, path, value)
/// @return null if the text must be parsed: for other changes, and if the document has anchors
DocumentNodePtr withNumberSpliced(const std::string& text, const DocumentNodePtr& root, const NodePath& path,
                                  const DocumentNodePtr& value, const Splice& splice);

}  // namespace emscape::document
