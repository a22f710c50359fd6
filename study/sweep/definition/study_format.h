/// The table of the format of studies.
#pragma once

#include <string>

#include "document/document.h"
#include "document/section.h"

namespace emscape::study {

const document::ObjectSpec& studyFormat();

/// The document with maps whose keys are paths of a scenario written as lists, which the table can check:
/// `sweep` and `samples.parameters` become lists of their values; `values` of a sweep, texts in YAML's flow
/// style; `set`, an empty map. Numbers where the table has texts (`times: 80`) become texts.
/// @throws Error (bad_input) where `sweep` or `samples.parameters` of the file is not a map
document::DocumentNodePtr checkable(const std::string& file, const document::DocumentNode& root);

/// The value of a key; null if there is none.
const document::DocumentNode* childOf(const document::DocumentNode* node, const std::string& key);

}  // namespace emscape::study
