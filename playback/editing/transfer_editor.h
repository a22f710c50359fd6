/// Model of an editor of a transfer function: points, selection, fitting, undo. No drawing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/render/transfer/transfer_function.h"
#include "emscape/volume/value_range.h"
#include "playback/editing/opacity_preset.h"
#include "playback/editing/undo_stack.h"

namespace emscape::playback {

/// Scale of an editor's vertical axis, 0..1 from the bottom. The logarithmic scale resolves small opacities:
/// its lowest part is opacity 0, the rest kMinOpacity to 1.
struct OpacityAxis {
  static constexpr double kMinOpacity = 1e-4;
  static constexpr double kZeroPart = 0.05;

  bool logarithmic = true;

  /// @param opacity  0..1, clamped; on the logarithmic axis values below kMinOpacity are shown as 0
  double position(double opacity) const;
  /// @param position  0..1, clamped
  double opacity(double position) const;
};

/// The function always has an interval: its points have at least two different values. Not for categories.
/// For one thread.
class TransferEditor {
 public:
  /// @throws Error (bad_input) for a categorical function
  explicit TransferEditor(const render::TransferFunction& function);

  const render::TransferFunction& function() const { return stack_.state(); }
  /// Number of changes, undo and redo included.
  long long changes() const { return changes_; }
  /// Sets another function, as one step: from a file, or the default of a volume. @throws as the constructor
  void setFunction(const render::TransferFunction& function);

  OpacityAxis axis;

  // Opacity points, by index in function().opacities; values in the quantity's unit
  /// The selected point; none after a change that removes it.
  std::optional<int> selected() const { return selected_; }
  /// Selects a point; none for an invalid index.
  void select(std::optional<int> point);
  /// The point nearest to a value and a position on the axis, if it is within `radius`.
  /// @param value_scale  length of one unit of the value, in that of the axis
  std::optional<int> pointNear(double value, double position, double value_scale, double radius) const;
  /// Adds a point within the interval and selects it. @return its index; after points at the same value
  int add(double value, double opacity);
  /// Moves the selected point between its neighbours, within the interval. No effect without one.
  void moveSelected(double value, double opacity);
  /// Deletes the selected point; the one that takes its index becomes selected, or the last. The last two,
  /// and points without which no interval would be left, stay.
  void removeSelected();

  /// Sets the points of one of opacityPresets() over the interval, as one step.
  /// @param at  position of a threshold or a shell; none: the middle
  /// @throws Error (bad_input) for an unknown name
  void setOpacityPreset(const std::string& name, std::optional<double> at = std::nullopt);
  /// Multiplies all opacities; those above 1 become 1. @param factor  >= 0
  void scaleOpacities(double factor);

  // Colours
  /// Sets a colour map over the interval of the function, as one step. @throws Error (bad_input) for an
  /// unknown name
  void setColorMap(const std::string& name);
  /// The name of the colour map in use; empty if the colours are no named map.
  std::string colorMap() const;
  /// The names for setColorMap().
  static std::vector<std::string> presets() { return render::colorMapNames(); }

  /// Stretches colours and opacities from the function's interval to another one. No effect for a range
  /// without width.
  void fit(const volume::ValueRange& range);
  /// The same in double precision.
  void setInterval(double lowest, double highest);
  /// Moves one end of the interval. Within a drag it is moved relative to the beginning of the drag, so that
  /// points are not lost.
  void setLowest(double value);
  void setHighest(double value);

  // Steps
  /// All changes until endDrag() are one step.
  void beginDrag() { stack_.beginDrag(); }
  void endDrag();
  /// As UndoStack::stepsBack().
  std::size_t stepsBack() const { return stack_.stepsBack(); }
  /// As UndoStack::stepsMade().
  long long stepsMade() const { return stack_.stepsMade(); }
  bool canUndo() const { return stack_.canUndo(); }
  bool canRedo() const { return stack_.canRedo(); }
  void undo();
  void redo();

 private:
  void set(render::TransferFunction function);
  /// The function at the beginning of a drag of the ends.
  const render::TransferFunction& base() const { return stack_.dragged() ? *stack_.dragged() : function(); }
  void checkSelection();

  UndoStack<render::TransferFunction> stack_;
  long long changes_ = 0;
  std::optional<int> selected_;
};

}  // namespace emscape::playback
