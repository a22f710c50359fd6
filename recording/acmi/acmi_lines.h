/// The lines of an ACMI text: one that ends in a backslash goes on in the next one.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace emscape::interop {

/// Reason for which a line is not used.
constexpr const char* kTooLongAcmiLine = "a line longer than 1 MiB";

/// Joins physical lines to logical ones. Logical lines longer than LineReader::kLongest are left out and
/// counted.
class AcmiLines {
 public:
  /// Takes the next physical line, without its end.
  /// @param is_cut  the line was too long, and is not whole
  /// @return the logical line that ends with it, with '\n' where lines were joined; valid until the next call
  /// and as long as `line`. None: the line goes on, or is too long
  std::optional<std::string_view> take(std::string_view line, bool is_cut = false);

  /// Number of the first physical line of the last logical one, from 1.
  long long line() const { return begin_; }
  /// Logical lines that were left out, each counted as soon as it is too long.
  long long tooLong() const { return too_long_; }

 private:
  std::string joined_;
  bool goes_on_ = false, is_too_long_ = false;
  long long lines_ = 0, begin_ = 0, too_long_ = 0;
};

/// A logical line as physical ones, without the end of the last one.
std::string physicalAcmi(std::string_view line);

}  // namespace emscape::interop
