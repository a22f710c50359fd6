/// Building of texts for a terminal.
#pragma once

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <utility>

namespace emscape::report {

/// A text that grows by formatted pieces.
class Text {
 public:
  template <class... Arguments>
  void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Arguments>(arguments)...);
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

}  // namespace emscape::report
