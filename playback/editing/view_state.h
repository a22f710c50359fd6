/// State of a view of a scenario or of volumes, and its file. The window writes it; `emscape render --state`
/// draws the same picture from it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/playback/pictures/painter.h"
#include "emscape/render/annotate/overlay.h"
#include "emscape/render/scene/camera.h"
#include "emscape/render/scene/render_settings.h"
#include "emscape/render/transfer/transfer_function.h"
#include "emscape/scenario/model/edit.h"
#include "emscape/scenario/model/emitter.h"
#include "emscape/volume/value_range.h"

namespace emscape::playback {

/// A stored camera, and a time if that is stored too.
struct Bookmark {
  std::string name;
  render::CameraSpec camera;
  std::optional<double> time_s;
};

/// Everything that a picture depends on besides the input, and the settings of playback.
struct ViewState {
  render::CameraSpec camera;
  std::vector<Bookmark> bookmarks;
  double time_s = 0;  ///< since the scenario's epoch
  double rate = 1;    ///< scenario seconds per second; negative: backwards
  bool loop = false;
  std::optional<scenario::TimeInterval> play_range;    ///< range of playing; none: all steps
  std::optional<scenario::TimeInterval> visible_time;  ///< range of the time line; none: all steps
  std::string quantity;                                ///< quantity or channel; empty: the first
  /// None: fitted to the volume, or to `range` if that is given. Categories have their own colours.
  std::optional<render::TransferFunction> transfer;
  std::optional<volume::ValueRange> range;  ///< of the colours; none: that of the series
  render::RenderSettings settings;          ///< without skip_empty and plain, which are not stored
  render::Theme theme = render::Theme::dark;
  bool show_terrain = true;
  bool show_emitters = true;
  render::ImageSize size{1280, 720};
  std::vector<scenario::Edit> edits;     ///< to the scenario, in order
  std::string compare;                   ///< as FrameSelection::compare; empty: the field is shown
  std::vector<std::string> open_panels;  ///< of the window
};

/// Reads a file (docs/view-state.md), JSON or YAML. Missing keys have their default. A relative name of a
/// file to compare with is relative to the file's folder; if there is none, to the working folder.
/// @throws Error (bad_input) that lists all faults with file:line:column
ViewState readViewState(const std::string& file);
/// The same from a text; `file` is the name that errors give. ViewState::compare is as in the text.
ViewState parseViewState(const std::string& text, const std::string& file);

/// The state as JSON; parseViewState() reads it back exactly. A categorical transfer function is left out.
/// Equal states have equal texts.
std::string viewStateText(const ViewState& state);
/// Writes that text, a relative name of a file to compare with made relative to the file's folder; the file
/// is written atomically.
/// @throws Error (bad_input) for a state that cannot be read again, such as a camera outside its limits;
/// (other) if the file cannot be written
void writeViewState(const std::string& file, const ViewState& state);

/// Changes the quantity or channel of a view. Colours, range and isosurface, which belong to the previous
/// one, are dropped. No effect if it is the same.
void changeQuantity(ViewState& state, const std::string& quantity);
/// Changes between the field and a difference (FrameSelection::compare). Colours, range and isosurface are
/// dropped if this is a change.
void changeComparison(ViewState& state, const std::string& compare);
/// Fits the colours to a range; this replaces a transfer function.
void changeRange(ViewState& state, const volume::ValueRange& range);

/// The picture style of a state.
PictureStyle pictureStyleOf(const ViewState& state);

}  // namespace emscape::playback
