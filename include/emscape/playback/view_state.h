/// What a view of a scenario or of volumes shows, as a file: a window writes it, `emscape render --state`
/// draws the same picture from it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/playback/painter.h"
#include "emscape/render/annotate/overlay.h"
#include "emscape/render/camera.h"
#include "emscape/render/render_settings.h"
#include "emscape/render/transfer_function.h"
#include "emscape/scenario/edit.h"
#include "emscape/scenario/emitter.h"
#include "emscape/volume/value_range.h"

namespace emscape::playback {

/// A camera to come back to, and a time if that is kept too.
struct Bookmark {
  std::string name;
  render::CameraSpec camera;
  std::optional<double> time_s;
};

/// Everything that a picture depends on besides the input, and how the input is played.
struct ViewState {
  render::CameraSpec camera;
  std::vector<Bookmark> bookmarks;
  double time_s = 0;  ///< since the scenario's epoch
  double rate = 1;    ///< scenario seconds in a second; negative: backwards
  bool loop = false;
  std::optional<scenario::TimeInterval> play_range;    ///< that playing stays in; none: all steps
  std::optional<scenario::TimeInterval> visible_time;  ///< that the time line shows; none: all steps
  std::string quantity;                                ///< quantity or channel; empty: the first
  /// None: fitted to the volume, or to `range` where that is given. Categories have their own colours.
  std::optional<render::TransferFunction> transfer;
  std::optional<volume::ValueRange> range;  ///< of the colours; none: that of the series
  render::RenderSettings settings;          ///< but for skip_empty and plain, which a file does not hold
  render::Theme theme = render::Theme::dark;
  bool show_terrain = true;
  bool show_emitters = true;
  render::ImageSize size{1280, 720};
  std::vector<scenario::Edit> edits;     ///< to the scenario, in order
  std::string compare;                   ///< as FrameSelection::compare; empty: the field is shown
  std::vector<std::string> open_panels;  ///< of the window, by its own names
};

/// Reads a file (docs/view-state.md), JSON or YAML. Keys that it does not have keep their default.
/// @throws Error (bad_input) that lists all faults with file:line:column
ViewState readViewState(const std::string& file);
/// The same from a text; `file` is the name that errors give.
ViewState parseViewState(const std::string& text, const std::string& file);

/// The JSON text that parseViewState() reads back to the same bits. A categorical transfer function is left
/// out. Equal states have equal texts.
std::string viewStateText(const ViewState& state);
/// Writes that text; the file appears whole or not at all.
/// @throws Error (bad_input) for a state that could not be read again, such as a camera out of its limits;
/// (other) if the file cannot be written
void writeViewState(const std::string& file, const ViewState& state);

/// Another quantity or channel in a view: colours, range and isosurface, which belong to the one before, are
/// dropped. Nothing happens if it is the same.
void changeQuantity(ViewState& state, const std::string& quantity);
/// The field or a difference (FrameSelection::compare): colours, range and isosurface are dropped where the
/// other of the two was shown.
void changeComparison(ViewState& state, const std::string& compare);
/// Colours over a range, in place of a transfer function.
void changeRange(ViewState& state, const volume::ValueRange& range);

/// How the pictures of a state look.
PictureStyle pictureStyleOf(const ViewState& state);

}  // namespace emscape::playback
