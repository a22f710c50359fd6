/// A text and the changes made to it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "document/text_edit.h"
#include "emscape/base/error.h"

namespace emscape::document {

/// The text of a file with changes, and where each of its places stands in the file. Changes that meet become
/// one: there are at most as many as places that were changed.
class EditedText {
 public:
  EditedText() = default;
  EditedText(std::string file, std::string text);

  const std::string& file() const { return file_; }
  const std::string& text() const { return text_; }

  /// @param label  names what made the change
  void apply(const Splice& splice, const std::string& label);

  /// A place in text() as its reader knows it: its line and column in the file itself, or the label of the
  /// change that wrote it there. Places in other files are returned as they are.
  SourceLocation originOf(const SourceLocation& place) const;

 private:
  /// file bytes [begin, end) became text() bytes [new_begin, new_end).
  struct Change {
    std::size_t begin, end, new_begin, new_end;
    std::string label;
  };

  std::string file_;
  std::string original_, text_;
  std::vector<Change> changes_;  ///< in order, not meeting
};

}  // namespace emscape::document
