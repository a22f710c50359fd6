#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scenario/file/parse_sections.h"

namespace emscape::scenario {

constexpr double kNarrow_hz = 100;  ///< no receiver of a radar is, no noise of a jammer

/// A warning of one kind about any number of items of a scenario.
class WarningOfItems {
 public:
  /// @param text  what is said of this item; that of the first item is shown
  void add(const SourceLocation& location, const std::string& item, const std::string& text) {
    if (items_.empty()) {
      location_ = location;
      text_ = text;
    }
    items_.push_back("'" + item + "'");
  }

  void addTo(document::ProblemList& problems) const {
    constexpr std::size_t kMaxNames = 5;
    if (items_.empty()) return;
    std::string text = text_;
    if (items_.size() > 1) {
      const auto end = items_.begin() + static_cast<std::ptrdiff_t>(std::min(items_.size(), kMaxNames));
      text += fmt::format("; likewise {}", fmt::join(items_.begin() + 1, end, ", "));
      if (items_.size() > kMaxNames) text += fmt::format(" and {} more", items_.size() - kMaxNames);
    }
    problems.addWarning(location_, text);
  }

 private:
  SourceLocation location_;
  std::string text_;
  std::vector<std::string> items_;  ///< names in quotation marks
};

}  // namespace emscape::scenario
