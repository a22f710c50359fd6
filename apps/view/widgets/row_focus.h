/// Which row of the scenario's values has the keyboard, and the text that is being typed there.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/commands/action.h"

namespace emscape::view {

/// The characters that open the text field of a row: none, those with which a number begins, or all.
enum class RowText { none, number, all };

/// The focus of the keyboard among rows, each with a name that is unique in the panel. Tab and the arrow keys
/// move it; Esc and a click elsewhere give the keyboard back to the picture. Dear ImGui's own navigation is
/// not used: its text fields alone are reached by Tab, and its arrow keys act also without a focus.
class RowFocus {
 public:
  /// Begins a frame of the panel: handles the keys that move the focus.
  /// @param is_behind_dialog  the keys are for a dialog, and no row has the focus
  void beginFrame(bool is_behind_dialog);
  /// Ends the frame. @param is_clicked_elsewhere  outside of the panel
  void endFrame(bool is_clicked_elsewhere);

  /// Tells that a row is drawn, in the order of the rows.
  void add(const std::string& row, RowText text = RowText::none) {
    rows_.push_back(row);
    if (has(row)) text_of_focused_ = text;
  }
  bool has(const std::string& row) const { return row == focused_; }
  void take(const std::string& row) { focused_ = row; }
  /// Keeps the focus on a row that gets another name. @param renamed  gives the new name of a row
  template <class Renamed>
  void rename(const Renamed& renamed) {
    for (std::string* row : {&focused_, &last_, &typing_, &next_typing_}) *row = renamed(*row);
    for (std::string& row : rows_before_) row = renamed(row);
    for (std::string& row : rows_) row = renamed(row);
  }
  /// Lets Tab begin at a row that does not take the focus.
  void startAt(const std::string& row) { last_ = row; }
  /// True in the frame in which the focus came to a row by a key: the row must become visible.
  bool arrives(const std::string& row) const { return moved_ && has(row); }
  /// True in the frame in which Enter was pressed in a row.
  bool isEntered(const std::string& row) const { return key_ == Key::enter && has(row); }
  bool isSpaced(const std::string& row) const { return key_ == Key::space && has(row); }
  /// True in the frame in which Esc took the focus from a row.
  bool isEscaped(const std::string& row) const { return row == escaped_; }
  /// Steps by the keys Left (-1) and Right (1).
  int steps(const std::string& row) const;
  /// Characters that were typed in a row without a text field and open it.
  std::string typed(const std::string& row) const;

  /// True if a row has the focus.
  bool hasKeyboard() const;
  /// True if a key without Ctrl is for the row with the focus: letters are for the picture, unless a text is
  /// typed.
  bool takes(const KeyChord& chord) const;
  /// True if the panel was drawn in the last frame.
  bool isShown() const;

  // --- the text field of a row ---
  /// Opens the field of a row with the next frame. @param selects  the text is selected, to be overwritten
  void type(const std::string& row, const std::string& text, bool selects);
  bool isTyping(const std::string& row) const { return row == typing_; }
  /// Draws the field. @return the text when Enter or Tab is pressed or another item is clicked; empty
  /// optional while it is typed, and if it is taken back by Esc or not changed
  std::optional<std::string> drawField();

 private:
  enum class Key { none, enter, space, left, right };
  void move(int by);

  std::vector<std::string> rows_, rows_before_;
  RowText text_of_focused_ = RowText::none;
  std::string focused_, last_;  // the last one gets the focus by Tab
  std::string escaped_;
  bool moved_ = false;
  int will_move_ = 0;  // by Tab, once the field has given its text
  Key key_ = Key::none;
  std::string characters_;
  int drawn_frame_ = -10;

  std::string typing_, next_typing_;
  std::string opened_text_, next_text_;
  std::array<char, 4096> text_{};
  bool selects_ = false, next_selects_ = false, is_open_ = false, leaves_ = false;
  int drawn_field_frame_ = -10;
};

/// The focus in the panel of the scenario.
RowFocus& scenarioFocus();

}  // namespace emscape::view
