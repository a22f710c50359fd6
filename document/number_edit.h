/// Numbers edited in a document without reading its text again.
#pragma once

#include <string>

#include "document/text_edit.h"

namespace emscape::document {

/// The document that readDocument() would make of a text after a change: of a number written in the place of
/// a scalar, which leaves all other values as they are.
/// @param splice  of spliceFor(text, root, path, value)
/// @return null if the text has to be read: for other changes, and where the document has anchors
DocumentNodePtr withNumberSpliced(const std::string& text, const DocumentNodePtr& root, const NodePath& path,
                                  const DocumentNodePtr& value, const Splice& splice);

}  // namespace emscape::document
