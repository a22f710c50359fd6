/// A text and the changes made to it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "document/text_edit.h"
#include "emscape/base/error.h"

namespace emscape::document {

/// The text of a file with changes, and the location in the file of each position. Adjacent changes are
/// merged.
class EditedText {
 public:
  EditedText() = default;
  EditedText(std::string file, std::string text);

  const std::string& file() const { return file_; }
  const std::string& text() const { return text_; }
  /// The text of the file.
  const std::string& original() const { return original_; }

  /// @param label  names the origin of the change
  void apply(const Splice& splice, const std::string& label);

  /// Maps a location in text() to its line and column in the file itself, or to the label of the change that
  /// wrote it. Locations in other files are returned unchanged.
  SourceLocation originOf(const SourceLocation& location) const;

 private:
  /// file bytes [begin, end) became text() bytes [new_begin, new_end).
  struct Change {
    std::size_t begin, end, new_begin, new_end;
    std::string label;
  };

  std::string file_;
  std::string original_, text_;
  /// Bytes at which the lines of original_ and text_ begin; empty without changes.
  std::vector<std::size_t> original_lines_, lines_;
  std::vector<Change> changes_;  ///< in order, not adjacent
};

}  // namespace emscape::document
