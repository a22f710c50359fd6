/// Rows of a name and a control; each edits the scenario's value at a path.
#pragma once

#include <optional>
#include <set>
#include <string>

#include "apps/view/panels/panels.h"
#include "scenario/file/parameters.h"

namespace emscape::view {

/// Text of the field being edited.
struct Typing {
  std::string path, text;
};

/// Draws the rows of groups; a refused edit is shown below its row. Lives for one frame.
class ParameterRows {
 public:
  /// @param edited  paths that differ from the scenario's file
  /// @param typing  kept from frame to frame
  ParameterRows(PanelContext& context, const std::set<std::string>& edited, Typing& typing)
      : context_(context), edited_(edited), typing_(typing) {}

  /// Draws a table of the group's values, and its subgroups below collapsible headings.
  void draw(const scenario::ParameterGroup& group);
  /// Begins one more row of such a table. @return true if it is drawn; end() must then be called after the
  /// control
  bool begin(const char* id);
  static void end();
  /// Begins a row; its control is drawn next.
  void label(const std::string& name, const std::string& tooltip, bool is_edited);

 private:
  void drawGroup(const scenario::ParameterGroup& group);
  void drawRow(const scenario::Parameter& parameter);
  void drawLabelMenu(const scenario::Parameter& parameter) const;
  void drawNumber(const scenario::Parameter& parameter);
  void drawChoice(const scenario::Parameter& parameter);
  void drawText(const scenario::Parameter& parameter);
  void drawTypedNumber(const scenario::Parameter& parameter);
  /// Draws a text field. @return the text when Enter is pressed or the focus is lost
  std::optional<std::string> drawField(const scenario::Parameter& parameter, const std::string& shown,
                                       const char* hint);
  /// Keeps the text of the item drawn last while it is edited. @return the text when Enter is pressed or the
  /// focus is lost, because a field without the focus no longer returns it; empty if Esc is pressed
  std::optional<std::string> takeTyped(const std::string& path, bool is_typed, const std::string& text);
  void drawRejection(const std::string& path);
  void set(const std::string& path, const std::string& value) const;

  PanelContext& context_;
  const std::set<std::string>& edited_;
  Typing& typing_;
};

}  // namespace emscape::view
