/// Lines, words and numbers of text in any encoding, as instruments and vendors write it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "emscape/base/error.h"

namespace emscape::document {

/// Part of a line. line and column (bytes) count from 1.
struct TextField {
  std::string_view text;
  int line = 0;
  int column = 0;
};

/// The text of a file, read whole, up to 64 MiB. It may have any encoding, and only its ASCII characters are
/// used: other bytes and control characters are read as '?', so that messages can quote the text.
class TextLines {
 public:
  /// @throws Error (bad_input) if the file cannot be read or is not text (holds a zero byte)
  explicit TextLines(const std::string& file);
  TextLines(const TextLines&) = delete;
  TextLines& operator=(const TextLines&) = delete;

  const std::string& file() const { return file_; }
  /// The whole text, for CsvReader.
  std::string_view text() const { return text_; }
  /// The lines with content, without blanks at their ends; lines end in LF, CRLF or CR. Empty ones and
  /// those that begin with # are left out.
  const std::vector<TextField>& lines() const { return lines_; }
  /// The location of a field, for an Error.
  SourceLocation location(const TextField& field) const { return {file_, field.line, field.column}; }

 private:
  std::string file_;
  std::string text_;
  std::vector<TextField> lines_;
};

/// The words of a line, separated by blanks and tabs.
std::vector<TextField> wordsOf(const TextField& line);
/// The part of a field from byte `offset` on, without blanks at its ends.
TextField restOf(const TextField& field, std::size_t offset);

/// A text without blanks and tabs at its ends.
std::string_view withoutBlanks(std::string_view text);

/// A finite decimal number that fills the whole text.
std::optional<double> numberIn(std::string_view text);
/// The same, also with a decimal comma: "17,5".
std::optional<double> numberOrCommaIn(std::string_view text);
/// Case of ASCII letters only.
std::string upperCase(std::string_view text);

}  // namespace emscape::document
