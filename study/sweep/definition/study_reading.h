/// Common data of the readers of a study's parts.
#pragma once

#include <string>

#include "document/document.h"
#include "document/section.h"
#include "emscape/base/error.h"
#include "study/sweep/definition/study_file.h"

namespace emscape::study {

/// True for a text with a line break or another control character, which does not fit a line of a table.
bool hasControlCharacter(const std::string& text);

/// A study being read. Faults are collected.
struct StudyReading {
  std::string file;
  document::ProblemList problems;
  /// The original document; checkable() rewrites its maps from paths to values.
  document::DocumentNodePtr original;
  StudySpec spec;
  bool tries_values = true;  ///< see loadStudy()

  /// A name in the study, relative to its folder.
  std::string resolve(const std::string& name) const;
  SourceLocation at(const document::TextPosition& position) const {
    return {file, position.line, position.column};
  }
  void fault(const SourceLocation& location, const std::string& message) {
    problems.addError(location, message);
  }
  /// Adds a file of points or polygons to the study's files. @throws Error (bad_input)
  void addVectors(const std::string& name);
  /// The name of a measure or a variant. Tables hold one line each: control characters are a fault.
  std::string nameOf(const document::Section& section);
  /// Calls a function; its error becomes a fault at a location of the study.
  template <class Read>
  void reportAt(const SourceLocation& location, const Read& read) {
    try {
      read();
    } catch (const Error& error) {
      fault(location, error.what());
    }
  }
};

/// Reads `measures`; after the times and the base scenario.
void readMeasures(StudyReading& reading, const document::Section& root);
/// Reads `variants`, `sweep`, `samples` and `sites`; after the measures. @throws Error (bad_input)
void readVariants(StudyReading& reading, const document::Section& root);
/// Adds to the study's files those that the scenarios of its variants name; after the variants. Only settings
/// of values that can name a file are looked at, and none that is valid only together with those of other
/// factors: its files are not in the study's hash.
void addFilesOfVariants(StudyReading& reading);

}  // namespace emscape::study
