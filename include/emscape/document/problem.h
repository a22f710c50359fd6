/// Problems of a document and of the files that it names.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "emscape/base/enum_names.h"
#include "emscape/base/error.h"

namespace emscape::document {

using emscape::toString;

enum class Severity { warning, error };
constexpr auto namesOf(Severity) {
  return std::array{"warning", "error"};
}

struct Problem {
  SourceLocation location;
  Severity severity = Severity::error;
  std::string message;
};

/// Collects problems, so that all of them can be reported at once. At most 1000 are kept, and one that says
/// so. Problems of another file are sorted by the location at which the scenario names that file.
class ProblemList {
 public:
  void addError(const SourceLocation& location, const std::string& message);
  void addWarning(const SourceLocation& location, const std::string& message);
  /// A fault in a file that the scenario names at `named_at`.
  void addErrorElsewhere(const SourceLocation& named_at, const SourceLocation& location,
                         const std::string& message);

  bool hasErrors() const;
  /// In the order of the scenario file; problems of one location in the order in which they were found.
  std::vector<Problem> inOrder() const;

 private:
  struct Entry {
    Problem problem;
    int line, column;  ///< in the scenario file
  };
  void add(const SourceLocation& order, Problem problem);

  std::vector<Entry> entries_;
};

}  // namespace emscape::document
