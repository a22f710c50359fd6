/// Model of an editor of a transfer function: points, selection, fitting, undo. No drawing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/playback/undo_stack.h"
#include "emscape/render/transfer_function.h"
#include "emscape/volume/value_range.h"

namespace emscape::playback {

/// How an editor's vertical axis, 0..1 from the bottom, shows opacities. The logarithmic one has fine control
/// where volumes need it: its lowest part is opacity 0, above are kMinOpacity to 1 in equal ratios.
struct OpacityAxis {
  static constexpr double kMinOpacity = 1e-4;
  static constexpr double kZeroPart = 0.05;

  bool logarithmic = true;

  /// @param opacity  0..1, clamped; on the logarithmic axis what is below kMinOpacity is shown as 0
  double position(double opacity) const;
  /// @param position  0..1, clamped
  double opacity(double position) const;
};

/// The function always keeps an interval: its points are at least two different values. Not for categories.
/// One thread uses it.
class TransferEditor {
 public:
  /// @throws Error (bad_input) for a categorical function
  explicit TransferEditor(const render::TransferFunction& function);

  const render::TransferFunction& function() const { return stack_.state(); }
  /// Another function, in one step: a file, or the default of a volume. @throws as the constructor
  void setFunction(const render::TransferFunction& function);

  OpacityAxis axis;

  // Opacity points, by index in function().opacities; values in the quantity's unit
  /// The selected one; none after a change that leaves the selection without a point.
  std::optional<int> selected() const { return selected_; }
  /// None for an index that is not one.
  void select(std::optional<int> point);
  /// The point nearest to a value and a position on the axis, if it is within `radius`.
  /// @param value_scale  length of one unit of the value, in that of the axis
  std::optional<int> pointNear(double value, double position, double value_scale, double radius) const;
  /// Adds a point and selects it. @return its index; after points at the same value
  int add(double value, double opacity);
  /// Moves the selected point between its neighbours. Nothing happens without one.
  void moveSelected(double value, double opacity);
  /// Deletes the selected point; the one that takes its index becomes selected, or the last. The last two,
  /// and points without which no interval would be left, stay.
  void removeSelected();

  // Colours
  /// A colour map over the interval of the function, as a step. @throws Error (bad_input) for an unknown name
  void setColorMap(const std::string& name);
  /// What setColorMap() takes.
  static std::vector<std::string> presets() { return render::colorMapNames(); }

  /// Colours and opacities together, stretched from the function's interval to another one. "Fit now" gives
  /// the range of the volume that is shown, "fit series" its info.range_*. Nothing happens for a range
  /// without width.
  void fit(const volume::ValueRange& range);
  /// The ends of the interval, each by itself.
  void setLowest(double value);
  void setHighest(double value);

  // Steps
  /// From here to endDrag() all changes are one step.
  void beginDrag() { stack_.beginDrag(); }
  void endDrag();
  bool canUndo() const { return stack_.canUndo(); }
  bool canRedo() const { return stack_.canRedo(); }
  void undo();
  void redo();

 private:
  void set(render::TransferFunction function);
  void spread(double lowest, double highest);
  void checkSelection();

  UndoStack<render::TransferFunction> stack_;
  std::optional<int> selected_;
};

}  // namespace emscape::playback
