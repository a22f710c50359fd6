/// What a file is that was given as a scenario or as a study.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "document/document.h"

namespace emscape::scenario {

/// What a file holds that is no document of ours, by its ending and its first bytes, and how it is used: "is
/// a recording: `emscape import` makes a scenario of it"; empty: it may be a document.
std::string foreignFileText(const std::string& file);

enum class DocumentKind { scenario, study, view, transfer, series, vectors, result, unknown, emitters };
/// By the keys of a document; the emitter database by those of its first row.
DocumentKind documentKindOf(const document::DocumentNode& root);
/// The same of JSON, by its keys alone.
DocumentKind documentKindOf(const nlohmann::json& root);

/// "a study, not a scenario: `emscape study` computes it"; empty: it is one, or not recognised.
/// @param wanted  scenario or study
std::string otherDocumentText(DocumentKind kind, DocumentKind wanted);

}  // namespace emscape::scenario
