/// Rows of a name and a control; each edits the scenario's value at a path.
#pragma once

#include <set>
#include <string>

#include "apps/view/panels/panels.h"
#include "apps/view/values/value_slider.h"
#include "apps/view/widgets/row_focus.h"
#include "scenario/file/parameters.h"

namespace emscape::view {

/// A typed text that was not accepted, kept for correction.
struct RefusedText {
  std::string path, text;
  std::string why;
  playback::ScenarioPtr scenario;  ///< whose value it was to replace
  bool is_own = false;             ///< by the row itself, not by the session
};

/// State of the rows between frames.
struct RowState {
  RefusedText refused;
  std::string sent_path, sent_text;  ///< the text entered last
  /// A value that is being dragged.
  struct {
    std::string path, sent;
    double position = 0;
    bool is_moved = false;
  } drag;
};

/// Draws the rows of groups; a refused edit is explained over the rows below its own. Lives for one frame.
class ParameterRows {
 public:
  /// @param edited  paths that differ from the scenario's file
  ParameterRows(PanelContext& context, const std::set<std::string>& edited, RowFocus& focus, RowState& state)
      : context_(context), edited_(edited), focus_(focus), state_(state) {}

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
  /// A collapsible heading in the table. @return true if it is open
  bool drawSubheading(const std::string& id, const std::string& name, bool is_open_first);
  void drawRow(const scenario::Parameter& parameter);
  void drawLabelMenu(const scenario::Parameter& parameter) const;
  /// A number or a text: a control that becomes a text field.
  void drawValue(const scenario::Parameter& parameter);
  void handleSlider(const scenario::Parameter& parameter, const ValueSlider& slider, double value);
  void drag(const scenario::Parameter& parameter, const std::string& value);
  bool enterPosition(const scenario::Parameter& parameter, const std::string& text);
  /// Takes a text without the blanks at its ends.
  void enter(const scenario::Parameter& parameter, const std::string& typed);
  void drawBoolean(const scenario::Parameter& parameter);
  void drawChoice(const scenario::Parameter& parameter);
  void drawItems(const scenario::Parameter& parameter);
  /// Draws the mark of the focus around the control drawn last and scrolls to it; takes the focus if it is
  /// clicked and a text is typed there.
  void showFocus(const std::string& path, RowText text);
  void takeRejection(const std::string& path);
  void restoreValue(const std::string& path);
  void drawRefusal(const std::string& path);
  bool isAdded(const std::string& path) const;
  void set(const std::string& path, const std::string& value) const;

  PanelContext& context_;
  const std::set<std::string>& edited_;
  RowFocus& focus_;
  RowState& state_;
};

}  // namespace emscape::view
