#include "emscape/document/problem.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "base/text/readable_text.h"

namespace emscape::document {

namespace {

constexpr std::size_t kMaxProblems = 1000;

}  // namespace

void ProblemList::addError(const SourceLocation& location, const std::string& message) {
  add(location, {location, Severity::error, message});
}

void ProblemList::addWarning(const SourceLocation& location, const std::string& message) {
  add(location, {location, Severity::warning, message});
}

void ProblemList::addErrorElsewhere(const SourceLocation& named_at, const SourceLocation& location,
                                    const std::string& message) {
  add(named_at, {location, Severity::error, message});
}

void ProblemList::add(const SourceLocation& order, Problem problem) {
  if (entries_.size() > kMaxProblems) return;
  problem.message = readableText(std::move(problem.message));
  if (entries_.size() == kMaxProblems) problem.message = "further faults are not reported";
  entries_.push_back({std::move(problem), order.line, order.column});
}

bool ProblemList::hasErrors() const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [](const Entry& entry) { return entry.problem.severity == Severity::error; });
}

std::vector<Problem> ProblemList::inOrder() const {
  std::vector<Entry> sorted = entries_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Entry& a, const Entry& b) {
    const SourceLocation &at = a.problem.location, &bt = b.problem.location;
    return std::tie(a.line, a.column, at.file, at.line, at.column) <
           std::tie(b.line, b.column, bt.file, bt.line, bt.column);
  });
  std::vector<Problem> problems;
  for (Entry& entry : sorted) problems.push_back(std::move(entry.problem));
  return problems;
}

}  // namespace emscape::document
