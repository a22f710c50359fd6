/// Frames of a source as finished pictures: one camera, one set of colours.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "emscape/base/progress.h"
#include "emscape/playback/frame_source.h"
#include "emscape/render/annotate/overlay.h"
#include "emscape/render/camera.h"
#include "emscape/render/height_field.h"
#include "emscape/render/image.h"
#include "emscape/render/renderer.h"

namespace emscape::playback {

/// How pictures look.
struct PictureStyle {
  render::ImageSize size;
  render::CameraSpec camera;
  render::Theme theme = render::Theme::dark;
  render::RenderSettings settings;
  std::string transfer;  ///< file of the transfer function; empty: fitted to the first volume
  std::optional<render::TransferFunction> function;  ///< without such a file; not used for categories
  bool colors_span_range = false;  ///< fitted to the range of its values alone, not to how frequent they are
  bool show_terrain = true;
  bool show_emitters = true;
};

/// Draws frames; colours stay as they were fitted to the first, the camera as long as frames have the same
/// grid. Casting a picture and writing its labels are apart: who draws labels of its own takes image() or
/// fetch(), annotations() and renderer(). One thread at a time uses it.
class Painter {
 public:
  /// Draws frames of one source. @throws Error (device)
  Painter(const PictureStyle& style, const FrameSource& source, const ComputeTarget& target);
  /// The same without title and scene, until setScene(). @throws Error (bad_input) for settings, (device)
  Painter(const PictureStyle& style, const ComputeTarget& target);

  /// What the next frames show besides the field. Another terrain object is another ground.
  /// @param scene  null: volumes without a scenario
  void setScene(const std::string& title, const LoadedScenario* scene);
  /// What the next pictures show.
  /// @throws Error (bad_input) for a transfer file, nothing is changed then; or for an isosurface that shows
  /// nothing of the first frame, which is set all the same. Error (device)
  void setFrame(const Frame& frame);
  /// Turns an orbiting camera to another azimuth. A frame must be set.
  void setAzimuth(double azimuth_deg);
  /// Another camera, fitted to the box of the volume. A frame must be set.
  /// @throws Error (usage) if eye and target coincide; the camera is then as before
  void setCamera(const render::CameraSpec& spec);

  /// The functions below change the style of the next pictures, before or after the first frame.
  /// @param size  both sides at least 1
  void setSize(render::ImageSize size);
  render::ImageSize size() const { return style_.size; }
  /// An isosurface is not checked against the volume. @throws Error (bad_input) for a value out of its range;
  /// the settings are then as before
  void setSettings(const render::RenderSettings& settings);
  /// This function in place of a file or a fitted one.
  void setTransferFunction(const render::TransferFunction& function);
  /// A function fitted to the frame, or to the next one if there is none yet: to how frequent its values are.
  void fitColors();
  /// The same, spread over a range of values. A frame must be set.
  void fitColors(const volume::ValueRange& range);
  /// Whether they have been fitted, read or set.
  bool hasColors() const { return has_colors_; }
  void showTerrain(bool show);
  void showEmitters(bool show);
  void setTheme(render::Theme theme) { annotations_.theme = theme; }

  render::FrameReport draw(const render::FramePlan& plan, const StopFlag* stop = nullptr);
  /// Casts what the last draw() left out.
  render::FrameReport restore(const StopFlag* stop = nullptr);
  /// What was drawn last, bare: premultiplied, no background, no labels.
  const render::Image& image();
  /// The same in 8 bits a channel; a GPU quantises it, which makes it the cheaper one.
  void fetch(render::Image8& picture);
  /// A full cast of what draw() and restore() show, beside it.
  render::Image fullCast();

  /// The ground that is drawn; null where none is.
  const std::shared_ptr<const render::HeightField>& heightField() const { return height_field_; }
  /// What is written on a picture of the frame.
  const render::Annotations& annotations() const { return annotations_; }
  /// Its camera, box and hidden positions are those of the picture. Colours and settings may be changed after
  /// the first frame was set.
  render::Renderer& renderer() { return renderer_; }

  /// What was drawn last on its background, with its labels. @param note  small, at the bottom
  render::Image8 picture(const std::string& note);
  /// A picture that was fetched, on the same background with the same labels; at most one level apart.
  render::Image8 annotated(const render::Image8& fetched, const std::string& note);
  /// The picture that annotated() gives, made and kept by the GPU; at most two levels apart. Null with the
  /// CPU.
  std::shared_ptr<const render::DevicePicture> annotatedOnDevice(const std::string& note);

 private:
  /// That of the scene below the grid of the frame, if it is to be shown.
  void setGround();
  void setGround(const scenario::TerrainPtr& ground);
  void setMarkers();
  /// Fits the camera anew where the legend takes more or less space than before.
  void setLegend();
  render::Camera cameraOf(const render::CameraSpec& spec) const;
  void fitCamera();
  render::TransferFunction functionFor(const volume::Volume& volume) const;

  PictureStyle style_;
  std::optional<LoadedScenario> scene_;
  std::optional<Frame> frame_;
  scenario::TerrainPtr ground_;  // whose height field the renderer has
  std::shared_ptr<const render::HeightField> height_field_;
  render::Renderer renderer_;
  render::Annotations annotations_;
  render::OverlayLayers layers_;
  render::Image image_;
  bool fetched_ = false;  ///< image_ is what was drawn last
  bool has_colors_ = false;
  double legend_space_ = 0;  ///< part of the width
};

}  // namespace emscape::playback
